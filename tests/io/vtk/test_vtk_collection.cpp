// SPDX-License-Identifier: Apache-2.0
#ifdef PELLUCID_HAVE_VTK

#include <string>

#include "mesh_files.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/io/read_volume.h"
#include "pellucid/io/write_volume.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_vtk_collection {
namespace {

namespace fs = std::filesystem;

using test::contains;
using test::error_of;
using test::expect_counting;

class VtkCollection : public test::ScratchFolder {
 protected:
  void SetUp() override {
    ScratchFolder::SetUp();
    Volume::Description description;
    description.dimensions = {5, 4, 3};
    description.name = "counting";
    for (const char* name : {"a.vti", "b.vti"}) {
      const Volume volume(description, DataArray<float>(test::counting()));
      write_volume({&volume, 1}, path(name));
    }
    write("m.vtu", test::small_vtu());
  }
  fs::path list(const std::string& type, const std::vector<std::string>& files,
                const std::string& name) const {
    std::string inside = "<" + type + ">";
    for (const std::string& file : files) inside += "<DataSet index=\"0\" file=\"" + file + "\"/>";
    return write(name, test::xml_file(type, inside + "</" + type + ">\n"));
  }
};

TEST_F(VtkCollection, OneImageIsRead) {
  for (const char* type : {"vtkMultiBlockDataSet", "Collection"}) {
    const fs::path file = list(type, {"a.vti"}, "one.vtm");
    EXPECT_FALSE(is_mesh_file(file));
    expect_counting(read_volume(file), "f32");
    EXPECT_EQ(list_arrays(file).size(), 1U);
  }
}

TEST_F(VtkCollection, SeveralAreRefusedWithTheirNames) {
  const std::string error = error_of([&] {
    read_volume(list("Collection", {"a.vti", "b.vti"}, "two.pvd"));
  });
  EXPECT_TRUE(contains(error, "lists 2 files") && contains(error, "a.vti, b.vti")) << error;
  EXPECT_TRUE(contains(error_of([&] {
                         read_volume(list("vtkMultiBlockDataSet", {"a.vti", "m.vtu"}, "x.vtm"));
                       }),
                       "lists 2 files"));
}

TEST_F(VtkCollection, AdaptiveOnesAreRefusedByName) {
  for (const char* type :
       {"vtkHierarchicalBoxDataSet", "vtkOverlappingAMR", "vtkNonOverlappingAMR"}) {
    for (const char* name : {"a.vthb", "a.vtm"}) {
      const fs::path file = list(type, {"a.vti"}, name);
      EXPECT_FALSE(is_mesh_file(file));
      const std::string error = error_of([&] { read_volume(file); });
      EXPECT_TRUE(contains(error, "adaptive (" + std::string(type)) && contains(error, "a.vti"))
          << error;
    }
  }
}

TEST_F(VtkCollection, AdaptiveOnesOfFilesThatAreGone) {
  const fs::path file = list("vtkOverlappingAMR", {"none.vti"}, "gone.vth");
  EXPECT_FALSE(is_mesh_file(file));
  EXPECT_TRUE(contains(error_of([&] { read_volume(file); }), "adaptive (vtkOverlappingAMR"));
}

TEST_F(VtkCollection, MeshesStayMeshes) {
  const fs::path file = list("vtkMultiBlockDataSet", {"m.vtu"}, "mesh.vtm");
  EXPECT_TRUE(is_mesh_file(file));
  EXPECT_EQ(read_mesh(file).blocks, 1);
  EXPECT_TRUE(is_mesh_file(list("vtkMultiBlockDataSet", {"none.vti"}, "gone.vtm")));
}

}  // namespace
}  // namespace pellucid::test_vtk_collection

#endif
