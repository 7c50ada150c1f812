// SPDX-License-Identifier: Apache-2.0
//
// A field of one's own, without a grid: particles in a spiral. A ball that is a volume on a grid
// overlaps them.
//
//   own_field [PICTURE [PARTICLES [WIDTH]]]
#include "particles.h"

#include <pellucid/cpu/render.h>
#include <pellucid/io/image_files.h>
#include <pellucid/scene/builtin_fields.h>
#include <pellucid/scene/error.h>
#include <pellucid/scene/scene.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

namespace {

using Points = std::vector<pellucid::TransferFunction::Point>;

pellucid::Layer particles(int count) {
  const auto cloud = std::make_shared<const ParticleCloud>(spiral_of_particles(count));
  // From the density to the extinction per length, and to a color.
  const auto function =
      std::make_shared<const pellucid::TransferFunction>(Points{{0.1, 0, {0.1, 0.2, 0.9}},
                                                                {1, 4, {0.2, 0.4, 1}},
                                                                {2.5, 12, {1, 0.6, 0.4}},
                                                                {6, 40, {1, 0.9, 0.7}}});
  pellucid::Layer layer{pellucid::SourceContent{cloud, function}};
  layer.name = "spiral";
  layer.shading = pellucid::Shading{0.5, 0.6, 0.1};
  return layer;
}

/// Returns a volume that overlaps an arm: both mix.
pellucid::Layer ball() {
  const auto data =
      std::make_shared<const pellucid::Volume>(pellucid::make_builtin_field("sphere", 24));
  const auto function = std::make_shared<const pellucid::TransferFunction>(
      Points{{0.3, 0, {0.2, 1, 0.5}}, {0.5, 6, {0.2, 1, 0.5}}, {0.7, 0, {0.2, 1, 0.5}}});
  pellucid::Layer layer{pellucid::VolumeContent{data, function}};
  layer.name = "ball";
  for (pellucid::Vec3<double>& column : layer.transform.matrix.column) column = 0.3 * column;
  layer.transform.translation = {0.42, -0.38, 0};
  return layer;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::string picture = argc > 1 ? argv[1] : "own_field.png";
    const int count = argc > 2 ? std::atoi(argv[2]) : 600;
    const int width = argc > 3 ? std::atoi(argv[3]) : 640;
    pellucid::Scene scene;
    scene.layers = {particles(count), ball()};
    scene.lights = {{pellucid::HeadLight{}}, {pellucid::PointLight{{0, 0, 0.6}}, {0.8, 0.7, 0.5}}};
    scene.camera.position = {0.6, -2.6, 2.4};
    scene.camera.up = {0, 0, 1};
    scene.background = pellucid::calm_background();
    scene.camera.vertical_angle = 32;
    scene.size = {width, width * 3 / 4};
    const auto [image, report] = pellucid::render(scene);
    pellucid::write_png(image, picture, scene.background);
    std::printf("%d particles, largest error %.2g of %.2g, %.1f s\n", count, report.largest_error,
                scene.integration.tolerance, report.seconds);
    return report.largest_error <= scene.integration.tolerance ? 0 : 1;
  } catch (const pellucid::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
