// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/gallery.h"

namespace pellucid::scenes {

Gallery gaussian_gallery() {
  return {};
}

}  // namespace pellucid::scenes
