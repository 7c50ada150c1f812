// SPDX-License-Identifier: Apache-2.0
#include "pellucid/math/gauss_legendre.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/support/accuracy.h"
#include "tests/support/wide_functions.h"

namespace pellucid::test {
namespace {

/// A rule from its definition at 60 digits: nodes are the zeros of the Legendre polynomial, found
/// by Newton's method; everything else follows from the Lagrange polynomials on them.
struct WideRule {
  std::vector<Wide> node, weight;
  std::vector<std::vector<Wide>> collocation;

  explicit WideRule(int n) {
    const Wide pi = 4 * atan(Wide(1));
    for (int i = n; i >= 1; --i) {
      Wide x = cos(pi * (Wide(i) - Wide(1) / 4) / (Wide(n) + Wide(1) / 2));
      for (int step = 0; step < 12; ++step) {
        Wide before = 1, p = x;
        for (int k = 2; k <= n; ++k) {
          const Wide next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
          before = p;
          p = next;
        }
        x -= p * (x * x - 1) / (n * (x * p - before));
      }
      node.push_back((1 + x) / 2);
    }
    collocation.resize(node.size());
    for (std::size_t k = 0; k < node.size(); ++k) {
      std::vector<Wide> lagrange = {1};  // coefficients of l_k
      for (std::size_t i = 0; i < node.size(); ++i) {
        if (i == k) {
          continue;
        }
        std::vector<Wide> product(lagrange.size() + 1, Wide(0));
        for (std::size_t d = 0; d < lagrange.size(); ++d) {
          product[d + 1] += lagrange[d] / (node[k] - node[i]);
          product[d] -= lagrange[d] * node[i] / (node[k] - node[i]);
        }
        lagrange = product;
      }
      const auto integral_to = [&](const Wide& end) {
        Wide sum = 0, power = end;
        for (std::size_t d = 0; d < lagrange.size(); ++d, power *= end) {
          sum += lagrange[d] * power / (d + 1);
        }
        return sum;
      };
      weight.push_back(integral_to(1));
      for (std::size_t j = 0; j < node.size(); ++j) {
        collocation[j].push_back(integral_to(node[j]));
      }
    }
  }
};

template <class S, int N>
void check_rule(ErrorRecord& numbers, ErrorRecord& moments) {
  static constexpr auto rule = gauss_legendre<S, N>();
  const WideRule truth(N);
  const std::string n = "n = " + std::to_string(N);
  const auto wide = [](S x) { return static_cast<long double>(x); };
  const auto narrow = [](const Wide& x) { return static_cast<long double>(x); };
  for (std::size_t j = 0; j < N; ++j) {
    numbers.add(relative_error_in_u(rule.node[j], narrow(truth.node[j])), n + ", node");
    numbers.add(relative_error_in_u(rule.weight[j], narrow(truth.weight[j])), n + ", weight");
    for (std::size_t k = 0; k < N; ++k) {
      numbers.add(absolute_error_in_u(rule.collocation[j][k], narrow(truth.collocation[j][k])),
                  n + ", collocation");
    }
    EXPECT_GT(rule.weight[j], S(0));
    EXPECT_EQ(rule.weight[j], rule.weight[N - 1 - j]) << n;
    if (j > 0) {
      EXPECT_LT(rule.node[j - 1], rule.node[j]) << n;
    }
    // Symmetric to half a rounding of numbers near 1.
    EXPECT_LE(absolute_error_in_u(rule.node[j], 1.0L - wide(rule.node[N - 1 - j])), 1.0L) << n;
  }
  // Powers of u: exact to degree 2 N - 1 over [0, 1], to degree N - 1 up to each node.
  for (int degree = 0; degree < 2 * N; ++degree) {
    long double whole = 0;
    for (std::size_t j = 0; j < N; ++j) {
      whole += wide(rule.weight[j]) * std::pow(wide(rule.node[j]), degree);
    }
    moments.add(std::fabs(whole * (degree + 1) - 1) / unit_of<S> / (degree + 1),
                n + ", degree " + std::to_string(degree));
    for (std::size_t j = 0; j < N && degree < N; ++j) {
      long double part = 0;
      for (std::size_t k = 0; k < N; ++k) {
        part += wide(rule.collocation[j][k]) * std::pow(wide(rule.node[k]), degree);
      }
      const long double u = wide(rule.node[j]);
      moments.add(std::fabs(part - std::pow(u, degree + 1) / (degree + 1)) / unit_of<S>,
                  n + ", to node " + std::to_string(j) + ", degree " + std::to_string(degree));
    }
  }
  // One degree more is not integrated: the rule is Gauss-Legendre and the check can fail.
  long double beyond = 0;
  for (std::size_t j = 0; j < N; ++j) {
    beyond += wide(rule.weight[j]) * std::pow(wide(rule.node[j]), 2 * N);
  }
  if (sizeof(S) == sizeof(double)) {
    EXPECT_GT(std::fabs(beyond * (2 * N + 1) - 1), 100 * unit_of<S>) << n;
  }
}

template <class S>
class GaussLegendreRules : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(GaussLegendreRules, NumberTypes);

TYPED_TEST(GaussLegendreRules, AreNearestNumbersAndIntegratePolynomials) {
  using S = TypeParam;
  const std::string type = sizeof(S) == sizeof(float) ? ", float" : ", double";
  ErrorRecord numbers("nodes, weights, collocation" + type);
  ErrorRecord moments("moments" + type);
  [&]<int... I>(std::integer_sequence<int, I...>) {
    (check_rule<S, I + 1>(numbers, moments), ...);
  }
  (std::make_integer_sequence<int, 12>());
  numbers.print();
  moments.print();
  EXPECT_LE(numbers.largest(), 1.0L);
  EXPECT_LE(moments.largest(), 2.0L);
}

}  // namespace
}  // namespace pellucid::test
