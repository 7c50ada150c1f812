// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/frames/matrix_report.h"

#include <algorithm>
#include <cmath>

#include "benchmarks/support/document.h"

namespace pellucid::bench {
namespace {

using scenes::grade_name;
using scenes::MatrixCell;
using scenes::MatrixRow;

constexpr Grade grades[] = {Grade::estimated, Grade::proved};

std::string tolerance_name(double tolerance) {
  return tolerance == 1.0 / 512 ? "1/512" : format("%.0e", tolerance);
}

std::vector<std::string> scene_names(const std::vector<MatrixRow>& rows) {
  std::vector<std::string> names;
  for (const MatrixRow& row : rows) {
    if (names.empty() || names.back() != row.scene) names.push_back(row.scene);
  }
  return names;
}

std::vector<double> tolerances(const std::vector<MatrixRow>& rows) {
  std::vector<double> list;
  if (rows.empty()) return list;
  for (const MatrixCell& cell : rows.front().cells) {
    if (list.empty() || list.back() != cell.tolerance) list.push_back(cell.tolerance);
  }
  return list;
}

/// Calls visit(row, cell) for the frames that pass: an empty name is every scene, a tolerance of 0
/// any.
template <class Visit>
void for_each_cell(const std::vector<MatrixRow>& rows, const std::string& scene, double tolerance,
                   Grade grade, Visit&& visit) {
  for (const MatrixRow& row : rows) {
    if (!scene.empty() && row.scene != scene) continue;
    for (const MatrixCell& cell : row.cells) {
      if (cell.grade == grade && (tolerance == 0 || cell.tolerance == tolerance)) visit(row, cell);
    }
  }
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : std::sqrt(values[n / 2 - 1] * values[n / 2]);
}

std::string header(const std::vector<std::string>& first, const std::vector<double>& columns) {
  std::string text = "|", line = "|";
  for (const std::string& name : first) {
    text += " " + name + " |";
    line += "---|";
  }
  for (const double tolerance : columns) {
    text += " " + tolerance_name(tolerance) + " |";
    line += "---|";
  }
  return text + "\n" + line + "\n";
}

std::string share_of_tolerance(const std::vector<MatrixRow>& rows, const std::string& scene,
                               double tolerance, Grade grade) {
  double found = 0;
  int over = 0, too_bright = 0, over_reported = 0, said_over = 0;
  for_each_cell(rows, scene, tolerance, grade, [&](const MatrixRow&, const MatrixCell& cell) {
    found = std::max(found, cell.verdict.found);
    over += cell.verdict.over;
    too_bright += cell.verdict.too_bright;
    over_reported += cell.verdict.over_reported;
    said_over += cell.verdict.said_over;
  });
  std::string text = found == 0 ? "0" : format("%.2g", found / tolerance);
  if (over > 0) text = "**" + text + format("**, %d over", over);
  if (over_reported > 0) text += format(", %d above their report", over_reported);
  if (too_bright > 0) text += format(", %d too bright", too_bright);
  if (said_over > 0) text += format(" (%d)", said_over);
  return text;
}

std::string error_table(const std::vector<MatrixRow>& rows, Grade grade) {
  const std::vector<double> columns = tolerances(rows);
  std::string text = header({"scene"}, columns);
  for (const std::string& scene : scene_names(rows)) {
    text += "| " + scene + " |";
    for (const double tolerance : columns) {
      text += " " + share_of_tolerance(rows, scene, tolerance, grade) + " |";
    }
    text += "\n";
  }
  return text;
}

/// "median (least to most)" of asked / found, and the median of reported / found.
std::string tightness(const std::vector<MatrixRow>& rows, const std::string& scene, Grade grade) {
  std::vector<double> asked, reported;
  double share = INFINITY;
  for_each_cell(rows, scene, 0, grade, [&](const MatrixRow&, const MatrixCell& cell) {
    share = std::min(share, cell.verdict.min_share);
    if (!(cell.verdict.found > 0)) return;
    asked.push_back(cell.tolerance / cell.verdict.found);
    reported.push_back(cell.verdict.reported / cell.verdict.found);
  });
  if (asked.empty()) return " – | – | – |";
  const auto [least, most] = std::minmax_element(asked.begin(), asked.end());
  return format(" %.3g (%.2g to %.2g) | %.3g | %.4g |", median(asked), *least, *most,
                median(reported), share);
}

std::string tightness_table(const std::vector<MatrixRow>& rows) {
  std::string text =
      "| scene | estimated: asked / found | reported / found | least of a pixel | proved: asked / "
      "found | reported / found | least of a pixel |\n|---|---|---|---|---|---|---|\n";
  std::vector<std::string> names = scene_names(rows);
  names.emplace_back();
  for (const std::string& scene : names) {
    text += "| " + (scene.empty() ? "**all**" : scene) + " |";
    for (const Grade grade : grades) text += tightness(rows, scene, grade);
    text += "\n";
  }
  return text;
}

double evaluations(const std::vector<MatrixRow>& rows, const std::string& scene, double tolerance,
                   Grade grade) {
  std::uint64_t sum = 0, rays = 0;
  for_each_cell(rows, scene, tolerance, grade, [&](const MatrixRow&, const MatrixCell& cell) {
    sum += cell.report.evaluations;
    rays += cell.report.rays;
  });
  return static_cast<double>(sum) / static_cast<double>(rays);
}

double sampling(const std::vector<MatrixRow>& rows, const std::string& scene, double* error) {
  double sum = 0;
  int count = 0;
  for (const MatrixRow& row : rows) {
    if (row.scene != scene) continue;
    sum += row.sampling_per_ray;
    if (error != nullptr) *error = std::max(*error, row.sampling_error);
    ++count;
  }
  return sum / count;
}

std::string work_table(const std::vector<MatrixRow>& rows, Grade grade) {
  const std::vector<double> columns = tolerances(rows);
  std::string text = header({"scene", "one-voxel sampling (its error)"}, columns);
  for (const std::string& scene : scene_names(rows)) {
    double error = 0;
    const double base = sampling(rows, scene, &error);
    text += "| " + scene + format(" | %.3g (%.1e) |", base, error);
    for (const double tolerance : columns) {
      const double work = evaluations(rows, scene, tolerance, grade);
      text += format(" %.3g, %.2g× |", work, work / base);
    }
    text += "\n";
  }
  return text;
}

std::string rules_table(const std::vector<MatrixRow>& rows, double tolerance) {
  std::string text =
      "| scene | grade | pixels proved | skipped | constant | strides | lines | closed | panels | "
      "in double |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const std::string& scene : scene_names(rows)) {
    for (const Grade grade : grades) {
      RuleCounts spans;
      std::uint64_t proved = 0, pixels = 0, rays = 0;
      for_each_cell(rows, scene, tolerance, grade, [&](const MatrixRow&, const MatrixCell& cell) {
        spans += cell.report.spans;
        proved += cell.report.pixels_proved;
        pixels += cell.report.pixels;
        rays += cell.report.rays;
      });
      text +=
          "| " + scene + " | " + grade_name(grade) +
          format(" | %.3g %% |", 100 * static_cast<double>(proved) / static_cast<double>(pixels));
      for (const std::uint64_t count : {spans.skipped, spans.constant, spans.strides, spans.lines,
                                        spans.closed, spans.panels, spans.in_double}) {
        text += format(" %.3g |", static_cast<double>(count) / static_cast<double>(rays));
      }
      text += "\n";
    }
  }
  return text;
}

std::string summary_table(const std::vector<MatrixRow>& rows) {
  std::string text =
      "| tolerance | grade | largest found / asked | median found / asked | pixels proved | pixels "
      "that report more | evaluations per ray | time per ray |\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const double tolerance : tolerances(rows)) {
    for (const Grade grade : grades) {
      std::vector<double> shares;
      double most = 0, seconds = 0;
      std::uint64_t proved = 0, pixels = 0, said_over = 0, rays = 0;
      for_each_cell(rows, {}, tolerance, grade, [&](const MatrixRow&, const MatrixCell& cell) {
        const double share = cell.verdict.found / tolerance;
        most = std::max(most, share);
        if (share > 0) shares.push_back(share);
        seconds += cell.report.seconds * cell.report.threads;
        proved += cell.report.pixels_proved;
        pixels += cell.report.pixels;
        rays += cell.report.rays;
        said_over += static_cast<std::uint64_t>(cell.verdict.said_over);
      });
      text += "| " + tolerance_name(tolerance) + " | " + grade_name(grade) +
              format(" | %.2g | %.2g | %.1f %% | %llu | %.3g | %.3g µs |\n", most, median(shares),
                     100 * static_cast<double>(proved) / static_cast<double>(pixels),
                     static_cast<unsigned long long>(said_over),
                     evaluations(rows, {}, tolerance, grade),
                     1e6 * seconds / static_cast<double>(rays));
    }
  }
  return text;
}

