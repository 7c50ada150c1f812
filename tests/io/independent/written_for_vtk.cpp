// SPDX-License-Identifier: Apache-2.0
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLImageDataReader.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "../scratch_folder.h"
#include "../written_volumes.h"
#include "pellucid/io/write_volume.h"

namespace pellucid {
namespace {

class WrittenForVtk : public test::ScratchFolder {
 protected:
  template <class Value>
  void expect(int components, Centering centering, int type) {
    SCOPED_TRACE(std::to_string(components) + " of type " + std::to_string(type));
    const Volume::Description d = test::awkward_description(centering);
    write_volume(test::awkward_volumes<Value>(components, d), path("a.vti"), "density");
    const auto reader = vtkSmartPointer<vtkXMLImageDataReader>::New();
    reader->SetFileName(path("a.vti").c_str());
    reader->Update();
    vtkImageData& image = *reader->GetOutput();
    const bool cell = centering == Centering::cell;
    int sides[3];
    image.GetDimensions(sides);
    for (int a = 0; a < 3; ++a) {
      EXPECT_EQ(sides[a], d.dimensions[static_cast<std::size_t>(a)] + (cell ? 1 : 0));
      EXPECT_EQ(image.GetSpacing()[a], d.placement.spacing[a]);
      for (int row = 0; row < 3; ++row) {
        EXPECT_EQ(image.GetDirectionMatrix()->GetElement(row, a),
                  d.placement.direction.column[a][row]);
      }
    }
    // The first value: a point, or the middle of a cell.
    double place[3];
    const double index = cell ? 0.5 : 0;
    image.TransformContinuousIndexToPhysicalPoint(index, index, index, place);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(place[a], d.placement.origin[a], 1e-13);
    vtkDataSetAttributes* const data =
        cell ? static_cast<vtkDataSetAttributes*>(image.GetCellData()) : image.GetPointData();
    vtkDataArray* const array = data->GetScalars();
    ASSERT_NE(array, nullptr);
    EXPECT_STREQ(array->GetName(), "density");
    EXPECT_EQ(array->GetDataType(), type);
    ASSERT_EQ(array->GetNumberOfComponents(), components);
    ASSERT_EQ(array->GetNumberOfTuples(), 60);
    const auto n = static_cast<std::size_t>(components);
    const auto* const read = static_cast<const Value*>(array->GetVoidPointer(0));
    for (std::size_t c = 0; c < n; ++c) {
      const auto written = test::awkward_values<Value>(static_cast<int>(c));
      for (std::size_t i = 0; i < 60; ++i) {
        EXPECT_EQ(std::memcmp(&read[n * i + c], &written[i], sizeof(Value)), 0) << c << " " << i;
      }
    }
  }
};

TEST_F(WrittenForVtk, Vti) {
  for (const Centering centering : {Centering::point, Centering::cell}) {
    expect<std::uint8_t>(1, centering, VTK_UNSIGNED_CHAR);
    expect<std::int8_t>(1, centering, VTK_SIGNED_CHAR);
    expect<std::uint16_t>(2, centering, VTK_UNSIGNED_SHORT);
    expect<std::int16_t>(1, centering, VTK_SHORT);
    expect<std::uint32_t>(1, centering, VTK_UNSIGNED_INT);
    expect<std::int32_t>(1, centering, VTK_INT);
    expect<float>(3, centering, VTK_FLOAT);
    expect<double>(1, centering, VTK_DOUBLE);
  }
}

}  // namespace
}  // namespace pellucid
