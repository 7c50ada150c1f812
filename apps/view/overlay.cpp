// SPDX-License-Identifier: Apache-2.0
#include "overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "camera_moves.h"
#include "pellucid/scene/error.h"

namespace pellucid::view {

namespace {

struct Segment {
  Vec3<double> from, to;
};
struct Handle {
  std::string name;
  Vec3<double> position;
};
/// The outline of a clip and its handles, in the world.
struct Shape {
  std::vector<Segment> lines;
  std::vector<Handle> handles;
};

/// Extent of the data: the middle and half of the diagonal of a box around them.
struct InterpolationInfo {
  Vec3<double> middle{};
  double radius = 0;
};

InterpolationInfo surroundings_of(const Scene& scene) {
  const std::array<Vec3<double>, 8> corners = world_corners(scene);
  InterpolationInfo result;
  for (const Vec3<double>& corner : corners) result.middle = result.middle + corner * 0.125;
  for (const Vec3<double>& corner : corners) {
    result.radius = std::max(result.radius, length(corner - result.middle));
  }
  return result;
}

/// Two directions across `normal` and across each other, of length 1.
std::pair<Vec3<double>, Vec3<double>> across(const Vec3<double>& normal) {
  const Vec3<double> other =
      std::abs(normal.z) < 0.9 ? Vec3<double>{0, 0, 1} : Vec3<double>{1, 0, 0};
  const Vec3<double> first = normalized(cross(normal, other));
  return {first, cross(normal, first)};
}

void add_circle(const Vec3<double>& middle, const Vec3<double>& normal, double radius,
                Shape& shape) {
  const auto [right, up] = across(normal);
  constexpr int corners = 48;
  const auto corner = [&, right = right, up = up](int i) {
    const double angle = i * 2 * std::numbers::pi / corners;
    return middle + right * (radius * std::cos(angle)) + up * (radius * std::sin(angle));
  };
  for (int i = 0; i < corners; ++i) shape.lines.push_back({corner(i), corner(i + 1)});
}

/// Returns the point of the plane that is nearest to the middle of the data.
Vec3<double> plane_middle(const ClipPlane& plane, const InterpolationInfo& around) {
  const Vec3<double> normal = normalized(plane.normal);
  return around.middle - normal * dot(around.middle - plane.point, normal);
}

Shape shape_of(const ClipPlane& plane, const InterpolationInfo& around) {
  const Vec3<double> normal = normalized(plane.normal), middle = plane_middle(plane, around);
  const auto [right, up] = across(normal);
  const double size = 0.6 * around.radius;
  const std::array corners{middle + (right + up) * size, middle + (right - up) * size,
                           middle - (right + up) * size, middle - (right - up) * size};
  Shape shape;
  for (std::size_t i = 0; i < 4; ++i) shape.lines.push_back({corners[i], corners[(i + 1) % 4]});
  const Vec3<double> tip = middle + normal * (0.35 * around.radius);
  shape.lines.push_back({middle, tip});
  shape.handles = {{"point", middle}, {"normal", tip}};
  return shape;
}

Shape shape_of(const ClipBox& box, const InterpolationInfo&) {
  const auto corner = [&](int bits) {
    return Vec3<double>{(bits & 1) != 0 ? box.upper.x : box.lower.x,
                        (bits & 2) != 0 ? box.upper.y : box.lower.y,
                        (bits & 4) != 0 ? box.upper.z : box.lower.z};
  };
  Shape shape;
  for (int bits = 0; bits < 8; ++bits) {
    for (const int axis : {1, 2, 4}) {
      if ((bits & axis) == 0) shape.lines.push_back({corner(bits), corner(bits | axis)});
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      Vec3<double> face = (box.lower + box.upper) * 0.5;
      face[axis] = upper ? box.upper[axis] : box.lower[axis];
      shape.handles.push_back({fmt::format("{}{}", "xyz"[axis], upper ? 1 : 0), face});
    }
  }
  return shape;
}

Shape shape_of(const ClipSphere& sphere, const InterpolationInfo&) {
  Shape shape;
  for (const Vec3<double>& axis :
       {Vec3<double>{1, 0, 0}, Vec3<double>{0, 1, 0}, Vec3<double>{0, 0, 1}}) {
    add_circle(sphere.center, axis, sphere.radius, shape);
  }
  shape.handles = {{"point", sphere.center},
                   {"radius", sphere.center + Vec3<double>{sphere.radius, 0, 0}}};
  return shape;
}

Shape shape_of(const ClipCylinder& cylinder, const InterpolationInfo&) {
  const Vec3<double> axis = normalized(cylinder.end - cylinder.start);
  const Vec3<double> right = across(axis).first, middle = (cylinder.start + cylinder.end) * 0.5;
  Shape shape;
  add_circle(cylinder.start, axis, cylinder.radius, shape);
  add_circle(cylinder.end, axis, cylinder.radius, shape);
  shape.lines.push_back({cylinder.start, cylinder.end});
  shape.handles = {{"point", middle}, {"radius", middle + right * cylinder.radius}};
  return shape;
}

Json shape_json(const Shape& shape, const PictureMap& map) {
  Json lines = Json::array(), handles = Json::array();
  for (const Segment& line : shape.lines) {
    const auto from = map(line.from), to = map(line.to);
    if (from && to) lines.push_back({from->x, from->y, to->x, to->y});
  }
  for (const Handle& handle : shape.handles) {
    const auto at = map(handle.position);
    if (at) handles.push_back({{"name", handle.name}, {"x", at->x}, {"y", at->y}});
  }
  return {{"lines", std::move(lines)}, {"handles", std::move(handles)}};
}

/// Returns how far a position moves along `direction` (length 1) if its picture follows the drag as
/// well as it can. A direction towards the eye moves no faster than at an angle of some 15 degrees.
double distance_along(const PictureMap& map, const Scene& scene, const Vec3<double>& direction,
                      const DragHandle& drag) {
  const Vec3<double> seen = map.direction(direction);
  const double across_picture = std::max(seen.x * seen.x + seen.y * seen.y, 0.07);
  const double height = height_at_focal_point(scene.camera);
  return (drag.x * seen.x + drag.y * seen.y) * height / across_picture;
}

/// Returns the world vector across the view that follows the drag.
Vec3<double> distance_across(const Scene& scene, const DragHandle& drag) {
  Camera moved = scene.camera;
  pan(moved, -drag.x, -drag.y);
  return moved.focal_point - scene.camera.focal_point;
}

[[noreturn]] void refuse(const DragHandle& drag) {
  throw Error(fmt::format("clip {} has no such handle", drag.clip + 1));
}

void drag_shape(ClipPlane& plane, const Scene& scene, const PictureMap& map,
                const DragHandle& drag) {
  const Vec3<double> normal = normalized(plane.normal);
  const Vec3<double> middle = plane_middle(plane, surroundings_of(scene));
  if (drag.handle == "point") {
    plane.point = middle + normal * distance_along(map, scene, normal, drag);
  } else if (drag.handle == "normal") {
    // The tip of the normal follows the mouse.
    const double size = 0.35 * surroundings_of(scene).radius;
    plane.normal = normalized(normal * size + distance_across(scene, drag));
    plane.point = middle;
  } else {
    refuse(drag);
  }
}

void drag_shape(ClipBox& box, const Scene& scene, const PictureMap& map, const DragHandle& drag) {
  const std::string axes = "xyz";
  const std::size_t axis = drag.handle.size() == 2 ? axes.find(drag.handle[0]) : axes.npos;
  if (axis == axes.npos || (drag.handle[1] != '0' && drag.handle[1] != '1')) refuse(drag);
  const int a = static_cast<int>(axis);
  Vec3<double> direction{};
  direction[a] = 1;
  const double moved = distance_along(map, scene, direction, drag);
  const double thinnest = 1e-4 * surroundings_of(scene).radius;
  if (drag.handle[1] == '0') {
    box.lower[a] = std::min(box.lower[a] + moved, box.upper[a] - thinnest);
  } else {
    box.upper[a] = std::max(box.upper[a] + moved, box.lower[a] + thinnest);
  }
}

/// A radius grows as its handle leaves the centre.
double dragged_radius(double radius, const Vec3<double>& direction, const Scene& scene,
                      const PictureMap& map, const DragHandle& drag) {
  return std::max(radius + distance_along(map, scene, direction, drag),
                  1e-4 * surroundings_of(scene).radius);
}

void drag_shape(ClipSphere& sphere, const Scene& scene, const PictureMap& map,
                const DragHandle& drag) {
  if (drag.handle == "point") {
    sphere.center = sphere.center + distance_across(scene, drag);
  } else if (drag.handle == "radius") {
    sphere.radius = dragged_radius(sphere.radius, {1, 0, 0}, scene, map, drag);
  } else {
    refuse(drag);
  }
}

void drag_shape(ClipCylinder& cylinder, const Scene& scene, const PictureMap& map,
                const DragHandle& drag) {
  if (drag.handle == "point") {
    const Vec3<double> move = distance_across(scene, drag);
    cylinder.start = cylinder.start + move;
    cylinder.end = cylinder.end + move;
  } else if (drag.handle == "radius") {
    const Vec3<double> right = across(normalized(cylinder.end - cylinder.start)).first;
    cylinder.radius = dragged_radius(cylinder.radius, right, scene, map, drag);
  } else {
    refuse(drag);
  }
}

}  // namespace

PictureMap::PictureMap(const Scene& scene)
    : frame_(make_camera_frame(scene.camera, scene.size)),
      aspect_(static_cast<double>(scene.size.width) / scene.size.height) {
  const auto row_of = [&](const Vec3<double>& direction, double at_camera) {
    return std::array{direction.x, direction.y, direction.z,
                      at_camera - dot(direction, frame_.position)};
  };
  // At the camera w is 0, or 1 everywhere for parallel rays.
  const double w = frame_.perspective ? 0 : 1;
  const Vec3<double> forward = frame_.forward * (1 - w);
  const Vec3<double> right = frame_.right * (1 / dot(frame_.right, frame_.right));
  const Vec3<double> up = frame_.up * (1 / dot(frame_.up, frame_.up));
  matrix_ = {row_of((forward + right) * 0.5, w / 2), row_of((forward - up) * 0.5, w / 2),
             row_of(forward, w)};
}

std::optional<PicturePoint> PictureMap::operator()(const Vec3<double>& position) const {
  const auto times = [&](const std::array<double, 4>& row) {
    return row[0] * position.x + row[1] * position.y + row[2] * position.z + row[3];
  };
  const double w = times(matrix_[2]);
  if (!(w > 0)) return {};
  return PicturePoint{times(matrix_[0]) / w, times(matrix_[1]) / w};
}

Vec3<double> PictureMap::direction(const Vec3<double>& world) const {
  return {dot(world, normalized(frame_.right)), -dot(world, normalized(frame_.up)),
          dot(world, frame_.forward)};
}

Json overlay_json(const Scene& scene, const Lettering& lettering) {
  const PictureMap map(scene);
  constexpr const char* patient[3][2] = {{"L", "R"}, {"P", "A"}, {"S", "I"}};
  constexpr const char* world[3] = {"x", "y", "z"};
  Json axes = Json::array();
  for (int a = 0; a < 3; ++a) {
    Vec3<double> axis{};
    axis[a] = 1;
    const Vec3<double> seen = map.direction(axis);
    axes.push_back({{"plus", lettering.anatomical ? patient[a][0] : world[a]},
                    {"minus", lettering.anatomical ? patient[a][1] : ""},
                    {"x", seen.x},
                    {"y", seen.y},
                    {"z", seen.z}});
  }
  Json clips = Json::array();
  const InterpolationInfo around = surroundings_of(scene);
  for (const Clip& clip : scene.clips) {
    clips.push_back(std::visit(
        [&](const auto& shape) { return shape_json(shape_of(shape, around), map); }, clip.shape));
  }
  return {{"axes", std::move(axes)},
          {"height", height_at_focal_point(scene.camera)},
          {"unit", lettering.unit},
          {"matrix", map.matrix()},
          {"clips", std::move(clips)}};
}

std::vector<Clip> with_handle_dragged(const Scene& scene, const DragHandle& drag) {
  if (drag.clip >= scene.clips.size())
    throw Error(fmt::format("there is no clip {}", drag.clip + 1));
  std::vector<Clip> clips = scene.clips;
  const PictureMap map(scene);
  std::visit([&](auto& shape) { drag_shape(shape, scene, map, drag); }, clips[drag.clip].shape);
  return clips;
}

}  // namespace pellucid::view
