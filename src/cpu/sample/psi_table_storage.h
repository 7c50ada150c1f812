// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/segment/partial_preintegration.h"

namespace pellucid {

/// Owns a PsiTable. Not copied, for the view refers to it.
class PsiTableStorage {
 public:
  /// 1 MiB: what Moreland has.
  static constexpr int nodes = 512;

  PsiTableStorage();
  PsiTableStorage(const PsiTableStorage&) = delete;
  PsiTableStorage& operator=(const PsiTableStorage&) = delete;

  const PsiTable& view() const noexcept { return view_; }

 private:
  std::vector<float> psi_;
  PsiTable view_;
};

/// Returns the one table of the whole program, made when it is first asked for: it knows nothing of
/// the scene.
const PsiTable& psi_table();

}  // namespace pellucid
