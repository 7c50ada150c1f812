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

#include <algorithm>
#include <cmath>
#include <optional>

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
  scene.integration.tolerance = 1e-5;
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
    const Image truth = render(scene_on(stage, std::move(layers))).image;
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
  options.outputs.values = true;
  const Image values = render(scene, options).image;
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

/// Arrays of several components; each has values by its number and those of the ball.
template <class Array, class Value>
void set_components(vtkImageData* image, int components, const Value& value) {
  vtkNew<Array> array;
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(image->GetNumberOfPoints());
  vtkDataArray* const one = image->GetPointData()->GetScalars();
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i) {
    for (int c = 0; c < components; ++c) {
      array->SetComponent(i, c, value(static_cast<int>(i), c, one->GetComponent(i, 0)));
    }
  }
  image->GetPointData()->SetScalars(array);
}

/// Two equal components are one, whichever has the color.
TEST(VtkLooks, TwoEqualDependentComponentsAreOne) {
  for (const bool lit : {false, true}) {
    Shown shown;
    set_components<vtkFloatArray>(shown.image, 2, [](int, int, double v) { return v; });
    shown.property->IndependentComponentsOff();
    if (lit) {
      shown.property->ShadeOn();
      shown.property->SetSpecular(0);
    }
    Layer layer{VolumeContent{volume_of(shown.image, 1), soft_function()}};
    if (lit) layer.shading = Shading{0.1, 0.7, 0, 10, GradientKind::smooth, 0};
    shown.expect({layer});
  }
}

/// Where the color's component is 40 everywhere, colors are those at 40.
TEST(VtkLooks, OfTwoDependentComponentsTheFirstHasTheColor) {
  Shown shown;
  shown.mapper->CroppingOn();
  shown.mapper->SetCroppingRegionFlagsToFence();
  const double planes[6] = {9.7, 19.4, 6.2, 24.9, 14.8, 33.1};
  shown.mapper->SetCroppingRegionPlanes(planes);
  set_components<vtkFloatArray>(shown.image, 2, [](int, int c, double v) {
    return c == 0 ? 40 : -v;  // and opacities of negative values
  });
  vtkPiecewiseFunction* const opacity = shown.property->GetScalarOpacity();
  opacity->RemoveAllPoints();
  opacity->AddPoint(-100, 0.2);
  opacity->AddPoint(-50, 0.02);
  opacity->AddPoint(0, 0);
  shown.property->IndependentComponentsOff();
  const Rgb<double> color{2.0 / 3, 1.0 / 3, 1.0 / 3};
  const auto function =
      std::make_shared<const TransferFunction>(transfer_function_from_opacity_table(
          {{-100, 0.2, color}, {-50, 0.02, color}, {0, 0, color}}, 1, 1e-6));
  std::vector<Layer> layers;
  for (int region = 0; region < 27; ++region) {
    if ((VTK_CROP_FENCE >> region & 1) == 0) continue;
    const int at[3] = {region % 3, region / 3 % 3, region / 9};
    ClipBox box;
    for (int axis = 0; axis < 3; ++axis) {
      const double ends[4] = {-100, planes[2 * axis], planes[2 * axis + 1], 100};
      box.lower[axis] = ends[at[axis]];
      box.upper[axis] = ends[at[axis] + 1];
    }
    Layer layer{VolumeContent{volume_of(shown.image, 1), function}};
    layer.clips.push_back({box});
    layers.push_back(layer);
  }
  shown.expect(std::move(layers));
}

/// Bytes are colors; so are floats, as they are.
TEST(VtkLooks, FourDependentComponentsAreColorsAndAnOpacity) {
  for (const bool bytes : {true, false}) {
    Shown shown;
    const double one = bytes ? 255 : 1;
    const Rgb<double> color{200 / 255.0, 100 / 255.0, 50 / 255.0};
    const auto value = [&](int, int c, double v) {
      return c == 3 ? std::floor(v) : one * (c == 0 ? color.r : c == 1 ? color.g : color.b);
    };
    if (bytes) {
      set_components<vtkUnsignedCharArray>(shown.image, 4, value);
    } else {
      set_components<vtkFloatArray>(shown.image, 4, value);
    }
    shown.property->IndependentComponentsOff();
    const std::vector<OpacityPoint> points{{0, 0, color}, {50, 0.02, color}, {100, 0.2, color}};
    shown.expect({Layer{VolumeContent{
        volume_of(shown.image, 3), std::make_shared<const TransferFunction>(
                                       transfer_function_from_opacity_table(points, 1, 1e-6))}}});
  }
}

