// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/read_mesh.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <new>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "files/input_file.h"
#include "files/memory_limit.h"
#include "hdf5/vtk_hdf.h"
#include "mesh_archive.h"
#include "mesh_blocks.h"
#include "netcdf/net_cdf_size.h"
#include "pellucid/scene/error.h"
#include "plot3d.h"
#include "process/contained.h"
#include "text/text.h"
#include "vtk/legacy_vtk_cells.h"
#include "vtk/legacy_vtk_numbers.h"
#include "vtk/vtk_collection.h"
#include "vtk/vtk_file_kind.h"
#include "vtk/vtk_files.h"
#include "vtk/vtk_module.h"
#include "vtk/xml/vtk_xml_check.h"

namespace pellucid {

namespace {

enum class Format { xml, legacy, exodus, plot3d, vtk_hdf };

struct Extension {
  std::string_view text;
  Format format;
};

constexpr std::array extensions{
    Extension{".vtu", Format::xml},        Extension{".pvtu", Format::xml},
    Extension{".vts", Format::xml},        Extension{".pvts", Format::xml},
    Extension{".vtm", Format::xml},        Extension{".vtmb", Format::xml},
    Extension{".pvd", Format::xml},        Extension{".vtk", Format::legacy},
    Extension{".ex2", Format::exodus},     Extension{".e", Format::exodus},
    Extension{".exo", Format::exodus},     Extension{".g", Format::exodus},
    Extension{".vtkhdf", Format::vtk_hdf}, Extension{".xyz", Format::plot3d},
    Extension{".p3d", Format::plot3d},     Extension{".x", Format::plot3d}};

std::optional<Format> format_by_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  for (const Extension& known : extensions) {
    if (extension == known.text) return known.format;
  }
  return std::nullopt;
}

/// The formats that begin with words of their own.
std::optional<Format> format_by_content(const std::filesystem::path& path) {
  constexpr std::size_t longest = std::size_t{1} << 16;
  const std::string head = first_bytes(path, longest);
  const auto has = [&](std::string_view word) { return head.find(word) != std::string::npos; };
  if (head.starts_with("# vtk DataFile")) return Format::legacy;
  if (head.starts_with("<") && has("<VTKFile")) return Format::xml;
  if (vtk_hdf_type(path) == "UnstructuredGrid") return Format::vtk_hdf;
  const bool net_cdf = head.starts_with("CDF") || head.starts_with("\x89HDF");
  if (net_cdf && (has("num_nodes") || has("num_el_blk"))) return Format::exodus;
  return std::nullopt;
}

Format format_of(const std::filesystem::path& path, const MeshReadOptions& options) {
  if (!options.q.empty()) return Format::plot3d;
  if (const auto format = format_by_content(path)) return *format;
  if (const auto format = format_by_extension(path)) return *format;
  throw Error(path.string() + ": is no mesh by its name or its first bytes; read are " +
              mesh_extensions());
}

/// Reads it in a process of its own, which may crash, and which hands over what it read.
MeshBlocks read_by_vtk(const std::filesystem::path& path, Format format,
                       const MeshReadOptions& options) {
  const std::uintmax_t file_bytes = bytes_of_vtk_files(path);
  std::optional<MeshBlocks> mesh;
  try {
    check_vtk_module();
    const ContainedBytes bytes = run_contained_answer(
        [&](const MakeAnswer& make) {
          VtkAnswer answer;
          vtk_module()(
              path,
              format == Format::xml      ? VtkFormat::xml
              : format == Format::legacy ? VtkFormat::legacy
                                         : VtkFormat::exodus,
              options, [](const std::filesystem::path& file) { return check_vtk_xml(file); },
              answer);
          if (!answer.error.empty()) throw Error(answer.error);
          write_mesh_blocks(answer.mesh, make);
          return true;
        },
        file_bytes, memory_for_vtk(file_bytes));
    if (bytes) mesh = read_mesh_blocks(bytes.span());
    if (!mesh) throw Error(vtk_fails);
  } catch (const Error& error) {
    throw Error(path.string() + ": " + one_line(error.what()));
  }
  return *std::move(mesh);
}

MeshBlocks read_blocks(const std::filesystem::path& path, const MeshReadOptions& options) {
  const std::uintmax_t bytes = check_input_file(path);
  // VTK's copy beside ours; what is compressed takes more.
  check_memory(2 * bytes, path.string() + ": its mesh");
  const Format format = format_of(path, options);
  if (format == Format::exodus) check_net_cdf_size(path);
  if (format == Format::legacy) {
    check_legacy_vtk_cells(path);
    check_legacy_vtk_numbers(path);
  }
  if (format == Format::vtk_hdf) return read_vtk_hdf(path, options);
  if (format != Format::plot3d) {
    return read_by_vtk(path, format, options);
  }
  if (options.time) {
    throw Error(path.string() + ": the file has no steps in time; leave the time out");
  }
  return read_plot3d(path, options.q);
}

}  // namespace

bool is_mesh_file(const std::filesystem::path& path) {
  const std::optional<VtkFileKind> kind = vtk_file_kind(path);
  if ((kind && kind->is_volume()) || is_image_collection(path)) return false;
  // Of the others of its kind the reader of volumes says what they are.
  if (format_by_extension(path) == Format::vtk_hdf && std::filesystem::exists(path)) {
    return format_by_content(path) == Format::vtk_hdf;
  }
  return format_by_extension(path).has_value() || format_by_content(path).has_value();
}

std::string mesh_extensions() {
  std::string text;
  for (const Extension& known : extensions) {
    text += (text.empty() ? "" : " ") + std::string(known.text);
  }
  return text;
}

MeshFile read_mesh(const std::filesystem::path& path, const MeshReadOptions& options) {
  const auto refuse = [&]() -> Error {
    return Error(path.string() + ": not enough memory for the mesh; split the file or make room");
  };
  try {
    MeshFile file = join_blocks(read_blocks(path, options), path.string());
    for (const std::string& note : file.notes) {
      if (options.note) options.note(note);
    }
    return file;
  } catch (const std::bad_alloc&) {
    throw refuse();
  } catch (const std::length_error&) {
    throw refuse();
  }
}

const MeshArray& default_array(const MeshFile& file) {
  const std::vector<MeshArray>& arrays = file.grid.arrays;
  if (arrays.empty()) {
    throw Error(file.grid.name + ": has no array of numbers to show" +
                (file.format == "PLOT3D" ? "; give its solution (q) too" : ""));
  }
  const auto named = std::ranges::find_if(
      arrays, [&](const MeshArray& a) { return !file.active.empty() && a.name == file.active; });
  if (named != arrays.end()) return *named;
  const auto scalar = std::ranges::find_if(arrays, [](const MeshArray& a) {
    return a.centering == Centering::point && a.components == 1;
  });
  return scalar != arrays.end() ? *scalar : arrays.front();
}

}  // namespace pellucid
