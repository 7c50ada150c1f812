// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "pellucid/packet/sample/sampler_transfer.h"

namespace pellucid {

/// Nothing absorbs outside of it; crossed over: nowhere.
struct Support {
  float min = 1, max = 0;
};

template <class T>
Support support_of(const PiecewiseLinear<T>& table) {
  int first = 0, end = table.count;
  while (first < end && !(table.material[first].extinction > 0)) ++first;
  while (end > first && !(table.material[end - 1].extinction > 0)) --end;
  if (first == end) return {};
  const float far = std::numeric_limits<float>::max();
  return {first == 0 ? -far : static_cast<float>(table.value[first - 1]),
          end == table.count ? far : static_cast<float>(table.value[end])};
}

/// Owns the tables of a SamplerTransfer. Not copied, for the view refers to it.
class SamplerRecords {
 public:
  explicit SamplerRecords(const PiecewiseLinear<float>& table);
  SamplerRecords(const SamplerRecords&) = delete;
  SamplerRecords& operator=(const SamplerRecords&) = delete;

  const SamplerTransfer& view() const noexcept { return view_; }

 private:
  void add_corners(const PiecewiseLinear<float>& table, int bins, double width);

  std::vector<float> bins_, first_line_, lines_, breakpoints_;
  SamplerTransfer view_;
};

}  // namespace pellucid
