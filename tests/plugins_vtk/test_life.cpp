// SPDX-License-Identifier: Apache-2.0
//
// Data that change, pictures that are cut short, objects that end, and input that is wrong.
#include <gtest/gtest.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCommand.h>
#include <vtkCullerCollection.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartVolumeMapper.h>
#include <vtkStringArray.h>
#include <vtkTransform.h>
#include <vtkUnstructuredGrid.h>
#include <vtkWeakPointer.h>

#include <chrono>
#include <limits>

#include "mapper_core.h"
#include "tests/plugins_vtk/stage.h"
#include "vtkPellucidFactory.h"
#include "vtkPellucidUnstructuredGridMapper.h"
#include "vtkPellucidVolumeMapper.h"

namespace pellucid::test {
namespace {

double brightness(const Image& image) {
  double sum = 0;
  for (const auto& pixel : image.pixels) sum += double{pixel[0]} + double{pixel[1]};
  return sum / static_cast<double>(image.pixels.size());
}

TEST(VtkLife, DataAreUsedWhereTheyLieAndReadAnewWhenTheyChange) {
  Stage stage;
  vtkNew<vtkPellucidVolumeMapper> mapper;
  const auto image = ball_image();
  mapper->SetInputData(image);
  vtkVolume* const volume = stage.add(mapper, soft_property());
  stage.look();
  const double before = brightness(stage.picture());
  auto* const values = vtkFloatArray::SafeDownCast(image->GetPointData()->GetScalars());
  plugin::MapperCore& core = mapper->GetCore();
  const Scene scene = core.scene_of(*mapper, {}, *stage.renderer, *volume);
  const auto& shown = std::get<VolumeContent>(scene.layers.at(0).content).volume->data();
  EXPECT_EQ(static_cast<const void*>(std::get<DataArray<float>>(shown).data()),
            values->GetVoidPointer(0));

  stage.camera->Azimuth(10);
  volume->GetProperty()->SetAmbient(0.3);
  stage.picture();
  EXPECT_EQ(core.data_made(), 1);
  for (vtkIdType i = 0; i < values->GetNumberOfValues(); ++i) {
    values->SetValue(i, 0.5F * values->GetValue(i));
  }
  values->Modified();
  stage.camera->Azimuth(-10);
  const double after = brightness(stage.picture());
  EXPECT_EQ(core.data_made(), 2);
  EXPECT_LT(after, 0.8 * before);
  image->SetSpacing(2, 1.5, 2);
  stage.picture();
  EXPECT_EQ(core.data_made(), 3);
}

TEST(VtkLife, AFunctionThatChangesIsSeen) {
  Stage stage;
  vtkNew<vtkPellucidVolumeMapper> mapper;
  mapper->SetInputData(ball_image());
  vtkVolume* const volume = stage.add(mapper, soft_property());
  stage.look();
  const double before = brightness(stage.picture());
  volume->GetProperty()->GetScalarOpacity()->AddPoint(100, 0.9);
  EXPECT_GT(brightness(stage.picture()), 1.01 * before);
  volume->GetProperty()->GetRGBTransferFunction()->AddRGBPoint(60, 0, 0, 0);
  EXPECT_LT(brightness(stage.picture()), before);
}

TEST(VtkLife, WhileTheUserInteractsPicturesComeInTimeAndAreExactWhenStill) {
  Stage stage(400, 300);
  vtkNew<vtkPellucidVolumeMapper> mapper;
  mapper->SetInputData(ball_image(48));
  stage.add(mapper, soft_property());
  mapper->SetTolerance(1e-5);
  stage.look();
  stage.picture();
  const double exact_seconds = mapper->GetCore().outcome.seconds;
  EXPECT_TRUE(mapper->GetExact());
  const double exact = brightness(stage.picture());

  stage.window->SetDesiredUpdateRate(20 / exact_seconds);
  const double coarse = brightness(stage.picture());
  EXPECT_FALSE(mapper->GetExact());
  EXPECT_TRUE(std::isinf(mapper->GetLargestError()));
  EXPECT_LT(mapper->GetCore().outcome.seconds, 0.7 * exact_seconds);
  EXPECT_NEAR(coarse, exact, 0.1 * exact);

  stage.window->SetDesiredUpdateRate(0.0001);
  EXPECT_EQ(brightness(stage.picture()), exact);
  EXPECT_TRUE(mapper->GetExact());
  EXPECT_LE(mapper->GetLargestError(), 1e-5);
}

TEST(VtkLife, AStillPictureCanBeAborted) {
  Stage stage(400, 300);
  vtkNew<vtkPellucidVolumeMapper> mapper;
  mapper->SetInputData(ball_image(48));
  stage.add(mapper, soft_property());
  mapper->SetTolerance(1e-5);
  stage.look();
  int asked = 0;
  vtkNew<vtkCallbackCommand> abort;
  abort->SetClientData(&asked);
  abort->SetCallback([](vtkObject* window, unsigned long, void* count, void*) {
    if (++*static_cast<int*>(count) > 3) static_cast<vtkRenderWindow*>(window)->SetAbortRender(1);
  });
  stage.window->AddObserver(vtkCommand::AbortCheckEvent, abort);
  stage.picture();
  EXPECT_GT(asked, 3);
  EXPECT_FALSE(mapper->GetExact());
}

TEST(VtkLife, NothingIsLeftWhenItEnds) {
  vtkWeakPointer<vtkDataArray> values, labels;
  vtkWeakPointer<vtkObject> mapper_left, property_left;
  for (const bool by_factory : {false, true}) {
    vtkPellucidFactory::Use(by_factory);
    {
      Stage stage;
      const auto image = ball_image(), mask = ball_image();
      values = image->GetPointData()->GetScalars();
      labels = mask->GetPointData()->GetScalars();
      for (vtkIdType i = 0; i < labels->GetNumberOfTuples(); ++i)
        labels->SetTuple1(i, i % 2 == 0 ? 0 : 1);
      vtkSmartPointer<vtkVolumeMapper> mapper;
      if (by_factory) {
        vtkNew<vtkSmartVolumeMapper> smart;
        mapper = smart;
      } else {
        vtkNew<vtkPellucidVolumeMapper> ours;
        ours->SetMaskInput(mask);
        mapper = ours;
      }
      mapper->SetInputDataObject(image);
      const auto property = soft_property();
      stage.add(mapper, property);
      stage.look();
      EXPECT_GT(brightness(stage.picture()), 0.01);
      mapper_left = mapper;
      property_left = property;
      EXPECT_EQ(vtkPellucidFactory::Has(mapper), true);
    }
    vtkPellucidFactory::Use(false);
    EXPECT_EQ(values, nullptr);
    EXPECT_EQ(labels, nullptr);
    EXPECT_EQ(mapper_left, nullptr);
    EXPECT_EQ(property_left, nullptr);
  }
}

TEST(VtkLife, TheFactoryMakesOursAndLetsGoOfThem) {
  const auto name = [] {
    vtkNew<vtkGPUVolumeRayCastMapper> mapper;
    return std::string(mapper->GetClassName());
  };
  const std::string before = name();
  vtkPellucidFactory::Use();
  vtkPellucidFactory::Use();
  vtkNew<vtkGPUVolumeRayCastMapper> ours;
  EXPECT_TRUE(vtkPellucidFactory::Has(ours));
  EXPECT_NE(name(), before);
  vtkPellucidFactory::Use(false);
  EXPECT_EQ(name(), before);
  EXPECT_TRUE(vtkPellucidFactory::Set(ours, "Tolerance", 0.25));
  EXPECT_EQ(vtkPellucidFactory::Get(ours, "Tolerance"), 0.25);
  EXPECT_FALSE(vtkPellucidFactory::Set(ours, "Tolerance", std::nan("")));
  EXPECT_FALSE(vtkPellucidFactory::Set(ours, "LargestError", 1));
  EXPECT_FALSE(vtkPellucidFactory::Set(ours, nullptr, 1));
  EXPECT_TRUE(std::isnan(vtkPellucidFactory::Get(ours, "tolerance")));
  EXPECT_TRUE(std::isnan(vtkPellucidFactory::Get(nullptr, "Tolerance")));
}

/// A volume that cannot be shown: one error, that says what, and a window that is as black as
/// before.
struct BadCase {
  const char* name;
  void (*spoil)(Stage&, vtkImageData*, vtkVolumeProperty*, vtkPellucidVolumeMapper*);
  const char* says;
};

void PrintTo(const BadCase& bad, std::ostream* to) {
  *to << bad.name;
}

vtkFloatArray* values_of(vtkImageData* image) {
  return vtkFloatArray::SafeDownCast(image->GetPointData()->GetScalars());
}

class VtkBad : public testing::TestWithParam<BadCase> {};

TEST_P(VtkBad, IsSaidOnceAndDrawsNothing) {
  Stage stage;
  vtkNew<vtkPellucidVolumeMapper> mapper;
  const auto image = ball_image();
  const auto property = soft_property();
  mapper->SetInputData(image);
  stage.add(mapper, property);
  stage.look();
  GetParam().spoil(stage, image, property, mapper);
  const Messages messages;
  EXPECT_EQ(brightness(stage.picture()), 0);
  EXPECT_EQ(brightness(stage.picture()), 0);
  const std::string said = messages.text();
  const auto at = said.find(GetParam().says);
  ASSERT_NE(at, std::string::npos) << said;
  EXPECT_EQ(said.find(GetParam().says, at + 1), std::string::npos) << said;
  EXPECT_TRUE(std::isinf(mapper->GetLargestError()));
  EXPECT_EQ(stage.gl_errors(), "");
}

INSTANTIATE_TEST_SUITE_P(
    Input, VtkBad,
    testing::Values(
        BadCase{"nearest",
                [](Stage&, vtkImageData*, vtkVolumeProperty* property, vtkPellucidVolumeMapper*) {
                  property->SetInterpolationTypeToNearest();
                },
                "SetInterpolationTypeToLinear"},
        BadCase{"no_values",
                [](Stage&, vtkImageData* image, vtkVolumeProperty*, vtkPellucidVolumeMapper*) {
                  image->GetPointData()->Initialize();
                },
                "no values to show"},
        BadCase{"too_few_values",
                [](Stage&, vtkImageData* image, vtkVolumeProperty*, vtkPellucidVolumeMapper*) {
                  values_of(image)->SetNumberOfTuples(100);
                },
                "100"},
        BadCase{"infinite",
                [](Stage&, vtkImageData* image, vtkVolumeProperty*, vtkPellucidVolumeMapper*) {
                  values_of(image)->SetValue(7, std::numeric_limits<float>::infinity());
                },
                "infinite"},
        BadCase{"flat",
                [](Stage&, vtkImageData* image, vtkVolumeProperty*, vtkPellucidVolumeMapper*) {
                  image->SetDimensions(24, 576, 1);
                },
                "single point"},
        BadCase{"singular",
                [](Stage& stage, vtkImageData*, vtkVolumeProperty*, vtkPellucidVolumeMapper*) {
                  vtkNew<vtkTransform> transform;
                  transform->Scale(1, 0, 1);
                  vtkVolume::SafeDownCast(stage.renderer->GetVolumes()->GetItemAsObject(0))
                      ->SetUserTransform(transform);
                },
                "singular"},
        BadCase{"additive",
                [](Stage&, vtkImageData*, vtkVolumeProperty*, vtkPellucidVolumeMapper* mapper) {
                  mapper->SetBlendModeToAdditive();
                },
                "additive"},
        BadCase{"slice_without_plane",
                [](Stage&, vtkImageData*, vtkVolumeProperty*, vtkPellucidVolumeMapper* mapper) {
                  mapper->SetBlendModeToSlice();
                },
                "SetSliceFunction"},
        BadCase{"mask_of_another_size",
                [](Stage&, vtkImageData*, vtkVolumeProperty*, vtkPellucidVolumeMapper* mapper) {
                  const auto mask = ball_image(5);
                  values_of(mask)->Fill(1);
                  mapper->SetMaskInput(mask);
                },
                "the mask is not on the grid"},
        BadCase{"sheared_camera",
                [](Stage& stage, vtkImageData*, vtkVolumeProperty*, vtkPellucidVolumeMapper*) {
                  stage.camera->SetViewShear(0.5, 0, 1);
                },
                "ViewShear"},
        BadCase{"two_eyes",
                [](Stage& stage, vtkImageData*, vtkVolumeProperty*, vtkPellucidVolumeMapper*) {
                  stage.window->SetStereoTypeToAnaglyph();
                  stage.window->StereoRenderOn();
                },
                "StereoRenderOff"},
        BadCase{"peeled_volumes",
                [](Stage& stage, vtkImageData*, vtkVolumeProperty*, vtkPellucidVolumeMapper*) {
                  stage.renderer->UseDepthPeelingOn();
                  stage.renderer->UseDepthPeelingForVolumesOn();
                },
                "UseDepthPeelingForVolumesOff"},
        BadCase{"far_window",
                [](Stage& stage, vtkImageData*, vtkVolumeProperty*, vtkPellucidVolumeMapper*) {
                  stage.camera->SetWindowCenter(300, 300);
                  stage.renderer->GetCullers()->RemoveAllItems();
                },
                "take fewer tiles"},
        BadCase{
            "dependent_components",
            [](Stage&, vtkImageData* image, vtkVolumeProperty* property, vtkPellucidVolumeMapper*) {
              vtkNew<vtkFloatArray> both;
              both->SetNumberOfComponents(2);
              both->SetNumberOfTuples(image->GetNumberOfPoints());
              both->Fill(50);
              image->GetPointData()->SetScalars(both);
              property->IndependentComponentsOff();
            },
            "dependent components"}),
    [](const auto& made) { return std::string(made.param.name); });

TEST(VtkLife, AMapperWithoutDataDrawsNothing) {
  Stage stage;
  vtkNew<vtkPellucidVolumeMapper> mapper;
  vtkVolume* const volume = stage.add(mapper, soft_property());
  const Messages messages;
  EXPECT_EQ(brightness(stage.picture()), 0);
  mapper->Render(stage.renderer, volume);
  vtkNew<vtkRectilinearGrid> grid;
  grid->SetDimensions(3, 3, 3);
  vtkNew<vtkFloatArray> values;
  values->SetNumberOfTuples(27);
  values->Fill(50);
  grid->GetPointData()->SetScalars(values);
  mapper->SetInputData(grid);
  EXPECT_EQ(messages.text().find("Pellucid draws"), std::string::npos) << messages.text();
  mapper->Render(stage.renderer, volume);
  EXPECT_NE(messages.text().find("coordinates for 3 points"), std::string::npos) << messages.text();
}

TEST(VtkLife, ValuesThatAreNotNumbersAreVacuum) {
  Stage stage;
  vtkNew<vtkPellucidVolumeMapper> mapper;
  const auto image = ball_image();
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i) {
    values_of(image)->SetValue(i, std::numeric_limits<float>::quiet_NaN());
  }
  mapper->SetInputData(image);
  stage.add(mapper, soft_property());
  stage.look();
  const Messages messages;
  EXPECT_EQ(brightness(stage.picture()), 0);
  EXPECT_EQ(messages.text(), "");
}

TEST(VtkLife, AMeshWithADamagedCellSaysSo) {
  Stage stage;
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  for (const auto& p : {std::array{0., 0., 0.}, {1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}}) {
    points->InsertNextPoint(p.data());
  }
  grid->SetPoints(points);
  const vtkIdType ids[4] = {0, 1, 2, 3};
  grid->InsertNextCell(VTK_TETRA, 4, ids);
  vtkNew<vtkDoubleArray> values;
  values->SetName("v");
  for (const double value : {0., 50., 80., 100.}) values->InsertNextValue(value);
  grid->GetPointData()->SetScalars(values);
  vtkNew<vtkPellucidUnstructuredGridMapper> mapper;
  mapper->SetInputData(grid);
  stage.add(mapper, soft_property(0.05));
  stage.look();
  const Messages messages;
  EXPECT_GT(brightness(stage.picture()), 0.01);
  EXPECT_EQ(messages.text(), "");
  EXPECT_EQ(mapper->GetCore().data_made(), 1);
  stage.picture();
  EXPECT_EQ(mapper->GetCore().data_made(), 1);
  values->SetNumberOfTuples(2);
  values->Modified();
  EXPECT_EQ(brightness(stage.picture()), 0);
  EXPECT_NE(messages.text().find("Pellucid draws nothing"), std::string::npos);
}

}  // namespace
}  // namespace pellucid::test
