// SPDX-License-Identifier: Apache-2.0
#include "cropping.h"

#include <bitset>
#include <string>

#include "pellucid/scene/error.h"

namespace pellucid::vtk_scene {
namespace {

using Regions = std::bitset<27>;

std::size_t number(int x, int y, int z) {
  const int place = x + 3 * y + 9 * z;
  return static_cast<std::size_t>(place);
}

template <class Visit>
bool all_of(const CroppedBox& box, const Visit& visit) {
  for (int z = box.first[2]; z <= box.last[2]; ++z) {
    for (int y = box.first[1]; y <= box.last[1]; ++y) {
      for (int x = box.first[0]; x <= box.last[0]; ++x) {
        if (!visit(number(x, y, z))) return false;
      }
    }
  }
  return true;
}

/// Returns the largest box from a region on, along x, then y, then z.
CroppedBox grown(const Regions& left, int x, int y, int z) {
  CroppedBox box{{x, y, z}, {x, y, z}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    while (box.last[axis] < 2) {
      CroppedBox wider = box;
      ++wider.last[axis];
      if (!all_of(wider, [&](std::size_t n) { return left.test(n); })) break;
      box = wider;
    }
  }
  return box;
}

}  // namespace

std::vector<CroppedBox> boxes_of(int flags) {
  Regions left(static_cast<unsigned long long>(flags));
  std::vector<CroppedBox> boxes;
  for (int z = 0; z < 3; ++z) {
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 3; ++x) {
        if (!left.test(number(x, y, z))) continue;
        boxes.push_back(grown(left, x, y, z));
        all_of(boxes.back(), [&](std::size_t n) {
          left.reset(n);
          return true;
        });
      }
    }
  }
  return boxes;
}

std::vector<Clip> clips_of(const CroppedBox& box, const std::array<double, 6>& planes,
                           const Affine<double>& world_from_data) {
  std::vector<Clip> clips;
  const auto add = [&](std::size_t axis, double place, double side) {
    const int a = static_cast<int>(axis);
    Vec3<double> point{0, 0, 0}, normal{0, 0, 0};
    point[a] = place;
    normal[a] = side;
    clips.push_back({placed_plane({point, normal}, world_from_data)});
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (box.first[axis] > 0) {
      add(axis, planes[2 * axis + static_cast<std::size_t>(box.first[axis]) - 1], 1);
    }
    if (box.last[axis] < 2) {
      add(axis, planes[2 * axis + static_cast<std::size_t>(box.last[axis])], -1);
    }
  }
  return clips;
}

ClipPlane placed_plane(const Plane& plane, const Affine<double>& world_from_data) {
  const Mat3<double> back = inverse(world_from_data.matrix);
  return {world_from_data.point(plane.origin),
          {dot(back.column[0], plane.normal), dot(back.column[1], plane.normal),
           dot(back.column[2], plane.normal)}};
}

std::vector<Clip> clips_of(const std::vector<Plane>& planes, Notes& notes) {
  std::vector<Clip> clips;
  for (const Plane& plane : planes) {
    const Clip clip{ClipPlane{plane.origin, plane.normal}};
    try {
      check_clip(clip, "clipping plane");
      clips.push_back(clip);
    } catch (const Error& error) {
      notes.add(std::string(error.what()) + "; the plane is left out");
    }
  }
  return clips;
}

}  // namespace pellucid::vtk_scene
