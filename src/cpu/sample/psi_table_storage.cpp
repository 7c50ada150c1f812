// SPDX-License-Identifier: Apache-2.0
#include "psi_table_storage.h"

#include "pellucid/segment/linear.h"

namespace pellucid {

PsiTableStorage::PsiTableStorage() {
  // The last node is x = ∞, where nothing passes: Ψ = 0.
  psi_.assign(static_cast<std::size_t>(nodes) * nodes, 0.0F);
  const auto x_of = [](int node) { return static_cast<double>(node) / (nodes - 1 - node); };
  for (int i = 0; i < nodes - 1; ++i) {
    float* row = psi_.data() + std::ptrdiff_t{nodes} * i;
    for (int j = 0; j < nodes - 1; ++j) {
      row[j] = static_cast<float>(linear_weights(x_of(i), x_of(j), 1.0).psi);
    }
  }
  view_ = {psi_.data(), nodes};
}

const PsiTable& psi_table() {
  static const PsiTableStorage storage;
  return storage.view();
}

}  // namespace pellucid
