// SPDX-License-Identifier: Apache-2.0
#include "projection/shown_value.h"

#include <algorithm>
#include <cmath>

namespace pellucid {

const TransferFunction& function_of(const Layer& layer) {
  const auto* const mesh = std::get_if<MeshContent>(&layer.content);
  return mesh != nullptr ? *mesh->univariate()
                         : *std::get<VolumeContent>(layer.content).transfer_function;
}

ValueColors::ValueColors(const TransferFunction& function)
    : table_(function.view<double>()), largest_color_(function.largest_color()) {
  for (const TransferFunction::Point& point : function.points()) {
    largest_extinction_ = std::max(largest_extinction_, point.extinction);
  }
}

ShownValue ValueColors::at(const Material<double>& material) const {
  ShownValue shown;
  if (!(largest_extinction_ > 0)) return shown;
  shown.opacity = std::min(material.extinction / largest_extinction_, 1.0);
  shown.radiance = material.color * shown.opacity;
  return shown;
}

ShownValue ValueColors::show(const RayValue& value) const {
  ShownValue shown;
  if (value.has_data && !std::isnan(value.value)) shown = at(table_.evaluate(value.value));
  if (value.is_unknown) {
    shown.color_error = largest_color_;
    shown.opacity_error = 1;
    return shown;
  }
  if (!value.has_data) return shown;
  const auto differ = [&](const ShownValue& other) {
    shown.color_error =
        std::max(shown.color_error, std::max({std::abs(other.radiance.r - shown.radiance.r),
                                              std::abs(other.radiance.g - shown.radiance.g),
                                              std::abs(other.radiance.b - shown.radiance.b)}));
    shown.opacity_error = std::max(shown.opacity_error, std::abs(other.opacity - shown.opacity));
  };
  const int first = table_.interval(value.lower), last = table_.interval(value.upper);
  double bulge = 0;
  for (int i = first; i <= last; ++i) {
    const double from = i > first ? table_.value[i - 1] : value.lower,
                 to = i < last ? table_.value[i] : value.upper;
    const ShownValue front = at(table_.evaluate_in(i, from)), back = at(table_.evaluate_in(i, to));
    differ(front);
    differ(back);
    // Color times opacity is a parabola between them; it leaves the chord by a quarter of the
    // product of both differences.
    const double colors =
        largest_component(table_.evaluate_in(i, to).color - table_.evaluate_in(i, from).color);
    bulge = std::max(bulge, 0.25 * colors * std::abs(back.opacity - front.opacity));
  }
  const double rounding = 16 * rounding_unit<double>;
  shown.color_error += bulge + rounding * largest_color_;
  shown.opacity_error += rounding;
  return shown;
}

ShownValue composite(const ShownValue& over, const ShownValue& behind) {
  const double transparency = 1 - over.opacity;
  const double left = std::min(transparency + over.opacity_error, 1.0);
  const double seen = std::max({behind.radiance.r, behind.radiance.g, behind.radiance.b});
  ShownValue both;
  both.radiance = over.radiance + transparency * behind.radiance;
  both.opacity = over.opacity + transparency * behind.opacity;
  both.color_error = over.color_error + over.opacity_error * seen + left * behind.color_error;
  both.opacity_error = over.opacity_error + left * behind.opacity_error;
  return both;
}

void put_over(const ShownValue& shown, double largest_color, RayResult& ray) {
  const double transparency = 1 - shown.opacity;
  ray.radiance = shown.radiance + transparency * ray.radiance;
  ray.opacity = shown.opacity + transparency * ray.opacity;
  ray.error = shown.color_error + shown.opacity_error * largest_color +
              std::min(transparency + shown.opacity_error, 1.0) * ray.error;
}

}  // namespace pellucid
