// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/gaussians/gaussian_scenes.h"

#include <cmath>
#include <filesystem>
#include <utility>

#include "benchmarks/support/document.h"
#include "pellucid/io/read_volume.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/derived_channels.h"
#include "tests/scenes/real.h"
#include "tests/support/one_layer.h"
#include "tests/support/test_data.h"

namespace pellucid::bench {
namespace {

using scenes::VolumePointer;
using Primitives = std::vector<GaussianPrimitive>;

Scene scene_of(std::vector<VolumePointer> volumes, Primitives primitives, ImageSize size) {
  Scene scene;
  std::vector<Channel> channels;
  for (VolumePointer& volume : volumes) {
    channels.push_back({format("channel %zu", channels.size()), "", std::move(volume)});
  }
  const int count = static_cast<int>(channels.size());
  test::channels_of(scene).channels = std::make_shared<const Channels>(std::move(channels));
  test::channels_of(scene).transfer_function =
      std::make_shared<const MultivariateTransferFunction>(count, std::move(primitives));
  scene.size = size;
  return scene;
}

/// Of the first channels.
GaussianPrimitive primitive(std::vector<double> center, const std::vector<double>& widths,
                            double extinction, Rgb<double> color) {
  GaussianPrimitive p;
  for (std::size_t i = 0; i < center.size(); ++i) p.channels.push_back(static_cast<int>(i));
  p.center = std::move(center);
  p.matrix = matrix_from_widths(widths);
  p.extinction = extinction;
  p.color = color;
  return p;
}

Rgb<double> hue(int i) {
  return {0.5 + 0.5 * std::cos(2.1 * i), 0.5 + 0.5 * std::cos(1.3 * i + 2), (i % 4) / 3.0};
}

Scene oblique(std::vector<VolumePointer> volumes, Primitives primitives, ImageSize size) {
  Scene scene = scene_of(std::move(volumes), std::move(primitives), size);
  scene.camera = scenes::view_camera(scenes::View::oblique);
  return scene;
}

Scene from_outside(std::vector<VolumePointer> volumes, Primitives primitives, ImageSize size) {
  Scene scene = scene_of(std::move(volumes), std::move(primitives), size);
  scene.camera = default_camera(test::channels_of(scene).channels->grid(), size);
  return scene;
}

/// Boundaries as in Kniss's widgets: a value in the middle of two materials, and a large gradient.
Scene boundaries(const std::filesystem::path& file, const std::vector<double>& values, double width,
                 double slope, double extinction, ImageSize size) {
  const auto value = std::make_shared<const Volume>(read_volume(file));
  Primitives primitives;
  for (const double center : values) {
    const int i = static_cast<int>(primitives.size());
    primitives.push_back(
        primitive({center, slope}, {width, 0.4 * slope}, extinction / (1 + 0.5 * i), hue(i + 1)));
  }
  return from_outside({value, std::make_shared<const Volume>(gradient_magnitude(*value))},
                      std::move(primitives), size);
}

std::filesystem::path scan_file(const std::string& name) {
  for (const scenes::RealData& data : scenes::real_data()) {
    if (data.name == name) return data.file;
  }
  return {};
}

/// Fluid, white matter and what is bright in FLAIR, which lesions are.
Scene patient(const std::filesystem::path& folder, ImageSize size) {
  std::vector<VolumePointer> contrasts;
  for (const char* name : {"FLAIR.nii.gz", "T1.nii.gz", "T2.nii.gz"}) {
    contrasts.push_back(std::make_shared<const Volume>(read_volume(folder / name)));
  }
  return from_outside(std::move(contrasts),
                      {primitive({25, 200, 900}, {20, 120, 250}, 0.08, {0.2, 0.4, 1}),
                       primitive({90, 800, 300}, {15, 80, 60}, 0.05, {1, 0.95, 0.8}),
                       primitive({160, 550, 600}, {15, 100, 120}, 1.5, {1, 0.2, 0.1})},
                      size);
}

/// A scan by the files that it needs.
struct Scan {
  GaussianScene scene;
  std::filesystem::path needs;
};

std::vector<Scan> scans() {
  const std::filesystem::path engine = scan_file("engine"), brain = scan_file("brain"),
                              head = test_data_folder() / "multivariate" / "ms_patient07";
  return {{{"engine, value and gradient",
            [=](ImageSize size) {
              return boundaries(engine, {65, 120, 180}, 8, 60, 0.8, size);
            }},
           engine},
          {{"brain, value and gradient",
            [=](ImageSize size) {
              return boundaries(brain, {35, 80, 125}, 12, 20, 0.6, size);
            }},
           brain},
          {{"head, three contrasts", [=](ImageSize size) { return patient(head, size); }},
           head / "FLAIR.nii.gz"}};
}

}  // namespace

GaussianScene width_scene(int points, double width) {
  return {format("width %g", width), [=](ImageSize size) {
            const double extinction = 0.4 / width;  // sheets of one depth
            return oblique({scenes::builtin("marschner_lobb", points)},
                           {primitive({0.3}, {width}, extinction, {0.2, 0.4, 1}),
                            primitive({0.5}, {width}, extinction, {0.3, 0.9, 0.3}),
                            primitive({0.7}, {width}, extinction, {1, 0.5, 0.1})},
                           size);
          }};
}

std::vector<GaussianScene> scan_scenes() {
  std::vector<GaussianScene> list;
  for (const Scan& scan : scans()) {
    if (std::filesystem::exists(scan.needs)) list.push_back(scan.scene);
  }
  return list;
}

std::vector<std::string> missing_scan_scenes() {
  std::vector<std::string> list;
  for (const Scan& scan : scans()) {
    if (!std::filesystem::exists(scan.needs)) list.push_back(scan.scene.name);
  }
  return list;
}

GaussianScene primitives_scene(int points, int count, bool apart) {
  return {format("%d primitive%s, %s", count, count == 1 ? "" : "s",
                 apart ? "apart" : "one on top of the other"),
          [=](ImageSize size) {
            Primitives primitives;
            for (int i = 0; i < count; ++i) {
              const double center = apart ? 0.1 + 0.8 * (i + 0.5) / count : 0.5;
              primitives.push_back(primitive({center}, {0.02}, apart ? 20 : 20.0 / count, hue(i)));
            }
            return oblique({scenes::builtin("marschner_lobb", points)}, std::move(primitives),
                           size);
          }};
}

GaussianScene channels_scene(int points, int channels) {
  return {format("%d channel%s", channels, channels == 1 ? "" : "s"), [=](ImageSize size) {
            std::vector<VolumePointer> volumes;
            for (int n = 0; n < channels; ++n) {
              volumes.push_back(scenes::sampled(
                  {points, points, points},
                  [=](double x, double y, double z) {
                    return 0.5 + 0.5 * std::sin((5 + 0.4 * n) * x + 4 * y + n) *
                                     std::cos(4.3 * z - 3 * y * (n % 3));
                  },
                  "waves"));
            }
            const auto all = static_cast<std::size_t>(channels);
            // A primitive of many variables is met by few data: wider by the root of their number.
            const double width = 0.1 * std::sqrt(channels);
            return oblique(
                std::move(volumes),
                {primitive(std::vector(all, 0.4), std::vector(all, width), 6, {0.2, 0.5, 1}),
                 primitive(std::vector(all, 0.6), std::vector(all, width), 6, {1, 0.6, 0.2})},
                size);
          }};
}

}  // namespace pellucid::bench
