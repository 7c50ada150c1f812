// SPDX-License-Identifier: Apache-2.0
//
// Data that change, pictures that are cut short, objects that end, and input that is wrong.
#include <gtest/gtest.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCommand.h>
#include <vtkContourValues.h>
#include <vtkCullerCollection.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkLight.h>
#include <vtkMatrix4x4.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartVolumeMapper.h>
#include <vtkStringArray.h>
#include <vtkTransform.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkWeakPointer.h>

#include <algorithm>
#include <array>
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
  Stage stage(1000, 800);  // so long that a busy machine asks several times
  vtkNew<vtkPellucidVolumeMapper> mapper;
  mapper->SetInputData(ball_image(48));
  stage.add(mapper, soft_property());
  mapper->SetTolerance(1e-6);
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

/// Sets an explicit projection, by which no volume is culled.
void project(Stage& stage, vtkMatrix4x4* matrix) {
  stage.camera->SetExplicitProjectionTransformMatrix(matrix);
  stage.camera->UseExplicitProjectionTransformMatrixOn();
  stage.renderer->GetCullers()->RemoveAllItems();
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
        BadCase{"pixels_that_are_not_square",
                [](Stage& stage, vtkImageData*, vtkVolumeProperty*, vtkPellucidVolumeMapper*) {
                  stage.camera->SetExplicitAspectRatio(0.5);
                  stage.camera->UseExplicitAspectRatioOn();
                },
                "pixels are not square"},
        BadCase{"no_frustum",
                [](Stage& stage, vtkImageData*, vtkVolumeProperty*, vtkPellucidVolumeMapper*) {
                  vtkNew<vtkMatrix4x4> matrix;
                  matrix->SetElement(0, 1, 0.2);
                  project(stage, matrix);
                },
                "take a frustum"},
        BadCase{"near_behind_the_camera",
                [](Stage& stage, vtkImageData*, vtkVolumeProperty*, vtkPellucidVolumeMapper*) {
                  const double near = -5, far = 60;
                  vtkNew<vtkMatrix4x4> matrix;
                  matrix->SetElement(0, 0, 2);
                  matrix->SetElement(1, 1, 3);
                  matrix->SetElement(2, 2, -(far + near) / (far - near));
                  matrix->SetElement(2, 3, -2 * far * near / (far - near));
                  matrix->SetElement(3, 2, -1);
                  matrix->SetElement(3, 3, 0);
                  project(stage, matrix);
                },
                "begins behind the camera"},
        BadCase{"near_behind_far",
                [](Stage& stage, vtkImageData*, vtkVolumeProperty*, vtkPellucidVolumeMapper*) {
                  vtkNew<vtkMatrix4x4> matrix;  // z is not turned around
                  matrix->SetElement(0, 0, 0.02);
                  matrix->SetElement(1, 1, 0.03);
                  project(stage, matrix);
                },
                "nothing from near to far"},
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
              both->SetNumberOfComponents(3);
              both->SetNumberOfTuples(image->GetNumberOfPoints());
              both->Fill(50);
              image->GetPointData()->SetScalars(both);
              property->IndependentComponentsOff();
            },
            "dependent components: the array has 3"}),
    [](const auto& made) { return std::string(made.param.name); });

/// A setting that is none, beside which the rest can be drawn: it is said once.
class VtkOdd : public testing::TestWithParam<BadCase> {};

