// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <utility>

#include "pellucid/scene/scene.h"
#include "tests/scenes/gallery.h"
#include "tests/scenes/meshes.h"

namespace pellucid::scenes {
namespace {

using Place = Vec3<double>;

/// In [0, 1] within [-1,1]³.
double wave(double x, double y, double z) {
  return 0.5 + 0.28 * std::sin(2 * x + 1.7 * y) * std::cos(2.1 * z - 0.4) +
         0.2 * std::sin(1.3 * y - z);
}

Points ramp(double extinction, Rgb<double> low, Rgb<double> high) {
  return {{0.2, 0, low}, {0.9, extinction, high}};
}

/// A jump, a peak and a gap, in which nothing absorbs.
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
      on_mesh(pointer,
              {at_points(*pointer, "field", [](const Place& p) { return wave(p.z, p.x, -p.y); })}),
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

/// Labels 0 to 5 in shells and halves, 2 without a style.
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

Layer labels(Centering centering = Centering::point) {
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

/// A turn about an oblique axis, with a shear and a move.
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

Clip cut_away(Clip clip) {
  clip.keep_inside = false;
  return clip;
}

/// What everything in the gallery is about as large as.
Exhibit exhibit(std::vector<Layer> layers, std::vector<Clip> clips = {}) {
  Exhibit result;
  result.cameras = three_cameras(Box<double>{{-1.2, -1.2, -1.2}, {1.2, 1.2, 1.2}});
  result.layers = std::move(layers);
  result.clips = std::move(clips);
  return result;
}

}  // namespace

Gallery layer_gallery() {
  const Points warm = ramp(1.5, {0.3, 0.1, 0}, {1, 0.7, 0.3});
  const Points cold = ramp(1.2, {0, 0.1, 0.3}, {0.3, 0.7, 1});
  const Clip plane{ClipPlane{{0.05, 0.1, -0.1}, {0.3, -0.5, 0.8}}};
  const Clip box{ClipBox{{-0.6, -0.71, -0.52}, {0.55, 0.62, 0.73}}};
  const Clip sphere{ClipSphere{{0.1, -0.05, 0.2}, 0.83}};
  const Clip cylinder{ClipCylinder{{-0.4, -0.5, -0.9}, {0.3, 0.4, 0.8}, 0.6}};
  const auto made = [](auto make) { return [make](int) { return make(); }; };
  return {
      {"layers: two grids", made([=] {
         return exhibit({grid({17, 15, 16}, warm), grid({9, 12, 11}, cold)});
       })},
      {"layers: oblique grids with jumps", made([=] {
         return exhibit(
             {grid({12, 13, 11}, jumps(1.5)), moved(grid({10, 9, 12}, jumps(0.8)), oblique())});
       })},
      {"layers: three, with Gaussians", made([=] {
         return exhibit({gaussians(), moved(gaussians(), oblique()), grid({8, 9, 7}, cold)});
       })},
      {"layers: a grid and a mesh", made([=] {
         return exhibit({grid({13, 11, 12}, jumps(1)), mesh(4, warm)});
       })},
      {"layers: a mesh, moved, in a mesh", made([=] {
         return exhibit({mesh(3, cold), moved(mesh(4, jumps(1)), oblique())});
       })},
      {"layers: clipped by a plane through jumps", made([=] {
         return exhibit({grid({15, 14, 13}, jumps(2))}, {plane});
       })},
      {"layers: a ball and a cylinder cut out of a grid", made([=] {
         return exhibit({grid({15, 14, 13}, ramp(1, {0.3, 0.6, 1}, {1, 0.9, 0.2}))},
                        {cut_away({ClipSphere{{0.1, -0.05, 0.2}, 0.5}}), cut_away(cylinder)});
       })},
      {"layers: a box, kept of one and cut out of the other", made([=] {
         Layer inside = grid({15, 14, 13}, warm), outside = grid({11, 12, 13}, cold);
         inside.clips = {box};
         outside.clips = {cut_away(box)};
         return exhibit({inside, outside});
       })},
      {"layers: sphere and cylinder", made([=] {
         Layer first = grid({15, 14, 13}, jumps(1.3)), second = mesh(4, warm);
         first.clips = {sphere, cut_away(cylinder)};
         second.clips = {cylinder};
         return exhibit({first, second});
       })},
      {"layers: labels", made([=] { return exhibit({labels()}); })},
      {"layers: labels of cells, clipped, in a grid", made([=] {
         Layer organs = labels(Centering::cell);
         organs.clips = {plane};
         return exhibit({organs, grid({12, 11, 13}, ramp(0.4, {0.5, 0.5, 0.5}, {1, 1, 1}))});
       })},
      {"layers: oblique labels in Gaussians", made([=] {
         return exhibit({moved(labels(), oblique()), gaussians()});
       })},
      {"layers: a mask", made([=] { return exhibit({masked()}); })},
      {"layers: a mask, moved and clipped, and a mesh", made([=] {
         Layer organ = moved(masked(), oblique());
         organ.clips = {cut_away(plane)};
         return exhibit({organ, mesh(3, cold)}, {sphere});
       })},
      {"layers: side by side, a grid, Gaussians and a mesh", made([=] {
         Affine<double> left, right;
         for (Affine<double>* map : {&left, &right}) {
           for (Vec3<double>& column : map->matrix.column) column = 0.4 * column;
         }
         left.translation = {-0.7, 0.1, -0.2};
         right.translation = {0.6, -0.3, 0.4};
         return exhibit({moved(grid({12, 13, 11}, jumps(3)), left), moved(gaussians(), right),
                         moved(mesh(3, ramp(4, {0, 0.1, 0.3}, {0.3, 0.7, 1})), {left.matrix, {}})});
       })},
      {"layers: grids that overlap in part", made([=] {
         Affine<double> aside;
         aside.translation = {0.9, 0.4, -0.7};
         return exhibit({grid({12, 13, 11}, warm), moved(grid({11, 12, 12}, jumps(1)), aside)});
       })},
      {"layers: clipped Gaussians", made([=] {
         Layer layer = gaussians();
         layer.clips = {cut_away({ClipSphere{{0.1, -0.05, 0.2}, 0.5}})};
         return exhibit({layer}, {plane});
       })},
      {"layers: a clipped mesh", made([=] {
         Layer layer = mesh(4, jumps(1));
         layer.clips = {cut_away(box)};
         return exhibit({layer});
       })},
      {"backdrop: in a grid", made([=] {
         Exhibit result = exhibit({grid({15, 14, 13}, jumps(1.5))});
         result.backdrop = true;
         return result;
       })},
      {"backdrop: in Gaussians, four samples a pixel", made([=] {
         Exhibit result = exhibit({gaussians()});
         result.backdrop = true;
         result.samples = 2;
         return result;
       })},
      {"backdrop: in a mesh", made([=] {
         Exhibit result = exhibit({mesh(4, warm)});
         result.backdrop = true;
         return result;
       })},
      {"backdrop: in labels and a clipped grid", made([=] {
         Exhibit result = exhibit(
             {labels(), grid({12, 11, 13}, ramp(0.4, {0.5, 0.5, 0.5}, {1, 1, 1}))}, {plane});
         result.backdrop = true;
         return result;
       })},
      {"layers: one of each kind", made([=] {
         Layer hidden = grid({5, 5, 5}, jumps(9));
         hidden.visible = false;
         return exhibit({grid({12, 13, 11}, warm), gaussians(), mesh(3, jumps(1)), labels(),
                         moved(masked(), oblique()), hidden},
                        {cut_away(box)});
       })},
  };
}

}  // namespace pellucid::scenes
