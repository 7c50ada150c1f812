// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pellucid {

/// Evidence on which the error of a pixel may rest. `proved`: on theorems only
/// (docs/explanation/accuracy.md lists them); rounding is charged with constants that tests assert.
/// `estimated`: also on estimates with a safety factor, where a proved bound would cost several
/// times the work.
enum class Grade { estimated, proved };

}  // namespace pellucid
