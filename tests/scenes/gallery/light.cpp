// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/scene/scene.h"
#include "tests/scenes/gallery.h"
#include "tests/scenes/layer_makers.h"
#include "tests/scenes/meshes.h"
#include "tests/scenes/real.h"

namespace pellucid::scenes {
namespace {

Layer lit(Layer layer, GradientKind gradient = GradientKind::smooth) {
  layer.shading = Shading{};
  layer.shading->gradient = gradient;
  return layer;
}

Layer with_factors(Layer layer, std::vector<GradientOpacity::Point> points,
                   GradientOpacity::Unit unit = GradientOpacity::Unit::world) {
  layer.gradient_opacity = std::make_shared<const GradientOpacity>(std::move(points), unit);
  return layer;
}

Layer with_surfaces(Layer layer, std::vector<Isosurface> surfaces) {
  layer.isosurfaces = std::move(surfaces);
  return layer;
}

Points peak_of_factors(double at, double half, double factor) {
  return {{at - half, 0, {}}, {at, factor, {}}, {at + half, 0, {}}};
}

/// Channels of waves, a function of all of them and a factor.
Layer with_factor(std::vector<VolumePointer> volumes, std::vector<GaussianPrimitive> primitives,
                  std::vector<ChannelTransferFunction> tables, int channel, Points factors) {
  std::vector<Channel> channels;
  for (VolumePointer& volume : volumes) {
    channels.push_back({"channel " + std::to_string(channels.size()), "", std::move(volume)});
  }
  const int count = static_cast<int>(channels.size());
  return {
      ChannelsContent{std::make_shared<const Channels>(std::move(channels)),
                      std::make_shared<const MultivariateTransferFunction>(
                          count, std::move(primitives), std::move(tables),
                          ChannelTransferFunction{channel, TransferFunction(std::move(factors))})}};
}

/// A wave of its own for each number, in [low, low + 1].
VolumePointer numbered_wave(int number, double low = 0) {
  const double n = number;
  return sampled(
      {13, 12, 14},
      [=](double x, double y, double z) {
        return low + wave(x * (1 - 0.2 * n) + 0.3 * n * z, y - 0.1 * n * x, z + 0.2 * n);
      },
      "numbered wave");
}

/// Colors of one variable, opacity of another, which has negative values, and a jump.
Layer colored_by_another(double low) {
  return with_factor(
      {numbered_wave(1), numbered_wave(3, low)}, {},
      {{0, TransferFunction({{0.2, 1, {0.1, 0.2, 1}},
                             {0.5, 1, {0.2, 1, 0.4}},
                             {0.5, 1, {1, 0.9, 0.1}},
                             {0.8, 1, {1, 0.2, 0}}})}},
      1, {{low + 0.35, 0, {}}, {low + 0.5, 1.5, {}}, {low + 0.5, 0.1, {}}, {low + 0.8, 4, {}}});
}

/// Red, green and blue of three variables, opacity of a fourth.
Layer colors_as_data() {
  std::vector<ChannelTransferFunction> tables;
  for (int c = 0; c < 3; ++c) {
    const Rgb<double> color{c == 0 ? 3.0 : 0, c == 1 ? 3.0 : 0, c == 2 ? 3.0 : 0};
    tables.push_back({c, TransferFunction({{0, 1.0 / 3, {}}, {1, 1.0 / 3, color}})});
  }
  return with_factor({numbered_wave(0), numbered_wave(1), numbered_wave(2), numbered_wave(4)}, {},
                     std::move(tables), 3, {{0.3, 0, {}}, {0.7, 3, {}}});
}

/// Gaussians times a peak of the other variable.
Layer weighted_gaussians() {
  const ChannelsContent content = std::get<ChannelsContent>(gaussians().content);
  const MultivariateTransferFunction& f = *content.transfer_function;
  return {ChannelsContent{
      content.channels,
      std::make_shared<const MultivariateTransferFunction>(
          2, f.primitives(), f.tables(),
          ChannelTransferFunction{1, TransferFunction(peak_of_factors(0.5, 0.15, 3))})}};
}

/// Two variables of a mesh; the second is negative.
Layer mesh_colored_by_another() {
  const MeshPointer pointer = make_mesh(box_of_cubes(4));
  return {MeshContent{
      on_mesh(pointer, {at_points(*pointer, "color",
                                  [](const Vec3<double>& p) { return wave(p.z, p.x, -p.y); }),
                        at_points(*pointer, "opacity",
                                  [](const Vec3<double>& p) { return wave(-p.y, p.z, p.x) - 2; })}),
      std::make_shared<const MultivariateTransferFunction>(
          2, std::vector<GaussianPrimitive>(),
          std::vector<ChannelTransferFunction>{
              {0, TransferFunction(Points{{0.2, 1, {0, 0.3, 1}}, {0.8, 1, {1, 0.7, 0}}})}},
          ChannelTransferFunction{1, TransferFunction(Points{{-1.7, 0, {}}, {-1.3, 3, {}}})})}};
}

Points clear() {
  return {{0, 0, {0.3, 0.5, 0.9}}, {1, 0, {1, 0.8, 0.4}}};
}

/// A peak of this half width.
Points peak(double at, double half, double extinction) {
  return {{at - half, 0, {1, 0.7, 0.3}},
          {at, extinction, {1, 0.8, 0.5}},
          {at + half, 0, {0.7, 0.8, 1}}};
}

/// Distance from the middle.
Layer ball(Points points) {
  return {VolumeContent{
      sampled(
          {16, 16, 16},
          [](double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); }, "ball"),
      transfer(std::move(points)), nullptr}};
}

/// Flat but for the last of 16 bits here and there, beside a step.
Layer almost_flat(Points points) {
  return {VolumeContent{make_volume<std::uint16_t>(grid_description({15, 14, 16}, {-1, -1, -1},
                                                                    {2.0 / 14, 2.0 / 13, 2.0 / 15}),
                                                   [](int i, int j, int k) {
                                                     return (i + j < 12 ? 20000 : 30000) +
                                                            (7 * i + 5 * j + 11 * k) % 3;
                                                   }),
                        transfer(std::move(points)), nullptr}};
}

Layer noise(Points points) {
  return {VolumeContent{
      make_volume<std::uint8_t>(
          grid_description({12, 13, 11}, {-1, -1, -1}, {2.0 / 11, 2.0 / 12, 2.0 / 10}),
          [](int i, int j, int k) {
            return (37 * i * i + 91 * j + 53 * k * j + 17 * i * k) % 251;
          }),
      transfer(std::move(points)), nullptr}};
}

Layer rectilinear(Points points) {
  Volume::Description description = grid_description({9, 10, 8}, {-1, -1, -1});
  description.coordinates[0] = {-1, -0.9, -0.5, -0.45, 0, 0.1, 0.4, 0.8, 1.1};
  description.placement.spacing = {1, 0.21, 0.27};
  return {VolumeContent{
      make_volume<float>(description,
                         [](int i, int j, int k) { return wave(0.25 * i, 0.2 * j, 0.3 * k); }),
      transfer(std::move(points)), nullptr}};
}

std::vector<Light> three_lights() {
  return {{HeadLight{}, {0.4, 0.4, 0.5}},
          {DirectionalLight{{0.3, -1, -0.4}}, {0.8, 0.7, 0.5}},
          {PointLight{{0.4, 1.6, -0.9}}, {0.2, 0.6, 0.9}}};
}

Exhibit in_lights(Exhibit made, std::vector<Light> lights) {
  made.lights = std::move(lights);
  return made;
}

/// A scan, shaded, and one of its surfaces.
GalleryEntry scan(const RealData& data, double value) {
  return {
      "light: " + data.name,
      [=](int) {
        const VolumePointer volume = read(data);
        Exhibit result;
        result.cameras = three_cameras(*volume);
        result.layers = {with_surfaces(lit({VolumeContent{volume, transfer(data.points), nullptr}}),
                                       {{value, 0.5, {0.9, 0.8, 0.6}}})};
        return result;
      },
      data.file};
}

}  // namespace

