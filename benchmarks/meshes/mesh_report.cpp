// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/meshes/mesh_report.h"

#include <algorithm>
#include <cmath>

#include "benchmarks/support/document.h"

namespace pellucid::bench {
namespace {

constexpr const char* vtk_names[] = {"VTK linear", "VTK default", "VTK ZSweep"};

std::string milliseconds(double seconds) {
  const double ms = 1e3 * seconds;
  return format(ms < 10 ? "%.1f ms" : "%.0f ms", ms);
}

/// A way that knows no threads is measured on one, and is that on all.
const MeshWay* on_threads(const MeshResult& result, const std::string& name, int threads) {
  const MeshWay* way = result.find(name, threads);
  return way == nullptr && name == vtk_names[2] ? result.find(name, 1) : way;
}

std::string error_cell(const PixelError& error) {
  return std::isfinite(error.largest) ? format("%.1e (%.1e)", error.largest, error.rms)
                                      : "not finite";
}

std::string rule(std::size_t columns) {
  std::string text = "|";
  for (std::size_t i = 0; i < columns; ++i) text += "---|";
  return text + "\n";
}

}  // namespace

std::string frame_times_table(const std::vector<MeshResult>& results,
                              const std::vector<int>& threads) {
  std::string text = "| mesh, scene | threads | exact | exact, proved |";
  for (const char* name : vtk_names) text += std::string(" ") + name + " |";
  text += "\n" + rule(7);
  for (const MeshResult& result : results) {
    for (const int count : threads) {
      const MeshWay* exact = result.find(mesh_estimated_name, count);
      const MeshWay* proved = result.find(mesh_proved_name, count);
      if (exact == nullptr || proved == nullptr) continue;
      text += "| " + result.name + format(" | %d | ", count) +
              milliseconds(exact->median_seconds()) + " | " +
              milliseconds(proved->median_seconds()) + " |";
      for (const char* name : vtk_names) {
        const MeshWay* way = on_threads(result, name, count);
        text += way == nullptr
                    ? std::string(" — |")
                    : " " + milliseconds(way->median_seconds()) +
                          format(" **%.2g×** |", way->median_seconds() / exact->median_seconds());
      }
      text += "\n";
    }
  }
  return text;
}

std::string frame_errors_table(const std::vector<MeshResult>& results) {
  std::string text = "| mesh, scene | exact | exact, proved |";
  for (const char* name : vtk_names) text += std::string(" ") + name + " |";
  text += " NaN pixels of linear, default |\n" + rule(7);
  for (const MeshResult& result : results) {
    text += "| " + result.name + " |";
    for (const char* name :
         {mesh_estimated_name, mesh_proved_name, vtk_names[0], vtk_names[1], vtk_names[2]}) {
      const MeshWay* way = result.find(name);
      text += way == nullptr ? std::string(" — |") : " " + error_cell(way->error) + " |";
    }
    const MeshWay *linear = result.find(vtk_names[0]), *other = result.find(vtk_names[1]);
    text += linear == nullptr || other == nullptr
                ? std::string(" — |\n")
                : format(" %llu, %llu |\n", static_cast<unsigned long long>(linear->nan_pixels),
                         static_cast<unsigned long long>(other->nan_pixels));
  }
  return text;
}

std::string segment_costs_table(const std::vector<MeshResult>& results) {
  std::string text =
      "| mesh, scene | tetrahedra | pieces, exact | exact | exact, proved | pieces, VTK | VTK "
      "linear | VTK default |\n" +
      rule(8);
  for (const MeshResult& result : results) {
    const auto cost = [&](const char* name) {
      const MeshWay* way = result.find(name, 1);
      return way == nullptr || way->segments == 0
                 ? std::string(" — |")
                 : format(" %.1f ns |",
                          1e9 * way->median_seconds() / static_cast<double>(way->segments));
    };
    const auto pieces = [&](const char* name) {
      const MeshWay* way = result.find(name);
      return way == nullptr ? std::string(" — |")
                            : format(" %.2f M |", 1e-6 * static_cast<double>(way->segments));
    };
    text += "| " + result.name +
            format(" | %.3g M |", 1e-6 * static_cast<double>(result.tetrahedra)) +
            pieces(mesh_estimated_name) + cost(mesh_estimated_name) + cost(mesh_proved_name) +
            pieces(vtk_names[0]) + cost(vtk_names[0]) + cost(vtk_names[1]) + "\n";
  }
  return text;
}

std::string segments_table(const SegmentStudy& study) {
  std::string text = "| kernel | all rows | rows of depth ≤ 2 | largest error | rows |\n" + rule(5);
  for (const SegmentResult& result : study.results) {
    text += "| " + result.name +
            format(" | %.1f ns | %.1f ns | %.1e | %zu |\n", result.nanoseconds,
                   result.nanoseconds_thin, result.error, result.rows);
  }
  return text;
}

std::string contrasts_table(const SegmentStudy& study) {
  std::string text = "| kernel |";
  for (const double contrast : study.contrasts) text += format(" %.0e |", contrast);
  text += "\n" + rule(study.contrasts.size() + 1);
  for (const SegmentResult& result : study.results) {
    text += "| " + result.name + " |";
    for (const double error : result.contrast_error) text += format(" %.1e |", error);
    text += "\n";
  }
  return text;
}

Plot contrasts_plot(const SegmentStudy& study) {
  Plot plot;
  plot.title = "A segment whose ends are almost alike";
  plot.x_label = "|τ_b − τ_f| / τ_f";
  plot.y_label = "largest error of color and opacity";
  for (const SegmentResult& result : study.results) {
    const bool vtk = result.name.starts_with("VTK");
    if (!vtk && result.name != "float" && result.name != "double") continue;
    PlotLine line{vtk ? result.name : "ours, " + result.name, {}, !vtk, vtk};
    line.points.reserve(study.contrasts.size());
    for (std::size_t i = 0; i < study.contrasts.size(); ++i) {
      line.points.push_back({study.contrasts[i], result.contrast_error[i], ""});
    }
    plot.lines.push_back(std::move(line));
  }
  return plot;
}

std::string building_table(const std::vector<BuildResult>& results,
                           const std::vector<int>& threads) {
  std::string text = "| mesh | tetrahedra | bytes each, mesh | bytes each, all told |";
  for (const int count : threads) {
    const char* const plural = count == 1 ? "" : "s";
    text += format(" cut and build, %d thread%s | build alone, %d thread%s |", count, plural, count,
                   plural);
  }
  text += "\n" + rule(4 + 2 * threads.size());
  for (const BuildResult& result : results) {
    const auto millions = [&](double seconds) {
      return 1e-6 * static_cast<double>(result.tetrahedra) / seconds;
    };
    text +=
        "| " + result.name +
        format(" | %zu | %.0f | %.0f |", result.tetrahedra, result.mesh_bytes, result.total_bytes);
    for (std::size_t i = 0; i < threads.size(); ++i) {
      text += format(" %.2f M/s | %.2f M/s |", millions(result.cut_seconds[i]),
                     millions(result.mesh_seconds[i]));
    }
    text += "\n";
  }
  return text;
}

std::string reconstruction_table(const std::vector<ReconstructionResult>& results) {
  std::string text =
      "| data | transfer function | largest | root mean square | pixels over 1/512 |\n" + rule(5);
  for (const ReconstructionResult& result : results) {
    text +=
        "| " + result.data + " | " + result.transfer_function +
        format(" | %.2g | %.2g | %.2g %% |\n", result.largest, result.rms, 100 * result.share_over);
  }
  return text;
}

nlohmann::ordered_json to_json(const std::vector<MeshResult>& results) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const MeshResult& result : results) {
    nlohmann::ordered_json ways = nlohmann::ordered_json::array();
    for (const MeshWay& way : result.ways) {
      ways.push_back({{"name", way.name},
                      {"threads", way.threads},
                      {"seconds", way.seconds},
                      {"largest_error", way.error.largest},
                      {"rms_error", way.error.rms},
                      {"segments", way.segments},
                      {"nan_pixels", way.nan_pixels}});
    }
    list.push_back({{"name", result.name},
                    {"tetrahedra", result.tetrahedra},
                    {"pixels", result.pixels},
                    {"ways", std::move(ways)}});
  }
  return list;
}

