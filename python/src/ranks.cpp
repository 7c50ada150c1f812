// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "images.h"
#include "pellucid/cluster/communicator.h"
#include "pellucid/cluster/render.h"
#include "pellucid/cluster/sub_scene.h"
#include "scenes.h"
#include "waiting.h"

namespace pellucid::python {

namespace {

/// Returns the tree of the boxes that the ranks have.
BrickTree tree_of(Communicator& ranks, const Box<double>& own) {
  const auto count = static_cast<std::size_t>(ranks.size());
  std::vector<double> numbers(6 * count, 0);
  for (int a = 0; a < 3; ++a) {
    const std::size_t at = 6 * static_cast<std::size_t>(ranks.rank()) + static_cast<std::size_t>(a);
    numbers[at] = own.lower[a];
    numbers[at + 3] = own.upper[a];
  }
  ranks.reduce_all(numbers, Communicator::Reduction::sum);
  std::vector<Box<double>> boxes(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int a = 0; a < 3; ++a) {
      boxes[i].lower[a] = numbers[6 * i + static_cast<std::size_t>(a)];
      boxes[i].upper[a] = numbers[6 * i + static_cast<std::size_t>(a) + 3];
    }
  }
  return BrickTree::of_boxes({}, boxes);
}

/// Renders on the ranks of an MPI communicator, or alone without a handle. Returns the Image on the
/// first, None on others.
py::object render_on_ranks(const py::object& object, std::optional<int> handle,
                           const py::object& lower, const py::object& upper, bool depth,
                           bool values, int threads, const py::object& progress) {
  Scene scene = complete_scene(object);
  std::optional<Box<double>> box;
  if (!lower.is_none()) {
    box = Box<double>{vector_of(lower, "box: the lower corner"),
                      vector_of(upper, "box: the upper corner")};
  }
  RenderOptions options;
  options.outputs.depth = depth;
  options.outputs.error = true;
  options.outputs.values = values;
  options.machine.threads = checked_threads(threads);
  std::exception_ptr raised;
  if (!progress.is_none()) {
    options.monitor.progress = [&](double fraction) {
      const py::gil_scoped_acquire acquired;
      try {
        progress(fraction);
        return true;
      } catch (...) {
        raised = std::current_exception();
        return false;
      }
    };
  }
  ImageHandle image{nullptr, shown_background(object), scene.integration.tolerance, {}};
  bool is_first = true;
  try {
    const ReleasedLock released;
    const auto ranks = handle ? mpi_communicator(handle) : single_rank();
    is_first = ranks->rank() == 0;
    if (box) agree_on_ranges(*ranks, {}, scene);
    RankResult frame = box ? render(*ranks, tree_of(*ranks, *box), scene, options)
                           : render(*ranks, scene, options);
    image.image = std::make_shared<const Image>(std::move(frame.image));
    image.report = frame.report.frame;
  } catch (const Cancelled&) {
    if (raised) std::rethrow_exception(raised);
    throw;
  }
  return is_first ? py::cast(image) : py::none();
}

}  // namespace

void bind_ranks(py::module_& module) {
  module.def("render_on_ranks", &render_on_ranks, py::arg("scene"), py::arg("handle") = py::none(),
             py::arg("lower") = py::none(), py::arg("upper") = py::none(), py::kw_only(),
             py::arg("depth") = false, py::arg("values") = false, py::arg("threads") = 1,
             py::arg("progress") = py::none(), "See pellucid.render_on_ranks().");
}

}  // namespace pellucid::python
