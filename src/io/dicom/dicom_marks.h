// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "dicom_elements.h"

namespace pellucid {

/// An attribute by which the volumes of one series may differ.
struct DicomMark {
  const char* name;
  /// True if its values mean different quantities, times or echoes. Else they may also tell apart
  /// the slices of one stack, as numbers of acquisitions do.
  bool is_decisive;
};

/// The attributes, in the order in which a series is told apart by them.
inline constexpr std::array dicom_marks =
    std::to_array<DicomMark>({{"ImageType", true},
                              {"ComplexImageComponent", true},
                              {"StackID", true},
                              {"EchoNumbers", true},
                              {"EchoTime", true},
                              {"InversionTime", true},
                              {"DiffusionBValue", true},
                              {"DiffusionGradientOrientation", true},
                              {"TemporalPosition", true},
                              {"ConvolutionKernel", true},
                              {"FrameReferenceTime", true},
                              {"AcquisitionNumber", false},
                              {"TriggerTime", false},
                              {"AcquisitionTime", false}});

/// Returns the value of each attribute for a frame as text, empty where it has none. `groups` are
/// the functional groups of the frame and those that all frames share; each may be null.
std::vector<std::string> dicom_mark_values(const DicomDataSet& file,
                                           const std::array<const DicomDataSet*, 2>& groups);

/// Returns what should be told of elements of the file that change how its values are meant, and
/// that are not taken into account, a line each.
std::vector<std::string> dicom_value_notes(const DicomDataSet& file);

}  // namespace pellucid
