// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pellucid {

/// automatic: binary32 where it keeps the tolerance, else binary64, span by span.
enum class Precision { automatic, float32, float64 };

}  // namespace pellucid
