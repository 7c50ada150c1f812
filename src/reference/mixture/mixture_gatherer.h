// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "grid/piece.h"
#include "mixture_part.h"

namespace pellucid::reference {

/// Gathers parts from front to back, halved until the rule sees all that is in them.
class MixtureGatherer {
 public:
  explicit MixtureGatherer(bool with_depth) : with_depth_(with_depth) {}

  void add(const MixturePart& part);
  bool done() const { return gatherer_.done(); }
  ReferencePixel result() const;

 private:
  /// A part that was added, for the search of the half-opacity depth.
  struct Mark {
    MixtureSamples samples;
    Real t_begin, length;
    double before;  ///< optical depth at the front
  };

  /// Adds a part by the rule; false where it does not see enough.
  bool add_whole(const MixturePart& part, bool is_smooth);

  bool with_depth_;
  Gatherer gatherer_;
  std::vector<Mark> marks_;
};

}  // namespace pellucid::reference
