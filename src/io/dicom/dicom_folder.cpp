// SPDX-License-Identifier: Apache-2.0
#include "dicom_folder.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <system_error>
#include <tuple>

#include "dicom_elements.h"
#include "dicom_volumes.h"
#include "files/input_file.h"
#include "files/numbered_files.h"
#include "pellucid/scene/error.h"
#include "zarr/zarr.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

std::vector<fs::path> files_of(const fs::path& folder) {
  return files_in(folder, [](const std::string&) { return true; });
}

fs::path folder_of(const fs::path& path) {
  if (fs::is_directory(path)) return path;
  check_input_file(path);
  const fs::path folder = path.parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

bool same_orientation(const DicomSlice& a, const DicomSlice& b) {
  if (!a.orientation || !b.orientation) return !a.orientation && !b.orientation;
  // Cosines come with three digits and more.
  constexpr double tolerance = 2e-3;
  return length((*a.orientation)[0] - (*b.orientation)[0]) < tolerance &&
         length((*a.orientation)[1] - (*b.orientation)[1]) < tolerance;
}

bool same_spacing(const DicomSlice& a, const DicomSlice& b) {
  if (!a.spacing || !b.spacing) return !a.spacing && !b.spacing;
  constexpr double tolerance = 1e-4;  // as a share; spacings come with four digits and more
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double x = (*a.spacing)[axis], y = (*b.spacing)[axis];
    if (std::abs(x - y) > tolerance * x) return false;
  }
  return true;
}

bool belong_together(const DicomSlice& a, const DicomSlice& b) {
  return a.image->series == b.image->series && a.image->format == b.image->format &&
         a.image->refused == b.image->refused && same_orientation(a, b) && same_spacing(a, b);
}

// Of a file without slices: whether it had some once, by its name and by what is left of it.
bool should_be_dicom(const fs::path& file) {
  if (fs::is_empty(file)) return true;
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return (extension == ".dcm" || extension == ".ima") && !is_dicom(file_source(file));
}

void add(DicomFolder& folder, DicomSlice slice) {
  auto group = std::ranges::find_if(
      folder.series, [&](const DicomGroup& g) { return belong_together(g.slices.front(), slice); });
  if (group == folder.series.end()) {
    const DicomImage& image = *slice.image;
    folder.series.push_back({{image.series, image.description, image.modality, 0,
                              image.format.columns, image.format.rows, image.refused},
                             {},
                             {}});
    group = folder.series.end() - 1;
  }
  ++group->about.slices;
  group->slices.push_back(std::move(slice));
}

// What a damaged header lacks that other files of the series have; empty: nothing.
std::string lack_of(const DicomSlice& slice) {
  if (!slice.image->refused.empty()) return slice.image->refused;
  if (!slice.orientation) return "it has no usable orientation (ImageOrientationPatient)";
  if (!slice.spacing) return "it has no usable spacing of pixels (PixelSpacing)";
  if (!slice.position) return "it has no usable position (ImagePositionPatient)";
  return {};
}

bool is_complete(const DicomSlice& slice) {
  return lack_of(slice).empty();
}

// Leaves out the files of a series that lack what more of its files have.
template <class AskedFor>
void leave_out_damaged_groups(DicomFolder& folder, const AskedFor& is_asked_for) {
  const auto leave_out = [&](const DicomSlice& slice) {
    const fs::path& file = slice.image->file;
    if (!folder.damaged.empty() && folder.damaged.back().file == file) return;
    folder.damaged.push_back({file, file.string() + " is not read: " + lack_of(slice)});
  };
  const auto complete_slices = [&](const std::string& uid) {
    std::ptrdiff_t count = 0;
    for (const DicomGroup& group : folder.series) {
      if (group.about.uid == uid) count += std::ranges::count_if(group.slices, is_complete);
    }
    return count;
  };
  for (DicomGroup& group : folder.series) {
    if (group.about.uid.empty()) continue;
    const auto lacking =
        std::ssize(group.slices) - std::ranges::count_if(group.slices, is_complete);
    if (lacking == 0 || complete_slices(group.about.uid) <= lacking) continue;
    std::erase_if(group.slices, [&](const DicomSlice& slice) {
      if (is_complete(slice) || is_asked_for(slice.image->file)) return false;
      leave_out(slice);
      return true;
    });
    group.about.slices = static_cast<int>(group.slices.size());
  }
  std::erase_if(folder.series, [](const DicomGroup& group) { return group.slices.empty(); });
  std::ranges::stable_sort(folder.damaged, {}, &DamagedDicomFile::file);
}

