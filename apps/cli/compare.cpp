// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>

#include "arguments/output.h"
#include "arguments/overwriting.h"
#include "arguments/parse.h"
#include "commands.h"
#include "pellucid/base/version.h"
#include "pellucid/io/image_files.h"
#include "pellucid/scene/image_difference.h"

namespace pellucid::cli {

namespace {

struct CompareArguments {
  std::string a, b, difference;
  std::optional<double> largest;
  std::optional<std::string> tolerance;
  bool json = false;
};

constexpr const char* channel_names[] = {"red", "green", "blue", "alpha"};

/// Description of the difference file, in words.
struct DifferenceFile {
  std::string path, scaling;
};

/// Number of pixels that differ by more than a tolerance.
struct ToleranceCheck {
  double tolerance;
  std::size_t pixels_over;
};

struct Comparison {
  ImageDifference difference;
  std::optional<ErrorCheck> errors;
  std::optional<ToleranceCheck> tolerance;
  std::optional<DifferenceFile> file;
};

void check_difference_path(const CompareArguments& arguments) {
  const std::string& path = arguments.difference;
  const std::string extension = extension_of(path);
  if (extension != ".png" && extension != ".exr") {
    throw UsageError(
        fmt::format("--difference {}: expected a name that ends in .png or .exr", path));
  }
  const NamedFile outputs[] = {{"--difference", path}};
  const NamedFile inputs[] = {{"A", arguments.a}, {"B", arguments.b}};
  refuse_overwriting(outputs, inputs);
  check_writable(path);
}

DifferenceFile write_difference(const CompareArguments& arguments, const Image& a, const Image& b,
                                const ImageDifference& difference) {
  if (extension_of(arguments.difference) == ".exr") {
    write_exr(difference_image(a, b), arguments.difference);
    return {arguments.difference, "|difference| of R, G, B, A, not scaled"};
  }
  const double scale = difference.all.largest > 0 ? 1 / difference.all.largest : 1;
  write_png(difference_picture(a, b, scale), arguments.difference, Rgb<double>{});
  return {arguments.difference,
          fmt::format("the largest |difference| of R, G, B, A in each pixel times {:.6g}", scale)};
}

Json statistics_json(const DifferenceStatistics& s) {
  return {
      {"largest", s.largest}, {"rms", s.root_mean_square}, {"percentile_99_9", s.percentile_999},
      {"psnr", s.psnr},       {"values", s.values},        {"not_finite", s.not_finite}};
}

std::string statistics_line(std::string_view name, const DifferenceStatistics& s) {
  return fmt::format("{:<6} {:>13.6g} {:>13.6g} {:>13.6g} {:>9}\n", name, s.largest,
                     s.root_mean_square, s.percentile_999, fmt::format("{:.2f} dB", s.psnr));
}

std::string error_lines(const ErrorCheck& check) {
  const std::size_t known = check.pixels - check.unknown;
  std::string text = fmt::format(
      "the error stored in A{}: {} of {} pixels differ by more; error / difference: median {:.3g}, "
      "smallest {:.3g}\n"
      "",
      check.unknown > 0 ? fmt::format(" (unknown in {} pixels)", check.unknown) : "", check.over,
      known, check.tightness_median, check.tightness_smallest);
  if (check.over > 0) {
    text += fmt::format("worst at column {}, row {}: difference {:.6g}, error {:.6g}\n",
                        check.column, check.row, check.difference, check.error);
  }
  return text;
}

std::string text_report(const Image& a, const Comparison& comparison) {
  const ImageDifference& d = comparison.difference;
  std::string text =
      fmt::format("{} x {} pixels, |a - b| of linear premultiplied values\n", a.width, a.height);
  text += fmt::format("{:<6} {:>13} {:>13} {:>13} {:>9}\n", "", "largest", "RMS", "99.9 %", "PSNR");
  for (std::size_t c = 0; c < 4; ++c) text += statistics_line(channel_names[c], d.channel[c]);
  text += statistics_line("all", d.all);
  text += fmt::format("largest at column {}, row {} (from the top left, counted from 0)\n",
                      d.column, d.row);
  if (d.all.not_finite > 0) {
    text += fmt::format(
        "{} values are not finite in one image and are left out above\n"
        "",
        d.all.not_finite);
  }
  if (comparison.errors) text += error_lines(*comparison.errors);
  if (const auto& check = comparison.tolerance) {
    text += fmt::format("pixels that differ by more than {:.6g}: {}\n", check->tolerance,
                        check->pixels_over);
  }
  if (const auto& file = comparison.file) {
    text += fmt::format("{}: {}\n", file->path, file->scaling);
  }
  return text;
}

Json errors_json(const ErrorCheck& check) {
  const std::size_t known = check.pixels - check.unknown;
  return {{"pixels", check.pixels},
          {"unknown", check.unknown},
          {"proved", check.proved},
          {"over", check.over},
          {"share_over",
           known > 0 ? static_cast<double>(check.over) / static_cast<double>(known) : 0.0},
          {"worst_at", {check.column, check.row}},
          {"worst_difference", check.difference},
          {"worst_error", check.error},
          {"tightness_median", check.tightness_median},
          {"tightness_smallest", check.tightness_smallest}};
}

Json json_report(const CompareArguments& arguments, const Image& a, const Comparison& comparison) {
  const ImageDifference& d = comparison.difference;
  Json json;
  json["pellucid"] = PELLUCID_VERSION_STRING;
  json["a"] = arguments.a;
  json["b"] = arguments.b;
  json["size"] = {a.width, a.height};
  json["identical"] = d.all.largest == 0 && d.all.not_finite == 0;
  json.update(statistics_json(d.all));
  json["largest_at"] = {d.column, d.row};
  for (std::size_t c = 0; c < 4; ++c) {
    json["channels"][channel_names[c]] = statistics_json(d.channel[c]);
  }
  if (comparison.errors) json["error"] = errors_json(*comparison.errors);
  if (const auto& check = comparison.tolerance) {
    json["tolerance"] = check->tolerance;
    json["pixels_over"] = check->pixels_over;
  }
  if (const auto& file = comparison.file) {
    json["difference"] = {{"path", file->path}, {"shows", file->scaling}};
  }
  return json;
}

int run_compare(const CompareArguments& arguments) {
  if (arguments.largest && !(*arguments.largest >= 0)) {
    throw UsageError(
        fmt::format("--largest {}: expected a number of at least 0", *arguments.largest));
  }
  std::optional<double> tolerance;
  if (arguments.tolerance) tolerance = parse_tolerance("--tolerance", *arguments.tolerance);
  if (!arguments.difference.empty()) check_difference_path(arguments);
  const Image a = read_exr(arguments.a), b = read_exr(arguments.b);
  if (a.width != b.width || a.height != b.height) {
    throw Error(fmt::format("{} has {} x {} pixels and {} has {} x {}; compare images of one size",
                            arguments.a, a.width, a.height, arguments.b, b.width, b.height));
  }
  Comparison comparison{compare_images(a, b), check_errors(a, b), {}, {}};
  const ImageDifference& difference = comparison.difference;
  if (tolerance) comparison.tolerance = {*tolerance, pixels_over(a, b, *tolerance)};
  if (!arguments.difference.empty()) {
    comparison.file = write_difference(arguments, a, b, difference);
  }
  if (arguments.json) {
    print_json(json_report(arguments, a, comparison));
  } else {
    print_text(text_report(a, comparison));
  }
  if (comparison.tolerance && comparison.tolerance->pixels_over > 0) {
    throw OverTolerance(fmt::format(
        "{} of {} pixels differ by more than {:.6g}, the largest difference is at column {}, row "
        "{}",
        comparison.tolerance->pixels_over, a.pixels.size(), *tolerance, difference.column,
        difference.row));
  }
  if (!arguments.largest) return 0;
  if (difference.all.not_finite > 0) {
    throw Error(fmt::format("{} values are not finite in one image, the first at column {}, row {}",
                            difference.all.not_finite, difference.column, difference.row));
  }
  if (difference.all.largest > *arguments.largest) {
    throw Error(fmt::format("the largest difference {:.6g}, at column {}, row {}, exceeds {:.6g}",
                            difference.all.largest, difference.column, difference.row,
                            *arguments.largest));
  }
  return 0;
}

}  // namespace

Command add_compare(CommandLine& app) {
  CommandLine& command =
      *app.add_subcommand("compare", "Measure how much two OpenEXR images differ");
  const auto arguments = std::make_shared<CompareArguments>();
  command.add_option("A", arguments->a, "OpenEXR image")->required();
  command.add_option("B", arguments->b, "OpenEXR image of the same size")->required();
  command
      .add_option(
          "--difference", arguments->difference,
          "Write |A - B| as a picture: .exr not scaled, .png in grey with the largest white")
      ->option_text("FILE");
  command
      .add_option("--largest", arguments->largest,
                  "Exit with 1 if the largest difference exceeds E")
      ->option_text("E");
  command
      .add_option("--tolerance", arguments->tolerance,
                  "Exit with 3 if a pixel differs by more than E, a number or a fraction as 1/512, "
                  "and print how many do")
      ->option_text("E");
  command.add_flag("--json", arguments->json, "Print JSON");
  command.footer(
      "Compares linear, premultiplied R, G, B and A. The PSNR is for a peak of 1. If A stores an\n"
      "error, as an .exr of 'pellucid render' does, compares it with the difference.\n"
      "\n"
      "Examples:\n"
      "  pellucid compare exact.exr midpoint.exr\n"
      "  pellucid compare exact.exr reference.exr --largest 1e-6\n"
      "  pellucid compare exact.exr reference.exr --tolerance 1/512\n"
      "  pellucid compare a.exr b.exr --difference difference.png --json");
  return {&command, [arguments] { return run_compare(*arguments); }};
}

}  // namespace pellucid::cli
