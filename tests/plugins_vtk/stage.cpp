// SPDX-License-Identifier: Apache-2.0
#include "stage.h"

#include <vtkAbstractVolumeMapper.h>
#include <vtkFloatArray.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>
#include <vtk_glew.h>

#include <algorithm>

namespace pellucid::test {

vtkSmartPointer<vtkImageData> ball_image(int n) {
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(n, n, n);
  image->SetSpacing(1, 1.5, 2);
  image->SetOrigin(3, -2, 1);
  vtkNew<vtkFloatArray> values;
  values->SetName("ball");
  const double middle = 0.5 * (n - 1);
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        const double r = std::hypot(x - middle, y - middle, z - middle) / middle;
        const double wave = 8 * std::sin(0.9 * x) * std::cos(0.7 * y + 0.5 * z);
        values->InsertNextValue(static_cast<float>(std::max(100 * (1 - r * r) + wave, 0.0)));
      }
    }
  }
  image->GetPointData()->SetScalars(values);
  return image;
}

vtkSmartPointer<vtkVolumeProperty> soft_property(double unit) {
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0, 0);
  opacity->AddPoint(50, 0.02);
  opacity->AddPoint(100, 0.2);
  vtkNew<vtkColorTransferFunction> color;
  color->AddRGBPoint(0, 0, 0, 1);
  color->AddRGBPoint(60, 1, 0.5, 0);
  color->AddRGBPoint(100, 1, 1, 1);
  auto property = vtkSmartPointer<vtkVolumeProperty>::New();
  property->SetScalarOpacity(opacity);
  property->SetColor(color);
  property->SetScalarOpacityUnitDistance(unit);
  property->SetInterpolationTypeToLinear();
  property->ShadeOff();
  return property;
}

class Messages::Window : public vtkOutputWindow {
 public:
  static Window* New();
  vtkTypeMacro(Window, vtkOutputWindow)
  void DisplayText(const char* text) override { said += text; }
  std::string said;
};
vtkStandardNewMacro(Messages::Window);

Messages::Messages() : window_(vtkSmartPointer<Window>::New()) {
  vtkOutputWindow::SetInstance(window_);
}

Messages::~Messages() {
  vtkOutputWindow::SetInstance(nullptr);
}

const std::string& Messages::text() const noexcept {
  return window_->said;
}

Stage::Stage(int width, int height) {
  // A display whose last window closes ends.
  static const vtkSmartPointer<vtkRenderWindow> kept = [] {
    auto open = vtkSmartPointer<vtkRenderWindow>::New();
    open->SetOffScreenRendering(1);
    open->SetSize(8, 8);
    open->Render();
    return open;
  }();
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(width, height);
  window->AddRenderer(renderer);
  renderer->SetBackground(0, 0, 0);
  camera = renderer->GetActiveCamera();
}

Stage::~Stage() = default;

vtkVolume* Stage::add(vtkAbstractVolumeMapper* mapper, vtkVolumeProperty* property) {
  vtkNew<vtkVolume> volume;
  volume->SetMapper(mapper);
  volume->SetProperty(property);
  renderer->AddVolume(volume);
  return volume;
}

void Stage::look(double azimuth, double elevation) {
  renderer->ResetCamera();
  camera->Azimuth(azimuth);
  camera->Elevation(elevation);
  renderer->ResetCameraClippingRange();
}

Image Stage::picture() {
  window->Render();
  const int* const size = window->GetSize();
  vtkNew<vtkUnsignedCharArray> bytes;
  window->GetPixelData(0, 0, size[0] - 1, size[1] - 1, 0, bytes);
  Image image;
  image.width = size[0];
  image.height = size[1];
  image.pixels.resize(static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]));
  for (int y = 0; y < size[1]; ++y) {
    for (int x = 0; x < size[0]; ++x) {
      const vtkIdType first = 3 * (static_cast<vtkIdType>(size[1] - 1 - y) * size[0] + x);
      for (int c = 0; c < 3; ++c) {
        image.at(x, y)[static_cast<std::size_t>(c)] =
            static_cast<float>(bytes->GetValue(first + c)) / 255.0F;
      }
    }
  }
  return image;
}

std::string Stage::gl_errors() {
  window->MakeCurrent();
  std::string errors;
  for (GLenum error = glGetError(); error != GL_NO_ERROR && errors.size() < 200;
       error = glGetError()) {
    errors += std::to_string(error) + " ";
  }
  return errors;
}

double largest_difference(const Image& shown, const Image& truth,
                          const std::function<bool(int, int)>& only) {
  double largest = shown.width == truth.width && shown.height == truth.height ? 0 : 1e9;
  for (int y = 0; y < shown.height && largest < 1e9; ++y) {
    for (int x = 0; x < shown.width; ++x) {
      if (only && !only(x, y)) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const double wanted = std::clamp(double{truth.at(x, y)[c]}, 0.0, 1.0);
        largest = std::max(largest, std::abs(double{shown.at(x, y)[c]} - wanted));
      }
    }
  }
  return largest;
}

}  // namespace pellucid::test
