// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "tests/packet/lit_scenes.h"
#include "tests/scenes/gallery.h"
#include "tests/scenes/layer_makers.h"
#include "tests/scenes/meshes.h"

namespace pellucid {

/// Random layers of all kinds, whose data go up to 200.
class RandomLayers {
 public:
  explicit RandomLayers(unsigned seed) : random_(seed) {}

  Scene scene() {
    Scene scene;
    const int layers = 1 + static_cast<int>(3.5 * unit());
    for (int n = 0; n < layers; ++n) scene.layers.push_back(layer(layers > 1));
    if (unit() < 0.4) scene.clips = {clip()};
    look_at_data(scene, random_);
    return scene;
  }

 private:
  double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  double both() { return 2 * unit() - 1; }

  scenes::TransferPointer function(double most) {
    const auto color = [&] { return random_color(random_); };
    scenes::Points points{{60, 0, color()}, {100, most * unit(), color()}};
    if (unit() < 0.3) {
      points.push_back({110, 0, color()});
      points.push_back({150, 0, color()});
      points.push_back({150, 0.5 * most, color()});
    }
    points.push_back({200, most * unit(), color()});
    // Colors bend where extinctions do not.
    if (unit() < 0.3) {
      for (int i = 0; i < 5; ++i) {
        const double share = (i + 1) / 6.0;
        const TransferFunction::Point first = points.front(), second = points[1];
        points.insert(points.begin() + 1 + i,
                      {60 + 40 * share, second.extinction * share, color()});
        points.back().color = first.color;
      }
    }
    return scenes::transfer(points);
  }

  Clip clip() {
    Clip result{ClipPlane{{0.3 * both(), 0.3 * both(), 0.3 * both()}, {both(), both(), both()}}};
    if (unit() < 0.3) result.shape = ClipSphere{{0.5 * both(), 0.5 * both(), 0}, 0.3 + unit()};
    if (unit() < 0.3) result.shape = ClipBox{{-0.5, -0.6, -2}, {0.7 * unit(), 2, 2}};
    result.keep_inside = unit() < 0.6;
    return result;
  }

  /// A mask of shells.
  std::shared_ptr<const LabelMask> mask(const Volume& volume) {
    Volume::Description description = volume.description();
    description.name = "labels";
    const auto labels = scenes::make_volume<std::uint8_t>(
        description, [](int i, int j, int k) { return (i * i + 2 * j * j + k * k) / 40 % 4; });
    std::vector<LabelMask::Choice> choices{{1, function(2)}, {3, function(1)}};
    return std::make_shared<const LabelMask>(std::make_shared<const LabelVolume>(labels),
                                             std::move(choices));
  }

  /// A grid of planes at uneven distances.
  scenes::VolumePointer rectilinear() {
    Volume::Description description = scenes::grid_description({9, 11, 8}, {0, 0, 0});
    for (std::size_t a = 0; a < 3; ++a) {
      double x = -1;
      for (int i = 0; i < description.dimensions[a]; ++i) {
        description.coordinates[a].push_back(x);
        x += 0.1 + 0.25 * unit();
      }
    }
    return scenes::make_volume<float>(description, [&](int i, int j, int k) {
      return 100 + 90 * std::sin(0.7 * i + 0.3 * j) * std::cos(0.5 * k);
    });
  }

  Layer mesh() {
    const auto pointer = scenes::make_mesh(
        unit() < 0.5 ? scenes::random_delaunay(60, static_cast<unsigned>(random_()))
                     : scenes::box_of_cubes(3));
    return {MeshContent{
        scenes::on_mesh(pointer, {scenes::at_points(*pointer, "field",
                                                    [](const Vec3<double>& p) {
                                                      return 200 * scenes::wave(p.x, p.y, p.z);
                                                    })}),
        function(2)}};
  }

  /// A table of values in [0, 1]; as a factor, its extinctions are factors.
  TransferFunction table(double most) {
    scenes::Points points{{0.1 * unit(), most * unit(), random_color(random_)}};
    for (double at = 0.2 + 0.2 * unit(); at < 1; at += 0.1 + 0.4 * unit()) {
      points.push_back({at, unit() < 0.3 ? 0 : most * unit(), random_color(random_)});
    }
    return TransferFunction(points);
  }

