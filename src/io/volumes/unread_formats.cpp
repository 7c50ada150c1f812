// SPDX-License-Identifier: Apache-2.0
#include "unread_formats.h"

#include <string>
#include <system_error>

#include "pellucid/io/read_mesh.h"
#include "pellucid/io/read_volume.h"
#include "pellucid/scene/error.h"
#include "text/json_file.h"
#include "text/text.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

/// Returns whether a folder is a store of N5, or an array in one: "attributes.json" says so.
bool is_n5(const fs::path& path) {
  std::error_code error;
  const fs::path file = path.filename() == "attributes.json" ? path : path / "attributes.json";
  const fs::path folder = file.parent_path();
  const fs::path bare = folder.has_filename() ? folder : folder.parent_path();
  if (!fs::is_directory(folder.empty() ? fs::path(".") : folder, error)) return false;
  if (in_small_letters(bare.filename().string()).ends_with(".n5")) return true;
  if (!fs::is_regular_file(file, error)) return false;
  try {
    const JsonFile attributes = read_data_json(file);
    const scene_json::Node root = attributes.root();
    return root.is_object() &&
           (root.has("n5") || (root.has("blockSize") && root.has("dimensions")));
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

void refuse_unread_format(const fs::path& path) {
  const std::string name = in_small_letters(path.filename().string());
  if (name.ends_with(".zarr.zip") || name.ends_with(".ozx")) {
    throw Error(path.string() +
                ": is a store of Zarr in a zip archive; unpack it, and give the folder");
  }
  if (name.ends_with(".mnc") || name.ends_with(".mnc.gz")) {
    throw Error(path.string() +
                ": is a file of MINC, which is not read; convert it, as with mnc2nii or nibabel, "
                "and give the NIfTI");
  }
  if (is_n5(path)) {
    throw Error(path.string() +
                ": is a store of N5, which is not read; copy the array to Zarr, as with "
                "tensorstore or zarr-python, and give its folder");
  }
}

void refuse_unknown_format(const fs::path& path) {
  if (is_mesh_file(path)) {
    throw Error(path.string() +
                ": is a mesh, and here a volume is needed; 'render' and 'info' take meshes");
  }
  throw Error(path.string() + ": the file's extension is not known; read are " +
              volume_extensions() +
              ", .dat headers of Inviwo and Voreen, and headerless data of any name with its "
              "dimensions and type given");
}

}  // namespace pellucid
