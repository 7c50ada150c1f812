// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/support/interleave.h"

#include <algorithm>

namespace pellucid::bench {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  if (n == 0) return 0;
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

std::vector<double> interleaved_medians(const std::vector<std::function<double()>>& ways,
                                        std::size_t rounds) {
  std::vector<std::vector<double>> results(ways.size());
  for (const auto& way : ways) way();
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const std::size_t way = (i + round) % ways.size();
      results[way].push_back(ways[way]());
    }
  }
  std::vector<double> medians;
  for (std::vector<double>& list : results) medians.push_back(median(std::move(list)));
  return medians;
}

}  // namespace pellucid::bench
