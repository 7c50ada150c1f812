// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>

#include "pellucid/cluster/ray_pixel.h"
#include "pellucid/cluster/render.h"
#include "pellucid/cluster/sub_scene.h"
#include "pellucid/cpu/renderer.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/internal/absorbing_blocks.h"
#include "prepass.h"
#include "tests/scenes/makers.h"

namespace pellucid {
namespace {

using scenes::make_volume;
using scenes::transfer;

RayPixel any_pixel(std::mt19937& random) {
  std::uniform_real_distribution<float> part(0, 1);
  const float opacity = part(random);
  return {opacity * part(random), opacity * part(random),
          opacity * part(random), opacity,
          1e-3f * part(random),   0};
}

TEST(RayPixel, OverIsAssociativeWithinItsError) {
  std::mt19937 random(1);
  for (int n = 0; n < 10000; ++n) {
    const RayPixel a = any_pixel(random), b = any_pixel(random), c = any_pixel(random);
    const RayPixel left = over(over(a, b), c), right = over(a, over(b, c));
    EXPECT_NEAR(left.red, right.red, 2e-7);
    EXPECT_NEAR(left.opacity, right.opacity, 2e-7);
    EXPECT_NEAR(left.error, right.error, 1e-6);
    // e = e1 + (1 - a1) e2, and never less.
    const double exact = double{a.error} + (1 - double{a.opacity}) * double{b.error};
    EXPECT_GE(double{over(a, b).error}, exact);
    EXPECT_LT(double{over(a, b).error}, exact + 3e-7);
  }
}

TEST(RayPixel, WhatIsUnknownBehindOpaqueIsKnown) {
  const RayPixel opaque{1, 1, 1, 1, 0, 0};
  RayPixel unknown;
  unknown.error = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(std::isfinite(over(opaque, unknown).error));
  EXPECT_TRUE(std::isinf(over(RayPixel{}, unknown).error));
}

TEST(RayPixel, NothingIsRoundedWithAnEmptyPart) {
  std::mt19937 random(2);
  for (int n = 0; n < 100; ++n) {
    const RayPixel pixel = any_pixel(random);
    for (const RayPixel& both : {over(RayPixel{}, pixel), over(pixel, RayPixel{})}) {
      EXPECT_EQ(both.red, pixel.red);
      EXPECT_EQ(both.opacity, pixel.opacity);
      EXPECT_EQ(both.error, pixel.error);
    }
  }
  EXPECT_FALSE(is_empty({0, 0, 0, 0, 1e-6f, 0}));
  EXPECT_FALSE(is_empty({0, 0, 0, 0, 0, 1}));
}

TEST(RenderPixels, AreThoseOfTheFrame) {
  Volume::Description of;
  of.dimensions = {24, 20, 22};
  const auto volume = make_volume<std::uint8_t>(of, [](int i, int j, int k) {
    return 128 + 60 * std::sin(0.7 * i + 0.4 * j) * std::cos(0.5 * k);
  });
  Scene scene;
  scene.layers.push_back(Layer{VolumeContent{
      volume,
      transfer({{0, 0, {1, 1, 1}}, {128, 0.02, {1, 0.4, 0.1}}, {255, 0.3, {0.1, 0.6, 1}}})}});
  scene.camera = Camera{};
  scene.camera.position = {60, 50, 70};
  scene.camera.focal_point = {12, 10, 11};
  scene.size = {30, 26};
  scene.integration.tolerance = 1e-4;
  const BrickTree tree = BrickTree::split({}, {{0, 0, 0}, {23, 19, 21}}, 3, {}, true);
  Renderer renderer;
  for (int brick = 0; brick < 3; ++brick) {
    RayRegion region = tree.region(brick);
    region.allowance = [](const Ray<double>&) { return 0.5; };
    RenderOptions options;
    options.outputs.error = true;
    options.outputs.region = std::make_shared<const RayRegion>(region);
    const Image frame = renderer.render(scene, options).image;
    std::vector<PixelRequest> same, finer;
    for (int row = 0; row < 26; row += 3) {
      for (int column = 0; column < 30; column += 2) {
        same.push_back({column, row, 0.5});
        finer.push_back({column, row, 0.02});
      }
    }
    const Image again = renderer.render_pixels(scene, options, same).image;
    const Image better = renderer.render_pixels(scene, options, finer).image;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < same.size(); ++i) {
      const auto at = static_cast<std::size_t>(same[i].row * 30 + same[i].column);
      EXPECT_EQ(again.pixels[i], frame.pixels[at]);
      EXPECT_EQ(again.error[i], frame.error[at]);
      EXPECT_LE(better.error[i], 0.02 * scene.integration.tolerance + 1e-6);
      EXPECT_NEAR(better.pixels[i][0], frame.pixels[at][0], frame.error[at] + better.error[i]);
      seen += frame.pixels[at][3] > 0 ? 1 : 0;
    }
    EXPECT_GT(seen, 10u);
  }
  EXPECT_THROW(renderer.render_pixels(scene, {}, {{0, 0, 1}}), Error);
}

/// One of seven ranks, each of which looks at its own part.
class OneOfSeven : public Communicator {
 public:
  explicit OneOfSeven(int of) : rank_(of) {}
  int rank() const noexcept override { return rank_; }
  int size() const noexcept override { return 7; }
  std::vector<std::string> gather_all(const std::string& own,
                                      const std::function<void()>&) override {
    return {own};
  }
  void reduce_all(std::span<double>, Reduction) override {}
  void broadcast(std::span<float>) override {}
  void composite(std::span<RayPixel>, int) override {}
  void composite_in_front(std::span<RayPixel>, int) override {}
  [[noreturn]] void abort(int status) noexcept override { std::_Exit(status); }
  void send(int, const RankSignal&) override {}
  std::optional<RankSignal> receive() override { return {}; }

