// SPDX-License-Identifier: Apache-2.0
#include "shared_picture.h"

#include <vtkAbstractVolumeMapper.h>
#include <vtkCommand.h>
#include <vtkCommunicator.h>
#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkInformationIntegerKey.h>
#include <vtkInformationVector.h>
#include <vtkMath.h>
#include <vtkMultiProcessController.h>
#include <vtkPVDataRepresentation.h>
#include <vtkPVRenderView.h>
#include <vtkRenderer.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace pellucid::plugin {

/// Waits for the end of a frame.
class SharedPicture::Gatherer : public vtkCommand {
 public:
  static Gatherer* New() { return new Gatherer; }
  vtkTypeMacro(Gatherer, vtkCommand)

  void await(vtkRenderer& renderer) {
    if (std::exchange(is_waiting_, true)) return;
    // After what puts the ranks' pictures together.
    renderer.AddObserver(vtkCommand::EndEvent, this, -1);
  }
  void Execute(vtkObject* renderer, unsigned long, void*) override {
    const vtkSmartPointer<Gatherer> self(this);
    renderer->RemoveObserver(this);
    is_waiting_ = false;
    if (picture != nullptr) picture->gather();
  }

  SharedPicture* picture = nullptr;

 private:
  bool is_waiting_ = false;
};

SharedPicture::SharedPicture(MapperCore& core, vtkAbstractVolumeMapper& mapper)
    : core_(core), mapper_(mapper), gatherer_(vtkSmartPointer<Gatherer>::New()) {
  gatherer_->picture = this;
  plugin::set_tolerance(core_.settings, tolerance_ / ranks());
}

SharedPicture::~SharedPicture() {
  gatherer_->picture = nullptr;
}

int SharedPicture::ranks() {
  vtkMultiProcessController* const controller = vtkMultiProcessController::GetGlobalController();
  return controller != nullptr ? std::max(controller->GetNumberOfProcesses(), 1) : 1;
}

bool SharedPicture::set_tolerance(double tolerance) {
  if (!(tolerance > 0)) return false;
  tolerance_ = std::clamp(tolerance, smallest_tolerance, largest_tolerance);
  return plugin::set_tolerance(core_.settings, tolerance_ / ranks());
}

bool SharedPicture::set_grade(int grade) {
  return plugin::set_grade(core_.settings, grade);
}

void SharedPicture::set_threads(int threads) {
  plugin::set_threads(core_.settings, threads);
}

void SharedPicture::prepare(vtkPVDataRepresentation& representation) {
  if (auto* const view = vtkPVRenderView::SafeDownCast(representation.GetView())) {
    view->GetRenderer()->SetUseDepthPeelingForVolumes(false);
    if (ranks() > 1) gatherer_->await(*view->GetRenderer());
  }
  vtkInformation* const chosen = representation.GetInputArrayInformation(0);
  const char* const name = chosen != nullptr ? chosen->Get(vtkDataObject::FIELD_NAME()) : nullptr;
  if ((name != nullptr && *name != '\0') || std::exchange(is_told_, true)) return;
  vtkWarningWithObjectMacro(
      &representation,
      << "Pellucid: nothing is shown without an array; choose one to color by (ColorBy())");
}

void SharedPicture::check_order(vtkPVDataRepresentation& representation) {
  has_order_ = true;
  if (ranks() < 2) return;
  std::array<double, 6> own;
  std::ranges::copy_n(mapper_.GetBounds(), 6, own.begin());
  std::vector<double> all(own.size() * static_cast<std::size_t>(ranks()));
  vtkMultiProcessController::GetGlobalController()->AllGather(own.data(), all.data(), 6);
  for (std::size_t a = 0; a < all.size(); a += 6) {
    for (std::size_t b = 0; b < a; b += 6) {
      bool overlap = true;
      for (std::size_t axis = 0; axis < 6; axis += 2) {
        const double first = std::max(all[a + axis], all[b + axis]);
        const double last = std::min(all[a + axis + 1], all[b + axis + 1]);
        overlap = overlap && last - first > 1e-6 * (all[a + axis + 1] - all[a + axis]);
      }
      if (overlap) has_order_ = false;
    }
  }
  if (has_order_ || std::exchange(is_order_told_, true)) return;
  vtkWarningWithObjectMacro(&representation,
                            << "Pellucid: the boxes of the ranks' parts overlap, so that no order "
                               "from back to front is right; use one rank");
}

void SharedPicture::gather() {
  Outcome own = core_.outcome;
  // A rank without data has nothing to draw.
  if (vtkMath::AreBoundsInitialized(mapper_.GetBounds()) == 0) own = {true, 0, 0, 0};
  const std::array<double, 3> part{own.exact ? 0.0 : 1.0, own.largest_error,
                                   static_cast<double>(own.pixels_over)};
  std::array<double, 3> sum{};
  vtkMultiProcessController::GetGlobalController()->AllReduce(part.data(), sum.data(), 3,
                                                              vtkCommunicator::SUM_OP);
  gathered_.exact = sum[0] == 0;
  gathered_.largest_error = sum[1];
  if (!has_order_) {
    gathered_.exact = false;
    gathered_.largest_error = std::numeric_limits<double>::infinity();
  }
  // What exceeds its share need not exceed the whole.
  gathered_.pixels_over = gathered_.largest_error <= tolerance_ ? 0 : std::llround(sum[2]);
}

Outcome SharedPicture::outcome() const {
  return ranks() > 1 ? gathered_ : core_.outcome;
}

void request_ghosts(vtkInformationVector** inputs) {
  if (SharedPicture::ranks() < 2) return;
  vtkInformationIntegerKey* const levels =
      vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_GHOST_LEVELS();
  for (int i = 0; i < inputs[0]->GetNumberOfInformationObjects(); ++i) {
    vtkInformation* const about = inputs[0]->GetInformationObject(i);
    about->Set(levels, std::max(about->Get(levels), 1));
  }
}

}  // namespace pellucid::plugin
