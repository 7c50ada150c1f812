// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "pellucid/render/transfer_tables.h"
#include "pellucid/scene/internal/antiderivative_storage.h"
#include "pellucid/scene/transfer_function.h"

namespace pellucid {

/// Owns the tables that are computed once per frame from a transfer function. It refers to the
/// function, which must outlive it. Not copyable, because the tables refer to this object.
class TransferTablesStorage {
 public:
  explicit TransferTablesStorage(const TransferFunction& function)
      : single_(function.view<float>()),
        wide_(function.view<double>()),
        tables_{function.view<float>(), function.view<double>(), single_.view(), wide_.view()} {
    for (const TransferFunction::Point& point : function.points()) {
      tables_.largest_extinction = std::max(tables_.largest_extinction, point.extinction);
    }
    tables_.merged = function.merged_in_float().data();
    tables_.merged_count = static_cast<int>(function.merged_in_float().size());
  }
  TransferTablesStorage(const TransferTablesStorage&) = delete;
  TransferTablesStorage& operator=(const TransferTablesStorage&) = delete;

  const TransferTables& tables() const noexcept { return tables_; }

 private:
  AntiderivativeStorage<float> single_;
  AntiderivativeStorage<double> wide_;
  TransferTables tables_;
};

}  // namespace pellucid
