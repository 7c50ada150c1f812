// SPDX-License-Identifier: Apache-2.0
#include "tests/packet/transfer_lanes.h"

#include <cstdint>

#include "pellucid/packet/cells/span_piece.h"
#include "pellucid/simd/instruction_set.h"

namespace pellucid {
namespace {

constexpr int N = PELLUCID_LANES;
using F = Batch<float, N>;
using D = Batch<double, N>;
using I = Batch<std::int32_t, N>;
using M = BatchMask<N>;

const BinnedTransfer& as_transfer(const void* transfer) {
  return *static_cast<const BinnedTransfer*>(transfer);
}

template <class T>
void colors(const void* transfer, const T* values, float* red) {
  color_at(as_transfer(transfer), Batch<T, N>::load(values)).r.store(red);
}

template <class T>
void next_colors(const void* transfer, const T* before, const T* values, float* red) {
  std::int32_t lane[N];
  for (int l = 0; l < N; ++l) lane[l] = l % 2;
  ColorInterval<Batch<T, N>> known = find_color(as_transfer(transfer), Batch<T, N>::load(before));
  const M wanted = I::load(lane) < I(1);
  color_at(as_transfer(transfer), Batch<T, N>::load(values), wanted, known).r.store(red);
}

template <class T>
void intervals(const void* transfer, const T* values, int* interval) {
  I found(0);
  find_extinction(as_transfer(transfer), Batch<T, N>::load(values), M(true), found);
  found.store(interval);
}

void across_jumps(const void* transfer, const int* interval, const double* const data[4],
                  const double* value_error, float* across) {
  SpanLanes<double, N> span;
  span.interval = I::load(interval);
  span.extinction = load_extinction<D>(as_transfer(transfer), span.interval);
  CubicBernstein<D> cubic;
  for (int k = 0; k < 4; ++k) cubic.b[k] = D::load(data[k]);
  extinction_across_jumps(span, as_transfer(transfer), M(true), cubic, D::load(value_error))
      .store(across);
}

constexpr transfer_lanes::Operations operations = {N,
                                                   colors<float>,
                                                   colors<double>,
                                                   next_colors<float>,
                                                   next_colors<double>,
                                                   intervals<float>,
                                                   intervals<double>,
                                                   across_jumps};

}  // namespace
}  // namespace pellucid

extern "C" const transfer_lanes::Operations* PELLUCID_ENTRY(pellucid_transfer_lanes)() {
  return &pellucid::operations;
}
