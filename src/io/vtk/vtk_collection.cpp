// SPDX-License-Identifier: Apache-2.0
#include "vtk_collection.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/scene/error.h"
#include "steps/file_steps.h"
#include "text/text.h"
#include "text/xml_scanner.h"
#include "volumes/volume_format.h"
#include "vtk_file_kind.h"
#include "vtk_volume.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t largest_list = std::size_t{1} << 26;  // bytes

bool is_adaptive(const std::string& kind) {
  constexpr std::array<std::string_view, 4> adaptive{"vtkHierarchicalBoxDataSet",
                                                     "vtkOverlappingAMR", "vtkNonOverlappingAMR",
                                                     "vtkUniformGridAMR"};
  return std::ranges::find(adaptive, kind) != adaptive.end();
}

/// Returns the file's kind where it lists others.
std::optional<std::string> collection_kind(const fs::path& path) {
  const std::optional<VtkFileKind> kind = vtk_file_kind(path);
  if (!kind || !kind->xml) return std::nullopt;
  if (is_adaptive(kind->data) || kind->data == "vtkMultiBlockDataSet" ||
      kind->data == "Collection") {
    return kind->data;
  }
  return std::nullopt;
}

/// Returns the files that the elements DataSet name, as they are named.
std::vector<std::string> names_in(const fs::path& path) {
  const std::string name = path.string();
  const std::string text = read_text_file(path, largest_list);
  XmlScanner scanner(text, name);
  std::vector<std::string> names;
  while (const std::optional<XmlTag> tag = scanner.next()) {
    // What may be in the file behind is no list.
    if (tag->name == "AppendedData") break;
    const auto file = tag->attributes.find("file");
    if (tag->name != "DataSet" || tag->closes || file == tag->attributes.end()) continue;
    names.emplace_back(file->second);
  }
  return names;
}

/// Returns the number that a text is, and nothing else.
std::optional<double> number_of(const std::string& text) {
  const std::string bare(trimmed(text));
  double number = 0;
  const char* const end = bare.data() + bare.size();
  const auto result = std::from_chars(bare.data(), end, number);
  if (bare.empty() || result.ec != std::errc() || result.ptr != end || !std::isfinite(number)) {
    return std::nullopt;
  }
  return number;
}

bool is_image(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return false;
  const std::optional<VtkFileKind> kind = vtk_file_kind(path);
  return kind && kind->is_volume();
}

std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  constexpr std::size_t most = 5;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) {
    list += (i == 0 ? "" : ", ") + names[i].substr(0, 100);
  }
  return list + (names.size() > most ? ", …" : "");
}

fs::path only_image(const fs::path& path) {
  const std::string kind = collection_kind(path).value_or("");
  std::vector<std::string> names = names_in(path);
  if (is_adaptive(kind)) {
    throw Error(path.string() + ": is adaptive (" + kind + "), voxels of several sizes, which is " +
                "not read; resample it to an image" +
                (names.empty() ? "" : ", or give one of its files: " + list_of(names)));
  }
  if (names.size() != 1) {
    throw Error(path.string() + ": lists " + std::to_string(names.size()) +
                " files, images among them, of which one is read at a time; give one of them: " +
                list_of(names));
  }
  return path.parent_path() / names.front();
}

}  // namespace

namespace {

/// Returns the images of a list by time, one at each; empty: it is no such list.
std::vector<FileStep> image_steps(const fs::path& path) {
  if (collection_kind(path) != "Collection") return {};
  std::vector<FileStep> steps;
  try {
    for (const ListedStep& step : steps_of_list(path)) {
      steps.push_back({step.time, path.parent_path() / step.file});
    }
  } catch (const Error& error) {
    throw Error(path.string() + ": " + error.what());
  }
  const bool is_one_each = std::ranges::adjacent_find(steps, {}, &FileStep::time) == steps.end();
  if (is_one_each) return steps;
  if (std::ranges::none_of(steps, [](const FileStep& step) { return is_image(step.file); })) {
    return {};
  }
  const auto twice = std::ranges::adjacent_find(steps, {}, &FileStep::time);
  throw Error(path.string() + ": lists " + std::to_string(steps.size()) +
              " files, images among them, of which one is read at each time, but " +
              one_line(twice->file.filename().string()) + " and " +
              one_line((twice + 1)->file.filename().string()) +
              " have the same; give one of them another timestep, or open one of them: " +
              list_of(names_in(path)));
}

}  // namespace

bool is_image_collection(const fs::path& path) {
  const std::optional<std::string> kind = collection_kind(path);
  if (!kind) return false;
  if (is_adaptive(*kind)) return true;
  try {
    return std::ranges::any_of(names_in(path), [&](const std::string& name) {
      return is_image(path.parent_path() / name);
    });
  } catch (const Error&) {
    return false;  // whoever reads it as a mesh says what is wrong
  }
}

std::vector<ListedStep> steps_of_list(const fs::path& path) {
  const std::string text = read_text_file(path, largest_list);
  XmlScanner scanner(text, path.filename().string());
  std::vector<ListedStep> steps;
  while (const std::optional<XmlTag> tag = scanner.next()) {
    if (tag->name != "DataSet" || tag->closes) continue;
    const auto file = tag->attributes.find("file"), time = tag->attributes.find("timestep");
    if (file == tag->attributes.end() || file->second.empty()) continue;
    ListedStep step;
    step.file = xml_text(file->second);
    const std::string extension = fs::path(step.file).extension().string();
    if (extension == ".pvd" || extension == ".series") {
      throw Error("names the list " + one_line(step.file) +
                  "; name the files that it lists, as a list in a list is not read");
    }
    if (time != tag->attributes.end()) {
      const std::optional<double> number = number_of(std::string(time->second));
      if (!number) {
        throw Error("the timestep of " + one_line(step.file) + " is no number; correct the file");
      }
      step.time = *number;
    }
    steps.push_back(std::move(step));
  }
  if (steps.empty()) throw Error("its Collection names no file; it is damaged");
  std::ranges::stable_sort(steps, {}, &ListedStep::time);
  return steps;
}

extern const VolumeFormat image_collection_format{
    .name = "VTK, a list of images",
    .content_owner =
        [](const fs::path& path, const VolumeFormat*) {
          return is_image_collection(path) ? ContentOwner::this_format : ContentOwner::others;
        },
    .open =
        [](const fs::path& path, const ReadOptions& options) {
          const std::vector<FileStep> steps = image_steps(path);
          return steps.empty() ? open_vtk_volume(only_image(path), options)
                               : open_file_step(steps, path, options);
        },
    .list =
        [](const fs::path& path, const ReadOptions& options) {
          const std::vector<FileStep> steps = image_steps(path);
          return steps.empty() ? list_vtk_arrays(only_image(path))
                               : list_file_step(steps, path, options);
        },
    .has_times = true};

}  // namespace pellucid
