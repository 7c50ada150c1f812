// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "dicom_slices.h"

namespace pellucid {

/// Slices of a series that are one volume.
struct DicomStack {
  std::vector<DicomSlice> slices;
  std::string mark;  ///< by which they differ from the rest: "EchoNumbers 2"; empty: there is none
  std::string note;  ///< what is assumed; empty: nothing
};

/// Tells the volumes of a series apart: slices that stand at the same places, or between each
/// other's, and differ in an echo, a time, an acquisition or the like. Slices that make one stack
/// stay together, whatever their acquisitions. Where nothing tells them apart, all stay together.
std::vector<DicomStack> split_dicom_volumes(std::vector<DicomSlice> slices);

}  // namespace pellucid
