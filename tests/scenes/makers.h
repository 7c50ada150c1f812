// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/scene/scene.h"

/// What scenes are made of.
namespace pellucid::scenes {

using VolumePointer = std::shared_ptr<const Volume>;
using TransferPointer = std::shared_ptr<const TransferFunction>;
using Points = std::vector<TransferFunction::Point>;

/// A volume of Value with f(i, j, k) at its points.
template <class Value, class Field>
VolumePointer make_volume(Volume::Description description, Field&& f) {
  const auto [nx, ny, nz] = description.dimensions;
  std::vector<Value> values;
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) values.push_back(static_cast<Value>(f(i, j, k)));
    }
  }
  return std::make_shared<const Volume>(std::move(description), VolumeData(std::move(values)));
}

/// A point-centred grid with its first value at `origin`.
Volume::Description grid_description(std::array<int, 3> dimensions, Vec3<double> origin = {0, 0, 0},
                                     Vec3<double> spacing = {1, 1, 1});

using FieldFunction = std::function<double(double x, double y, double z)>;
/// f at the points of [-1,1]³ (cell-centred: of equal cells that fill it), as floats.
VolumePointer sampled(std::array<int, 3> dimensions, const FieldFunction& f, const char* name,
                      Centering centering = Centering::point);
/// A built-in field (pellucid/scene/builtin_fields.h).
VolumePointer builtin(const char* name, int points);

TransferPointer transfer(Points points);
/// Red runs with the value, green swings three times, blue falls: (x, ½ + ½cos 7x, 1 − x) in 256
/// equal steps over [0, 1], linear between them.
Rgb<double> tabulated_color(double value);
/// An extinction on the 256 points of the color table and on corners of its own.
TransferPointer with_tabulated_color(const std::function<double(double)>& extinction,
                                     const std::vector<double>& corners);

Scene make_scene(VolumePointer volume, TransferPointer transfer_function, const Camera& camera,
                 ImageSize size);

}  // namespace pellucid::scenes
