// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pellucid/geometry/vec3.h"
#include "pellucid/math/rgb.h"
#include "pellucid/scene/transfer_function.h"

namespace pellucid {

/// A light at the eye: it shines along each ray.
struct HeadLight {
  bool operator==(const HeadLight&) const = default;
};
/// A light from far away. World coordinates.
struct DirectionalLight {
  Vec3<double> direction{0, 0, -1};  ///< in which it shines; any length but 0
  bool operator==(const DirectionalLight&) const = default;
};
/// A light at a point, equally bright at any distance. World coordinates.
struct PointLight {
  Vec3<double> position{};
  bool operator==(const PointLight&) const = default;
};

/// A light of a scene. It casts no shadows.
struct Light {
  std::variant<HeadLight, DirectionalLight, PointLight> kind{};
  Rgb<double> color{1, 1, 1};  ///< linear, >= 0

  bool operator==(const Light&) const = default;
};

/// Throws Error if a number is not finite, a direction has no length, or a color is negative.
/// `where` begins the message, e.g. "light 1".
void check_light(const Light& light, const std::string& where);

/// Reconstruction of the gradient of data, in the scene's world.
///
/// - `smooth`: at the data values the derivative of the parabola through a value and its two
///   neighbors along each axis of the grid (on a uniform axis the central difference); one-sided at
///   the border and beside vacuum; 0 where a value has no neighbor. Trilinear between, as the data
///   are; half cells at the border repeat the gradient of the border value. On meshes each point
///   has the mean of its tetrahedra's gradients, weighted by their volumes; linear between.
/// - `field`: the gradient of the reconstructed data themselves, which jumps between cells.
enum class GradientKind { smooth, field };
/// Names of the kinds as in scene files.
inline constexpr const char* gradient_kind_names[] = {"smooth", "field"};
/// Returns the name of a kind as in scene files.
std::string_view gradient_kind_name(GradientKind kind) noexcept;

/// Reflection of light by a layer or its surfaces (Blinn 1977), on both sides.
///
///   shaded color = color ∘ (ambient + Σ diffuse |n·l| L) + Σ specular |n·h|^power L
///
/// with the lights' colors L, their directions l, the half vectors h = (l + v) / |l + v| and the
/// direction v to the eye. A light has no specular part
/// where |l + v| <= 1e-6. The normal is
///
///   n = g / √(|g|² + g0²)
///
/// so that light fades where the data are flat, and noise makes no highlights. For surfaces g0 is
/// 0: they have a normal wherever the gradient is not 0. For the medium g0 is of the data, the same
/// however finely they are stored: flat_gradient() (scene/layer.h) defines it. One of `flatness`
/// and `flat_gradient` may be given in its place.
struct Shading {
  double ambient = 0.2, diffuse = 0.7, specular = 0.2;  ///< >= 0
  double power = 20;                                    ///< from 1 to 1000
  GradientKind gradient = GradientKind::smooth;
  /// g0 as a share of the range of the data per voxel, of the medium and of surfaces; >= 0.
  std::optional<double> flatness{};
  ChannelRef channel{};  ///< variable whose gradient it is, of several
  /// g0 of the medium, in data units per world length; >= 0.
  std::optional<double> flat_gradient{};

  bool operator==(const Shading&) const = default;
};

/// A factor of the extinction as a function of the gradient's magnitude: what VTK calls gradient
/// opacity. Linear between its points, constant outside of them.
///
/// The magnitude is that of the `smooth` gradient at the data values, trilinear between (linear in
/// tetrahedra).
class GradientOpacity {
 public:
  struct Point {
    double gradient = 0;  ///< magnitude
    double factor = 1;    ///< >= 0
  };
  /// Unit of length of the magnitudes: of the world, or a voxel (voxel_of(), scene/layer.h).
  enum class Unit { world, voxel };

  /// Throws Error as TransferFunction does, and if a magnitude is negative.
  explicit GradientOpacity(std::vector<Point> points, Unit unit = Unit::world,
                           ChannelRef channel = {});

  const std::vector<Point>& points() const noexcept { return points_; }
  Unit unit() const noexcept { return unit_; }
  const ChannelRef& channel() const noexcept { return channel_; }
  double largest_factor() const noexcept { return largest_; }
  /// Returns the same function of the magnitude per world length, with factors in the place of
  /// extinctions. `voxel`: the size of a voxel in world units.
  TransferFunction per_world(double voxel) const;

 private:
  std::vector<Point> points_;
  Unit unit_;
  ChannelRef channel_;
  double largest_ = 0;
};

}  // namespace pellucid
