// SPDX-License-Identifier: Apache-2.0
//
// What VTK's settings become in a scene, beside scenes that are made by hand.
#include <gtest/gtest.h>
#include <vtkContourValues.h>
#include <vtkFloatArray.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkUnsignedCharArray.h>

#include "mapper_core.h"
#include "pellucid/cpu/render.h"
#include "pellucid/scene/opacity_table.h"
#include "tests/plugins_vtk/stage.h"
#include "vtkPellucidVolumeMapper.h"

namespace pellucid::test {
namespace {

constexpr double half_a_step = 0.5 / 255;
constexpr double rounding = 1.0 / 32767;

std::shared_ptr<const Volume> volume_of(vtkImageData* image, int component = 0) {
  Volume::Description grid;
  grid.dimensions = {image->GetDimensions()[0], image->GetDimensions()[1],
                     image->GetDimensions()[2]};
  grid.placement.origin = {3, -2, 1};
  grid.placement.spacing = {1, 1.5, 2};
  grid.name = "by hand";
  std::vector<float> values;
  vtkDataArray* const array = image->GetPointData()->GetScalars();
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i) {
    values.push_back(static_cast<float>(array->GetComponent(i, component)));
  }
  return std::make_shared<const Volume>(grid, std::move(values));
}

/// soft_property() as a table of opacities.
std::shared_ptr<const TransferFunction> soft_function(double unit = 1) {
  const std::vector<OpacityPoint> points{{0, 0, {0, 0, 1}},
                                         {50, 0.02, {5.0 / 6, 2.5 / 6, 1.0 / 6}},
                                         {60, 0.056, {1, 0.5, 0}},
                                         {100, 0.2, {1, 1, 1}}};
  return std::make_shared<const TransferFunction>(
      transfer_function_from_opacity_table(points, unit, 1e-6));
}

/// A scene as the stage's camera sees it.
Scene scene_on(Stage& stage, std::vector<Layer> layers) {
  Scene scene;
  scene.layers = std::move(layers);
  const int* const size = stage.window->GetSize();
  scene.size = {size[0], size[1]};
  const auto vector = [](const double v[3]) { return Vec3<double>{v[0], v[1], v[2]}; };
  scene.camera.position = vector(stage.camera->GetPosition());
  scene.camera.focal_point = vector(stage.camera->GetFocalPoint());
  scene.camera.up = vector(stage.camera->GetViewUp());
  scene.camera.vertical_angle = stage.camera->GetViewAngle();
  scene.integration.set_tolerance(1e-5);
  return scene;
}

struct Shown {
  Stage stage;
  vtkNew<vtkPellucidVolumeMapper> mapper;
  vtkSmartPointer<vtkImageData> image = ball_image();
  vtkSmartPointer<vtkVolumeProperty> property = soft_property();
  vtkVolume* volume = nullptr;

