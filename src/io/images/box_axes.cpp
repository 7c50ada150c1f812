// SPDX-License-Identifier: Apache-2.0
#include "box_axes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "pellucid/scene/internal/axis_ticks.h"

namespace pellucid {
namespace {

/// Points between ticks, and the shortest axis that is drawn.
constexpr double between_ticks = 22, shortest_axis = 16;

/// A corner of a box: of each axis the lower end or the upper one.
using Corner = std::array<bool, 3>;

Vec3<double> position_of(const FigureSpace& space, const Corner& corner) {
  return {corner[0] ? space.upper.x : space.lower.x, corner[1] ? space.upper.y : space.lower.y,
          corner[2] ? space.upper.z : space.lower.z};
}

/// Returns whether a face of the box is turned towards the eye.
bool is_visible(const FigureSpace& space, const CameraFrame<double>& frame, int axis, bool upper) {
  if (!frame.perspective) return upper ? frame.forward[axis] < 0 : frame.forward[axis] > 0;
  return upper ? frame.position[axis] > space.upper[axis]
               : frame.position[axis] < space.lower[axis];
}

PagePoint between(const PagePoint& a, const PagePoint& b) {
  return {(a.x + b.x) / 2, (a.y + b.y) / 2};
}

struct SeenEdge {
  Corner from{};  ///< its other end is at the upper end of the axis
  PagePoint start, end, outward;
};

class SeenBox {
 public:
  SeenBox(const FigureSpace& space, ImageSize size)
      : space_(space), frame_(make_camera_frame(space.camera, size)) {
    for (int n = 0; n < 8; ++n) {
      const auto seen = seen_at(frame_, position_of(space, {(n & 1) != 0, (n & 2) != 0, n > 3}));
      if (!seen) {
        is_whole_ = false;
        return;
      }
      middle_.x += seen->x / 8;
      middle_.y += seen->y / 8;
    }
  }

  bool is_whole() const { return is_whole_; }

  /// Returns the edges along an axis that lie in the silhouette.
  std::vector<SeenEdge> silhouette(int axis) const {
    const auto a = static_cast<std::size_t>(axis), b = (a + 1) % 3, c = (a + 2) % 3;
    std::vector<SeenEdge> edges;
    for (int n = 0; n < 4; ++n) {
      SeenEdge edge;
      edge.from[b] = (n & 1) != 0;
      edge.from[c] = (n & 2) != 0;
      const auto faces = [&](std::size_t across) {
        return is_visible(space_, frame_, static_cast<int>(across), edge.from[across]);
      };
      if (faces(b) == faces(c)) continue;
      Corner to = edge.from;
      to[a] = true;
      edge.start = *seen_at(frame_, position_of(space_, edge.from));
      edge.end = *seen_at(frame_, position_of(space_, to));
      const double dx = edge.end.x - edge.start.x, dy = edge.end.y - edge.start.y;
      const double long_as = std::hypot(dx, dy);
      if (!(long_as > 0)) continue;
      edge.outward = {-dy / long_as, dx / long_as};
      const PagePoint half = between(edge.start, edge.end);
      if ((half.x - middle_.x) * edge.outward.x + (half.y - middle_.y) * edge.outward.y < 0) {
        edge.outward = {-edge.outward.x, -edge.outward.y};
      }
      edges.push_back(edge);
    }
    return edges;
  }

  PagePoint at(const SeenEdge& edge, int axis, double share) const {
    Vec3<double> position = position_of(space_, edge.from);
    position[axis] = (1 - share) * space_.lower[axis] + share * space_.upper[axis];
    return *seen_at(frame_, position);
  }

