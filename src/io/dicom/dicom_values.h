// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "dicom_slices.h"
#include "volumes/components.h"

namespace pellucid {

/// Returns the type that holds the values of a series: with a slope of 1 and a whole intercept, the
/// same in all slices, the smallest whole type that holds every stored value behind it, not smaller
/// than the stored one; else f32, of 32 bits and more f64. Throws Error for slopes of 0.
std::string dicom_value_type(const std::vector<DicomSlice>& slices, const std::string& name);

/// Returns slope · stored + intercept of all slices in their order, each component by itself.
/// Throws DamagedDicom where some of several files cannot be decompressed, else Error.
std::vector<VolumeData> read_dicom_values(const std::vector<DicomSlice>& slices,
                                          ComponentRange range, const std::string& name);

/// Returns the values of all frames of a file, decompressed by GDCM, in this machine's byte order,
/// colors side by side; null where GDCM cannot do it. Throws Error where memory does not hold them,
/// and where the build has no GDCM.
std::shared_ptr<const std::byte> decode_dicom(const DicomImage& image);

}  // namespace pellucid
