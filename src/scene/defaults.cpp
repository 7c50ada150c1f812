// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/defaults.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "distinct_colors.h"
#include "mean_chord.h"
#include "readable_numbers.h"
#include "value_sample.h"

namespace pellucid {
namespace {

using Point = TransferFunction::Point;

/// Three classes of the sorted values: [0, foreground), [foreground, bright), [bright, n).
struct Classes {
  std::size_t foreground = 0, bright = 0;
};

/// Otsu 1979 with three classes: the sum of squared distances to the classes' means is smallest.
/// (Two splits into two, one after the other, would first tell bone from the rest and never find
/// air.) A class begins at a new value. The thresholds tried are spread evenly over the range and
/// over the ranks, 256 in all. With two values only, the bright class is empty.
Classes otsu_classes(const std::vector<double>& v) {
  const std::size_t n = v.size();
  const double range = v.back() - v.front();
  std::vector<double> sum(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) sum[i + 1] = sum[i] + (v[i] - v.front()) / range;

  std::vector<std::size_t> starts;
  const auto add = [&](double threshold) {
    const auto start = std::lower_bound(v.begin(), v.end(), threshold) - v.begin();
    if (start > 0 && v[static_cast<std::size_t>(start)] > v.front()) {
      starts.push_back(static_cast<std::size_t>(start));
    }
  };
  constexpr std::size_t count = 128;
  for (std::size_t i = 1; i < count; ++i) {
    add(v.front() + range * (static_cast<double>(i) / count));
    add(v[n * i / count]);
  }
  add(v.back());
  std::sort(starts.begin(), starts.end());
  starts.erase(std::unique(starts.begin(), starts.end()), starts.end());

  // Within-class squares are all squares less this, summed over the classes.
  const auto between = [&](std::size_t first, std::size_t last) {
    const double s = sum[last] - sum[first];
    return s * s / static_cast<double>(last - first);
  };
  Classes best{starts[0], n};
  double largest = 0;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    for (std::size_t j = i + 1; j < starts.size(); ++j) {
      const double score =
          between(0, starts[i]) + between(starts[i], starts[j]) + between(starts[j], n);
      if (score > largest) {
        largest = score;
        best = {starts[i], starts[j]};
      }
    }
  }
  return best;
}

double mean(const std::vector<double>& v, std::size_t first, std::size_t last) {
  double sum = 0;
  for (std::size_t i = first; i < last; ++i) sum += v[i] - v[first];
  return v[first] + sum / static_cast<double>(last - first);
}

/// Points in ascending order at readable values, which may not fall together.
class PointList {
 public:
  explicit PointList(double range) : range_(range) {}

  /// Where the rounded value falls on the point before, it keeps more digits.
  void add(double value, double extinction, Rgb<double> color) {
    for (double range = range_; range > range_ * 1e-18; range /= 10) {
      const double near =
          std::clamp(readable(value, range), -largest_data_value, largest_data_value);
      if (points_.empty() || near > points_.back().value) {
        points_.push_back({near, extinction, color});
        return;
      }
    }
  }
  std::vector<Point> take() { return std::move(points_); }

 private:
  double range_;
  std::vector<Point> points_;
};

/// Values of value_sample(), and their classes where there are two different ones.
struct ClassedValues {
  explicit ClassedValues(std::vector<double> of)
      : values(std::move(of)), differ(!values.empty() && values.front() != values.back()) {
    if (differ) classes = otsu_classes(values);
  }
  /// Between the background and the rest.
  double threshold() const {
    return values[classes.foreground - 1] / 2 + values[classes.foreground] / 2;
  }

