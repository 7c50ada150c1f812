// SPDX-License-Identifier: Apache-2.0
//
// All formats of volumes. In builds for a first picture first_volume_formats.cpp stands in.
#include <array>
#include <optional>
#include <string>
#include <system_error>

#include "dicom/dicom.h"
#include "dicom/dicom_folder.h"
#include "files/gzip_source.h"
#include "files/input_file.h"
#include "grid_modules/grid_files.h"
#include "hdf5/vtk_hdf.h"
#include "inviwo/dat_header.h"
#include "inviwo/ivf_header.h"
#include "inviwo/vvd_header.h"
#include "medical_volumes.h"
#include "mrc/mrc.h"
#include "npy/npy.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/scene/error.h"
#include "stacks/image_stack.h"
#include "unread_formats.h"
#include "volume_format.h"
#include "vtk/vtk_collection.h"
#include "vtk/vtk_file_kind.h"
#include "vtk/vtk_js.h"
#include "vtk/vtk_volume.h"
#include "zarr/zarr.h"

namespace pellucid {

namespace {

template <VolumeFile (*open)(const ByteSource&, const ReadOptions&)>
VolumeFile open_bytes(const std::filesystem::path& path, const ReadOptions& options) {
  return open(file_source(path), options);
}

VolumeFile open_mrc_file(const std::filesystem::path& path, const ReadOptions& options) {
  return open_mrc(plain_or_gzip_source(path), options);
}

template <std::vector<VolumeArray> (*list)(const std::filesystem::path&)>
std::vector<VolumeArray> without_options(const std::filesystem::path& path, const ReadOptions&) {
  return list(path);
}

constexpr VolumeFormat mgh{.open = open_mgh, .is_of_patients = true};
constexpr VolumeFormat nrrd{.open = open_nrrd, .is_of_patients = true};
constexpr VolumeFormat meta_image{.open = open_meta_image, .is_of_patients = true};
constexpr VolumeFormat npz{
    .open = open_bytes<open_npz>, .list = list_npz_arrays, .takes_axes = true};
constexpr VolumeFormat slc{.open = open_bytes<open_slc>};
constexpr VolumeFormat vtk{
    .open = open_vtk_volume, .list = without_options<list_vtk_arrays>, .has_times = true};
constexpr VolumeFormat dicom{.open = open_dicom,
                             .open_without = open_dicom_without,
                             .has_series = true,
                             .is_of_patients = true};
constexpr VolumeFormat stack{
    .open = open_stack, .takes_axes = true, .has_times = true, .has_series = true};
constexpr VolumeFormat mrc{.open = open_mrc_file};
constexpr VolumeFormat hdf5{
    .open = open_hdf5, .list = list_hdf5_arrays, .takes_axes = true, .has_times = true};
constexpr VolumeFormat vtk_hdf{.open = open_vtk_hdf, .list = without_options<list_vtk_hdf_arrays>};
constexpr VolumeFormat net_cdf{
    .open = open_net_cdf, .list = without_options<list_net_cdf_arrays>, .has_times = true};
constexpr VolumeFormat vdb{.open = open_vdb, .list = without_options<list_vdb_arrays>};
constexpr VolumeFormat ivf{.open = open_ivf};
constexpr VolumeFormat vvd{.open = open_vvd};
constexpr VolumeFormat dat{.open = open_dat};
constexpr VolumeFormat zarr{.open = open_zarr,
                            .list = list_zarr_arrays,
                            .takes_axes = true,
                            .has_levels = true,
                            .has_times = true};
constexpr VolumeFormat vtk_js{.open = open_vtk_js, .list = without_options<list_vtk_js_arrays>};
constexpr VolumeFormat image_collection{.open = open_image_collection,
                                        .list = without_options<list_collection_arrays>};

constexpr std::array extensions{VolumeExtension{".nii", &nifti_format},
                                VolumeExtension{".nii.gz", &nifti_format},
                                VolumeExtension{".hdr", &nifti_format},
                                VolumeExtension{".hdr.gz", &nifti_format},
                                VolumeExtension{".img", &nifti_format},
                                VolumeExtension{".img.gz", &nifti_format},
                                VolumeExtension{".mgz", &mgh},
                                VolumeExtension{".mgh", &mgh},
                                VolumeExtension{".mgh.gz", &mgh},
                                VolumeExtension{".nrrd", &nrrd},
                                VolumeExtension{".nhdr", &nrrd},
                                VolumeExtension{".mha", &meta_image},
                                VolumeExtension{".mhd", &meta_image},
                                VolumeExtension{".npy", &npy_format},
                                VolumeExtension{".npz", &npz},
                                VolumeExtension{".slc", &slc},
                                VolumeExtension{".vti", &vtk},
                                VolumeExtension{".pvti", &vtk},
                                VolumeExtension{".vtr", &vtk},
                                VolumeExtension{".pvtr", &vtk},
                                VolumeExtension{".vtk", &vtk},
                                VolumeExtension{".raw", &raw_format},
                                VolumeExtension{".dcm", &dicom},
                                VolumeExtension{".ima", &dicom},
                                VolumeExtension{".tif", &stack},
                                VolumeExtension{".tiff", &stack},
                                VolumeExtension{".png", &stack},
                                VolumeExtension{".mrc", &mrc},
                                VolumeExtension{".map", &mrc},
                                VolumeExtension{".rec", &mrc},
                                VolumeExtension{".st", &mrc},
                                VolumeExtension{".ccp4", &mrc},
                                VolumeExtension{".raw.gz", &raw_gzip_format},
                                VolumeExtension{".h5", &hdf5},
                                VolumeExtension{".hdf5", &hdf5},
                                VolumeExtension{".he5", &hdf5},
                                VolumeExtension{".ims", &hdf5},  // Imaris
                                VolumeExtension{".vtkhdf", &vtk_hdf},
                                VolumeExtension{".hdf", &vtk_hdf},
                                VolumeExtension{".nc", &net_cdf},
                                VolumeExtension{".nc4", &net_cdf},
                                VolumeExtension{".cdf", &net_cdf},
                                VolumeExtension{".vdb", &vdb},
                                VolumeExtension{".ivf", &ivf},
                                VolumeExtension{".vvd", &vvd},
                                VolumeExtension{".zarr", &zarr},
                                VolumeExtension{".mrc.gz", &mrc},
                                VolumeExtension{".map.gz", &mrc},
                                VolumeExtension{".rec.gz", &mrc},
                                VolumeExtension{".st.gz", &mrc},
                                VolumeExtension{".ccp4.gz", &mrc},
                                VolumeExtension{".companion.ome", &stack}};

/// By the extension; VTK's files, of whatever name, by their first bytes.
const VolumeFormat* format_of(const std::filesystem::path& path) {
  const VolumeFormat* const format = volume_format_by_name(path.filename().string());
  if (is_image_collection(path)) return &image_collection;
  const std::optional<VtkFileKind> kind = vtk_file_kind(path);
  if (kind && kind->is_volume() && format != &raw_format) return &vtk;
  // Of any name that does not speak of something else.
  if (format == nullptr || format == &hdf5) {
    const std::string type = vtk_hdf_type(path);
    if (type == "UnstructuredGrid") return nullptr;
    if (!type.empty()) return &vtk_hdf;
  }
  const bool may_be_mesh = format == &vtk_hdf || format == &vtk;
  return may_be_mesh && is_mesh_file(path) ? nullptr : format;
}

}  // namespace

std::span<const VolumeExtension> volume_format_extensions() {
  return extensions;
}

const VolumeFormat& find_volume_format(const std::filesystem::path& path,
                                       const ReadOptions& options) {
  std::error_code error;
  if (is_zarr(path)) return zarr;
  if (is_vtk_js(path)) return vtk_js;
  refuse_unread_format(path);
  if (std::filesystem::is_directory(path, error)) return is_dicom(path) ? dicom : stack;
  if (is_stack_pattern(path)) return stack;
  check_input_file(path);
  if (const VolumeFormat* const format = format_of(path)) return *format;
  // Whoever says how large the data is and of what type has said that it has no header.
  if (options.dimensions && options.type) return raw_format;
  if (is_dat_header(path)) return dat;
  if (is_dicom(path)) return dicom;
  if (is_mesh_file(path)) {
    throw Error(path.string() +
                ": is a mesh, and here a volume is needed; 'render' and 'info' take meshes");
  }
  throw Error(path.string() + ": the file's extension is not known; read are " +
              volume_extensions() +
              ", .dat headers of Inviwo and Voreen, and headerless data of any name with its "
              "dimensions and type given");
}

bool is_volume_json(const std::filesystem::path& path) {
  return is_vtk_js(path);
}

}  // namespace pellucid
