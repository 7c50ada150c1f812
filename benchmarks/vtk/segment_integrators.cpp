// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/vtk/segment_integrators.h"

#include <vtkUnstructuredGridLinearRayIntegrator.h>
#include <vtkUnstructuredGridPartialPreIntegration.h>

#include <memory>
#include <string>

namespace pellucid::bench {
namespace {

using Integrate = void (*)(double length, const double color_f[3], double extinction_f,
                           const double color_b[3], double extinction_b, float color[4]);

template <Integrate integrate>
SegmentIntegrator integrator(const char* name, double largest_depth) {
  return {name,
          [](const SegmentList& given) {
            const auto list = std::make_shared<const SegmentList>(given);
            const auto colors = std::make_shared<std::vector<std::array<float, 4>>>(given.size());
            return PreparedSegments{[=] {
                                      for (std::size_t i = 0; i < list->size(); ++i) {
                                        float* color = (*colors)[i].data();
                                        color[0] = color[1] = color[2] = color[3] = 0;
                                        integrate(list->length[i], list->color_f[i].data(),
                                                  list->extinction_f[i], list->color_b[i].data(),
                                                  list->extinction_b[i], color);
                                      }
                                    },
                                    [=] {
                                      SegmentColors result;
                                      result.reserve(colors->size());
                                      for (const auto& c : *colors)
                                        result.push_back({c[0], c[1], c[2], c[3]});
                                      return result;
                                    }};
          },
          largest_depth};
}

}  // namespace

std::vector<SegmentIntegrator> vtk_segment_integrators() {
  vtkUnstructuredGridPartialPreIntegration::BuildPsiTable();
  return {integrator<vtkUnstructuredGridLinearRayIntegrator::IntegrateRay>(
              "VTK linear", std::numeric_limits<double>::infinity()),
          // Its table is looked up beyond its end where x/(x + 1) is 1 in float.
          integrator<vtkUnstructuredGridPartialPreIntegration::IntegrateRay>("VTK partial", 1e6)};
}

}  // namespace pellucid::bench