/// Red rises along x, by a component of its own: the sum of all is no sum of pictures.
TEST(VtkLooks, ColorsInComponentsMixInEachPlace) {
  Shown shown;
  set_components<vtkUnsignedCharArray>(shown.image, 4, [](int i, int c, double v) {
    return c == 0 ? 10 * (i % 24) : c == 1 ? 230 - 10 * (i % 24) : c == 2 ? 60 : v;
  });
  shown.property->IndependentComponentsOff();
  // Colors by a volume that is 0 to 1 along x: the red one.
  std::vector<float> along;
  for (vtkIdType i = 0; i < shown.image->GetNumberOfPoints(); ++i) {
    along.push_back(static_cast<float>(i % 24));
  }
  const auto opacities = volume_of(shown.image, 3);
  const auto x = std::make_shared<const Volume>(opacities->description(), std::move(along));
  Layer layer{
      ChannelsContent{std::make_shared<const Channels>(
                          std::vector<Channel>{{"x", "", x}, {"opacity", "", opacities}}),
                      std::make_shared<const MultivariateTransferFunction>(
                          2, std::vector<GaussianPrimitive>(),
                          std::vector<ChannelTransferFunction>{
                              {0, TransferFunction({{0, 1, {0, 230 / 255.0, 60 / 255.0}},
                                                    {23, 1, {230 / 255.0, 0, 60 / 255.0}}})}},
                          ChannelTransferFunction{1, *soft_function()})}};
  shown.expect({layer});
}

/// Each value fills the box that is nearer to it than to the others, half of one at the border.
TEST(VtkLooks, NearestValuesFillBoxes) {
  for (const bool bytes : {false, true}) {
    Shown shown;
    shown.image = ball_image(4);
    if (bytes) {
      set_components<vtkUnsignedCharArray>(shown.image, 1,
                                           [](int i, int, double) { return 7 * i % 101; });
    } else {
      vtkDataArray* const values = shown.image->GetPointData()->GetScalars();
      for (vtkIdType i = 0; i < 64; ++i) {
        values->SetComponent(i, 0,
                             static_cast<double>(7 * i % 101) + 0.37 * static_cast<double>(i % 5));
      }
    }
    shown.mapper->SetInputData(shown.image);
    shown.property->SetInterpolationTypeToNearest();
    std::vector<Layer> layers;
    for (vtkIdType i = 0; i < 64; ++i) {
      double place[3];
      shown.image->GetPoint(i, place);
      const double value = shown.image->GetPointData()->GetScalars()->GetComponent(i, 0);
      const double opacity = shown.property->GetScalarOpacity()->GetValue(value);
      double color[3];
      shown.property->GetRGBTransferFunction()->GetColor(value, color);
      if (opacity == 0) continue;
      Layer layer{VolumeContent{
          volume_of(shown.image),
          std::make_shared<const TransferFunction>(std::vector<TransferFunction::Point>{
              {0, -std::log1p(-opacity), {color[0], color[1], color[2]}}})}};
      ClipBox box;
      const double spacing[3] = {1, 1.5, 2};
      for (int a = 0; a < 3; ++a) {
        box.lower[a] = place[a] - spacing[a] / 2;
        box.upper[a] = place[a] + spacing[a] / 2;
      }
      layer.clips.push_back({box});
      layers.push_back(layer);
    }
    shown.expect(std::move(layers));
  }
}

/// Of a point in an image, by definition; none outside.
std::optional<double> value_in(vtkImageData* image, const Vec3<double>& world) {
  const double place[3] = {world.x - 3, (world.y + 2) / 1.5, (world.z - 1) / 2};
  int cell[3];
  double share[3];
  for (int a = 0; a < 3; ++a) {
    const int last = image->GetDimensions()[a] - 1;
    if (!(place[a] >= 0 && place[a] <= last)) return std::nullopt;
    cell[a] = std::min(static_cast<int>(place[a]), last - 1);
    share[a] = place[a] - cell[a];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    int at[3];
    for (int a = 0; a < 3; ++a) {
      const bool upper = (corner >> a & 1) != 0;
      weight *= upper ? share[a] : 1 - share[a];
      at[a] = cell[a] + (upper ? 1 : 0);
    }
    sum += weight * image->GetScalarComponentAsDouble(at[0], at[1], at[2], 0);
  }
  return sum;
}

