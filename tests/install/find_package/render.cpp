// SPDX-License-Identifier: Apache-2.0
#include <pellucid/cpu/render.h>
#include <pellucid/io/image_files.h>
#include <pellucid/io/read_volume.h>
#include <pellucid/scene/builtin_fields.h>
#include <pellucid/scene/defaults.h>
#include <pellucid/scene/error.h>

#include <cstdio>
#include <memory>
#include <utility>

// A scene with nothing left to choose: the transfer function and the camera follow from the data.
pellucid::Scene scene_of(pellucid::Volume volume) {
  pellucid::Scene scene;
  const auto data = std::make_shared<pellucid::Volume>(std::move(volume));
  const auto function =
      std::make_shared<pellucid::TransferFunction>(pellucid::default_transfer_function(*data));
  scene.layers = {{pellucid::VolumeContent{data, function}}};
  scene.size = {96, 72};
  scene.camera = pellucid::default_camera(*data, scene.size);
  scene.integration.set_tolerance(1e-3);
  return scene;
}

int main(int argc, char** argv) {
  try {
    const pellucid::Scene scene = scene_of(argc > 1 ? pellucid::read_volume(argv[1])
                                                    : pellucid::make_builtin_field("shells", 24));

    pellucid::RenderOptions options;
    options.error = true;  // fill Image::error
    options.preview = 3;   // every eighth pixel along each axis first
    options.tile = [](const pellucid::TileResult& done) {
      std::printf("level %d: %d x %d pixels\n", done.tile.level, done.tile.columns, done.tile.rows);
      return true;  // false cancels
    };
    pellucid::RenderReport report;
    const pellucid::Image image = pellucid::render(scene, options, &report);

    std::printf("largest error %g, tolerance %g\n", report.largest_error,
                scene.integration.tolerance);
    const auto [red, green, blue, opacity] = image.at(48, 36);
    std::printf("the middle pixel: %g %g %g, opacity %g\n", red, green, blue, opacity);
    pellucid::write_png(image, "picture.png");
    pellucid::write_exr(image, "picture.exr");
  } catch (const pellucid::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
