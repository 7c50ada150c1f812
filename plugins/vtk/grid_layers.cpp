// SPDX-License-Identifier: Apache-2.0
#include "grid_layers.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkVolume.h>
#include <vtkVolumeMapper.h>

#include "pellucid/scene/error.h"

namespace pellucid::plugin {
namespace {

GridData data_of(vtkDataSet& data, vtkDataArray* array, bool of_cells, KeptOfGrids& kept) {
  GridData made;
  made.class_name = data.GetClassName();
  made.ghosts = ghosts_of(data, kept.own_cells);
  if (array == nullptr) return made;
  made.components = array->GetNumberOfComponents();
  made.type = array->GetDataType();
  made.type_name = array->GetDataTypeAsString();
  made.ranges.resize(static_cast<std::size_t>(made.components));
  for (int c = 0; c < made.components; ++c) {
    array->GetFiniteRange(made.ranges[static_cast<std::size_t>(c)].data(), c);
  }
  made.volume = [&data, array, of_cells, &kept](int component) {
    return kept.volumes.find(data, *array, of_cells, component);
  };
  return made;
}

Mask mask_of(const MaskImage& input, bool of_cells, KeptOfGrids& kept) {
  if (input.labels == nullptr) return {};
  vtkDataArray* const labels = input.labels->GetPointData()->GetScalars();
  if (labels == nullptr) throw Error("mask: has no labels");
  return {kept.labels.find(*input.labels, *labels, of_cells, 0), input.is_binary, input.blend};
}

}  // namespace

void KeptOfGrids::keep_used() {
  volumes.keep_used();
  labels.keep_used();
  looks.keep_used();
  fits.keep_used();
  own_cells.keep_used();
}

std::vector<TableLayer> layers_of(vtkVolumeMapper& mapper, vtkDataSet* data, vtkVolume& volume,
                                  const MaskImage& mask, double tolerance, bool has_ambient_light,
                                  KeptOfGrids& kept, Notes& notes) {
  if (data == nullptr) return {};
  int of_cells = 0;
  vtkDataArray* const array =
      vtkAbstractMapper::GetScalars(data, mapper.GetScalarMode(), mapper.GetArrayAccessMode(),
                                    mapper.GetArrayId(), mapper.GetArrayName(), of_cells);
  GridVolume given;
  given.data = data_of(*data, array, of_cells != 0, kept);
  given.property = settings_of(*volume.GetProperty(), given.data.components);
  given.mapper = settings_of(mapper);
  given.matrix = elements_of(*volume.GetMatrix());
  given.mask = mask_of(mask, of_cells != 0, kept);
  return vtk_scene::layers_of(given, tolerance, has_ambient_light, kept.looks, notes);
}

}  // namespace pellucid::plugin