  /// The same channels, of which one has NaN here and there.
  static std::shared_ptr<const Channels> with_vacuum(const Channels& channels, int which) {
    std::vector<Channel> result;
    for (int c = 0; c < channels.count(); ++c) {
      result.push_back(channels[c]);
      if (c != which) continue;
      const Volume& volume = *channels[c].volume;
      result.back().volume =
          scenes::make_volume<float>(volume.description(), [&](int i, int j, int k) {
            const double value = volume.visit([&](const auto& grid) {
              return static_cast<double>(grid.data[grid.offset(i, j, k)]);
            });
            return (5 * i + 3 * j + 7 * k) % 41 == 0 ? std::nan("") : value;
          });
    }
    return std::make_shared<const Channels>(std::move(result));
  }

  /// Gaussians of two variables, tables, or both, on a grid or a mesh; now and then with a factor.
  Layer several_variables() {
    Layer result = scenes::gaussians();
    if (unit() < 0.25) return result;
    std::vector<GaussianPrimitive> primitives;
    for (int i = 0; i < 1 + static_cast<int>(4 * unit()); ++i) {
      GaussianPrimitive& one = primitives.emplace_back();
      one.channels = {0, 1};
      one.center = {unit(), unit()};
      one.matrix = {{1 / (0.05 + 0.4 * unit()), 3 * both()}, {0, 1 / (0.05 + 0.4 * unit())}};
      one.extinction = 4 * unit();
      one.color = random_color(random_);
    }
    std::vector<ChannelTransferFunction> tables;
    while (tables.size() < 3 && unit() < 0.4) tables.push_back({unit() < 0.5 ? 0 : 1, table(2)});
    if (!tables.empty() && unit() < 0.5) primitives.clear();
    std::optional<ChannelTransferFunction> factor;
    if (unit() < 0.3) factor = {unit() < 0.5 ? 0 : 1, table(1.5)};
    const auto function = std::make_shared<const MultivariateTransferFunction>(
        2, std::move(primitives), std::move(tables), std::move(factor));
    if (unit() < 0.7) {
      auto& content = std::get<ChannelsContent>(result.content);
      content.transfer_function = function;
      if (unit() < 0.4) content.channels = with_vacuum(*content.channels, unit() < 0.5 ? 0 : 1);
      return result;
    }
    const auto pointer = scenes::make_mesh(scenes::box_of_cubes(3));
    const auto at = [&](const char* name, double turn) {
      return scenes::at_points(*pointer, name, [=](const Vec3<double>& p) {
        return scenes::wave(p.x, turn * p.y, p.z - turn * p.x);
      });
    };
    return {MeshContent{scenes::on_mesh(pointer, {at("one", 1), at("other", -0.6)}), function}};
  }

  Layer layer(bool has_others) {
    const double kind = unit();
    Layer result = scenes::labels();
    bool has_gradient = false, is_volume = false;
    if (kind < 0.55) {
      const bool vacuum = unit() < 0.3;
      const auto volume =
          kind < 0.08 ? rectilinear()
                      : any_volume(random_, static_cast<int>(4 * unit()), vacuum ? 0.01 : 0);
      result = {VolumeContent{volume, function(3), nullptr}};
      if (unit() < 0.3 || !has_others) {
        std::get<VolumeContent>(result.content).mask = mask(*volume);
      }
      has_gradient = is_volume = true;
    } else if (kind < 0.75) {
      result = mesh();
      has_gradient = true;
    } else if (kind < 0.85) {
      result = several_variables();
      if (unit() < 0.6) {
        result.shading = random_shading(random_);
        result.shading->channel = unit() < 0.5 ? 0 : 1;
      }
    }
    if (has_gradient) {
      if (unit() < 0.5) result.shading = random_shading(random_);
      if (is_volume && unit() < 0.25) result.gradient_opacity = random_factor(random_);
      if (unit() < 0.2) result.isosurfaces = random_surfaces(random_);
      if (unit() < 0.15) {
        result.slices = {{{0.2 * both(), 0, 0.1}, {both(), both(), both()}, unit()}};
      }
    }
    if (unit() < 0.5) result.transform = scenes::oblique();
    if (unit() < 0.2) result.clips = {clip()};
    return result;
  }

  std::mt19937 random_;
};

}  // namespace pellucid
