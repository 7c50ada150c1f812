// SPDX-License-Identifier: Apache-2.0
#include "override_mappers.h"

#include <vtkContourValues.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkImageData.h>
#include <vtkMultiVolume.h>
#include <vtkObjectFactory.h>
#include <vtkProjectedTetrahedraMapper.h>
#include <vtkRenderer.h>
#include <vtkSmartVolumeMapper.h>
#include <vtkUnstructuredGridVolumeRayCastMapper.h>
#include <vtkUnstructuredGridVolumeZSweepMapper.h>
#include <vtkVolume.h>

#include "mapper_core.h"
#include "vtkPellucidUnstructuredGridMapper.h"
#include "vtkPellucidVolumeMapper.h"

namespace pellucid::plugin {
namespace {

/// Base of each of the classes below.
class HasCore {
 public:
  virtual ~HasCore() = default;
  MapperCore core;
};

/// Notes that shadows are left out; VTK before 9.2 has none.
template <class Mapper>
void say_shadows_are_left_out(Mapper& mapper, Notes& notes) {
  if constexpr (requires { mapper.GetVolumetricScatteringBlending(); }) {
    if (mapper.GetVolumetricScatteringBlending() > 0) {
      notes.add("light is not scattered: VolumetricScatteringBlending is left out");
    }
  }
}

class GpuOverride final : public vtkGPUVolumeRayCastMapper, public HasCore {
 public:
  static GpuOverride* New();
  vtkTypeMacro(GpuOverride, vtkGPUVolumeRayCastMapper)
  GpuOverride(const GpuOverride&) = delete;
  void operator=(const GpuOverride&) = delete;

  int IsRenderSupported(vtkRenderWindow*, vtkVolumeProperty*) override { return 1; }
  void Render(vtkRenderer* renderer, vtkVolume* volume) override {
    update_inputs(*this);
    const MaskImage mask{this->GetMaskInput(), this->GetMaskType() == BinaryMaskType,
                         double{this->GetMaskBlendFactor()}};
    set_final_colors(this->core.finish, double{this->GetFinalColorWindow()},
                     double{this->GetFinalColorLevel()}, this->core.left_out);
    say_shadows_are_left_out(*this, this->core.left_out);
    if (this->GetRenderToImage() != 0) this->core.left_out.add("RenderToImage is left out");
    if (auto* const several = vtkMultiVolume::SafeDownCast(volume)) {
      std::vector<std::pair<vtkDataSet*, vtkVolume*>> parts;
      // Ports need not follow one another.
      for (int port = 0; port < this->GetNumberOfInputPorts(); ++port) {
        if (this->GetNumberOfInputConnections(port) == 0) continue;
        if (vtkVolume* const part = several->GetVolume(port)) {
          parts.emplace_back(this->GetInput(port), part);
        }
      }
      this->core.draw(*this, parts, mask, *renderer, *volume);
    } else {
      this->core.draw(*this, mask, *renderer, *volume);
    }
    this->TimeToDraw = this->core.outcome.seconds;
  }
  void ReleaseGraphicsResources(vtkWindow* window) override { this->core.release(window); }
  void GetReductionRatio(double ratio[3]) override { ratio[0] = ratio[1] = ratio[2] = 1; }

 protected:
  GpuOverride() = default;
  ~GpuOverride() override = default;
  void PreRender(vtkRenderer*, vtkVolume*, double*, double*, int, unsigned int) override {}
  void RenderBlock(vtkRenderer*, vtkVolume*, unsigned int) override {}
  void PostRender(vtkRenderer*, int) override {}
};
vtkStandardNewMacro(GpuOverride)

    class FixedPointOverride final : public vtkFixedPointVolumeRayCastMapper,
                                     public HasCore {
 public:
  static FixedPointOverride* New();
  vtkTypeMacro(FixedPointOverride, vtkFixedPointVolumeRayCastMapper)
  FixedPointOverride(const FixedPointOverride&) = delete;
  void operator=(const FixedPointOverride&) = delete;

  void Render(vtkRenderer* renderer, vtkVolume* volume) override {
    update_inputs(*this);
    set_final_colors(this->core.finish, double{this->GetFinalColorWindow()},
                     double{this->GetFinalColorLevel()}, this->core.left_out);
    this->core.draw(*this, {}, *renderer, *volume);
    this->TimeToDraw = this->core.outcome.seconds;
  }
  void ReleaseGraphicsResources(vtkWindow* window) override {
    this->core.release(window);
    this->Superclass::ReleaseGraphicsResources(window);
  }

 protected:
  FixedPointOverride() = default;
  ~FixedPointOverride() override = default;
};
vtkStandardNewMacro(FixedPointOverride)

