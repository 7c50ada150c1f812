// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/look.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/error.h"

namespace pellucid::test_look {
namespace {

constexpr int side = 24;
constexpr std::size_t count = std::size_t{side} * side * side;

template <class Value>
Volume make_volume(const std::vector<Value>& values, std::string name = "", double spacing = 1) {
  Volume::Description description;
  description.dimensions = {side, side, side};
  description.placement.spacing = {spacing, spacing, spacing};
  description.name = std::move(name);
  return Volume(description, VolumeData(values));
}

/// Noisy air, and a cube of soft tissue with a core of bone: 1/8 and 1/216 of the box.
std::vector<float> head(float air = 0, float tissue = 100, float bone = 1000, float noise = 5) {
  std::vector<float> values;
  unsigned random = 1;
  for (int k = 0; k < side; ++k) {
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) {
        const int d = std::max(
            {std::abs(2 * i - side + 1), std::abs(2 * j - side + 1), std::abs(2 * k - side + 1)});
        random = random * 1664525U + 1013904223U;
        const float n = noise * (static_cast<float>(random >> 8) / 8388608.0F - 1);
        values.push_back((d < side / 6 ? bone : d < side / 2 ? tissue : air) + n);
      }
    }
  }
  return values;
}

/// Values by the distance from the middle, in half sides.
std::vector<float> ball(const std::function<double(double)>& value) {
  std::vector<float> values;
  for (int k = 0; k < side; ++k) {
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) {
        const double x = 2.0 * i / side - 1, y = 2.0 * j / side - 1, z = 2.0 * k / side - 1;
        values.push_back(static_cast<float>(value(std::sqrt(x * x + y * y + z * z))));
      }
    }
  }
  return values;
}

template <class To>
std::vector<To> as(const std::vector<float>& values) {
  std::vector<To> result;
  for (const float v : values) result.push_back(static_cast<To>(std::lround(v)));
  return result;
}

double extinction_at(const Look& look, double value) {
  return look.transfer_function.view<double>().evaluate(value).extinction;
}

TEST(Look, OfDataWithSurfacesIsDenseAndInLight) {
  const Volume volume = make_volume(head());
  const Look look = choose_look(volume);
  EXPECT_EQ(look.name, "scan");
  EXPECT_EQ(look.reason, "data with surfaces");
  ASSERT_TRUE(look.shading);
  EXPECT_TRUE(look.isosurfaces.empty());
  EXPECT_EQ(extinction_at(look, 0), 0);
  // Opaque within a few voxels, from the tissue on.
  EXPECT_GT(extinction_at(look, 100), 1);
  EXPECT_GT(extinction_at(look, 1000), extinction_at(look, 100));
  // A border of two voxels is one, too.
  EXPECT_EQ(choose_look(make_volume(ball([](double r) {
              return 100 * std::clamp((0.7 - r) * side / 4 + 0.5, 0.0, 1.0);
            }))).name,
            "scan");
  for (const float unit : {1e-30F, 1e30F}) {
    EXPECT_EQ(choose_look(make_volume(head(0, 100 * unit, 1000 * unit, 5 * unit))).name, "scan");
  }
}

TEST(Look, OfAMedicalImageIsKnownByItsName) {
  for (const char* const name : {"/a/head.nii", "HEAD.NII.GZ", "x.mgz", "b.hdr"}) {
    EXPECT_EQ(choose_look(make_volume(head(), name)).name, "mr") << name;
  }
}

TEST(Look, OfHounsfieldUnitsShowsBoneOrSkin) {
  const Look bone = choose_look(make_volume(head(-1000, 40, 1000, 10)));
  EXPECT_EQ(bone.name, "ct");
  EXPECT_EQ(extinction_at(bone, 40), 0);
  EXPECT_GT(extinction_at(bone, 1000), 0);
  EXPECT_TRUE(bone.shading);
  std::vector<float> soft = head(-1000, 40, 60, 20);
  soft[5000] = 400;  // a single tooth
  const Look skin = choose_look(make_volume(soft));
  EXPECT_EQ(skin.name, "ct-skin");
  EXPECT_GT(extinction_at(skin, 40), 0);
  EXPECT_EQ(extinction_at(skin, -900), 0);
  // Twelve bits that begin at air.
  const Look shifted = choose_look(make_volume(as<std::int16_t>(head(30, 1064, 2024, 10))));
  EXPECT_EQ(shifted.name, "ct");
  EXPECT_EQ(extinction_at(shifted, 1064), 0);
  EXPECT_GT(extinction_at(shifted, 2024), 0);
  // Neither are these.
  EXPECT_EQ(choose_look(make_volume(head(0, 1, 2, 0.01F))).name, "scan");
}