nlohmann::ordered_json cell_json(const MatrixCell& cell) {
  const scenes::Verdict& v = cell.verdict;
  const RuleCounts& s = cell.report.spans;
  return {{"tolerance", cell.tolerance},
          {"grade", grade_name(cell.grade)},
          {"found", v.found},
          {"column", v.worst.column},
          {"row", v.worst.row},
          {"channel", v.worst.channel},
          {"reported", v.reported},
          {"pixels_over", v.over},
          {"pixels_too_bright", v.too_bright},
          {"pixels_over_reported", v.over_reported},
          {"pixels_said_over", v.said_over},
          {"least_reported_to_found", std::isfinite(v.min_share) ? v.min_share : -1},
          {"pixels_proved", cell.report.pixels_proved},
          {"rays", cell.report.rays},
          {"evaluations", cell.report.evaluations},
          {"cells", cell.report.cells},
          {"seconds", cell.report.seconds},
          {"threads", cell.report.threads},
          {"spans",
           {{"skipped", s.skipped},
            {"constant", s.constant},
            {"strides", s.strides},
            {"lines", s.lines},
            {"closed", s.closed},
            {"panels", s.panels},
            {"in_double", s.in_double}}}};
}

}  // namespace

MatrixTotal matrix_total(const std::vector<MatrixRow>& rows) {
  MatrixTotal total;
  for (const MatrixRow& row : rows) {
    for (const MatrixCell& cell : row.cells) {
      ++total.frames;
      total.pixels += row.pixels;
      total.over += static_cast<std::size_t>(cell.verdict.over);
      total.too_bright += static_cast<std::size_t>(cell.verdict.too_bright);
      total.over_reported += static_cast<std::size_t>(cell.verdict.over_reported);
      total.said_over += static_cast<std::size_t>(cell.verdict.said_over);
    }
  }
  return total;
}

