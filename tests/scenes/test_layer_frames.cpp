// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pellucid/cpu/render.h"
#include "tests/scenes/gallery.h"
#include "tests/scenes/makers.h"
#include "tests/scenes/reference_frame.h"
#include "tests/scenes/verdict.h"

/// Frames of several layers, beside what the tolerance matrix asks of all scenes.
namespace pellucid::scenes {
namespace {

Image rendered(const Scene& scene, RenderReport* report = nullptr) {
  RenderOptions options;
  options.machine.threads = 2;
  options.outputs.error = options.outputs.depth = true;
  RenderResult frame = render(scene, options);
  if (report != nullptr) *report = std::move(frame.report);
  return std::move(frame.image);
}

/// Pixels of a and b differ by no more than both say.
void expect_agree(const Image& a, const Image& b) {
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      ASSERT_LE(std::abs(a.pixels[i][c] - b.pixels[i][c]), a.error[i] + b.error[i])
          << "pixel " << i;
    }
  }
}

TEST(LayerFrames, DoNotDependOnTheOrderOfTheLayers) {
  int scenes = 0;
  for (const GalleryEntry& entry : layer_gallery()) {
    const Exhibit exhibit = entry.make(24);
    // Later projections lie over earlier ones.
    const bool has_order = std::ranges::any_of(
        exhibit.layers, [](const Layer& layer) { return layer.projection.has_value(); });
    if (exhibit.layers.size() < 2 || has_order) continue;
    SCOPED_TRACE(entry.name);
    ++scenes;
    Scene scene = scene_of(exhibit, 0, 24);
    for (const Grade grade : {Grade::estimated, Grade::proved}) {
      scene.integration.grade = grade;
      const Image as_listed = rendered(scene);
      std::reverse(scene.layers.begin(), scene.layers.end());
      const Image reversed = rendered(scene);
      expect_agree(as_listed, reversed);
    }
  }
  EXPECT_GE(scenes, 10);
}

/// A plane that cuts data with a jump obliquely, at the finest sampling there is: where others
/// sample along rays, such an edge is a staircase.
TEST(LayerFrames, AClippedEdgeHasNoStaircase) {
  for (const GalleryEntry& entry : layer_gallery()) {
    if (entry.name != "layers: clipped by a plane through jumps") continue;
    Scene scene = scene_of(entry.make(2), 1, 2);
    scene.samples = largest_samples;
    scene.integration.tolerance = 1e-4;
    const Verdict verdict =
        judge(rendered(scene), reference_frame(scene, 2), scene.integration.tolerance);
    EXPECT_TRUE(verdict.kept()) << verdict.text();
    EXPECT_EQ(verdict.said_over, 0);
    EXPECT_GT(verdict.brightest, 0.05);
    return;
  }
  FAIL() << "the gallery has no such scene";
}

/// Where a ray meets one layer only, the others cost it nothing: it is what that layer's own
/// tracer finds.
TEST(LayerFrames, SideBySideAreAsEachByItself) {
  for (const GalleryEntry& entry : layer_gallery()) {
    if (entry.name != "layers: side by side, a grid, Gaussians and a mesh") continue;
    const Scene all = scene_of(entry.make(32), 0, 32);
    RenderReport together;
    const Image image = rendered(all, &together);
    std::uint64_t cells = 0;
    std::vector<Image> alone;
    for (const Layer& layer : all.layers) {
      Scene scene = all;
      scene.layers = {layer};
      RenderReport report;
      alone.push_back(rendered(scene, &report));
      cells += report.cells;
    }
    int seen = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      int present = 0;
      const Image* one = nullptr;
      for (const Image& of_layer : alone) {
        if (of_layer.pixels[i][3] == 0) continue;
        ++present;
        one = &of_layer;
      }
      if (present != 1) continue;
      ++seen;
      for (std::size_t c = 0; c < 4; ++c) {
        EXPECT_NEAR(image.pixels[i][c], one->pixels[i][c], 2 * all.integration.tolerance);
      }
      EXPECT_NEAR(image.depth[i], one->depth[i], 0.05);
    }
    EXPECT_GT(seen, 60);
    // No more cells are looked at than by all of them together.
    EXPECT_LE(static_cast<double>(together.cells), 1.05 * static_cast<double>(cells));
    return;
  }
  FAIL() << "the gallery has no such scene";
}

/// A ray along the surface of a clip is inside of it or not, as rounding has it: then the pixel
/// says that it is not known. The others are not affected.
TEST(LayerFrames, ARayAlongAClipSaysThatItIsNotKnown) {
  Layer layer{VolumeContent{make_volume<float>(grid_description({3, 3, 3}, {-1, -1, -1}),
                                               [](int, int, int) { return 1; }),
                            transfer({{0, 5, {1, 0.5, 0.2}}})}};
  Scene scene;
  scene.layers = {layer};
  scene.size = {25, 25};
  scene.camera.projection = Projection::orthographic;
  scene.camera.position = {0, 0, -5};
  scene.camera.parallel_scale = 1.5;
  Clip box{ClipBox{{-0.48, -2, -2}, {2, 2, 2}}}, cylinder{ClipCylinder{{0, 0, -2}, {0, 0, 2}, 0.6}};
  for (const Clip& clip : {Clip{ClipPlane{{0, 0, 0}, {0.6, 0.8, 0}}}, box, cylinder}) {
    for (const bool inside : {true, false}) {
      scene.clips = {clip};
      scene.clips[0].keep_inside = inside;
      const Image image = rendered(scene);
      const ReferenceFrame truth = reference_frame(scene, 2);
      int unknown = 0;
      for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (image.error[i] > static_cast<float>(scene.integration.tolerance)) ++unknown;
        for (std::size_t c = 0; c < 4; ++c) {
          ASSERT_LE(std::abs(static_cast<double>(image.pixels[i][c]) - truth.pixels[i][c]),
                    static_cast<double>(image.error[i]))
              << "pixel " << i << ", clip " << clip.shape.index();
        }
      }
      EXPECT_LE(unknown, 25) << "clip " << clip.shape.index();
    }
  }
}

