// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pellucid/io/field_source.h"

namespace pellucid::cli {

/// Prints the DICOM series of a folder with several of which the source chooses none; else does
/// nothing. Whether it printed. Throws Error.
bool print_series(const FieldSource& source, const std::string& input, bool as_json);

}  // namespace pellucid::cli
