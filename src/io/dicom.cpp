// SPDX-License-Identifier: Apache-2.0
#include "dicom.h"

#include <limits>
#include <memory>
#include <utility>

#include "dicom_folder.h"
#include "dicom_grid.h"
#include "dicom_values.h"
#include "pellucid/scene/error.h"

namespace pellucid {

VolumeFile open_dicom(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  const DicomFolder folder = scan_dicom_folder(path);
  DicomGroup group = choose_dicom_series(folder, path, options.series);
  const DicomImage& image = *group.slices.front().image;
  if (!image.refused.empty()) {
    throw Error(name + ": " + group.slices.front().name() + " is not read: " + image.refused);
  }
  if (group.slices.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw Error(name + ": has too many slices");
  }
  if (folder.others > 0 && options.note && std::filesystem::is_directory(path)) {
    options.note(name + ": " + std::to_string(folder.others) +
                 (folder.others == 1 ? " file holds" : " files hold") + " no DICOM image and " +
                 (folder.others == 1 ? "is" : "are") + " left out");
  }
  if (image.photometric == "MONOCHROME1" && options.note) {
    options.note(name +
                 ": large values are meant to be dark (MONOCHROME1); they are read as they "
                 "are");
  }
  VolumeFile file;
  file.description = place_dicom_slices(group.slices, options, name);
  value_count(
      {image.format.columns, image.format.rows, static_cast<std::int64_t>(group.slices.size())},
      name);
  apply_overrides(options, file.description);
  file.components = image.format.samples;
  file.holds = image.format.samples == 3 ? "colors (RGB)"
                                         : std::to_string(image.format.samples) + " samples";
  const auto slices = std::make_shared<const std::vector<DicomSlice>>(std::move(group.slices));
  file.read = [slices, name](ComponentRange range) {
    return read_dicom_values(*slices, range, name);
  };
  return file;
}

}  // namespace pellucid
