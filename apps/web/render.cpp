// SPDX-License-Identifier: Apache-2.0
//
// One frame of a scene, for pages of others (apps/web/npm/index.js): the caller writes the scene
// and its arrays to the module's files, and reads the picture from its memory.
#include <emscripten/emscripten.h>

#include <exception>
#include <new>
#include <string>
#include <utility>

#include "pellucid/cpu/framed_camera.h"
#include "pellucid/cpu/renderer.h"
#include "pellucid/io/scene_json.h"
#include "view/view_input.h"

namespace pellucid {

namespace {

/// The last frame, and why there is none.
struct LastFrame {
  Renderer renderer{1};
  Image image;
  RenderReport report;
  std::string text;  ///< what failed; else the camera
};

LastFrame& last() {
  static LastFrame frame;
  return frame;
}

void render_scene(const std::string& path, ImageSize size, double tolerance) {
  view::ViewedScene viewed = view::view_input(path, {});
  Scene& scene = viewed.scene;
  if (size.width > 0) scene.size = size;
  if (tolerance > 0) scene.integration.tolerance = nearest_tolerance(tolerance);
  if (!viewed.keeps_camera) scene.camera = framed_camera(scene, scene.camera);
  RenderOptions options;
  options.outputs.error = scene.integration.method == Method::exact;
  RenderResult result = last().renderer.render(scene, options);
  last().image = std::move(result.image);
  last().report = result.report;
  last().text = camera_to_json(scene.camera);
}

}  // namespace

}  // namespace pellucid

extern "C" {

/// Renders the scene of a file of the module. Sizes of 0 and a tolerance of 0 are the scene's.
/// Returns 1 if there is a picture.
EMSCRIPTEN_KEEPALIVE int pellucid_render(const char* path, int width, int height,
                                         double tolerance) {
  using pellucid::last;
  last().image = {};
  try {
    pellucid::render_scene(path, {width, height}, tolerance);
    return 1;
  } catch (const std::bad_alloc&) {
    last().text = "there is not enough memory for this in a page";
  } catch (const std::exception& error) {
    last().text = error.what();
  }
  return 0;
}

/// Returns four premultiplied linear numbers of each pixel of the last frame, row by row from the
/// top.
EMSCRIPTEN_KEEPALIVE const void* pellucid_pixels() {
  return pellucid::last().image.pixels.data();
}
/// Returns the largest error of each pixel; null: it is not known.
EMSCRIPTEN_KEEPALIVE const void* pellucid_errors() {
  const auto& errors = pellucid::last().image.error;
  return errors.empty() ? nullptr : errors.data();
}
EMSCRIPTEN_KEEPALIVE int pellucid_width() {
  return pellucid::last().image.width;
}
EMSCRIPTEN_KEEPALIVE int pellucid_height() {
  return pellucid::last().image.height;
}
EMSCRIPTEN_KEEPALIVE double pellucid_largest_error() {
  return pellucid::last().report.largest_error;
}
EMSCRIPTEN_KEEPALIVE double pellucid_pixels_over() {
  return static_cast<double>(pellucid::last().report.pixels_over_tolerance);
}
EMSCRIPTEN_KEEPALIVE double pellucid_seconds() {
  return pellucid::last().report.seconds;
}
/// Returns the camera as JSON; where a frame failed, why.
EMSCRIPTEN_KEEPALIVE const char* pellucid_text() {
  return pellucid::last().text.c_str();
}
}
