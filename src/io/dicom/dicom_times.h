// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dicom_folder.h"

namespace pellucid {

/// Volumes of one series that differ in their time alone: phases of a heart, a bolus that passes.
struct DicomSteps {
  std::vector<const DicomGroup*> volumes;  ///< empty: there are none
  std::vector<double> times;               ///< time of each volume
  std::string unit;                        ///< "ms (TriggerTime)"
};

/// Returns the steps of a folder, or of the series of a file; with `wanted`, of the series whose
/// UID ends so. Times are FrameReferenceTime, TriggerTime, TemporalPositionIdentifier or the
/// earliest AcquisitionTime of each volume, the first of these that differs between all. `folder`
/// must outlive what is returned.
DicomSteps dicom_steps(const DicomFolder& folder, const std::filesystem::path& path,
                       const std::optional<std::string>& wanted);

}  // namespace pellucid
