// SPDX-License-Identifier: Apache-2.0
//
// Functions of VTK as curves, beside VTK's own values.
#include <gtest/gtest.h>
#include <vtkDoubleArray.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mapper_core.h"
#include "override_mappers.h"
#include "pellucid/cpu/render.h"
#include "pellucid/scene/error.h"
#include "settings.h"
#include "tests/plugins_vtk/stage.h"
#include "vtkPellucidVolumeMapper.h"

namespace pellucid::test {
namespace {

using plugin::FittedCurve;
using plugin::FunctionReader;
using plugin::KeptCurves;
using plugin::Notes;
using plugin::settings_of;

struct Shape {
  double midpoint, sharpness;
};
constexpr Shape shapes[] = {{0.5, 0},    {0.3, 0},      {0.6, 0.5},  {0.2, 1},
                            {0.5, 0.02}, {0.45, 0.985}, {0.6, 0.995}};

vtkSmartPointer<vtkColorTransferFunction> colors(int space, const Shape& shape) {
  auto made = vtkSmartPointer<vtkColorTransferFunction>::New();
  made->SetColorSpace(space);
  constexpr double nodes[][4] = {
      {1, 0.9, 0.1, 0.2}, {7, 0.1, 0.6, 0.95}, {40, 0.85, 0.8, 0.05}, {90, 0.02, 0.01, 0.03}};
  for (const auto& [x, r, g, b] : nodes) {
    made->AddRGBPoint(x, r, g, b, shape.midpoint, shape.sharpness);
  }
  return made;
}

/// How far a curve is from VTK's colors, at places that are no multiples of one another.
double color_off(const FittedCurve& curve, vtkColorTransferFunction& function) {
  constexpr int count = 20'011;
  constexpr double first = 0.25 * std::numbers::e, last = 31 * std::numbers::pi;
  std::vector<double> places, truth(3 * count);
  function.GetTable(first, last, count, truth.data());
  double largest = 0;
  // On a logarithmic scale VTK's table has even logarithms.
  const bool log = function.GetScale() == VTK_CTF_LOG10;
  for (int i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / (count - 1);
    const double x = log ? first * std::pow(last / first, share) : first + share * (last - first);
    const auto at = 3 * static_cast<std::size_t>(i);
    largest =
        std::max(largest, largest_component(plugin::value_at(curve.points, x) -
                                            Rgb<double>{truth[at], truth[at + 1], truth[at + 2]}));
  }
  return largest;
}

TEST(VtkFunctions, ColorsAreVtksWithinWhatIsSaid) {
  for (int space = VTK_CTF_RGB; space <= VTK_CTF_STEP; ++space) {
    for (const int scale : {VTK_CTF_LINEAR, VTK_CTF_LOG10}) {
      for (const Shape& shape : shapes) {
        const auto function = colors(space, shape);
        function->SetScale(scale);
        for (const double tolerance : {1e-2, 1e-6}) {
          KeptCurves kept;
          Notes notes;
          const FittedCurve curve =
              FunctionReader(tolerance, kept, notes).colors(settings_of(*function), {});
          EXPECT_LE(color_off(curve, *function), curve.deviation + 1e-12)
              << space << " " << scale << " " << shape.midpoint << " " << shape.sharpness;
          // Where vtkMath's branches of Lab do not meet, more is said. Colors of CIEDE2000 are
          // steps.
          const double steps = space == VTK_CTF_LAB_CIEDE2000 ? 0.03 : 1.3e-6;
          EXPECT_LE(curve.deviation, tolerance / 16 + steps);
          EXPECT_TRUE(notes.lines().empty());
        }
      }
    }
  }
}

TEST(VtkFunctions, ColorsOutsideOfTheNodesAreVtks) {
  for (const bool clamping : {true, false}) {
    for (const bool below : {true, false}) {
      for (const bool above : {true, false}) {
        const auto function = colors(VTK_CTF_HSV, shapes[0]);
        function->SetClamping(clamping);
        function->SetUseBelowRangeColor(below);
        function->SetBelowRangeColor(0.1, 0.9, 0.3);
        function->SetUseAboveRangeColor(above);
        function->SetAboveRangeColor(0.7, 0.2, 1);
        KeptCurves kept;
        Notes notes;
        const FittedCurve curve =
            FunctionReader(1e-4, kept, notes).colors(settings_of(*function), {});
        EXPECT_LE(color_off(curve, *function), curve.deviation + 1e-12);
      }
    }
  }
}

TEST(VtkFunctions, OpacitiesAreVtksWithinWhatIsSaid) {
  constexpr double nodes[][3][2] = {{{1, 0}, {30, 0.7}, {80, 0.2}},
                                    {{2, 0.4}, {3, 0.9}, {70, 0}},
                                    {{1, -0.3}, {30, 1.4}, {80, -1}},
                                    {{5, 1}, {50, 0.99}, {90, 1}}};
  for (const Shape& shape : shapes) {
    for (const auto& list : nodes) {
      for (const bool log : {false, true}) {
        vtkNew<vtkPiecewiseFunction> function;
        for (const auto& [x, y] : list) {
          function->AddPoint(x, y, shape.midpoint, shape.sharpness);
        }
        function->SetUseLogScale(log);
        KeptCurves kept;
        Notes notes;
        const FittedCurve curve =
            FunctionReader(1e-5, kept, notes).opacities(settings_of(*function), 1, {});
        EXPECT_LE(curve.deviation, 1e-5 / 16 + 1e-12);
        const auto depth = [](double opacity) { return -std::log1p(-opacity); };
        for (int i = 0; i < 5003; ++i) {
          const double x = 0.3 + 0.02 * std::numbers::pi * std::numbers::pi * i / 10;
          const double ours = plugin::value_at(curve.points, x).r;
          const double theirs = std::clamp(function->GetValue(x), 0.0, 1.0);
          // VTK's own arithmetic loses this much where numbers of nodes cancel.
          if (std::abs(ours - theirs) <= 2e-15) continue;
          // Thin and dense opacities are followed to as much.
          if (theirs < 1e-11 || theirs > 1 - 1e-5) {
            EXPECT_NEAR(ours, theirs, 1e-5);
          } else {
            EXPECT_LE(std::abs(std::log(depth(ours) / depth(theirs))), curve.deviation + 1e-9)
                << x << " " << shape.midpoint << " " << shape.sharpness << " " << log;
          }
        }
      }
    }
  }
}

TEST(VtkFunctions, WhatLeavesTheLimitsIsCutBetweenTheNodes) {
  vtkNew<vtkPiecewiseFunction> function;
  function->AddPoint(0, 0.5);
  function->AddPoint(10, 2.5);
  function->AddPoint(20, -0.5);
  KeptCurves kept;
  Notes notes;
  FunctionReader reader(1e-3, kept, notes);
  const FittedCurve curve = reader.opacities(settings_of(*function), 1, {});
  EXPECT_EQ(curve.deviation, 0);
  for (const auto& [x, y] : {std::pair{1.0, 0.7},
                             {2.5, 1.0},
                             {10.0, 1.0},
                             {15.0, 1.0},
                             {17.5, 0.25},
                             {19.0, 0.0},
                             {25.0, 0.0}}) {
    EXPECT_NEAR(plugin::value_at(curve.points, x).r, y, 1e-14) << x;
  }
  // Extinctions of meshes have no upper limit.
  const FittedCurve extinctions =
      reader.opacities(settings_of(*function), std::numeric_limits<double>::infinity(), {});
  EXPECT_EQ(plugin::value_at(extinctions.points, 10).r, 2.5);
  EXPECT_EQ(plugin::value_at(extinctions.points, 19).r, 0);
}

/// The field of x from 0.5 to 100, one thick, along which a pixel is the function.
struct Strip {
  static constexpr int width = 257;
  Stage stage{width, 3};
  vtkNew<vtkPellucidVolumeMapper> mapper;
  vtkNew<vtkVolumeProperty> property;
  vtkVolume* volume = nullptr;

