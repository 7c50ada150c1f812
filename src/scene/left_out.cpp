// SPDX-License-Identifier: Apache-2.0
//
// Stands in for the sources that builds for a first picture leave out (PELLUCID_FIRST_PICTURE).
#include "pellucid/scene/internal/left_out.h"

#include "pellucid/scene/derived_channels.h"

namespace pellucid {

Volume gradient_magnitude(const Volume&, const ParallelFor&) {
  throw left_out("what derives channels");
}

Volume second_derivative(const Volume&, const ParallelFor&) {
  throw left_out("what derives channels");
}

Volume smoothed(const Volume&, double, const ParallelFor&) {
  throw left_out("what smooths channels");
}

}  // namespace pellucid