/// The same between labels: a ray along their border shows one or the other, as rounding has it.
TEST(LayerFrames, ARayAlongABorderOfLabelsSaysThatItIsNotKnown) {
  // Borders of values at 0 and ±0.6, where the rays of columns and rows 7, 12 and 17 run.
  const auto description = grid_description({4, 4, 4}, {-0.9, -0.9, -0.9}, {0.6, 0.6, 0.6});
  const auto labels = std::make_shared<const LabelVolume>(make_volume<std::uint8_t>(
      description, [](int i, int j, int k) { return (i + 2 * j + k) % 3; }));
  const Layer segmentation{
      LabelContent{labels, std::make_shared<const LabelTable>(std::vector<LabelStyle>{
                               {1, "", {1, 0.2, 0.1}, 0.5}, {2, "", {0.1, 0.4, 1}, 3}})}};
  const Layer masked{VolumeContent{
      make_volume<float>(description, [](int i, int, int) { return i; }),
      transfer({{0, 0.5, {1, 0.2, 0.1}}}),
      std::make_shared<const LabelMask>(
          labels, std::vector<LabelMask::Choice>{{1, transfer({{0, 3, {0.1, 0.4, 1}}})}})}};
  Scene scene;
  scene.size = {25, 25};
  scene.camera.projection = Projection::orthographic;
  scene.camera.parallel_scale = 1.5;
  for (const Layer& layer : {segmentation, masked}) {
    scene.layers = {layer};
    for (const Vec3<double> from : {Vec3<double>{0, 0, -5}, {0, 0, 7.3}, {1e-15, 1e-15, -5}}) {
      scene.camera.position = from;
      scene.camera.focal_point = {from.x, from.y, 0};
      const Image image = rendered(scene);
      const ReferenceFrame truth = reference_frame(scene, 2);
      int unknown = 0;
      for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const std::size_t column = i % 25, row = i / 25;
        const auto runs_along = [](std::size_t n) { return n == 7 || n == 12 || n == 17; };
        if (image.error[i] > static_cast<float>(scene.integration.tolerance)) {
          ++unknown;
          EXPECT_TRUE(runs_along(column) || runs_along(row))
              << "pixel " << column << ", " << row << " from " << from.x << ", " << from.z << ": "
              << image.error[i];
        }
        for (std::size_t c = 0; c < 4; ++c) {
          ASSERT_LE(std::abs(static_cast<double>(image.pixels[i][c]) - truth.pixels[i][c]),
                    static_cast<double>(image.error[i]))
              << "pixel " << column << ", " << row << " from " << from.z;
        }
      }
      EXPECT_GT(unknown, 20);
    }
  }
}

/// One of these rays touches a tetrahedron in a point, within rounding, and goes on in another.
TEST(LayerFrames, ARayThroughAPointOfAMeshMeetsASurfaceOnce) {
  for (const GalleryEntry& entry : light_gallery()) {
    if (entry.name != "isosurfaces: in tetrahedra, beside a grid, and labels") continue;
    Scene scene = scene_of(entry.make(25), 0, 25);
    scene.layers.resize(1);
    scene.integration.tolerance = 1e-5;
    const Verdict verdict =
        judge(rendered(scene), reference_frame(scene, 2), scene.integration.tolerance);
    EXPECT_TRUE(verdict.kept()) << verdict.text();
    EXPECT_EQ(verdict.said_over, 0);
    return;
  }
  FAIL() << "the gallery has no such scene";
}

/// What a table is off by is seen in the color of the layer behind it.
TEST(LayerFrames, ReserveForTablesWhatIsSeenBehindThem) {
  const double error = 0.01;
  const VolumePointer data =
      make_volume<float>(grid_description({3, 3, 3}), [](int i, int, int) { return i; });
  const auto table = std::make_shared<const TransferFunction>(
      Points{{0, 0.1, {0, 0, 0}}, {2, 2, {0, 0, 0}}}, error);
  Scene scene;
  scene.layers = {{VolumeContent{data, table}}};
  EXPECT_LE(approximation_error(scene), error);
  scene.layers.push_back({VolumeContent{data, transfer({{0, 1, {100, 0, 0}}})}});
  EXPECT_GE(approximation_error(scene), 100 * error / std::exp(1.0));
  scene.layers[1].visible = false;
  EXPECT_LE(approximation_error(scene), error);
  scene.background = Rgb<double>{0, 50, 0};
  EXPECT_GE(approximation_error(scene), 50 * error / std::exp(1.0));
}

}  // namespace
}  // namespace pellucid::scenes
