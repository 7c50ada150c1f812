// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/scene/layer.h"

namespace pellucid {

/// 3 × 2 × 2 values on a uniform grid whose numbers are exact in any order of operations.
inline Volume::Description exact_grid() {
  Volume::Description d;
  d.dimensions = {3, 2, 2};
  d.placement.spacing = {2, 1, 0.5};
  d.placement.origin = {10, -20, 30};
  d.name = "small";
  return d;
}

inline std::shared_ptr<const Volume> counting(const Volume::Description& d) {
  std::vector<float> values(static_cast<std::size_t>(d.dimensions[0]) *
                            static_cast<std::size_t>(d.dimensions[1]) *
                            static_cast<std::size_t>(d.dimensions[2]));
  std::iota(values.begin(), values.end(), 0.0F);
  return std::make_shared<const Volume>(d, VolumeData(std::move(values)));
}

inline std::shared_ptr<const TransferFunction> table_of(double extinction, double color) {
  return std::make_shared<const TransferFunction>(
      std::vector<TransferFunction::Point>{{0, extinction, {color, color / 2, 0}}});
}

inline std::shared_ptr<const MultivariateTransferFunction> gaussian_of(int channels) {
  return std::make_shared<const MultivariateTransferFunction>(
      channels, std::vector<GaussianPrimitive>{{{0}, {0.5}, {{4}}, 3, {1, 5, 1}}});
}

/// Two tetrahedra with a point that none uses, and so many channels: at points, then of cells.
inline std::shared_ptr<const MeshChannels> two_tetrahedra(int channels) {
  TetrahedralMesh::Description d;
  d.points = {{0, 0, 0}, {1, 0, 0}, {9, 9, 9}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  d.tetrahedra = {{0, 1, 3, 4}, {1, 3, 4, 5}};
  d.point_numbers = {70, 71, 72, 73, 74, 75};
  d.name = "two.vtu";
  std::vector<MeshChannel> list;
  list.push_back({"p", "Pa", Centering::point, std::vector<float>{0, 1, 2, 3, 4, 5}});
  if (channels > 1) list.push_back({"m", "", Centering::cell, std::vector<std::uint8_t>{1, 2}});
  return std::make_shared<const MeshChannels>(std::make_shared<const TetrahedralMesh>(d),
                                              std::move(list));
}

inline std::shared_ptr<const Channels> two_channels() {
  return std::make_shared<const Channels>(
      std::vector<Channel>{{"a", "K", counting(exact_grid())}, {"b", "", counting(exact_grid())}});
}

}  // namespace pellucid