TEST_P(VtkOdd, IsSaidOnceAndTheRestIsDrawn) {
  Stage stage;
  vtkNew<vtkPellucidVolumeMapper> mapper;
  const auto image = ball_image();
  const auto property = soft_property();
  mapper->SetInputData(image);
  stage.add(mapper, property);
  stage.look();
  GetParam().spoil(stage, image, property, mapper);
  const Messages messages;
  for (int frame = 0; frame < 2; ++frame) {
    const Image picture = stage.picture();
    EXPECT_GT(std::ranges::count_if(
                  picture.pixels,
                  [](const auto& p) { return p[0] > 0.1F || p[1] > 0.1F || p[2] > 0.1F; }),
              50);
  }
  const std::string said = messages.text();
  const auto at = said.find(GetParam().says);
  ASSERT_NE(at, std::string::npos) << said;
  EXPECT_EQ(said.find(GetParam().says, at + 1), std::string::npos) << said;
  EXPECT_EQ(said.find("draws nothing"), std::string::npos) << said;
  EXPECT_TRUE(mapper->GetExact());
  EXPECT_EQ(mapper->GetPixelsOver(), 0);
}

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

void set_node(vtkPiecewiseFunction* function, int index, std::array<double, 4> node) {
  function->SetNodeValue(index, node.data());
}

INSTANTIATE_TEST_SUITE_P(
    Settings, VtkOdd,
    testing::Values(
        BadCase{"opacity_nan",
                [](Stage&, vtkImageData*, vtkVolumeProperty* property, vtkPellucidVolumeMapper*) {
                  set_node(property->GetScalarOpacity(), 1, {50, not_a_number, 0.5, 0});
                },
                "nodes of functions that are no numbers"},
        BadCase{"color_nan",
                [](Stage&, vtkImageData*, vtkVolumeProperty* property, vtkPellucidVolumeMapper*) {
                  double node[6] = {60, 1, not_a_number, 0, 0.5, 0};
                  property->GetRGBTransferFunction()->SetNodeValue(1, node);
                },
                "nodes of functions that are no numbers"},
        BadCase{"unit_distance_0",
                [](Stage&, vtkImageData*, vtkVolumeProperty* property, vtkPellucidVolumeMapper*) {
                  property->SetScalarOpacityUnitDistance(0);
                },
                "a unit distance of 0"},
        BadCase{"unit_distance_nan",
                [](Stage&, vtkImageData*, vtkVolumeProperty* property, vtkPellucidVolumeMapper*) {
                  property->SetScalarOpacityUnitDistance(not_a_number);
                },
                "no positive number"},
        BadCase{"unit_distance_negative",
                [](Stage&, vtkImageData*, vtkVolumeProperty* property, vtkPellucidVolumeMapper*) {
                  property->SetScalarOpacityUnitDistance(-2);
                },
                "no positive number"},
        BadCase{"shading",
                [](Stage&, vtkImageData*, vtkVolumeProperty* property, vtkPellucidVolumeMapper*) {
                  property->ShadeOn();
                  property->SetDiffuse(not_a_number);
                  property->SetSpecular(-0.5);
                },
                "a number of the shading"},
        BadCase{
            "light",
            [](Stage& stage, vtkImageData*, vtkVolumeProperty* property, vtkPellucidVolumeMapper*) {
              property->ShadeOn();
              vtkNew<vtkLight> light, head;
              light->SetLightTypeToSceneLight();
              light->SetIntensity(not_a_number);
              head->SetLightTypeToHeadlight();
              stage.renderer->AddLight(light);
              stage.renderer->AddLight(head);
            },
            "light: a color is"},
        BadCase{"clipping_plane",
                [](Stage&, vtkImageData*, vtkVolumeProperty*, vtkPellucidVolumeMapper* mapper) {
                  vtkNew<vtkPlane> plane;
                  plane->SetNormal(0, 0, 0);
                  mapper->AddClippingPlane(plane);
                },
                "the plane is left out"},
        BadCase{"isovalue",
                [](Stage&, vtkImageData*, vtkVolumeProperty* property,
                   vtkPellucidVolumeMapper* mapper) {
                  mapper->SetBlendModeToIsoSurface();
                  property->GetIsoSurfaceValues()->SetValue(0, not_a_number);
                  property->GetIsoSurfaceValues()->SetValue(1, 90);
                  property->GetIsoSurfaceValues()->SetValue(2, 90);
                },
                "isosurfaces at values"},
        BadCase{"final_window",
                [](Stage&, vtkImageData*, vtkVolumeProperty*, vtkPellucidVolumeMapper* mapper) {
                  mapper->SetFinalColorWindow(0);
                },
                "the window of the final color"},
        BadCase{"nearest_in_light",
                [](Stage&, vtkImageData*, vtkVolumeProperty* property, vtkPellucidVolumeMapper*) {
                  property->SetInterpolationTypeToNearest();
                  property->ShadeOn();
                },
                "nearest values are shown without light"}),
    [](const auto& made) { return std::string(made.param.name); });

