// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/read_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "components.h"
#include "dat_header.h"
#include "dicom.h"
#include "grid_files.h"
#include "gzip_source.h"
#include "image_stack.h"
#include "input_file.h"
#include "ivf_header.h"
#include "medical_volumes.h"
#include "mrc.h"
#include "npy.h"
#include "pellucid/io/color_data.h"
#include "pellucid/io/dicom_series.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/scene/error.h"
#include "unread_formats.h"
#include "vtk_collection.h"
#include "vtk_file_kind.h"
#include "vtk_hdf.h"
#include "vtk_js.h"
#include "vtk_volume.h"
#include "vvd_header.h"
#include "zarr.h"

namespace pellucid {

namespace {

using Opener = VolumeFile (*)(const std::filesystem::path&, const ReadOptions&);

template <VolumeFile (*open)(const ByteSource&, const ReadOptions&)>
VolumeFile open_bytes(const std::filesystem::path& path, const ReadOptions& options) {
  return open(file_source(path), options);
}

struct Format {
  std::string_view extension;
  Opener open;
};

constexpr Opener open_raw_file = open_bytes<open_raw>;
constexpr Opener open_npy_file = open_bytes<open_npy>;
constexpr Opener open_npz_file = open_bytes<open_npz>;

VolumeFile open_mrc_file(const std::filesystem::path& path, const ReadOptions& options) {
  return open_mrc(plain_or_gzip_source(path), options);
}

constexpr std::array formats{Format{".nii", open_nifti},
                             Format{".nii.gz", open_nifti},
                             Format{".hdr", open_nifti},
                             Format{".hdr.gz", open_nifti},
                             Format{".img", open_nifti},
                             Format{".img.gz", open_nifti},
                             Format{".mgz", open_mgh},
                             Format{".mgh", open_mgh},
                             Format{".mgh.gz", open_mgh},
                             Format{".nrrd", open_nrrd},
                             Format{".nhdr", open_nrrd},
                             Format{".mha", open_meta_image},
                             Format{".mhd", open_meta_image},
                             Format{".npy", open_npy_file},
                             Format{".npz", open_npz_file},
                             Format{".slc", open_bytes<open_slc>},
                             Format{".vti", open_vtk_volume},
                             Format{".pvti", open_vtk_volume},
                             Format{".vtr", open_vtk_volume},
                             Format{".pvtr", open_vtk_volume},
                             Format{".vtk", open_vtk_volume},
                             Format{".raw", open_raw_file},
                             Format{".dcm", open_dicom},
                             Format{".ima", open_dicom},
                             Format{".tif", open_stack},
                             Format{".tiff", open_stack},
                             Format{".png", open_stack},
                             Format{".mrc", open_mrc_file},
                             Format{".map", open_mrc_file},
                             Format{".rec", open_mrc_file},
                             Format{".st", open_mrc_file},
                             Format{".ccp4", open_mrc_file},
                             Format{".raw.gz", open_raw_gzip},
                             Format{".h5", open_hdf5},
                             Format{".hdf5", open_hdf5},
                             Format{".he5", open_hdf5},
                             Format{".ims", open_hdf5},  // Imaris
                             Format{".vtkhdf", open_vtk_hdf},
                             Format{".hdf", open_vtk_hdf},
                             Format{".nc", open_net_cdf},
                             Format{".nc4", open_net_cdf},
                             Format{".cdf", open_net_cdf},
                             Format{".vdb", open_vdb},
                             Format{".ivf", open_ivf},
                             Format{".vvd", open_vvd},
                             Format{".zarr", open_zarr},
                             Format{".mrc.gz", open_mrc_file},
                             Format{".map.gz", open_mrc_file},
                             Format{".rec.gz", open_mrc_file},
                             Format{".st.gz", open_mrc_file},
                             Format{".ccp4.gz", open_mrc_file},
                             Format{".companion.ome", open_stack}};

using Lister = std::vector<VolumeArray> (*)(const std::filesystem::path&, const ReadOptions&);

template <std::vector<VolumeArray> (*list)(const std::filesystem::path&)>
std::vector<VolumeArray> without_options(const std::filesystem::path& path, const ReadOptions&) {
  return list(path);
}

/// What lists the arrays of files that are read by it; null where they have no names.
Lister lister_of(Opener open) {
  return open == open_npz_file           ? list_npz_arrays
         : open == open_vtk_volume       ? without_options<list_vtk_arrays>
         : open == open_hdf5             ? list_hdf5_arrays
         : open == open_vtk_hdf          ? without_options<list_vtk_hdf_arrays>
         : open == open_net_cdf          ? without_options<list_net_cdf_arrays>
         : open == open_vdb              ? without_options<list_vdb_arrays>
         : open == open_image_collection ? without_options<list_collection_arrays>
         : open == open_zarr             ? list_zarr_arrays
         : open == open_vtk_js           ? without_options<list_vtk_js_arrays>
                                         : nullptr;
}

const Format* format_of(std::string_view file_name) {
  std::string name(file_name);
  std::ranges::transform(name, name.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  const auto format = std::ranges::find_if(
      formats, [&](const Format& known) { return name.ends_with(known.extension); });
  return format == formats.end() ? nullptr : &*format;
}

/// By the extension; VTK's files, of whatever name, by their first bytes.
Opener opener_of(const std::filesystem::path& path) {
  const Format* const format = format_of(path.filename().string());
  if (is_image_collection(path)) return open_image_collection;
  const std::optional<VtkFileKind> kind = vtk_file_kind(path);
  if (kind && kind->is_volume() && (format == nullptr || format->open != open_raw_file)) {
    return open_vtk_volume;
  }
  // Of any name that does not speak of something else.
  if (format == nullptr || format->open == open_hdf5) {
    const std::string type = vtk_hdf_type(path);
    if (type == "UnstructuredGrid") return nullptr;
    if (!type.empty()) return open_vtk_hdf;
  }
  if (format == nullptr) return nullptr;
  if (format->open == open_vtk_hdf && is_mesh_file(path)) return nullptr;
  return format->open == open_vtk_volume && is_mesh_file(path) ? nullptr : format->open;
}

Opener find_opener(const std::filesystem::path& path, const ReadOptions& options) {
  std::error_code error;
  if (is_zarr(path)) return open_zarr;
  if (is_vtk_js(path)) return open_vtk_js;
  refuse_unread_format(path);
  if (std::filesystem::is_directory(path, error)) return is_dicom(path) ? open_dicom : open_stack;
  if (is_stack_pattern(path)) return open_stack;
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
    throw Error(path.string() + ": the file's extension is not known; read are " +
                volume_extensions() +
                ", .dat headers of Inviwo and Voreen, and headerless data of any name with its "
                "dimensions and type given");
  }
  return open;
}

VolumeFile open_file(const std::filesystem::path& path, const ReadOptions& options) {
  if (options.time && !std::isfinite(*options.time)) {
    throw Error(path.string() + ": the time is no finite number; give that of a step");
  }
  const Opener open = find_opener(path, options);
  if (options.series && open != open_stack && !is_dicom(path)) {
    throw Error(path.string() + ": is no DICOM, and only of DICOM a series may be chosen");
  }
  if (options.array && lister_of(open) == nullptr) {
    throw Error(path.string() + ": has no arrays with names; leave the array out");
  }
  constexpr std::array of_plain_arrays{open_npy_file, open_npz_file, Opener{open_hdf5},
                                       Opener{open_zarr}, Opener{open_stack}};
  if (options.axes && std::ranges::find(of_plain_arrays, open) == of_plain_arrays.end()) {
    throw Error(path.string() + ": the file's format says which axes are x, y and z; leave the " +
                "axes out (they are for .npy, .npz, HDF5, Zarr and tifffile's arrays)");
  }
  if (options.level && open != open_zarr) {
    throw Error(path.string() + ": has no levels of resolution; leave the level out");
  }
  constexpr std::array with_times{Opener{open_hdf5}, Opener{open_net_cdf}, Opener{open_zarr},
                                  Opener{open_stack}, open_vtk_volume};
  if (options.time && std::ranges::find(with_times, open) == with_times.end()) {
    throw Error(path.string() + ": the file has no steps in time; leave the time out");
  }
  return open(path, options);
}

/// What `read` makes of the opened file, with one line for all that memory does not hold.
template <class Read>
auto with_memory(const std::filesystem::path& path, const Read& read) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
    throw Error(path.string() + ": not enough memory for the data; crop or reduce the volume");
  } catch (const std::length_error&) {
    throw Error(path.string() + ": not enough memory for the data; crop or reduce the volume");
  }
}

