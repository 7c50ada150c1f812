// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/steps/step_positions.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// The data at places of rays in lanes, found as those (step_positions.h).
template <int N>
class PacketSamples {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;

  explicit PacketSamples(const PacketGrid& grid) noexcept : grid_(grid), places_(grid) {}

  /// Cells by world length.
  void set_direction(const D* direction) noexcept { places_.set_direction(direction); }

  /// Samples are from these places on, in plane coordinates.
  void anchor(const D* at) noexcept {
    std::ptrdiff_t value[N];
    places_.anchor(at, value);
    with_value_type(grid_.type, [&](auto datum) noexcept {
      const auto* const data = static_cast<const decltype(datum)*>(grid_.data);
      for (int l = 0; l < N; ++l) base_[l] = data + value[l];
    });
  }

  /// The data at K world lengths from the anchor; NaN in vacuum. All addresses first: what one
  /// sample waits for is done beside the others'.
  template <int K>
  PELLUCID_ALWAYS_INLINE void sample(const F* offset, F* value) const noexcept {
    Vec3<F> local[K];
    std::int32_t on[K][N];
    find<K>(offset, on, local);
    with_value_type(grid_.type, [&](auto datum) noexcept {
      using Value = decltype(datum);
      const Value* base[N];
      for (int l = 0; l < N; ++l) base[l] = static_cast<const Value*>(base_[l]);
      for (int k = 0; k < K; ++k) {
        value[k] = load_trilinear<Value, N>(base, on[k], places_.row, places_.slice, local[k]);
      }
    });
  }

  /// Has the data at K world lengths from the anchor, which are wanted soon, loaded into the cache:
  /// rays beside each other share lines of it, and those far apart wait for memory.
  template <int K>
  PELLUCID_ALWAYS_INLINE void load_ahead(const F* offset) const noexcept {
    Vec3<F> local[K];
    std::int32_t on[K][N];
    find<K>(offset, on, local);
    const std::ptrdiff_t rows[4] = {0, places_.row, places_.slice, places_.slice + places_.row};
    with_value_type(grid_.type, [&](auto datum) noexcept {
      for (int k = 0; k < K; ++k) {
        for (int l = 0; l < N; ++l) {
          const auto* const at = static_cast<const decltype(datum)*>(base_[l]) + on[k][l];
          for (const std::ptrdiff_t row : rows) __builtin_prefetch(at + row);
        }
      }
    });
  }

 private:
  template <int K>
  PELLUCID_ALWAYS_INLINE void find(const F* offset, std::int32_t (&on)[K][N],
                                   Vec3<F>* local) const noexcept {
    places_.template find<K>(offset, on, local);
    // Addresses are loaded from there: taking lanes out of registers costs more.
    asm("" : "+m"(on));
  }

  const PacketGrid& grid_;
  StepPositions<N> places_;
  const void* base_[N];  ///< the anchor's cell
};

}  // namespace pellucid
#endif
