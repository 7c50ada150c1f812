// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pellucid/scene/presets.h"
#include "tests/scene/expect_error.h"

namespace pellucid::test_presets {
namespace {

/// A cube of 11³ values from `first` to `last`, evenly along x, of this spacing.
Volume ramp(float first, float last, double spacing = 1) {
  Volume::Description description;
  description.dimensions = {11, 11, 11};
  description.placement.spacing = {spacing, spacing, spacing};
  std::vector<float> values;
  for (int i = 0; i < 11 * 11 * 11; ++i) {
    values.push_back(first + (last - first) * static_cast<float>(i % 11) / 10);
  }
  return Volume(description, VolumeData(values));
}

std::vector<double> values_of(const TransferFunction& function) {
  std::vector<double> values;
  for (const auto& point : function.points()) values.push_back(point.value);
  return values;
}

TEST(Presets, AreFunctionsOfAnyData) {
  EXPECT_EQ(presets().size(), 7u);
  for (const Preset& preset : presets()) {
    const std::string name(preset.name);
    EXPECT_EQ(find_preset(name)->name, name);
    EXPECT_GT(preset.description.size(), 20u);
    for (const Volume& volume :
         {ramp(-1000, 3000), ramp(0, 1e-20F), ramp(1e30F, 2e30F), ramp(7, 7), ramp(-1e-3F, 0)}) {
      const bool fits = !preset.hounsfield || volume.statistics().minimum == -1000;
      if (!fits) {
        expect_error([&] { make_preset(name, volume); },
                     {name.c_str(), "is for Hounsfield units", "unless a range moves it"});
        continue;
      }
      const TransferFunction function = make_preset(name, volume);
      double largest = 0;
      for (const auto& p : function.points()) {
        largest = std::max(largest, p.extinction);
        EXPECT_LE(largest_component(p.color), 1) << name;
      }
      EXPECT_GT(largest, 0) << name;
      EXPECT_EQ(function.approximation_error(), 0) << name;
    }
  }
}

TEST(Presets, RelativeOnesScaleWithTheData) {
  for (const char* name : {"simulation-diverging", "simulation-isosurfaces", "x-ray"}) {
    const auto plain = make_preset(name, ramp(0, 1)).points();
    for (const float scale : {1e30F, 2e37F, 1e-30F}) {
      const auto points = make_preset(name, ramp(0, scale)).points();
      ASSERT_EQ(points.size(), plain.size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(points[i].value / static_cast<double>(scale), plain[i].value, 1e-4) << name;
        EXPECT_EQ(points[i].extinction, plain[i].extinction) << name;
      }
    }
  }
  EXPECT_NO_THROW(make_preset("mr-t1-brain", ramp(-1e37F, 2.1e37F)));
  EXPECT_NO_THROW(make_preset("x-ray", ramp(2.1e37F, 2.1e37F)));
  EXPECT_NO_THROW(make_preset("x-ray", ramp(0, 1), std::array{-2e37, 2e37}));
}

TEST(Presets, InHounsfieldUnitsAreMovedOrRefused) {
  const TransferFunction bone = make_preset("ct-bone", ramp(-1000, 1500));
  EXPECT_EQ(values_of(bone), values_of(make_preset("ct-bone", ramp(-1000, 3000, 0.5))));
  // An MR image.
  expect_error([] { make_preset("ct-bone", ramp(0, 1337)); }, {"the data are 0 to 1337"});
  // Twelve bits: a third air, the rest water, and some bone.
  Volume::Description description;
  description.dimensions = {30, 30, 30};
  std::vector<std::int16_t> values(27000, 1024);
  std::fill(values.begin(), values.begin() + 9000, 24);
  std::fill(values.end() - 500, values.end(), 2500);
  const TransferFunction moved = make_preset("ct-bone", Volume(description, VolumeData(values)));
  for (std::size_t i = 0; i < moved.points().size(); ++i) {
    EXPECT_NEAR(moved.points()[i].value, bone.points()[i].value + 1024, 1e-9);
    EXPECT_EQ(moved.points()[i].extinction, bone.points()[i].extinction);
  }
  // Nothing of water and soft tissue, and compact bone is dense: half of the light within a few mm.
  EXPECT_EQ(bone.points().front().extinction, 0);
  EXPECT_GE(bone.points().front().value, 100);
  EXPECT_GT(bone.points().back().extinction, 0.3);
}

TEST(Presets, AreRelativeToTheRangeAndTheMeanChordOtherwise) {
  // The mean chord of a cube is 2/3 of its edge: 10 · spacing here.
  for (const double spacing : {1.0, 1e-3, 50.0}) {
    const TransferFunction film = make_preset("x-ray", ramp(-40, 60, spacing));
    EXPECT_EQ(values_of(film), (std::vector<double>{-40, 60}));
    EXPECT_EQ(film.points()[0].extinction, 0);
    const double depth = film.points()[1].extinction * 10 * spacing * 2 / 3;
    EXPECT_NEAR(depth, 1.5, 0.05 * 1.5);  // rounded to two digits
  }
}

TEST(Presets, OfTissueGoByItsMedian) {
  // 0, 10, …, 100 in equal shares: above an eighth lie 20 to 100, of which 60 is the median.
  const TransferFunction brain = make_preset("mr-t1-brain", ramp(0, 100));
  EXPECT_EQ(brain.points().front().value, 0);
  EXPECT_NEAR(brain.points().back().value, 1.65 * 60, 1e-12);
  EXPECT_EQ(brain.points().front().extinction, 0);
}

TEST(Presets, AreMovedToARange) {
  for (const Preset& preset : presets()) {
    const TransferFunction moved =
        make_preset(preset.name, ramp(0, 1), std::array<double, 2>{100, 300});
    EXPECT_EQ(moved.points().front().value, 100) << preset.name;
    EXPECT_EQ(moved.points().back().value, 300) << preset.name;
  }
}

TEST(Presets, RefuseWhatIsNotThere) {
  expect_error([] { make_preset("ct-bones", ramp(0, 1)); },
               {"there is none of the name \"ct-bones\""});
  expect_error(
      [] {
        make_preset("x-ray", ramp(0, 1), std::array<double, 2>{1, 1});
      },
      {"two ascending numbers"});
  EXPECT_EQ(find_preset("ct-bones"), nullptr);
}

}  // namespace
}  // namespace pellucid::test_presets
