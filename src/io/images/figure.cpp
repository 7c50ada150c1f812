// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/figure.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include "box_axes.h"
#include "cairo_module.h"
#include "image_checks.h"
#include "legend_panel.h"
#include "pellucid/base/version.h"
#include "pellucid/geometry/box_around.h"
#include "pellucid/io/display_bytes.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/io/internal/module.h"
#include "pellucid/io/internal/patient_space.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/internal/axis_ticks.h"
#include "png_bytes.h"
#include "text/text.h"

namespace pellucid {
namespace {

constexpr Module figures_module{"pellucid_cairo.so", "draws figures",
                                "Cairo (Debian: libcairo2-dev)"};
constexpr double points_per_mm = 72 / 25.4;
/// Share of the picture's width that a scale bar may take.
constexpr double longest_scale_bar = 0.3;
/// Parts of the picture that the box of the axes may reach beyond its edges.
constexpr double farthest_box = 0.75;
/// Angle to an axis up to which a view along it has letters at the edges of the picture.
constexpr double degrees_along_axis = 15;

DrawFigure* draw_figure() {
  return reinterpret_cast<DrawFigure*>(module_function(figures_module, draw_figure_name));
}

/// Returns a number with so many digits, 1.2e-05 as 1.2e-5.
std::string number_text(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  std::string number = text;
  const std::size_t e = number.find('e');
  if (e == std::string::npos) return number;
  const std::size_t first = number.find_first_not_of("+-0", e + 1);
  return number.substr(0, e + 1) + (number[e + 1] == '-' ? "\u2212" : "") + number.substr(first);
}

/// Returns a share as percent; what is neither all nor none is not rounded to it.
std::string percent_text(std::uint64_t part, std::uint64_t whole) {
  const double percent = 100 * static_cast<double>(part) / static_cast<double>(whole);
  return number_text(std::clamp(percent, 0.01, 99.99), percent > 99 ? 4 : 2) + " %";
}

/// Returns the height of the picture in world units: where the camera looks at.
double seen_height(const Camera& camera) {
  if (camera.projection == Projection::orthographic) return 2 * camera.parallel_scale;
  return 2 * length(camera.focal_point - camera.position) *
         std::tan(camera.vertical_angle * std::numbers::pi / 360);
}

bool draws_axes(const Figure& figure) {
  return figure.space && figure.parts.axes.value_or(!figure.space->is_anatomical);
}

/// Returns the last day and second of SOURCE_DATE_EPOCH, so that builds of a paper are repeated.
std::string given_date() {
  const char* const given = std::getenv("SOURCE_DATE_EPOCH");
  if (given == nullptr) return {};
  const auto seconds = number_of_word<std::int64_t>(given);
  if (!seconds || *seconds < 0) return {};
  const std::time_t time = *seconds;
  std::tm parts{};
  if (gmtime_r(&time, &parts) == nullptr) return {};
  char text[64];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

/// Returns whether no data are seen at the edge of the picture.
bool has_free_edge(const std::vector<std::uint8_t>& covered, int width, int height) {
  const auto at = [&](int column, int row) {
    return covered[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                   static_cast<std::size_t>(column)] != 0;
  };
  for (int column = 0; column < width; ++column) {
    if (at(column, 0) || at(column, height - 1)) return false;
  }
  for (int row = 0; row < height; ++row) {
    if (at(0, row) || at(width - 1, row)) return false;
  }
  return true;
}

bool is_inside(const PagePoint& point, ImageSize size, double beyond) {
  return point.x >= -beyond * size.width && point.x <= (1 + beyond) * size.width &&
         point.y >= -beyond * size.height && point.y <= (1 + beyond) * size.height;
}

void set_axes(const Figure& figure, ImageSize size, FigurePage& page) {
  // A bar and its numbers take some 50 points; what the picture is then makes room for ticks.
  const double taken = page.panels.empty() ? 0 : 50;
  const double scale = std::max(page.width - taken, page.width / 2) / size.width;
  BoxAxes seen = box_axes(*figure.space, size, scale);
  // The background goes on beyond the picture only if the data do not.
  const double beyond = page.grows ? farthest_box : 0;
  const auto reaches_beyond = [&](const auto& line) {
    return !is_inside(line[0], size, beyond) || !is_inside(line[1], size, beyond);
  };
  if (std::ranges::any_of(seen.axes, [&](const DrawnAxis& axis) {
        return reaches_beyond(std::array{axis.from, axis.to});
      })) {
    return;
  }
  page.axes = std::move(seen.axes);
  std::erase_if(seen.outline, reaches_beyond);
  page.outline = std::move(seen.outline);
}

void set_scale_bar(const FigureSpace& space, ImageSize size, FigurePage& page) {
  const double pixel = seen_height(space.camera) / size.height;
  const double most = longest_scale_bar * size.width * pixel;
  if (!(most > 0) || !std::isfinite(most)) return;
  const double nice = round_length(most);
  page.scale_bar = nice / pixel;
  page.scale_bar_label = short_number(nice) + (space.unit.empty() ? "" : " " + space.unit);
}

void set_orientation(const FigureSpace& space, FigurePage& page) {
  const auto [right, up, forward] = camera_axes(space.camera);
  const double along = std::max({std::abs(forward.x), std::abs(forward.y), std::abs(forward.z)});
  const bool at_edges =
      space.is_anatomical && along >= std::cos(degrees_along_axis * std::numbers::pi / 180);
  const Vec3<double> edges[] = {right * -1.0, right, up, up * -1.0};
  for (std::size_t edge = 0; at_edges && edge < 4; ++edge) {
    const Vec3<double>& towards = edges[edge];
    int axis = 0;
    for (int a = 1; a < 3; ++a) {
      if (std::abs(towards[a]) > std::abs(towards[axis])) axis = a;
    }
    page.edge_letters[edge] = axis_ends(axis, true)[towards[axis] > 0 ? 1 : 0];
  }
  for (int axis = 0; !at_edges && axis < 3; ++axis) {
    page.directions.push_back({axis_ends(axis, space.is_anatomical)[1], {right[axis], -up[axis]}});
  }
}

FigurePage::Format page_format(FigureFormat format) {
  return format == FigureFormat::pdf   ? FigurePage::Format::pdf
         : format == FigureFormat::svg ? FigurePage::Format::svg
                                       : FigurePage::Format::png;
}

/// Returns the page without its pixels. `covered`: of them, if they are known. `may_grow`: whether
/// axes may stand around the picture.
FigurePage page_of(const Figure& figure, ImageSize size, FigureFormat format,
                   std::vector<std::uint8_t> covered, bool may_grow = true) {
  if (!(figure.width >= smallest_figure_width && figure.width <= largest_figure_width)) {
    throw Error("figure: is " + short_number(figure.width) + " mm wide, but must be from " +
                short_number(smallest_figure_width) + " to " + short_number(largest_figure_width));
  }
  FigurePage page;
  page.format = page_format(format);
  page.width = figure.width * points_per_mm;
  page.picture_width = size.width;
  page.picture_height = size.height;
  page.creator = std::string("Pellucid ") + PELLUCID_VERSION_STRING;
  page.date = given_date();
  if (figure.parts.color_bars) {
    for (const ColorBar& bar : figure.bars) {
      page.panels.push_back(panel_of(bar));
      // One opacity for all values needs no strip.
      std::vector<double>& opacity = page.panels.back().opacity;
      if (opacity.empty()) continue;
      const auto [least, most] = std::ranges::minmax(opacity);
      if (most - least < 0.02) opacity.clear();
    }
  }
  page.grows = may_grow && !covered.empty() && has_free_edge(covered, size.width, size.height);
  page.covered = std::move(covered);
  if (draws_axes(figure)) set_axes(figure, size, page);
  const bool is_parallel =
      figure.space && figure.space->camera.projection == Projection::orthographic;
  // Where the axes have numbers, one more length would be right in one distance alone.
  if (figure.space && figure.parts.scale_bar && (is_parallel || page.axes.empty())) {
    set_scale_bar(*figure.space, size, page);
  }
  if (figure.space && figure.parts.orientation && page.axes.empty()) {
    set_orientation(*figure.space, page);
  }
  if (figure.parts.caption) {
    page.caption = figure.caption;
    const auto add = [&](const char* sentence) {
      page.caption += (page.caption.empty() ? "" : " ") + std::string(sentence);
    };
    if (std::ranges::any_of(page.panels,
                            [](const LegendPanel& panel) { return !panel.opacity.empty(); })) {
      add("Narrow strip beside the colors: opacity.");
    }
    if (page.scale_bar > 0 && !is_parallel) add("Scale bar: at the focal point.");
  }
  return page;
}

DrawnFigure drawn(const FigurePage& page) {
  DrawnFigure result;
  std::string error;
  (*draw_figure())(page, result, error);
  if (!error.empty()) throw Error("figure: " + error);
  return result;
}

/// Returns whether a page without its pixels could be drawn.
bool has_room(const FigurePage& page) {
  try {
    static_cast<void>(drawn(page));
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

FigureSpace figure_space(const SceneDescription& description, const Scene& scene) {
  FigureSpace space;
  space.camera = scene.camera;
  const Box<double> box = box_around(world_corners(scene));
  space.lower = box.lower;
  space.upper = box.upper;
  space.is_anatomical = std::ranges::all_of(description.layers, is_of_patient);
  if (space.is_anatomical) space.unit = "mm";
  return space;
}

std::string accuracy_caption(const FigureAccuracy& accuracy) {
  const Integration& integration = accuracy.integration;
  const std::string table =
      accuracy.transfer_function_error > 0
          ? " Opacity table: within " + number_text(accuracy.transfer_function_error, 2) + "."
          : "";
  if (accuracy.is_reference) {
    return "Volume rendering integral by adaptive quadrature to 1e\u221212." + table;
  }
  if (integration.method != Method::exact) {
    return "Sampled by the method " + std::string(method_name(integration.method)) +
           "; the error is not known.";
  }
  const std::string largest =
      std::isfinite(accuracy.largest_error) ? number_text(accuracy.largest_error, 2) : "not known";
  const std::string tolerance = number_text(integration.tolerance, 3);
  if (accuracy.pixels_over > 0) {
    return std::to_string(accuracy.pixels_over) + " of " + std::to_string(accuracy.pixels) +
           " pixels may be off the integral by more than the tolerance of " + tolerance +
           "; largest error " + largest + "." + table;
  }
  const std::string evidence = accuracy.pixels_proved >= accuracy.pixels ? "proved"
                               : accuracy.pixels_proved == 0
                                   ? "estimated"
                                   : "proved for " +
                                         percent_text(accuracy.pixels_proved, accuracy.pixels) +
                                         " of the pixels, else estimated";
  return "Each pixel within " + tolerance + " of the integral; largest error " + largest + " (" +
         evidence + ")." + table;
}

FigureFormat figure_format(const std::filesystem::path& path) {
  const std::string extension = in_small_letters(path.extension().string());
  if (extension == ".pdf") return FigureFormat::pdf;
  if (extension == ".svg") return FigureFormat::svg;
  if (extension == ".png") return FigureFormat::png;
  throw Error(path.string() + ": expected a name that ends in .pdf, .svg or .png");
}

void check_figure(const Figure& figure, ImageSize size, FigureFormat format) {
  static_cast<void>(drawn(page_of(figure, size, format, {})));
}

std::string encode_figure(const Image& image, const Figure& figure, FigureFormat format) {
  check_image(image, "figure");
  check_finite(image, "figure");
  std::vector<std::uint8_t> covered;
  covered.reserve(image.pixels.size());
  // Half a step of 8 bits is not seen.
  for (const auto& pixel : image.pixels) covered.push_back(pixel[3] > 1.0F / 512 ? 1 : 0);
  FigurePage page = page_of(figure, {image.width, image.height}, format, std::move(covered));
  const Background behind = figure.background.value_or(Rgb<double>{1, 1, 1});
  // check_figure(), which knows no pixels, has seen room for a page whose axes stand over the
  // picture.
  if (page.grows && !has_room(page)) {
    page = page_of(figure, {image.width, image.height}, format, std::move(page.covered), false);
  }
  page.picture = display_bytes(image, behind);
  Image empty;
  empty.width = 1;
  empty.height = image.height;
  empty.pixels.resize(static_cast<std::size_t>(image.height));
  page.behind = display_bytes(empty, behind);
  DrawnFigure result = drawn(page);
  if (format != FigureFormat::png) return std::move(result.bytes);
  constexpr double points_per_metre = 72 / 0.0254;
  return encode_png_bytes(
      result.width, result.height, result.rgb,
      static_cast<std::uint32_t>(std::lround(result.pixels_per_point * points_per_metre)),
      image.metadata);
}

void write_figure(const Image& image, const Figure& figure, const std::filesystem::path& path) {
  const FigureFormat format = figure_format(path);
  write_text_file(path, encode_figure(image, figure, format));
}

}  // namespace pellucid
