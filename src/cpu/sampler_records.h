// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/packet/sampler_transfer.h"

namespace pellucid {

/// Owns the records of a SamplerTransfer. Not copied, for the view refers to them.
class SamplerRecords {
 public:
  explicit SamplerRecords(const PiecewiseLinear<float>& table);
  SamplerRecords(const SamplerRecords&) = delete;
  SamplerRecords& operator=(const SamplerRecords&) = delete;

  const SamplerTransfer& view() const noexcept { return view_; }

 private:
  std::vector<float> records_;
  SamplerTransfer view_;
};

}  // namespace pellucid
