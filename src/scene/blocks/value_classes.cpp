// SPDX-License-Identifier: Apache-2.0
#include "value_classes.h"

#include <cmath>
#include <variant>

#include "looks/value_sample.h"

namespace pellucid {
namespace {

/// Splits values into three classes after Otsu 1979: the sum of squared distances to the classes'
/// means is smallest. (Two splits into two, one after the other, would first tell bone from the
/// rest and never find air.) A class begins at a new value. The thresholds tried are spread evenly
/// over the range and over the ranks, 256 in all. With two values only, the bright class is empty.
Classes otsu_classes(const std::vector<double>& v) {
  const std::size_t n = v.size();
  const double range = v.back() - v.front();
  std::vector<double> sum(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) sum[i + 1] = sum[i] + (v[i] - v.front()) / range;

  std::vector<std::size_t> starts;
  const auto add = [&](double threshold) {
    const auto start = std::lower_bound(v.begin(), v.end(), threshold) - v.begin();
    if (start > 0 && v[static_cast<std::size_t>(start)] > v.front()) {
      starts.push_back(static_cast<std::size_t>(start));
    }
  };
  constexpr std::size_t count = 128;
  for (std::size_t i = 1; i < count; ++i) {
    add(v.front() + range * (static_cast<double>(i) / count));
    add(v[n * i / count]);
  }
  add(v.back());
  std::sort(starts.begin(), starts.end());
  starts.erase(std::unique(starts.begin(), starts.end()), starts.end());

  // Within-class squares are all squares less this, summed over the classes.
  const auto between = [&](std::size_t first, std::size_t last) {
    const double s = sum[last] - sum[first];
    return s * s / static_cast<double>(last - first);
  };
  Classes best{starts[0], n};
  double largest = 0;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    for (std::size_t j = i + 1; j < starts.size(); ++j) {
      const double score =
          between(0, starts[i]) + between(starts[i], starts[j]) + between(starts[j], n);
      if (score > largest) {
        largest = score;
        best = {starts[i], starts[j]};
      }
    }
  }
  return best;
}

/// Calls visit(a, b) with values that are neighbors along an axis, at up to 2^18 places that are
/// even in the volume. None of them is NaN.
template <class Visit>
void visit_neighbors(const Volume& volume, const Visit& visit) {
  std::visit(
      [&](const auto& data) {
        const auto& n = volume.description().dimensions;
        const std::size_t row = static_cast<std::size_t>(n[0]),
                          slice = row * static_cast<std::size_t>(n[1]);
        const auto look = [&](std::size_t i) {
          const auto here = static_cast<double>(data[i]);
          const auto beside = [&](bool inside, std::size_t step) {
            if (!inside) return;
            const auto there = static_cast<double>(data[i + step]);
            if (!std::isnan(here) && !std::isnan(there)) visit(here, there);
          };
          beside(i % row + 1 < row, 1);
          beside(i % slice + row < slice, row);
          beside(i + slice < data.size(), slice);
        };
        visit_even_places(data.size(), look);
      },
      volume.data());
}

}  // namespace

ClassedValues::ClassedValues(std::vector<double> of)
    : values(std::move(of)), differ(!values.empty() && values.front() != values.back()) {
  if (differ) classes = otsu_classes(values);
}

double ClassedValues::mean(std::size_t first, std::size_t last) const {
  double sum = 0;
  for (std::size_t i = first; i < last; ++i) sum += values[i] - values[first];
  return values[first] + sum / static_cast<double>(last - first);
}

bool has_surfaces(const Volume& volume, const ClassedValues& of) {
  if (!of.differ) return false;
  const std::vector<double>& v = of.values;
  const std::size_t foreground = of.classes.foreground;
  const double threshold = of.threshold();
  const double apart = of.mean(foreground, v.size()) / 2 - of.mean(0, foreground) / 2;
  std::vector<double> steps;
  std::size_t pairs = 0;
  visit_neighbors(volume, [&](double a, double b) {
    ++pairs;
    if ((a < threshold) != (b < threshold)) steps.push_back(std::abs(b / 2 - a / 2));
  });
  // Noise goes through the threshold everywhere.
  if (steps.empty() || 8 * steps.size() > pairs) return false;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return 6 * *middle >= apart;
}

}  // namespace pellucid
