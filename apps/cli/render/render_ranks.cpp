// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "arguments/output.h"
#include "arguments/parse.h"
#include "pellucid/cluster/communicator.h"
#include "pellucid/cluster/load.h"
#include "pellucid/cluster/render.h"
#include "pellucid/cpu/framed_camera.h"
#include "pellucid/cpu/threads.h"
#include "pellucid/scene/internal/label_values.h"
#include "progress.h"
#include "render.h"
#include "tolerance.h"

namespace pellucid::cli {

namespace {

/// Refuses arguments that need all of the data in one process.
void refuse_arguments(const RenderArguments& arguments) {
  const std::pair<const char*, bool> given[] = {
      {"--reference", arguments.reference},
      {"--print-tf", arguments.print_tf},
      {"--range in percent", arguments.colors.asks_data()},
      {"--save-tf", !arguments.save_tf.empty()},
      {"--figure", !arguments.figure.files.empty()},
      {"--device", !arguments.device.empty() && arguments.device != "cpu"},
      {"--method", !arguments.method.empty() && arguments.method != "exact"}};
  for (const auto& [argument, is_given] : given) {
    if (!is_given) continue;
    throw UsageError(fmt::format("{}: is not done by --ranks; drop one of the two", argument));
  }
  if (!arguments.renders()) throw UsageError("--ranks: nothing to render; give -o FILE.png");
}

/// Returns the largest part of the memory that this process has had at any time, in MiB.
double most_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

std::vector<double> gather(Communicator& ranks, double own) {
  std::vector<double> numbers(static_cast<std::size_t>(ranks.size()), 0);
  numbers[static_cast<std::size_t>(ranks.rank())] = own;
  ranks.reduce_all(numbers, Communicator::Reduction::sum);
  return numbers;
}

std::string ranks_json(Communicator& ranks, const RankReport& report) {
  const std::vector<double> memory = gather(ranks, most_memory());
  return fmt::format(R"({{"count": {}, "most_bricks_on_a_ray": {}, "render_seconds": [{}], )"
                     R"("composite_seconds": [{}], "memory_mib": [{:.1f}], )"
                     R"("parts_rendered_again": {}}})",
                     ranks.size(), report.most_bricks, fmt::join(report.render_seconds, ", "),
                     fmt::join(report.composite_seconds, ", "), fmt::join(memory, ", "),
                     report.parts_again);
}

/// The work of one rank, on which all agree.
class RankRun {
 public:
  RankRun(RenderArguments arguments, Communicator& ranks)
      : arguments_(std::move(arguments)), ranks_(ranks) {
    // The first rank speaks for all.
    if (ranks_.rank() != 0) arguments_.quiet = true;
  }

  void operator()() {
    agreed_on_arguments([&] {
      refuse_arguments(arguments_);
      if (ranks_.rank() == 0) check_arguments(arguments_);
    });
    SceneRequest request;
    agreed_on_arguments([&] {
      request = request_scene(arguments_);
      const Integration& integration = request.prepared.description.integration;
      if (!integration.relative_tolerance || !knows_its_error(arguments_, integration)) return;
      throw UsageError(
          "--tolerance: a share of the picture's range is not found by --ranks; give " +
          std::string("a number"));
    });
    const BrickBalance balance =
        arguments_.balance == "data" ? BrickBalance::data : BrickBalance::work;
    const ParallelFor parallel =
        parallel_for(arguments_.threads > 0 ? arguments_.threads : default_thread_count());
    BrickedScene bricks = load_bricks(ranks_, request.description, balance, parallel);
    PreparedScene prepared;
    agreed(ranks_, [&] {
      prepared = complete_scene(arguments_, std::move(request), std::move(bricks.scene),
                                bricks.meshes, [&](const Scene&) { return bricks.visible; });
    });
    for (std::size_t i = 0; i < bricks.dimensions.size(); ++i) {
      prepared.whole_layers.push_back({bricks.dimensions[i], bricks.nan[i]});
    }
    find_labels(prepared);
    place_camera(bricks.tree, prepared);
    RenderedPicture picture;
    RankResult frame = render_frame(bricks.tree, prepared);
    picture.image = std::move(frame.image);
    picture.report = frame.report.frame;
    picture.ranks_json = ranks_json(ranks_, frame.report);
    picture.notes = std::move(bricks.notes);
    picture.over = over_tolerance(picture.report, prepared.scene.integration);
    // The first rank alone has the report of the whole picture.
    std::vector<double> is_over{ranks_.rank() == 0 && picture.over ? 1.0 : 0.0};
    ranks_.reduce_all(is_over, Communicator::Reduction::maximum);
    over_ = is_over[0] > 0;
    std::optional<std::string> over;
    agreed(ranks_, [&] {
      if (ranks_.rank() != 0) return;
      try {
        write_picture(arguments_, prepared, "", picture);
      } catch (const OverTolerance& error) {
        over = error.what();
      }
    });
    if (over) throw OverTolerance(*over);
  }
  bool is_over() const noexcept { return over_; }
  /// Returns whether this rank found its arguments wrong.
  bool is_wrong_use() const noexcept { return wrong_use_; }

