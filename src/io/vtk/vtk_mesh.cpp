// SPDX-License-Identifier: Apache-2.0
//
// Meshes that VTK reads: its XML and legacy files, and Exodus II.
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "legacy_vtk_cells.h"
#include "legacy_vtk_numbers.h"
#include "meshes/mesh_archive.h"
#include "meshes/mesh_format.h"
#include "netcdf/net_cdf_size.h"
#include "pellucid/scene/error.h"
#include "process/contained.h"
#include "text/text.h"
#include "vtk/xml/vtk_xml_check.h"
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
    const ContainedBytes bytes = run_contained_answer(
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
        }};

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
        }};

}  // namespace pellucid
