// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/read_volume.h"

#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "components.h"
#include "dat_header.h"
#include "dicom.h"
#include "image_stack.h"
#include "input_file.h"
#include "medical_volumes.h"
#include "mrc.h"
#include "pellucid/io/dicom_series.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

using Opener = VolumeFile (*)(const std::filesystem::path&, const ReadOptions&);

VolumeFile open_npy_file(const std::filesystem::path& path, const ReadOptions& options) {
  return open_npy(file_source(path), options);
}

VolumeFile open_raw_file(const std::filesystem::path& path, const ReadOptions& options) {
  return open_raw(file_source(path), options);
}

VolumeFile open_mrc_file(const std::filesystem::path& path, const ReadOptions& options) {
  return open_mrc(file_source(path), options);
}

struct Format {
  std::string_view extension;
  Opener open;
};

constexpr std::array formats{
    Format{".nii", open_nifti},      Format{".nii.gz", open_nifti}, Format{".hdr", open_nifti},
    Format{".hdr.gz", open_nifti},   Format{".img", open_nifti},    Format{".img.gz", open_nifti},
    Format{".nrrd", open_nrrd},      Format{".nhdr", open_nrrd},    Format{".mha", open_meta_image},
    Format{".mhd", open_meta_image}, Format{".npy", open_npy_file}, Format{".raw", open_raw_file},
    Format{".dcm", open_dicom},      Format{".ima", open_dicom},    Format{".tif", open_stack},
    Format{".tiff", open_stack},     Format{".png", open_stack},    Format{".mrc", open_mrc_file},
    Format{".map", open_mrc_file},   Format{".rec", open_mrc_file}, Format{".st", open_mrc_file},
    Format{".ccp4", open_mrc_file}};

Opener opener_of(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  std::ranges::transform(name, name.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  for (const Format& format : formats) {
    if (name.ends_with(format.extension)) return format.open;
  }
  return nullptr;
}

VolumeFile open_folder(const std::filesystem::path& path, const ReadOptions& options) {
  return is_dicom(path) ? open_dicom(path, options) : open_stack(path, options);
}

VolumeFile open_file(const std::filesystem::path& path, const ReadOptions& options) {
  std::error_code error;
  if (options.series && !is_dicom(path)) {
    throw Error(path.string() + ": is no DICOM, and only of DICOM a series may be chosen");
  }
  if (std::filesystem::is_directory(path, error)) return open_folder(path, options);
  if (is_stack_pattern(path)) return open_stack(path, options);
  check_input_file(path);
  Opener open = opener_of(path);
  // Whoever says how large the data is and of what type has said that it has no header.
  if (open == nullptr && options.dimensions && options.type) open = open_raw_file;
  if (open == nullptr && is_dat_header(path)) open = open_dat;
  if (open == nullptr && is_dicom(path)) open = open_dicom;
  if (open == nullptr && is_mesh_file(path)) {
    throw Error(path.string() +
                ": is a mesh, and here a volume is needed; 'render' and 'info' take meshes");
  }
  if (open == nullptr) {
    std::string known;
    for (const Format& format : formats) {
      known += (known.empty() ? "" : " ") + std::string(format.extension);
    }
    throw Error(path.string() + ": the file's extension is not known; read are " + known +
                ", .dat headers of Inviwo and Voreen, and headerless data of any name with its "
                "dimensions and type given");
  }
  return open(path, options);
}

/// What `read` makes of the opened file, with one line for all that memory does not hold.
template <class Read>
auto open_and(const std::filesystem::path& path, const ReadOptions& options, const Read& read) {
  try {
    return read(open_file(path, options));
  } catch (const std::bad_alloc&) {
    throw Error(path.string() + ": not enough memory for the data; crop or reduce the volume");
  } catch (const std::length_error&) {
    throw Error(path.string() + ": not enough memory for the data; crop or reduce the volume");
  }
}

}  // namespace

Volume read_volume(const std::filesystem::path& path, const ReadOptions& options) {
  return open_and(path, options,
                  [&](const VolumeFile& file) { return read_chosen(file, options); });
}

int component_count(const std::filesystem::path& path, const ReadOptions& options) {
  return open_and(path, options, [](const VolumeFile& file) { return file.components; });
}

std::vector<Volume> read_components(const std::filesystem::path& path, const ReadOptions& options) {
  return open_and(path, options, [&](const VolumeFile& file) { return read_all(file, options); });
}

}  // namespace pellucid
