// SPDX-License-Identifier: Apache-2.0
#include "color_volume.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>
#include <vector>

#include "files/memory_limit.h"
#include "pellucid/io/internal/color_data.h"
#include "pellucid/scene/srgb.h"

namespace pellucid {
namespace {

/// Returns the linear light of each stored signal.
std::vector<float> light_of_signals(double largest) {
  std::vector<float> light(static_cast<std::size_t>(largest) + 1);
  for (std::size_t i = 0; i < light.size(); ++i) {
    light[i] = static_cast<float>(srgb_to_linear(static_cast<double>(i) / largest));
  }
  return light;
}

/// Returns a stored number as an index of the table.
template <class Value>
std::size_t signal_index(Value value, std::size_t last) {
  const auto number = static_cast<double>(value);
  return number > 0 ? static_cast<std::size_t>(std::min(number, static_cast<double>(last))) : 0;
}

/// Adds `weight` times the light of a component to the sums.
void add_light(const VolumeData& component, const std::vector<float>& light, float weight,
               std::span<float> sums) {
  std::visit(
      [&](const auto& values) {
        for (std::size_t i = 0; i < sums.size(); ++i) {
          sums[i] += weight * light[signal_index(values[i], light.size() - 1)];
        }
      },
      component);
}

bool is_constant(const VolumeData& component) {
  return std::visit(
      [](const auto& values) {
        return std::all_of(values.begin(), values.end(),
                           [&](const auto& value) { return value == values[0]; });
      },
      component);
}

/// Returns the numbers over the largest.
DataArray<float> as_shares(const VolumeData& component, double largest) {
  return std::visit(
      [&](const auto& values) {
        DataArray<float> shares(values.size());
        const std::span<float> to = shares.writable();
        for (std::size_t i = 0; i < to.size(); ++i) {
          to[i] =
              static_cast<float>(std::clamp(static_cast<double>(values[i]) / largest, 0.0, 1.0));
        }
        return shares;
      },
      component);
}

}  // namespace

bool asks_for_color_opacity(const VolumeFile& file, const ReadOptions& options) {
  return file.largest_color > 0 && !options.component &&
         options.component_name == std::string(color_opacity) &&
         std::ranges::count(file.component_names, color_opacity) == 0;
}

VolumeData color_opacity_of(const VolumeFile& file, const GridPart* part) {
  if (file.components == 4) {
    const std::vector<VolumeData> alpha = file.read({3, 1, part});
    if (!is_constant(alpha.front())) return as_shares(alpha.front(), file.largest_color);
  }
  const std::vector<VolumeData> colors = file.read({0, 3, part});
  const std::size_t points = std::visit([](const auto& v) { return v.size(); }, colors.front());
  check_memory(std::uintmax_t{points} * sizeof(float), file.description.name + ": its luminance");
  DataArray<float> luminance(points);
  const std::span<float> to = luminance.writable();
  const std::vector<float> light = light_of_signals(file.largest_color);
  constexpr float weights[] = {0.2126F, 0.7152F, 0.0722F};  // IEC 61966-2-1
  for (std::size_t c = 0; c < 3; ++c) add_light(colors[c], light, weights[c], to);
  for (float& sum : to) {
    sum = static_cast<float>(linear_to_srgb(std::min(static_cast<double>(sum), 1.0)));
  }
  return luminance;
}

}  // namespace pellucid
