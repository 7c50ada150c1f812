// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/constants.h"
#include "pellucid/transfer/gaussian.h"

namespace pellucid {

/// A piecewise-linear function of one channel.
template <class S>
struct ChannelTable {
  int channel = 0;
  PiecewiseLinear<S> table;
};

/// A transfer function of several variables: the sum of Gaussian primitives and of piecewise-linear
/// functions of single channels. Each term is a kind of particles of its own: extinctions add, and
/// so do color · extinction. A view; owns nothing. Gaussians see consecutive channels.
template <class S>
struct MultivariateTransfer {
  GaussianMixture<S> gaussians;
  const ChannelTable<S>* table = nullptr;
  int tables = 0;
  int channels = 1;  ///< 1 … max_channels, of layers together max_bundle_channels

  /// Returns the extinction at v (`channels` numbers), and the color whose product with it is the
  /// sum of color · extinction. Returns vacuum if the extinction is below the smallest normal
  /// number, because its quotients could overflow. Of the primitives, only those in the set count.
  PELLUCID_HD Material<S> evaluate(const S* v, PrimitiveSet set = {}) const noexcept {
    S extinction = S(0);
    Rgb<S> emission{};
    for (int i = 0; i < gaussians.count; ++i) {
      if (!set.contains(i)) continue;
      const Gaussian<S>& g = gaussians.primitive[i];
      const S here = g.peak * g.density(v + g.first);
      extinction += here;
      emission += here * g.color;
    }
    for (int i = 0; i < tables; ++i) {
      const Material<S> here = table[i].table.evaluate(v[table[i].channel]);
      extinction += here.extinction;
      emission += here.extinction * here.color;
    }
    if (!(extinction >= S(smallest_normal<S>))) return {};
    return {extinction, (S(1) / extinction) * emission};
  }
};

}  // namespace pellucid