// Where none of a series has a position, SliceLocation is the place along the normal.
void place_by_location(DicomGroup& group) {
  const bool has_places = std::ranges::any_of(
      group.slices, [](const DicomSlice& slice) { return slice.position || !slice.location; });
  if (has_places || group.slices.size() < 2) return;
  const auto [least, most] = std::ranges::minmax(
      group.slices, {}, [](const DicomSlice& slice) { return *slice.location; });
  if (*least.location == *most.location) return;
  const auto [row, column] = group.slices.front().orientation.value_or(
      std::array{Vec3<double>{1, 0, 0}, Vec3<double>{0, 1, 0}});
  const Vec3<double> normal = normalized(cross(row, column));
  for (DicomSlice& slice : group.slices) slice.position = normal * *slice.location;
  group.notes.emplace_back(
      "no positions (ImagePositionPatient); the slices stand at their SliceLocation along the "
      "normal");
}

// Makes series of their own of the volumes that one series holds.
void split_volumes(DicomFolder& folder) {
  std::vector<DicomGroup> series;
  for (DicomGroup& group : folder.series) {
    place_by_location(group);
    const DicomGroup whole{group.about, {}, group.notes};
    for (DicomStack& stack : split_dicom_volumes(std::move(group.slices))) {
      DicomGroup& part = series.emplace_back(whole);
      part.about.slices = static_cast<int>(stack.slices.size());
      if (!stack.mark.empty()) {
        std::string& description = part.about.description;
        description += (description.empty() ? "" : ", ") + stack.mark;
      }
      if (!stack.note.empty()) part.notes.push_back(std::move(stack.note));
      part.slices = std::move(stack.slices);
    }
  }
  folder.series = std::move(series);
}

// "2: T1w (MR, 384 slices of 274 x 384)"
std::string listed(const DicomFolder& folder) {
  constexpr std::size_t most = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, folder.series.size()); ++i) {
    const DicomSeries& s = folder.series[i].about;
    text += (i == 0 ? "" : ", ") + std::to_string(i + 1) + ": " +
            (s.description.empty() ? "without a description" : s.description) + " (" +
            (s.modality.empty() ? "" : s.modality + ", ") + std::to_string(s.slices) +
            (s.slices == 1 ? " slice of " : " slices of ") + std::to_string(s.columns) + " x " +
            std::to_string(s.rows) + ")";
  }
  if (folder.series.size() > most) {
    text += " and " + std::to_string(folder.series.size() - most) + " more";
  }
  return text;
}

// The series that the text means, by number, whole UID or end of one.
std::vector<const DicomGroup*> meant(const DicomFolder& folder, const std::string& text) {
  std::vector<const DicomGroup*> found;
  for (const DicomGroup& group : folder.series) {
    if (group.about.uid == text) found.push_back(&group);
  }
  if (!found.empty()) return found;
  std::size_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error == std::errc{} && stop == end && number >= 1 && number <= folder.series.size()) {
    return {&folder.series[number - 1]};
  }
  for (const DicomGroup& group : folder.series) {
    if (!text.empty() && group.about.uid.ends_with(text)) found.push_back(&group);
  }
  return found;
}

}  // namespace

