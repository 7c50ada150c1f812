// SPDX-License-Identifier: Apache-2.0
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "../scratch_folder.h"
#include "../written_volumes.h"
#include "pellucid/io/write_volume.h"

namespace pellucid {
namespace {

class WrittenForItk : public test::ScratchFolder {
 protected:
  /// What ITK reads is what was written: values, components side by side, and places in LPS.
  template <class Io, class Value>
  void expect(const std::string& name, int components, double tolerance,
              itk::CommonEnums::IOComponent type) {
    SCOPED_TRACE(name + " of " + std::to_string(components));
    const Volume::Description d = test::awkward_description();
    const std::vector<Volume> volumes = test::awkward_volumes<Value>(components, d);
    write_volume(volumes, path(name));
    const auto io = Io::New();
    ASSERT_TRUE(io->CanReadFile(path(name).c_str()));
    io->SetFileName(path(name).string());
    io->ReadImageInformation();
    ASSERT_EQ(io->GetNumberOfDimensions(), 3u);
    ASSERT_EQ(io->GetNumberOfComponents(), static_cast<unsigned>(components));
    EXPECT_EQ(io->GetComponentType(), type);
    for (unsigned a = 0; a < 3; ++a) {
      const int axis = static_cast<int>(a);
      EXPECT_EQ(io->GetDimensions(a), static_cast<std::size_t>(d.dimensions[a]));
      EXPECT_NEAR(io->GetSpacing(a), d.placement.spacing[axis], tolerance);
      EXPECT_NEAR(io->GetOrigin(a), d.placement.origin[axis], tolerance);
      for (unsigned row = 0; row < 3; ++row) {
        EXPECT_NEAR(io->GetDirection(a)[row],
                    d.placement.direction.column[axis][static_cast<int>(row)], tolerance);
      }
    }
    const auto n = static_cast<std::size_t>(components);
    std::vector<Value> read(60 * n);
    ASSERT_EQ(static_cast<std::size_t>(io->GetImageSizeInBytes()), read.size() * sizeof(Value));
    itk::ImageIORegion whole(3);
    for (unsigned a = 0; a < 3; ++a) whole.SetSize(a, io->GetDimensions(a));
    io->SetIORegion(whole);
    io->Read(read.data());
    for (std::size_t c = 0; c < n; ++c) {
      const auto written = test::awkward_values<Value>(static_cast<int>(c));
      for (std::size_t i = 0; i < 60; ++i) {
        // ITK 5.2 gives 0 for NaN in NIfTI.
        if (std::is_same_v<Io, itk::NiftiImageIO> && written[i] != written[i]) continue;
        EXPECT_EQ(std::memcmp(&read[n * i + c], &written[i], sizeof(Value)), 0) << c << " " << i;
      }
    }
  }
};

using Type = itk::CommonEnums::IOComponent;

TEST_F(WrittenForItk, Nrrd) {
  expect<itk::NrrdImageIO, std::uint8_t>("a.nrrd", 1, 1e-13, Type::UCHAR);
  expect<itk::NrrdImageIO, std::int16_t>("a.nrrd", 1, 1e-13, Type::SHORT);
  expect<itk::NrrdImageIO, std::uint32_t>("a.nrrd", 1, 1e-13, Type::UINT);
  expect<itk::NrrdImageIO, float>("a.nrrd", 1, 1e-13, Type::FLOAT);
  expect<itk::NrrdImageIO, float>("a.nrrd", 3, 1e-13, Type::FLOAT);
  expect<itk::NrrdImageIO, double>("a.nrrd", 5, 1e-13, Type::DOUBLE);
}

TEST_F(WrittenForItk, Nifti) {
  // Of a.nii.gz ITK would read a.nii, where there is one. In binary32: 83.3 is off by up to 4e-6.
  for (const char* name : {"a.nii", "b.nii.gz"}) {
    expect<itk::NiftiImageIO, std::uint8_t>(name, 1, 4e-6, Type::UCHAR);
    expect<itk::NiftiImageIO, std::int16_t>(name, 1, 4e-6, Type::SHORT);
    expect<itk::NiftiImageIO, std::uint16_t>(name, 1, 4e-6, Type::USHORT);
    expect<itk::NiftiImageIO, float>(name, 1, 4e-6, Type::FLOAT);
    expect<itk::NiftiImageIO, float>(name, 3, 4e-6, Type::FLOAT);
    expect<itk::NiftiImageIO, double>(name, 2, 4e-6, Type::DOUBLE);
  }
}

}  // namespace
}  // namespace pellucid
