// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "tests/math/sweep.h"

/// Triangles whose orientation is hard to tell, and its truth.
namespace pellucid::test {

/// Holds a product of two numbers exactly; so differences have their exact sign.
using ProductOfTwo = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<256, boost::multiprecision::digit_base_2>,
    boost::multiprecision::et_off>;

template <class T>
struct DeterminantCase {
  T a_x, a_y, b_x, b_y;

  ProductOfTwo first() const { return ProductOfTwo(a_x) * b_y; }
  ProductOfTwo second() const { return ProductOfTwo(a_y) * b_x; }
  ProductOfTwo truth() const { return first() - second(); }
  int sign() const { return truth().sign(); }
  /// |found - truth| in units of u (|a_x b_y| + |a_y b_x|).
  long double error_of(T found) const {
    const ProductOfTwo size = abs(first()) + abs(second());
    if (size == 0) return found == 0 ? 0 : std::numeric_limits<long double>::infinity();
    return static_cast<long double>(abs(ProductOfTwo(found) - truth()) / size) / unit_of<T>;
  }
  std::string text() const {
    return "(" + at(a_x) + ", " + at(a_y) + "), (" + at(b_x) + ", " + at(b_y) + ")";
  }
};

/// Any; nearly and exactly collinear with 0; on a lattice; along the axes; of sizes from 2^-range
/// to 2^range, within what determinant() wants.
template <class T>
std::vector<DeterminantCase<T>> determinant_cases(int count) {
  constexpr int range = std::is_same_v<T, float> ? 38 : 420;
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> place(-1, 1);
  std::uniform_int_distribution<int> lattice(-3, 3), binade(-range, range), steps(-2, 2);
  std::vector<DeterminantCase<T>> all;
  all.reserve(static_cast<std::size_t>(count));
  const auto draw = [&] { return static_cast<T>(place(random)); };
  const auto moved = [&](T x) {
    T y = x;
    for (int n = steps(random); n != 0; n += n > 0 ? -1 : 1) {
      const T far =
          n > 0 ? std::numeric_limits<T>::infinity() : -std::numeric_limits<T>::infinity();
      y = x == 0 ? x : std::nextafter(y, far);
    }
    return y;
  };
  for (int i = 0; i < count; ++i) {
    DeterminantCase<T> c{draw(), draw(), draw(), draw()};
    if (i % 8 == 1) {
      c = {T(lattice(random)), T(lattice(random)), T(lattice(random)), T(lattice(random))};
    } else if (i % 8 == 2) {
      c.b_x = c.a_x;
      c.b_y = i % 16 == 2 ? c.a_y : -c.a_y;
    } else if (i % 8 >= 3) {
      // b = s a, but for its rounding and some steps.
      const T s = i % 8 == 3 ? T(lattice(random)) : draw();
      c.b_x = moved(static_cast<T>(s * c.a_x));
      c.b_y = moved(static_cast<T>(s * c.a_y));
    }
    if (i % 3 == 0) {
      const int a = binade(random), b = binade(random);
      c = {std::ldexp(c.a_x, a), std::ldexp(c.a_y, a), std::ldexp(c.b_x, b), std::ldexp(c.b_y, b)};
    }
    all.push_back(c);
  }
  return all;
}

}  // namespace pellucid::test
