// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/camera_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "pellucid/scene/error.h"
#include "pellucid/scene/view_camera.h"

namespace pellucid {

namespace {

using Quaternion = std::array<double, 4>;

double dot(const Quaternion& a, const Quaternion& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

/// Returns the turn that takes the axes of the world to these, which are of length 1 and at right
/// angles (Shepperd 1978: the largest component first, so that nothing cancels).
Quaternion quaternion_of(const Vec3<double>& x, const Vec3<double>& y, const Vec3<double>& z) {
  const double trace = x.x + y.y + z.z;
  const std::array<double, 4> squares{1 + 2 * x.x - trace, 1 + 2 * y.y - trace, 1 + 2 * z.z - trace,
                                      1 + trace};
  const auto largest = std::max_element(squares.begin(), squares.end()) - squares.begin();
  const double c = std::sqrt(squares[static_cast<std::size_t>(largest)]) / 2, f = 1 / (4 * c);
  switch (largest) {
    case 0:
      return {c, (x.y + y.x) * f, (x.z + z.x) * f, (y.z - z.y) * f};
    case 1:
      return {(x.y + y.x) * f, c, (y.z + z.y) * f, (z.x - x.z) * f};
    case 2:
      return {(x.z + z.x) * f, (y.z + z.y) * f, c, (x.y - y.x) * f};
    default:
      return {(y.z - z.y) * f, (z.x - x.z) * f, (x.y - y.x) * f, c};
  }
}

/// Returns where a turn takes `v`.
Vec3<double> turned(const Quaternion& q, const Vec3<double>& v) {
  const Vec3<double> axis{q[0], q[1], q[2]};
  const Vec3<double> t = cross(axis, v) * 2;
  return v + t * q[3] + cross(axis, t);
}

/// Interpolates along the great circle, and beyond its ends (Shoemake 1985).
Quaternion mixed_turn(const Quaternion& a, const Quaternion& b, double share) {
  const double angle = std::acos(std::clamp(dot(a, b), -1.0, 1.0));
  constexpr double small = 1e-6;  // sin(s x) / sin(x) is s up to 1e-12
  double of_a = 1 - share, of_b = share;
  if (angle > small) {
    of_a = std::sin((1 - share) * angle) / std::sin(angle);
    of_b = std::sin(share * angle) / std::sin(angle);
  }
  Quaternion made{};
  for (std::size_t i = 0; i < 4; ++i) made[i] = of_a * a[i] + of_b * b[i];
  const double length = std::sqrt(dot(made, made));
  for (double& part : made) part /= length;
  return made;
}

Quaternion negative(const Quaternion& q) {
  return {-q[0], -q[1], -q[2], -q[3]};
}

/// Returns the number that the picture's extent goes with: the angle of view, or the scale.
double extent_of(const Camera& camera) {
  return camera.projection == Projection::perspective ? camera.vertical_angle
                                                      : camera.parallel_scale;
}

}  // namespace

Camera turned_camera(const Camera& camera, double degrees,
                     const std::optional<Vec3<double>>& axis) {
  const Vec3<double> around = axis.value_or(camera.up);
  if (!(length(around) > 0)) throw Error("turntable: the axis has no length");
  const double radians = degrees * std::numbers::pi / 180;
  const Vec3<double> unit = normalized(around);
  Camera made = camera;
  made.position = camera.focal_point + rotated(camera.position - camera.focal_point, unit, radians);
  made.up = rotated(camera.up, unit, radians);
  return made;
}

CameraPath::View CameraPath::view_of(const Camera& camera) {
  const CameraFrame<double> frame = make_camera_frame(camera, {1, 1});
  View view;
  view.turn = quaternion_of(normalized(frame.right), normalized(frame.up), -frame.forward);
  view.focus = {camera.focal_point.x, camera.focal_point.y, camera.focal_point.z};
  view.lengths = {std::log(length(camera.position - camera.focal_point)),
                  std::log(extent_of(camera))};
  return view;
}

CameraPath::View CameraPath::mixed(const View& a, const View& b, double share) {
  View view;
  view.turn = mixed_turn(a.turn, b.turn, share);
  for (std::size_t i = 0; i < 3; ++i) {
    view.focus[i] = a.focus[i] + share * (b.focus[i] - a.focus[i]);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    view.lengths[i] = a.lengths[i] + share * (b.lengths[i] - a.lengths[i]);
  }
  return view;
}

/// Adds the turn in radians, how much nearer the eye comes and the picture zooms, as logarithms,
/// and how far the focal point moves, in distances of the eye from it.
double CameraPath::distance_between(const View& a, const View& b) {
  const double eye = std::exp((a.lengths[0] + b.lengths[0]) / 2);
  const double angle = 2 * std::acos(std::min(1.0, std::abs(dot(a.turn, b.turn))));
  double focus = 0;
  for (std::size_t i = 0; i < 3; ++i) focus = std::hypot(focus, a.focus[i] - b.focus[i]);
  return angle + std::abs(a.lengths[0] - b.lengths[0]) + std::abs(a.lengths[1] - b.lengths[1]) +
         focus / eye;
}

CameraPath::CameraPath(const std::vector<CameraKey>& keys, double seconds, bool is_closed) {
  if (keys.empty()) throw Error("camera path: has no camera");
  like_ = keys.front().camera;
  const bool is_timed = keys.front().at.has_value();
  // The number of the view of each key, and its time.
  std::vector<std::size_t> view_of_key;
  std::vector<double> times;
  const auto append = [&](View view) {
    if (!views_.empty() && dot(view.turn, views_.back().turn) < 0) view.turn = negative(view.turn);
    if (views_.empty() || distance_between(view, views_.back()) > 0) views_.push_back(view);
    view_of_key.push_back(views_.size() - 1);
  };
  constexpr double least_gap = 1e-6;  // seconds
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto fail = [&](const std::string& what) {
      throw Error("camera path: camera " + std::to_string(i + 1) + " " + what);
    };
    const CameraKey& key = keys[i];
    if (key.at.has_value() != is_timed) {
      fail(is_timed ? "has no \"at\", but the first has; give all of them a time, or none"
                    : "has \"at\", but the first has none; give all of them a time, or none");
    }
    if (is_timed && !(*key.at >= 0 && *key.at <= seconds)) {
      fail("is at " + std::to_string(*key.at) + " s, outside of the film's " +
           std::to_string(seconds) + " s");
    }
    if (is_timed && i > 0 && !(*key.at >= *keys[i - 1].at + least_gap)) {
      fail("is not later than the one before");
    }
    if (key.camera.projection != like_.projection) {
      fail("has another projection than the first; give all of them the same");
    }
    append(view_of(key.camera));
    if (is_timed) times.push_back(*key.at);
  }
  const bool returns = is_closed && views_.size() > 1;
  if (is_closed && is_timed && keys.size() > 1 && !(seconds >= times.back() + least_gap)) {
    throw Error("camera path: is closed, but its last camera is at the end; give it a time before");
  }
  if (returns) {
    append(views_.front());
    if (is_timed) times.push_back(seconds);
  }
  const std::size_t count = views_.size();
  if (count == 1) return;
  // Centripetal knots bend least between views that are unevenly far apart (Yuksel 2011).
  knots_ = {0};
  for (std::size_t i = 1; i < count; ++i) {
    knots_.push_back(knots_.back() + std::sqrt(distance_between(views_[i], views_[i - 1])));
  }
  // The next one beyond either end: of a closed path that which follows, else a mirrored one.
  const double last_gap = knots_[count - 1] - knots_[count - 2], first_gap = knots_[1] - knots_[0];
  View before = mixed(views_[1], views_[0], 2);
  View after = mixed(views_[count - 2], views_[count - 1], 2);
  double before_gap = first_gap, after_gap = last_gap;
  if (returns && count > 2) {
    before = views_[count - 2];
    if (dot(before.turn, views_[0].turn) < 0) before.turn = negative(before.turn);
    after = views_[1];
    if (dot(after.turn, views_[count - 1].turn) < 0) after.turn = negative(after.turn);
    before_gap = last_gap;
    after_gap = first_gap;
  }
  views_.insert(views_.begin(), before);
  views_.push_back(after);
  knots_.insert(knots_.begin(), knots_.front() - before_gap);
  knots_.push_back(knots_.back() + after_gap);
  const std::vector<double> way_of_view = measure();
  if (is_timed) {
    for (const std::size_t view : view_of_key) ways_.push_back(way_of_view[view]);
    times_ = std::move(times);
  } else {
    times_ = {0, seconds};
    ways_ = {0, lengths_.back()};
  }
  find_speeds();
}

/// Notes how far it is along the path to which knot. Returns how far it is to each view.
std::vector<double> CameraPath::measure() {
  constexpr int parts = 512;  // between two cameras
  lengths_ = {0};
  places_ = {knots_[1]};
  std::vector<double> ways{0};
  View last = view_at(knots_[1]);
  for (std::size_t i = 1; i + 2 < knots_.size(); ++i) {
    for (int k = 1; k <= parts; ++k) {
      const double knot = knots_[i] + (knots_[i + 1] - knots_[i]) * k / parts;
      const View next = view_at(knot);
      lengths_.push_back(lengths_.back() + distance_between(last, next));
      places_.push_back(knot);
      last = next;
    }
    ways.push_back(lengths_.back());
  }
  return ways;
}

/// Chooses the speed at each time so that the way never goes back and has no corner: the harmonic
/// mean of the speeds beside it (Fritsch and Butland 1984).
void CameraPath::find_speeds() {
  const std::size_t count = times_.size();
  const auto speed = [&](std::size_t i) {
    return (ways_[i + 1] - ways_[i]) / (times_[i + 1] - times_[i]);
  };
  speeds_.assign(count, 0);
  if (count < 2) return;
  speeds_.front() = speed(0);
  speeds_.back() = speed(count - 2);
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const double a = speed(i - 1), b = speed(i);
    const double share = (times_[i] - times_[i - 1] + 2 * (times_[i + 1] - times_[i])) /
                         (3 * (times_[i + 1] - times_[i - 1]));
    speeds_[i] = a * b > 0 ? a * b / (share * b + (1 - share) * a) : 0;
  }
}

