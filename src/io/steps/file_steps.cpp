// SPDX-License-Identifier: Apache-2.0
#include "file_steps.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "axes/time_steps.h"
#include "files/input_file.h"
#include "files/numbered_files.h"
#include "meshes/mesh_blocks.h"
#include "pellucid/scene/error.h"
#include "text/json_file.h"
#include "text/printable.h"
#include "text/text.h"
#include "volumes/volume_format.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

bool is_series_list(const fs::path& path) {
  return in_small_letters(path.extension().string()) == ".series";
}

double number_of(const NameNumber& number) {
  return static_cast<double>(number.mantissa) * std::pow(10.0, -number.fraction_digits);
}

/// Returns the number of a name by a pattern; nothing where it does not fit. `*` stands for a
/// number.
std::optional<double> number_by(const std::string& pattern, const std::string& name) {
  std::optional<NameNumber> number;
  const std::size_t star = pattern.find('*');
  if (star == std::string::npos) {
    const std::optional<NamePattern> written = name_pattern(pattern);
    if (written) number = written->number(name);
  } else {
    const std::string before = pattern.substr(0, star), behind = pattern.substr(star + 1);
    const bool fits = name.size() > before.size() + behind.size() && name.starts_with(before) &&
                      name.ends_with(behind);
    if (fits) {
      number = name_number(std::string_view(name).substr(
          before.size(), name.size() - before.size() - behind.size()));
    }
  }
  if (!number) return std::nullopt;
  return number_of(*number);
}

/// Returns whether a name is a pattern of one number, of files that are no slices.
bool is_pattern(const std::string& name) {
  const VolumeFormat* const format = volume_format_by_name(name);
  if (format != nullptr && format->takes_other_folders) return false;
  if (std::ranges::count(name, '*') > 0) {
    return std::ranges::count(name, '*') == 1;
  }
  return name_pattern(name).has_value();
}

std::vector<FileStep> files_of_pattern(const fs::path& path) {
  const fs::path folder = path.parent_path();
  const std::string pattern = path.filename().string();
  std::vector<FileStep> steps;
  const auto fits = [&](const std::string& name) { return number_by(pattern, name).has_value(); };
  for (const fs::path& file : files_in(folder.empty() ? fs::path(".") : folder, fits)) {
    steps.push_back({*number_by(pattern, file.filename().string()), folder / file.filename()});
  }
  return steps;
}

/// Returns an attribute of an element, as a number.
std::optional<double> number_attribute(std::string_view element, const std::string& key) {
  const std::size_t at = element.find(" " + key + "=\"");
  if (at == std::string_view::npos) return std::nullopt;
  const std::size_t begin = at + key.size() + 3, end = element.find('"', begin);
  if (end == std::string_view::npos) return std::nullopt;
  return number_of_word<double>(std::string(element.substr(begin, end - begin)));
}

/// Returns the TimeValue of a file of XML, as text or as the range of the one value.
std::optional<double> time_in_xml(std::string_view head) {
  const std::size_t name = head.find("Name=\"TimeValue\"");
  if (name == std::string_view::npos) return std::nullopt;
  const std::size_t begin = head.rfind('<', name), end = head.find('>', name);
  if (begin == std::string_view::npos || end == std::string_view::npos) return std::nullopt;
  const std::string_view element = head.substr(begin, end - begin);
  const std::optional<double> least = number_attribute(element, "RangeMin"),
                              most = number_attribute(element, "RangeMax");
  if (least && least == most) return least;
  if (element.find("format=\"ascii\"") == std::string_view::npos) return std::nullopt;
  const std::string_view text = head.substr(end + 1, head.find('<', end) - end - 1);
  return number_of_word<double>(std::string(trimmed(text, " \t\r\n")));
}

/// Returns the TimeValue of a legacy file.
std::optional<double> time_in_legacy(std::string_view head) {
  constexpr std::string_view key = "\nTimeValue 1 1 ";
  const std::size_t at = head.find(key);
  if (at == std::string_view::npos) return std::nullopt;
  const std::size_t line = head.find('\n', at + key.size());
  if (line == std::string_view::npos) return std::nullopt;
  const std::string_view type = trimmed(head.substr(at + key.size(), line - at - key.size()));
  const std::string_view behind = head.substr(line + 1);
  if (head.find("\nBINARY") == std::string_view::npos) {
    return number_of_word<double>(std::string(trimmed(behind.substr(0, behind.find('\n')))));
  }
  const auto big_endian = [&](auto number) -> std::optional<double> {
    std::array<char, sizeof(number)> bytes{};
    if (behind.size() < bytes.size()) return std::nullopt;
    std::memcpy(bytes.data(), behind.data(), bytes.size());
    if constexpr (std::endian::native == std::endian::little) std::ranges::reverse(bytes);
    std::memcpy(&number, bytes.data(), bytes.size());
    return static_cast<double>(number);
  };
  if (type == "double") return big_endian(double{});
  return type == "float" ? big_endian(float{}) : std::nullopt;
}

