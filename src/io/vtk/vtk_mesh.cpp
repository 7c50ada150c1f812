// SPDX-License-Identifier: Apache-2.0
//
// Meshes that VTK reads: its XML and legacy files, and Exodus II.
#include <algorithm>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "legacy_vtk_cells.h"
#include "legacy_vtk_numbers.h"
#include "meshes/mesh_archive.h"
#include "meshes/mesh_format.h"
#include "netcdf/net_cdf_size.h"
#include "pellucid/scene/error.h"
#include "process/child_process.h"
#include "text/text.h"
#include "vtk/xml/vtk_xml_check.h"
#include "vtk_collection.h"
#include "vtk_file_kind.h"
#include "vtk_files.h"
#include "vtk_module.h"

namespace pellucid {

namespace {

/// Reads it in a process of its own, which may crash, and which hands over what it read.
MeshBlocks read_by_vtk(const std::filesystem::path& path, VtkFormat format,
                       const MeshReadOptions& options) {
  const std::uintmax_t file_bytes = bytes_of_vtk_files(path);
  std::optional<MeshBlocks> mesh;
  try {
    check_vtk_module();
    const ChildBytes bytes = answer_in_child(
        [&](const MakeAnswer& make) {
          VtkAnswer answer;
          vtk_module()(
              path, format, options,
              [](const std::filesystem::path& file) { return check_vtk_xml(file); }, answer);
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

/// Returns the times of a file of XML, without VTK.
std::vector<double> xml_times(const std::filesystem::path& path) {
  const std::optional<VtkFileKind> kind = vtk_file_kind(path);
  try {
    if (!kind || kind->data != "Collection") return read_vtk_xml(path).times;
    std::vector<double> times;
    for (const ListedStep& step : steps_of_list(path)) times.push_back(step.time);
    return times;
  } catch (const Error& error) {
    throw Error(path.string() + ": " + one_line(error.what()));
  }
}

/// Asks VTK, in a process of its own.
std::vector<double> exodus_times(const std::filesystem::path& path) {
  check_net_cdf_size(path);
  const std::uintmax_t file_bytes = bytes_of_vtk_files(path);
  std::vector<double> times;
  try {
    check_vtk_module();
    const ChildBytes bytes = answer_in_child(
        [&](const MakeAnswer& make) {
          std::vector<double> found;
          std::string error;
          exodus_times_module()(path, found, error);
          if (!error.empty()) throw Error(error);
          std::ranges::copy(std::as_bytes(std::span(found)),
                            make(found.size() * sizeof(double) + 1).begin());
          return true;
        },
        file_bytes, memory_for_vtk(file_bytes));
    if (!bytes) throw Error(vtk_fails);
    times.resize(bytes.size / sizeof(double));
    if (!times.empty()) {
      std::memcpy(times.data(), bytes.data.get(), times.size() * sizeof(double));
    }
  } catch (const Error& error) {
    throw Error(path.string() + ": " + one_line(error.what()));
  }
  return times;
}

bool has(std::string_view head, std::string_view word) {
  return head.find(word) != std::string_view::npos;
}

}  // namespace

extern const MeshFormat vtk_xml_mesh_format{
    .name = "VTK XML",
    .extensions = ".vtu .pvtu .vts .pvts .vtm .vtmb .pvd",
    .takes_content =
        [](const std::filesystem::path&, std::string_view head) {
          return head.starts_with("<") && has(head, "<VTKFile");
        },
    .read =
        [](const std::filesystem::path& path, const MeshReadOptions& options) {
          return read_by_vtk(path, VtkFormat::xml, options);
        },
    .times = xml_times};

extern const MeshFormat vtk_legacy_mesh_format{
    .name = "legacy VTK",
    .extensions = ".vtk",
    .takes_content = [](const std::filesystem::path&,
                        std::string_view head) { return head.starts_with("# vtk DataFile"); },
    .read =
        [](const std::filesystem::path& path, const MeshReadOptions& options) {
          check_legacy_vtk_cells(path);
          check_legacy_vtk_numbers(path);
          return read_by_vtk(path, VtkFormat::legacy, options);
        }};

/// A file of NetCDF, which may be one of HDF5.
extern const MeshFormat exodus_format{
    .name = "Exodus II",
    .extensions = ".ex2 .e .exo .g",
    .takes_content =
        [](const std::filesystem::path&, std::string_view head) {
          const bool net_cdf = head.starts_with("CDF") || head.starts_with("\x89HDF");
          return net_cdf && (has(head, "num_nodes") || has(head, "num_el_blk"));
        },
    .read =
        [](const std::filesystem::path& path, const MeshReadOptions& options) {
          check_net_cdf_size(path);
          return read_by_vtk(path, VtkFormat::exodus, options);
        },
    .times = exodus_times};

}  // namespace pellucid
