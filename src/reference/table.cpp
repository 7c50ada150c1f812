// SPDX-License-Identifier: Apache-2.0
#include "table.h"

#include <algorithm>

namespace pellucid::reference {

Table::Table(const std::vector<TransferFunction::Point>& points) : points_(points) {
  for (const TransferFunction::Point& p : points) values_.push_back(p.value);
  values_.erase(std::unique(values_.begin(), values_.end()), values_.end());
}

TableInterval Table::interval(Real v) const {
  const auto right = std::upper_bound(
      points_.begin(), points_.end(), v,
      [](Real value, const TransferFunction::Point& p) { return value < p.value; });
  if (right == points_.begin()) return {&points_.front(), &points_.front()};
  if (right == points_.end()) return {&points_.back(), &points_.back()};
  return {&*(right - 1), &*right};
}

Real Table::extinction(Real v) const {
  const TableInterval i = interval(v);
  if (i.constant()) return i.left->extinction;
  const Real s = (v - i.left->value) / (Real(i.right->value) - i.left->value);
  return (1 - s) * i.left->extinction + s * i.right->extinction;
}

bool Table::is_clear(Real lower, Real upper) const {
  if (extinction(lower) > 0 || extinction(upper) > 0) return false;
  auto point = std::lower_bound(
      points_.begin(), points_.end(), lower,
      [](const TransferFunction::Point& p, Real value) { return p.value < value; });
  for (; point != points_.end() && point->value <= upper; ++point) {
    if (point->extinction > 0) return false;
  }
  return true;
}

}  // namespace pellucid::reference
