// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "pellucid/cpu/render.h"

namespace pellucid {

class SetupCache;

/// A pixel of a region's frame, and how many times the scene's tolerance it may be off by.
struct PixelRequest {
  int column = 0, row = 0;
  double allowance = 1;
};

/// A frame that is being rendered by threads of its own. The handle can be moved; its destructor
/// cancels the frame and waits for its threads. All members are safe to call from any thread, but
/// for wait(), moves and the destructor, which are for the owner, and not for callbacks of the
/// frame itself. A handle that was moved from may only be assigned to or destroyed.
class RunningFrame {
 public:
  RunningFrame(RunningFrame&&) noexcept;
  RunningFrame& operator=(RunningFrame&&) noexcept;
  ~RunningFrame();

  /// Asks the threads to stop, and returns at once. They stop within some 5 ms of work; a set-up
  /// that has begun (RenderReport::setup_seconds) is finished first.
  void cancel() noexcept;
  /// Returns whether the threads are done: with the image, or because of an error or cancel().
  bool finished() const noexcept;

  /// Progress of the frame.
  struct State {
    double fraction = 0;  ///< share of the pixels that are final
    /// The finest level of FrameMonitor::preview that is complete; -1: none is yet. Level n has
    /// every 2ⁿ-th pixel along each axis; 0 is the image.
    int level = -1;
    bool finished = false;
  };
  State state() const;
  /// Returns what is known of the image: a pixel that is not rendered yet has the color of its
  /// nearest coarser one, or nothing. Without depth, error and metadata.
  Image look() const;

  /// Waits for the threads and returns the image and its report. Throws Error if the scene failed
  /// its checks, and Cancelled. Only the first call returns the image; look() has none then.
  RenderResult wait();

 private:
  friend class Renderer;
  struct Job;
  explicit RunningFrame(std::unique_ptr<Job> job);

  std::unique_ptr<Job> job_;
};

/// A frame that the caller's thread renders bit by bit between other work of its own, and other
/// threads with it while it does: for a program whose one thread also answers its user. The handle
/// can be moved; one that was moved from may only be assigned to or destroyed.
class SteppedFrame {
 public:
  SteppedFrame(SteppedFrame&&) noexcept;
  SteppedFrame& operator=(SteppedFrame&&) noexcept;
  ~SteppedFrame();

  /// Goes on for some `seconds`, and until the tiles that are begun by then are done; the first
  /// call makes the set-up, however long it takes. Returns whether the frame is done. Throws Error
  /// if `seconds` is negative or NaN, and Cancelled, after which the frame may not go on.
  bool advance(double seconds);
  /// Returns the image and its report, whose seconds are those of the calls. Only the first call
  /// returns the image. Throws Error unless the frame is done.
  RenderResult take();

 private:
  friend class Renderer;
  struct Job;
  explicit SteppedFrame(std::unique_ptr<Job> job);

  std::unique_ptr<Job> job_;
};

/// Renders frame after frame, and keeps what they share: the blocks' classes, tables and packets'
/// set-up of each layer, found by the identity of its data and functions (the shared objects, not
/// their contents). A camera that moves costs no set-up; a new transfer function costs its own.
/// What a frame's scene does not have is let go of. The records of blocks stay with the volumes.
///
/// Nothing is global: renderers do not know of each other. Safe to use from any thread; frames that
/// run at the same time share the cores.
class Renderer {
 public:
  /// Makes a renderer that keeps nothing yet. `threads`: of frames whose options name none; 0: one
  /// per core. Throws Error if it is negative.
  explicit Renderer(int threads = 0);
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;
  ~Renderer();

  /// Renders a frame on this thread and others, as pellucid::render() does.
  RenderResult render(const Scene& scene, const RenderOptions& options = {});
  /// Renders the same into memory of the caller, as pellucid::render_into() does.
  RenderReport render_into(const ImageView& target, const Scene& scene,
                           const RenderOptions& options = {});
  /// Renders some pixels of a frame of a region (FrameOutputs::region) again, each to a tolerance
  /// of its own in place of the region's allowance. Returns an image of one row with a pixel for
  /// each request, with errors, and a report of the work. Uses of the options the threads, the
  /// region, the progress and the stop token. Throws Error unless there is a region, and as
  /// render() does.
  RenderResult render_pixels(const Scene& scene, const RenderOptions& options,
                             const std::vector<PixelRequest>& requests);
  /// Starts a frame and returns at once. The frame may outlive the renderer. Callbacks of the
  /// options are called by the frame's threads.
  RunningFrame start(Scene scene, RenderOptions options = {});
  /// Begins a frame that advance() renders; its image is bitwise that of render(). Throws Error if
  /// `scene` fails its checks.
  SteppedFrame begin(Scene scene, RenderOptions options = {});
  /// Lets go of all that is kept.
  void clear();

 private:
  std::shared_ptr<SetupCache> kept_;
};

}  // namespace pellucid
