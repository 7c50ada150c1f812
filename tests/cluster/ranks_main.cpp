// SPDX-License-Identifier: Apache-2.0
//
// Renders scenes on all ranks of the program, each with the data of its brick alone, and holds the
// pictures against the reference and the picture of one process:
//
//   mpirun -n N test_ranks [--all] [--size PIXELS] [--only PART OF A NAME] [--tolerance NUMBER]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "pellucid/cluster/communicator.h"
#include "pellucid/cluster/render.h"
#include "pellucid/cluster/sub_scene.h"
#include "pellucid/reference/render.h"
#include "pellucid/scene/image_difference.h"
#include "tests/cluster/rank_scenes.h"

namespace {

using namespace pellucid;

struct Wanted {
  bool all = false;
  int size = 24;
  double tolerance = default_tolerance;
  std::string only;
};

Wanted parse(int argc, char** argv) {
  Wanted wanted;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto next = [&]() -> std::string { return i + 1 < argc ? argv[++i] : ""; };
    if (word == "--all") wanted.all = true;
    if (word == "--size") wanted.size = std::stoi(next());
    if (word == "--only") wanted.only = next();
    if (word == "--tolerance") wanted.tolerance = std::stod(next());
  }
  return wanted;
}

/// Returns the number of pixels in which a differs from b by more than the errors that they report.
std::size_t wrong_pixels(const Image& a, const Image& b, const char* what) {
  const auto check = check_errors(a, b);
  if (!check || check->over == 0) return 0;
  std::printf("    %zu pixels differ from %s by more than their errors, (%d, %d) by %.3g > %.3g\n",
              check->over, what, check->column, check->row, check->difference, check->error);
  return check->over;
}

/// Returns the number of pixels whose depth is far from that of the picture of one process. Half of
/// the opacity is reached within the tolerance of it; where little absorbs, that is a wide range,
/// so a few may differ.
std::size_t far_depths(const Image& a, const Image& b) {
  std::size_t far = 0, seen = 0;
  float nearest = INFINITY, farthest = 0;
  for (const float depth : b.depth) {
    if (!std::isfinite(depth)) continue;
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  for (std::size_t i = 0; i < a.depth.size(); ++i) {
    if (b.pixels[i][3] < 0.05f) continue;
    ++seen;
    const bool same = std::isinf(a.depth[i]) && std::isinf(b.depth[i]);
    if (!same && !(std::abs(a.depth[i] - b.depth[i]) <= 0.02f * (farthest - nearest) + 1e-4f)) {
      ++far;
    }
  }
  if (20 * far <= seen) return 0;
  std::printf("    %zu of %zu depths are far from those of one process\n", far, seen);
  return far;
}

/// Returns whether the ranks' picture is right.
bool is_right(const Scene& scene, const Image& image, const RankReport& report, bool is_hard) {
  RenderOptions options;
  options.outputs.error = options.outputs.depth = true;
  const auto [alone, alone_report] = render(scene, options);
  const Image truth = render_reference(scene).image;
  std::size_t wrong = wrong_pixels(image, truth, "the reference");
  wrong += wrong_pixels(image, alone, "the picture of one process");
  wrong += far_depths(image, alone);
  // What one process cannot do within the tolerance, ranks need not do either.
  const std::size_t over = report.frame.pixels_over_tolerance;
  const double margin = 1.02 * scene.integration.tolerance;
  // A proof takes more panels than it may at the shares of many ranks: a pixel may say so.
  const std::size_t unproved = scene.integration.grade == Grade::proved ? 1 : 0;
  if (over > (is_hard ? 1 : 2) * alone_report.pixels_over_tolerance + unproved) {
    std::printf("    %zu pixels are over the tolerance (%.6g), and %zu with one process\n", over,
                report.frame.largest_error, std::size_t{alone_report.pixels_over_tolerance});
    ++wrong;
  }
  if (over == 0 && pixels_over(image, truth, margin) > 0) {
    std::printf("    %zu pixels are off by more than the tolerance\n",
                pixels_over(image, truth, margin));
    ++wrong;
  }
  return wrong == 0;
}

/// The same bricks, moved so that they meet at values of the grid.
BrickTree with_faces_on_values(const BrickTree& tree) {
  std::vector<Box<double>> boxes;
  for (int brick = 0; brick < tree.count(); ++brick) {
    Box<double> box = tree.box(brick);
    for (int a = 0; a < 3; ++a) {
      box.lower[a] = std::round(box.lower[a]);
      box.upper[a] = std::round(box.upper[a]);
    }
    boxes.push_back(box);
  }
  return BrickTree::of_boxes(tree.world_from_frame(), boxes);
}

int run(Communicator& ranks, const Wanted& wanted) {
  int failed = 0, done = 0;
  for (const auto& [name, made, slow, faces, is_hard] : cluster_tests::rank_scenes(wanted.size)) {
    if (slow && !wanted.all) continue;
    if (name.find(wanted.only) == std::string::npos) continue;
    Scene scene = made;
    if (!is_hard) scene.integration.tolerance = wanted.tolerance;
    RenderOptions options;
    options.outputs.error = options.outputs.depth = true;
    options.machine.threads = 1;
    const SceneFrame frame = frame_of(scene);
    BrickTree tree =
        BrickTree::split(frame.world_from_frame, frame.bounds, ranks.size(), {}, frame.on_grid);
    if (faces) tree = with_faces_on_values(tree);
    const auto [image, report] = render(ranks, tree, sub_scene(scene, tree, ranks.rank()), options);
    bool right = true;
    if (ranks.rank() == 0) {
      right = is_right(scene, image, report, is_hard);
      std::printf("%s %s (up to %d bricks on a ray, %llu parts again)\n",
                  right ? "ok    " : "FAILED", name.c_str(), report.most_bricks,
                  static_cast<unsigned long long>(report.parts_again));
      std::fflush(stdout);
    }
    ++done;
    if (!right) ++failed;
  }
  if (ranks.rank() == 0) std::printf("%d scenes, %d failed\n", done, failed);
  return failed == 0 && done > 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const auto ranks =
        pellucid::is_under_mpi() ? pellucid::mpi_communicator() : pellucid::single_rank();
    return run(*ranks, parse(argc, argv));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
