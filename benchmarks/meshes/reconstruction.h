// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pellucid::bench {

/// How far two exact pictures of one field are apart: trilinear on its grid, and linear in the
/// tetrahedra that the grid is cut into. Over all pixels, channels of premultiplied RGBA.
struct ReconstructionResult {
  std::string data, transfer_function;
  double largest = 0, rms = 0;
  double share_over = 0;  ///< of the pixels, that differ by more than 1/512
};

struct ReconstructionOptions {
  int size = 256;
  bool tiny = false;
  std::function<void(const std::string&)> say;
};

/// The field of Marschner and Lobb on 41³ points, a part of the brain and the hydrogen atom (where
/// their files are), behind a ramp and behind a peak of a hundredth of the range, obliquely.
std::vector<ReconstructionResult> study_reconstruction(const ReconstructionOptions& options);

}  // namespace pellucid::bench
