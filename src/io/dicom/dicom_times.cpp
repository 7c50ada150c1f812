// SPDX-License-Identifier: Apache-2.0
#include "dicom_times.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <system_error>

#include "dicom_marks.h"
#include "text/text.h"

namespace pellucid {

namespace {

/// A mark of time, and what its numbers are.
struct TimeMark {
  std::string_view name;
  const char* unit;
  bool is_of_day = false;  ///< "101530.5", of which a volume has several
};
constexpr std::array time_marks =
    std::to_array<TimeMark>({{"FrameReferenceTime", "ms (FrameReferenceTime)", false},
                             {"TriggerTime", "ms (TriggerTime)", false},
                             {"TemporalPosition", "(TemporalPositionIdentifier)", false},
                             {"AcquisitionTime", "s after midnight (AcquisitionTime)", true}});

std::size_t index_of(std::string_view name) {
  const auto found = std::ranges::find(
      dicom_marks, name, [](const DicomMark& mark) { return std::string_view(mark.name); });
  return static_cast<std::size_t>(found - dicom_marks.begin());
}

/// Returns the seconds of "101530.5", a time of the day.
std::optional<double> seconds_of_day(const std::string& text) {
  constexpr std::size_t shortest = 6;
  if (text.size() < shortest) return std::nullopt;
  const auto hours = number_of_word<double>(text.substr(0, 2)),
             minutes = number_of_word<double>(text.substr(2, 2)),
             seconds = number_of_word<double>(text.substr(4));
  if (!hours || !minutes || !seconds) return std::nullopt;
  return 3600 * *hours + 60 * *minutes + *seconds;
}

/// Returns the time of a volume; nothing where its slices have none, or several.
std::optional<double> time_of(const DicomGroup& volume, const TimeMark& mark) {
  const std::size_t index = index_of(mark.name);
  std::optional<double> time;
  for (const DicomSlice& slice : volume.slices) {
    if (index >= slice.marks.size()) return std::nullopt;
    const std::string text(trimmed(slice.marks[index]));
    const std::optional<double> own =
        mark.is_of_day ? seconds_of_day(text) : number_of_word<double>(text);
    if (!own || !std::isfinite(*own)) return std::nullopt;
    if (time && *time != *own && !mark.is_of_day) return std::nullopt;
    time = time ? std::min(*time, *own) : own;
  }
  return time;
}

/// Returns the times of all volumes, different ones; empty: the mark does not say them.
std::vector<double> times_of(const std::vector<const DicomGroup*>& volumes, const TimeMark& mark) {
  std::vector<double> times;
  for (const DicomGroup* const volume : volumes) {
    const std::optional<double> time = time_of(*volume, mark);
    if (!time) return {};
    times.push_back(*time);
  }
  std::vector<double> sorted = times;
  std::ranges::sort(sorted);
  return std::ranges::adjacent_find(sorted) == sorted.end() ? times : std::vector<double>();
}

/// Returns whether the volumes have different values of a mark that is none of time, such as an
/// echo. Numbers of acquisitions and types of images may count the times.
bool differ_otherwise(const std::vector<const DicomGroup*>& volumes) {
  for (std::size_t mark = 0; mark < dicom_marks.size(); ++mark) {
    const std::string_view name = dicom_marks[mark].name;
    const bool is_time = std::ranges::find(time_marks, name, &TimeMark::name) != time_marks.end() ||
                         name == "AcquisitionNumber";
    if (is_time) continue;
    const std::vector<DicomSlice>& first = volumes.front()->slices;
    for (const DicomGroup* const volume : volumes) {
      for (const DicomSlice& slice : volume->slices) {
        if (mark >= slice.marks.size() || mark >= first.front().marks.size()) continue;
        if (slice.marks[mark] != first.front().marks[mark]) return true;
      }
    }
  }
  return false;
}

}  // namespace

DicomSteps dicom_steps(const DicomFolder& folder, const std::filesystem::path& path,
                       const std::optional<std::string>& wanted) {
  // A number chooses one volume.
  if (wanted && number_of_word<unsigned>(*wanted).value_or(0) - 1U < folder.series.size())
    return {};
  std::error_code error;
  std::string uid;
  for (const DicomGroup& group : folder.series) {
    const bool is_own = std::filesystem::is_directory(path, error)
                            ? !wanted || group.about.uid.ends_with(*wanted)
                            : std::ranges::any_of(group.slices, [&](const DicomSlice& slice) {
                                return slice.image->file.filename() == path.filename();
                              });
    if (!is_own) continue;
    if (!uid.empty() && group.about.uid != uid) return {};  // of several series
    uid = group.about.uid;
  }
  DicomSteps steps;
  for (const DicomGroup& group : folder.series) {
    if (!uid.empty() && group.about.uid == uid) steps.volumes.push_back(&group);
  }
  if (steps.volumes.size() < 2 || differ_otherwise(steps.volumes)) return {};
  for (const TimeMark& mark : time_marks) {
    steps.times = times_of(steps.volumes, mark);
    if (steps.times.empty()) continue;
    steps.unit = mark.unit;
    return steps;
  }
  return {};
}

}  // namespace pellucid
