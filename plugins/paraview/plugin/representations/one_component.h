// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <vector>

class vtkDataArray;
class vtkDataSet;

namespace pellucid::plugin {

/// Gives data sets in which one component of an array, or its length, stands in the array's place.
class OneComponent {
 public:
  static constexpr int length = -1;

  /// Returns a shallow copy of the data with the component of the array under the array's name. The
  /// same copy comes again while data and array are as they were.
  vtkDataSet* of(vtkDataSet& data, vtkDataArray& array, bool of_cells, int component);
  /// Forgets what was not asked for since the last call.
  void keep_used();

 private:
  struct Kept {
    vtkSmartPointer<vtkDataSet> data;
    vtkSmartPointer<vtkDataArray> array;
    vtkMTimeType data_time = 0, array_time = 0;
    int component = 0;
    vtkSmartPointer<vtkDataSet> copy;
    bool used = true;
  };
  std::vector<Kept> kept_;
};

}  // namespace pellucid::plugin
