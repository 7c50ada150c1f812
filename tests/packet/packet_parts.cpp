// SPDX-License-Identifier: Apache-2.0
#include "tests/packet/packet_parts.h"

#include "pellucid/packet/bundle/culled_mixture.h"
#include "pellucid/packet/lane_compositor.h"
#include "pellucid/packet/lane_spans.h"
#include "pellucid/segment/constant.h"
#include "pellucid/simd/instruction_set.h"

namespace pellucid {
namespace {

constexpr int N = PELLUCID_LANES;
using F = Batch<float, N>;
using D = Batch<double, N>;
using I = Batch<std::int32_t, N>;
using M = BatchMask<N>;

int take_oldest(const std::int32_t* waiting, unsigned of_lanes, int next, std::int32_t* row,
                std::int32_t* left) {
  LaneSpans<N> spans;
  spans.waiting = I::load(waiting);
  int loads = 0;
  I found(-1);
  spans.take_oldest(M::from_bits(of_lanes), next, [&](M here, int at) noexcept {
    ++loads;
    found = select(here, I(at / N), found);
  });
  found.store(row);
  spans.waiting.store(left);
  return loads;
}

void fold(const packet_parts::Fold& wanted, int spans, packet_parts::FoldResult* result) {
  const F length(static_cast<float>(wanted.length)),
      step(static_cast<float>(wanted.length / spans));
  LaneCompositor<N> rays(wanted.tolerance, wanted.largest_extinction, wanted.largest_color, length);
  const F opacity = F::load(wanted.opacity);
  M alive(true);
  for (int l = 0; l < N; ++l) result->spans[l] = result->could_end[l] = -1;
  const auto note = [&](M done, int n) {
    const F left = rays.budget.remaining(), spent = rays.budget.spent();
    const F rest =
        rays.transparency() *
        min(F(static_cast<float>(wanted.largest_extinction)) * rays.budget.remaining_length(),
            F(1)) *
        F(static_cast<float>(wanted.largest_color));
    for (int l = 0; l < N; ++l) {
      if (alive[l] && result->could_end[l] < 0 &&
          static_cast<double>(spent[l]) > wanted.tolerance &&
          static_cast<double>(rest[l]) <= 0.999 / 64 * (1 - 0x1p-9) * wanted.tolerance) {
        result->could_end[l] = n;
      }
      if (!done[l]) continue;
      result->spans[l] = n;
      result->left[l] = static_cast<double>(left[l]);
      result->rest[l] = static_cast<double>(rest[l]);
    }
  };
  for (int n = 1; n <= spans; ++n) {
    const F before = rays.transparency();
    const typename RayBudget<F>::SpanShare shares = rays.budget.span_share(step, opacity);
    const F cost = F::load(wanted.share) * F::load(wanted.allowance) * shares.sum();
    SegmentResult<F> s;
    s.optical_depth = -log(F(1) - opacity);
    s.opacity = opacity;
    s.transparency = F(1) - opacity;
    s.radiance = opacity * Rgb<F>{F(1), F(0.5f), F(0.25f)};
    rays.add(alive, s);
    rays.budget.spend(select(alive, step, F(0)), shares, select(alive, min(cost, before), F(0)));
    const M done = rays.cut_off(alive);
    note(done, n);
    alive = alive & !done;
  }
  const D all = rays.error(D(static_cast<double>(spans)));
  rays.opacity().store(result->opacity);
  all.store(result->error);
  convert<double>(rays.budget.spent()).store(result->spent);
}

void least_exponents(const void* near, const float* lower, const float* upper, float* least) {
  F from[max_channels], to[max_channels];
  const auto& one = *static_cast<const NearGaussian*>(near);
  for (int c = 0; c < one.gaussian.channels; ++c) {
    from[c] = F::load(lower + c * N);
    to[c] = F::load(upper + c * N);
  }
  least_exponent_by_rows(one, from, to).store(least);
}

constexpr packet_parts::Operations operations = {N, take_oldest, fold, least_exponents};

}  // namespace
}  // namespace pellucid

extern "C" const packet_parts::Operations* PELLUCID_ENTRY(pellucid_packet_parts)() {
  return &pellucid::operations;
}
