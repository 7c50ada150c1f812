// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/multichannel_grid.h"
#include "pellucid/packet/steps/step_positions.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Several fields at places of rays in lanes, found once for all of them (step_positions.h).
template <int N>
class MultichannelSamples {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;

  MultichannelSamples(const MultichannelGrid& fields, const PacketGrid& grid) noexcept
      : fields_(fields), places_(grid) {}

  /// Cells by world length.
  void set_direction(const D* direction) noexcept { places_.set_direction(direction); }

  /// Samples are from these places on, in plane coordinates.
  void anchor(const D* at) noexcept { places_.anchor(at, base_); }

  /// The data at K world lengths from the anchor, by samples and channels; NaN in vacuum of a
  /// channel's own.
  template <int K>
  PELLUCID_ALWAYS_INLINE void sample(const F* offset, F (*value)[max_channels]) const noexcept {
    each<K>(offset, [&]<class Value>(int k, int c, const Value* const* at, const std::int32_t* on,
                                     const Vec3<F>& local) noexcept {
      value[k][c] = load_trilinear<Value, N>(at, on, places_.row, places_.slice, local);
    });
  }
  template <int K>
  PELLUCID_ALWAYS_INLINE void sample(const F* offset,
                                     DatumInCell<F> (*value)[max_channels]) const noexcept {
    each<K>(offset, [&]<class Value>(int k, int c, const Value* const* at, const std::int32_t* on,
                                     const Vec3<F>& local) noexcept {
      value[k][c] = load_in_cell<Value, N>(at, on, places_.row, places_.slice, local);
    });
  }

 private:
  template <int K, class Load>
  PELLUCID_ALWAYS_INLINE void each(const F* offset, Load&& load) const noexcept {
    Vec3<F> local[K];
    std::int32_t on[K][N];
    places_.template find<K>(offset, on, local);
    asm("" : "+m"(on));
    for (int c = 0; c < fields_.channels; ++c) {
      fields_.visit_channel(c,
                            [&]<class Value>(const StructuredGrid<Value, double>& field) noexcept {
                              const Value* at[N];
                              for (int l = 0; l < N; ++l) at[l] = field.data + base_[l];
                              for (int k = 0; k < K; ++k) {
                                load.template operator()<Value>(k, c, at, on[k], local[k]);
                              }
                            });
    }
  }

  const MultichannelGrid& fields_;
  StepPositions<N> places_;
  std::ptrdiff_t base_[N];  ///< the value at the lower corner of the anchor's cell
};

}  // namespace pellucid
#endif
