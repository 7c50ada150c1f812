// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "pellucid/scene/scene.h"

namespace pellucid::view {

/// A position on the picture: fractions of its width and height, from the upper left.
struct PicturePoint {
  double x, y;
};

/// Projects world positions onto a picture.
class PictureMap {
 public:
  explicit PictureMap(const Scene& scene);

  /// Rows of the matrix that takes (x, y, z, 1) of the world to homogeneous coordinates of the
  /// picture: x · w, y · w and w, which is positive in front of the camera.
  using Matrix = std::array<std::array<double, 4>, 3>;
  const Matrix& matrix() const noexcept { return matrix_; }
  /// Returns where a position is seen, or none if it is behind the camera.
  std::optional<PicturePoint> operator()(const Vec3<double>& position) const;
  /// Returns a world direction as seen: x to the right, y downwards, z away from the eye. Length 1
  /// stays 1.
  Vec3<double> direction(const Vec3<double>& world) const;
  double aspect() const { return aspect_; }

 private:
  CameraFrame<double> frame_;
  double aspect_;
  Matrix matrix_;
};

/// Elements that a page draws over the picture besides its own controls.
struct Lettering {
  bool anatomical = false;  ///< L/R, A/P, S/I in place of x, y, z
  std::string unit;         ///< of length; empty: not known
};

/// Returns the axes of the world as seen, the height of the picture at the focal point in world
/// units, and the outlines and handles of the scene's clips:
///
///   {"axes": [{"plus", "minus", "x", "y", "z"}], "height", "unit", "matrix": (PictureMap's),
///    "clips": [{"lines": [[x, y, x, y]], "handles": [{"name", "x", "y"}]}]}
Json overlay_json(const Scene& scene, const Lettering& lettering);

/// Returns the scene's clips with one handle dragged along the picture (DragHandle). The handles of
/// a box are its faces, "x0" … "z1"; those of a plane "point", which moves it along its normal, and
/// "normal", which turns it; those of a sphere and a cylinder "point", which moves them, and
/// "radius". Throws Error if there is no such clip or handle.
std::vector<Clip> with_handle_dragged(const Scene& scene, const DragHandle& drag);

}  // namespace pellucid::view
