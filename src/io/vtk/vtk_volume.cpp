// SPDX-License-Identifier: Apache-2.0
#include "vtk_volume.h"

#include <cstddef>
#include <cstring>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "files/input_file.h"
#include "files/memory_limit.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/scene/error.h"
#include "process/child_process.h"
#include "process/child_values.h"
#include "volumes/volume_format.h"
#include "volumes/volume_source.h"
#include "vtk_file_kind.h"
#include "vtk_files.h"
#include "vtk_module.h"
#include "vtk_volume_answer.h"
#include "vtk_volume_open.h"

namespace pellucid {

namespace {

/// Runs `work`, which calls VTK, in a process of its own. Throws Error where it fails.
ChildBytes run_vtk(const std::filesystem::path& path,
                   const std::function<void(const MakeAnswer&)>& work) {
  const std::uintmax_t bytes = bytes_of_vtk_files(path);
  try {
    check_vtk_module();
  } catch (const Error& error) {
    throw Error(path.string() + ": " + error.what());
  }
  ChildBytes answer = answer_in_child(
      [&](const MakeAnswer& make) {
        work(make);
        return true;
      },
      bytes, memory_for_vtk(bytes));
  if (!answer) throw Error(path.string() + ": " + vtk_fails);
  return answer;
}

template <class Answer>
Answer checked(std::optional<Answer>&& answer, const std::filesystem::path& path) {
  if (!answer) throw Error(path.string() + ": " + vtk_fails);
  return *std::move(answer);
}

/// Reads the components of the wanted part of a volume whose head has been read.
std::vector<VolumeData> read_part(const std::filesystem::path& path, const OpenedVtkVolume& opened,
                                  ComponentRange range, const Note& note) {
  const std::string& name = opened.description.name;
  const std::size_t points = value_count(
      range.part != nullptr ? range.part->box : IndexBox{{0, 0, 0}, opened.description.dimensions});
  const std::size_t size = value_size(opened.type, name);
  const std::size_t bytes = value_count(points, range.number, name) * size;
  check_memory(bytes, name + ": its values");
  // Behind the values stands how far pieces disagree.
  PieceDifferences differences;
  const ChildBytes answer = run_vtk(path, [&](const MakeAnswer& make) {
    const std::span<std::byte> to = make(bytes + sizeof(differences));
    differences = read_part_here(path, opened, range, to.first(bytes));
    std::memcpy(to.data() + bytes, &differences, sizeof(differences));
  });
  if (answer.size != bytes + sizeof(differences)) throw Error(name + ": " + vtk_fails);
  std::memcpy(&differences, answer.data.get() + bytes, sizeof(differences));
  if (note && differences.count > 0) note(name + ": " + differences.note("first"));
  std::vector<VolumeData> components;
  for (std::size_t c = 0; c < static_cast<std::size_t>(range.number); ++c) {
    components.push_back(child_values(answer.data, c * points * size, points, opened.type));
  }
  return components;
}

}  // namespace

VolumeFile open_vtk_volume(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  const ChildBytes answer =
      run_vtk(path, [&](const MakeAnswer& make) { write_opened(open_here(path, options), make); });
  OpenedVtkVolume opened = checked(read_opened(answer, name), path);
  opened.time = options.time;
  for (const std::string& note : opened.notes) {
    if (options.note) options.note(name + ": " + note);
  }
  VolumeFile file;
  file.description = opened.description;
  file.components = opened.components;
  file.array = opened.array;
  file.times = opened.times;
  file.holds = std::to_string(file.components) + " components (array \"" + file.array + "\")";
  file.reads_parts = opened.reads_parts;
  if (file.reads_parts) {
    file.read = [path, opened = std::move(opened), note = options.note](ComponentRange range) {
      return read_part(path, opened, range, note);
    };
  } else {
    file.read = [values = std::move(opened.values), components = opened.components,
                 name](ComponentRange range) {
      return split_components(values, components, range, name);
    };
  }
  return file;
}

std::vector<VolumeArray> list_vtk_arrays(const std::filesystem::path& path) {
  const ChildBytes answer =
      run_vtk(path, [&](const MakeAnswer& make) { write_arrays(list_here(path), make); });
  return checked(read_arrays(answer), path);
}

/// Files of whatever name by their first bytes; headerless data may begin with any.
extern const VolumeFormat vtk_format{
    .name = "VTK",
    .extensions = ".vti .pvti .vtr .pvtr .vtk",
    .content_owner =
        [](const std::filesystem::path& path, const VolumeFormat* by_name) {
          const std::optional<VtkFileKind> kind = vtk_file_kind(path);
          const bool is_ours =
              kind && kind->is_volume() && (by_name == nullptr || by_name->has_header);
          return is_ours ? ContentOwner::this_format : ContentOwner::others;
        },
    .refuses = is_mesh_file,
    .open = open_vtk_volume,
    .list = [](const std::filesystem::path& path,
               const ReadOptions&) { return list_vtk_arrays(path); },
    .has_times = true};

}  // namespace pellucid
