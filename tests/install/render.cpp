// SPDX-License-Identifier: Apache-2.0
#include <pellucid/cpu/render.h>
#include <pellucid/io/image_files.h>
#include <pellucid/io/read_volume.h>
#include <pellucid/scene/builtin_fields.h>
#include <pellucid/scene/defaults.h>
#include <pellucid/scene/error.h>

#include <cstdio>
#include <memory>

int main(int argc, char** argv) {
  try {
    pellucid::Scene scene;
    scene.volume = std::make_shared<pellucid::Volume>(
        argc > 1 ? pellucid::read_volume(argv[1]) : pellucid::make_builtin_field("shells", 24));
    scene.transfer_function = std::make_shared<pellucid::TransferFunction>(
        pellucid::default_transfer_function(*scene.volume));
    scene.size = {96, 72};
    scene.camera = pellucid::default_camera(*scene.volume, scene.size);

    pellucid::RenderOptions options;
    options.preview = 3;  // every eighth pixel along each axis first
    options.tile = [](const pellucid::TileResult& done) {
      std::printf("level %d: %d x %d pixels\n", done.tile.level, done.tile.columns, done.tile.rows);
      return true;  // false cancels
    };
    const pellucid::Image image = pellucid::render(scene, options);
    pellucid::write_png(image, "picture.png");
    const auto [red, green, blue, opacity] = image.at(48, 36);
    std::printf("the middle pixel: %g %g %g, opacity %g\n", red, green, blue, opacity);
  } catch (const pellucid::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
