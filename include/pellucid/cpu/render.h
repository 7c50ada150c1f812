// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "pellucid/render/ray_result.h"
#include "pellucid/scene/image.h"
#include "pellucid/scene/scene.h"
#include "pellucid/simd/instruction_set.h"

namespace pellucid {

/// How rays in packets go through Gaussians: in steps that resolve what these make of the data, or
/// cell by cell.
enum class GaussianMarch { steps, cells };

/// Some pixels of a frame that are rendered together: (column + i·stride, row + j·stride) for
/// 0 <= i < columns, 0 <= j < rows.
struct Tile {
  int column = 0, row = 0;
  int columns = 0, rows = 0;
  int stride = 1;
  int level = 0;  ///< of the preview; 0 is the finest
};

/// A tile whose pixels are final, in the image that is being made. Until finer ones are there, a
/// pixel of level n stands for the square of 2ⁿ × 2ⁿ pixels of which it is the upper left.
struct TileResult {
  const Tile& tile;
  const Image& image;
};

/// Limit of RenderOptions::preview.
inline constexpr int largest_preview = 8;

struct RenderOptions {
  int threads = 0;     ///< 0: one per core
  bool depth = false;  ///< fill Image::depth
  bool error = false;  ///< fill Image::error and Image::proved
  /// For rays in packets; none: the fastest that the machine has. Error where it has not this one.
  std::optional<InstructionSet> instruction_set;
  /// For those through Gaussians, where both can be; none: the one that is likely to be faster.
  std::optional<GaussianMarch> gaussian_march;
  /// Called now and then, from any one thread at a time, with the share done in [0, 1]; false
  /// cancels the frame, which then throws Cancelled.
  std::function<bool(double)> progress;

  // Of render() alone:
  /// Levels of a preview: every 2ⁿ-th pixel along each axis is rendered first, then those in the
  /// middle between them, and so on. No pixel is rendered twice; the image is bitwise the same.
  int preview = 0;
  /// Called once for each tile, from any one thread at a time and not while `progress` is; the
  /// tiles of a level after all of the coarser one. No thread waits for it. False cancels as above:
  /// the other threads finish the tiles that they are at.
  std::function<bool(const TileResult&)> tile;
};

struct RenderReport {
  double seconds = 0;
  int threads = 0;
  std::uint64_t rays = 0;   ///< that were traced
  std::uint64_t cells = 0;  ///< cells visited (exact) or samples taken (the others)

  // Of the exact method alone:
  double largest_error = 0;                 ///< of any pixel: largest bound or estimate
  std::uint64_t pixels = 0;                 ///< of the image
  std::uint64_t pixels_proved = 0;          ///< whose error is a proved bound
  std::uint64_t pixels_interpolated = 0;    ///< that were interpolated, not traced
  std::uint64_t pixels_over_tolerance = 0;  ///< whose error is above the tolerance
  std::uint64_t evaluations = 0;            ///< of the field: cells gathered and points sampled
  RuleCounts spans;                         ///< by rule
};

/// Thrown where the progress callback returned false.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("rendering was cancelled") {}
};

/// Renders the scene with its own method and precision. The image is bitwise the same for any
/// number of threads. Throws Error for what `scene` checks (camera, sizes, step).
Image render(const Scene& scene, const RenderOptions& options = {}, RenderReport* report = nullptr);

}  // namespace pellucid
