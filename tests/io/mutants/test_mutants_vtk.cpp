// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>
#include <vector>

#ifdef PELLUCID_HAVE_HDF5
#include "tests/io/arrays/vtk_hdf_files.h"
#endif

#include "mutants_test.h"
#include "pellucid/io/mesh_source.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/io/write_volume.h"
#include "tests/io/volume_files.h"
#include "tests/io/vtk/exodus_files.h"
#include "tests/io/vtk/mesh_files.h"
#include "tests/io/vtk/polyhedra_files.h"

#ifdef PELLUCID_HAVE_VTK
#include "src/io/vtk/vtk_module.h"
#endif

// Damaged files of VTK's formats and of meshes, as `info` reads them.
namespace pellucid::test_mutants_vtk {
namespace {

using test::bytes_of;
using test::counting;
using test::xml_array;

std::string numbers(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += std::to_string(i) + " ";
  return text;
}

class MutantsOfMeshes : public test::MutantsTest {
 protected:
  void SetUp() override {
    MutantsTest::SetUp();
    // VTK allocates what a damaged file says, up to the limit of its process.
    may_run_out_ = true;
    reader_ = [](const std::filesystem::path& input) {
      if (!is_mesh_file(input)) {
        read_components(input);
        return;
      }
      const MeshFile file = read_mesh(input);
      if (!file.grid.arrays.empty()) load_mesh({input, {}, {}});
    };
#ifdef PELLUCID_HAVE_VTK
    // Its libraries, which then need not be loaded for each file.
    vtk_module();
#endif
  }
};

TEST_F(MutantsOfMeshes, Plot3d) {
  // One block of 3 x 2 x 2 points, with and without record marks.
  std::vector<float> places;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 12; ++i) {
      places.push_back(static_cast<float>(axis == 0 ? i % 3 : axis == 1 ? i / 3 % 2 : i / 6));
    }
  }
  const std::string sides = bytes_of(std::vector<std::int32_t>{3, 2, 2}), values = bytes_of(places);
  const auto marked = [](const std::string& record) {
    const std::string mark = bytes_of(std::vector{static_cast<std::int32_t>(record.size())});
    return mark + record + mark;
  };
  survive({sides + values, marked(sides) + marked(values)}, "a.xyz", path("a.xyz"));
}

#ifdef PELLUCID_HAVE_VTK
class MutantsOfVtk : public MutantsOfMeshes {};

std::string image(const std::string& kind, const std::string& inside, const std::string& more = "",
                  const std::string& behind = "") {
  return "<VTKFile type=\"" + kind + "\" version=\"1.0\" byte_order=\"LittleEndian\"" + more +
         "><" + kind +
         " WholeExtent=\"0 4 0 3 0 2\" Origin=\"0 0 0\" Spacing=\"1 1 1\"><Piece "
         "Extent=\"0 4 0 3 0 2\">" +
         inside + "</Piece></" + kind + ">" + behind + "</VTKFile>\n";
}

TEST_F(MutantsOfVtk, Images) {
  Volume::Description description;
  description.dimensions = {5, 4, 3};
  description.name = "counting";
  const Volume volume(description, DataArray<float>(counting()));
  write_volume({&volume, 1}, path("seed.vti"));
  const std::string cells = "<CellData>" + xml_array("Int16", "c", numbers(24)) + "</CellData>";
  const std::string packed = test::deflated(bytes_of(counting()), 15);
  survive({read(path("seed.vti")), image("ImageData", cells),
           image("ImageData", "<PointData>" + xml_array("UInt8", "vtkGhostType", numbers(60)) +
                                  xml_array("Float32", "p", numbers(60)) + "</PointData>" + cells),
           image("ImageData",
                 "<PointData><DataArray type=\"Float32\" Name=\"p\" format=\"appended\" "
                 "offset=\"0\"/></PointData>",
                 " header_type=\"UInt32\" compressor=\"vtkZLibDataCompressor\"",
                 "<AppendedData encoding=\"raw\">_" +
                     bytes_of(std::vector<std::uint32_t>{
                         1, 240, 0, static_cast<std::uint32_t>(packed.size())}) +
                     packed + "</AppendedData>"),
           "# vtk DataFile Version 3.0\ntitle\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 5 4 "
           "3\nORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 60\nSCALARS v float 1\nLOOKUP_TABLE "
           "default\n" +
               test::swapped_bytes_of(counting())},
          "a.vti", path("a.vti"));
}

TEST_F(MutantsOfVtk, RectilinearGrids) {
  const std::string places = "<Coordinates>" + xml_array("Float64", "x", "0 1 3 4 5") +
                             xml_array("Float64", "y", "0 1 3 4") +
                             xml_array("Float64", "z", "0 2 3") + "</Coordinates>";
  survive({image("RectilinearGrid",
                 "<CellData>" + xml_array("Float64", "c", numbers(24)) + "</CellData>" + places),
           image("RectilinearGrid",
                 "<PointData>" + xml_array("Int64", "p", numbers(60)) + "</PointData>" + places),
           "# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET RECTILINEAR_GRID\nDIMENSIONS 3 2 "
           "2\nX_COORDINATES 3 float\n0 1 3\nY_COORDINATES 2 float\n-1 4\nZ_COORDINATES 2 float\n0 "
           "2\nCELL_DATA 2\nSCALARS c float 1\nLOOKUP_TABLE default\n7 8\n"},
          "a.vtr", path("a.vtr"));
}