/// The same, opened again without the files of a DICOM series that turn out to be damaged. Notes
/// are told once, and only if there is no error, which is then the one line.
template <class Read>
auto open_and(const std::filesystem::path& path, const ReadOptions& options, const Read& read) {
  std::vector<std::string> notes;
  ReadOptions once = options;
  if (options.note) {
    once.note = [&](const std::string& text) {
      if (std::ranges::find(notes, text) == notes.end()) notes.push_back(text);
    };
  }
  auto made = with_memory(path, [&] {
    try {
      return read(open_file(path, once));
    } catch (const DamagedDicom& damaged) {
      return read(open_dicom_without(damaged.files(), path, once));
    }
  });
  for (const std::string& text : notes) options.note(text);
  return made;
}

}  // namespace

VolumeOutline outline_volume(const std::filesystem::path& path, const ReadOptions& options) {
  return open_and(path, options, [](const VolumeFile& file) {
    return VolumeOutline{file.description, file.reads_parts, file.space};
  });
}

Volume read_volume(const std::filesystem::path& path, const ReadOptions& options) {
  return open_and(path, options,
                  [&](const VolumeFile& file) { return read_chosen(file, options); });
}

ColorOutline outline_colors(const std::filesystem::path& path, const ReadOptions& options) {
  return open_and(path, options, [](const VolumeFile& file) {
    if (!(file.largest_color > 0)) return ColorOutline{};
    const Volume::Description& grid = file.description;
    const auto side = [&](int a) {
      const auto axis = static_cast<std::size_t>(a);
      const std::vector<double>& places = grid.coordinates[axis];
      return places.empty() ? grid.dimensions[axis] * grid.placement.spacing[a]
                            : places.back() - places.front();
    };
    const double x = side(0), y = side(1), z = side(2);
    return ColorOutline{file.components, file.largest_color,
                        2 * x * y * z / (x * y + y * z + z * x)};
  });
}

