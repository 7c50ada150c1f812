// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/frames/report.h"

#include <algorithm>
#include <cmath>

#include "benchmarks/frames/pellucid_contenders.h"
#include "benchmarks/support/document.h"

namespace pellucid::bench {
namespace {

std::string milliseconds(double seconds) {
  const double ms = 1e3 * seconds;
  return ms < 10 ? format("%.1f ms", ms) : format("%.0f ms", ms);
}

std::string ratio(double seconds, double base) {
  const double r = seconds / base;
  return r < 10 ? format("%.2g×", r) : format("%.0f×", r);
}

/// "41 ms (1.1e-03)": time and largest error.
std::string time_and_error(const CurvePoint* point) {
  if (point == nullptr) return "—";
  return milliseconds(point->median_seconds()) + format(" (%.1e)", point->error.largest);
}

const CurvePoint* at_setting(const Curve* curve, double setting) {
  if (curve == nullptr) return nullptr;
  for (const CurvePoint& point : curve->points) {
    if (point.setting == setting) return &point;
  }
  return nullptr;
}

/// "12× midpoint 0.07"; "> 80×: 3.1e-3 midpoint 0.02" where it is not reached.
std::string sampler_cell(const SceneResult& result, double error, const Reach& exact) {
  const BestSampler best = best_sampler(result, error);
  if (best.curve == nullptr) return "—";
  const Reach& r = best.reach;
  const std::string who = best.curve->name + format(" %.2g", r.setting);
  const double base = exact.seconds;
  if (r.reached) {
    return exact.reached ? "**" + ratio(r.seconds, base) + "** " + who
                         : milliseconds(r.seconds) + " " + who;
  }
  const std::string after = exact.reached ? ratio(r.seconds, base) : milliseconds(r.seconds);
  if (r.may_go_on) return "**> " + after + format("**: %.1e ", r.error) + who;
  return format("never: %.1e after ", r.error) + after + ", " + who;
}

std::string vtk_cell(const CurvePoint* point, double base) {
  if (point == nullptr) return "—";
  return ratio(point->median_seconds(), base) + ", " + milliseconds(point->median_seconds()) +
         format(" (%.1e / %.1e)", point->error.rms, point->error.largest);
}

/// What peers measured of Open VKL 1.3: ISPC, AVX-512, one thread, 512 x 512, on a Xeon with 2.3
/// GHz.
struct OpenVklFrame {
  const char* scene;
  double milliseconds, error;            // one sample per voxel
  double fine_milliseconds, fine_error;  // ten
};
constexpr OpenVklFrame open_vkl[] = {{"haze, oblique", 483, 9.7e-5, 4056, 4.0e-6},
                                     {"band, oblique", 355, 9.4e-3, 2431, 7.0e-5},
                                     {"spike, oblique", 355, 0.32, 2430, 1.7e-3}};

std::string setting_name(double setting, Knob knob) {
  return knob == Knob::tolerance ? error_name(setting) : format("%g", setting);
}

}  // namespace

BestSampler best_sampler(const SceneResult& result, double error) {
  BestSampler best;
  for (const Curve& curve : result.curves) {
    if (!is_our_sampler(curve.name)) continue;
    const Reach one = reach(curve, error, ErrorKind::largest);
    const bool better =
        best.curve == nullptr || (one.reached && !best.reach.reached) ||
        (one.reached == best.reach.reached &&
         (one.reached ? one.seconds < best.reach.seconds : one.error < best.reach.error));
    if (better) best = {&curve, one};
  }
  return best;
}

std::string error_name(double error) {
  if (error == 1.0 / 512) return "1/512";
  std::string text = format("%.0e", error);
  const std::size_t zero = text.find("e-0");
  return zero == std::string::npos ? text : text.erase(zero + 2, 1);
}

std::string equal_error_table(const std::vector<SceneResult>& results) {
  std::string text = "| scene |", line = "|---|";
  for (const double error : compared_errors) {
    text += " exact to " + error_name(error) + " | best sampler |";
    line += "---|---|";
  }
  text += "\n" + line + "\n";
  for (const SceneResult& r : results) {
    const Curve* exact = r.find(exact_name);
    if (exact == nullptr) continue;
    text += "| " + r.name + " |";
    for (const double error : compared_errors) {
      const Reach own = reach(*exact, error, ErrorKind::largest);
      text += own.reached
                  ? " " + milliseconds(own.seconds) + " at " + error_name(own.setting) + " |"
                  : format(" not reached: %.1e |", own.error);
      text += " " + sampler_cell(r, error, own) + " |";
    }
    text += "\n";
  }
  return text;
}

std::string exact_table(const std::vector<SceneResult>& results) {
  constexpr double shown[] = {1e-2, 1.0 / 512, 1e-4, 1e-6}, shown_proved[] = {1.0 / 512, 1e-4};
  std::string text = "| scene | data |", line = "|---|---|";
  for (const double tolerance : shown) {
    text += " " + error_name(tolerance) + " |";
    line += "---|";
  }
  for (const double tolerance : shown_proved) {
    text += " proved " + error_name(tolerance) + " |";
    line += "---|";
  }
  text += "\n" + line + "\n";
  for (const SceneResult& r : results) {
    text += "| " + r.name + " | " + r.data + " |";
    for (const double tolerance : shown) {
      text += " " + time_and_error(at_setting(r.find(exact_name), tolerance)) + " |";
    }
    for (const double tolerance : shown_proved) {
      text += " " + time_and_error(at_setting(r.find(proved_name), tolerance)) + " |";
    }
    text += "\n";
  }
  return text;
}

std::string vtk_table(const std::vector<SceneResult>& results) {
  std::string text;
  for (const SceneResult& r : results) {
    const Curve* exact = r.find(exact_name);
    const CurvePoint* own = at_setting(exact, 1.0 / 512);
    const Curve* fixed = r.find("VTK fixed point");
    if (own == nullptr || fixed == nullptr) continue;
    const double base = own->median_seconds();
    const Reach fine = reach(*exact, 1e-4, ErrorKind::rms);
    const Curve* smart = r.find("VTK smart");
    text += "| " + r.name + " | " + milliseconds(base) +
            format(" (%.1e / %.1e) | ", own->error.rms, own->error.largest) +
            vtk_cell(at_setting(fixed, 1), base) + " | " +
            vtk_cell(at_setting(r.find("VTK GPU mapper"), 1), base) + " | " +
            (fine.reached ? milliseconds(fine.seconds) : format("not reached: %.1e", fine.error)) +
            " | " +
            (smart == nullptr || smart->points.empty()
                 ? std::string("—")
                 : vtk_cell(&smart->points.front(), fine.seconds));
    double least = INFINITY;
    for (const Curve& curve : r.curves) {
      if (!curve.name.starts_with("VTK")) continue;
      least = std::min(least, reach(curve, 0, ErrorKind::rms).error);
    }
    text += format(" | %.1e |\n", least);
  }
  if (text.empty()) return {};
  return "| scene | exact at 1/512 | fixed point, 1 voxel | GPU mapper, 1 voxel | exact to RMS "
         "1e-4 | smart, default | least RMS of VTK |\n|---|---|---|---|---|---|---|\n" +
         text;
}

std::string open_vkl_table(const std::vector<SceneResult>& results) {
  std::string text;
  for (const OpenVklFrame& peer : open_vkl) {
    for (const SceneResult& r : results) {
      const Curve* exact = r.find(exact_name);
      if (r.name != peer.scene || exact == nullptr) continue;
      const CurvePoint* own = at_setting(exact, 1.0 / 512);
      if (own == nullptr) continue;
      const double base = own->median_seconds();
      text += "| " + r.name + " | " + milliseconds(base) + format(" (%.1e) | ", own->error.largest);
      text += ratio(1e-3 * peer.milliseconds, base) +
              format(", %.0f ms (%.1e) | ", peer.milliseconds, peer.error);
      text += ratio(1e-3 * peer.fine_milliseconds, base) +
              format(", %.0f ms (%.1e) |\n", peer.fine_milliseconds, peer.fine_error);
    }
  }
  if (text.empty()) return {};
  return "| scene | exact at 1/512, here | Open VKL at 1 voxel, published | at 0.1 voxel, "
         "published "
         "|\n|---|---|---|---|\n" +
         text;
}

std::string frames_markdown(const std::vector<SceneResult>& results, int threads,
                            const std::string& plot_folder) {
  std::string text = format("Frames on %d thread%s. ", threads, threads == 1 ? "" : "s");
  if (!results.empty()) {
    const SceneResult& r = results.front();
    text += format("Images of %d×%d, of which %zu pixels are held against the reference.\n",
                   r.size.width, r.size.height, r.pixels);
  }
  text += "\n### At an equal largest error\n\n" + equal_error_table(results) +
          "\n### Exact at its tolerances\n\nTime (largest error).\n\n" + exact_table(results);
  if (const std::string table = vtk_table(results); !table.empty()) {
    text +=
        "\n### Beside VTK\n\nTime (RMS / largest error); times of VTK also as ratios to the "
        "column of exact to their left.\n\n" +
        table;
  }
  if (threads == 1) {
    if (const std::string table = open_vkl_table(results); !table.empty()) {
      text +=
          "\n### Beside Open VKL\n\nIts figures are published ones, of one thread of a Xeon with "
          "AVX-512 at 2.3 GHz, not measured here: ratios hold across machines only roughly. Time "
          "(largest error).\n\n" +
          table;
    }
  }
  std::vector<std::string> missing;
  for (const SceneResult& r : results) {
    for (const std::string& one : r.left_out) {
      if (std::find(missing.begin(), missing.end(), one) == missing.end()) missing.push_back(one);
    }
  }
  for (const std::string& one : missing) text += "\nLeft out: " + one + ".\n";
  if (plot_folder.empty()) return text;
  text += "\n### Curves\n\n";
  for (const SceneResult& r : results) {
    text +=
        "![Time and error: " + r.name + "](" + plot_folder + "/" + plot_file(r, threads) + ")\n";
  }
  return text;
}

nlohmann::ordered_json frames_json(const std::vector<SceneResult>& results) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const SceneResult& r : results) {
    nlohmann::ordered_json scene{{"name", r.name},
                                 {"data", r.data},
                                 {"image", {r.size.width, r.size.height}},
                                 {"pixels_compared", r.pixels},
                                 {"curves", nlohmann::ordered_json::array()}};
    if (!r.left_out.empty()) scene["left_out"] = r.left_out;
    for (const Curve& curve : r.curves) {
      nlohmann::ordered_json entry{{"name", curve.name}, {"cut_short", curve.cut_short}};
      const char* knob = curve.knob == Knob::tolerance ? "tolerance" : "step";
      for (const CurvePoint& p : curve.points) {
        entry["points"].push_back({{knob, p.setting},
                                   {"seconds", p.median_seconds()},
                                   {"runs", p.seconds},
                                   {"largest_error", p.error.largest},
                                   {"rms_error", p.error.rms},
                                   {"cells_or_samples", p.work}});
      }
      scene["curves"].push_back(std::move(entry));
    }
    list.push_back(std::move(scene));
  }
  return list;
}

std::string plot_file(const SceneResult& result, int threads) {
  std::string name;
  for (const char c : result.name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.';
    if (plain) {
      name += c;
    } else if (!name.empty() && name.back() != '-') {
      name += '-';
    }
  }
  return name + format("-%d.svg", threads);
}

Plot time_error_plot(const SceneResult& result, int threads) {
  Plot plot;
  plot.title = result.name + format(" — %d×%d, %d thread%s", result.size.width, result.size.height,
                                    threads, threads == 1 ? "" : "s");
  plot.x_label = "time of a frame in ms";
  plot.y_label = "largest error";
  for (const double error : compared_errors) plot.marks.push_back({error, error_name(error)});
  for (const Curve& curve : result.curves) {
    PlotLine line;
    line.name = curve.name;
    line.thick = curve.name == exact_name;
    line.dashed = curve.name.starts_with("VTK");
    for (const CurvePoint& p : curve.points) {
      line.points.push_back(
          {1e3 * p.median_seconds(), p.error.largest,
           curve.points.size() == 1 ? std::string() : setting_name(p.setting, curve.knob)});
    }
    plot.lines.push_back(std::move(line));
  }
  return plot;
}

}  // namespace pellucid::bench
