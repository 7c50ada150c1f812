// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/read_mesh.h"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

#include "files/input_file.h"
#include "files/memory_limit.h"
#include "mesh_format.h"
#include "pellucid/scene/error.h"
#include "text/text.h"
#include "vtk/vtk_collection.h"
#include "vtk/vtk_file_kind.h"

namespace pellucid {

namespace {

/// Returns the first format for which `takes` returns true; null: there is none.
template <class Takes>
const MeshFormat* first_format(const Takes& takes) {
  const auto formats = mesh_formats();
  const auto found =
      std::ranges::find_if(formats, [&](const MeshFormat* format) { return takes(*format); });
  return found == formats.end() ? nullptr : *found;
}

const MeshFormat* format_by_extension(const std::filesystem::path& path) {
  const std::string extension = in_small_letters(path.extension().string());
  return first_format([&](const MeshFormat& known) {
    return any_word(known.extensions, [&](std::string_view end) { return extension == end; });
  });
}

const MeshFormat* format_by_content(const std::filesystem::path& path) {
  constexpr std::size_t longest = std::size_t{1} << 16;
  const std::string head = first_bytes(path, longest);
  return first_format([&](const MeshFormat& known) {
    return known.takes_content != nullptr && known.takes_content(path, head);
  });
}

const MeshFormat& format_of(const std::filesystem::path& path, const MeshReadOptions& options) {
  const MeshFormat* format = nullptr;
  if (!options.q.empty()) {
    format = first_format([](const MeshFormat& known) { return known.takes_solution; });
  }
  if (format == nullptr) format = format_by_content(path);
  if (format == nullptr) format = format_by_extension(path);
  if (format != nullptr) return *format;
  throw Error(path.string() + ": is no mesh by its name or its first bytes; read are " +
              mesh_extensions());
}

MeshBlocks read_blocks(const std::filesystem::path& path, const MeshReadOptions& options) {
  const std::uintmax_t bytes = check_input_file(path);
  // VTK's copy beside ours; what is compressed takes more.
  check_memory(2 * bytes, path.string() + ": its mesh");
  return format_of(path, options).read(path, options);
}

}  // namespace

bool is_mesh_file(const std::filesystem::path& path) {
  const std::optional<VtkFileKind> kind = vtk_file_kind(path);
  if ((kind && kind->is_volume()) || is_image_collection(path)) return false;
  const MeshFormat* const by_extension = format_by_extension(path);
  // Of the others of its kind the reader of volumes says what they are.
  if (by_extension != nullptr && by_extension->content_decides && std::filesystem::exists(path)) {
    return format_by_content(path) == by_extension;
  }
  return by_extension != nullptr || format_by_content(path) != nullptr;
}

std::string mesh_extensions() {
  std::string text;
  for (const MeshFormat* const format : mesh_formats()) {
    text += (text.empty() ? "" : " ") + std::string(format->extensions);
  }
  return text;
}

MeshFile read_mesh(const std::filesystem::path& path, const MeshReadOptions& options) {
  const auto refuse = [&]() -> Error {
    return Error(path.string() + ": not enough memory for the mesh; split the file or make room");
  };
  try {
    MeshFile file = join_blocks(read_blocks(path, options), path.string());
    for (const std::string& note : file.notes) {
      if (options.note) options.note(note);
    }
    return file;
  } catch (const std::bad_alloc&) {
    throw refuse();
  } catch (const std::length_error&) {
    throw refuse();
  }
}

std::vector<double> mesh_times(const std::filesystem::path& path, const MeshReadOptions& options) {
  check_input_file(path);
  const auto times = format_of(path, options).times;
  return times == nullptr ? std::vector<double>{} : times(path);
}

const MeshArray& default_array(const MeshFile& file) {
  const std::vector<MeshArray>& arrays = file.grid.arrays;
  if (arrays.empty()) {
    throw Error(file.grid.name + ": has no array of numbers to show" +
                (file.format == "PLOT3D" ? "; give its solution (q) too" : ""));
  }
  const auto named = std::ranges::find_if(
      arrays, [&](const MeshArray& a) { return !file.active.empty() && a.name == file.active; });
  if (named != arrays.end()) return *named;
  const auto scalar = std::ranges::find_if(arrays, [](const MeshArray& a) {
    return a.centering == Centering::point && a.components == 1;
  });
  return scalar != arrays.end() ? *scalar : arrays.front();
}

}  // namespace pellucid
