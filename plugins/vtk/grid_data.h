// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "ghost_cells.h"
#include "pellucid/scene/volume.h"

class vtkDataArray;
class vtkDataSet;

namespace pellucid::plugin {

/// Returns the grid of a vtkImageData or a vtkRectilinearGrid in the world of its data. Values of
/// cells lie in the middle of the cells. Throws Error for other data sets.
Volume::Description grid_of(vtkDataSet& data, bool of_cells, const std::string& name);

/// Returns one component of an array. It is used where it lies, and owned together with VTK, if the
/// array's layout has the component's values side by side: one component, or a layout of arrays.
/// Otherwise, and for bits and whole numbers of 64 bits, it is copied. Throws Error.
VolumeData component_of(vtkDataArray& array, int component);

/// Returns a number that another one takes the place of if values of a component change: of some
/// thousand values, evenly spread, so that a change of few values may be missed.
std::uint64_t fingerprint_of(vtkDataArray& array, int component);

/// Keeps the volumes of the last picture. A volume is made again if its array, its grid or its
/// ghosts changed, as times of modification, the array's memory and fingerprint and the numbers of
/// the grid say. Hidden values are vacuum (hidden_places()).
class KeptGrids {
 public:
  /// Returns the volume of a component. Throws Error as Volume and hidden_places() do.
  std::shared_ptr<const Volume> find(vtkDataSet& data, vtkDataArray& array, bool of_cells,
                                     int component);
  /// Forgets what was not asked for since the last call.
  void keep_used() { kept_.keep_used(); }
  /// Returns how many volumes were made so far.
  int made() const noexcept { return kept_.made(); }

 private:
  struct Recipe {
    vtkSmartPointer<vtkDataArray> array;
    const void* memory = nullptr;
    vtkMTimeType time = 0;
    std::uint64_t fingerprint = 0;
    vtkIdType values = 0;
    int component = 0;
    GhostTimes ghosts;
    Volume::Description grid;

    bool operator==(const Recipe& other) const;
  };
  Kept<Recipe, Volume> kept_;
};

}  // namespace pellucid::plugin