  std::vector<double> values;
  bool differ;
  Classes classes{};
};

/// The values are even in a body that fills a share of a box whose chords have this mean. `density`
/// multiplies the extinctions.
TransferFunction make_default(const ClassedValues& of, double chord, double filled,
                              double density = 1) {
  const std::vector<double>& v = of.values;
  const std::size_t n = v.size();

  // The extinction that gives a typical path through all values from index `first` on the optical
  // depth: what fills a share s of the box is taken for a body of the box's shape, ∛s times as
  // wide.
  const auto extinction = [&](double depth, std::size_t first) {
    const double share = filled * static_cast<double>(n - first) / static_cast<double>(n);
    const double e = density * depth / (std::cbrt(share) * chord);
    return std::isfinite(e) ? two_digits(std::clamp(e, 1 / largest_number, largest_number)) : 1;
  };
  // Dark low values draw an outline where a ray grazes a surface; bright high values shine through.
  constexpr Rgb<double> faint{0.1, 0.012, 0.008}, dark{0.16, 0.02, 0.012}, red{0.45, 0.1, 0.04},
      orange{0.95, 0.5, 0.2}, white{1, 0.95, 0.82};

  if (n == 0) return TransferFunction({{0, 0, orange}});
  if (!of.differ) return TransferFunction({{v.front(), extinction(1, 0), orange}});

  const std::size_t foreground = of.classes.foreground, bright = of.classes.bright;
  const double threshold = of.threshold();
  PointList points(v.back() - v.front());
  points.add(mean(v, 0, foreground) / 2 + threshold / 2, 0, faint);
  points.add(threshold, extinction(0.5, foreground), dark);
  if (bright < n) {
    points.add(mean(v, foreground, bright), extinction(0.8, foreground), red);
    points.add(v[bright], extinction(1.6, bright), orange);
    points.add(v.back(), extinction(5, bright), white);
  } else {
    points.add(v[foreground], extinction(1.6, foreground), orange);
  }
  return TransferFunction(points.take());
}

}  // namespace

TransferFunction default_transfer_function(const Volume& volume) {
  return make_default(ClassedValues(value_sample(volume)), mean_chord(volume), 1);
}

namespace {

/// Calls visit(a, b) with values that are neighbors along an axis, at up to 2^18 places that are
/// even in the volume. None of them is NaN.
template <class Visit>
void visit_neighbors(const Volume& volume, const Visit& visit) {
  std::visit(
      [&](const auto& data) {
        const auto& n = volume.description().dimensions;
        const std::size_t row = static_cast<std::size_t>(n[0]),
                          slice = row * static_cast<std::size_t>(n[1]);
        const auto look = [&](std::size_t i) {
          const auto here = static_cast<double>(data[i]);
          const auto beside = [&](bool inside, std::size_t step) {
            if (!inside) return;
            const auto there = static_cast<double>(data[i + step]);
            if (!std::isnan(here) && !std::isnan(there)) visit(here, there);
          };
          beside(i % row + 1 < row, 1);
          beside(i % slice + row < slice, row);
          beside(i + slice < data.size(), slice);
        };
        visit_even_places(data.size(), look);
      },
      volume.data());
}

/// Whether the background ends at surfaces (default_look()). `of`: its values.
bool has_surfaces(const Volume& volume, const ClassedValues& of) {
  if (!of.differ) return false;
  const std::vector<double>& v = of.values;
  const std::size_t foreground = of.classes.foreground;
  const double threshold = of.threshold();
  const double apart = mean(v, foreground, v.size()) / 2 - mean(v, 0, foreground) / 2;
  std::vector<double> steps;
  std::size_t pairs = 0;
  visit_neighbors(volume, [&](double a, double b) {
    ++pairs;
    if ((a < threshold) != (b < threshold)) steps.push_back(std::abs(b / 2 - a / 2));
  });
  // Noise goes through the threshold everywhere.
  if (steps.empty() || 8 * steps.size() > pairs) return false;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return 6 * *middle >= apart;
}

}  // namespace

DefaultLook default_look(const Volume& volume) {
  const ClassedValues values(value_sample(volume));
  const double chord = mean_chord(volume);
  if (!has_surfaces(volume, values)) return {make_default(values, chord, 1), std::nullopt};
  constexpr double density = 8;
  Shading shading;
  shading.ambient = 0.3;
  shading.diffuse = 0.8;
  shading.specular = 0.15;
  return {make_default(values, chord, 1, density), shading};
}

TransferFunction default_transfer_function(const MeshChannels& mesh) {
  const Box<double>& box = mesh.mesh().bounds();
  const Vec3<double> size = box.upper - box.lower;
  const double filled = mesh.mesh().statistics().volume / (size.x * size.y * size.z);
  return make_default(ClassedValues(value_sample(mesh)), mean_chord(box), std::min(filled, 1.0));
}

