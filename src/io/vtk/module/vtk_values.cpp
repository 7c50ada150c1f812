// SPDX-License-Identifier: Apache-2.0
#include "vtk_values.h"

#include <vtkDataArray.h>
#include <vtkSmartPointer.h>

#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "volumes/stored_numbers.h"

namespace pellucid {

namespace {

std::size_t count_of(vtkDataArray& array) {
  return static_cast<std::size_t>(array.GetNumberOfTuples()) *
         static_cast<std::size_t>(array.GetNumberOfComponents());
}

template <class Value>
VolumeData in_place(vtkDataArray& array) {
  const vtkSmartPointer<vtkDataArray> owner(&array);
  const auto* const first = static_cast<const Value*>(array.GetVoidPointer(0));
  return DataArray<Value>(std::shared_ptr<const Value>(first, [owner](const Value*) {}),
                          count_of(array));
}

/// GetComponent() gives double, which is exact for all but the largest numbers of 64 bits.
template <class Value>
VolumeData copied(vtkDataArray& array) {
  DataArray<Value> values(count_of(array));
  auto to = values.writable().begin();
  for (vtkIdType tuple = 0; tuple < array.GetNumberOfTuples(); ++tuple) {
    for (int c = 0; c < array.GetNumberOfComponents(); ++c) {
      *to++ = static_cast<Value>(array.GetComponent(tuple, c));
    }
  }
  return values;
}

/// Whole numbers of 64 bits.
template <class Number>
VolumeData whole_numbers(vtkDataArray& array, std::string& rounded) {
  const std::size_t count = count_of(array);
  WholeNumbers kept([&](const std::string& type) { return make_volume_data(type, count); });
  kept.add(std::span(static_cast<const Number*>(array.GetVoidPointer(0)), count));
  if (kept.rounding().count > 0 && kept.type() == "f64") rounded = kept.rounding().text(count);
  return kept.take();
}

}  // namespace

VolumeData values_in_place(vtkDataArray& array, std::string& rounded) {
  const int bytes = array.GetDataTypeSize();
  switch (array.GetDataType()) {
    case VTK_BIT:
      return copied<std::uint8_t>(array);
    case VTK_UNSIGNED_CHAR:
      return in_place<std::uint8_t>(array);
    case VTK_CHAR:
      return std::numeric_limits<char>::is_signed ? in_place<std::int8_t>(array)
                                                  : in_place<std::uint8_t>(array);
    case VTK_SIGNED_CHAR:
      return in_place<std::int8_t>(array);
    case VTK_UNSIGNED_SHORT:
      return in_place<std::uint16_t>(array);
    case VTK_SHORT:
      return in_place<std::int16_t>(array);
    case VTK_UNSIGNED_INT:
      return in_place<std::uint32_t>(array);
    case VTK_INT:
      return in_place<std::int32_t>(array);
    case VTK_LONG:
    case VTK_LONG_LONG:
    case VTK_ID_TYPE:
      return bytes == 4 ? in_place<std::int32_t>(array)
                        : whole_numbers<std::int64_t>(array, rounded);
    case VTK_UNSIGNED_LONG:
    case VTK_UNSIGNED_LONG_LONG:
      return bytes == 4 ? in_place<std::uint32_t>(array)
                        : whole_numbers<std::uint64_t>(array, rounded);
    case VTK_FLOAT:
      return in_place<float>(array);
    case VTK_DOUBLE:
      return in_place<double>(array);
    default:
      break;
  }
  return copied<double>(array);
}

}  // namespace pellucid
