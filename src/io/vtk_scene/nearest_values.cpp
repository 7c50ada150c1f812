// SPDX-License-Identifier: Apache-2.0
#include "nearest_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <variant>

#include "pellucid/scene/error.h"

namespace pellucid::vtk_scene {

NearestValues nearest_values(const Volume& volume) {
  constexpr std::size_t most = std::size_t{1} << 24;
  std::vector<double> values, all;
  std::visit([&](const auto& data) { all.assign(data.begin(), data.end()); }, volume.data());
  values = all;
  std::erase_if(values, [](double value) { return std::isnan(value); });
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() > most) {
    throw Error("nearest values: there are " + std::to_string(values.size()) +
                " different ones; call SetInterpolationTypeToLinear()");
  }
  DataArray<float> labels(all.size());
  std::size_t i = 0;
  for (float& label : labels.writable()) {
    const double value = all[i++];
    label = std::isnan(value)
                ? std::numeric_limits<float>::quiet_NaN()
                : static_cast<float>(std::ranges::lower_bound(values, value) - values.begin());
  }
  return {std::make_shared<const LabelVolume>(
              std::make_shared<const Volume>(volume.description(), std::move(labels))),
          std::move(values)};
}

std::vector<ValueLook> looks_of(const std::vector<double>& values,
                                const ComponentSettings& component, const RampRange& ramp,
                                FunctionReader& reader) {
  std::vector<ValueLook> looks;
  looks.reserve(values.size());
  for (const double value : values) {
    looks.push_back({reader.opacity_at(component.opacity, ramp, value),
                     reader.color_at(component, ramp, value)});
  }
  return looks;
}

}  // namespace pellucid::vtk_scene
