// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <random>

namespace pellucid::bench {

/// Inputs enough that branches are not learnt by heart, few enough to stay in the first cache.
inline constexpr std::size_t input_count = 256;

/// Uniform in [lower, upper], always the same.
template <class T>
std::array<T, input_count> uniform_inputs(T lower, T upper, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<T> distribution(lower, upper);
  std::array<T, input_count> inputs;
  for (T& x : inputs) x = distribution(random);
  return inputs;
}

}  // namespace pellucid::bench
