// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/cells/gradient_loads.h"
#include "pellucid/packet/cells/span_light.h"
#include "pellucid/packet/cells/span_queue.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Returns places in the world, from the middle of the grid, of plane coordinates.
template <int N>
Vec3<Batch<float, N>> place_in_world(const PacketGrid& grid, const PacketLight& light,
                                     const Batch<std::int32_t, N> (&cell)[3],
                                     const Vec3<Batch<double, N>>& in_cell) noexcept {
  using D = Batch<double, N>;
  Vec3<Batch<float, N>> result;
  for (int c = 0; c < 3; ++c) {
    D sum(light.world_origin[c]);
    for (int a = 0; a < 3; ++a) {
      const D at = convert<double>(cell[a]) + in_cell[a] - D(static_cast<double>(grid.padding[a]));
      sum = multiply_add(D(light.world_direction[c][a]), at, sum);
    }
    result[c] = convert<float>(sum);
  }
  return result;
}

/// The gradients of the spans that are next on each ray, a few per ray, in order. They are computed
/// for spans of any rays in one go, so that lanes are full: lanes come to new spans at different
/// times. A ray that ends has at most `depth` of them computed in vain.
template <int N>
class SpanGradients : private SpanLight<N> {
 public:
  using F = Batch<float, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  /// Gradients of the spans of lanes.
  struct Found {
    CubicBernstein<F> gradient[3];  ///< in the world, along the lanes' ways through their cells
    CubicBernstein<F> magnitude;    ///< if there is a factor of it
    F kink;                         ///< SpanLight::kink() of the first piece; -1: light too near
    Vec3<F> entry;  ///< places of entry, from PacketLight's origin, if there are point lights
  };

  /// Prepares for rays that come from these directions, of length 1.
  SpanGradients(const PacketGrid& grid, const PacketLight& light, const Vec3<F>& to_eye) noexcept
      : SpanLight<N>(light, to_eye), grid_(grid), light_(light), loads_(grid, light) {
    for (int c = 0; c < 3; ++c) to_eye[c].store(eye_of_ray_[c]);
  }

  /// Begins with what a SpanFinder has found.
  void begin(const SpanWorkspace<N>& spans, const SpanWays<N>& ways) noexcept {
    spans_ = &spans;
    ways_ = &ways;
    for (int l = 0; l < N; ++l) stretch_[l] = row_[l] = end_row_[l] = 0;
    ready_ = first_ = I(0);
  }

  /// Takes the next span of each of the lanes' rays, as SpanQueue::take().
  void take(M lanes, Found& found) noexcept {
    if (any(lanes & (ready_ < I(1)))) compute();
    const I slot = slots_of_rays() + first_;
    ready_ -= select(lanes, I(1), I(0));
    first_ = select(lanes, (first_ + I(1)) & I(depth - 1), first_);
    F fields[field_count];
    load_records<field_count>(record_, slot, fields);
    for (int k = 0; k < 12; ++k) found.gradient[k / 4].b[k % 4] = fields[k];
    found.kink = fields[12];
    found.entry = {fields[13], fields[14], fields[15]};
    if (light_.factor != nullptr) load_records<4>(magnitude_of_, slot, found.magnitude.b);
  }

  /// Gives up what is left of the lanes' rays.
  void drop(M lanes) noexcept {
    for (unsigned left = bits(lanes); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      row_[l] = end_row_[l];
      stretch_[l] = BlockIntervals<N>::of_a_ray;
    }
  }

 private:
  static constexpr int depth_bits = 2, depth = 1 << depth_bits;  ///< spans of a ray
  static constexpr int field_count = 16, slots = N * depth;

  static I slots_of_rays() noexcept {
    std::int32_t slot[N];
    for (int l = 0; l < N; ++l) slot[l] = l * depth;
    return I::load(slot);
  }