/// Return false where VTK is older than the setting.
template <class Mapper>
bool take_normals_of_opacity(Mapper& mapper) {
  if constexpr (requires { mapper.SetComputeNormalFromOpacity(true); }) {
    mapper.SetComputeNormalFromOpacity(true);
    return true;
  }
  return false;
}

template <class Mapper>
bool scatter(Mapper& mapper) {
  if constexpr (requires { mapper.SetVolumetricScatteringBlending(1.0F); }) {
    mapper.SetVolumetricScatteringBlending(1.0F);
    return true;
  }
  return false;
}

TEST(VtkLife, LightThatNewerVersionsHaveIsSaidToBeLeftOut) {
  vtkPellucidFactory::Use();
  vtkNew<vtkGPUVolumeRayCastMapper> mapper;
  vtkPellucidFactory::Use(false);
  if (!take_normals_of_opacity(*mapper) || !scatter(*mapper)) {
    GTEST_SKIP() << "this VTK has no such light";
  }
  mapper->SetInputData(ball_image());
  const auto property = soft_property();
  property->ShadeOn();
  Stage stage;
  stage.add(mapper, property);
  stage.look();
  const Messages messages;
  stage.picture();
  for (const char* const setting : {"ComputeNormalFromOpacity", "VolumetricScatteringBlending"}) {
    EXPECT_NE(messages.text().find(std::string(setting) + " is left out"), std::string::npos)
        << messages.text();
  }
}

TEST(VtkLife, AUnitDistanceOf0IsOpaqueAndOneThatIsNoNumberIsOne) {
  const auto with_unit = [](double unit) {
    Stage stage;
    vtkNew<vtkPellucidVolumeMapper> mapper;
    mapper->SetInputData(ball_image());
    stage.add(mapper, soft_property(unit));
    stage.look();
    const Messages messages;
    return stage.picture();
  };
  // Blue where the data are above 0, from the outermost value on.
  const Image one = with_unit(1), close = with_unit(1e-6), zero = with_unit(0);
  EXPECT_EQ(largest_difference(with_unit(not_a_number), one), 0);
  EXPECT_EQ(largest_difference(with_unit(-3), one), 0);
  EXPECT_GT(largest_difference(one, zero), 0.3);
  EXPECT_EQ(largest_difference(close, zero), 0);
  const auto is_blue = [](const auto& pixel) { return pixel[2] > 0.9F && pixel[0] < 0.1F; };
  EXPECT_GT(std::ranges::count_if(zero.pixels, is_blue), 500);
  EXPECT_EQ(std::ranges::count_if(one.pixels, is_blue), 0);
}

TEST(VtkLife, ValuesThatChangeInPlaceAreSeenWithoutModified) {
  Stage stage;
  vtkNew<vtkPellucidVolumeMapper> mapper;
  const auto image = ball_image();
  mapper->SetInputData(image);
  stage.add(mapper, soft_property());
  stage.look();
  const double before = brightness(stage.picture());
  EXPECT_EQ(mapper->GetCore().data_made(), 1);
  vtkFloatArray* const values = values_of(image);
  for (vtkIdType i = 0; i < values->GetNumberOfValues(); ++i) {
    *values->GetPointer(i) *= 0.5F;
  }
  EXPECT_LT(brightness(stage.picture()), 0.8 * before);
  EXPECT_EQ(mapper->GetCore().data_made(), 2);
  stage.picture();
  EXPECT_EQ(mapper->GetCore().data_made(), 2);
}

