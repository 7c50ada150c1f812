// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "pellucid/scene/volume.h"

/// Small volumes for the tests of what is computed at data values.
namespace derived_fields {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// f(i, j, k) at the data values, in the type asked for.
template <class Value, class Field>
pellucid::Volume of_indices(pellucid::Volume::Description d, const Field& f) {
  std::vector<Value> data;
  for (int k = 0; k < d.dimensions[2]; ++k) {
    for (int j = 0; j < d.dimensions[1]; ++j) {
      for (int i = 0; i < d.dimensions[0]; ++i) data.push_back(static_cast<Value>(f(i, j, k)));
    }
  }
  return {std::move(d), pellucid::VolumeData(std::move(data))};
}

/// Calls check(i, j, k, value) for each value of f32 data.
template <class Check>
void each(const pellucid::Volume& volume, const Check& check) {
  const auto& n = volume.description().dimensions;
  const auto& data = std::get<pellucid::DataArray<float>>(volume.data());
  std::size_t at = 0;
  for (int k = 0; k < n[2]; ++k) {
    for (int j = 0; j < n[1]; ++j) {
      for (int i = 0; i < n[0]; ++i) check(i, j, k, static_cast<double>(data[at++]));
    }
  }
}

/// In so many unequal parts, each on a thread of its own.
inline pellucid::ParallelFor in_threads(int parts) {
  return [parts](int count, const std::function<void(int, int)>& body) {
    std::vector<std::thread> threads;
    int begin = 0;
    for (int t = 1; t <= parts; ++t) {
      const int end = static_cast<int>(static_cast<long long>(count) * t * t / (parts * parts));
      threads.emplace_back([&body, begin, end] { body(begin, end); });
      begin = end;
    }
    for (std::thread& t : threads) t.join();
  };
}

}  // namespace derived_fields