/// VTK's sum is ∫ opacity · place in the range ds / unit distance, up to 1; where there are no data
/// nothing is drawn.
TEST(VtkLooks, SumsAreIntegralsThatEndAt1) {
  for (const double unit : {1.0, 0.1}) {
    Shown shown;
    shown.mapper->SetBlendModeToAdditive();
    shown.property->SetScalarOpacityUnitDistance(unit);
    shown.property->GetScalarOpacity()->AddPoint(70, 0.01);
    shown.property->GetScalarOpacity()->AddPoint(100, 0.05);
    shown.stage.renderer->SetBackground(0, 0, 1);
    shown.stage.look();
    const Image picture = shown.stage.picture();
    EXPECT_EQ(shown.stage.gl_errors(), "");
    EXPECT_TRUE(shown.mapper->GetExact());
    EXPECT_EQ(shown.mapper->GetPixelsOver(), 0);
    EXPECT_LE(shown.mapper->GetLargestError(), shown.mapper->GetTolerance());
    double range[2];
    shown.image->GetScalarRange(range);
    const Scene scene = scene_on(shown.stage, {});
    const CameraFrame<double> frame = make_camera_frame(scene.camera, scene.size);
    int dark = 0, grey = 0, full = 0, outside = 0, silhouette = 0;
    for (int y = 0; y < scene.size.height; y += 3) {
      for (int x = 0; x < scene.size.width; x += 3) {
        const Ray<double> ray = frame.ray(x, y);
        constexpr double step = 0.01;
        double sum = 0, length = 0;
        for (double t = step / 2; t < 300; t += step) {
          const auto value = value_in(shown.image, ray.origin + ray.direction * t);
          if (!value) continue;
          length += step;
          sum += shown.property->GetScalarOpacity()->GetValue(*value) * (*value - range[0]) /
                 (range[1] - range[0]) * step / unit;
        }
        const double wanted = std::min(sum, 1.0);
        const bool is_inside = length > 0;
        if (length < 3 * step && (is_inside || picture.at(x, y)[2] < 1)) {
          ++silhouette;
          continue;
        }
        EXPECT_NEAR(picture.at(x, y)[0], is_inside ? wanted : 0, 0.006) << x << ' ' << y;
        EXPECT_NEAR(picture.at(x, y)[2], is_inside ? wanted : 1, 0.006) << x << ' ' << y;
        ++(!is_inside ? outside : sum >= 1 ? full : sum > 0.1 ? grey : dark);
      }
    }
    EXPECT_LE(silhouette, 3);
    EXPECT_GT(grey, 20);
    EXPECT_GT(outside, 20);
    EXPECT_GE(full, unit < 1 ? 20 : 0);
  }
}

TEST(VtkLooks, TheFinalColorHasAWindowAndALevel) {
  for (const auto& [window, level] : {std::pair{0.6F, 0.4F}, {-0.5F, 0.3F}, {4.0F, 0.1F}}) {
    Shown shown;
    shown.property->SetScalarOpacityUnitDistance(0.2);
    shown.mapper->SetFinalColorWindow(window);
    shown.mapper->SetFinalColorLevel(level);
    shown.stage.look();
    const Image picture = shown.stage.picture();
    EXPECT_LE(shown.mapper->GetLargestError(), shown.mapper->GetTolerance());
    Image truth =
        render(scene_on(shown.stage,
                        {Layer{VolumeContent{volume_of(shown.image), soft_function(0.2)}}}))
            .image;
    const double w = double{window}, l = double{level};
    for (auto& pixel : truth.pixels) {
      for (std::size_t c = 0; c < 3; ++c) {
        pixel[c] = static_cast<float>((double{pixel[c]} - double{pixel[3]} * (l - w / 2)) / w);
      }
    }
    EXPECT_LE(largest_difference(picture, truth),
              half_a_step + rounding + shown.mapper->GetTolerance() + 1e-4)
        << window;
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
