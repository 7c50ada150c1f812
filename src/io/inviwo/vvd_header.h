// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "volumes/components.h"

namespace pellucid {

/// A volume of Voreen (.vvd): a header in XML that names a file of values. Values stand at the
/// offset and from there at steps of the spacing, both turned by the transformation. A mapping to
/// real values other than Voreen's default is applied.
VolumeFile open_vvd(const std::filesystem::path& path, const ReadOptions& options);

}  // namespace pellucid