  Strip() {
    vtkNew<vtkImageData> image;
    image->SetDimensions(2, 2, 2);
    image->SetOrigin(0.5, 0, 0);
    image->SetSpacing(99.5, 99.5, 1);
    vtkNew<vtkDoubleArray> values;
    for (int i = 0; i < 8; ++i) values->InsertNextValue(i % 2 == 0 ? 0.5 : 100);
    image->GetPointData()->SetScalars(values);
    mapper->SetInputData(image);
    property->SetInterpolationTypeToLinear();
    property->SetScalarOpacityUnitDistance(1);
    volume = stage.add(mapper, property);
    stage.camera->ParallelProjectionOn();
    stage.camera->SetFocalPoint(50.25, 49.75, 0);
    stage.camera->SetPosition(50.25, 49.75, 10);
    stage.camera->SetParallelScale(1.5 * 99.5 / width);
    stage.camera->SetClippingRange(1, 100);
  }
  static double place(int pixel) { return 0.5 + (pixel + 0.5) * 99.5 / width; }
  /// The picture in floats, and the error that it says.
  std::pair<Image, double> picture(double tolerance) {
    mapper->SetTolerance(tolerance);
    const Scene scene = mapper->GetCore().scene_of(*mapper, {}, *stage.renderer, *volume);
    auto [image, report] = render(scene);
    return {std::move(image), report.largest_error};
  }
};

TEST(VtkFunctions, PicturesOfCurvesAreWithinWhatTheySay) {
  for (int space = VTK_CTF_RGB; space <= VTK_CTF_STEP; ++space) {
    for (const bool log : {false, true}) {
      Strip strip;
      const auto color = colors(space, {0.4, 0.3});
      if (log) color->SetScaleToLog10();
      vtkNew<vtkPiecewiseFunction> opacity;
      opacity->AddPoint(2, 0.1, 0.3, 0.6);
      opacity->AddPoint(95, 0.9);
      opacity->SetUseLogScale(log);
      strip.property->SetColor(color);
      strip.property->SetScalarOpacity(opacity);
      const auto [image, said] = strip.picture(1e-6);
      const bool has_steps = space == VTK_CTF_LAB_CIEDE2000;
      EXPECT_LE(said, has_steps ? 0.03 : 4e-6);
      for (int i = 0; i < Strip::width; i += has_steps ? 32 : 1) {
        const double x = Strip::place(i), a = opacity->GetValue(x);
        double c[3];
        color->GetTable(x, x, 1, c);
        for (std::size_t k = 0; k < 3; ++k) {
          EXPECT_NEAR(image.at(i, 1)[k], a * c[k], said + 1e-7) << space << " " << log << " " << x;
        }
        EXPECT_NEAR(image.at(i, 1)[3], a, said + 1e-7);
      }
    }
  }
}

TEST(VtkFunctions, EmptyOnesAreVtksRamps) {
  Strip strip;
  vtkNew<vtkPiecewiseFunction> opacity;
  vtkNew<vtkColorTransferFunction> color;
  strip.property->SetScalarOpacity(opacity);
  strip.property->SetColor(color);
  const auto [image, said] = strip.picture(1e-5);
  for (int i = 0; i < Strip::width; ++i) {
    const double share = (Strip::place(i) - 0.5) / 99.5;
    EXPECT_NEAR(image.at(i, 1)[3], share / 2, said + 1e-6);
    EXPECT_NEAR(image.at(i, 1)[0], share * share / 2, said + 1e-6);
  }
  EXPECT_EQ(opacity->GetSize(), 0);
  // The fixed-point mapper shows them as 0.
  const vtkSmartPointer<vtkFixedPointVolumeRayCastMapper> fixed =
      vtkSmartPointer<vtkFixedPointVolumeRayCastMapper>::Take(plugin::new_fixed_point_override());
  fixed->SetInputData(strip.mapper->GetInput());
  const Scene scene =
      plugin::core_of(fixed)->scene_of(*fixed, {}, *strip.stage.renderer, *strip.volume);
  const Image empty = render(scene).image;
  for (const auto& pixel : empty.pixels) EXPECT_EQ(pixel[3], 0);
}

TEST(VtkFunctions, UnknownColorSpacesAreRefused) {
  imported::ShapedFunction function;
  function.is_color = true;
  function.space = 6;  // of VTK 9.4
  function.nodes = {{0, {0, 0, 0}}, {1, {1, 1, 1}}};
  EXPECT_THROW(imported::fit(function, 1e-3), Error);
}

TEST(VtkFunctions, WhatVtkDoesOtherwiseIsCounted) {
  imported::ShapedFunction function;
  function.nodes = {{0, {0.2, 0.2, 0.2}}, {1, {0.4, 0.4, 0.4}}};
  function.is_color = true;
  const auto own = [](double first, double, int) -> std::vector<Rgb<double>> {
    const double value = 0.2 + 0.2 * first + 0.01 * first * (1 - first);
    return {{value, value, value}};
  };
  const FittedCurve curve = imported::fit(function, 1e-3, {}, own);
  EXPECT_GE(curve.deviation, 0.0025);
}

TEST(VtkGrids, DescendingCoordinatesAreTurned) {
  const auto grid = [](bool descends) {
    auto made = vtkSmartPointer<vtkRectilinearGrid>::New();
    made->SetDimensions(4, 3, 2);
    const int sides[] = {4, 3, 2};
    vtkNew<vtkDoubleArray> axes[3], values;
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i < sides[axis]; ++i) {
        const int k = descends && axis != 1 ? sides[axis] - 1 - i : i;
        axes[axis]->InsertNextValue(k * (k + 1.0 + axis));
      }
    }
    made->SetXCoordinates(axes[0]);
    made->SetYCoordinates(axes[1]);
    made->SetZCoordinates(axes[2]);
    for (vtkIdType i = 0; i < made->GetNumberOfPoints(); ++i) {
      double p[3];
      made->GetPoint(i, p);
      values->InsertNextValue(std::sin(p[0]) + 3 * std::cos(p[1]) + p[2]);
    }
    made->GetPointData()->SetScalars(values);
    return made;
  };
  plugin::KeptGrids kept;
  const auto there = grid(false), back = grid(true);
  const auto a = kept.find(*there, *there->GetPointData()->GetScalars(), false, 0);
  const auto b = kept.find(*back, *back->GetPointData()->GetScalars(), false, 0);
  EXPECT_EQ(a->description().coordinates, b->description().coordinates);
  EXPECT_TRUE(std::ranges::equal(std::get<DataArray<double>>(a->data()),
                                 std::get<DataArray<double>>(b->data())));
  // Kept as others are.
  kept.keep_used();
  EXPECT_EQ(kept.find(*back, *back->GetPointData()->GetScalars(), false, 0), b);
}

}  // namespace
}  // namespace pellucid::test
