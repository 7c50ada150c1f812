// SPDX-License-Identifier: Apache-2.0
#include <pellucid/pellucid.h>
#include <pellucid/scene/builtin_fields.h>
#include <pellucid/scene/error.h>

#include <cstdio>

// A scene with nothing left to choose: the transfer function and the camera follow from the data.
pellucid::Scene scene_of(const pellucid::Volume& data) {
  const pellucid::Layer layer(data, pellucid::default_transfer_function(data));
  pellucid::Scene scene(layer, {96, 72});
  scene.integration.tolerance = 1e-3;
  return scene;
}

int main(int argc, char** argv) {
  try {
    const pellucid::Scene scene = scene_of(argc > 1 ? pellucid::read_volume(argv[1])
                                                    : pellucid::make_builtin_field("shells", 24));

    pellucid::RenderOptions options;
    options.outputs.error = true;  // fill Image::error
    options.monitor.preview = 3;   // every eighth pixel along each axis first
    options.monitor.tile = [](const pellucid::TileResult& done) {
      std::printf("level %d: %d x %d pixels\n", done.tile.level, done.tile.columns, done.tile.rows);
      return true;  // false cancels
    };
    const auto [image, report] = pellucid::render(scene, options);

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
