// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>
#include <vector>

#include "mutants_test.h"
#include "tests/io/arrays/zarr_files.h"
#include "tests/io/volume_files.h"

// Damaged headers of volumes whose values are in other files.
namespace pellucid::test_mutants_stores {
namespace {

using test::bytes_of;
using test::counting;
using test::MutantsTest;

TEST_F(MutantsTest, ZarrMetadata) {
  const test::ZarrStore store;
  std::filesystem::create_directories(path("a.zarr"));
  store.write_chunks(path("a.zarr"), bytes_of(counting()), 4);
  survive({store.array_2()}, "a.zarr/.zarray", path("a.zarr"));
  std::filesystem::remove(path("a.zarr/.zarray"));
  const std::string bytes = "[{\"name\": \"bytes\", \"configuration\": {\"endian\": \"little\"}}]";
  survive({store.array_3("float32", bytes,
                         "{\"name\": \"v2\", \"configuration\": {\"separator\": \".\"}}")},
          "a.zarr/zarr.json", path("a.zarr"));
}

TEST_F(MutantsTest, VtkJs) {
  std::filesystem::create_directories(path("head.vti/data"));
  write("head.vti/data/f", bytes_of(counting()));
  survive({"{\"vtkClass\": \"vtkImageData\", \"spacing\": [1, 2, 3], \"origin\": [1, 2, 3], "
           "\"extent\": [0, 4, 0, 3, 0, 2], \"pointData\": {\"vtkClass\": "
           "\"vtkDataSetAttributes\", \"arrays\": [{\"data\": {\"vtkClass\": \"vtkDataArray\", "
           "\"name\": \"f\", \"numberOfComponents\": 1, \"dataType\": \"Float32Array\", \"ref\": "
           "{\"encode\": \"LittleEndian\", \"basepath\": \"data\", \"id\": \"f\"}, \"size\": "
           "60}}]}}"},
          "head.vti/index.json", path("head.vti"));
}

TEST_F(MutantsTest, Vvd) {
  write("v.raw", bytes_of(counting()));
  survive({"<?xml version=\"1.0\" ?>\n<VoreenData version=\"1\">\n<Volumes>\n<Volume>\n<RawData "
           "filename=\"v.raw\" format=\"float\" x=\"5\" y=\"4\" z=\"3\" />\n<MetaData>\n<MetaItem "
           "name=\"Spacing\" type=\"Vec3MetaData\"><value x=\"1\" y=\"2\" z=\"3\" /></MetaItem>\n"
           "</MetaData>\n</Volume>\n</Volumes>\n</VoreenData>\n"},
          "a.vvd", path("a.vvd"));
}

}  // namespace
}  // namespace pellucid::test_mutants_stores