int component_count(const std::filesystem::path& path, const ReadOptions& options) {
  return open_and(path, options, [](const VolumeFile& file) { return file.components; });
}

std::vector<Volume> read_components(const std::filesystem::path& path, const ReadOptions& options) {
  return read_named_components(path, options).components;
}

NamedComponents read_named_components(const std::filesystem::path& path,
                                      const ReadOptions& options) {
  return open_and(path, options, [&](const VolumeFile& file) {
    return NamedComponents{file.array, read_all(file, options)};
  });
}

std::vector<VolumeArray> list_arrays(const std::filesystem::path& path,
                                     const ReadOptions& options) {
  return with_memory(path, [&]() -> std::vector<VolumeArray> {
    const auto list = lister_of(find_opener(path, options));
    return list == nullptr ? std::vector<VolumeArray>{} : list(path, options);
  });
}

bool has_volume_header(std::string_view file_name) {
  const Format* const format = format_of(file_name);
  return format != nullptr && format->open != open_raw_file && format->open != open_raw_gzip;
}

std::string world_space(const std::filesystem::path& file, const ReadOptions& options) {
  constexpr std::array of_patients{Opener{open_nifti}, Opener{open_nrrd}, Opener{open_meta_image},
                                   Opener{open_mgh}, Opener{open_dicom}};
  ReadOptions silent = options;
  silent.note = {};
  silent.part = {};
  try {
    if (std::ranges::find(of_patients, find_opener(file, silent)) == of_patients.end()) return {};
    return outline_volume(file, silent).space;
  } catch (const Error&) {
    return {};
  }
}

bool is_placed_in_lps(const std::filesystem::path& file, const ReadOptions& options) {
  return world_space(file, options) == patient_space;
}

bool is_volume_json(const std::filesystem::path& path) {
  return is_vtk_js(path);
}

std::string volume_extensions() {
  std::string known;
  for (const Format& format : formats) {
    known += (known.empty() ? "" : " ") + std::string(format.extension);
  }
  return known;
}

}  // namespace pellucid
