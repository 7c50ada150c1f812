// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "pellucid/scene/image.h"

class vtkAbstractVolumeMapper;

namespace pellucid::test {

/// An image of n³ floats: a ball whose values fall from 100 in its middle, with waves.
vtkSmartPointer<vtkImageData> ball_image(int n = 24);
/// A property as in tests/python/test_vtk.py: orange over blue, opacity 0.2 at 100.
vtkSmartPointer<vtkVolumeProperty> soft_property(double unit = 1);

/// Messages of VTK while it lives, in the place of the standard error.
class Messages {
 public:
  Messages();
  ~Messages();
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  const std::string& text() const noexcept;

 private:
  class Window;
  vtkSmartPointer<Window> window_;
};

/// A window off the screen with one renderer, black and without samples in a pixel.
class Stage {
 public:
  explicit Stage(int width = 96, int height = 64);
  ~Stage();

  vtkVolume* add(vtkAbstractVolumeMapper* mapper, vtkVolumeProperty* property);
  /// Turns the camera and puts its clipping planes around everything.
  void look(double azimuth = 30, double elevation = 20);
  /// Renders the window and returns its colors, row 0 at the top; alpha is 0.
  Image picture();
  /// Returns the errors of OpenGL since the last call, which are not to be.
  std::string gl_errors();

  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkRenderWindow> window;
  vtkCamera* camera = nullptr;
};

/// The largest difference of a color of any pixel between a picture of 8 bits and `truth` over
/// black. With `only`, of the pixels for which it holds.
double largest_difference(const Image& shown, const Image& truth,
                          const std::function<bool(int, int)>& only = {});

}  // namespace pellucid::test