TEST_F(MutantsOfVtk, Lists) {
  write("l.vti",
        image("ImageData", "<PointData>" + xml_array("Int16", "v", numbers(60)) + "</PointData>"));
  write("a.vtu", test::small_vtu());
  const std::string head = "<VTKFile type=\"", middle =
                                                   "\" version=\"1.0\" byte_order=\""
                                                   "LittleEndian\">";
  survive({head + "PImageData" + middle +
               "<PImageData WholeExtent=\"0 4 0 3 0 2\" Origin=\"0 0 0\" Spacing=\"1 1 1\">"
               "<PPointData><PDataArray type=\"Int16\" Name=\"v\"/></PPointData><Piece "
               "Extent=\"0 4 0 3 0 1\" Source=\"l.vti\"/><Piece Extent=\"0 4 0 3 1 2\" "
               "Source=\"l.vti\"/></PImageData></VTKFile>",
           head + "PUnstructuredGrid" + middle +
               "<PUnstructuredGrid GhostLevel=\"0\"><PPointData><PDataArray type=\"Float32\" "
               "Name=\"p\"/></PPointData><PPoints><PDataArray type=\"Float64\" "
               "NumberOfComponents=\"3\"/></PPoints><Piece Source=\"a.vtu\"/><Piece "
               "Source=\"a.vtu\"/></PUnstructuredGrid></VTKFile>",
           head + "Collection" + middle +
               "<Collection><DataSet timestep=\"1\" file=\"a.vtu\"/></Collection></VTKFile>"},
          "a.pvtu", path("a.pvtu"));
}

TEST_F(MutantsOfVtk, Meshes) {
  test::SmallVtu ghosts;
  ghosts.more = xml_array("UInt8", "vtkGhostType", "0 1 0");
  test::AnyVtu cells = test::polyhedron_vtu();
  cells.cell_data = "<CellData>" + xml_array("Float32", "c", "1 2") + "</CellData>";
  std::string places;
  for (int i = 0; i < 60; ++i) {
    places += std::to_string(i % 5) + " " + std::to_string(i / 5 % 4) + " " +
              std::to_string(i / 20) + " ";
  }
  survive({test::small_vtu(), test::small_vtu(ghosts), test::polyhedron_vtu().text(), cells.text(),
           image("StructuredGrid", "<CellData>" + xml_array("Float64", "c", numbers(24)) +
                                       "</CellData><Points>" +
                                       xml_array("Float64", "Points", places, 3) + "</Points>"),
           test::PolyhedraVtu(test::Coding::ascii).text({}, 2),
           test::PolyhedraVtu(test::Coding::raw).text({}),
           test::PolyhedraVtu(test::Coding::packed_base64).text({})},
          "a.vtu", path("a.vtu"));
}

TEST_F(MutantsOfVtk, LegacyMeshes) {
  survive({test::small_vtk(), test::polyhedron_vtk(false), test::polyhedron_vtk(true),
           test::small_structured_vtk(),
           test::small_structured_vtk() +
               "POINT_DATA 12\nFIELD FieldData 1\nvtkGhostType 1 12 unsigned_char\n" +
               "2 0 0 0 0 0 0 0 0 0 0 0\n"},
          "a.vtk", path("a.vtk"));
}

#ifdef PELLUCID_HAVE_NETCDF
TEST_F(MutantsOfVtk, ExodusFiles) {
  test::SmallExodus of;
  std::vector<std::string> seeds;
  for (const bool more : {false, true}) {
    if (more) {
      of.nodal = {"DISPLX", "DISPLY", "DISPLZ", "T"};
      of.of_elements = {"e"};
      of.steps = 2;
      of.written_steps = 1;
    }
    of.write(path("seed.e"));
    seeds.push_back(read(path("seed.e")));
  }
  survive(seeds, "a.e", path("a.e"));
}
#endif
#endif

#ifdef PELLUCID_HAVE_HDF5
TEST_F(MutantsOfMeshes, VtkHdf) {
  std::vector<std::string> seeds;
  for (const bool packed : {false, true}) {
    test::VtkHdfWriter mesh(path("seed"), "UnstructuredGrid");
    mesh.attribute<std::int64_t>("Version", {1, 0});
    mesh.array<std::int64_t>("", "NumberOfPoints", {1}, {5});
    mesh.array<std::int64_t>("", "NumberOfCells", {1}, {2});
    mesh.array<std::int64_t>("", "NumberOfConnectivityIds", {1}, {8});
    mesh.array<double>("", "Points", {5, 3}, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, packed);
    mesh.array<std::uint8_t>("", "Types", {2}, {10, 10});
    mesh.array<std::int64_t>("", "Connectivity", {8}, {0, 1, 2, 3, 1, 2, 3, 4}, packed);
    mesh.array<std::int64_t>("", "Offsets", {3}, {0, 4, 8});
    mesh.array<float>("PointData", "p", {5}, {0, 1, 2, 3, 4}, packed);
    mesh.close();
    seeds.push_back(read(path("seed")));
  }
  test::PolyhedraVtkHdf{}.write(path("seed"));
  seeds.push_back(read(path("seed")));
  survive(seeds, "a.vtkhdf", path("a.vtkhdf"));
}
#endif

}  // namespace
}  // namespace pellucid::test_mutants_vtk
