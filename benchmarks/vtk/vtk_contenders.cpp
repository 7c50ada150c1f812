// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/vtk/vtk_contenders.h"

#include <vtkAutoInit.h>
#include <vtkImageData.h>
#include <vtkLogger.h>
#include <vtkMultiThreader.h>
#include <vtkRenderWindow.h>
#include <vtkVersion.h>

#include <cstdlib>

#include "benchmarks/vtk/fixed_point.h"
#include "benchmarks/vtk/gpu.h"
#include "benchmarks/vtk/vtk_scene.h"

VTK_MODULE_INIT(vtkRenderingOpenGL2)
VTK_MODULE_INIT(vtkRenderingVolumeOpenGL2)

namespace pellucid::bench {
namespace {

/// For VTK's mappers, and, by variables that are asked for once, for its filters (vtkSMPTools.h is
/// no C++20) and Mesa's software renderer.
void set_threads(int threads) {
  vtkMultiThreader::SetGlobalMaximumNumberOfThreads(threads);
  vtkMultiThreader::SetGlobalDefaultNumberOfThreads(threads);
  setenv("VTK_SMP_MAX_THREADS", std::to_string(threads).c_str(), 1);
  setenv("LP_NUM_THREADS", std::to_string(threads == 1 ? 0 : threads).c_str(), 1);
}

}  // namespace

VtkContenders vtk_contenders(const Scene& scene, const std::vector<double>& steps, int threads) {
  VtkContenders made;
  if (const std::string why = not_for_vtk(scene); !why.empty()) {
    made.left_out = "VTK: " + why;
    return made;
  }
  set_threads(threads);
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_ERROR);
  const auto image = vtk_image(scene);
  // The window is asked for its size alone: without a display it is never opened.
  const auto renderer = vtk_renderer(scene);
  const auto window = vtkSmartPointer<vtkRenderWindow>::New();
  window->SetSize(scene.size.width, scene.size.height);
  window->AddRenderer(renderer);
  Contender fixed = fixed_point_contender(scene, renderer, image, threads);
  fixed.render = [window, render = fixed.render](double step) { return render(step); };
  made.list.push_back(std::move(fixed));
  std::string name;
  if (opengl_works(&name)) {
    for (Contender& contender : gpu_contenders(scene, image)) {
      made.list.push_back(std::move(contender));
    }
  } else {
    made.left_out =
        "VTK's GPU and smart mappers: no OpenGL display; run under xvfb-run (package xvfb)";
  }
  for (Contender& contender : made.list) {
    if (contender.settings.empty()) contender.settings = steps;
  }
  return made;
}

std::string vtk_version() {
  return std::string("VTK ") + vtkVersion::GetVTKVersion();
}

}  // namespace pellucid::bench