TEST(Look, OfLabelsIsLabelsAndOfTwoValuesTheSurfaceBetween) {
  const auto parts = [](int labels) {
    std::vector<std::uint8_t> values(count);
    for (std::size_t i = 0; i < count; ++i) {
      values[i] =
          static_cast<std::uint8_t>(i / 576 < 6 ? 0 : i / 576 % static_cast<unsigned>(labels));
    }
    return values;
  };
  const Look look = choose_look(make_volume(parts(7)));
  EXPECT_EQ(look.name, "labels");
  EXPECT_TRUE(look.as_labels);
  const Look mask = choose_look(make_volume(parts(2)));
  EXPECT_EQ(mask.name, "mask");
  ASSERT_EQ(mask.isosurfaces.size(), 1U);
  EXPECT_EQ(mask.isosurfaces[0].value, 0.5);
}

TEST(Look, OfSmoothDataIsSurfaces) {
  const Look look = choose_look(make_volume(ball([](double r) { return std::exp(-2 * r * r); })));
  EXPECT_EQ(look.name, "simulation");
  ASSERT_GE(look.isosurfaces.size(), 3U);
  EXPECT_TRUE(look.shading);
  for (std::size_t i = 1; i < look.isosurfaces.size(); ++i) {
    EXPECT_GT(look.isosurfaces[i].value, look.isosurfaces[i - 1].value);
    EXPECT_GT(look.isosurfaces[i].opacity, look.isosurfaces[i - 1].opacity);
  }
  // Of whole numbers, between them: a value that data have is anywhere.
  const Look whole = choose_look(
      make_volume(as<std::uint8_t>(ball([](double r) { return 200 * std::exp(-2 * r * r); }))));
  EXPECT_EQ(whole.name, "simulation");
  for (const Isosurface& surface : whole.isosurfaces) {
    EXPECT_EQ(surface.value - std::floor(surface.value), 0.5);
  }
}

TEST(Look, OfDataAroundZeroHasSurfacesOfBothSigns) {
  std::vector<float> waves;
  for (int k = 0; k < side; ++k) {
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) {
        const auto bump = [&](double x) {
          const double dx = i - x, dy = j - 12.0, dz = k - 12.0;
          return std::exp(-(dx * dx + dy * dy + dz * dz) / 60);
        };
        waves.push_back(static_cast<float>(3 * bump(7) - 2 * bump(17)));
      }
    }
  }
  const Look look = choose_look(make_volume(waves));
  EXPECT_EQ(look.name, "simulation");
  const auto is_negative = [](const Isosurface& s) { return s.value < 0; };
  EXPECT_EQ(std::ranges::count_if(look.isosurfaces, is_negative), 2);
  EXPECT_EQ(look.isosurfaces.size(), 5U);
  for (const Isosurface& surface : look.isosurfaces) {
    if (surface.value < 0) {
      EXPECT_GT(surface.color.b, surface.color.r) << surface.value;
    } else {
      EXPECT_GT(surface.color.r, surface.color.b) << surface.value;
    }
  }
}

TEST(Look, OfNoiseIsHazeAndOfImagesGlows) {
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, 10);
  std::vector<float> values(count);
  for (float& v : values) v = noise(random);
  const Look haze = choose_look(make_volume(values));
  EXPECT_EQ(haze.name, "haze");
  EXPECT_FALSE(haze.shading);
  // Spots among noise.
  const std::vector<float> spots = ball([](double r) { return 3000 * std::exp(-8 * r * r); });
  for (std::size_t i = 0; i < count; ++i) values[i] = 100 + 12 * values[i] + spots[i];
  const Look glow = choose_look(make_volume(values, "cells.ome.tif"));
  EXPECT_EQ(glow.name, "microscopy");
  EXPECT_LT(extinction_at(glow, 300), 0.3 * extinction_at(glow, 2500));
}

