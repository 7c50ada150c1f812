// SPDX-License-Identifier: Apache-2.0
#include "mixture_part.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

namespace pellucid::reference {
namespace {

/// e^-51 = 7e-23.
constexpr Real invisible = -51;

/// Returns the mean of the function of [0, 1] whose values at the nodes are given.
double mean(const Collocation::Values& values) {
  return 0.5 * Collocation::rule().integral(values);
}

}  // namespace

double MixtureSamples::depth() const {
  return mean(rate);
}

double MixtureSamples::gaussian_depth() const {
  return mean(gaussians);
}

double MixtureSamples::depth_to(double s) const {
  return 0.5 * Collocation::rule().running_integral(rate, 2 * s - 1);
}

double MixtureSamples::share_at_depth(double before, double target) const {
  const auto excess = [&](double s) { return before + depth_to(s) - target; };
  if (!(excess(1) > 0)) return 1;
  if (!(excess(0) < 0)) return 0;
  std::uintmax_t iterations = 200;
  const auto [left, right] = boost::math::tools::toms748_solve(
      excess, 0.0, 1.0, boost::math::tools::eps_tolerance<double>(50), iterations);
  return 0.5 * (left + right);
}

std::array<Real, 3> MixtureSamples::radiance() const {
  const Collocation::Values depths = Collocation::rule().running_integral(rate);
  Collocation::Values transparency;
  for (std::size_t j = 0; j < Collocation::nodes; ++j) transparency[j] = std::exp(-0.5 * depths[j]);
  std::array<Real, 3> result;
  for (std::size_t c = 0; c < 3; ++c) {
    Collocation::Values seen;
    for (std::size_t j = 0; j < Collocation::nodes; ++j) seen[j] = transparency[j] * light[c][j];
    result[c] = mean(seen);
  }
  return result;
}

MixturePart::MixturePart(const Mixture& mixture, const std::vector<Chord>& chords, Real u_begin,
                         Real u_end, Real t_begin, Real length)
    : MixturePart(t_begin, length) {
  const Real middle = (u_begin + u_end) / 2;
  for (const Mixture::ChannelTable& term : mixture.tables()) {
    const Chord& chord = chords[term.channel];
    const TableInterval interval = term.table.interval(chord(middle));
    if (interval.left->extinction == 0 && interval.right->extinction == 0) continue;
    tables_.push_back(
        {Piece(chord, u_begin, u_end, interval, t_begin, t_begin + length), 0.0, 1.0});
  }
  std::vector<Cubic> data;
  data.reserve(chords.size());
  for (const Chord& chord : chords) data.push_back(chord.monomial(u_begin, u_end));
  for (const GaussianPrimitive& primitive : mixture.primitives()) {
    add(GaussianTerm(primitive, data));
  }
}

void MixturePart::add(MixturePart other) {
  for (GaussianTerm& term : other.gaussians_) gaussians_.push_back(std::move(term));
  tables_.insert(tables_.end(), other.tables_.begin(), other.tables_.end());
}

void MixturePart::add(GaussianTerm term) {
  if (term.log_peak() + std::log(length_) - term.exponent().lower < invisible) return;
  gaussians_.push_back(std::move(term));
}

std::pair<MixturePart, MixturePart> MixturePart::halves() const {
  const Real half = length_ / 2;
  std::pair<MixturePart, MixturePart> result{MixturePart(t_begin_, half),
                                             MixturePart(t_begin_ + half, half)};
  auto& [front, back] = result;
  for (const TablePart& part : tables_) {
    const double middle = 0.5 * (part.w_begin + part.w_end);
    front.tables_.push_back({part.piece, part.w_begin, middle});
    back.tables_.push_back({part.piece, middle, part.w_end});
  }
  for (const GaussianTerm& term : gaussians_) {
    auto [first, second] = term.halves();
    front.add(std::move(first));
    back.add(std::move(second));
  }
  return result;
}

Real MixturePart::exponent_change() const {
  Real largest = 0;
  for (const GaussianTerm& term : gaussians_) {
    largest = std::max(largest, term.exponent().upper - term.exponent().lower);
  }
  return largest;
}

MixtureSamples MixturePart::sample() const {
  MixtureSamples samples;
  const auto add_term = [&](std::size_t j, double rate, const Rgb<double>& color) {
    samples.rate[j] += rate;
    samples.light[0][j] += rate * color.r;
    samples.light[1][j] += rate * color.g;
    samples.light[2][j] += rate * color.b;
  };
  const Collocation::Values& node = Collocation::rule().node();
  for (const GaussianTerm& term : gaussians_) {
    const GaussianTerm::Density density(term);
    const double peak = static_cast<double>(term.primitive().extinction * length_);
    for (std::size_t j = 0; j < Collocation::nodes; ++j) {
      const double rate = peak * density(0.5 * (1 + node[j]));
      samples.gaussians[j] += rate;
      add_term(j, rate, term.primitive().color);
    }
  }
  for (const TablePart& part : tables_) {
    const double share = part.w_end - part.w_begin;
    for (std::size_t j = 0; j < Collocation::nodes; ++j) {
      const double w = part.w_begin + share * 0.5 * (1 + node[j]);
      add_term(j, part.piece.rate(w) * share, part.piece.color(w));
    }
  }
  return samples;
}

}  // namespace pellucid::reference
