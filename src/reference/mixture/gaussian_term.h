// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "pellucid/scene/multivariate_transfer_function.h"
#include "real.h"

namespace pellucid::reference {

/// A cubic on [0, 1], lowest power first.
using Cubic = std::array<Real, 4>;

/// A Gaussian primitive along a part of a chord, w in [0, 1]: peak · e^(-E), E = |K (v - c)|²,
/// where each of the rows of K (v - c) is a cubic in w, because v is.
class GaussianTerm {
 public:
  /// Takes a primitive along data. `data` has a cubic for each channel of the scene.
  GaussianTerm(const GaussianPrimitive& primitive, const std::vector<Cubic>& data);

  std::pair<GaussianTerm, GaussianTerm> halves() const;

  /// Encloses E, for a cubic stays between the least and the largest of its Bernstein coefficients.
  struct Range {
    Real lower, upper;
  };
  Range exponent() const { return exponent_; }
  const GaussianPrimitive& primitive() const { return *primitive_; }
  Real log_peak() const { return log_peak_; }

  /// e^(-E) in double, for many w.
  class Density {
   public:
    explicit Density(const GaussianTerm& term);
    double operator()(double w) const;

   private:
    std::vector<std::array<double, 4>> rows_;  ///< lowest power first
  };

 private:
  GaussianTerm(const GaussianTerm& whole, std::vector<Cubic> rows);
  Range range() const;

  const GaussianPrimitive* primitive_;
  Real log_peak_;
  std::vector<Cubic> rows_;  ///< Bernstein coefficients
  Range exponent_;
};

}  // namespace pellucid::reference
