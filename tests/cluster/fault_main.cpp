// SPDX-License-Identifier: Apache-2.0
//
// Something goes wrong on one rank; all of them must end, soon and with one line:
//
//   mpirun -n N test_rank_faults FAULT
//
// Prints "ended: MESSAGE" on rank 0. FAULT: throw, kill, version, frame, camera,
// light, cancel_first, cancel_last.
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>

#include "pellucid/cluster/communicator.h"
#include "pellucid/cluster/render.h"
#include "pellucid/cluster/sub_scene.h"
#include "tests/cluster/rank_scenes.h"

namespace {

using namespace pellucid;

/// Renders a scene of many pixels; `progress` is of this rank.
void render_long(Communicator& ranks, const std::function<bool(double)>& progress, int size = 400) {
  Scene scene = cluster_tests::rank_scenes(size)[1].scene;
  scene.integration.tolerance = 1e-6;
  RenderOptions options;
  options.machine.threads = 1;
  options.monitor.progress = progress;
  render(ranks, scene, options);
}

void run(Communicator& ranks, const std::string& fault) {
  const int last = ranks.size() - 1;
  const bool is_last = ranks.rank() == last, is_first = ranks.rank() == 0;
  if (fault == "throw") {
    render_long(ranks, [&](double) -> bool {
      if (is_last) throw Error("the disk is gone");
      return true;
    });
  } else if (fault == "kill") {
    render_long(ranks, [&](double fraction) {
      if (is_last && fraction > 0.01) std::raise(SIGKILL);
      return true;
    });
  } else if (fault == "version") {
    check_equal(ranks, "the version", is_last ? "0.0.1" : "0.0.2");
  } else if (fault == "frame") {
    render_long(ranks, {}, is_last ? 33 : 32);
  } else if (fault == "camera" || fault == "light") {
    Scene scene = cluster_tests::rank_scenes(16)[1].scene;
    scene.camera.projection =
        is_last && fault == "camera" ? Projection::orthographic : Projection::perspective;
    if (is_last && fault == "light") scene.layers[0].shading = Shading{.power = 7};
    render(ranks, scene, {});
  } else if (fault == "cancel_first") {
    render_long(ranks, [&](double) { return !is_first; });
  } else if (fault == "cancel_last") {
    render_long(ranks, [&](double) { return !is_last; });
  } else {
    throw AgreedError("there is no fault " + fault);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const auto ranks = pellucid::mpi_communicator();
    std::string ended = "without an error";
    try {
      run(*ranks, argc > 1 ? argv[1] : "");
    } catch (const pellucid::AgreedError& e) {
      ended = e.what();
    } catch (const pellucid::Cancelled&) {
      ended = "cancelled";
    }
    if (ranks->rank() == 0) {
      std::printf("ended: %s\n", ended.c_str());
      std::fflush(stdout);
    }
    ranks->gather_all("");
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  return 0;
}