DicomFolder scan_dicom_folder(const fs::path& path, const std::vector<DamagedDicomFile>& known) {
  DicomFolder folder;
  const bool is_folder = fs::is_directory(path);
  const auto is_asked_for = [&](const fs::path& file) {
    return !is_folder && file.filename() == path.filename();
  };
  for (const fs::path& file : files_of(folder_of(path))) {
    const auto leave_out = [&](const std::string& why) {
      if (is_asked_for(file)) throw Error(why);
      folder.damaged.push_back({file, why});
    };
    const auto found = std::ranges::find(known, file, &DamagedDicomFile::file);
    if (found != known.end()) {
      leave_out(found->why);
      continue;
    }
    try {
      std::vector<DicomSlice> slices = read_dicom_slices(file);
      if (slices.empty() && !is_asked_for(file) && should_be_dicom(file)) {
        leave_out(file.string() +
                  (fs::is_empty(file) ? ": is empty"
                                      : ": is no DICOM file, though it is named like one") +
                  "; get it again");
      } else if (slices.empty()) {
        ++folder.others;
      }
      for (DicomSlice& slice : slices) add(folder, std::move(slice));
    } catch (const Error& error) {
      leave_out(error.what());
    }
  }
  leave_out_damaged_groups(folder, is_asked_for);
  split_volumes(folder);
  std::ranges::stable_sort(folder.series, {}, [](const DicomGroup& group) {
    return std::tuple(group.slices.front().image->series_number, group.about.uid);
  });
  return folder;
}

std::string left_out_text(const std::vector<DamagedDicomFile>& files) {
  if (files.empty()) return {};
  if (files.size() == 1) return "1 file is left out: " + files.front().why;
  return std::to_string(files.size()) + " files are left out; the first: " + files.front().why;
}

DicomGroup choose_dicom_series(const DicomFolder& folder, const fs::path& path,
                               const std::optional<std::string>& wanted) {
  const std::string name = path.string();
  const auto fail = [&](const std::string& what) {
    const std::string left_out = left_out_text(folder.damaged);
    throw Error(name + ": " + what + (left_out.empty() ? "" : "; " + left_out));
  };
  if (folder.series.empty()) {
    fail(folder.damaged.empty()
             ? "holds no DICOM file with pixels; folders within are not looked into"
             : "holds no DICOM file with pixels that can be read");
  }
  std::vector<const DicomGroup*> found;
  if (wanted) {
    found = meant(folder, *wanted);
  } else {
    for (const DicomGroup& group : folder.series) {
      const bool has_file = std::ranges::any_of(group.slices, [&](const DicomSlice& slice) {
        return slice.image->file.filename() == path.filename();
      });
      if (fs::is_directory(path) || has_file) found.push_back(&group);
    }
  }
  if (found.size() == 1) return *found.front();
  const std::string all = std::to_string(folder.series.size()) + " DICOM series, " + listed(folder);
  if (wanted) {
    fail(std::string(found.empty() ? "none" : "more than one") + " of its series is meant by \"" +
         *wanted + "\"; there are " + all + "; choose by number, UID or the unique end of one");
  }
  if (found.empty()) throw Error(name + ": has no pixels; beside it are " + all);
  fail("holds " + all + "; choose one of them as the series, by number or UID");
  return {};
}

bool is_dicom(const fs::path& path) {
  std::error_code error;
  if (fs::is_regular_file(path, error)) return is_dicom(file_source(path));
  // Stores of Zarr may have a million files, whose bytes may be any.
  if (!fs::is_directory(path, error) || is_zarr(path)) return false;
  return std::ranges::any_of(files_of(path), [](const fs::path& file) {
    try {
      return is_dicom(file_source(file));
    } catch (const Error&) {
      return false;  // told of when the folder is read
    }
  });
}

std::vector<DicomSeries> list_dicom_series(const fs::path& path,
                                           const std::function<void(const std::string&)>& note) {
  const DicomFolder folder = scan_dicom_folder(path);
  if (note && !folder.damaged.empty()) note(path.string() + ": " + left_out_text(folder.damaged));
  std::vector<DicomSeries> list;
  for (const DicomGroup& group : folder.series) list.push_back(group.about);
  return list;
}

}  // namespace pellucid
