// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/defaults.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "blocks/value_classes.h"
#include "looks/distinct_colors.h"
#include "looks/value_sample.h"
#include "mean_chord.h"
#include "readable_numbers.h"

namespace pellucid {
namespace {

/// Makes the function of values that are even in a body that fills a share of a box whose chords
/// have this mean.
TransferFunction make_default(const ClassedValues& of, double chord, double filled) {
  const std::vector<double>& v = of.values;
  const std::size_t n = v.size();
  const Depths extinction(n, chord, filled);
  // Dark low values draw an outline where a ray grazes a surface; bright high values shine through.
  constexpr Rgb<double> faint{0.1, 0.012, 0.008}, dark{0.16, 0.02, 0.012}, red{0.45, 0.1, 0.04},
      orange{0.95, 0.5, 0.2}, white{1, 0.95, 0.82};

  if (n == 0) return TransferFunction({{0, 0, orange}});
  if (!of.differ) return TransferFunction({{v.front(), extinction(1, 0), orange}});

  const std::size_t foreground = of.classes.foreground, bright = of.classes.bright;
  const double threshold = of.threshold();
  PointList points(v.back() - v.front());
  points.add(of.mean(0, foreground) / 2 + threshold / 2, 0, faint);
  points.add(threshold, extinction(0.5, foreground), dark);
  if (bright < n) {
    points.add(of.mean(foreground, bright), extinction(0.8, foreground), red);
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

TransferFunction default_transfer_function(const MeshChannels& mesh) {
  const Box<double>& box = mesh.mesh().bounds();
  const Vec3<double> size = box.upper - box.lower;
  const double filled = mesh.mesh().statistics().volume / (size.x * size.y * size.z);
  return make_default(ClassedValues(value_sample(mesh)), mean_chord(box), std::min(filled, 1.0));
}

namespace {

/// Returns a grey ramp for a projection. `longest`: of a ray, in the world.
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

/// Returns a transparent ramp over the range of a volume or a mesh.
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
  return default_label_table(labels.labels(),
                             extinction.value_or(default_label_extinction(labels.volume())));
}

LabelTable default_label_table(const std::vector<std::int32_t>& labels, double extinction) {
  std::vector<LabelStyle> styles;
  for (const std::int32_t label : labels) {
    if (label != 0) styles.push_back({label, "", {}, extinction});
  }
  if (styles.empty()) styles.push_back({0, "", {}, extinction});
  const std::vector<Rgb<double>> colors = distinct_colors(std::vector<double>(styles.size(), 0.75));
  // Neighbors in the list, which mostly are neighbors in the data, get hues that are far apart.
  std::size_t step = std::max<std::size_t>(1, colors.size() * 382 / 1000);
  while (std::gcd(step, colors.size()) != 1) ++step;
  for (std::size_t i = 0; i < styles.size(); ++i) {
    styles[i].color = colors[i * step % colors.size()];
  }
  return LabelTable(std::move(styles));
}

double default_label_extinction(const Volume& volume) {
  const auto corners = volume.world_corners();
  double longest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    longest = std::max(longest, length(corners[7 - i] - corners[i]));
  }
  return two_digits(200 * std::numbers::ln2 / longest);
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
