// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/read_mesh.h"

#include <algorithm>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "axes/time_steps.h"
#include "files/input_file.h"
#include "files/memory_limit.h"
#include "mesh_format.h"
#include "pellucid/scene/error.h"
#include "steps/file_steps.h"
#include "text/text.h"
#include "volumes/volume_steps.h"
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

MeshBlocks read_step(const std::filesystem::path& path, const MeshReadOptions& options) {
  if (lists_file_steps(path)) {
    const std::vector<FileStep> steps = file_steps(path);
    const FileStep& step = nearest_file(steps, options.time, path);
    MeshReadOptions inside = options;
    inside.time.reset();
    MeshBlocks mesh = read_step(step.file, inside);
    if (mesh.file.times.size() > 1) {
      throw Error(path.string() + ": " + step.file.filename().string() +
                  " has steps in time of its own, of which a list chooses none; give it alone");
    }
    mesh.file.times = times_of(steps);
    mesh.file.time = step.time;
    return mesh;
  }
  const std::uintmax_t bytes = check_input_file(path);
  // VTK's copy beside ours; what is compressed takes more.
  check_memory(2 * bytes, path.string() + ": its mesh");
  return format_of(path, options).read(path, options);
}

bool are_equal(const Vec3<double>& a, const Vec3<double>& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

bool have_same_cells(const UnstructuredGrid& a, const UnstructuredGrid& b) {
  return std::ranges::equal(a.points, b.points, are_equal) && a.shapes == b.shapes &&
         a.corners == b.corners && a.layouts == b.layouts;
}

/// Puts values between those of two steps into the blocks of the first. Arrays that one of them
/// lacks are left out, with a note.
void put_between(MeshBlocks& before, const MeshBlocks& after, double share,
                 const std::string& name) {
  const bool are_alike = std::ranges::equal(before.blocks, after.blocks, have_same_cells);
  if (!are_alike) {
    throw Error(name +
                ": the steps around the time have different points or cells, so nothing is linear "
                "between them; take the nearest step");
  }
  const auto size = [](const MeshArray& array) {
    return std::visit([](const auto& values) { return values.size(); }, array.values);
  };
  std::vector<std::string> left_out;
  for (std::size_t b = 0; b < before.blocks.size(); ++b) {
    const std::vector<MeshArray>& others = after.blocks[b].arrays;
    std::erase_if(before.blocks[b].arrays, [&](MeshArray& array) {
      const auto other = std::ranges::find_if(others, [&](const MeshArray& one) {
        return one.name == array.name && one.centering == array.centering &&
               one.components == array.components && size(one) == size(array);
      });
      if (other != others.end()) {
        array.values = values_between(array.values, other->values, share);
        return false;
      }
      if (std::ranges::find(left_out, array.name) == left_out.end()) {
        left_out.push_back(array.name);
      }
      return true;
    });
  }
  for (const std::string& array : left_out) {
    before.file.notes.push_back("the array \"" + array +
                                "\" is in one of the two steps alone, and left out");
  }
}

MeshBlocks read_blocks(const std::filesystem::path& path, const MeshReadOptions& options) {
  if (options.time_between != TimeBetween::linear) return read_step(path, options);
  if (!options.time) {
    throw Error(path.string() + ": linear between steps in time needs a time; give one");
  }
  const std::optional<MomentBetween> moment =
      moment_between(mesh_times(path, options), *options.time);
  if (!moment) return read_step(path, options);
  MeshReadOptions at = options;
  at.time = moment->before;
  MeshBlocks mesh = read_step(path, at);
  at.time = moment->after;
  const MeshBlocks after = read_step(path, at);
  put_between(mesh, after, moment->share, path.string());
  for (const std::string& note : after.file.notes) {
    if (std::ranges::find(mesh.file.notes, note) == mesh.file.notes.end()) {
      mesh.file.notes.push_back(note);
    }
  }
  mesh.file.notes.push_back(moment_note(*moment, *options.time));
  mesh.file.time = options.time;
  return mesh;
}

}  // namespace

bool is_mesh_file(const std::filesystem::path& path) {
  if (lists_file_steps(path)) {
    try {
      return is_mesh_file(file_steps(path).front().file);
    } catch (const Error&) {
      return false;  // whoever reads it as a volume says what is wrong
    }
  }
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
    file.times = ascending_times(std::move(file.times));
    const auto step = std::ranges::find(file.times, file.time.value_or(0));
    if (options.note && options.time && file.time && file.times.size() > 1 &&
        step != file.times.end() && options.time_between == TimeBetween::nearest) {
      const auto number = static_cast<std::size_t>(step - file.times.begin());
      options.note(path.string() + ": " + step_note(file.times, number, *options.time));
    }
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
  if (lists_file_steps(path)) return times_of(file_steps(path));
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