nlohmann::ordered_json to_json(const SegmentStudy& study) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const SegmentResult& result : study.results) {
    list.push_back({{"kernel", result.name},
                    {"nanoseconds", result.nanoseconds},
                    {"nanoseconds_to_depth_2", result.nanoseconds_thin},
                    {"largest_error", result.error},
                    {"rows", result.rows},
                    {"contrast_errors", result.contrast_error}});
  }
  return {{"contrasts", study.contrasts}, {"kernels", std::move(list)}};
}

nlohmann::ordered_json to_json(const std::vector<BuildResult>& results,
                               const std::vector<int>& threads) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const BuildResult& result : results) {
    list.push_back({{"name", result.name},
                    {"tetrahedra", result.tetrahedra},
                    {"threads", threads},
                    {"cut_seconds", result.cut_seconds},
                    {"mesh_seconds", result.mesh_seconds},
                    {"mesh_bytes", result.mesh_bytes},
                    {"total_bytes", result.total_bytes}});
  }
  return list;
}

nlohmann::ordered_json to_json(const std::vector<ReconstructionResult>& results) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ReconstructionResult& result : results) {
    list.push_back({{"data", result.data},
                    {"transfer_function", result.transfer_function},
                    {"largest", result.largest},
                    {"rms", result.rms},
                    {"share_over", result.share_over}});
  }
  return list;
}

}  // namespace pellucid::bench
