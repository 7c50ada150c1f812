// SPDX-License-Identifier: Apache-2.0
#include "volume_format.h"

#include <algorithm>
#include <string>

#include "files/input_file.h"
#include "medical_volumes.h"
#include "text/text.h"

namespace pellucid {

const VolumeFormat nifti_format{.open = open_nifti, .is_of_patients = true};

const VolumeFormat npy_format{
    .open = [](const std::filesystem::path& path,
               const ReadOptions& options) { return open_npy(file_source(path), options); },
    .takes_axes = true};

const VolumeFormat raw_format{
    .open = [](const std::filesystem::path& path,
               const ReadOptions& options) { return open_raw(file_source(path), options); },
    .has_header = false};

const VolumeFormat raw_gzip_format{.open = open_raw_gzip, .has_header = false};

const VolumeFormat* volume_format_by_name(std::string_view file_name) {
  const std::string name = in_small_letters(std::string(file_name));
  const auto extensions = volume_format_extensions();
  const auto found = std::ranges::find_if(
      extensions, [&](const VolumeExtension& known) { return name.ends_with(known.text); });
  return found == extensions.end() ? nullptr : found->format;
}

std::string volume_extensions() {
  std::string known;
  for (const VolumeExtension& extension : volume_format_extensions()) {
    known += (known.empty() ? "" : " ") + std::string(extension.text);
  }
  return known;
}

bool has_volume_header(std::string_view file_name) {
  const VolumeFormat* const format = volume_format_by_name(file_name);
  return format != nullptr && format->has_header;
}

}  // namespace pellucid
