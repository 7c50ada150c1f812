// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "pellucid/cpu/ray_region.h"
#include "pellucid/render/ray_result.h"
#include "pellucid/scene/image.h"
#include "pellucid/scene/image_view.h"
#include "pellucid/scene/scene.h"
#include "pellucid/simd/instruction_set.h"

namespace pellucid {

/// Way in which packets of rays traverse Gaussians: in steps that resolve their variation along the
/// ray, or cell by cell.
enum class GaussianMarch { steps, cells };

/// Processor that follows the rays.
enum class Device {
  cpu,
  cuda,     ///< a card of NVIDIA
  emulated  ///< the card's functions, ray by ray, on this machine's threads: for tests
};
/// Returns "cpu", "cuda" or "emulated".
std::string_view device_name(Device device) noexcept;

/// Pixels of a frame that are rendered together: (column + i·stride, row + j·stride) for 0 <= i <
/// columns, 0 <= j < rows.
struct Tile {
  int column = 0, row = 0;
  int columns = 0, rows = 0;
  int stride = 1;
  int level = 0;  ///< level of the preview; 0 is the finest
};

/// A finished tile and the picture that contains it. Until finer tiles are finished, a pixel of
/// level n represents the 2ⁿ × 2ⁿ pixels of which it is the upper left.
struct TileResult {
  const Tile& tile;
  const ImageView& image;
};

/// Upper limit of FrameMonitor::preview.
inline constexpr int largest_preview = 8;

/// Outputs of a frame beside the color of each pixel.
struct FrameOutputs {
  bool depth = false;  ///< fill Image::depth; projections have none
  bool error = false;  ///< fill Image::error and Image::proved
  /// Fill Image::values. render() throws Error unless exactly one visible layer is projected and a
  /// pixel has one ray.
  bool values = false;
  /// Keeps to a part of the world; none: all of it. The image then has what the rays gather there,
  /// to be composited with the other parts: nothing of the backdrop but the ends of rays, no error
  /// of the functions' approximation, and the depth of half of the part's own opacity. render()
  /// throws Error if a pixel has several rays, a layer is projected, or the method is not `exact`.
  std::shared_ptr<const RayRegion> region{};
};

/// The processors that a frame may use. The image does not depend on the number of threads.
struct Machine {
  int threads = 0;  ///< 0: one per core
  /// Processor that follows the rays. What a card cannot do yet is done by the CPU
  /// (RenderReport::device). render() throws Error if there is no card, no driver, or no part of
  /// the library for it.
  Device device = Device::cpu;
  /// Instruction set for packets of rays; none: the fastest that the machine has. render() throws
  /// Error if the machine lacks it.
  std::optional<InstructionSet> instruction_set{};
  /// Method for packets through Gaussians where both are possible; none: the one expected to be
  /// faster.
  std::optional<GaussianMarch> gaussian_march{};
};

/// Progress of a frame: whom it tells, and by what it is cancelled.
struct FrameMonitor {
  /// Receives the finished fraction in [0, 1] now and then, from one thread at a time. If it
  /// returns false, the frame is cancelled and render() throws Cancelled.
  std::function<bool(double)> progress{};
  /// Cancels the frame, from any thread: threads stop within some 5 ms of work, and render() throws
  /// Cancelled.
  std::stop_token stop{};
  /// Number of preview levels: every 2ⁿ-th pixel along each axis is rendered first, then the pixels
  /// half-way between them, and so on. No pixel is rendered twice; the image is bitwise the same.
  int preview = 0;
  /// Receives each tile once, from one thread at a time and never during `progress`. The tiles of a
  /// level follow all tiles of the coarser level. No thread waits for the call. If it returns
  /// false, the frame is cancelled as above; other threads finish their current tiles.
  std::function<bool(const TileResult&)> tile{};
};

/// Options of a frame: what it computes, on which processors, and how it is watched.
struct RenderOptions {
  FrameOutputs outputs{};
  Machine machine{};
  FrameMonitor monitor{};
};

/// Statistics of a rendered frame.
struct RenderReport {
  double seconds = 0;
  double setup_seconds = 0;  ///< part of `seconds` until the first ray
  int threads = 0;
  /// Account of the work done by each processor, in words, if Machine::device is not the CPU; else
  /// empty.
  std::string device;
  std::uint64_t rays = 0;         ///< traced rays
  std::uint64_t cells = 0;        ///< cells visited (exact) or samples taken (the others)
  bool sampled_in_float = false;  ///< true if whole rays were sampled in packets, in binary32

  // The following members are set by the exact method only.
  double largest_error = 0;                 ///< largest error bound or estimate of any pixel
  std::uint64_t pixels = 0;                 ///< in the image
  std::uint64_t pixels_proved = 0;          ///< with a proved error bound
  std::uint64_t pixels_interpolated = 0;    ///< interpolated from traced neighbors
  std::uint64_t pixels_over_tolerance = 0;  ///< with an error above the tolerance
  std::uint64_t evaluations = 0;            ///< cells gathered and points sampled
  RuleCounts spans;                         ///< number of spans by rule
  // And by devices only:
  std::uint64_t pixels_in_double = 0;  ///< that were followed again, for want of digits in binary32
  std::uint64_t pixels_left = 0;       ///< that the device left to the CPU
};

/// A frame and how it was made.
struct RenderResult {
  Image image;
  RenderReport report;
};

/// Thrown by render() if a callback returned false or FrameMonitor::stop was requested.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("rendering was cancelled") {}
};

/// Renders the scene with its own method and precision: one frame of a new Renderer
/// (pellucid/cpu/renderer.h). The image is bitwise the same for any number of threads. Throws Error
/// if `scene` fails its checks (camera, sizes, step), and Cancelled.
RenderResult render(const Scene& scene, const RenderOptions& options = {});
/// Renders the same into memory of the caller, which has the size of the scene's picture. Outputs
/// beside the color are those for which `target` has memory; of options.outputs only the region
/// counts. Throws as render() does, which leaves the memory as far as the frame had come, and Error
/// if the size is another or there is no memory for the color.
RenderReport render_into(const ImageView& target, const Scene& scene,
                         const RenderOptions& options = {});

}  // namespace pellucid
