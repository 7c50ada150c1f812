// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "axes/time_steps.h"
#include "dicom_folder.h"
#include "dicom_grid.h"
#include "dicom_times.h"
#include "dicom_values.h"
#include "meshes/mesh_blocks.h"
#include "pellucid/scene/error.h"
#include "volumes/components.h"
#include "volumes/volume_format.h"

namespace pellucid {

namespace {

/// Tells what is left out, and what is assumed of the series.
void tell(const DicomFolder& folder, const DicomGroup& group, const std::filesystem::path& path,
          const ReadOptions& options) {
  if (!options.note) return;
  const auto note = [&](const std::string& what) { options.note(path.string() + ": " + what); };
  if (folder.others > 0 && std::filesystem::is_directory(path)) {
    note(std::to_string(folder.others) + (folder.others == 1
                                              ? " file holds no DICOM image and is left out"
                                              : " files hold no DICOM image and are left out"));
  }
  if (!folder.damaged.empty()) note(left_out_text(folder.damaged));
  std::vector<std::string> told;
  for (const DicomSlice& slice : group.slices) {
    if (slice.frame != 0) continue;
    for (const std::string& text : slice.image->notes) {
      if (std::ranges::find(told, text) != told.end()) continue;
      note(text);
      told.push_back(text);
    }
  }
  for (const std::string& text : group.notes) note(text);
  const auto inverted = std::ranges::count_if(group.slices, [](const DicomSlice& slice) {
    return slice.image->photometric == "MONOCHROME1";
  });
  if (inverted == std::ssize(group.slices)) {
    note("large values are meant to be dark (MONOCHROME1); they are read as they are");
  } else if (inverted > 0) {
    note("large values are meant to be dark in " + std::to_string(inverted) + " of " +
         std::to_string(group.slices.size()) +
         " slices (MONOCHROME1), and bright in the others; all are read as they are");
  }
}

/// Returns the unit that all slices name; empty where they differ.
std::string unit_of(const std::vector<DicomSlice>& slices) {
  const std::string& unit = slices.front().image->unit;
  const bool same = std::ranges::all_of(
      slices, [&](const DicomSlice& slice) { return slice.image->unit == unit; });
  return same ? unit : std::string();
}

/// Returns the volume of a series whose time is nearest to the one that the options ask for, and
/// tells which.
DicomGroup volume_at_time(const DicomFolder& folder, const std::filesystem::path& path,
                          const ReadOptions& options) {
  const DicomSteps steps = dicom_steps(folder, path, options.series);
  if (steps.volumes.empty()) {
    throw Error(
        path.string() +
        ": has no volumes that differ in time alone (TriggerTime, TemporalPositionIdentifier "
        "and the like); leave the time out");
  }
  const std::size_t step = nearest_step(steps.times, options.time);
  if (options.note) {
    options.note(path.string() + ": " + step_note(steps.times, step, *options.time, steps.unit));
  }
  return *steps.volumes[step];
}

/// Returns the times of the volumes of a series; none where it has one. Throws Error where several
/// are no steps.
StepTimes dicom_times(const std::filesystem::path& path, const ReadOptions& options) {
  const DicomFolder folder = scan_dicom_folder(path);
  DicomSteps steps = dicom_steps(folder, path, options.series);
  if (steps.volumes.empty()) choose_dicom_series(folder, path, options.series);
  return {std::move(steps.times), std::move(steps.unit)};
}

/// Opens a series without the files for which reading it threw DamagedDicom.
VolumeFile open_dicom_without(const std::vector<DamagedDicomFile>& damaged,
                              const std::filesystem::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  const DicomFolder folder = scan_dicom_folder(path, damaged);
  DicomGroup group = options.time ? volume_at_time(folder, path, options)
                                  : choose_dicom_series(folder, path, options.series);
  const DicomImage& image = *group.slices.front().image;
  const std::string left_out = left_out_text(folder.damaged);
  const auto fail = [&](const std::string& what) {
    throw Error(name + ": " + what + (left_out.empty() ? "" : "; " + left_out));
  };
  if (!image.refused.empty()) {
    fail(group.slices.front().name() + " is not read: " + image.refused);
  }
  if (group.slices.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    fail("has too many slices");
  }
  if (group.slices.size() == 1 && options.centering != Centering::cell) {
    fail((image.modality == "RTDOSE" ? "holds a single plane of dose"
                                     : "holds a single slice, " + image.file.filename().string()) +
         std::string(", and a volume needs two; give the folder of all slices, or read it with "
                     "cell centering"));
  }
  tell(folder, group, path, options);
  VolumeFile file;
  file.description = place_dicom_slices(group.slices, options, name, !folder.damaged.empty());
  value_count(
      {image.format.columns, image.format.rows, static_cast<std::int64_t>(group.slices.size())},
      name);
  if (group.slices.front().orientation) file.space = patient_space;
  apply_overrides(options, file.description);
  file.components = image.format.samples;
  file.holds = image.format.samples == 3 ? "colors (RGB)"
                                         : std::to_string(image.format.samples) + " samples";
  if (image.format.samples == 3 && image.format.bits_allocated == 8) file.largest_color = 255;
  const auto slices = std::make_shared<const std::vector<DicomSlice>>(std::move(group.slices));
  file.read = [slices, name](ComponentRange range) {
    return read_dicom_values(*slices, range, name);
  };
  return file;
}

/// Opens a DICOM series: a folder with its files, or any one of them. One file per slice, or frames
/// with functional groups or a vector of their positions; sorted by position. The world is LPS, in
/// millimetres. Values are those behind rescale slope and intercept, or the scaling of a dose.
/// Colors are components. Compressed pixels go through GDCM. Damaged files of a folder are left
/// out, and `options.note` is told.
VolumeFile open_dicom(const std::filesystem::path& path, const ReadOptions& options) {
  return open_dicom_without({}, path, options);
}

}  // namespace

std::string dicom_unit(const std::filesystem::path& path,
                       const std::optional<std::string>& series) {
  return unit_of(choose_dicom_series(scan_dicom_folder(path), path, series).slices);
}

extern const VolumeFormat dicom_format{.name = "DICOM",
                                       .extensions = ".dcm .ima",
                                       .takes_folder = is_dicom,
                                       .takes_unknown_name = is_dicom,
                                       .open = open_dicom,
                                       .open_without = open_dicom_without,
                                       .times = dicom_times,
                                       .has_times = true,
                                       .has_series = true,
                                       .is_of_patients = true};

}  // namespace pellucid
