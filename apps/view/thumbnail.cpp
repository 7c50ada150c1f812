// SPDX-License-Identifier: Apache-2.0
#include "thumbnail.h"

#include "pellucid/io/display_bytes.h"
#include "server/page_messages.h"

namespace pellucid::view {

namespace {

constexpr ImageSize thumbnail_size{96, 72};
/// A picture of this size need not be exact.
constexpr double thumbnail_tolerance = 1.0 / 32;

}  // namespace

PageMessage thumbnail_message(const SceneState& state, const AskThumbnail& ask,
                              Renderer& renderer) {
  SceneState preview = state;
  preview.edit({ask.layer, "transfer_function", ask.function, 0});
  preview.set_size(thumbnail_size);
  preview.set_tolerance(thumbnail_tolerance);
  const Scene& scene = preview.scene();
  const Image image = renderer.render(scene).image;
  const std::vector<std::uint8_t> bytes =
      display_bytes(image, scene.background.value_or(calm_background()), DisplayLayout::rgba);
  return binary_message({{"type", "thumbnail"},
                         {"layer", ask.layer},
                         {"function", ask.function},
                         {"width", image.width},
                         {"height", image.height}},
                        {as_text(bytes)});
}

}  // namespace pellucid::view
