// SPDX-License-Identifier: Apache-2.0
#include <pellucid/cpu/render.h>
#include <pellucid/io/image_files.h>
#include <pellucid/io/read_volume.h>
#include <pellucid/scene/defaults.h>

#include <cstdio>
#include <memory>

int main(int argc, char** argv) try {
  if (argc != 3) return 2;
  pellucid::Scene scene;
  const auto data = std::make_shared<pellucid::Volume>(pellucid::read_volume(argv[1]));
  const auto function =
      std::make_shared<pellucid::TransferFunction>(pellucid::default_transfer_function(*data));
  scene.layers = {{pellucid::VolumeContent{data, function}}};
  scene.camera = pellucid::default_camera(*data, scene.size);
  scene.integration.set_tolerance(1e-3);
  pellucid::write_png(pellucid::render(scene), argv[2]);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
