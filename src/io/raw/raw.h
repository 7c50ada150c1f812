// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/components.h"

namespace pellucid {

/// Opens headerless data, whose dimensions and type the options say. Throws Error.
VolumeFile open_raw(const ByteSource& source, const ReadOptions& options);

}  // namespace pellucid
