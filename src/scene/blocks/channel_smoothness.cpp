// SPDX-License-Identifier: Apache-2.0
#include "channel_smoothness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "block_groups.h"
#include "block_neighbours.h"

namespace pellucid {
namespace {

/// Largest change of K (v - c) from ray to ray: the top of a Gaussian that lies between two of them
/// is seen by both.
constexpr double most_moved = 1.6;
/// Likewise where the data turn back at a distance u of K (v - c), in the Gaussian's tail: with its
/// second derivative q by the place, that top is e^(-u q x²) wide, and this is the most of √(u q)
/// x.
constexpr double most_turned = 1.6;

/// By how much K (v - c) may change its slope from cell to cell without any of it being seen, as
/// data do that are rounded.
constexpr double least_turned = 2e-5;

/// Variation of the data of a channel in its blocks, by the position in cells.
class ChannelMovement {
 public:
  explicit ChannelMovement(const BlockRecords& records) : records_(records) {}

  /// Returns about the length of the gradient, seldom less. From corner to corner of a box of w
  /// cells along each axis the data change by no more than their range: by Σ |slope| w in the mean,
  /// from which slopes differ by half of what they vary by, where they vary evenly.
  double slope(int block) const noexcept {
    const BlockRange range = records_.range(block);
    const std::array<int, 3> at = place(block);
    double varies = 0, along_all = 0, least = block_width;
    for (std::size_t a = 0; a < 3; ++a) {
      const double oscillation = 0.5 * static_cast<double>(range.oscillation[a]) * width(a),
                   along = cells(a, at[a]);
      varies += oscillation;
      along_all += oscillation * along;
      least = std::min(least, along);
    }
    double found = (range.max - range.min + along_all) / least;
    // Of the last block of an axis, which may be thin, by the one before.
    int stride = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      if (at[a] > 0 && cells(a, at[a]) < block_width - 0.5) {
        const double jump =
            std::max(second_difference(block, a), second_difference(block - stride, a));
        found = std::min(found, slope(block - stride) + jump + varies);
      }
      stride *= records_.axis[a].cells();
    }
    return found;
  }

  /// Returns a bound on the second derivative along any direction: of the matrix of them, a
  /// derivative's jump from cell to cell being that along an axis, no eigenvalue is more than the
  /// largest sum over a row.
  double turn(int block) const noexcept {
    const CurvatureBounds curvature = records_.curvature(block);
    double most = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      const double twists = static_cast<double>(curvature.twist[c]) * width(b) +
                            static_cast<double>(curvature.twist[b]) * width(c);
      most = std::max(most, second_difference(block, a) + width(a) * twists);
    }
    return most;
  }

 private:
  std::array<int, 3> place(int block) const noexcept {
    const int x = records_.axis[0].cells(), y = records_.axis[1].cells();
    return {block % x, block / x % y, block / (x * y)};
  }
  double width(std::size_t axis) const noexcept {
    const Vec3<double>& w = records_.mean_width;
    return axis == 0 ? w.x : axis == 1 ? w.y : w.z;
  }
  double cells(std::size_t axis, int at) const noexcept {
    const GridAxis<double>& planes = records_.axis[axis];
    return (planes.plane(at + 1) - planes.plane(at)) / width(axis);
  }
  double second_difference(int block, std::size_t axis) const noexcept {
    return static_cast<double>(records_.curvature(block).second_difference[axis]) * width(axis);
  }

  const BlockRecords& records_;
};

/// Returns the distance that K (v - c) moves where channel c moves by by_channel[c].
double moved(const Gaussian<double>& g, const double* by_channel) noexcept {
  double square = 0;
  for (int r = 0; r < g.rows; ++r) {
    double sum = 0;
    for (int c = 0; c < g.channels; ++c) sum += std::fabs(g.matrix[r][c]) * by_channel[c];
    square += sum * sum;
  }
  return std::sqrt(square);
}

class SmoothnessOfChannels {
 public:
  SmoothnessOfChannels(const Channels& channels, const GaussianMixture<double>& mixture,
                       const PrimitiveSet* primitives, double negligible,
                       const ParallelFor& parallel)
      : mixture_(mixture), primitives_(primitives) {
    for (const Channel& channel : channels) {
      records_.push_back(channel.volume->block_records(parallel));
    }
    for (int i = 0; i < mixture.count; ++i) {
      const Gaussian<double>& g = mixture.primitive[i];
      const double exponent = g.peak > 0 ? std::log(g.peak * mixture.count / negligible) : 0;
      PrimitiveLook look{std::sqrt(std::max(exponent, 0.0)), {}};
      for (int c = 0; c < g.channels; ++c) {
        double square = 0;
        for (int r = 0; r < g.rows; ++r) square += g.matrix[r][c] * g.matrix[r][c];
        look.at[static_cast<std::size_t>(c)] = std::sqrt(square);
      }
      looks_.push_back(look);
    }
  }

