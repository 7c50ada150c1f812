// SPDX-License-Identifier: Apache-2.0
#ifdef PELLUCID_HAVE_VTK

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "meshes/load_mesh_step.h"
#include "pellucid/io/film.h"
#include "tests/io/scratch_folder.h"

namespace pellucid::test_mesh_steps {
namespace {

namespace fs = std::filesystem;

/// Returns a tetrahedron, whose second point is at x, with other values at each step.
std::string step(double x, double value) {
  std::string values;
  for (int i = 0; i < 4; ++i) values += std::to_string(value + i) + " ";
  return R"(<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">)"
         R"(<UnstructuredGrid><Piece NumberOfPoints="4" NumberOfCells="1"><Points><DataArray )"
         R"(type="Float64" NumberOfComponents="3" format="ascii">0 0 0 )" +
         std::to_string(x) +
         R"( 0 0 0 1 0 0 0 1</DataArray></Points><Cells><DataArray type="Int32" )"
         R"(Name="connectivity" format="ascii">0 1 2 3</DataArray><DataArray type="Int32" )"
         R"(Name="offsets" format="ascii">4</DataArray><DataArray type="UInt8" Name="types" )"
         R"(format="ascii">10</DataArray></Cells><PointData><DataArray type="Float32" Name="v" )"
         R"(format="ascii">)" +
         values + R"(</DataArray></PointData></Piece></UnstructuredGrid></VTKFile>)";
}

class MeshSteps : public test::ScratchFolder {
 protected:
  void SetUp() override {
    ScratchFolder::SetUp();
    write("m1.vtu", step(1, 0));
    write("m2.vtu", step(1, 10));
    write("m3.vtu", step(1, 20));
    write("m4.vtu", step(1.5, 30));
    write("m5.vtu", step(1.5, 40));
  }
};

const MeshChannels& mesh_of(const Scene& scene) {
  return *std::get<MeshContent>(scene.layers.front().content).mesh;
}

TEST_F(MeshSteps, KeepTheirTetrahedraWhileCellsStay) {
  MeshSource source{path("m%d.vtu"), {}, {}};
  std::shared_ptr<const MeshChannels> last;
  for (int i = 1; i <= 5; ++i) {
    source.options.time = i;
    const auto alone = load_mesh(source).mesh;
    const auto mesh = load_mesh_step(source, last.get(), {}).mesh;
    EXPECT_EQ(last && mesh->shared_mesh() == last->shared_mesh(), i != 1 && i != 4) << i;
    EXPECT_NE(alone->shared_mesh(), mesh->shared_mesh());
    EXPECT_EQ(alone->mesh().points(), mesh->mesh().points());
    for (std::size_t p = 0; p < 4; ++p) EXPECT_EQ(alone->value(0, p), mesh->value(0, p));
    EXPECT_EQ(mesh->statistics(0).minimum, 10 * (i - 1));
    last = mesh;
  }
  // A file alone keeps nothing for a next step.
  const MeshSource one{path("m1.vtu"), {}, {}};
  const auto mesh = load_mesh(one).mesh;
  EXPECT_NE(load_mesh_step(one, mesh.get(), {}).mesh->shared_mesh(), mesh->shared_mesh());
}

TEST_F(MeshSteps, OfAFilmShareTheirTetrahedra) {
  const std::string function = R"({"points": [{"value": 0, "extinction": 1, "color": [1, 1, 1]}]})";
  SceneDescription description =
      parse_scene(R"({"layers": [{"mesh": {"file": ")" + path("m%d.vtu").string() +
                      R"(", "time": 1}, "transfer_function": )" + function + "}]}",
                  "test");
  const Scene first = make_scene(description);
  FrameLoader loader(description, first);
  description.layers[0].mesh->options.time = 3;
  const Scene third = loader.load(description);
  EXPECT_EQ(mesh_of(third).shared_mesh(), mesh_of(first).shared_mesh());
  EXPECT_EQ(mesh_of(third).statistics(0).minimum, 20);
  description.layers[0].mesh->options.time = 4;
  EXPECT_NE(mesh_of(loader.load(description)).shared_mesh(), mesh_of(first).shared_mesh());
}

TEST_F(MeshSteps, SayTheRangeOfTheirFunction) {
  SceneDescription description = parse_scene(
      R"({"layers": [{"mesh": {"file": ")" + path("m%d.vtu").string() + R"("}}]})", "test");
  const SceneTimes times(description);
  SceneDescription ended = description;
  int asked = 0;
  const StepsAsked ends{[&] { return ++asked == 3; }, {}};
  EXPECT_TRUE(choose_for_all_steps(ended, times, {}, ends).empty());
  EXPECT_EQ(asked, 3);
  EXPECT_FALSE(ended.layers[0].transfer_function);
  ASSERT_EQ(choose_for_all_steps(description, times), std::vector<std::size_t>{0});
  const LayerDescription& layer = description.layers[0];
  EXPECT_FALSE(layer.function_change.range);
  ASSERT_TRUE(layer.transfer_function);
  const auto& points = std::get<std::vector<TransferFunction::Point>>(*layer.transfer_function);
  EXPECT_EQ(points.front().value, 0);
  EXPECT_EQ(points.back().value, 43);
}

}  // namespace
}  // namespace pellucid::test_mesh_steps

#endif