/// What a callback of the check for an abort may do to a scene that is being drawn.
struct SceneChange {
  const char* name;
  void (*change)(Stage&, vtkVolume*, vtkPellucidVolumeMapper*);
};

void PrintTo(const SceneChange& change, std::ostream* to) {
  *to << change.name;
}

class VtkAbort : public testing::TestWithParam<SceneChange> {};

TEST_P(VtkAbort, MayChangeTheScene) {
  Stage stage(300, 200);
  auto mapper = vtkSmartPointer<vtkPellucidVolumeMapper>::New();
  mapper->SetInputData(ball_image(48));
  mapper->SetTolerance(1e-5);
  stage.add(mapper, soft_property());
  stage.look();
  struct Context {
    Stage& stage;
    vtkWeakPointer<vtkPellucidVolumeMapper> mapper;
    int asked = 0;
  } context{stage, mapper.Get()};
  mapper = nullptr;
  vtkNew<vtkCallbackCommand> change;
  change->SetClientData(&context);
  change->SetCallback([](vtkObject*, unsigned long, void* client, void*) {
    auto& c = *static_cast<Context*>(client);
    if (++c.asked != 1) return;
    GetParam().change(c.stage,
                      vtkVolume::SafeDownCast(c.stage.renderer->GetVolumes()->GetItemAsObject(0)),
                      c.mapper);
  });
  stage.window->AddObserver(vtkCommand::AbortCheckEvent, change);
  stage.picture();
  EXPECT_GE(context.asked, 1);
  stage.window->RemoveAllObservers();
  // What was taken from the scene is let go of.
  stage.picture();
  stage.renderer->RemoveAllViewProps();
  stage.renderer->GetVolumes();  // which the renderer keeps a list of
  EXPECT_EQ(context.mapper, nullptr);
}

INSTANTIATE_TEST_SUITE_P(
    Changes, VtkAbort,
    testing::Values(
        SceneChange{"sets_no_mapper", [](Stage&, vtkVolume* volume,
                                         vtkPellucidVolumeMapper*) { volume->SetMapper(nullptr); }},
        SceneChange{"sets_another_mapper",
                    [](Stage&, vtkVolume* volume, vtkPellucidVolumeMapper*) {
                      vtkNew<vtkPellucidVolumeMapper> other;
                      other->SetInputData(ball_image(8));
                      volume->SetMapper(other);
                    }},
        SceneChange{"removes_the_volume",
                    [](Stage& stage, vtkVolume* volume, vtkPellucidVolumeMapper*) {
                      stage.renderer->RemoveVolume(volume);
                    }},
        SceneChange{"removes_all",
                    [](Stage& stage, vtkVolume* volume, vtkPellucidVolumeMapper*) {
                      volume->SetMapper(nullptr);
                      stage.renderer->RemoveAllViewProps();
                    }},
        SceneChange{"takes_the_data",
                    [](Stage&, vtkVolume*, vtkPellucidVolumeMapper* mapper) {
                      mapper->SetInputData(static_cast<vtkImageData*>(nullptr));
                    }},
        SceneChange{"draws_again",
                    [](Stage& stage, vtkVolume* volume, vtkPellucidVolumeMapper* mapper) {
                      mapper->Render(stage.renderer, volume);
                    }}),
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
  // Another process has it, and shows it.
  grid->AllocateCellGhostArray()->SetValue(0, vtkDataSetAttributes::DUPLICATECELL);
  EXPECT_EQ(brightness(stage.picture()), 0);
  EXPECT_TRUE(mapper->GetExact());
  EXPECT_EQ(messages.text(), "");
  values->SetNumberOfTuples(2);
  values->Modified();
  EXPECT_EQ(brightness(stage.picture()), 0);
  EXPECT_NE(messages.text().find("Pellucid draws nothing"), std::string::npos);
}

}  // namespace
}  // namespace pellucid::test
