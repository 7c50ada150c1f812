# SPDX-License-Identifier: Apache-2.0

# cmake -D "FILES=path;..." -D OUTPUT=file.cpp -P embed_page.cmake: a source that holds the files of
# the page as texts (page_files.h).
set(types
  html "text/html; charset=utf-8" js "text/javascript; charset=utf-8"
  css "text/css; charset=utf-8" svg "image/svg+xml")
set(rows "")
foreach(path IN LISTS FILES)
  cmake_path(GET path FILENAME name)
  cmake_path(GET path EXTENSION LAST_ONLY extension)
  string(SUBSTRING "${extension}" 1 -1 extension)
  list(FIND types "${extension}" index)
  math(EXPR index "${index} + 1")
  list(GET types ${index} type)
  # In hexadecimal, for CMake would change brackets and semicolons of a text.
  file(READ "${path}" bytes HEX)
  string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" bytes "${bytes}")
  string(REGEX REPLACE "([^\n]+)" "   \"\\1\"" bytes "${bytes}")
  file(SIZE "${path}" size)
  string(APPEND rows
    "  {std::string_view(\"${name}\"),\n   std::string_view(\"${type}\"),\n   std::string_view(\n"
    "${bytes}, ${size})},\n")
endforeach()
file(WRITE "${OUTPUT}"
  "#include \"server/page_files.h\"\n\nnamespace pellucid::view {\n\nnamespace {\n\n"
  "constexpr PageFile files[] = {\n${rows}};\n\n}  // namespace\n\n"
  "std::span<const PageFile> page_files() noexcept {\n  return files;\n}\n\n"
  "}  // namespace pellucid::view\n")
