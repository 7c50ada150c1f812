// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/compare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>

#include "pellucid/cpu/render.h"
#include "pellucid/reference/render.h"
#include "pellucid/render/integrate_ray.h"
#include "pellucid/scene/internal/transfer_tables_storage.h"
#include "tests/scenes/difference.h"
#include "tests/support/accuracy.h"
#include "tests/support/one_layer.h"

namespace pellucid::scenes {
namespace {

/// Every seventh pixel's ray in double from end to end, to a tolerance of `ray_bound`.
void expect_exact_rays(const NamedScene& named) {
  const Scene& scene = named.scene;
  const CameraFrame<double> camera = make_camera_frame(scene.camera, scene.size);
  const TransferTablesStorage transfer(*test::volume_of(scene).transfer_function);
  const RayTolerance wanted{
      ray_bound, Grade::estimated, Precision::float64,
      std::max(1.0, test::volume_of(scene).transfer_function->largest_color())};
  test::ErrorRecord light(named.name + ", rays", ""), depth("  half-opacity depth", "");
  for (int pixel = 3; pixel < scene.size.width * scene.size.height; pixel += 7) {
    const Ray<double> ray = camera.ray(pixel % scene.size.width, pixel / scene.size.width);
    const ReferencePixel truth =
        reference_ray(*test::volume_of(scene).volume, *test::volume_of(scene).transfer_function,
                      ray.origin, ray.direction);
    const RayResult result = test::volume_of(scene).volume->visit([&](const auto& grid) {
      return integrate_ray(grid, nullptr, test::volume_of(scene).volume->grid_from_world().ray(ray),
                           transfer.tables(), wanted, true);
    });
    const std::string where = "pixel " + std::to_string(pixel);
    const Rgb<double> off = result.radiance - truth.radiance;
    for (const double error : {off.r, off.g, off.b, result.opacity - truth.opacity}) {
      light.add(std::fabs(static_cast<long double>(error)), where);
    }
    if (truth.opacity > 0.01) {
      const double off_depth = result.half_opacity_depth - truth.half_opacity_depth;
      depth.add(std::fabs(static_cast<long double>(off_depth)), where);
    }
  }
  light.print();
  depth.print();
  EXPECT_LE(light.largest(), ray_bound) << named.name;
  // What is looked for inside of a cell (pellucid/render/integrate_ray.h); all grids here are
  // uniform.
  const long double cell_diagonal = static_cast<long double>(
      length(test::volume_of(scene).volume->description().placement.spacing));
  EXPECT_LE(depth.largest(), cell_diagonal * 0x1p-23L) << named.name;
}

}  // namespace

void expect_exact(const NamedScene& named) {
  RenderOptions options;
  options.outputs.depth = true;
  Scene scene = named.scene;
  const auto [reference, reference_report] = render_reference(scene, options);
  float most = 0;
  for (const auto& pixel : reference.pixels) most = std::max(most, pixel[3]);
  EXPECT_GT(most, 0.01f) << named.name << ": there is nothing to see, so nothing is tested";

  for (const auto& [precision, label, bound] :
       {std::tuple{Precision::float64, "double", double_bound},
        std::tuple{Precision::float32, "float", float_bound}}) {
    scene.integration.precision = precision;
    scene.integration.tolerance = smallest_tolerance;
    const auto [image, report] = render(scene, options);
    const Difference error = difference(image, reference);
    std::printf("[ accuracy ] %-48s %-6s %s; %.2f s, reference %.2f s\n", named.name.c_str(), label,
                error.text().c_str(), report.seconds, reference_report.seconds);
    EXPECT_LE(error.largest, bound) << named.name << ", " << label << ": " << error.text();
  }
  expect_exact_rays(named);
}

}  // namespace pellucid::scenes