  Shown() {
    mapper->SetInputData(image);
    volume = stage.add(mapper, property);
  }
  void expect(std::vector<Layer> layers, double least_brightness = 0.1) {
    stage.look();
    const Image picture = stage.picture();
    EXPECT_EQ(stage.gl_errors(), "");
    EXPECT_EQ(mapper->GetPixelsOver(), 0);
    const Image truth = render(scene_on(stage, std::move(layers)));
    EXPECT_LE(largest_difference(picture, truth),
              half_a_step + rounding + mapper->GetTolerance() + 2e-5);
    double brightest = 0;
    for (const auto& pixel : truth.pixels) brightest = std::max(brightest, double{pixel[0]});
    EXPECT_GT(brightest, least_brightness);
  }
};

TEST(VtkLooks, AVolumeByHandIsTheSame) {
  Shown shown;
  shown.expect({Layer{VolumeContent{volume_of(shown.image), soft_function()}}});
}

/// The boxes of cropping, each region by itself.
class VtkCropping : public testing::TestWithParam<int> {};

TEST_P(VtkCropping, ShowsTheRegionsOfItsFlags) {
  const double planes[6] = {9.7, 19.4, 6.2, 24.9, 14.8, 33.1};
  Shown shown;
  shown.mapper->CroppingOn();
  shown.mapper->SetCroppingRegionFlags(GetParam());
  shown.mapper->SetCroppingRegionPlanes(planes);
  std::vector<Layer> layers;
  const auto volume = volume_of(shown.image);
  const auto function = soft_function(0.1);
  for (int region = 0; region < 27; ++region) {
    if ((GetParam() >> region & 1) == 0) continue;
    const int at[3] = {region % 3, region / 3 % 3, region / 9};
    ClipBox box;
    for (int axis = 0; axis < 3; ++axis) {
      const double ends[4] = {-100, planes[2 * axis], planes[2 * axis + 1], 100};
      box.lower[axis] = ends[at[axis]];
      box.upper[axis] = ends[at[axis] + 1];
    }
    Layer layer{VolumeContent{volume, function}};
    layer.clips.push_back({box});
    layers.push_back(layer);
  }
  shown.property->SetScalarOpacityUnitDistance(0.1);
  shown.expect(std::move(layers), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Flags, VtkCropping,
                         testing::Values(VTK_CROP_SUBVOLUME, VTK_CROP_FENCE, VTK_CROP_CROSS,
                                         VTK_CROP_INVERTED_FENCE, VTK_CROP_INVERTED_CROSS,
                                         0x0000001 | 0x4000000, 0x7ffffff));

TEST(VtkLooks, AProjectionShowsOneNumberByColorAndOpacity) {
  Shown shown;
  shown.mapper->SetBlendModeToMaximumIntensity();
  shown.stage.look();
  const Image picture = shown.stage.picture();
  Scene scene =
      scene_on(shown.stage, {Layer{VolumeContent{volume_of(shown.image), soft_function()}}});
  scene.layers[0].projection = LayerProjection::maximum;
  RenderOptions options;
  options.values = true;
  const Image values = render(scene, options);
  // VTK's functions at the number.
  Image truth = values;
  for (std::size_t i = 0; i < values.values.size(); ++i) {
    const double value = double{values.values[i]};
    truth.pixels[i] = {0, 0, 0, 0};
    if (std::isnan(value)) continue;
    const double opacity = shown.property->GetScalarOpacity()->GetValue(value);
    double color[3];
    shown.property->GetRGBTransferFunction()->GetColor(value, color);
    for (std::size_t c = 0; c < 3; ++c) truth.pixels[i][c] = static_cast<float>(opacity * color[c]);
  }
  EXPECT_LE(largest_difference(picture, truth),
            half_a_step + rounding + shown.mapper->GetTolerance() + 1e-4);
}

TEST(VtkLooks, IsosurfacesHaveTheFunctionsAtTheirValues) {
  Shown shown;
  shown.mapper->SetBlendModeToIsoSurface();
  shown.property->GetIsoSurfaceValues()->SetValue(0, 55);
  shown.property->GetIsoSurfaceValues()->SetValue(1, 90);
  shown.property->GetScalarOpacity()->RemoveAllPoints();
  shown.property->GetScalarOpacity()->AddPoint(0, 0.2);
  shown.property->GetScalarOpacity()->AddPoint(100, 0.8);
  Layer layer{VolumeContent{volume_of(shown.image),
                            std::make_shared<const TransferFunction>(
                                std::vector<TransferFunction::Point>{{0, 0, {0, 0, 0}}})}};
  layer.isosurfaces.push_back({55, 0.2 + 0.6 * 0.55, {5.5 / 6, 2.75 / 6, 0.5 / 6}});
  layer.isosurfaces.push_back({90, 0.2 + 0.6 * 0.9, {1, 0.875, 0.75}});
  shown.expect({layer});
}

TEST(VtkLooks, ASliceIsAPlaneOfTheData) {
  Shown shown;
  shown.mapper->SetBlendModeToSlice();
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(14, 15, 24);
  plane->SetNormal(0.2, 1, 0.4);
  shown.property->SetSliceFunction(plane);
  shown.property->GetScalarOpacity()->RemoveAllPoints();
  shown.property->GetScalarOpacity()->AddPoint(0, 0.7);
  Layer layer{
      VolumeContent{volume_of(shown.image),
                    std::make_shared<const TransferFunction>(std::vector<TransferFunction::Point>{
                        {0, 0, {0, 0, 1}}, {60, 0, {1, 0.5, 0}}, {100, 0, {1, 1, 1}}})}};
  layer.slices.push_back({{14, 15, 24}, {0.2, 1, 0.4}, 0.7});
  shown.expect({layer});
}

TEST(VtkLooks, IndependentComponentsMix) {
  for (const bool by_component : {false, true}) {
    Shown shown;
    const vtkIdType count = shown.image->GetNumberOfPoints();
    vtkSmartPointer<vtkDataArray> both;
    if (by_component) {
      both = vtkSmartPointer<vtkSOADataArrayTemplate<float>>::New();
    } else {
      both = vtkSmartPointer<vtkFloatArray>::New();
    }
    both->SetNumberOfComponents(2);
    both->SetNumberOfTuples(count);
    vtkDataArray* const one = shown.image->GetPointData()->GetScalars();
    for (vtkIdType i = 0; i < count; ++i) {
      both->SetComponent(i, 0, one->GetComponent(i, 0));
      both->SetComponent(i, 1, one->GetComponent(count - 1 - i * 3 / 4, 0));
    }
    shown.image->GetPointData()->SetScalars(both);
    shown.property->SetScalarOpacity(1, shown.property->GetScalarOpacity(0));
    vtkNew<vtkColorTransferFunction> green;
    green->AddRGBPoint(0, 0, 1, 0);
    shown.property->SetColor(1, green);
    shown.property->SetScalarOpacityUnitDistance(1, 1);
    shown.property->SetComponentWeight(1, 0.5);
    const std::vector<OpacityPoint> points{
        {0, 0, {0, 1, 0}}, {50, 0.02, {0, 1, 0}}, {100, 0.2, {0, 1, 0}}};
    shown.expect(
        {Layer{VolumeContent{volume_of(shown.image, 0), soft_function()}},
         Layer{VolumeContent{volume_of(shown.image, 1),
                             std::make_shared<const TransferFunction>(
                                 transfer_function_from_opacity_table(points, 2, 1e-6))}}});
  }
}

vtkSmartPointer<vtkImageData> mask_like(vtkImageData* image) {
  auto mask = vtkSmartPointer<vtkImageData>::New();
  mask->CopyStructure(image);
  vtkNew<vtkUnsignedCharArray> labels;
  const int* const side = image->GetDimensions();
  for (int z = 0; z < side[2]; ++z) {
    for (int y = 0; y < side[1]; ++y) {
      for (int x = 0; x < side[0]; ++x) {
        labels->InsertNextValue(static_cast<unsigned char>(x < 9 ? 0 : y < 12 ? 1 : 2));
      }
    }
  }
  mask->GetPointData()->SetScalars(labels);
  return mask;
}

TEST(VtkLooks, MasksAndLabelsChooseTheFunction) {
  for (const bool binary : {true, false}) {
    Shown shown;
    const auto mask = mask_like(shown.image);
    shown.mapper->SetMaskInput(mask);
    shown.mapper->SetMaskType(binary ? vtkPellucidVolumeMapper::BinaryMaskType
                                     : vtkPellucidVolumeMapper::LabelMapMaskType);
    shown.mapper->SetMaskBlendFactor(0.25F);
    vtkNew<vtkColorTransferFunction> green;
    green->AddRGBPoint(0, 0, 1, 0);
    shown.property->SetLabelColor(2, green);
    shown.property->SetLabelScalarOpacity(2, shown.property->GetScalarOpacity());
    std::vector<float> labels;
    for (vtkIdType i = 0; i < mask->GetNumberOfPoints(); ++i) {
      labels.push_back(static_cast<float>(mask->GetPointData()->GetScalars()->GetComponent(i, 0)));
    }
    const auto volume = volume_of(shown.image);
    const auto of_labels = std::make_shared<const LabelVolume>(
        std::make_shared<const Volume>(volume->description(), std::move(labels)));
    std::vector<LabelMask::Choice> choices;
    if (binary) {
      choices.push_back({0, std::make_shared<const TransferFunction>(
                                std::vector<TransferFunction::Point>{{0, 0, {0, 0, 0}}})});
    } else {
      const std::vector<OpacityPoint> points{{0, 0, {0, 0.25, 0.75}},
                                             {50, 0.02, {3.75 / 6, 0.3125 + 0.25, 0.125}},
                                             {60, 0.056, {0.75, 0.375 + 0.25, 0}},
                                             {100, 0.2, {0.75, 1, 0.75}}};
      choices.push_back({2, std::make_shared<const TransferFunction>(
                                transfer_function_from_opacity_table(points, 1, 1e-6))});
    }
    shown.expect({Layer{VolumeContent{volume, soft_function(),
                                      std::make_shared<const LabelMask>(of_labels, choices)}}});
  }
}

TEST(VtkLooks, NodesWithJumpsAreJumps) {
  Shown shown;
  vtkPiecewiseFunction* const opacity = shown.property->GetScalarOpacity();
  opacity->RemoveAllPoints();
  opacity->AllowDuplicateScalarsOn();
  opacity->AddPoint(0, 0);
  opacity->AddPoint(70, 0);
  opacity->AddPoint(70, 0.9);
  opacity->AddPoint(100, 0.9);
  vtkNew<vtkColorTransferFunction> white;
  white->AddRGBPoint(0, 1, 1, 1);
  shown.property->SetColor(white);
  const std::vector<OpacityPoint> points{
      {0, 0, {1, 1, 1}}, {70, 0, {1, 1, 1}}, {70, 0.9, {1, 1, 1}}, {100, 0.9, {1, 1, 1}}};
  shown.expect({Layer{VolumeContent{volume_of(shown.image),
                                    std::make_shared<const TransferFunction>(
                                        transfer_function_from_opacity_table(points, 1, 1e-6))}}});
}

}  // namespace
}  // namespace pellucid::test
