// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/components.h"

namespace pellucid {

/// Reads FreeSurfer's .mgh from bytes that are not compressed. The world is LPS. Frames are
/// components. Throws Error.
VolumeFile open_mgh_bytes(const ByteSource& source, const ReadOptions& options);

}  // namespace pellucid
