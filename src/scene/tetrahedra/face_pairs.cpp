// SPDX-License-Identifier: Apache-2.0
#include "face_pairs.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>

namespace pellucid {
namespace {

/// A face in the bucket of its smallest point.
struct Face {
  std::uint64_t others;  ///< the two other points, the smaller one first
  std::int32_t code;     ///< 4 · tetrahedron + face
};

/// Corners of each face: that of the smallest point, and the two others.
constexpr std::array<std::array<int, 3>, 4> corners_of_face{
    {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};

}  // namespace

std::int32_t pair_faces(std::vector<Tetrahedron>& tetrahedra, std::size_t points,
                        const ParallelFor& parallel) {
  // Tetrahedra have three faces with their first point, and one with the second as the smallest.
  std::vector<std::size_t> end(points + 1, 0);
  for (const Tetrahedron& t : tetrahedra) {
    end[static_cast<std::size_t>(t[0])] += 3;
    end[static_cast<std::size_t>(t[1])] += 1;
  }
  std::size_t sum = 0;
  for (std::size_t& e : end) e = sum += e;
  std::vector<Face> faces(sum);
  for (std::size_t i = tetrahedra.size(); i-- > 0;) {
    const Tetrahedron& t = tetrahedra[i];
    for (int f = 3; f >= 0; --f) {
      const auto& corner = corners_of_face[static_cast<std::size_t>(f)];
      const auto middle = static_cast<std::uint64_t>(static_cast<std::uint32_t>(t[corner[1]]));
      const auto last = static_cast<std::uint64_t>(static_cast<std::uint32_t>(t[corner[2]]));
      faces[--end[static_cast<std::size_t>(t[corner[0]])]] = {middle << 32 | last,
                                                              static_cast<std::int32_t>(4 * i) + f};
    }
  }
  // Now end[p] is where the bucket of p begins.
  std::atomic<std::int32_t> crowded{-1};
  parallel(static_cast<int>(points), [&](int first_point, int last_point) {
    const auto set = [&](std::int32_t code, std::int32_t behind) {
      tetrahedra[static_cast<std::size_t>(code >> 2)].neighbor[code & 3] = behind;
    };
    for (auto p = static_cast<std::size_t>(first_point); p < static_cast<std::size_t>(last_point);
         ++p) {
      Face* const bucket_end = faces.data() + end[p + 1];
      Face* face = faces.data() + end[p];
      std::sort(face, bucket_end, [](const Face& a, const Face& b) {
        return a.others != b.others ? a.others < b.others : a.code < b.code;
      });
      while (face != bucket_end) {
        Face* next = face + 1;
        while (next != bucket_end && next->others == face->others) ++next;
        const auto same_corners = [&] {
          return std::ranges::equal(tetrahedra[static_cast<std::size_t>(face[0].code >> 2)].corner,
                                    tetrahedra[static_cast<std::size_t>(face[1].code >> 2)].corner);
        };
        if (next - face == 2 && same_corners()) {
          crowded = face->code >> 2;
        } else if (next - face == 2) {
          set(face[0].code, face[1].code);
          set(face[1].code, face[0].code);
        } else if (next - face > 2) {
          crowded = face->code >> 2;
        }
        face = next;
      }
    }
  });
  return crowded;
}

}  // namespace pellucid
