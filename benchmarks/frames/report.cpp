// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/frames/report.h"

#include "benchmarks/support/document.h"

namespace pellucid::bench {
namespace {

constexpr Method rules[] = {Method::rectangle, Method::taylor,  Method::midpoint,
                            Method::trapezoid, Method::simpson, Method::linear};

std::string milliseconds(double seconds) {
  return seconds < 0.1 ? format("%.2g ms", 1e3 * seconds) : format("%.0f ms", 1e3 * seconds);
}

std::string ratio(double seconds, double base) {
  const double r = seconds / base;
  return r < 10 ? format("%.2g×", r) : format("%.0f×", r);
}

/// "largest (RMS)"; 0 where all floats are the same.
std::string errors(const Measurement& m) {
  if (m.error.largest == 0) return "0";
  return format("%.1e (%.1e)", m.error.largest, m.error.rms);
}

bool has_rules(const SceneResult& result) {
  return result.measurements.size() > 2;
}

/// The fastest step of a rule whose largest error is within the bound; null where there is none.
const Measurement* fastest_within(const SceneResult& result, Method rule, double bound) {
  const Measurement* best = nullptr;
  for (const Measurement& m : result.measurements) {
    if (m.integration.method != rule || !(m.error.largest <= bound)) continue;
    if (best == nullptr || m.median_seconds() < best->median_seconds()) best = &m;
  }
  return best;
}

const Measurement& most_accurate(const SceneResult& result, Method rule) {
  const Measurement* best = nullptr;
  for (const Measurement& m : result.measurements) {
    if (m.integration.method != rule) continue;
    if (best == nullptr || m.error.largest < best->error.largest) best = &m;
  }
  return *best;
}

std::string equal_error_cell(const SceneResult& result, Method rule, double bound, double base) {
  if (const Measurement* m = fastest_within(result, rule, bound)) {
    return ratio(m->median_seconds(), base) + format(" at %g", m->integration.step);
  }
  const Measurement& m = most_accurate(result, rule);
  return "never: " + format("%.1e", m.error.largest) + " after " + ratio(m.median_seconds(), base);
}

std::string exact_table(const std::vector<SceneResult>& results) {
  std::string text =
      "| scene | data | image | exact, double | largest error (RMS) | exact, float | largest error "
      "(RMS) |\n|---|---|---|---|---|---|---|\n";
  for (const SceneResult& r : results) {
    const Measurement& d = r.find(Method::exact, Precision::float64);
    const Measurement& f = r.find(Method::exact, Precision::float32);
    text += "| " + r.name + " | " + r.data + format(" | %d×%d | ", r.size.width, r.size.height) +
            milliseconds(d.median_seconds()) + " | " + errors(d) + " | " +
            ratio(f.median_seconds(), d.median_seconds()) + ", " +
            milliseconds(f.median_seconds()) + " | " + errors(f) + " |\n";
  }
  return text;
}

/// `bound_of` gives the error that the rules have to reach in a scene.
template <class Bound>
std::string equal_error_table(const std::vector<SceneResult>& results, Bound&& bound_of) {
  std::string text = "| scene | error | exact, float |";
  std::string line = "|---|---|---|";
  for (const Method rule : rules) {
    text += " " + std::string(method_name(rule)) + " |";
    line += "---|";
  }
  text += "\n" + line + "\n";
  for (const SceneResult& r : results) {
    if (!has_rules(r)) continue;
    const double base = r.find(Method::exact, Precision::float64).median_seconds();
    const double bound = bound_of(r);
    text += "| " + r.name + format(" | %.1e | ", bound) +
            ratio(r.find(Method::exact, Precision::float32).median_seconds(), base) + " |";
    for (const Method rule : rules) text += " " + equal_error_cell(r, rule, bound, base) + " |";
    text += "\n";
  }
  return text;
}

std::string step_table(const SceneResult& result) {
  std::string text = "\n#### " + result.name + "\n\n| step |", line = "|---|";
  std::vector<double> steps;
  for (const Measurement& m : result.measurements) {
    if (m.integration.method == rules[0]) steps.push_back(m.integration.step);
  }
  for (const double step : steps) {
    text += format(" %g |", step);
    line += "---|";
  }
  text += "\n" + line + "\n";
  const double base = result.find(Method::exact, Precision::float64).median_seconds();
  for (const Method rule : rules) {
    text += "| " + std::string(method_name(rule)) + " |";
    for (const Measurement& m : result.measurements) {
      if (m.integration.method != rule) continue;
      text += " " + errors(m) + "<br>" + ratio(m.median_seconds(), base) + ", " +
              milliseconds(m.median_seconds()) + " |";
    }
    text += "\n";
  }
  return text;
}

}  // namespace

std::string frames_markdown(const std::vector<SceneResult>& results) {
  std::string text =
      "### Exact\n\nAn error of 0: the image holds the same floats as the reference. The second "
      "time is also given as a ratio to the first.\n\n" +
      exact_table(results);
  bool any_rules = false;
  for (const SceneResult& r : results) any_rules = any_rules || has_rules(r);
  if (!any_rules) return text;
  text +=
      "\n### Time to an equal error\n\nTime of the coarsest of the steps that suffices, as a ratio "
      "to the exact frame in double, and that step in voxels; or the least error that the rule "
      "reaches at any of them. First at the error of exact in float:\n\n" +
      equal_error_table(results,
                        [](const SceneResult& r) {
                          return r.find(Method::exact, Precision::float32).error.largest;
                        }) +
      "\nand at half a grey level of 8 bit:\n\n" +
      equal_error_table(results, [](const SceneResult&) { return eight_bit_error; }) +
      "\n### Each step\n\nLargest error (RMS), then the time as a ratio to exact in double and "
      "absolute. Steps in voxels.\n";
  for (const SceneResult& r : results) {
    if (has_rules(r)) text += step_table(r);
  }
  return text;
}

nlohmann::ordered_json frames_json(const std::vector<SceneResult>& results) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const SceneResult& r : results) {
    nlohmann::ordered_json scene{
        {"name", r.name}, {"data", r.data}, {"image", {r.size.width, r.size.height}}};
    for (const Measurement& m : r.measurements) {
      nlohmann::ordered_json entry{
          {"method", method_name(m.integration.method)},
          {"precision", m.integration.precision == Precision::float64 ? "double" : "float"}};
      if (m.integration.method != Method::exact) entry["step"] = m.integration.step;
      entry["seconds"] = m.median_seconds();
      entry["runs"] = m.seconds;
      entry["largest_error"] = m.error.largest;
      entry["rms_error"] = m.error.rms;
      entry["cells_or_samples"] = m.cells;
      scene["measurements"].push_back(std::move(entry));
    }
    list.push_back(std::move(scene));
  }
  return list;
}

}  // namespace pellucid::bench
