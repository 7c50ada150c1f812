// SPDX-License-Identifier: Apache-2.0
#include "pellucid/traverse/mesh_face.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <sstream>
#include <string>

namespace pellucid::test_mesh_face {
namespace {

template <class T>
class MeshFaceTest : public testing::Test {
 protected:
  double uniform(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random_);
  }
  double power(double a, double b) { return std::exp(uniform(std::log(a), std::log(b))); }
  bool one_of(unsigned n) { return random_() % n == 0; }

  std::mt19937 random_{11};
};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(MeshFaceTest, Numbers);

/// Truth in long double, of points and values before anything is off or rounded.
TYPED_TEST(MeshFaceTest, InterpolatesToWithinItsError) {
  using T = TypeParam;
  constexpr double u = static_cast<double>(rounding_unit<T>);
  double largest = 0, sum = 0;
  int through = 0, bounded = 0;
  std::string worst;
  for (int trial = 0; trial < 400000; ++trial) {
    // From round to slivers, the ray anywhere in it, on its edges and corners or just beside them.
    const double size = this->power(1e-6, 1), thin = this->one_of(2) ? 1 : this->power(1e-8, 1);
    const double turn = this->uniform(0, 6.3), c = std::cos(turn), s = std::sin(turn);
    long double x[3], y[3], weight[3], all = 0, at_x = 0, at_y = 0;
    for (int i = 0; i < 3; ++i) {
      const double along = this->uniform(-size, size), aside = thin * this->uniform(-size, size);
      x[i] = static_cast<long double>(c * along - s * aside);
      y[i] = static_cast<long double>(s * along + c * aside);
      // Also just beside the face, where only what is off lets it be hit.
      weight[i] = this->one_of(6)
                      ? (this->one_of(2) ? 0 : this->power(1e-9, 1e-3)) * (this->one_of(2) ? 1 : -1)
                      : static_cast<long double>(this->uniform(0, 1));
      all += weight[i];
    }
    if (!(all > 0)) continue;
    for (int i = 0; i < 3; ++i) {
      at_x += weight[i] / all * x[i];
      at_y += weight[i] / all * y[i];
    }
    const double blur = this->one_of(2) ? 0 : size * this->power(1e-18, 1e-6);
    const double level = this->one_of(2) ? 0 : this->power(0.01, 10),
                 step = this->one_of(4) ? 0 : 1;
    SeenFace<T> face;
    long double value[3], lowest = std::numeric_limits<long double>::max(), highest = -lowest;
    T kept[3];
    for (int i = 0; i < 3; ++i) {
      x[i] -= at_x;
      y[i] -= at_y;
      const auto seen = [&](long double place) {
        return static_cast<T>(place + static_cast<long double>(this->uniform(-blur, blur)));
      };
      face.seen[i] = {seen(x[i]), seen(y[i]), T(0)};
      value[i] = static_cast<long double>(level + step * this->uniform(-1, 1));
      kept[i] = static_cast<T>(value[i]);
      lowest = std::min(lowest, value[i]);
      highest = std::max(highest, value[i]);
    }
    if (!turn_around_ray(face)) continue;
    ++through;
    long double area[3], whole = 0, truth = 0;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      area[i] = x[j] * y[k] - x[k] * y[j];
      whole += area[i];
    }
    if (whole == 0) continue;
    for (int i = 0; i < 3; ++i) truth += area[i] / whole * value[i];
    T w[3];
    face.weights(w);
    const T found = kept[0] + (w[1] * (kept[1] - kept[0]) + w[2] * (kept[2] - kept[0]));
    const double share = static_cast<double>(face.error(static_cast<T>(blur)));
    if (share >= 1) continue;
    ++bounded;
    const double bound = share * static_cast<double>(highest - lowest) +
                         2.1 * u * std::abs(static_cast<double>(found)) + 1e-300;
    const double ratio =
        std::abs(static_cast<double>(static_cast<long double>(found) - truth)) / bound;
    sum += ratio * ratio;
    if (ratio > largest) {
      largest = ratio;
      std::ostringstream row;
      row << "size " << size << ", thin " << thin << ", blur " << blur << ", share " << share;
      worst = row.str();
    }
  }
  const double rms = std::sqrt(sum / bounded);
  std::printf("of the bound: largest %.3f, RMS %.3f; %d through, %d bounded; worst: %s\n", largest,
              rms, through, bounded, worst.c_str());
  this->RecordProperty("largest_of_bound", std::to_string(largest));
  EXPECT_LE(largest, 1) << worst;
  // A bound that says more than three times what is true would have rays followed again.
  EXPECT_GT(largest, 0.3);
  EXPECT_GT(bounded, 200000);
}

/// Faces without an area, or none but rounding, promise nothing.
TYPED_TEST(MeshFaceTest, OfNoAreaIsOffByAll) {
  using T = TypeParam;
  SeenFace<T> face;
  for (int i = 0; i < 3; ++i) face.seen[i] = {T(i - 1), T(i - 1), T(0)};
  (void)turn_around_ray(face);
  EXPECT_EQ(face.error(T(0)), T(1));
  face.seen[1] = {rounding_unit<T>, T(0), T(0)};
  (void)turn_around_ray(face);
  EXPECT_EQ(face.error(T(0)), T(1));
}

}  // namespace
}  // namespace pellucid::test_mesh_face