    class RayCastOverride final : public vtkUnstructuredGridVolumeRayCastMapper,
                                  public HasCore {
 public:
  static RayCastOverride* New();
  vtkTypeMacro(RayCastOverride, vtkUnstructuredGridVolumeRayCastMapper)
  RayCastOverride(const RayCastOverride&) = delete;
  void operator=(const RayCastOverride&) = delete;

  void Render(vtkRenderer* renderer, vtkVolume* volume) override {
    update_inputs(*this);
    this->core.draw(*this, *renderer, *volume);
    this->TimeToDraw = this->core.outcome.seconds;
  }
  void ReleaseGraphicsResources(vtkWindow* window) override {
    this->core.release(window);
    this->Superclass::ReleaseGraphicsResources(window);
  }

 protected:
  RayCastOverride() = default;
  ~RayCastOverride() override = default;
};
vtkStandardNewMacro(RayCastOverride)

    class ZSweepOverride final : public vtkUnstructuredGridVolumeZSweepMapper,
                                 public HasCore {
 public:
  static ZSweepOverride* New();
  vtkTypeMacro(ZSweepOverride, vtkUnstructuredGridVolumeZSweepMapper)
  ZSweepOverride(const ZSweepOverride&) = delete;
  void operator=(const ZSweepOverride&) = delete;

  void Render(vtkRenderer* renderer, vtkVolume* volume) override {
    update_inputs(*this);
    this->core.draw(*this, *renderer, *volume);
    this->TimeToDraw = this->core.outcome.seconds;
  }
  void ReleaseGraphicsResources(vtkWindow* window) override {
    this->core.release(window);
    this->Superclass::ReleaseGraphicsResources(window);
  }

 protected:
  ZSweepOverride() = default;
  ~ZSweepOverride() override = default;
};
vtkStandardNewMacro(ZSweepOverride)

    class TetrahedraOverride final : public vtkProjectedTetrahedraMapper,
                                     public HasCore {
 public:
  static TetrahedraOverride* New();
  vtkTypeMacro(TetrahedraOverride, vtkProjectedTetrahedraMapper)
  TetrahedraOverride(const TetrahedraOverride&) = delete;
  void operator=(const TetrahedraOverride&) = delete;

  bool IsSupported(vtkRenderWindow*) override { return true; }
  void Render(vtkRenderer* renderer, vtkVolume* volume) override {
    update_inputs(*this);
    this->core.draw(*this, *renderer, *volume);
    this->TimeToDraw = this->core.outcome.seconds;
  }
  void ReleaseGraphicsResources(vtkWindow* window) override { this->core.release(window); }

 protected:
  TetrahedraOverride() = default;
  ~TetrahedraOverride() override = default;
};
vtkStandardNewMacro(TetrahedraOverride)

    /// Reads the protected members of a smart mapper of which one draws for it.
    struct SmartMapper : vtkSmartVolumeMapper {
  static vtkAbstractVolumeMapper* drawing_for(vtkSmartVolumeMapper& mapper) {
    switch (mapper.GetRequestedRenderMode()) {
      case DefaultRenderMode:
      case GPURenderMode:
        return mapper.*(&SmartMapper::GPUMapper);
      case RayCastRenderMode:
        return mapper.*(&SmartMapper::RayCastMapper);
      default:
        return nullptr;
    }
  }
};

}  // namespace

vtkGPUVolumeRayCastMapper* new_gpu_override() {
  return GpuOverride::New();
}
vtkFixedPointVolumeRayCastMapper* new_fixed_point_override() {
  return FixedPointOverride::New();
}
vtkUnstructuredGridVolumeRayCastMapper* new_ray_cast_override() {
  return RayCastOverride::New();
}
vtkUnstructuredGridVolumeZSweepMapper* new_z_sweep_override() {
  return ZSweepOverride::New();
}
vtkProjectedTetrahedraMapper* new_projected_tetrahedra_override() {
  return TetrahedraOverride::New();
}

MapperCore* core_of(vtkAbstractVolumeMapper* mapper) {
  if (mapper == nullptr) return nullptr;
  if (auto* const override_mapper = dynamic_cast<HasCore*>(mapper)) return &override_mapper->core;
  if (auto* const ours = vtkPellucidVolumeMapper::SafeDownCast(mapper)) return &ours->GetCore();
  if (auto* const ours = vtkPellucidUnstructuredGridMapper::SafeDownCast(mapper)) {
    return &ours->GetCore();
  }
  if (auto* const smart = vtkSmartVolumeMapper::SafeDownCast(mapper)) {
    return core_of(SmartMapper::drawing_for(*smart));
  }
  return nullptr;
}

}  // namespace pellucid::plugin
