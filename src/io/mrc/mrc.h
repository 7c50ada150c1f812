// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/components.h"

namespace pellucid {

/// Opens MRC2014 and CCP4 maps, of either byte order: modes 0 (i8, or u8 where IMOD or the range in
/// the header says so), 1 (i16), 2 (f32), 6 (u16) and 12 (half floats, f32). World is the cell's,
/// in Ångström, with its angles; the axes stand where the header permutes them to. Several volumes
/// (space group 401) are components.
VolumeFile open_mrc(const ByteSource& source, const ReadOptions& options);

}  // namespace pellucid
