// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pellucid {

/// What the error of a pixel may rest on. `proved`: on theorems alone (docs/explanation/accuracy.md
/// says which), but for rounding, which is charged with constants that tests assert. `estimated`:
/// also on estimates with a safety factor, where a proof would cost several times the work.
enum class Grade { estimated, proved };

}  // namespace pellucid