 private:
  int rank_;
};

TEST(NanValues, AreCountedOnce) {
  Volume::Description of;
  of.dimensions = {16, 12, 14};
  of.centering = Centering::cell;
  of.placement.spacing = {0.5, 1, 2};
  const auto volume = make_volume<float>(of, [](int i, int j, int k) {
    return (i * 7 + j * 3 + k) % 5 == 0 ? NAN : static_cast<float>(i);
  });
  Scene scene;
  Layer layer{VolumeContent{volume, transfer({{0, 0, {1, 1, 1}}, {9, 1, {1, 1, 1}}})}};
  layer.transform.translation = {3, 4, 5};
  scene.layers.push_back(layer);
  const SceneFrame frame = frame_of(scene);
  const BrickTree tree =
      BrickTree::split(frame.world_from_frame, frame.bounds, 7, {}, frame.on_grid);
  std::size_t all = 0, parts = 0;
  for (int rank = 0; rank < 7; ++rank) {
    OneOfSeven own(rank);
    const Scene part = sub_scene(scene, tree, rank);
    all += nan_values(own, tree, part).at(0);
    parts += grid_of(part.layers[0])->statistics().nan;
  }
  EXPECT_EQ(all, volume->statistics().nan);
  EXPECT_GT(parts, all);  // of the layers around bricks, too
}

TEST(StretchSources, AreNotForRanks) {
  class Nothing : public StretchSource {
   public:
    Nothing() : StretchSource({"nothing", {{0, 0, 0}, {1, 1, 1}}, {{"x", 0, 1}}}) {}
    std::unique_ptr<StretchStream> stream(const StretchDemand&) const override { return nullptr; }
  };
  Scene scene;
  scene.layers = {{SourceContent{std::make_shared<const Nothing>(), transfer({{0, 1, {}}})}}};
  OneOfSeven ranks(0);
  try {
    render(ranks, scene);
    ADD_FAILURE() << "rendered";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "ranks: layer 1 has a stretch source, which ranks do not take; render it in one "
                 "process");
  }
}

Volume::Description description(std::array<int, 3> dimensions, Centering centering) {
  Volume::Description result;
  result.dimensions = dimensions;
  result.centering = centering;
  result.placement.origin = {3, 4, 5};
  result.placement.spacing = {1, 2, 0.5};
  result.placement.direction.column[0] = {0.8, 0.6, 0};
  result.placement.direction.column[1] = {-0.6, 0.8, 0};
  return result;
}

std::shared_ptr<const Volume> some_volume(const Volume::Description& of) {
  return make_volume<std::int16_t>(of, [](int i, int j, int k) {
    return std::lround(1000 * std::sin(0.3 * i) * std::cos(0.2 * j + 0.1 * k));
  });
}