 private:
  void agreed_on_arguments(const std::function<void()>& work) {
    agreed(ranks_, [&] {
      try {
        work();
      } catch (const UsageError&) {
        wrong_use_ = true;
        throw;
      }
    });
  }
  /// Finds volumes that look like labels: those that do on every rank.
  void find_labels(PreparedScene& prepared) {
    // A line for each volume: its name, and its values, or "no".
    std::string own;
    std::vector<std::string> names;
    agreed(ranks_, [&] {
      const std::vector<Layer>& layers = prepared.scene.layers;
      for (std::size_t i = 0; i < layers.size(); ++i) {
        visit_fields_of_files(layers[i], prepared.description.layers[i], i, layers.size(),
                              [&](const std::string& name, const Volume& volume) {
                                names.push_back(name);
                                const auto values = label_values_of_part(volume);
                                own +=
                                    values ? fmt::format("{}\n", fmt::join(*values, " ")) : "no\n";
                              });
      }
    });
    std::vector<std::set<std::string>> values(names.size());
    for (const std::string& rank : ranks_.gather_all(own)) {
      std::istringstream lines(rank);
      std::string line, value;
      for (std::size_t n = 0; n < names.size() && std::getline(lines, line); ++n) {
        std::istringstream words(line);
        while (words >> value) values[n].insert(value);
      }
    }
    for (std::size_t n = 0; n < names.size(); ++n) {
      if (values[n].size() < 2 || values[n].contains("no")) continue;
      prepared.labels.emplace_back(names[n], values[n].size());
    }
  }

  /// Places the camera. Rank 0 frames what is seen; all ranks render its drafts, and take its
  /// camera.
  void place_camera(const BrickTree& tree, PreparedScene& prepared) {
    Scene draft = draft_scene(prepared.scene);
    cli::place_camera(arguments_, prepared, [&](const Scene& scene) {
      const RenderOptions options = quiet_options_of(arguments_);
      return framed_camera(scene.camera, scene.size, [&](const Camera& camera, ImageSize size) {
        draft.camera = camera;
        draft.size = size;
        Image image = render(ranks_, tree, draft, options).image;
        image.width = size.width;
        image.height = size.height;
        image.pixels.resize(static_cast<std::size_t>(size.width) *
                            static_cast<std::size_t>(size.height));
        ranks_.broadcast({image.pixels.front().data(), image.pixels.size() * 4});
        return image;
      });
    });
  }

  RankResult render_frame(const BrickTree& tree, const PreparedScene& prepared) {
    RenderOptions options = options_of(arguments_, prepared);
    ProgressLine progress(!arguments_.quiet);
    options.monitor.progress = [&](double share_done) {
      progress.show(share_done);
      return !InterruptGuard::interrupted();
    };
    return render(ranks_, tree, prepared.scene, options);
  }

  RenderArguments arguments_;
  Communicator& ranks_;
  bool over_ = false, wrong_use_ = false;
};

}  // namespace

bool is_rank(int argc, char** argv) {
  return is_under_mpi() && std::find(argv, argv + argc, std::string_view("--ranks")) != argv + argc;
}

int fail_on_ranks(const std::string& wrong_use) {
  const std::unique_ptr<Communicator> ranks = mpi_communicator();
  try {
    // The first that ranks whose arguments are right agree on, too.
    agreed(*ranks, [&] { throw UsageError(wrong_use); });
  } catch (const AgreedError& error) {
    if (ranks->rank() == 0) print_error(error.what());
  }
  static_cast<void>(ranks->gather_all(""));
  return 2;
}

int run_on_ranks(const RenderArguments& arguments) {
  const std::unique_ptr<Communicator> ranks = is_under_mpi() ? mpi_communicator() : single_rank();
  const InterruptGuard guard;
  const bool speaks = ranks->rank() == 0;
  int status = 0;
  std::string message;
  RankRun run(arguments, *ranks);
  try {
    run();
    if (run.is_over()) status = 3;
  } catch (const OverTolerance& error) {
    status = 3;
    message = error.what();
  } catch (const AgreedError& error) {
    status = run.is_wrong_use() ? 2 : 1;
    message = error.what();
  } catch (const Cancelled&) {
    status = 130;
    message = "interrupted; nothing more was written";
  } catch (const std::exception& error) {
    // The others do not know of it, and may wait for this rank.
    print_error(fmt::format("rank {}: {}", ranks->rank(), error.what()));
    ranks->abort(1);
  }
  if (speaks && !message.empty()) print_error(message);
  // A launcher ends all ranks when one ends with a failure: not before the message is out.
  static_cast<void>(ranks->gather_all(""));
  return status;
}

}  // namespace pellucid::cli