  const BlockRecords& blocks() const noexcept { return records_.front(); }

  /// Notes what is to be known of a group's blocks, if they are smooth.
  void note(const BlockGroups::Group& group, BlockClass* classes, float* waves) const {
    const auto each_candidate = [&](const auto& visit) {
      group.each([&](int b) {
        if (classes[b].kind != BlockKind::skip) visit(b);
      });
    };
    std::array<GroupVariation, max_channels> variation;
    PrimitiveSet near{0};
    bool vacuum = false;
    each_candidate([&](int b) {
      near.bits |= primitives_[b].bits;
      for (std::size_t c = 0; c < records_.size(); ++c) {
        variation[c].add(records_[c][b]);
        vacuum = vacuum || records_[c][b].vacuum() != BlockVacuum::none;
      }
    });
    double steps = longest_sampled_step;
    for (std::size_t c = 0; c < records_.size(); ++c) {
      double turned = 0;
      for (std::size_t i = 0; i < looks_.size(); ++i) {
        if (near.contains(static_cast<int>(i))) {
          turned = std::max(turned, looks_[i].at[c] * variation[c].most_change());
        }
      }
      if (turned > least_turned) steps = std::min(steps, variation[c].steps());
    }
    if (vacuum || !(steps >= GroupVariation::min_steps)) return;
    each_candidate([&](int b) {
      const double its_steps = std::min(steps, resolving_steps(b));
      classes[b].kind = BlockKind::smooth;
      waves[b] = static_cast<float>(1 / its_steps);
    });
  }

 private:
  struct PrimitiveLook {
    double reach;                           ///< |K (v - c)| beyond which it does not matter
    std::array<double, max_channels> at{};  ///< the lengths of K's columns
  };

  /// Returns the largest distance of rays that resolves the block's primitives, in cells.
  double resolving_steps(int block) const noexcept {
    double slope[max_channels] = {}, turn[max_channels] = {};
    for (std::size_t c = 0; c < records_.size(); ++c) {
      const ChannelMovement movement(records_[c]);
      slope[c] = movement.slope(block);
      turn[c] = movement.turn(block);
    }
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < mixture_.count; ++i) {
      const double reach = looks_[static_cast<std::size_t>(i)].reach;
      if (!primitives_[block].contains(i) || !(reach > 0)) continue;
      const Gaussian<double>& g = mixture_.primitive[i];
      least = std::min(
          {least, most_moved / moved(g, slope), most_turned / std::sqrt(reach * moved(g, turn))});
    }
    return least;
  }

  std::vector<BlockRecords> records_;  ///< of each channel
  GaussianMixture<double> mixture_;
  const PrimitiveSet* primitives_;
  std::vector<PrimitiveLook> looks_;
};

}  // namespace

double find_smooth_channels(const Channels& channels,
                            const MultivariateTransferFunction& transfer_function,
                            const PrimitiveSet* primitives, double negligible,
                            const ParallelFor& parallel, BlockClass* classes,
                            std::vector<float>& waves) {
  const SmoothnessOfChannels smoothness(channels, transfer_function.view().gaussians, primitives,
                                        negligible, parallel);
  const BlockRecords& blocks = smoothness.blocks();
  waves.assign(static_cast<std::size_t>(blocks.count()), 0);
  const BlockGroups groups(blocks);
  parallel(groups.slabs(), [&](int first, int last) {
    for (int k = first; k < last; ++k) {
      groups.each(k, [&](const BlockGroups::Group& group) {
        smoothness.note(group, classes, waves.data());
      });
    }
  });
  join_with_neighbours(blocks, parallel, 1, waves,
                       [](float& most, float other) { most = std::max(most, other); });
  float least = std::numeric_limits<float>::infinity();
  for (int b = 0; b < blocks.count(); ++b) {
    if (classes[b].kind == BlockKind::smooth) {
      least = std::min(least, waves[static_cast<std::size_t>(b)]);
    }
  }
  if (least < std::numeric_limits<float>::infinity()) return 1 / static_cast<double>(least);
  waves.clear();
  return 0;
}

}  // namespace pellucid
