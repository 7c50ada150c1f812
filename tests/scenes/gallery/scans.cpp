// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/gallery.h"
#include "tests/scenes/real.h"

namespace pellucid::scenes {

Gallery scan_gallery() {
  Gallery entries;
  for (const RealData& data : real_data()) {
    entries.push_back({data.name,
                       [data](int) {
                         const VolumePointer volume = read(data);
                         return Exhibit{volume, transfer(data.points), three_cameras(*volume)};
                       },
                       data.file});
  }
  return entries;
}

}  // namespace pellucid::scenes
