// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "arguments/parse.h"
#include "pellucid/io/figure.h"
#include "render.h"

namespace pellucid::cli {

namespace {

constexpr const char* parts_of_figures = "color-bar, axes, scale-bar, letters, caption";

double parse_width(const std::string& text) {
  const double width = parse_paper_length("--figure-width", text);
  if (!(width >= smallest_figure_width && width <= largest_figure_width)) {
    throw UsageError(fmt::format("--figure-width '{}': expected a width from {} to {} mm", text,
                                 smallest_figure_width, largest_figure_width));
  }
  return width;
}

/// Sets the parts that a list names. Throws UsageError for others.
void set_parts(const char* option, const std::string& list, bool is_drawn, FigureParts& parts) {
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string name = list.substr(begin, end - begin);
    begin = end + 1;
    if (name == "color-bar") {
      parts.color_bars = is_drawn;
    } else if (name == "axes") {
      parts.axes = is_drawn;
    } else if (name == "scale-bar") {
      parts.scale_bar = is_drawn;
    } else if (name == "letters") {
      parts.orientation = is_drawn;
    } else if (name == "caption") {
      parts.caption = is_drawn;
    } else {
      throw UsageError(fmt::format("{} '{}': expected some of {}", option, list, parts_of_figures));
    }
  }
}

/// Returns what the options say of a figure.
Figure figure_of(const FigureArguments& arguments) {
  Figure figure;
  if (!arguments.width.empty()) figure.width = parse_width(arguments.width);
  if (!arguments.with.empty()) set_parts("--figure-with", arguments.with, true, figure.parts);
  if (!arguments.without.empty()) {
    set_parts("--figure-without", arguments.without, false, figure.parts);
  }
  return figure;
}

/// Returns the figure of a scene, with the accuracy that `report` tells of.
Figure figure_of(const RenderArguments& arguments, const PreparedScene& prepared,
                 const RenderReport& report) {
  const Scene& scene = prepared.scene;
  Figure figure = figure_of(arguments.figure);
  figure.bars = color_bars(prepared.description, scene);
  if (!arguments.color_bar_title.empty() && !figure.bars.empty()) {
    figure.bars.front().title = arguments.color_bar_title;
  }
  figure.space = figure_space(prepared.description, scene);
  if (!arguments.figure.unit.empty()) figure.space->unit = arguments.figure.unit;
  figure.background = shown_background(prepared.description);
  figure.caption = accuracy_caption({arguments.reference, scene.integration, report.largest_error,
                                     report.pixels, report.pixels_proved,
                                     report.pixels_over_tolerance, approximation_error(scene)});
  return figure;
}

}  // namespace

void FigureArguments::add_to(CommandLine& command) {
  command
      .add_option("--figure", files,
                  "Write the picture as a figure of a paper, .pdf, .svg or .png: with color bars, "
                  "axes, scale bar, letters of a patient, and its accuracy; may be repeated")
      ->option_text("FILE")
      ->allow_extra_args(false);
  command
      .add_option(
          "--figure-width", width,
          fmt::format("Width of a figure, {} to {} mm, or with unit, as in 3.35in. Default: "
                      "85, a column. Text keeps its size, 6.5 and 7 pt",
                      smallest_figure_width, largest_figure_width))
      ->option_text("WIDTH");
  command
      .add_option(
          "--figure-without", without,
          fmt::format("Leave out parts of a figure, with commas between: {}", parts_of_figures))
      ->option_text("PARTS");
  command
      .add_option("--figure-with", with,
                  "Draw parts of a figure that are not by default: axes for data of a patient")
      ->option_text("PARTS");
  command
      .add_option("--figure-unit", unit,
                  "Unit of length at axes and scale bar. Default: mm for data of a patient, else "
                  "none")
      ->option_text("TEXT");
}

void check_figures(const RenderArguments& arguments) {
  const FigureArguments& given = arguments.figure;
  for (const auto& [option, text] : {std::pair{"--figure-width", &given.width},
                                     {"--figure-without", &given.without},
                                     {"--figure-with", &given.with},
                                     {"--figure-unit", &given.unit}}) {
    if (!text->empty() && given.files.empty()) {
      throw UsageError(fmt::format("{}: is of --figure FILE; give that, too", option));
    }
  }
  const Figure figure = figure_of(given);
  for (const std::string& file : given.files) {
    const std::string extension = extension_of(file);
    if (extension != ".pdf" && extension != ".svg" && extension != ".png") {
      throw UsageError(
          fmt::format("--figure {}: expected a name that ends in .pdf, .svg or .png", file));
    }
    check_figure(figure, {}, figure_format(file));
  }
}

void check_figures(const RenderArguments& arguments, const PreparedScene& prepared) {
  if (arguments.figure.files.empty()) return;
  const Figure figure = figure_of(arguments, prepared, {});
  for (const std::string& file : arguments.figure.files) {
    check_figure(figure, prepared.scene.size, figure_format(file));
  }
}

void write_figure(const RenderArguments& arguments, const PreparedScene& prepared,
                  const RenderedPicture& picture, const std::string& file) {
  pellucid::write_figure(picture.image, figure_of(arguments, prepared, picture.report), file);
}

}  // namespace pellucid::cli
