// SPDX-License-Identifier: Apache-2.0
#include "evaluate.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "arguments/output.h"
#include "arguments/overwriting.h"
#include "arguments/parse.h"
#include "commands.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/internal/atomic_file.h"

namespace pellucid::cli {

namespace {

struct EvaluateArguments {
  std::string kind, table, output;
  std::string precision = "double";
  std::optional<double> tolerance;
};

std::vector<EvaluateKind> kinds() {
  return {linear_segment_kind(),           piecewise_linear_segment_kind(),
          trilinear_cell_kind(),           special_functions_kind(),
          gaussian_segment_kind(),         gaussian_segment_kniss_kind(),
          gaussian_mixture_segment_kind(), gaussian_mixture_segment_kniss_kind()};
}

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const EvaluateKind& kind : kinds()) names.emplace_back(kind.name);
  return names;
}

double tolerance_of(const EvaluateArguments& arguments, const EvaluateKind& kind) {
  const bool single = arguments.precision == "float";
  if (!arguments.tolerance) return single ? 1e-6 : 1e-10;
  if (!kind.has_tolerance) {
    throw UsageError(fmt::format("--tolerance: {} is a closed form and has none", kind.name));
  }
  if (!(*arguments.tolerance > 0) || !(*arguments.tolerance < 1)) {
    throw UsageError(
        fmt::format("--tolerance {}: expected a number between 0 and 1", *arguments.tolerance));
  }
  return *arguments.tolerance;
}

int run_evaluate(const EvaluateArguments& arguments) {
  const auto all = kinds();
  const EvaluateKind& kind = *std::find_if(
      all.begin(), all.end(), [&](const EvaluateKind& k) { return k.name == arguments.kind; });
  const double tolerance = tolerance_of(arguments, kind);
  const NamedFile files_out[] = {{"-o", arguments.output}};
  const NamedFile files_in[] = {{"TABLE", arguments.table}};
  refuse_overwriting(files_out, files_in);
  check_writable(arguments.output);
  constexpr std::size_t largest_table = std::size_t(1) << 30;
  const CsvTable table(read_text_file(arguments.table, largest_table), arguments.table);
  const std::size_t id = table.column("id");
  std::vector<std::size_t> columns;
  for (const std::string_view name : kind.inputs) columns.push_back(table.column(name));

  std::vector<std::string_view> written = {"id"};
  written.insert(written.end(), kind.outputs.begin(), kind.outputs.end());
  CsvWriter writer(written);
  const EvaluateKind::Row evaluate =
      arguments.precision == "float" ? kind.in_float : kind.in_double;
  std::vector<double> outputs;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    outputs.clear();
    evaluate(table, columns, row, tolerance, outputs);
    writer.cell(table.text(row, id));
    for (const double output : outputs) writer.cell(output);
    writer.end_row();
  }
  write_text_file(arguments.output, writer.text());
  return 0;
}

}  // namespace

template <class T>
T non_negative(const CsvTable& table, std::size_t row, std::size_t column) {
  const T value = table.number<T>(row, column);
  if (value < 0) {
    throw Error(fmt::format("{}, column '{}': {} is negative; expected at least 0",
                            table.where(row), table.columns()[column], value));
  }
  return value;
}
template float non_negative<float>(const CsvTable&, std::size_t, std::size_t);
template double non_negative<double>(const CsvTable&, std::size_t, std::size_t);

template <class T>
std::vector<T> list_of(const CsvTable& table, std::size_t row, std::size_t column,
                       std::size_t count) {
  std::vector<T> list = table.list<T>(row, column);
  if (list.size() != count) {
    throw Error(fmt::format("{}, column '{}': {} numbers where {} are expected, separated by ';'",
                            table.where(row), table.columns()[column], list.size(), count));
  }
  return list;
}
template std::vector<float> list_of<float>(const CsvTable&, std::size_t, std::size_t, std::size_t);
template std::vector<double> list_of<double>(const CsvTable&, std::size_t, std::size_t,
                                             std::size_t);

template <class T>
TransferFunction transfer_function_of(const CsvTable& table, std::size_t row,
                                      const std::array<std::size_t, 5>& columns) {
  const std::vector<T> value = table.list<T>(row, columns[0]);
  std::array<std::vector<T>, 4> rest;
  for (std::size_t c = 0; c < 4; ++c) {
    rest[c] = list_of<T>(table, row, columns[c + 1], value.size());
  }
  const auto wide = [](T x) { return static_cast<double>(x); };
  std::vector<TransferFunction::Point> points;
  for (std::size_t p = 0; p < value.size(); ++p) {
    points.push_back(
        {wide(value[p]), wide(rest[0][p]), {wide(rest[1][p]), wide(rest[2][p]), wide(rest[3][p])}});
  }
  try {
    return TransferFunction(std::move(points));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", table.where(row), error.what()));
  }
}
template TransferFunction transfer_function_of<float>(const CsvTable&, std::size_t,
                                                      const std::array<std::size_t, 5>&);
template TransferFunction transfer_function_of<double>(const CsvTable&, std::size_t,
                                                       const std::array<std::size_t, 5>&);

Command add_evaluate(CommandLine& app) {
  CommandLine& command =
      *app.add_subcommand("evaluate", "Run the integration kernels on a table of your own");
  const auto arguments = std::make_shared<EvaluateArguments>();
  command.add_option("KIND", arguments->kind, fmt::format("{}", fmt::join(kind_names(), ", ")))
      ->required()
      ->one_of(kind_names());
  command
      .add_option("TABLE", arguments->table, "CSV with a header line, a column id and the inputs")
      ->required();
  command
      .add_option("-o,--output", arguments->output, "Write this CSV: id and the outputs. Required")
      ->required()
      ->option_text("FILE.csv");
  command
      .add_option("--precision", arguments->precision,
                  "Type of inputs and kernels: float or double (default)")
      ->option_text("TYPE")
      ->one_of({"float", "double"});
  command
      .add_option("--tolerance", arguments->tolerance,
                  "Tolerance of trilinear_cell and gaussian_mixture_segment, between 0 and 1. "
                  "Default: 1e-6 in float, 1e-10 in double")
      ->option_text("E");

  std::string footer =
      "Columns are found by name, in any order; others are ignored. ';' separates the numbers of\n"
      "a list, '|' separates lists. Rows keep their order.\n";
  for (const EvaluateKind& kind : kinds()) {
    footer += fmt::format("\n{}\n  reads  {}\n  writes {}\n", kind.name,
                          fmt::join(kind.inputs, ","), fmt::join(kind.outputs, ","));
  }
  footer +=
      "\nExamples:\n"
      "  pellucid evaluate linear_segment linear_segment.csv -o mine.csv --precision float\n"
      "  pellucid evaluate trilinear_cell cells.csv -o mine.csv --tolerance 1e-8";
  command.footer(footer);
  return {&command, [arguments] { return run_evaluate(*arguments); }};
}

}  // namespace pellucid::cli
