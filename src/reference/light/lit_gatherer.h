// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "grid/piece.h"
#include "lit_part.h"
#include "surface_hits.h"

namespace pellucid::reference {

/// Gathers layers and surfaces from front to back. Parts are halved until the halves agree with
/// the whole to 1e-12.
class LitGatherer {
 public:
  explicit LitGatherer(bool with_depth) : with_depth_(with_depth) {}

  /// Adds layers along the same part of the ray, [t_begin, t_begin + length].
  void add(const std::vector<LitPart>& layers, Real t_begin, Real length);
  void add(const SurfaceHit& surface);
  bool done() const { return gatherer_.done(); }
  ReferencePixel result() const;

 private:
  struct Panel {
    std::vector<LitPart> layers;
    Real t_begin, length;
    MixtureSamples samples;
  };
  /// Part that was added, for the search of the half-opacity depth.
  struct Mark {
    MixtureSamples samples;
    Real t_begin, length;  ///< a surface has no length
    double before, after;  ///< optical depth in front and behind
  };

  static std::pair<Panel, Panel> halves(const Panel& panel);
  bool agree(const Panel& whole, const Panel& front, const Panel& back) const;
  void add(const Panel& panel, int halvings);
  void add_whole(const Panel& panel);

  bool with_depth_;
  Gatherer gatherer_;
  std::vector<Mark> marks_;
};

}  // namespace pellucid::reference