/// Returns the time that a file of VTK's states; nothing where it states none.
std::optional<double> stated_time(const fs::path& file) {
  constexpr std::size_t longest = std::size_t{1} << 16;
  const std::string head = first_bytes(file, longest);
  std::optional<double> time;
  if (head.starts_with("<")) time = time_in_xml(head);
  if (head.starts_with("# vtk DataFile")) time = time_in_legacy(head);
  return time && std::isfinite(*time) ? time : std::nullopt;
}

/// Puts the times that the files state in the place of their numbers, if all state one.
void take_stated_times(std::vector<FileStep>& steps) {
  std::vector<double> times;
  for (const FileStep& step : steps) {
    const std::optional<double> time = stated_time(step.file);
    if (!time) return;
    times.push_back(*time);
  }
  for (std::size_t i = 0; i < steps.size(); ++i) steps[i].time = times[i];
}

std::vector<FileStep> files_of_list(const fs::path& path) {
  const JsonFile list = read_data_json(path);
  const scene_json::Node files = list.root().at("files", "give the files of the series");
  std::vector<FileStep> steps;
  for (std::size_t i = 0; i < files.array_size(); ++i) {
    const scene_json::Node entry = files.element(i);
    FileStep step;
    step.file = path_inside(path.parent_path(),
                            entry.at("name", "give the name of a file").string(), path.string());
    const std::string extension = in_small_letters(step.file.extension().string());
    if (extension == ".series" || extension == ".pvd") {
      entry.fail_at("name", "is a list itself; give the files that it lists");
    }
    step.time = entry.at("time", "give the time of the file").number();
    steps.push_back(std::move(step));
  }
  if (steps.empty()) throw Error(path.string() + ": lists no file");
  return steps;
}

}  // namespace

bool lists_file_steps(const fs::path& path) {
  std::error_code error;
  if (is_series_list(path)) return fs::is_regular_file(path, error);
  const std::string name = path.filename().string();
  if (name.find_first_of("*%") == std::string::npos) return false;
  return is_pattern(name) && !fs::exists(path, error);
}

std::vector<FileStep> file_steps(const fs::path& path) {
  std::vector<FileStep> steps = is_series_list(path) ? files_of_list(path) : files_of_pattern(path);
  if (steps.empty()) {
    throw Error(path.string() +
                ": no file has a name of this pattern; a number stands for * or %04d");
  }
  if (!is_series_list(path)) take_stated_times(steps);
  std::ranges::stable_sort(steps, {}, &FileStep::time);
  const auto twice = std::ranges::adjacent_find(steps, {}, &FileStep::time);
  if (twice != steps.end()) {
    throw Error(path.string() + ": " + printable(twice->file.filename().string()) + " and " +
                printable((twice + 1)->file.filename().string()) +
                " have the same time; give one of them another");
  }
  return steps;
}

const FileStep& nearest_file(const std::vector<FileStep>& steps, std::optional<double> time,
                             const fs::path& path) {
  if (time && !std::isfinite(*time)) {
    throw Error(path.string() + ": the time is no finite number; give that of a step");
  }
  return steps[nearest_step(times_of(steps), time)];
}

std::vector<double> times_of(const std::vector<FileStep>& steps) {
  std::vector<double> times;
  times.reserve(steps.size());
  for (const FileStep& step : steps) times.push_back(step.time);
  return times;
}

VolumeFile open_file_step(const std::vector<FileStep>& steps, const fs::path& path,
                          const ReadOptions& options) {
  const std::string name = path.string();
  const FileStep& step = nearest_file(steps, options.time, path);
  ReadOptions inside = options;
  inside.time.reset();
  const VolumeFormat& format = find_volume_format(step.file, inside);
  if (options.array && format.list == nullptr) {
    throw Error(step.file.string() + ": has no arrays with names; leave the array out");
  }
  VolumeFile file = format.open(step.file, inside);
  if (file.times.size() > 1) {
    throw Error(name + ": " + printable(step.file.filename().string()) +
                " has steps in time of its own, of which a list chooses none; give it alone");
  }
  file.times = times_of(steps);
  if (!options.note || steps.size() < 2) return file;
  if (options.time) {
    const auto number = static_cast<std::size_t>(&step - steps.data());
    options.note(name + ": " + step_note(file.times, number, *options.time));
  } else {
    options.note(name + ": the first is read of " + times_note(file.times));
  }
  return file;
}

std::vector<VolumeArray> list_file_step(const std::vector<FileStep>& steps, const fs::path& path,
                                        const ReadOptions& options) {
  const FileStep& step = nearest_file(steps, options.time, path);
  ReadOptions inside = options;
  inside.time.reset();
  const auto list = find_volume_format(step.file, inside).list;
  return list == nullptr ? std::vector<VolumeArray>{} : list(step.file, inside);
}

extern const VolumeFormat file_steps_format{
    .name = "files that are steps in time",
    .takes_path = lists_file_steps,
    .open =
        [](const fs::path& path, const ReadOptions& options) {
          return open_file_step(file_steps(path), path, options);
        },
    .list =
        [](const fs::path& path, const ReadOptions& options) {
          return list_file_step(file_steps(path), path, options);
        },
    .has_times = true};

}  // namespace pellucid