TEST(SubVolume, KeepsItsPlaceAndItsValues) {
  for (const Centering centering : {Centering::point, Centering::cell}) {
    const auto whole = some_volume(description({20, 17, 13}, centering));
    const IndexBox box{{3, 0, 5}, {7, 17, 4}};
    const Volume part = sub_volume(*whole, box);
    EXPECT_EQ(part.statistics().minimum, whole->statistics().minimum);
    const auto& all = std::get<DataArray<std::int16_t>>(whole->data());
    const auto& some = std::get<DataArray<std::int16_t>>(part.data());
    for (int k = 0; k < 4; ++k) {
      for (int j = 0; j < 17; ++j) {
        for (int i = 0; i < 7; ++i) {
          const Vec3<double> a = part.world_from_grid().point({1.0 * i, 1.0 * j, 1.0 * k});
          const Vec3<double> b = whole->world_from_grid().point({3.0 + i, 1.0 * j, 5.0 + k});
          EXPECT_LT(length(a - b), 1e-12);
          EXPECT_EQ(some[static_cast<std::size_t>(i + 7 * (j + 17 * k))],
                    all[static_cast<std::size_t>(i + 3 + 20 * (j + 17 * (k + 5)))]);
        }
      }
    }
  }
}

TEST(SubVolume, RefusesWhatIsOutside) {
  const auto whole = some_volume(description({8, 8, 8}, Centering::point));
  EXPECT_THROW(sub_volume(*whole, {{0, 0, 1}, {8, 8, 8}}), Error);
  EXPECT_THROW(sub_volume(*whole, {{-1, 0, 0}, {8, 8, 8}}), Error);
  EXPECT_THROW(sub_volume(*whole, {{0, 0, 0}, {8, 0, 8}}), Error);
  EXPECT_THROW(whole->as_part_of(0, 1), Error);
}

TEST(SubVolume, BricksHoldTheirCellsAndALayerMore) {
  const Volume::Description of = description({40, 30, 20}, Centering::point);
  const DataExtent extent = extent_of(of, {});
  const BrickTree tree =
      BrickTree::split(extent.world_from_data, extent.box, 7, {}, extent.is_uniform_grid);
  for (int brick = 0; brick < 7; ++brick) {
    const IndexBox box = indices_of_brick(of, {}, tree, brick);
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      const double lower = tree.box(brick).lower[a], upper = tree.box(brick).upper[a];
      const int first = std::max(static_cast<int>(std::floor(lower)) - 1, 0);
      const int last = std::min(static_cast<int>(std::ceil(upper)) + 1, of.dimensions[axis] - 1);
      EXPECT_LE(box.first[axis], first);
      EXPECT_GE(box.first[axis], first - 1);
      EXPECT_GE(box.first[axis] + box.count[axis] - 1, last);
      EXPECT_LE(box.first[axis] + box.count[axis] - 1, last + 1);
    }
  }
}

TEST(Survey, SlabsFindWhatIsSeenOfTheWhole) {
  for (const Centering centering : {Centering::point, Centering::cell}) {
    const auto whole = some_volume(description({20, 17, 45}, centering));
    const auto function = transfer({{500, 0, {1, 1, 1}}, {950, 1, {1, 1, 1}}, {999, 0, {1, 1, 1}}});
    const Layer layer{VolumeContent{whole, function}};
    const DataExtent extent = extent_of(layer);
    const std::array<Vec3<double>, 8> expected = visible_corners(layer);
    for (const int ranks : {1, 2, 3, 8}) {
      Survey survey(whole->description(), {}, extent.box, {3, 3, 4});
      for (int rank = 0; rank < ranks; ++rank) {
        for (const SurveySlab& slab : slabs_of(whole->description(), rank, ranks, 6000)) {
          const Layer part{VolumeContent{
              std::make_shared<const Volume>(sub_volume(*whole, slab.values)), function}};
          survey.add(slab, absorbing_blocks(part));
        }
      }
      const auto found = survey.corners(extent.world_from_data);
      ASSERT_TRUE(found.has_value());
      for (std::size_t n = 0; n < 8; ++n) EXPECT_LT(length((*found)[n] - expected[n]), 1e-12);
      BrickWeights weights{{3, 3, 4}, std::vector<double>(36, 0)};
      survey.add_to(weights);
      EXPECT_NEAR(std::accumulate(weights.weight.begin(), weights.weight.end(), 0.0), 1, 1e-12);
    }
  }
}

}  // namespace
}  // namespace pellucid
