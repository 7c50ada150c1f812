// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/cubic_panel.h"
#include "pellucid/segment/gauss_panel.h"
#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Three Gauss nodes on [0,1] in some lanes, six in the others.
template <int N>
class NodesOfLanes {
 public:
  using F = Batch<float, N>;
  using M = BatchMask<N>;

  /// Weights of the Bernstein coefficients of a cubic.
  struct Weights {
    F of[4];

    /// Returns the sum of the coefficients with these weights.
    F sum(const F (&b)[4]) const noexcept {
      return multiply_add(of[0], b[0], of[3] * b[3]) + multiply_add(of[1], b[1], of[2] * b[2]);
    }
  };

  explicit NodesOfLanes(M more) noexcept : more_(more), any_more_(any(more)) {}

  /// Calls visit(j) for each node. In lanes of three nodes the others weigh nothing.
  template <class Visit>
  void for_each(const Visit& visit) const noexcept {
    for (int j = 0; j < 3; ++j) visit(j);
    if (!any_more_) return;
    for (int j = 3; j < 6; ++j) visit(j);
  }

  F weight(int j) const noexcept {
    return j < 3 ? of_rules(few_.weight[j], many_.weight[j]) : of_rules(0, many_.weight[j]);
  }
  F position(int j) const noexcept { return of_rules(few_.position[j % 3], many_.position[j]); }
  /// Returns the weights of a cubic's value at a node.
  Weights value_weights(int j) const noexcept { return of_rules(few_.basis, many_.basis, j); }
  /// Returns the weights of its integral from 0 to the node.
  Weights integral_weights(int j) const noexcept {
    return of_rules(few_.integral, many_.integral, j);
  }
  /// Returns the depth at a node from the rates at all of them, as depth_to_node().
  F collocated(int j, const float (&rate)[6][N]) const noexcept {
    static constexpr auto few = gauss_legendre<float, 3>();
    static constexpr auto many = gauss_legendre<float, 6>();
    F depth(0);
    for_each([&](int k) noexcept {
      const float of_few = k < 3 ? few.collocation[j % 3][k] : 0.0f;
      depth += of_rules(of_few, many.collocation[j][k]) * F::load(rate[k]);
    });
    return depth;
  }

 private:
  static constexpr CubicNodes<float, 3> few_{};
  static constexpr CubicNodes<float, 6> many_{};

  F of_rules(float of_few, float of_many) const noexcept {
    return any_more_ ? select(more_, F(of_many), F(of_few)) : F(of_few);
  }
  Weights of_rules(const float (&few)[3][4], const float (&many)[6][4], int j) const noexcept {
    const auto one = [&](int k) noexcept {
      return j < 3 ? of_rules(few[j][k], many[j][k]) : F(many[j][k]);
    };
    return {{one(0), one(1), one(2), one(3)}};
  }

  M more_;
  bool any_more_;
};

}  // namespace pellucid
#endif
