// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>

#include "commands.h"
#include "difference.h"
#include "output.h"
#include "overwriting.h"
#include "parse.h"
#include "pellucid/base/version.h"
#include "pellucid/io/image_files.h"

namespace pellucid::cli {

namespace {

struct CompareArguments {
  std::string a, b, difference;
  std::optional<double> largest;
  bool json = false;
};

constexpr const char* channel_names[] = {"red", "green", "blue", "alpha"};

/// What the difference file shows, in words.
struct DifferenceFile {
  std::string path, scaling;
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

std::string text_report(const Image& a, const ImageDifference& d,
                        const std::optional<DifferenceFile>& file) {
  std::string text =
      fmt::format("{} x {} pixels, |a - b| of linear premultiplied values\n", a.width, a.height);
  text += fmt::format("{:<6} {:>13} {:>13} {:>13} {:>9}\n", "", "largest", "RMS", "99.9 %", "PSNR");
  for (std::size_t c = 0; c < 4; ++c) text += statistics_line(channel_names[c], d.channel[c]);
  text += statistics_line("all", d.all);
  text += fmt::format("largest at column {}, row {} (from the top left, counted from 0)\n",
                      d.column, d.row);
  if (d.all.not_finite > 0) {
    text +=
        fmt::format("{} values are not finite in one image and left out above\n", d.all.not_finite);
  }
  if (file) text += fmt::format("{}: {}\n", file->path, file->scaling);
  return text;
}

Json json_report(const CompareArguments& arguments, const Image& a, const ImageDifference& d,
                 const std::optional<DifferenceFile>& file) {
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
  if (file) json["difference"] = {{"path", file->path}, {"shows", file->scaling}};
  return json;
}

int run_compare(const CompareArguments& arguments) {
  if (arguments.largest && !(*arguments.largest >= 0)) {
    throw UsageError(
        fmt::format("--largest {}: expected a number of at least 0", *arguments.largest));
  }
  if (!arguments.difference.empty()) check_difference_path(arguments);
  const Image a = read_exr(arguments.a), b = read_exr(arguments.b);
  if (a.width != b.width || a.height != b.height) {
    throw Error(fmt::format("{} has {} x {} pixels and {} has {} x {}; compare images of one size",
                            arguments.a, a.width, a.height, arguments.b, b.width, b.height));
  }
  const ImageDifference difference = compare_images(a, b);
  std::optional<DifferenceFile> file;
  if (!arguments.difference.empty()) file = write_difference(arguments, a, b, difference);
  if (arguments.json) {
    print_json(json_report(arguments, a, difference, file));
  } else {
    print_text(text_report(a, difference, file));
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

Command add_compare(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("compare", "Measure how two OpenEXR images differ");
  const auto arguments = std::make_shared<CompareArguments>();
  command.add_option("A", arguments->a, "OpenEXR image")->required();
  command.add_option("B", arguments->b, "OpenEXR image of the same size")->required();
  command
      .add_option("--difference", arguments->difference,
                  "Write a picture of |A - B|: .exr as it is, .png in grey with the largest white")
      ->option_text("FILE");
  command
      .add_option("--largest", arguments->largest,
                  "Exit with 1 where the largest difference exceeds E")
      ->option_text("E");
  command.add_flag("--json", arguments->json, "Print JSON");
  command.footer(
      "Differences are taken of linear, premultiplied R, G, B and A; PSNR is for a peak of 1.\n"
      "\n"
      "Examples:\n"
      "  pellucid compare exact.exr midpoint.exr\n"
      "  pellucid compare exact.exr reference.exr --largest 1e-6\n"
      "  pellucid compare a.exr b.exr --difference difference.png --json");
  return {&command, [arguments] { return run_compare(*arguments); }};
}

}  // namespace pellucid::cli