 private:
  const FigureSpace& space_;
  CameraFrame<double> frame_;
  PagePoint middle_;
  bool is_whole_ = true;
};

/// Returns the title of an axis, with its ends in the order in which they are read.
std::string title_of(int axis, const DrawnAxis& seen, const FigureSpace& space) {
  auto ends = axis_ends(axis, space.is_anatomical);
  const bool is_forward = seen.is_steep() ? seen.from.y > seen.to.y : seen.from.x < seen.to.x;
  if (!is_forward && !ends[0].empty()) std::swap(ends[0], ends[1]);
  const std::string name = ends[0].empty() ? ends[1] : ends[0] + "\u2013" + ends[1];
  return space.unit.empty() ? name : name + " (" + space.unit + ")";
}

/// Returns round ticks, more than `most` if there are no two otherwise.
std::vector<Tick> round_ticks(double lower, double upper, int most) {
  std::vector<Tick> ticks = axis_ticks(lower, upper, most);
  const auto are_ends = [&] {
    return ticks.size() == 2 && ticks[0].label == short_number(lower) &&
           ticks[1].label == short_number(upper);
  };
  for (int more = most + 1; are_ends() && more < most + 4; ++more) {
    const std::vector<Tick> others = axis_ticks(lower, upper, more);
    if (others.size() > 2) ticks = others;
    if (others.size() == 2 && others[0].share > 0) ticks = others;
  }
  return ticks;
}

/// Returns the number with the sign that is as wide as a digit.
std::string with_minus(std::string number) {
  for (std::size_t at = number.find('-'); at != std::string::npos; at = number.find('-', at)) {
    number.replace(at, 1, "\u2212");
  }
  return number;
}

}  // namespace

std::optional<PagePoint> seen_at(const CameraFrame<double>& frame, const Vec3<double>& position) {
  const Vec3<double> offset = position - frame.position;
  double scale = 1;
  if (frame.perspective) {
    const double distance = dot(offset, frame.forward);
    if (!(distance > 0)) return std::nullopt;
    scale = 1 / distance;
  }
  const double x = scale * dot(offset, frame.right) / dot(frame.right, frame.right);
  const double y = scale * dot(offset, frame.up) / dot(frame.up, frame.up);
  return PagePoint{(1 + x) / 2 * frame.width, (1 - y) / 2 * frame.height};
}

double round_length(double most) {
  const double power = std::pow(10, std::floor(std::log10(most)));
  for (const double factor : {10.0, 5.0, 2.0}) {
    if (factor * power <= most * (1 + 1e-9)) return factor * power;
  }
  return power;
}

std::array<std::string, 2> axis_ends(int axis, bool is_anatomical) {
  constexpr const char* patient[3][2] = {{"R", "L"}, {"A", "P"}, {"I", "S"}};
  constexpr const char* world[3] = {"x", "y", "z"};
  if (is_anatomical) return {patient[axis][0], patient[axis][1]};
  return {"", world[axis]};
}

BoxAxes box_axes(const FigureSpace& space, ImageSize size, double points_per_pixel) {
  BoxAxes made;
  const SeenBox box(space, size);
  if (!box.is_whole()) return made;
  // Low edges, and of upright ones the left.
  const auto suits = [](const SeenEdge& edge) {
    return 0.94 * edge.outward.y - 0.35 * edge.outward.x;
  };
  for (int a = 0; a < 3; ++a) {
    std::vector<SeenEdge> edges = box.silhouette(a);
    if (edges.empty() || !(space.lower[a] < space.upper[a])) continue;
    const auto chosen = std::ranges::max_element(edges, {}, suits);
    const double long_as = points_per_pixel * std::hypot(chosen->end.x - chosen->start.x,
                                                         chosen->end.y - chosen->start.y);
    if (long_as >= shortest_axis) {
      DrawnAxis axis{"", chosen->start, chosen->end, chosen->outward, {}};
      axis.title = title_of(a, axis, space);
      const int most = std::max(2, static_cast<int>(long_as / between_ticks));
      for (const Tick& tick : round_ticks(space.lower[a], space.upper[a], most)) {
        axis.ticks.push_back({box.at(*chosen, a, tick.share), with_minus(tick.label)});
      }
      made.axes.push_back(std::move(axis));
      edges.erase(chosen);
    }
    for (const SeenEdge& edge : edges) made.outline.push_back({edge.start, edge.end});
  }
  return made;
}

}  // namespace pellucid