std::string violations(const std::vector<MatrixRow>& rows) {
  std::string text;
  for (const MatrixRow& row : rows) {
    for (const MatrixCell& cell : row.cells) {
      if (cell.verdict.kept()) continue;
      text += row.scene + "; " + row.camera + "; " + tolerance_name(cell.tolerance) + ", " +
              grade_name(cell.grade) + ": " + cell.verdict.text() + "\n";
    }
  }
  return text;
}

std::string matrix_markdown(const std::vector<MatrixRow>& rows) {
  const MatrixTotal total = matrix_total(rows);
  std::string text = format("%zu scenes, %zu views, %zu frames, %zu pixels judged.\n\n",
                            scene_names(rows).size(), rows.size(), total.frames, total.pixels);
  text += format("- Pixels over the tolerance: **%zu**\n", total.over);
  text += format("- Pixels over their reported error: **%zu**\n", total.over_reported);
  text += format("- Pixels over the tolerance that report it, too bright for binary32: %zu\n",
                 total.too_bright);
  text += format("- Pixels that report more than the tolerance: %zu\n\n", total.said_over);
  text += summary_table(rows);
  text += "\n### Error / tolerance, estimated\n\n" + error_table(rows, Grade::estimated);
  text += "\n### Error / tolerance, proved\n\n" + error_table(rows, Grade::proved);
  text += "\n### Tightness\n\n" + tightness_table(rows);
  text += "\n### Evaluations per ray, estimated\n\n" + work_table(rows, Grade::estimated);
  text += "\n### Evaluations per ray, proved\n\n" + work_table(rows, Grade::proved);
  text += "\n### Spans per ray by rule, at 1/512\n\n" + rules_table(rows, 1.0 / 512);
  return text;
}

nlohmann::ordered_json matrix_json(const std::vector<MatrixRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const MatrixRow& row : rows) {
    nlohmann::ordered_json entry{{"scene", row.scene},
                                 {"camera", row.camera},
                                 {"pixels", row.pixels},
                                 {"brightest", row.brightest},
                                 {"sampling_per_ray", row.sampling_per_ray},
                                 {"sampling_error", row.sampling_error}};
    for (const MatrixCell& cell : row.cells) entry["frames"].push_back(cell_json(cell));
    list.push_back(std::move(entry));
  }
  return list;
}

}  // namespace pellucid::bench
