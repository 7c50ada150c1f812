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
#include <vtkMatrix4x4.h>
#include <vtkMultiProcessController.h>
#include <vtkPVRenderView.h>
#include <vtkPVRenderViewDataDeliveryManager.h>
#include <vtkProp3D.h>
#include <vtkRenderer.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace pellucid::plugin {
namespace {

/// Share of a box's side by which boxes may overlap at their border.
constexpr double border = 1e-6;

bool overlap(const vtkBoundingBox& a, const vtkBoundingBox& b) {
  if (a.IsValid() == 0 || b.IsValid() == 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const double first = std::max(a.GetBound(2 * axis), b.GetBound(2 * axis));
    const double last = std::min(a.GetBound(2 * axis + 1), b.GetBound(2 * axis + 1));
    if (!(last - first > border * std::min(a.GetLength(axis), b.GetLength(axis)))) return false;
  }
  return true;
}

bool lies_in(const vtkBoundingBox& part, const vtkBoundingBox& whole) {
  if (whole.IsValid() == 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const double beside = border * part.GetLength(axis);
    if (part.GetBound(2 * axis) < whole.GetBound(2 * axis) - beside ||
        part.GetBound(2 * axis + 1) > whole.GetBound(2 * axis + 1) + beside) {
      return false;
    }
  }
  return true;
}

}  // namespace

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
  core_.finish.is_composited = ranks() > 1;
  plugin::set_tolerance(core_.settings, share());
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
  tolerance_ = nearest_tolerance(tolerance);
  return plugin::set_tolerance(core_.settings, share());
}

double SharedPicture::share() const {
  return ranks() > 1 ? tolerance_ / (2 * ranks()) : tolerance_;
}

bool SharedPicture::set_grade(int grade) {
  return plugin::set_grade(core_.settings, grade);
}

void SharedPicture::set_threads(int threads) {
  plugin::set_threads(core_.settings, threads);
}

void SharedPicture::prepare(vtkPVDataRepresentation& representation) {
  core_.outcome = {};
  if (vtkMath::AreBoundsInitialized(mapper_.GetBounds()) != 0) core_.outcome = {true, 0, 0};
  if (auto* const view = vtkPVRenderView::SafeDownCast(representation.GetView())) {
    view->GetRenderer()->SetUseDepthPeelingForVolumes(false);
    if (ranks() > 1) {
      representation_ = &representation;
      gatherer_->await(*view->GetRenderer());
    }
  }
  vtkInformation* const chosen = representation.GetInputArrayInformation(0);
  const char* const name = chosen != nullptr ? chosen->Get(vtkDataObject::FIELD_NAME()) : nullptr;
  if ((name != nullptr && *name != '\0') || std::exchange(is_told_, true)) return;
  vtkWarningWithObjectMacro(
      &representation,
      << "Pellucid: nothing is shown without an array; choose one to color by (ColorBy())");
}

void SharedPicture::check_order(vtkPVDataRepresentation& representation,
                                const vtkBoundingBox& own) {
  has_order_ = true;
  if (ranks() < 2) return;
  auto* const view = vtkPVRenderView::SafeDownCast(representation.GetView());
  auto* const manager =
      view == nullptr
          ? nullptr
          : vtkPVRenderViewDataDeliveryManager::SafeDownCast(view->GetDeliveryManager());
  if (manager == nullptr) return;
  const std::vector<vtkBoundingBox>& boxes = manager->GetCuts();
  const auto rank = static_cast<std::size_t>(
      vtkMultiProcessController::GetGlobalController()->GetLocalProcessId());
  has_order_ = boxes.size() == static_cast<std::size_t>(ranks()) &&
               (own.IsValid() == 0 || lies_in(own, boxes[rank]));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (overlap(boxes[i], boxes[j])) has_order_ = false;
    }
  }
}

void SharedPicture::gather() {
  Outcome own = core_.outcome;
  // A rank without data has nothing to draw.
  if (vtkMath::AreBoundsInitialized(mapper_.GetBounds()) == 0) own = {true, 0, 0, 0};
  const std::array<double, 4> part{own.exact ? 0.0 : 1.0, has_order_ ? 0.0 : 1.0, own.largest_error,
                                   static_cast<double>(own.pixels_over)};
  std::array<double, 4> sum{};
  vtkMultiProcessController& controller = *vtkMultiProcessController::GetGlobalController();
  controller.AllReduce(part.data(), sum.data(), 4, vtkCommunicator::SUM_OP);
  gathered_.exact = sum[0] == 0 && sum[1] == 0;
  gathered_.largest_error = std::min(2 * sum[2], 1.0);  // a window shows 0 to 1
  if (!gathered_.exact) gathered_.largest_error = std::numeric_limits<double>::infinity();
  // What exceeds its share need not exceed the whole.
  gathered_.pixels_over = gathered_.largest_error <= tolerance_ ? 0 : std::llround(sum[3]);
  const vtkSmartPointer<vtkPVDataRepresentation> told = std::move(representation_);
  if (sum[1] == 0 || controller.GetLocalProcessId() != 0 || std::exchange(is_order_told_, true)) {
    return;
  }
  vtkWarningWithObjectMacro(
      told, << "Pellucid: the boxes around what each rank shows overlap, so that no order of the "
               "ranks from back to front is right; use one rank");
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
    about->Set(levels, std::max(about->Get(levels), 2));
  }
}

vtkBoundingBox moved(const vtkBoundingBox& box, vtkProp3D& volume) {
  vtkBoundingBox around;
  if (box.IsValid() == 0) return around;
  volume.ComputeMatrix();
  for (int i = 0; i < 8; ++i) {
    double corner[4] = {0, 0, 0, 1};
    box.GetCorner(i, corner);
    volume.GetMatrix()->MultiplyPoint(corner, corner);
    around.AddPoint(corner);
  }
  return around;
}

void set_bounds(vtkInformation& view, vtkPVDataRepresentation& representation,
                const vtkBoundingBox& own, vtkProp3D& volume) {
  double bounds[6];
  vtkMath::UninitializeBounds(bounds);
  if (const vtkBoundingBox box = moved(own, volume); box.IsValid() != 0) box.GetBounds(bounds);
  vtkPVRenderView::SetGeometryBounds(&view, &representation, bounds);
}

bool Mover::moved(vtkProp3D& volume) {
  volume.ComputeMatrix();
  std::array<double, 16> now;
  std::ranges::copy_n(volume.GetMatrix()->GetData(), 16, now.begin());
  return std::exchange(last_, now) != now;
}

vtkBoundingBox joined_over_ranks(const vtkBoundingBox& own) {
  // The largest of what is positive upwards, on either side.
  std::array<double, 6> sides, largest;
  own.GetBounds(sides.data());
  for (std::size_t side = 0; side < 6; side += 2) sides[side] = -sides[side];
  vtkMultiProcessController::GetGlobalController()->AllReduce(sides.data(), largest.data(), 6,
                                                              vtkCommunicator::MAX_OP);
  for (std::size_t side = 0; side < 6; side += 2) largest[side] = -largest[side];
  return vtkBoundingBox(largest.data());
}

}  // namespace pellucid::plugin
