// SPDX-License-Identifier: Apache-2.0
//
// Stands in for volume_formats.cpp in builds for a first picture: the formats of first pictures.
#include <array>
#include <string>
#include <system_error>

#include "files/input_file.h"
#include "pellucid/scene/left_out.h"
#include "volume_format.h"

namespace pellucid {

namespace {

constexpr std::array extensions{
    VolumeExtension{".nii", &nifti_format},      VolumeExtension{".nii.gz", &nifti_format},
    VolumeExtension{".hdr", &nifti_format},      VolumeExtension{".hdr.gz", &nifti_format},
    VolumeExtension{".img", &nifti_format},      VolumeExtension{".img.gz", &nifti_format},
    VolumeExtension{".npy", &npy_format},        VolumeExtension{".raw", &raw_format},
    VolumeExtension{".raw.gz", &raw_gzip_format}};

}  // namespace

std::span<const VolumeExtension> volume_format_extensions() {
  return extensions;
}

const VolumeFormat& find_volume_format(const std::filesystem::path& path,
                                       const ReadOptions& options) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) {
    check_input_file(path);
    const VolumeFormat* const format = volume_format_by_name(path.filename().string());
    if (format != nullptr) return *format;
    if (options.dimensions && options.type) return raw_format;
  }
  throw left_out(path.string() + ": what reads it (read are " + volume_extensions() + ")");
}

bool is_volume_json(const std::filesystem::path&) {
  return false;
}

}  // namespace pellucid