namespace {

/// `longest`: of a ray, in the world.
TransferFunction grey_ramp(const VolumeStatistics& data, LayerProjection projection,
                           double longest) {
  double lower = data.minimum, upper = data.maximum;
  if (projection == LayerProjection::sum) {
    // Within what TransferFunction accepts.
    lower = std::max(std::min(lower, 0.0) * longest, -2e37);
    upper = std::min(std::max(upper, 0.0) * longest, 2e37);
  }
  constexpr Rgb<double> black{0, 0, 0}, white{1, 1, 1};
  if (!(lower < upper)) return TransferFunction({{lower, 1, white}});
  return TransferFunction({{lower, 1, black}, {upper, 1, white}});
}

/// Of a volume or a mesh.
template <class Data>
TransferFunction transparent_ramp(const Data& data) {
  std::vector<TransferFunction::Point> points =
      projection_transfer_function(data, LayerProjection::maximum).points();
  for (TransferFunction::Point& point : points) point.extinction = 0;
  return TransferFunction(std::move(points));
}

}  // namespace

TransferFunction projection_transfer_function(const Volume& volume, LayerProjection projection) {
  const Vec3<double> size = volume.grid_upper() - volume.grid_lower();
  double longest = 0;
  for (int a = 0; a < 3; ++a) {
    longest = std::max(longest, size[a] * length(volume.world_from_grid().matrix.column[a]));
  }
  return grey_ramp(volume.statistics(), projection, longest);
}

TransferFunction projection_transfer_function(const MeshChannels& mesh,
                                              LayerProjection projection) {
  const Vec3<double> size = mesh.mesh().bounds().upper - mesh.mesh().bounds().lower;
  return grey_ramp(mesh.statistics(0), projection, std::max({size.x, size.y, size.z}));
}

TransferFunction grey_colors(const Volume& volume) {
  return transparent_ramp(volume);
}

TransferFunction grey_colors(const MeshChannels& mesh) {
  return transparent_ramp(mesh);
}

LabelTable default_label_table(const LabelVolume& labels, std::optional<double> extinction) {
  std::vector<LabelStyle> styles;
  const double each = extinction.value_or(default_label_extinction(labels.volume()));
  for (const std::int32_t label : labels.labels()) {
    if (label != 0) styles.push_back({label, "", {}, each});
  }
  if (styles.empty()) styles.push_back({0, "", {}, each});
  const std::vector<Rgb<double>> colors = distinct_colors(std::vector<double>(styles.size(), 0.75));
  for (std::size_t i = 0; i < styles.size(); ++i) styles[i].color = colors[i];
  return LabelTable(std::move(styles));
}

double default_label_extinction(const Volume& volume) {
  const auto corners = volume.world_corners();
  double longest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    longest = std::max(longest, length(corners[7 - i] - corners[i]));
  }
  return two_digits(40 * std::numbers::ln2 / longest);
}

Camera default_camera(const Volume& volume, ImageSize size) {
  return default_camera(volume.world_corners(), size);
}

Camera default_camera(const std::array<Vec3<double>, 8>& corners, ImageSize size) {
  constexpr double degree = std::numbers::pi / 180;
  constexpr double azimuth = 30 * degree, elevation = 20 * degree, margin = 1.05;
  const Vec3<double> backward{std::sin(azimuth) * std::cos(elevation),
                              -std::cos(azimuth) * std::cos(elevation), std::sin(elevation)};
  const Vec3<double> right{std::cos(azimuth), std::sin(azimuth), 0};
  const Vec3<double> up = cross(backward, right);

  Camera camera;
  camera.vertical_angle = 30;
  camera.up = {0, 0, 1};
  const double half_height = std::tan(camera.vertical_angle / 2 * degree) / margin;
  const double half_width = half_height * size.width / size.height;

  Vec3<double> center{};
  for (const Vec3<double>& corner : corners) center = center + corner * 0.125;
  // A corner is in the picture from where |x| <= half_width · depth and |y| <= half_height · depth.
  double distance = 0;
  for (const Vec3<double>& corner : corners) {
    const Vec3<double> offset = corner - center;
    const double x = std::abs(dot(offset, right)), y = std::abs(dot(offset, up));
    distance =
        std::max(distance, std::max(x / half_width, y / half_height) + dot(offset, backward));
  }
  camera.focal_point = center;
  camera.position = center + backward * distance;
  return camera;
}

}  // namespace pellucid
