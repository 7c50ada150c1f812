// SPDX-License-Identifier: Apache-2.0
//
// A simulation that looks at itself. Heat spreads in a cube that is cut into slabs, one for each
// rank of MPI. Every so many steps the ranks render a picture together: each shows its own array
// where it lies, without a copy and without a file.
//
//   mpirun -n 4 in_transit [STEPS [STEPS_PER_PICTURE [PREFIX]]]
#include <mpi.h>
#include <pellucid/cluster/communicator.h>
#include <pellucid/cluster/render.h>
#include <pellucid/cluster/sub_scene.h>
#include <pellucid/io/image_files.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

namespace {

constexpr int side = 48;   ///< points along each axis
constexpr int ghosts = 2;  ///< planes of the neighbors: one for the brick's cells, one for light
constexpr int plane = side * side;

/// The part [first, end) of the planes along z, and planes of the neighbors on both sides.
struct Slab {
  int rank = 0, ranks = 1, first = 0, end = side;
  std::vector<float> heat, next;

  Slab(int own, int count)
      : rank(own), ranks(count), first(side * own / count), end(side * (own + 1) / count) {
    heat.resize(static_cast<std::size_t>(plane) * static_cast<std::size_t>(planes()));
    for (int k = 0; k < planes(); ++k) {
      for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) at(i, j, k) = start(i, j, first - ghosts + k);
      }
    }
    next = heat;
  }
  int planes() const { return end - first + 2 * ghosts; }
  float& at(int i, int j, int k) {
    return heat[static_cast<std::size_t>(i + side * (j + side * k))];
  }
  static float start(int i, int j, int k) {
    const double x = i - 14.0, y = j - 20.0, z = k - 18.0, u = i - 33.0, w = k - 30.0;
    return static_cast<float>(std::exp(-(x * x + y * y + z * z) / 60) +
                              std::exp(-(u * u + y * y + w * w) / 30));
  }

  /// One explicit step of the heat equation; the border keeps its values.
  void step() {
    next = heat;
    for (int k = ghosts; k < planes() - ghosts; ++k) {
      const int z = first - ghosts + k;
      if (z == 0 || z == side - 1) continue;
      for (int j = 1; j < side - 1; ++j) {
        for (int i = 1; i < side - 1; ++i) {
          const float around = at(i - 1, j, k) + at(i + 1, j, k) + at(i, j - 1, k) +
                               at(i, j + 1, k) + at(i, j, k - 1) + at(i, j, k + 1);
          next[static_cast<std::size_t>(i + side * (j + side * k))] =
              at(i, j, k) + 0.15f * (around - 6 * at(i, j, k));
        }
      }
    }
    heat.swap(next);
    exchange();
  }

  /// Gets the neighbors' planes.
  void exchange() {
    const int below = rank > 0 ? rank - 1 : MPI_PROC_NULL;
    const int above = rank + 1 < ranks ? rank + 1 : MPI_PROC_NULL;
    const int count = ghosts * plane;
    float* const own_first = &at(0, 0, ghosts);
    float* const own_last = &at(0, 0, planes() - 2 * ghosts);
    MPI_Sendrecv(own_first, count, MPI_FLOAT, below, 0, &at(0, 0, planes() - ghosts), count,
                 MPI_FLOAT, above, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    MPI_Sendrecv(own_last, count, MPI_FLOAT, above, 1, &at(0, 0, 0), count, MPI_FLOAT, below, 1,
                 MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  }

  /// The planes that are inside of the cube.
  int lowest() const { return std::max(first - ghosts, 0); }
  int highest() const { return std::min(end + ghosts, side); }

  /// The array itself as a volume: nothing is copied, so that the slab must outlive the volume.
  std::shared_ptr<const pellucid::Volume> volume() {
    pellucid::Volume::Description description;
    description.dimensions = {side, side, highest() - lowest()};
    description.placement.origin = {0, 0, static_cast<double>(lowest())};
    description.name = "heat";
    const float* const values = &at(0, 0, lowest() - (first - ghosts));
    const std::shared_ptr<const float> shared(values, [](const float*) {});
    return std::make_shared<const pellucid::Volume>(
        description, pellucid::DataArray<float>(
                         shared, static_cast<std::size_t>(plane) *
                                     static_cast<std::size_t>(description.dimensions[2])));
  }
};

/// The bricks of all ranks, which meet half-way between their points.
pellucid::BrickTree bricks(int ranks) {
  std::vector<pellucid::Box<double>> boxes;
  for (int rank = 0; rank < ranks; ++rank) {
    const double lower = rank == 0 ? 0 : side * rank / ranks - 0.5;
    const double upper = rank + 1 == ranks ? side - 1 : side * (rank + 1) / ranks - 0.5;
    boxes.push_back({{0, 0, lower}, {side - 1, side - 1, upper}});
  }
  return pellucid::BrickTree::of_boxes({}, boxes);
}

pellucid::Scene scene_of(Slab& slab) {
  using Point = pellucid::TransferFunction::Point;
  pellucid::Layer layer;
  layer.content = pellucid::VolumeContent{
      slab.volume(),
      std::make_shared<const pellucid::TransferFunction>(std::vector<Point>{
          {0.05, 0, {0.1, 0.2, 1}}, {0.3, 0.15, {1, 0.3, 0.1}}, {1, 1, {1, 1, 0.6}}})};
  layer.shading = pellucid::Shading{};
  pellucid::Scene scene;
  scene.layers = {layer};
  scene.camera.position = {110, 80, 120};
  scene.camera.focal_point = {23.5, 23.5, 23.5};
  scene.camera.vertical_angle = 26;
  scene.size = {160, 120};
  return scene;
}

void run(pellucid::Communicator& ranks, int steps, int steps_per_picture,
         const std::string& prefix) {
  Slab slab(ranks.rank(), ranks.size());
  const pellucid::BrickTree tree = bricks(ranks.size());
  pellucid::RenderOptions options;
  options.machine.threads = 1;
  for (int step = 0; step <= steps; ++step) {
    if (step % steps_per_picture == 0) {
      pellucid::Scene scene = scene_of(slab);
      pellucid::agree_on_ranges(ranks, {}, scene);
      const auto [image, report] = pellucid::render(ranks, tree, scene, options);
      if (ranks.rank() == 0) {
        const std::string file = prefix + std::to_string(step) + ".exr";
        pellucid::write_exr(image, file);
        std::printf("%s: within %.2g, %.3f s\n", file.c_str(), report.frame.largest_error,
                    report.frame.seconds);
      }
    }
    slab.step();
  }
}

}  // namespace

int main(int argc, char** argv) {
  int level = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &level);
  int status = 0;
  try {
    const auto ranks = pellucid::mpi_communicator(static_cast<int>(MPI_Comm_c2f(MPI_COMM_WORLD)));
    run(*ranks, argc > 1 ? std::atoi(argv[1]) : 40, argc > 2 ? std::atoi(argv[2]) : 10,
        argc > 3 ? argv[3] : "heat");
  } catch (const pellucid::AgreedError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    status = 1;
  } catch (const std::exception& error) {
    // The other ranks do not know of it.
    std::fprintf(stderr, "%s\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  MPI_Finalize();
  return status;
}