TEST(Look, OfAStatisticOfBothSignsIsItsSurfaces) {
  // Noise of deviation 1, and two spots at ±9: a map of a statistic.
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, 1);
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = [&](double x) {
      const double dx = static_cast<double>(i % side) - x,
                   dy = static_cast<double>(i / side % side) - 12.0,
                   dz = static_cast<double>(i / side / side) - 12.0;
      return 9 * std::exp(-(dx * dx + dy * dy + dz * dz) / 8);
    };
    values[i] = 0.5F * noise(random) + static_cast<float>(at(6) - at(18));
  }
  const Look look = choose_look(make_volume(values, "zmap.nii.gz"));
  EXPECT_EQ(look.name, "simulation");
  EXPECT_GE(look.isosurfaces.size(), 4U);
}

TEST(Look, OfBrightSpotsOnDarkGroundInImagesGlows) {
  std::vector<std::uint16_t> values(count, 100);
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 97 < 4 && i / side % 5 == 0) values[i] = static_cast<std::uint16_t>(900 + i % 300);
  }
  EXPECT_EQ(choose_look(make_volume(values, "spots.tif")).name, "microscopy");
}

TEST(Look, IsNoLabelsWhereTheyAreLargerThanLabelsMayBe) {
  std::vector<std::int32_t> values(count, 0);
  for (std::size_t i = 0; i < count; ++i) values[i] = i / 576 % 3 == 0 ? 0 : 312782628;
  EXPECT_FALSE(choose_look(make_volume(values)).as_labels);
}

TEST(Look, ForHounsfieldUnitsIsRefusedForOtherData) {
  const Volume volume = make_volume(head());
  for (const char* const name : {"ct", "ct-skin"}) {
    try {
      static_cast<void>(choose_look(volume, name));
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("Hounsfield"), std::string::npos) << error.what();
    }
  }
}

TEST(Look, IsMadeForAllDataThatThereAre) {
  const std::vector<std::vector<float>> values{
      std::vector<float>(count, 3), std::vector<float>(count, 0),
      std::vector<float>(count, std::numeric_limits<float>::quiet_NaN()),
      head(-2e37F, 0, 2e37F, 1e30F), head(0, 1e-38F, 1e-37F, 0)};
  for (const auto& each : values) {
    const Volume volume = make_volume(each);
    static_cast<void>(choose_look(volume));
    for (const LookName& look : looks()) {
      SCOPED_TRACE(look.name);
      if (look.name.starts_with("ct")) continue;  // of Hounsfield units alone
      EXPECT_EQ(choose_look(volume, look.name).name, look.name);
    }
  }
  for (const std::string_view name : builtin_field_names()) {
    const Volume volume = make_builtin_field(name, 33);
    for (const LookName& look : looks()) {
      SCOPED_TRACE(std::string(name) + " " + std::string(look.name));
      Layer layer;
      if (look.name.starts_with("ct")) continue;
      Look made = choose_look(volume, look.name);
      if (made.as_labels) continue;
      layer.content =
          VolumeContent{std::make_shared<const Volume>(volume),
                        std::make_shared<const TransferFunction>(made.transfer_function), nullptr};
      layer.shading = made.shading;
      layer.isosurfaces = std::move(made.isosurfaces);
      EXPECT_NO_THROW(check_layer(layer, "layer"));
    }
  }
}

TEST(Look, ThatIsNotThereIsRefusedByNameWithTheOthers) {
  try {
    static_cast<void>(choose_look(make_volume(head()), "bones"));
    FAIL();
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("\"bones\""), std::string::npos) << text;
    EXPECT_NE(text.find("simulation"), std::string::npos) << text;
  }
}

TEST(Look, LightsAreAsBrightAsOneTogether) {
  const Camera camera{Projection::perspective, {3, -5, 2}, {0, 0, 0}, {0, 0, 1}};
  const std::vector<Light> lights = look_lights(camera);
  ASSERT_EQ(lights.size(), 2U);
  const auto& key = std::get<DirectionalLight>(lights[1].kind);
  const Vec3<double> forward = normalized(camera.focal_point - camera.position);
  const Vec3<double> direction = normalized(key.direction);
  // On a surface that faces the eye.
  EXPECT_NEAR(lights[0].color.r + lights[1].color.r * dot(direction, forward), 1, 0.05);
  EXPECT_LT(direction.z, 0);  // from above
}

}  // namespace
}  // namespace pellucid::test_look
