// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/layer_makers.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "tests/scenes/meshes.h"

namespace pellucid::scenes {

double wave(double x, double y, double z) {
  return 0.5 + 0.28 * std::sin(2 * x + 1.7 * y) * std::cos(2.1 * z - 0.4) +
         0.2 * std::sin(1.3 * y - z);
}

Points ramp(double extinction, Rgb<double> low, Rgb<double> high) {
  return {{0.2, 0, low}, {0.9, extinction, high}};
}

Points jumps(double extinction) {
  return {{0.3, 0, {0.9, 0.9, 0.2}},
          {0.45, 0, {0.9, 0.9, 0.2}},
          {0.45, extinction, {0.9, 0.2, 0.1}},
          {0.6, 0.3 * extinction, {0.2, 0.9, 0.3}},
          {0.62, 0, {0.1, 0.2, 0.9}},
          {0.7, 0, {0.1, 0.2, 0.9}},
          {0.72, 3 * extinction, {0.8, 0.8, 1}},
          {0.74, 0, {0.8, 0.8, 1}}};
}

Layer grid(std::array<int, 3> dimensions, Points points) {
  return {VolumeContent{sampled(dimensions, wave, "wave"), transfer(std::move(points)), nullptr}};
}

Layer mesh(int cubes, Points points) {
  const MeshPointer pointer = make_mesh(box_of_cubes(cubes));
  return {MeshContent{
      on_mesh(pointer, {at_points(*pointer, "field",
                                  [](const Vec3<double>& p) { return wave(p.z, p.x, -p.y); })}),
      transfer(std::move(points))}};
}

Layer gaussians() {
  const auto one = sampled({14, 12, 13}, wave, "one");
  const auto other = sampled(
      {14, 12, 13}, [](double x, double y, double z) { return wave(-z, 0.7 * x, y); }, "other");
  GaussianPrimitive a, b;
  a.channels = {0, 1};
  a.center = {0.5, 0.45};
  a.matrix = {{7, -4}, {1, 5}};
  a.extinction = 4;
  a.color = {1, 0.6, 0.1};
  b.channels = {1};
  b.center = {0.7};
  b.matrix = {{12}};
  b.extinction = 2;
  b.color = {0.1, 0.5, 1};
  return {ChannelsContent{std::make_shared<const Channels>(
                              std::vector<Channel>{{"one", "", one}, {"other", "", other}}),
                          std::make_shared<const MultivariateTransferFunction>(
                              2, std::vector{a, b},
                              std::vector<ChannelTransferFunction>{
                                  {0, TransferFunction(ramp(0.4, {0, 0.3, 0}, {0, 1, 0.4}))}})}};
}

std::shared_ptr<const LabelVolume> segmentation(Centering centering) {
  return std::make_shared<const LabelVolume>(sampled(
      {15, 13, 14},
      [](double x, double y, double z) {
        const double r = std::sqrt(x * x + y * y + z * z);
        if (r > 1.1) return 0.0;
        if (r > 0.8) return x > 0 ? 1.0 : 2.0;
        return r > 0.45 ? (y > 0.1 ? 3.0 : 4.0) : 5.0;
      },
      "labels", centering));
}

Layer labels(Centering centering) {
  return {LabelContent{
      segmentation(centering),
      std::make_shared<const LabelTable>(std::vector<LabelStyle>{{1, "shell", {0.9, 0.7, 0.3}, 0.4},
                                                                 {3, "", {0.2, 0.8, 0.3}, 1.1},
                                                                 {4, "", {0.8, 0.1, 0.4}, 0.7},
                                                                 {5, "core", {0.3, 0.4, 1}, 5}})}};
}

Layer masked() {
  const auto data = sampled({15, 13, 14}, wave, "wave");
  return {VolumeContent{
      data, transfer(ramp(0.5, {0.4, 0.4, 0.4}, {1, 1, 1})),
      std::make_shared<const LabelMask>(
          segmentation(Centering::point),
          std::vector<LabelMask::Choice>{{3, transfer(jumps(2))},
                                         {5, transfer(ramp(6, {1, 0, 0}, {1, 0.8, 0}))},
                                         {0, transfer({{0, 0, {0, 0, 0}}})}})}};
}

Affine<double> oblique() {
  Affine<double> map;
  map.matrix = {{{0.83, 0.31, -0.22}, {-0.35, 0.8, 0.27}, {0.24, -0.1, 0.9}}};
  map.translation = {0.21, -0.13, 0.17};
  return map;
}

Layer moved(Layer layer, const Affine<double>& map) {
  layer.transform = map;
  return layer;
}

Layer with_vacuum(Points points) {
  const auto holes = [](double x, double y, double z) {
    return std::fabs(x + 0.7 * y - 0.4 * z) < 0.2 || (x < -0.4 && z > 0.5)
               ? std::numeric_limits<double>::quiet_NaN()
               : wave(x, y, z);
  };
  return {
      VolumeContent{sampled({14, 15, 13}, holes, "holes"), transfer(std::move(points)), nullptr}};
}

Layer oblique_cells(Points points) {
  Volume::Description description =
      grid_description({11, 8, 6}, {-0.9, -0.8, -0.7}, {0.16, 0.2, 0.31});
  description.placement.direction = {{{0.8, 0.6, 0}, {-0.6, 0.8, 0.1}, {0, 0.2, 1}}};
  description.centering = Centering::cell;
  return {VolumeContent{
      make_volume<std::int16_t>(
          description, [](int i, int j, int k) { return 100 * i - 37 * j * k + 11 * i * k; }),
      transfer(std::move(points)), nullptr}};
}

Clip cut_away(Clip clip) {
  clip.keep_inside = false;
  return clip;
}

Exhibit exhibit(std::vector<Layer> layers, std::vector<Clip> clips) {
  Exhibit result;
  result.cameras = three_cameras(Box<double>{{-1.2, -1.2, -1.2}, {1.2, 1.2, 1.2}});
  result.layers = std::move(layers);
  result.clips = std::move(clips);
  return result;
}

}  // namespace pellucid::scenes