Gallery light_gallery() {
  const Points warm = ramp(2.5, {0.3, 0.1, 0}, {1, 0.7, 0.3});
  const auto made = [](auto make) { return [make](int) { return make(); }; };
  Gallery entries = {
      {"light: a ramp", made([=] {
         return exhibit({lit(grid({12, 13, 11}, warm))});
       })},
      {"light: jumps and a peak, gradients of the field", made([=] {
         return exhibit({lit(grid({12, 13, 11}, jumps(2)), GradientKind::field)});
       })},
      {"light: a spike of half width 0.002 in three lights", made([=] {
         return in_lights(exhibit({lit(grid({14, 12, 13}, peak(0.52, 0.002, 60)))}),
                          three_lights());
       })},
      {"light: noise", made([=] {
         return exhibit({lit(noise({{60, 0, {0.2, 0.4, 1}}, {240, 2, {1, 0.8, 0.5}}}))});
       })},
      {"light: flat but for the last bit", made([=] {
         Layer layer = lit(almost_flat({{19000, 0.8, {0.3, 0.6, 1}}, {31000, 1.5, {1, 0.8, 0.5}}}));
         layer.shading->specular = 0.7;
         return exhibit({layer});
       })},
      {"light: normals of length 1 in noise", made([=] {
         Layer layer = lit(noise({{100, 0, {0.2, 0.4, 1}}, {250, 1, {1, 0.8, 0.5}}}));
         layer.shading->flatness = 0;
         layer.shading->power = 60;
         return exhibit({layer});
       })},
      {"light: an oblique, sheared grid of cells", made([=] {
         return in_lights(
             exhibit({lit(oblique_cells({{0, 0, {0.1, 0.3, 0.9}}, {600, 2, {0.9, 0.9, 0.2}}}))}),
             three_lights());
       })},
      {"light: a rectilinear grid, moved",
       made([=] { return exhibit({moved(lit(rectilinear(jumps(1.5))), oblique())}); })},
      {"light: beside vacuum", made([=] { return exhibit({lit(with_vacuum(warm))}); })},
      {"light: tetrahedra, smooth and field", made([=] {
         return in_lights(exhibit({lit(mesh(4, jumps(1))),
                                   moved(lit(mesh(3, warm), GradientKind::field), oblique())}),
                          three_lights());
       })},
      {"light: Gaussians, lit by the second variable", made([=] {
         Layer layer = lit(gaussians());
         layer.shading->channel = 1;
         return exhibit({layer});
       })},
      {"light: a mask", made([=] { return exhibit({lit(masked())}); })},
      {"gradient opacity: jumps times a ramp with a jump", made([=] {
         return exhibit({with_factors(grid({12, 13, 11}, jumps(3)),
                                      {{0.1, 0}, {0.4, 0.9}, {0.4, 0.3}, {0.9, 1}})});
       })},
      {"gradient opacity: lit, in voxels, with vacuum, and a mesh", made([=] {
         return exhibit({lit(with_factors(with_vacuum(warm), {{0.02, 0}, {0.1, 1}},
                                          GradientOpacity::Unit::voxel)),
                         with_factors(mesh(4, warm), {{0.2, 0.2}, {0.6, 1}})},
                        {cut_away({ClipSphere{{0.1, -0.05, 0.2}, 0.5}})});
       })},
      {"gradient opacity: of Gaussians", made([=] {
         return exhibit({with_factors(gaussians(), {{0.1, 0}, {0.5, 1}})});
       })},
      {"factor: colors of one variable, opacity of another",
       made([=] { return exhibit({colored_by_another(-0.4)}); })},
      {"factor: red, green, blue, and opacity of a fourth, lit", made([=] {
         return in_lights(
             exhibit({lit(colors_as_data())}, {cut_away({ClipSphere{{0.2, 0.1, 0.3}, 0.4}})}),
             three_lights());
       })},
      {"factor: of Gaussians, and on a mesh beside a medium", made([=] {
         return exhibit({weighted_gaussians(), moved(mesh_colored_by_another(), oblique()),
                         grid({8, 9, 7}, warm)});
       })},
      {"isosurfaces: of a ball, nested and translucent", made([=] {
         return exhibit({with_surfaces(lit(ball(clear())), {{0.9, 0.3, {1, 0.9, 0.6}},
                                                            {0.6, 0.4, {0.3, 0.9, 0.5}},
                                                            {0.35, 1, {0.9, 0.2, 0.1}}})});
       })},
      {"isosurfaces: in a medium beside jumps, clipped, in three lights", made([=] {
         return in_lights(
             exhibit({with_surfaces(lit(grid({13, 11, 12}, jumps(1))),
                                    {{0.45, 0.5, {0.9, 0.9, 1}}, {0.66, 0.7, {0.2, 0.5, 1}}})},
                     {{ClipPlane{{0.05, 0.1, -0.1}, {0.3, -0.5, 0.8}}}}),
             three_lights());
       })},
      {"isosurfaces: at the values of noise", made([=] {
         return exhibit({with_surfaces(lit(noise(clear())), {{100, 0.6, {0.8, 0.8, 0.9}}})});
       })},
      {"isosurfaces: in tetrahedra, beside a grid, and labels", made([=] {
         return exhibit(
             {with_surfaces(lit(mesh(4, clear())), {{0.5, 0.6, {0.9, 0.7, 0.4}}}),
              moved(with_surfaces(grid({9, 12, 11}, warm), {{0.4, 0.5, {0, 0.6, 1}}}), oblique()),
              labels()});
       })},
      {"isosurfaces: of one variable, colored by another", made([=] {
         Isosurface surface;
         surface.value = 0.45;
         surface.opacity = 0.8;
         surface.colors = transfer({{0.2, 0, {0, 0, 1}}, {0.5, 0, {1, 1, 0}}, {0.8, 0, {1, 0, 0}}});
         surface.color_channel = 1;
         return exhibit({with_surfaces(lit(gaussians()), {surface})});
       })},
      {"slices: opaque and not, through vacuum and jumps", made([=] {
         Layer layer = with_vacuum(jumps(0.7));
         layer.slices = {{{0, 0.1, 0}, {0.2, 0.1, 1}, 0.7},
                         {{0.3, 0, 0}, {1, 0.2, 0}, 1, transfer(clear())}};
         return exhibit({layer});
       })},
      {"slices: of clear data, on the border and coincident", made([=] {
         Layer first = grid({11, 12, 10}, clear()), second = grid({8, 9, 7}, clear());
         first.slices = {{{0, 0, 1}, {0, 0, 1}, 0.5}, {{0.1, 0, 0}, {1, 0, 0}, 0.5}};
         second.slices = {{{0.1, 0.3, 0}, {-2, 0, 0}, 0.25, transfer({{0, 0, {1, 0, 0}}})}};
         return exhibit({first, second});
       })},
  };
  const double values[] = {110, 150, 50};
  std::size_t n = 0;
  for (const RealData& data : real_data()) {
    if (n == 3) break;
    entries.push_back(scan(data, values[n++]));
  }
  for (GalleryEntry& entry : entries) entry.least_proved = 1e-3;
  return entries;
}

}  // namespace pellucid::scenes
