// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkMultiBlockVolumeMapper.h>

#include <vector>

#include "mapper_core.h"
#include "one_component.h"

namespace pellucid::plugin {

/// Returns the data sets with points of an input: itself, or its blocks.
std::vector<vtkDataSet*> parts_of(vtkDataObject* input);

/// Draws an image, a rectilinear grid, or blocks of them as one volume. ParaView's representation
/// of images asks for this class of mapper where the data may be blocks.
class BlocksMapper final : public vtkMultiBlockVolumeMapper {
 public:
  static BlocksMapper* New();
  vtkTypeMacro(BlocksMapper, vtkMultiBlockVolumeMapper)
  BlocksMapper(const BlocksMapper&) = delete;
  void operator=(const BlocksMapper&) = delete;

  MapperCore core;

  /// Returns the bounds of all blocks. Those of rectilinear grids count as well, which the
  /// superclass leaves out.
  double* GetBounds() override;
  using vtkMultiBlockVolumeMapper::GetBounds;
  void Render(vtkRenderer* renderer, vtkVolume* volume) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;

 protected:
  BlocksMapper() = default;
  ~BlocksMapper() override = default;

 private:
  OneComponent component_;
};

}  // namespace pellucid::plugin
