// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pellucid {

/// automatic: for each span binary32 if it keeps the tolerance, else binary64.
enum class Precision { automatic, float32, float64 };

}  // namespace pellucid
