// SPDX-License-Identifier: Apache-2.0
#include <pellucid/pellucid.h>

int main(int, char** argv) {
  pellucid::Scene scene{pellucid::Layer(pellucid::read_volume(argv[1]))};
  scene.integration.tolerance = 1e-3;
  pellucid::write_png(pellucid::render(scene).image, argv[2]);
}
