// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include "pellucid/scene/scene.h"
#include "tests/scenes/gallery.h"
#include "tests/scenes/layer_makers.h"

namespace pellucid::scenes {
namespace {

Layer projected(Layer layer, LayerProjection projection) {
  layer.projection = projection;
  return layer;
}

/// A line of one voxel, oblique to all axes, in noise.
Layer vessel() {
  const auto value = [](int i, int j, int k) {
    const int along = (i + j) / 2;
    if (std::abs(i - j) <= 1 && k == along) return 200;
    return (7 * i + 13 * j + 29 * k) % 23;
  };
  return {VolumeContent{
      make_volume<std::uint8_t>(
          grid_description({19, 19, 19}, {-1, -1, -1}, {1.0 / 9, 1.0 / 9, 1.0 / 9}), value),
      transfer({{0, 1, {0, 0, 0}}, {200, 1, {1, 1, 1}}}), nullptr}};
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
      {"projections: maximum of a line of one voxel",
       made([=] { return exhibit({projected(vessel(), LayerProjection::maximum)}); })},
      {"projections: maximum through jumps, of a rectilinear grid in a cylinder", made([=] {
         Volume::Description description = grid_description({9, 10, 8}, {-1, -1, -1});
         description.coordinates[0] = {-1, -0.9, -0.5, -0.45, 0, 0.1, 0.4, 0.8, 1.1};
         description.placement.spacing = {1, 0.21, 0.27};
         Layer layer{VolumeContent{
             make_volume<float>(
                 description, [](int i, int j, int k) { return wave(0.4 * i, 0.3 * j, 0.5 * k); }),
             transfer(jumps(1)), nullptr}};
         layer.clips = {cylinder};
         return exhibit({projected(layer, LayerProjection::maximum)});
       })},
      {"projections: minimum with clips and vacuum", made([=] {
         Layer layer = moved(with_vacuum(ramp(1, {0.2, 0.1, 0.9}, {1, 0.8, 0.1})), oblique());
         layer.clips = {cut_away(box)};
         return exhibit({projected(layer, LayerProjection::minimum)}, {sphere});
       })},
      {"projections: sum of an anisotropic oblique grid", made([=] {
         return exhibit({projected(oblique_cells({{-500, 0.2, {0.1, 0.3, 0.9}},
                                                  {300, 0.9, {0.9, 0.9, 0.2}},
                                                  {900, 1.7, {1, 0.5, 0.2}}}),
                                   LayerProjection::sum)});
       })},
      {"projections: mean of a mesh", made([=] {
         return exhibit({projected(mesh(4, warm), LayerProjection::mean)}, {cut_away(cylinder)});
       })},
      {"projections: extremes of meshes", made([=] {
         return exhibit({projected(mesh(3, warm), LayerProjection::minimum),
                         projected(moved(mesh(4, ramp(2, {0, 0, 1}, {1, 1, 0})), oblique()),
                                   LayerProjection::maximum)},
                        {plane});
       })},
      {"projections: mean and sum with vacuum over a grid and labels", made([=] {
         const Points pale = {{0, 0.3, {0.9, 0.1, 0.1}}, {1.5, 1, {0.4, 0.9, 1}}};
         Layer hidden = projected(vessel(), LayerProjection::sum);
         hidden.visible = false;
         return exhibit({projected(with_vacuum(pale), LayerProjection::mean),
                         grid({13, 11, 12}, jumps(1)), labels(),
                         projected(with_vacuum(pale), LayerProjection::sum), hidden});
       })},
  };
}

}  // namespace pellucid::scenes
