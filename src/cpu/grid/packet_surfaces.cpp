// SPDX-License-Identifier: Apache-2.0
#include "packet_surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "grid_light.h"
#include "packet_setup.h"
#include "pellucid/transfer/piecewise_linear.h"

namespace pellucid {
namespace {

constexpr double unit = static_cast<double>(rounding_unit<float>);

/// Least distance of a value from other control points, in largest values of the data.
constexpr double min_distance = 1e-4;
/// Largest distance from it that has an extinction for packets to visit it.
constexpr double reach = 0x1p-14;
/// By what share of it the extinction is raised at a value, at the second by twice that, and so on:
/// control points on a line between others are none for BinnedTransfer.
constexpr double kink = 0x1p-40;
/// Optical depth of a medium that absorbs nothing, over the longest way through the data.
constexpr double next_to_nothing = 1e-20;

/// The function in the making.
class Points {
 public:
  Points(const TransferFunction& function, double largest_value, double extinction)
      : points_(function.points()),
        table_(function.view<double>()),
        largest_(largest_value),
        extinction_(extinction) {}

  /// Adds a value. Returns false where that is not possible.
  bool add(double value) {
    double nearest = largest_;
    bool is_point = false;
    for (const TransferFunction::Point& point : points_) {
      if (point.value == value) {
        if (is_point) return false;  // a jump
        is_point = true;
      } else {
        nearest = std::min(nearest, std::abs(point.value - value));
      }
    }
    if (!(nearest > min_distance * largest_)) return false;
    const double beside = std::min(reach * largest_, 0.25 * nearest);
    if (!is_point) put(value, table_.evaluate(value));
    const auto absorbs = [&](double at) { return table_.evaluate(at).extinction > 0; };
    const bool in_medium = absorbs(value - beside) || absorbs(value) || absorbs(value + beside);
    if (!in_medium) {
      for (const double at : {value - beside, value + beside}) put(at, table_.evaluate(at));
    }
    const auto here = std::ranges::find(points_, value, &TransferFunction::Point::value);
    ++added_;
    here->extinction = in_medium ? here->extinction * (1 + added_ * kink) : extinction_;
    return true;
  }
  std::vector<TransferFunction::Point> take() { return std::move(points_); }

 private:
  void put(double value, const Material<double>& material) {
    const auto behind =
        std::ranges::upper_bound(points_, value, {}, &TransferFunction::Point::value);
    points_.insert(behind, {value, material.extinction, material.color});
  }

  std::vector<TransferFunction::Point> points_;
  PiecewiseLinear<double> table_;
  double largest_, extinction_;
  int added_ = 0;
};

}  // namespace

bool has_plain_isosurfaces(const Layer& layer) {
  const auto* const content = std::get_if<VolumeContent>(&layer.content);
  return content != nullptr && !content->mask && layer.slices.empty() &&
         !layer.isosurfaces.empty() &&
         layer.isosurfaces.size() <= std::size_t{PacketSurfaces::most} &&
         std::ranges::none_of(
             layer.isosurfaces,
             [](const Isosurface& surface) { return surface.colors != nullptr; }) &&
         fits_single(*content->volume) && content->volume->statistics().nan == 0;
}

PacketSurfaces packet_surfaces(const LayerAppearance& look,
                               const std::vector<LightSource<double>>& lights,
                               double largest_color) {
  PacketSurfaces result;
  std::vector<Isosurface> surfaces = look.isosurfaces();
  std::ranges::sort(surfaces, {}, &Isosurface::value);
  result.bound[0] = -BinnedTransfer::far;
  for (const Isosurface& surface : surfaces) {
    const int i = ++result.count;
    result.bound[i] = static_cast<float>(surface.value);
    result.value_error =
        std::max(result.value_error, static_cast<float>(2 * unit * std::abs(surface.value)));
    result.opacity[i] = static_cast<float>(surface.opacity);
    result.depth[i] = surface.opacity < 1 ? static_cast<float>(-std::log1p(-surface.opacity))
                                          : std::numeric_limits<float>::infinity();
    result.color[0][i] = static_cast<float>(surface.color.r);
    result.color[1][i] = static_cast<float>(surface.color.g);
    result.color[2][i] = static_cast<float>(surface.color.b);
  }
  result.bound[result.count + 1] = BinnedTransfer::far;
  if (const Reflection<double>* const r = look.surface_reflection()) {
    result.is_lit = 1;
    result.reflection = in_single(*r);
    // As light_up() says of its errors.
    double brightest = 0;
    for (const LightSource<double>& light : lights) brightest += largest_component(light.color);
    result.color_rounding =
        static_cast<float>(unit * (8 * (r->ambient + r->diffuse * brightest) * largest_color +
                                   16 * std::max(r->power, 1.0) * r->specular * brightest));
  }
  return result;
}

std::optional<TransferFunction> with_points_at_isosurfaces(const Layer& layer) {
  const VolumeContent& content = std::get<VolumeContent>(layer.content);
  const Volume& volume = *content.volume;
  Points points(*content.transfer_function, largest_value(volume),
                next_to_nothing / diagonal(volume));
  for (const Isosurface& surface : layer.isosurfaces) {
    if (!points.add(surface.value)) return std::nullopt;
  }
  return TransferFunction(points.take());
}

}  // namespace pellucid