  /// Returns whether there is another span of a ray, at row_.
  bool advance(int ray) noexcept {
    const SpanRows<N>& rows = spans_->rows;
    if (row_[ray] < end_row_[ray]) return true;
    if (stretch_[ray] >= rows.stretches[ray]) return false;
    row_[ray] = rows.first[ray][stretch_[ray]];
    end_row_[ray] = rows.end[ray][stretch_[ray]];
    ++stretch_[ray];
    return true;
  }

  /// Computes what is missing of each ray's next spans.
  [[gnu::noinline]] void compute() noexcept {
    std::int32_t ready[N], first[N], row[slots + N], slot[slots + N];
    ready_.store(ready);
    first_.store(first);
    int count = 0;
    for (int l = 0; l < N; ++l) {
      for (; ready[l] < depth && advance(l); ++ready[l]) {
        row[count] = row_[l]++;
        slot[count] = l * depth + ((first[l] + ready[l]) & (depth - 1));
        ++count;
      }
    }
    ready_ = I::load(ready);
    for (int i = count; i < count + N && count > 0; ++i) {
      row[i] = row[count - 1];
      slot[i] = slots;
    }
    for (int i = 0; i < count; i += N) compute(I::load(row + i), I::load(slot + i));
  }

  /// Computes these rows. In the last slot anything may be put.
  [[gnu::flatten, gnu::noinline]] void compute(I row, I slot) noexcept {
    const M lanes = slot < I(slots);
    const I ray = select(lanes, slot >> depth_bits, I(0));
    F span[SpanRows<N>::fields], way[SpanWays<N>::fields];
    load_records<SpanRows<N>::fields>(spans_->rows.row, row, span);
    load_records<SpanWays<N>::fields>(ways_->row, row, way);
    const I code = convert<std::int32_t>(span[7]), stretch = PackedSpanInfo::stretch_of(code);
    I cell[3];
    for (int a = 0; a < 3; ++a) {
      cell[a] = gather(spans_->stretches.block[a], stretch) * I(block_width) +
                PackedSpanInfo::place_in_block(code, a);
    }
    const Vec3<F> entry{way[0], way[1], way[2]}, exit{way[3], way[4], way[5]};
    CubicBernstein<F>(&gradient)[3] = this->gradient_;
    CubicBernstein<F> magnitude;
    loads_(lanes, cell, entry, exit, gradient, magnitude);
    for (int c = 0; c < 3; ++c) this->to_eye_[c] = lookup(eye_of_ray_[c], ray);
    Vec3<F> in_world{F(0), F(0), F(0)};
    if (light_.points > 0) {
      in_world =
          place_in_world(grid_, light_, cell,
                         Vec3<Batch<double, N>>{convert<double>(entry.x), convert<double>(entry.y),
                                                convert<double>(entry.z)});
    }
    const M near = this->begin_loaded(lanes, in_world, span[5]);
    F fields[field_count];
    for (int k = 0; k < 12; ++k) fields[k] = gradient[k / 4].b[k % 4];
    fields[12] = select(near, F(-1), this->kink());
    for (int c = 0; c < 3; ++c) fields[13 + c] = in_world[c];
    store_records<field_count>(fields, record_, slot);
    if (light_.factor != nullptr) store_records<4>(magnitude.b, magnitude_of_, slot);
  }

  const PacketGrid& grid_;
  const PacketLight& light_;
  GradientLoads<N> loads_;
  const SpanWorkspace<N>* spans_ = nullptr;
  const SpanWays<N>* ways_ = nullptr;
  float eye_of_ray_[3][16] = {};

  // By ray: where what has not been computed begins, as in SpanQueue.
  std::int32_t stretch_[N], row_[N], end_row_[N];
  I ready_, first_;  ///< spans that wait, and the place of the first of them among `depth`
  float record_[(slots + 1) * field_count];
  float magnitude_of_[(slots + 1) * 4];
};

}  // namespace pellucid
#endif
