// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/internal/multivariate_blocks_storage.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <type_traits>

#include "block_levels.h"
#include "channel_smoothness.h"
#include "pellucid/transfer/gaussian_bound.h"

namespace pellucid {
namespace {

/// The box of what the channels' data can be in a block.
struct DataBox {
  double lower[max_channels], upper[max_channels];
  bool vacuum = false;  ///< all of it
};

DataBox data_box(const std::vector<const BlockRecords*>& records, int block) {
  DataBox box;
  for (std::size_t c = 0; c < records.size(); ++c) {
    const BlockRange range = records[c]->range(block);
    box.lower[c] = range.min;
    box.upper[c] = range.max;
    box.vacuum = box.vacuum || range.vacuum == BlockVacuum::all;
  }
  return box;
}

class BlockClassifier {
 public:
  BlockClassifier(const MultivariateTransferFunction& function, double negligible)
      : transfer_(function.view()), factor_(function.factor()) {
    const int count = transfer_.gaussians.count;
    for (int i = 0; i < count; ++i) {
      const double peak = transfer_.gaussians.primitive[i].peak * function.largest_factor();
      enough_.push_back(peak > 0 ? std::log(peak * count / negligible) : 0);
    }
  }

  /// Returns the primitives that may matter; none and no table: to skip.
  bool classify(const DataBox& box, PrimitiveSet& set) const {
    set = {0};
    if (box.vacuum) return false;
    if (factor_ != nullptr && !absorbs(factor_->function.view<double>(), factor_->channel, box)) {
      return false;
    }
    for (std::size_t i = 0; i < enough_.size(); ++i) {
      const Gaussian<double>& g = transfer_.gaussians.primitive[i];
      // As if it were alone, each may have an equal share.
      if (!(enough_[i] > 0) || !(g.peak > 0)) continue;
      if (least_exponent(g, box.lower, box.upper, enough_[i]) < enough_[i]) {
        set.bits |= 1ULL << (i & 63);
      }
    }
    bool tables = false;
    for (int t = 0; t < transfer_.tables; ++t) {
      const ChannelTable<double>& table = transfer_.table[t];
      tables = tables || absorbs(table.table, table.channel, box);
    }
    return set.bits != 0 || tables;
  }

 private:
  static bool absorbs(const PiecewiseLinear<double>& table, int channel, const DataBox& box) {
    return table.has_extinction(table.interval(box.lower[channel]),
                                table.interval(box.upper[channel]));
  }

  const MultivariateTransfer<double> transfer_;
  const ChannelTransferFunction* factor_;
  std::vector<double> enough_;  ///< the exponent from which on a primitive is left out
};

template <class T>
ValueType type_of() {
  if constexpr (std::is_same_v<T, std::uint8_t>) return ValueType::u8;
  if constexpr (std::is_same_v<T, std::int8_t>) return ValueType::i8;
  if constexpr (std::is_same_v<T, std::uint16_t>) return ValueType::u16;
  if constexpr (std::is_same_v<T, std::int16_t>) return ValueType::i16;
  if constexpr (std::is_same_v<T, std::uint32_t>) return ValueType::u32;
  if constexpr (std::is_same_v<T, std::int32_t>) return ValueType::i32;
  if constexpr (std::is_same_v<T, float>) return ValueType::f32;
  return ValueType::f64;
}

}  // namespace

MultivariateBlocksStorage::MultivariateBlocksStorage(
    const Channels& channels, const MultivariateTransferFunction& transfer_function,
    double negligible, const ParallelFor& parallel)
    : negligible_(negligible) {
  std::vector<const BlockRecords*> records;
  for (const Channel& channel : channels)
    records.push_back(&channel.volume->block_records(parallel));
  records_ = *records.front();
  const auto count = static_cast<std::size_t>(records_.count());
  classes_.resize(count);
  primitives_.resize(count);
  const BlockClassifier classifier(transfer_function, negligible);
  const ParallelFor run = parallel_or_serial(parallel);
  run(records_.count(), [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      const auto b = static_cast<std::size_t>(i);
      const bool absorbs = classifier.classify(data_box(records, i), primitives_[b]);
      classes_[b] = {0, absorbs ? BlockKind::cells : BlockKind::skip, 0};
    }
  });
  find_block_levels({records_.axis[0].cells(), records_.axis[1].cells(), records_.axis[2].cells()},
                    BlockKind::skip, run, classes_.data());
}

void MultivariateBlocksStorage::find_smooth(const Channels& channels,
                                            const MultivariateTransferFunction& transfer_function,
                                            const ParallelFor& parallel) {
  longest_step_ = find_smooth_channels(channels, transfer_function, primitives_.data(), negligible_,
                                       parallel_or_serial(parallel), classes_.data(), waves_);
}

MultichannelGrid multichannel_grid(const Channels& channels) {
  MultichannelGrid grid;
  grid.channels = channels.count();
  for (int c = 0; c < channels.count(); ++c) {
    channels[c].volume->visit([&]<class Value>(const StructuredGrid<Value, double>& field) {
      grid.data[c] = field.data;
      grid.type[c] = type_of<Value>();
      for (int a = 0; a < 3; ++a) {
        if (c == 0) grid.axis[a] = field.axis[a];
      }
    });
  }
  return grid;
}

}  // namespace pellucid
