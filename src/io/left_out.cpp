// SPDX-License-Identifier: Apache-2.0
//
// Stands in for the sources that builds for a first picture leave out (PELLUCID_FIRST_PICTURE).
#include "pellucid/scene/internal/left_out.h"

#include "axes/grid_axes.h"
#include "axes/positions_beside.h"
#include "meshes/load_mesh_step.h"
#include "meshes/mesh_format.h"
#include "pellucid/io/color_bar.h"
#include "pellucid/io/figure.h"
#include "pellucid/io/film.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/import_transfer_function.h"
#include "pellucid/io/mesh_source.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/io/read_volume.h"
#include "volumes/unread_formats.h"

namespace pellucid {

// Volumes of formats that are not in the table.

void refuse_unread_format(const std::filesystem::path&) {}

void refuse_unknown_format(const std::filesystem::path& path) {
  throw left_out(path.string() + ": what reads it (read are " + volume_extensions() + ")");
}

// Meshes.

bool is_mesh_file(const std::filesystem::path&) {
  return false;
}

std::string mesh_extensions() {
  return ".vtu …";
}

LoadedMesh load_mesh(const MeshSource& source, const ParallelFor&) {
  throw left_out(source.file.string() + ": what reads meshes");
}

LoadedMesh load_mesh_step(const MeshSource& source, const MeshChannels*, const ParallelFor&) {
  throw left_out(source.file.string() + ": what reads meshes");
}

std::vector<double> mesh_times(const std::filesystem::path& path, const MeshReadOptions&) {
  throw left_out(path.string() + ": what reads meshes");
}

// Functions of all steps: that of the step that is shown stands for them.

std::vector<std::size_t> choose_for_all_steps(SceneDescription&, const SceneTimes&,
                                              const ParallelFor&, const StepsAsked&) {
  return {};
}

// Transfer functions of other programs.

bool needs_import(std::string_view) {
  return false;
}

ImportedTransferFunction import_transfer_function(std::string_view, const std::string& name,
                                                  const ImportOptions&) {
  throw left_out(name + ": what reads transfer functions of other programs");
}

// Positions of values. A lone .npy says none.

PositionsBeside positions_beside(std::span<const ArrayBeside>, std::span<const std::int64_t>,
                                 const KnownAxes&) {
  throw left_out("what places values by arrays beside them");
}

void place_axes(Volume::Description&, const std::array<AxisPositions, 3>&, const ReadOptions&) {}

// OpenEXR.

void write_exr(const Image&, const std::filesystem::path& path) {
  throw left_out(path.string() + ": what writes .exr");
}

void write_error_exr(const Image&, double, const std::filesystem::path& path) {
  throw left_out(path.string() + ": what writes .exr");
}

void write_values_exr(const Image&, const std::filesystem::path& path) {
  throw left_out(path.string() + ": what writes .exr");
}

Image read_exr(const std::filesystem::path& path) {
  throw left_out(path.string() + ": what reads .exr");
}

// Color bars.

std::vector<ColorBar> color_bars(const SceneDescription&, const Scene&) {
  return {};
}

Image with_color_bars(const Image&, const std::vector<ColorBar>&) {
  throw left_out("--color-bar: what draws color bars");
}

void check_draws_color_bars() {
  throw left_out("--color-bar: what draws color bars");
}

// Figures.

FigureSpace figure_space(const SceneDescription&, const Scene&) {
  return {};
}

std::string accuracy_caption(const FigureAccuracy&) {
  return {};
}

FigureFormat figure_format(const std::filesystem::path&) {
  return FigureFormat::pdf;
}

void check_figure(const Figure&, ImageSize, FigureFormat) {
  throw left_out("--figure: what draws figures");
}

void write_figure(const Image&, const Figure&, const std::filesystem::path&) {
  throw left_out("--figure: what draws figures");
}

}  // namespace pellucid
