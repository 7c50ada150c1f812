// SPDX-License-Identifier: Apache-2.0
//
// Faces of polyhedra as VTK writes them since version 9.4, in .vtu files in every coding and in
// VTKHDF.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/io/mesh_source.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/scene/tetrahedral_mesh.h"
#include "polyhedra_files.h"

namespace pellucid {
namespace {

using test::CellLists;
using test::Coding;
using test::contains;
using test::error_of;
using test::Numbers;
using test::PolyhedraVtu;

void expect_two_cells(const std::filesystem::path& file, std::size_t pieces = 1) {
  const MeshFile mesh = read_mesh(file);
  ASSERT_EQ(mesh.grid.shapes.size(), 2 * pieces);
  for (std::size_t piece = 0; piece < pieces; ++piece) {
    EXPECT_EQ(mesh.grid.shapes[2 * piece], CellShape::polyhedron);
    EXPECT_EQ(mesh.grid.shapes[2 * piece + 1], CellShape::hexahedron);
  }
  const MeshStatistics s = load_mesh({file, {}, {}}).mesh->mesh().statistics();
  EXPECT_NEAR(s.volume, 2. * static_cast<double>(pieces), 1e-12);
  EXPECT_EQ(s.folded_faces, 0U);
  EXPECT_EQ(s.boundary_faces, 20U * pieces);
}

class VtkPolyhedra : public test::ScratchFolder {
 protected:
  std::string error_with(const CellLists& lists, Coding coding = Coding::ascii) {
    const auto file = write("bad.vtu", PolyhedraVtu(coding).text(lists));
    return error_of([&] { read_mesh(file); });
  }
};

#ifdef PELLUCID_HAVE_VTK

TEST_F(VtkPolyhedra, FacesOfVtk94InEveryCoding) {
  for (const Coding coding : {Coding::ascii, Coding::base64, Coding::raw, Coding::appended_base64,
                              Coding::packed, Coding::packed_base64}) {
    SCOPED_TRACE(static_cast<int>(coding));
    expect_two_cells(write("a.vtu", PolyhedraVtu(coding).text({})));
    expect_two_cells(write("a.vtu", PolyhedraVtu(coding).text({}, 2)), 2);
  }
  // A face that two cells share, in any order; the second is turned.
  CellLists shared;
  shared.types = {42, 42};
  shared.face_connectivity.insert(
      shared.face_connectivity.end(),
      {1, 8, 10, 5, 8, 9, 11, 10, 9, 2, 6, 11, 1, 2, 9, 8, 5, 10, 11, 6});
  shared.face_offsets.insert(shared.face_offsets.end(), {28, 32, 36, 40, 44});
  shared.polyhedron_to_faces.insert(shared.polyhedron_to_faces.end(), {10, 3, 6, 7, 8, 9});
  shared.polyhedron_offsets = {6, 12};
  const MeshFile mesh = read_mesh(write("a.vtu", PolyhedraVtu(Coding::ascii).text(shared)));
  EXPECT_EQ(mesh.grid.shapes, (std::vector{CellShape::polyhedron, CellShape::polyhedron}));
  EXPECT_NEAR(load_mesh({path("a.vtu"), {}, {}}).mesh->mesh().statistics().volume, 2, 1e-12);
}

TEST_F(VtkPolyhedra, InPiecesOfAListAndInSteps) {
  write("l.vtu", PolyhedraVtu(Coding::base64).text({}));
  std::string right = PolyhedraVtu(Coding::ascii).text({});
  const std::string left_points = "\"Points\" NumberOfComponents=\"3\" format=\"ascii\">";
  write("r.vtu", right);
  write("a.pvtu",
        test::xml_file("PUnstructuredGrid",
                       "<PUnstructuredGrid><PPointData Scalars=\"p\"><PDataArray type=\"Float32\" "
                       "Name=\"p\"/></PPointData><PPoints><PDataArray type=\"Float64\" "
                       "NumberOfComponents=\"3\"/></PPoints><Piece Source=\"l.vtu\"/></"
                       "PUnstructuredGrid>\n"));
  expect_two_cells(path("a.pvtu"));
  write("a.pvd", test::xml_file("Collection",
                                "<Collection><DataSet timestep=\"0\" file=\"l.vtu\"/><DataSet "
                                "timestep=\"1\" file=\"r.vtu\"/></Collection>\n"));
  expect_two_cells(path("a.pvd"));
  write("a.vtm", test::xml_file("vtkMultiBlockDataSet",
                                "<vtkMultiBlockDataSet><DataSet index=\"0\" file=\"l.vtu\"/>"
                                "</vtkMultiBlockDataSet>\n"));
  expect_two_cells(path("a.vtm"));
}

TEST_F(VtkPolyhedra, ListsThatAreDamagedAreRefused) {
  const auto with = [&](Numbers CellLists::*list, const Numbers& numbers) {
    CellLists lists;
    lists.*list = numbers;
    return lists;
  };
  const std::vector<std::pair<CellLists, std::string>> faults{
      {with(&CellLists::polyhedron_offsets, {6}), "polyhedron_offsets\" of cells has 1 numbers"},
      {with(&CellLists::polyhedron_offsets, {6, 5}), "polyhedron_offsets\" of cells goes back"},
      {with(&CellLists::polyhedron_offsets, {-6, 6}), "polyhedron_offsets\" of cells goes back"},
      {with(&CellLists::polyhedron_offsets, {6, 7}),
       "polyhedron_to_faces\" of cells has fewer than 7"},
      {with(&CellLists::polyhedron_to_faces, {0, 1, 2, 3, 4, 6}),
       "face_offsets\" of cells has fewer"},
      {with(&CellLists::polyhedron_to_faces, {0, 1, 2, 3, 4, -1}), "has a negative number"},
      {with(&CellLists::face_offsets, {4, 8, 12, 16, 20, 25}),
       "face_connectivity\" of cells has fewer"},
      {with(&CellLists::face_offsets, {4, 3, 12, 16, 20, 24}), "face_offsets\" of cells goes back"},
      {with(&CellLists::polyhedron_offsets, {0, 0}), "comes without its faces"}};
  for (const auto& [lists, fault] : faults) {
    for (const Coding coding : {Coding::ascii, Coding::packed}) {
      const std::string error = error_with(lists, coding);
      EXPECT_TRUE(contains(error, fault)) << fault << ": " << error;
      EXPECT_FALSE(contains(error, "\n")) << error;
    }
  }
  CellLists outside;
  outside.face_connectivity[5] = 100;
  EXPECT_TRUE(contains(error_with(outside), "100")) << error_with(outside);
  // Each cell has each face a thousand times.
  CellLists repeated;
  repeated.polyhedron_to_faces = Numbers(6000, 1);
  repeated.polyhedron_offsets = {6000, 6000};
  EXPECT_TRUE(contains(error_with(repeated), "more often than")) << error_with(repeated);
  // Both forms at once.
  std::string both = PolyhedraVtu(Coding::ascii).text({});
  both.insert(both.find("</Cells>"),
              test::xml_array("Int64", "faces",
                              "6 4 0 3 2 1 4 4 5 6 7 4 0 1 5 4 4 1 2 6 5 4 2 3 7 6 4 3 0 4 7") +
                  test::xml_array("Int64", "faceoffsets", "31 -1"));
  const auto file = write("both.vtu", both);
  EXPECT_TRUE(contains(error_of([&] { read_mesh(file); }), "write all pieces in one of them"));
}

#endif

#ifdef PELLUCID_HAVE_HDF5

TEST_F(VtkPolyhedra, OfVtkHdf) {
  test::PolyhedraVtkHdf{}.write(path("a.vtkhdf"));
  expect_two_cells(path("a.vtkhdf"), 2);
}

TEST_F(VtkPolyhedra, OfVtkHdfThatAreDamagedAreRefused) {
  const auto error_with = [&](Numbers CellLists::*list, const Numbers& numbers) {
    test::PolyhedraVtkHdf file;
    file.lists.*list = numbers;
    file.write(path("a.vtkhdf"));
    return error_of([&] { read_mesh(path("a.vtkhdf")); });
  };
  EXPECT_TRUE(contains(error_with(&CellLists::polyhedron_offsets, {6, 5}), "PolyhedronOffsets"));
  EXPECT_TRUE(contains(error_with(&CellLists::polyhedron_offsets, {6, 7}), "PolyhedronOffsets"));
  EXPECT_TRUE(contains(error_with(&CellLists::polyhedron_to_faces, {0, 1, 2, 3, 4, 6}),
                       "PolyhedronToFaces"));
  EXPECT_TRUE(contains(error_with(&CellLists::polyhedron_to_faces, {0, 1, 2, 3, 4, -1}),
                       "PolyhedronToFaces"));
  EXPECT_TRUE(
      contains(error_with(&CellLists::face_offsets, {4, 8, 12, 16, 20, 25}), "FaceOffsets"));
  EXPECT_TRUE(
      contains(error_with(&CellLists::face_offsets, {4, 3, 12, 16, 20, 24}), "FaceOffsets"));
  EXPECT_TRUE(
      contains(error_with(&CellLists::polyhedron_offsets, {0, 0}), "comes without its faces"));
}

#endif

}  // namespace
}  // namespace pellucid