/// Returns how far the path is at a moment, by the cubic of Hermite between two times.
double CameraPath::way_at(double seconds) const {
  if (times_.size() < 2 || !(seconds > times_.front())) return ways_.front();
  if (!(seconds < times_.back())) return ways_.back();
  const auto above = std::upper_bound(times_.begin(), times_.end(), seconds);
  const auto i = static_cast<std::size_t>(above - times_.begin()) - 1;
  const double gap = times_[i + 1] - times_[i], u = (seconds - times_[i]) / gap, v = 1 - u;
  return v * v * ((1 + 2 * u) * ways_[i] + u * gap * speeds_[i]) +
         u * u * ((1 + 2 * v) * ways_[i + 1] - v * gap * speeds_[i + 1]);
}

CameraPath::View CameraPath::view_at(double knot) const {
  // The interval [i, i + 1] that the knot lies in, of the given views.
  const auto above = std::upper_bound(knots_.begin() + 2, knots_.end() - 2, knot);
  const auto i = static_cast<std::size_t>(above - knots_.begin()) - 1;
  const auto between = [&](const View& a, const View& b, std::size_t from, std::size_t to) {
    return mixed(a, b, (knot - knots_[from]) / (knots_[to] - knots_[from]));
  };
  // The pyramid of Barry and Goldman over views i - 1 … i + 2.
  const View a = between(views_[i - 1], views_[i], i - 1, i);
  const View b = between(views_[i], views_[i + 1], i, i + 1);
  const View c = between(views_[i + 1], views_[i + 2], i + 1, i + 2);
  return between(between(a, b, i - 1, i + 1), between(b, c, i, i + 2), i, i + 1);
}

Camera CameraPath::camera_of(const View& view) const {
  Camera camera = like_;
  camera.focal_point = {view.focus[0], view.focus[1], view.focus[2]};
  camera.position = camera.focal_point + turned(view.turn, {0, 0, 1}) * std::exp(view.lengths[0]);
  camera.up = turned(view.turn, {0, 1, 0});
  const double extent = std::exp(view.lengths[1]);
  if (camera.projection == Projection::perspective) {
    camera.vertical_angle = std::min(extent, 179.0);
  } else {
    camera.parallel_scale = extent;
  }
  return camera;
}

Camera CameraPath::at(double seconds) const {
  if (views_.size() == 1) return like_;
  const double way = way_at(seconds);
  const auto above = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, way);
  const auto i = static_cast<std::size_t>(above - lengths_.begin());
  const double part = lengths_[i] - lengths_[i - 1];
  const double share = part > 0 ? std::clamp((way - lengths_[i - 1]) / part, 0.0, 1.0) : 0;
  return camera_of(view_at(places_[i - 1] + share * (places_[i] - places_[i - 1])));
}

}  // namespace pellucid
