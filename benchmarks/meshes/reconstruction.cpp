// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/meshes/reconstruction.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <utility>

#include "pellucid/cpu/render.h"
#include "pellucid/cpu/threads.h"
#include "pellucid/scene/tetrahedralize.h"
#include "tests/scenes/cameras.h"
#include "tests/scenes/real.h"
#include "tests/support/one_layer.h"

namespace pellucid::bench {
namespace {

/// Pictures are this near to their integrals, far below what is to be seen.
constexpr double tolerance = 1e-5;

struct Data {
  std::string name;
  scenes::VolumePointer volume;
};

/// The middle of a volume, as floats, `points` data values along each axis at most.
scenes::VolumePointer middle_of(const Volume& volume, int points) {
  Volume::Description d = volume.description();
  const std::array<int, 3> whole = d.dimensions;
  std::array<int, 3> first{};
  Vec3<double> shift{};
  for (std::size_t a = 0; a < 3; ++a) {
    d.dimensions[a] = std::min(whole[a], points);
    first[a] = (whole[a] - d.dimensions[a]) / 2;
  }
  const GridPlacement& p = d.placement;
  shift = p.direction.column[0] * (first[0] * p.spacing.x) +
          p.direction.column[1] * (first[1] * p.spacing.y) +
          p.direction.column[2] * (first[2] * p.spacing.z);
  d.placement.origin = d.placement.origin + shift;
  return std::visit(
      [&](const auto& values) {
        return scenes::make_volume<float>(d, [&](int i, int j, int k) {
          const auto at = [&](int n, std::size_t a) {
            return static_cast<std::size_t>(n + first[a]);
          };
          return values[at(i, 0) + static_cast<std::size_t>(whole[0]) *
                                       (at(j, 1) + static_cast<std::size_t>(whole[1]) * at(k, 2))];
        });
      },
      volume.data());
}

std::vector<Data> data_of(const ReconstructionOptions& options) {
  std::vector<Data> list{
      {"Marschner-Lobb, 41³ points", scenes::builtin("marschner_lobb", options.tiny ? 12 : 41)}};
  if (options.tiny) return list;
  for (const scenes::RealData& real : scenes::real_data()) {
    if (!std::filesystem::exists(real.file)) continue;
    if (real.name == "brain") {
      list.push_back({"brain (ch2), the middle 64³ points", middle_of(*scenes::read(real), 64)});
    }
    if (real.name == "hydrogen") {
      list.push_back({"hydrogen atom, 128³ points", scenes::read(real)});
    }
  }
  return list;
}

/// A ramp of 4 optical depths along an edge of the box where it is densest, or a thin peak of 200.
scenes::TransferPointer table(const Volume& volume, bool narrow) {
  const VolumeStatistics& s = volume.statistics();
  const double range = s.maximum - s.minimum;
  const auto at = [&](double share) { return s.minimum + share * range; };
  const auto corners = volume.world_corners();
  const double edge = length(corners[1] - corners[0]);
  if (!narrow) {
    return scenes::transfer({{at(0.1), 0, {0.1, 0.2, 0.9}}, {at(1), 4 / edge, {1, 0.8, 0.2}}});
  }
  return scenes::transfer({{at(0.395), 0, {0.2, 0.4, 1}},
                           {at(0.4), 200 / edge, {0.9, 0.9, 0.5}},
                           {at(0.405), 0, {1, 0.5, 0.1}}});
}

ReconstructionResult difference(const Image& a, const Image& b) {
  ReconstructionResult result;
  double sum = 0;
  std::size_t over = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    double largest = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      const double off =
          std::fabs(static_cast<double>(a.pixels[i][c]) - static_cast<double>(b.pixels[i][c]));
      largest = std::max(largest, off);
      sum += off * off;
    }
    result.largest = std::max(result.largest, largest);
    if (largest > default_tolerance) ++over;
  }
  const auto count = static_cast<double>(a.pixels.size());
  result.rms = std::sqrt(sum / (4 * count));
  result.share_over = static_cast<double>(over) / count;
  return result;
}

}  // namespace

std::vector<ReconstructionResult> study_reconstruction(const ReconstructionOptions& options) {
  std::vector<ReconstructionResult> results;
  const MeshArrayChoice value{"value", std::nullopt, {}};
  for (const Data& data : data_of(options)) {
    options.say("reconstruction: " + data.name);
    const auto mesh = cut_into_tetrahedra(to_unstructured(*data.volume), {&value, 1},
                                          parallel_for(default_thread_count()));
    for (const bool narrow : {false, true}) {
      Scene grid;
      test::volume_of(grid).volume = data.volume;
      test::volume_of(grid).transfer_function = table(*data.volume, narrow);
      grid.camera = scenes::three_cameras(*data.volume).front().camera;
      grid.size = {options.size, options.size};
      grid.integration.tolerance = tolerance;
      Scene cut = grid;
      cut.layers = {{MeshContent{mesh, test::volume_of(grid).transfer_function}}};
      ReconstructionResult result = difference(render(grid).image, render(cut).image);
      result.data = data.name;
      result.transfer_function = narrow ? "peak, half width 1/200" : "ramp";
      results.push_back(std::move(result));
    }
  }
  return results;
}

}  // namespace pellucid::bench
