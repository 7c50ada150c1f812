// SPDX-License-Identifier: Apache-2.0
#include "import_paths.h"

namespace pellucid::imported {
namespace {

// vtkMath::RGBToHSV.
Triple<double> hsv_of(const Triple<double>& rgb) {
  const auto [r, g, b] = rgb;
  const double largest = std::max({r, g, b}), smallest = std::min({r, g, b});
  const double span = largest - smallest;
  const double saturation = largest > 0 ? span / largest : 0;
  double hue = 0;
  if (saturation > 0) {
    hue = r == largest   ? (g - b) / span / 6
          : g == largest ? 1.0 / 3 + (b - r) / span / 6
                         : 2.0 / 3 + (r - g) / span / 6;
    if (hue < 0) hue += 1;
  }
  return {hue, saturation, largest};
}

}  // namespace

// vtkMath::RGBToXYZ and XYZToLab.
Triple<double> lab_of(const Triple<double>& rgb) {
  const auto [r, g, b] = color_of_signals<double>(rgb, ColorEncoding::srgb);
  const auto compress = [](double t) {
    return t > 0.008856 ? std::pow(t, 1.0 / 3) : 7.787 * t + 16.0 / 116;
  };
  const double x = compress((r * 0.4124 + g * 0.3576 + b * 0.1805) / 0.9505);
  const double y = compress(r * 0.2126 + g * 0.7152 + b * 0.0722);
  const double z = compress((r * 0.0193 + g * 0.1192 + b * 0.9505) / 1.089);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

namespace {

// Moreland's Msh: the length of (L, a, b), its angle to the L axis, and the hue.
Triple<double> msh_of(const Triple<double>& rgb) {
  const auto [l, a, b] = lab_of(rgb);
  const double m = std::sqrt(l * l + a * a + b * b);
  const double s = m > 0.001 ? std::acos(l / m) : 0;
  return {m, s, s > 0.001 ? std::atan2(b, a) : 0};
}

double angle_between(double a, double b) {
  const double difference = std::fmod(std::abs(a - b), 2 * std::numbers::pi);
  return std::min(difference, 2 * std::numbers::pi - difference);
}

/// Returns a hue for an end without saturation, of length m, such that the way to the saturated one
/// changes evenly (Moreland's AdjustHue).
double adjusted_hue(const Triple<double>& saturated, double m) {
  if (saturated[0] >= m - 0.1) return saturated[2];
  const double spin = saturated[1] * std::sqrt(m * m - saturated[0] * saturated[0]) /
                      (saturated[0] * std::sin(saturated[1]));
  return saturated[2] > -0.3 * std::numbers::pi ? saturated[2] + spin : saturated[2] - spin;
}

constexpr double saturated_from = 0.05;

void adjust_hues(Triple<double>& a, Triple<double>& b) {
  if (a[1] < saturated_from && b[1] > saturated_from) {
    a[2] = adjusted_hue(b, a[0]);
  } else if (b[1] < saturated_from && a[1] > saturated_from) {
    b[2] = adjusted_hue(a, b[0]);
  }
}

}  // namespace

ColorPath::ColorPath(const ColorNode& from, const ColorNode& to, ColorSpace space,
                     ColorEncoding numbers)
    : from_(from),
      to_(to),
      space_(space),
      numbers_(numbers),
      middle_(place_at(std::clamp(from.midpoint, 0.00001, 0.99999), from.x, to.x,
                       from.logarithmic && from.x < to.x)),
      begin_(triple(from.color)),
      end_(triple(to.color)) {
  for (const Triple<double>& color : {begin_, end_}) {
    for (const double x : color) is_outside_ = is_outside_ || x < 0 || x > 1;
  }
  // Ends alike stay what they are: a way through another space would only round them.
  if (begin_ == end_ && space_ != ColorSpace::step) space_ = ColorSpace::rgb;
  if (space_ == ColorSpace::hsv || space_ == ColorSpace::hsv_without_wrap) {
    set_hsv(space_ == ColorSpace::hsv);
  } else if (space_ == ColorSpace::lab) {
    begin_ = lab_of(begin_);
    end_ = lab_of(end_);
  } else if (space_ == ColorSpace::diverging) {
    set_diverging();
  }
}

void ColorPath::set_hsv(bool wrap) {
  begin_ = hsv_of(begin_);
  end_ = hsv_of(end_);
  if (!wrap || std::abs(begin_[0] - end_[0]) <= 0.5) return;
  (begin_[0] > end_[0] ? begin_ : end_)[0] -= 1;
}

// White is put between two saturated colors of different hue.
void ColorPath::set_diverging() {
  begin_ = msh_of(begin_);
  end_ = msh_of(end_);
  second_begin_ = begin_;
  second_end_ = end_;
  through_white_ = begin_[1] > saturated_from && end_[1] > saturated_from &&
                   angle_between(begin_[2], end_[2]) > 0.33 * std::numbers::pi;
  if (through_white_) {
    const Triple<double> white{std::max({begin_[0], end_[0], 88.0}), 0, 0};
    end_ = second_begin_ = white;
  }
  adjust_hues(begin_, end_);
  adjust_hues(second_begin_, second_end_);
}

template <class T>
T ColorPath::share(const T& value, bool second_half) const {
  const T s = way_share(value, from_.x, to_.x, from_.logarithmic);
  return node_shape(s, from_.midpoint, from_.sharpness, second_half,
                    space_ != ColorSpace::diverging);
}

template <class T>
Triple<T> ColorPath::color(const T& value, const Place& place) const {
  // VTK looks at a large sharpness first.
  if (space_ == ColorSpace::step && from_.sharpness <= 0.99) {
    return color_of_signals<T>({T(end_[0]), T(end_[1]), T(end_[2])}, numbers_);
  }
  Triple<T> color = uncut_color(value, place);
  // VTK cuts what is sharp, and nothing else.
  for (T& x : color) x = is_outside_ && is_sharp() ? limited(x, 1) : x;
  return color;
}

template <class T>
Triple<T> ColorPath::uncut_color(const T& value, const Place& place) const {
  const T s = share(value, place.color_second_half);
  if (space_ == ColorSpace::rgb || space_ == ColorSpace::step) {
    return color_of_signals(mixed(begin_, end_, s), numbers_);
  }
  if (space_ == ColorSpace::way) {
    const WayPoint &a = from_.way[place.way], &b = from_.way[place.way + 1];
    return color_of_signals(
        mixed(triple(a.color), triple(b.color), ratio(s - T(a.share), b.share - a.share)),
        numbers_);
  }
  if (space_ == ColorSpace::lab) {
    const auto [l, a, b] = mixed(begin_, end_, s);
    return color_of_light(light_of_lab(l, a, b), numbers_);
  }
  if (space_ == ColorSpace::diverging) {
    const bool second = through_white_ && place.color_second_half;
    const T t = !through_white_ ? s : second ? s * T(2) - T(1) : s * T(2);
    const auto [m, angle, hue] =
        second ? mixed(second_begin_, second_end_, t) : mixed(begin_, end_, t);
    const T chroma = m * sine(angle);
    return color_of_light(light_of_lab(m * cosine(angle), chroma * cosine(hue), chroma * sine(hue)),
                          numbers_);
  }
  const auto [hue, saturation, brightness] = mixed(begin_, end_, s);
  return color_of_signals(signals_of_hsv(hue, saturation, brightness, place.sextant), numbers_);
}

template Triple<double> ColorPath::color(const double&, const Place&) const;
template Triple<Jet> ColorPath::color(const Jet&, const Place&) const;

double ColorPath::hue(double value, const Place& place) const {
  const bool has_hue = space_ == ColorSpace::hsv || space_ == ColorSpace::hsv_without_wrap;
  return has_hue ? mix(begin_[0], end_[0], share(value, place.color_second_half)) : 0;
}

/// Adds the positions at which the hue passes from one sextant to the next.
void ColorPath::add_hue_breaks(std::vector<double>& breaks) const {
  const double first = std::min(begin_[0], end_[0]), last = std::max(begin_[0], end_[0]);
  for (double sextant = std::floor(first * 6) + 1; sextant < last * 6; ++sextant) {
    // The hue is monotone in the value.
    double before = from_.x, after = to_.x;
    for (int i = 0; i < 100; ++i) {
      const double value = before + (after - before) / 2;
      Place place;
      place.color_second_half = second_half(value);
      ((hue(value, place) * 6 < sextant) == (begin_[0] < end_[0]) ? before : after) = value;
    }
    breaks.push_back(after);
  }
}

std::size_t ColorPath::corner(double value) const {
  if (space_ != ColorSpace::way) return 0;
  const double s = share(value, second_half(value));
  const auto after = std::upper_bound(from_.way.begin() + 1, from_.way.end() - 1, s,
                                      [](double x, const WayPoint& p) { return x < p.share; });
  return static_cast<std::size_t>(after - from_.way.begin()) - 1;
}

void ColorPath::add_way_breaks(std::vector<double>& breaks) const {
  for (std::size_t i = 1; i + 1 < from_.way.size(); ++i) {
    double before = from_.x, after = to_.x;
    for (int k = 0; k < 100; ++k) {
      const double value = before + (after - before) / 2;
      (share(value, second_half(value)) < from_.way[i].share ? before : after) = value;
    }
    breaks.push_back(after);
  }
}

std::vector<double> ColorPath::breaks() const {
  std::vector<double> breaks{from_.x, to_.x};
  const bool plain = from_.midpoint == 0.5 && from_.sharpness < 0.01;
  if (!plain || through_white_) breaks.push_back(middle_);
  if (space_ == ColorSpace::hsv || space_ == ColorSpace::hsv_without_wrap) add_hue_breaks(breaks);
  if (space_ == ColorSpace::way) add_way_breaks(breaks);
  return breaks;
}

}  // namespace pellucid::imported
