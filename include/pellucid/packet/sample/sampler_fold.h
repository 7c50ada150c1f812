// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/rgb.h"
#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Front-to-back folding in lanes: a few steps in float, which costs them a few u, and these in
/// double (segment/compositor.h).
template <int N>
class SamplerFold {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;

  PELLUCID_ALWAYS_INLINE void add(F opacity, F transparency, Rgb<F> radiance) noexcept {
    few_radiance_ = few_radiance_ + few_transparency_ * radiance;
    few_opacity_ = multiply_add(few_transparency_, opacity, few_opacity_);
    few_transparency_ = few_transparency_ * transparency;
  }
  void add_depth(F optical_depth) noexcept { few_depth_ += optical_depth; }

  void fold() noexcept {
    radiance_.r += transparency_ * convert<double>(few_radiance_.r);
    radiance_.g += transparency_ * convert<double>(few_radiance_.g);
    radiance_.b += transparency_ * convert<double>(few_radiance_.b);
    const D weighted = transparency_ * convert<double>(few_opacity_);
    opacity_ += weighted;
    // The opacity is precise in thin segments, the transparency in dense ones.
    transparency_ = select(few_opacity_ < F(0.5f), transparency_ - weighted,
                           transparency_ * convert<double>(few_transparency_));
    optical_depth_ += convert<double>(few_depth_);
    few_radiance_ = {};
    few_opacity_ = few_depth_ = F(0);
    few_transparency_ = F(1);
  }

  const D& transparency() const noexcept { return transparency_; }
  const D& optical_depth() const noexcept { return optical_depth_; }
  const Rgb<D>& radiance() const noexcept { return radiance_; }
  D opacity() const noexcept { return min(opacity_, D(1)); }

 private:
  F few_opacity_, few_depth_, few_transparency_ = F(1);
  Rgb<F> few_radiance_{};
  D transparency_ = D(1), opacity_, optical_depth_;
  Rgb<D> radiance_{};
};

}  // namespace pellucid
#endif
