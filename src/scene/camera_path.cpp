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

/// Adds what the eye moves by turns, by the focal point and by nearing, and what zooms are like.
double CameraPath::distance_between(const View& a, const View& b) {
  const double eye = std::exp((a.lengths[0] + b.lengths[0]) / 2);
  const double angle = 2 * std::acos(std::min(1.0, std::abs(dot(a.turn, b.turn))));
  double focus = 0;
  for (std::size_t i = 0; i < 3; ++i) focus = std::hypot(focus, a.focus[i] - b.focus[i]);
  return eye * (angle + std::abs(a.lengths[0] - b.lengths[0]) +
                std::abs(a.lengths[1] - b.lengths[1])) +
         focus;
}

CameraPath::CameraPath(const std::vector<CameraKey>& keys, double seconds, bool is_closed) {
  if (keys.empty()) throw Error("camera path: has no camera");
  like_ = keys.front().camera;
  const bool is_timed = keys.front().at.has_value();
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
    if (is_timed && i > 0 && !(*key.at > *keys[i - 1].at)) {
      fail("is not later than the one before");
    }
    if (key.camera.projection != like_.projection) {
      fail("has another projection than the first; give all of them the same");
    }
    View view = view_of(key.camera);
    if (!views_.empty() && dot(view.turn, views_.back().turn) < 0) view.turn = negative(view.turn);
    if (!is_timed && !views_.empty() && !(distance_between(view, views_.back()) > 0)) continue;
    views_.push_back(view);
    if (is_timed) knots_.push_back(*key.at);
  }
  const auto append_first = [&] {
    View first = views_.front();
    if (dot(first.turn, views_.back().turn) < 0) first.turn = negative(first.turn);
    if (!is_timed && !(distance_between(first, views_.back()) > 0)) return;
    if (is_timed && !(seconds > knots_.back())) {
      throw Error(
          "camera path: is closed, but its last camera is at the end; give it a time before");
    }
    views_.push_back(first);
    if (is_timed) knots_.push_back(seconds);
  };
  if (is_closed && views_.size() > 1) append_first();
  if (!is_timed) {
    // Centripetal knots bend least between views that are unevenly far apart (Yuksel 2011).
    knots_.push_back(0);
    for (std::size_t i = 1; i < views_.size(); ++i) {
      knots_.push_back(knots_.back() + std::sqrt(distance_between(views_[i], views_[i - 1])));
    }
  }
  const std::size_t count = views_.size();
  if (count == 1) return;
  // The next one beyond either end: of a closed path that which follows, else a mirrored one.
  const auto last_gap = knots_[count - 1] - knots_[count - 2], first_gap = knots_[1] - knots_[0];
  View before = mixed(views_[1], views_[0], 2);
  View after = mixed(views_[count - 2], views_[count - 1], 2);
  double before_gap = first_gap, after_gap = last_gap;
  if (is_closed && count > 2) {
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
  if (!is_timed) measure(seconds);
}

/// Notes at which moment a path at constant speed is at which knot.
void CameraPath::measure(double seconds) {
  constexpr int parts = 64;  // between two cameras
  moments_ = {0};
  places_ = {knots_[1]};
  View last = view_at(knots_[1]);
  for (std::size_t i = 1; i + 2 < knots_.size(); ++i) {
    for (int k = 1; k <= parts; ++k) {
      const double knot = knots_[i] + (knots_[i + 1] - knots_[i]) * k / parts;
      const View next = view_at(knot);
      moments_.push_back(moments_.back() + distance_between(last, next));
      places_.push_back(knot);
      last = next;
    }
  }
  const double all = moments_.back();
  for (double& moment : moments_) moment *= seconds / all;
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
  double knot = seconds;
  if (!moments_.empty()) {
    const auto above = std::upper_bound(moments_.begin() + 1, moments_.end() - 1, seconds);
    const auto i = static_cast<std::size_t>(above - moments_.begin());
    const double share = (seconds - moments_[i - 1]) / (moments_[i] - moments_[i - 1]);
    knot = places_[i - 1] + std::clamp(share, 0.0, 1.0) * (places_[i] - places_[i - 1]);
  }
  return camera_of(view_at(std::clamp(knot, knots_[1], knots_[knots_.size() - 2])));
}

}  // namespace pellucid
