// SPDX-License-Identifier: Apache-2.0

// Google Benchmark's own options, and besides --pellucid_markdown=FILE, --pellucid_json=FILE and
// --pellucid_commit=HASH for the table in the documents.

#include <benchmark/benchmark.h>

#include <cstdio>
#include <map>
#include <string_view>

#include "benchmarks/kernels/packet_table.h"
#include "benchmarks/support/document.h"
#include "benchmarks/support/environment.h"
#include "pellucid/io/internal/atomic_file.h"

namespace {

/// Prints as always and keeps the time of one item.
class Collector : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      // With repetitions the median alone counts.
      const bool is_median = run.run_type == Run::RT_Aggregate && run.aggregate_name == "median";
      const auto rate = run.counters.find("items_per_second");
      if (rate == run.counters.end() || run.error_occurred) continue;
      if (run.run_type == Run::RT_Aggregate && !is_median) continue;
      const std::string name = run.run_name.function_name;
      if (nanoseconds.find(name) == nanoseconds.end()) order.push_back(name);
      nanoseconds[name] = 1e9 / static_cast<double>(rate->second);
    }
    ConsoleReporter::ReportRuns(runs);
  }

  std::vector<std::string> order;
  std::map<std::string, double> nanoseconds;
};

/// "erf on [-4, 4], float" and ", double" become one row.
std::string markdown(const Collector& collector) {
  std::string text = "| kernel | float | double |\n|---|---|---|\n";
  const std::string_view suffix = ", float";
  for (const std::string& name : collector.order) {
    if (!name.ends_with(suffix)) continue;
    const std::string kernel = name.substr(0, name.size() - suffix.size());
    const auto in_double = collector.nanoseconds.find(kernel + ", double");
    text += "| " + kernel +
            pellucid::bench::format(" | %.1f ns | ", collector.nanoseconds.at(name)) +
            (in_double == collector.nanoseconds.end()
                 ? std::string("—")
                 : pellucid::bench::format("%.1f ns", in_double->second)) +
            " |\n";
  }
  return text;
}

void write(const Collector& collector, const std::string& markdown_file,
           const std::string& json_file, const std::string& commit) {
  using namespace pellucid::bench;
  const Environment where = environment(commit);
  if (!markdown_file.empty()) {
    replace_section(markdown_file, "kernels",
                    "\n" + to_markdown(where) +
                        "\nNanoseconds per lane, and in brackets per call.\n\n" +
                        packet_markdown(collector.order, collector.nanoseconds) +
                        "\nOne number at a time:\n\n" + markdown(collector) + "\n");
  }
  if (!json_file.empty()) {
    nlohmann::ordered_json kernels;
    for (const std::string& name : collector.order) {
      kernels[name] = collector.nanoseconds.at(name);
    }
    const nlohmann::ordered_json json{{"environment", to_json(where)}, {"nanoseconds", kernels}};
    pellucid::write_text_file(json_file, json.dump(1) + "\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::map<std::string, std::string> own;
  int kept = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    const std::size_t equals = argument.find('=');
    if (argument.starts_with("--pellucid_") && equals != std::string_view::npos) {
      own[std::string(argument.substr(0, equals))] = argument.substr(equals + 1);
    } else {
      argv[kept++] = argv[i];
    }
  }
  argc = kept;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector);
  try {
    write(collector, own["--pellucid_markdown"], own["--pellucid_json"], own["--pellucid_commit"]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_kernels: %s\n", error.what());
    return 1;
  }
  return 0;
}
