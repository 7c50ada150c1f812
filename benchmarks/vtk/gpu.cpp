// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/vtk/gpu.h"

#include <vtkNew.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLGPUVolumeRayCastMapper.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkPixelBufferObject.h>
#include <vtkSmartVolumeMapper.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "benchmarks/vtk/vtk_scene.h"
#include "tests/support/one_layer.h"

namespace pellucid::bench {
namespace {

/// A window that is not shown, and a framebuffer of floats in place of its own of 8 bits.
class FloatTarget {
 public:
  FloatTarget(vtkRenderer* renderer, ImageSize size) : renderer_(renderer), size_(size) {
    window_ = vtkSmartPointer<vtkOpenGLRenderWindow>::Take(
        vtkOpenGLRenderWindow::SafeDownCast(vtkRenderWindow::New()));
    window_->SetShowWindow(false);
    window_->SetUseOffScreenBuffers(true);
    window_->SetMultiSamples(0);
    window_->SetAlphaBitPlanes(1);
    window_->SetSize(size.width, size.height);
    window_->AddRenderer(renderer);
  }
  ~FloatTarget() {
    if (buffer_) buffer_->ReleaseGraphicsResources(window_);
    window_->RemoveRenderer(renderer_);
    window_->Finalize();
  }
  FloatTarget(const FloatTarget&) = delete;
  FloatTarget& operator=(const FloatTarget&) = delete;

  double draw() {
    if (!buffer_) make();
    vtkOpenGLState* state = window_->GetState();
    state->PushFramebufferBindings();
    buffer_->Bind();
    buffer_->ActivateDrawBuffer(0);
    renderer_->ResetCameraClippingRange();
    const auto start = std::chrono::steady_clock::now();
    renderer_->Render();
    window_->WaitForCompletion();
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    state->PopFramebufferBindings();
    return seconds;
  }

  Image picture() {
    Image image;
    image.width = size_.width;
    image.height = size_.height;
    const auto width = static_cast<std::size_t>(size_.width);
    const auto height = static_cast<std::size_t>(size_.height);
    image.pixels.resize(width * height);
    vtkOpenGLState* state = window_->GetState();
    state->PushFramebufferBindings();
    buffer_->Bind();
    buffer_->ActivateReadBuffer(0);
    int extent[4] = {0, size_.width - 1, 0, size_.height - 1};
    const auto pixels =
        vtkSmartPointer<vtkPixelBufferObject>::Take(buffer_->DownloadColor4(extent, VTK_FLOAT));
    std::vector<std::array<float, 4>> bottom_up(width * height);
    unsigned int dimensions[2] = {static_cast<unsigned>(width), static_cast<unsigned>(height)};
    vtkIdType increments[2] = {0, 0};
    pixels->Download2D(VTK_FLOAT, bottom_up.data(), dimensions, 4, increments);
    state->PopFramebufferBindings();
    for (std::size_t row = 0; row < height; ++row) {
      std::copy_n(bottom_up.begin() + static_cast<std::ptrdiff_t>((height - 1 - row) * width),
                  width, image.pixels.begin() + static_cast<std::ptrdiff_t>(row * width));
    }
    return image;
  }

 private:
  void make() {
    window_->Render();
    buffer_ = vtkSmartPointer<vtkOpenGLFramebufferObject>::New();
    buffer_->SetContext(window_);
    vtkOpenGLState* state = window_->GetState();
    state->PushFramebufferBindings();
    const bool made =
        buffer_->PopulateFramebuffer(size_.width, size_.height, true, 1, VTK_FLOAT, true, 32, 0);
    state->PopFramebufferBindings();
    if (!made) throw std::runtime_error("VTK: no framebuffer of floats can be made");
  }

  vtkSmartPointer<vtkRenderer> renderer_;
  vtkSmartPointer<vtkOpenGLRenderWindow> window_;
  vtkSmartPointer<vtkOpenGLFramebufferObject> buffer_;
  ImageSize size_;
};

/// One mapper that stays, so that its volume is handed to OpenGL once.
struct Stage {
  vtkSmartPointer<vtkVolumeMapper> mapper;
  vtkSmartPointer<vtkVolume> volume;
  std::unique_ptr<FloatTarget> target;
  bool warm = false;

  Stage(const Scene& scene, vtkImageData* image, vtkVolumeMapper* made) : mapper(made) {
    mapper->SetInputDataObject(image);
    volume = vtk_volume(scene, mapper);
    const auto renderer = vtk_renderer(scene);
    renderer->AddVolume(volume);
    target = std::make_unique<FloatTarget>(renderer, scene.size);
  }
  /// The first one, which hands over the data and makes the programs, is drawn twice.
  TimedFrame frame() {
    if (!warm) target->draw();
    warm = true;
    TimedFrame timed;
    timed.seconds = target->draw();
    timed.image = target->picture();
    return timed;
  }
};

}  // namespace

bool opengl_works(std::string* renderer_name) {
  // Without a display VTK would end the program.
  if (std::getenv("DISPLAY") == nullptr) return false;
  static const std::string name = [] {
    const auto window = vtkSmartPointer<vtkRenderWindow>::New();
    window->SetShowWindow(false);
    window->SetUseOffScreenBuffers(true);
    window->SetSize(8, 8);
    window->Render();
    if (!window->SupportsOpenGL()) return std::string();
    const std::string report = window->ReportCapabilities();
    const std::size_t from = report.find("OpenGL renderer string:");
    if (from == std::string::npos) return std::string("OpenGL");
    const std::size_t begin = report.find_first_not_of(' ', from + 23);
    return report.substr(begin, report.find('\n', begin) - begin);
  }();
  *renderer_name = name;
  return !name.empty();
}

std::vector<Contender> gpu_contenders(const Scene& scene, vtkImageData* image) {
  std::vector<Contender> list;
  const auto gpu = vtkSmartPointer<vtkGPUVolumeRayCastMapper>::New();
  gpu->AutoAdjustSampleDistancesOff();
  gpu->UseJitteringOff();
  gpu->SetImageSampleDistance(1);
  const auto gpu_stage = std::make_shared<Stage>(scene, image, gpu);
  const double voxel = test::volume_of(scene).volume->voxel_size();
  list.push_back({"VTK GPU mapper", Knob::step, {}, [=](double step) {
                    gpu->SetSampleDistance(static_cast<float>(step * voxel));
                    return gpu_stage->frame();
                  }});

  const auto smart = vtkSmartPointer<vtkSmartVolumeMapper>::New();
  const auto smart_stage = std::make_shared<Stage>(scene, image, smart);
  list.push_back({"VTK smart", Knob::step, {0.5}, [=](double) { return smart_stage->frame(); }});
  return list;
}

}  // namespace pellucid::bench
