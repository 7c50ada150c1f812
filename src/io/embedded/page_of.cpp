// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "pellucid/io/embed_scene.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/io/internal/module.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

/// Pages that scripts/build-web makes, and the mark in them that the data replace
/// (apps/web/make_page.py).
constexpr Module page{"pellucid_page.html", "shows scenes in a page",
                      "Emscripten (Debian: emscripten): run scripts/build-web"};
constexpr Module page_with_threads{
    "pellucid_page_threads.html", "shows scenes in a page with threads",
    "Emscripten (Debian: emscripten): run scripts/build-web --threads"};
constexpr std::string_view mark = "<!-- embedded -->";

void append_base64(std::string& text, std::string_view bytes) {
  constexpr const char* letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto byte = [&](std::size_t i) {
    return i < bytes.size() ? static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) : 0;
  };
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::uint32_t three = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (std::size_t j = 0; j < 4; ++j) {
      text += i + j > bytes.size() ? '=' : letters[three >> (18 - 6 * j) & 63];
    }
  }
}

/// Appends an element of HTML with these attributes that holds the bytes.
void append_element(std::string& text, const std::string& attributes, std::string_view bytes) {
  text += "<script type=\"text/plain\" " + attributes + ">";
  append_base64(text, bytes);
  text += "</script>\n";
}

void append_file(std::string& text, const EmbeddedFile& file) {
  append_element(
      text,
      "data-embedded=\"" + file.name + "\" data-size=\"" + std::to_string(file.bytes.size()) + "\"",
      file.bytes);
}

}  // namespace

std::string empty_page(PageThreads threads) {
  const std::filesystem::path path =
      module_file(threads == PageThreads::one ? page : page_with_threads);
  std::string text = read_text_file(path);
  if (text.find(mark) == text.npos) {
    throw Error(path.string() + ": is no page for scenes; run scripts/build-web again");
  }
  return text;
}

std::string page_of(const EmbeddedScene& scene, PageThreads threads) {
  const std::string empty = empty_page(threads);
  const std::size_t at = empty.find(mark);
  std::string text = empty.substr(0, at);
  append_file(text, {"scene.json", scene.scene});
  for (const EmbeddedFile& file : scene.files) append_file(text, file);
  if (!scene.note.empty()) append_element(text, "id=\"embedded-note\"", scene.note);
  return text + empty.substr(at + mark.size());
}

}  // namespace pellucid
