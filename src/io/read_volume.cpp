// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/read_volume.h"

#include <algorithm>
#include <array>
#include <new>
#include <string>
#include <string_view>

#include "input_file.h"
#include "medical_volumes.h"
#include "pellucid/scene/error.h"
#include "volume_source.h"

namespace pellucid {

namespace {

using Reader = Volume (*)(const std::filesystem::path&, const ReadOptions&);

Volume read_npy_file(const std::filesystem::path& path, const ReadOptions& options) {
  return read_npy(file_source(path), options);
}

Volume read_raw_file(const std::filesystem::path& path, const ReadOptions& options) {
  return read_raw(file_source(path), options);
}

struct Format {
  std::string_view extension;
  Reader read;
};

constexpr std::array formats{
    Format{".nii", read_nifti},      Format{".nii.gz", read_nifti}, Format{".hdr", read_nifti},
    Format{".hdr.gz", read_nifti},   Format{".img", read_nifti},    Format{".img.gz", read_nifti},
    Format{".nrrd", read_nrrd},      Format{".nhdr", read_nrrd},    Format{".mha", read_meta_image},
    Format{".mhd", read_meta_image}, Format{".npy", read_npy_file}, Format{".raw", read_raw_file}};

Reader reader_of(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  std::ranges::transform(name, name.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  for (const Format& format : formats) {
    if (name.ends_with(format.extension)) return format.read;
  }
  return nullptr;
}

}  // namespace

Volume read_volume(const std::filesystem::path& path, const ReadOptions& options) {
  check_input_file(path);
  Reader read = reader_of(path);
  // Whoever says how large the data is and of what type has said that it has no header.
  if (read == nullptr && options.dimensions && options.type) read = read_raw_file;
  if (read == nullptr) {
    std::string known;
    for (const Format& format : formats) {
      known += (known.empty() ? "" : " ") + std::string(format.extension);
    }
    throw Error(path.string() + ": the file's extension is not known; read are " + known +
                ", and headerless data of any name with its dimensions and type given");
  }
  try {
    return read(path, options);
  } catch (const std::bad_alloc&) {
    throw Error(path.string() + ": not enough memory for the data; crop or reduce the volume");
  } catch (const std::length_error&) {
    throw Error(path.string() + ": not enough memory for the data; crop or reduce the volume");
  }
}

}  // namespace pellucid
