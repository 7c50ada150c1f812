// SPDX-License-Identifier: Apache-2.0
#include <cairo.h>
#ifdef CAIRO_HAS_PDF_SURFACE
#include <cairo-pdf.h>
#endif
#ifdef CAIRO_HAS_SVG_SURFACE
#include <cairo-svg.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "cairo_module.h"
#include "cairo_pen.h"
#include "figure_composer.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/internal/axis_ticks.h"
#include "process/module_answer.h"

namespace pellucid {
namespace {

constexpr double least_pixels_per_point = 300.0 / 72;
/// Cairo's fixed-point coordinates end there.
constexpr int largest_side = 32767;
/// Adobe's limit of a page.
constexpr double largest_page = 14400;

cairo_status_t append_bytes(void* closure, const unsigned char* bytes, unsigned int length) {
  try {
    static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(bytes), length);
  } catch (...) {
    return CAIRO_STATUS_NO_MEMORY;
  }
  return CAIRO_STATUS_SUCCESS;
}

/// Returns a surface for a file of vectors, whose bytes go to `bytes`. Throws Error if Cairo was
/// built without.
CairoSurface vector_surface(const FigurePage& page, double width, double height,
                            std::string& bytes) {
  if (page.format == FigurePage::Format::pdf) {
#ifdef CAIRO_HAS_PDF_SURFACE
    CairoSurface surface(cairo_pdf_surface_create_for_stream(append_bytes, &bytes, width, height));
    check(cairo_surface_status(surface.get()));
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATOR, page.creator.c_str());
    // An empty date is none, in place of the present one.
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE,
                                   page.date.c_str());
    return surface;
#endif
  } else {
#ifdef CAIRO_HAS_SVG_SURFACE
    CairoSurface surface(cairo_svg_surface_create_for_stream(append_bytes, &bytes, width, height));
    check(cairo_surface_status(surface.get()));
    return surface;
#endif
  }
  throw Error(std::string("this Cairo cannot write ") + (page.format == FigurePage::Format::pdf
                                                             ? ".pdf; give .svg or .png"
                                                             : ".svg; give .pdf or .png"));
}

/// Returns the file with ids that are counted from 1 for each kind: Cairo counts what it has made
/// since the process began.
std::string with_own_ids(const std::string& svg) {
  std::map<std::string, std::string, std::less<>> ids;
  std::map<std::string, int, std::less<>> counts;
  constexpr std::string_view opening = " id=\"";
  for (std::size_t at = svg.find(opening); at != svg.npos; at = svg.find(opening, at)) {
    at += opening.size();
    const std::string id = svg.substr(at, svg.find('"', at) - at);
    const std::string kind = id.substr(0, id.find_last_not_of("0123456789") + 1);
    if (kind.size() < id.size()) ids[id] = kind + std::to_string(++counts[kind]);
  }
  std::string made;
  made.reserve(svg.size());
  std::size_t copied = 0;
  // Ids stand behind id=" and #, and end at " or ).
  for (std::size_t at = svg.find_first_of("\"#"); at != svg.npos;
       at = svg.find_first_of("\"#", at + 1)) {
    const std::size_t end = svg.find_first_of("\")", at + 1);
    if (end == svg.npos) break;
    const auto found =
        ids.find(std::string_view(svg).substr(at + 1, std::min<std::size_t>(end - at - 1, 64)));
    if (found == ids.end()) continue;
    made.append(svg, copied, at + 1 - copied);
    made += found->second;
    copied = end;
  }
  return made.append(svg, copied, svg.npos);
}

/// Whole pixels of a .png for each pixel of the picture, and its size.
struct PngSize {
  double pixels_per_point;
  int width, height;
};

PngSize png_size(const Layout& layout) {
  const double factor = std::ceil(least_pixels_per_point * layout.scale - 1e-9);
  const double scale = std::max(factor, 1.0) / layout.scale;
  const double width = std::ceil(scale * layout.page_width - 1e-6);
  const double height = std::ceil(scale * layout.page_height - 1e-6);
  if (width > largest_side || height > largest_side || width * height > 1 << 30) {
    throw Error("a .png of the picture's pixels would be " + short_number(width) + " by " +
                short_number(height) + " pixels large; give a .pdf, or a smaller picture");
  }
  return {scale, static_cast<int>(width), static_cast<int>(height)};
}

void draw_png(const FigurePage& page, Layout layout, DrawnFigure& drawn) {
  const PngSize size = png_size(layout);
  CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, size.width, size.height));
  check(cairo_surface_status(surface.get()));
  {
    Pen pen(surface.get());
    const double scale = size.pixels_per_point;
    cairo_scale(pen.get(), scale, scale);
    // The picture begins at a whole pixel.
    const double dx = std::round(scale * layout.picture.x) / scale - layout.picture.x;
    const double dy = std::round(scale * layout.picture.y) / scale - layout.picture.y;
    layout.picture = layout.picture.moved(dx, dy);
    const auto whole = [&](double x) { return std::round(scale * x) / scale; };
    const PageBox& stage = layout.stage;
    layout.stage = {whole(stage.x), whole(stage.y), whole(stage.right()) - whole(stage.x),
                    whole(stage.bottom()) - whole(stage.y)};
    compose(page, layout, pen);
  }
  cairo_surface_flush(surface.get());
  drawn.width = size.width;
  drawn.height = size.height;
  drawn.pixels_per_point = size.pixels_per_point;
  drawn.rgb.reserve(3 * static_cast<std::size_t>(size.width) *
                    static_cast<std::size_t>(size.height));
  const unsigned char* const data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  for (int row = 0; row < size.height; ++row) {
    const auto* from =
        reinterpret_cast<const std::uint32_t*>(data + static_cast<std::ptrdiff_t>(row) * stride);
    for (int column = 0; column < size.width; ++column) {
      for (const unsigned shift : {16U, 8U, 0U}) {
        drawn.rgb.push_back(static_cast<std::uint8_t>(from[column] >> shift & 0xffU));
      }
    }
  }
}

void draw(const FigurePage& page, DrawnFigure& drawn) {
  if (page.picture_width > largest_side || page.picture_height > largest_side) {
    throw Error("Cairo draws pictures of at most " + std::to_string(largest_side) +
                " pixels a side; give a smaller one");
  }
  Layout layout;
  {
    const CairoSurface none(cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1));
    Pen pen(none.get());
    layout = lay_out(page, pen);
  }
  const bool is_png = page.format == FigurePage::Format::png;
  if (is_png) static_cast<void>(png_size(layout));
  if (!is_png && layout.page_height > largest_page) {
    throw Error("is " + short_number(layout.page_height / 72 * 25.4) +
                " mm high; show fewer layers");
  }
  if (is_png && !page.picture.empty()) {
    draw_png(page, layout, drawn);
    return;
  }
  if (is_png) return;
  const CairoSurface surface =
      vector_surface(page, layout.page_width, layout.page_height, drawn.bytes);
  if (!page.picture.empty()) {
    Pen pen(surface.get());
    compose(page, layout, pen);
  }
  cairo_surface_finish(surface.get());
  check(cairo_surface_status(surface.get()));
  if (page.format == FigurePage::Format::svg) drawn.bytes = with_own_ids(drawn.bytes);
}

}  // namespace
}  // namespace pellucid

extern "C" __attribute__((visibility("default"))) void pellucid_draw_figure_1(
    const pellucid::FigurePage& page, pellucid::DrawnFigure& drawn, std::string& error) {
  using namespace pellucid;
  answer(error, "make the picture smaller", [&] { draw(page, drawn); });
}
