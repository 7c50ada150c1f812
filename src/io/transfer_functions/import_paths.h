// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "import_curves.h"

namespace pellucid::imported {

/// Returns a color of signals as VTK's (L, a, b).
Triple<double> lab_of(const Triple<double>& rgb);

/// Between which nodes a stretch of values lies, and where there.
struct Place {
  double inside = 0;                   ///< a value of the stretch that is no break
  std::size_t color = 0, opacity = 0;  ///< the node before it; at or beyond an end: constant
  bool color_second_half = false, opacity_second_half = false;
  double sextant = 0;   ///< of the hue
  std::size_t way = 0;  ///< the corner before it, of a way
};

/// The way from one color to the next, its ends in the space in which it is straight.
class ColorPath {
 public:
  ColorPath(const ColorNode& from, const ColorNode& to, ColorSpace space, ColorEncoding numbers);

  /// Returns the color where no break of breaks() lies within the value.
  template <class T>
  Triple<T> color(const T& value, const Place& place) const;
  double hue(double value, const Place& place) const;
  /// Returns the last corner of a way before a value, which is no corner.
  std::size_t corner(double value) const;
  /// Returns the values, from one end to the other, between which color() is smooth.
  std::vector<double> breaks() const;
  bool second_half(double value) const { return value > middle_; }

 private:
  template <class T>
  T share(const T& value, bool second_half) const;
  template <class T>
  Triple<T> uncut_color(const T& value, const Place& place) const;
  template <class T>
  Triple<T> mixed(const Triple<double>& a, const Triple<double>& b, const T& share) const {
    return {mix(a[0], b[0], share), mix(a[1], b[1], share), mix(a[2], b[2], share)};
  }
  void set_hsv(bool wrap);
  void set_diverging();
  void add_hue_breaks(std::vector<double>& breaks) const;
  void add_way_breaks(std::vector<double>& breaks) const;
  /// Returns whether the way is bent by a sharpness.
  bool is_sharp() const { return from_.sharpness >= 0.01 && from_.sharpness <= 0.99; }

  ColorNode from_, to_;
  ColorSpace space_;
  ColorEncoding numbers_;
  double middle_;
  /// In the space of the way; for ColorSpace::diverging those of the second half behind them.
  Triple<double> begin_{}, end_{}, second_begin_{}, second_end_{};
  bool through_white_ = false, is_outside_ = false;
};

/// An imported function in its smooth pieces.
class Curves {
 public:
  explicit Curves(const Function& function);

  /// Returns where pieces meet, ascending, each once; between two neighbours color and opacity are
  /// smooth, but for kinks of Jet::larger().
  const std::vector<double>& breaks() const noexcept { return breaks_; }
  Place place(double inside) const;
  template <class T>
  Triple<T> color(const T& value, const Place& place) const;
  template <class T>
  T opacity(const T& value, const Place& place) const;

 private:
  template <class T>
  T highest_gaussian(const T& value, const Place& place) const;

  const Function& function_;
  std::vector<ColorPath> colors_;
  std::vector<double> breaks_;
  bool is_outside_ = false;  ///< numbers of nodes are beyond the function's limits
};

}  // namespace pellucid::imported
