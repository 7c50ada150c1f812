// SPDX-License-Identifier: Apache-2.0
#include "images.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "pellucid/io/image_files.h"
#include "pellucid/scene/image_difference.h"
#include "pellucid/scene/srgb.h"

namespace pellucid::python {

namespace {

ImageHandle image_of(const py::object& object) {
  if (py::isinstance<ImageHandle>(object)) return py::cast<ImageHandle>(object);
  constexpr int flags = py::array::c_style | py::array::forcecast;
  const auto array = py::array_t<float, flags>::ensure(object);
  if (!array) PyErr_Clear();
  if (!array || array.ndim() != 3 || array.shape(2) != 4 || array.shape(0) > 65536 ||
      array.shape(1) > 65536) {
    throw Error(
        "image: expected an Image or an array (height, width, 4) of premultiplied linear "
        "light, got " +
        short_repr(object));
  }
  Image image;
  image.height = static_cast<int>(array.shape(0));
  image.width = static_cast<int>(array.shape(1));
  image.pixels.resize(static_cast<std::size_t>(array.size()) / 4);
  std::copy_n(array.data(), array.size(), image.pixels.data()->data());
  return {std::make_shared<const Image>(std::move(image))};
}

/// Returns the scene's background for Python's `...`, none for None, else a color.
std::optional<Background> background_of(const ImageHandle& handle, const py::object& background) {
  if (background.is(py::ellipsis())) return handle.background;
  if (background.is_none()) return std::nullopt;
  return background_from(background);
}

/// Returns an array (height, width) of one of the image's lists; None if it is empty.
template <class T>
py::object map_of(const py::object& self, const std::vector<T>& values) {
  if (values.empty()) return py::none();
  const Image& image = *py::cast<const ImageHandle&>(self).image;
  return view_of(values.data(), {image.height, image.width}, self);
}

py::array srgb8(const ImageHandle& handle, const py::object& background) {
  const auto color = background_of(handle, background);
  std::vector<std::uint8_t> bytes;
  {
    const ReleasedLock released;
    bytes = to_srgb8(*handle.image, color);
  }
  return py::array_t<std::uint8_t>(
      std::vector<py::ssize_t>{handle.image->height, handle.image->width, color ? 3 : 4},
      bytes.data());
}

/// Returns the color bars that `wanted` asks for: True, or the title of the first one.
std::vector<ColorBar> wanted_bars(const ImageHandle& handle, const py::object& wanted) {
  const bool has_title = py::isinstance<py::str>(wanted);
  if (!has_title && !py::isinstance<py::bool_>(wanted)) {
    throw Error("color_bar: expected True, False or a title, got " + short_repr(wanted));
  }
  if (!has_title && !py::cast<bool>(wanted)) return {};
  if (handle.bars.empty()) {
    throw Error(
        "color_bar: the image knows none: it shows labels, and functions of one variable, of a "
        "scene that was rendered");
  }
  std::vector<ColorBar> bars = handle.bars;
  if (has_title) bars.front().title = py::cast<std::string>(wanted);
  return bars;
}

void save(const ImageHandle& handle, const std::filesystem::path& path,
          const py::object& background, const py::object& color_bar) {
  const std::vector<ColorBar> bars = wanted_bars(handle, color_bar);
  const auto color = background_of(handle, background);
  const std::string extension = path.extension().string();
  if (extension != ".png" && extension != ".exr") {
    throw Error(path.string() + ": expected a name that ends in .png or .exr");
  }
  if (extension == ".exr" && !bars.empty()) {
    throw Error(path.string() + ": a color bar is drawn in a .png, never among numbers");
  }
  const ReleasedLock released;
  if (extension == ".exr") {
    write_exr(*handle.image, path);
  } else if (bars.empty()) {
    write_png(*handle.image, path, color);
  } else {
    write_png(with_color_bars(*handle.image, bars), path, color);
  }
}

/// Python's Figure: a picture and what is drawn around it.
struct FigureHandle {
  std::shared_ptr<const Image> image;
  Figure figure;
};

/// Returns the names of parts that are left out: of a text with commas, or of several.
std::vector<std::string> part_names(const py::object& without) {
  std::vector<std::string> names;
  if (!py::isinstance<py::str>(without)) {
    if (!py::isinstance<py::iterable>(without)) {
      throw Error("without: expected names of parts, got " + short_repr(without));
    }
    for (const py::handle name : without) {
      if (!py::isinstance<py::str>(name)) {
        throw Error("without: expected names of parts, got " + short_repr(without));
      }
      names.push_back(py::cast<std::string>(name));
    }
    return names;
  }
  std::string text = py::cast<std::string>(without);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    names.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return names;
}

FigureParts parts_of(const py::object& without, const std::optional<bool>& axes) {
  FigureParts parts;
  parts.axes = axes;
  for (const std::string& name : part_names(without)) {
    if (name == "color-bar") {
      parts.color_bars = false;
    } else if (name == "axes") {
      parts.axes = false;
    } else if (name == "scale-bar") {
      parts.scale_bar = false;
    } else if (name == "letters") {
      parts.orientation = false;
    } else if (name == "caption") {
      parts.caption = false;
    } else {
      throw Error("without: there is no part '" + name +
                  "'; there are color-bar, axes, scale-bar, letters and caption");
    }
  }
  return parts;
}

void save_figure(const FigureHandle& handle, const std::filesystem::path& path) {
  const ReleasedLock released;
  write_figure(*handle.image, handle.figure, path);
}

std::string figure_bytes(const FigureHandle& handle, const std::string& format) {
  const FigureFormat known = figure_format("figure." + format);
  const ReleasedLock released;
  return encode_figure(*handle.image, handle.figure, known);
}

FigureHandle figure_of(const ImageHandle& handle, const std::optional<std::filesystem::path>& path,
                       double width_mm, const py::object& without, const std::optional<bool>& axes,
                       const std::optional<std::string>& unit, const std::optional<bool>& patient,
                       const std::optional<std::string>& title,
                       const std::optional<std::string>& caption, const py::object& background) {
  FigureHandle made{handle.image, {handle.bars, handle.space}};
  Figure& figure = made.figure;
  figure.parts = parts_of(without, axes);
  figure.width = width_mm;
  figure.background = background_of(handle, background);
  if (title && !figure.bars.empty()) figure.bars.front().title = *title;
  if (figure.space && patient) {
    figure.space->is_anatomical = *patient;
    figure.space->unit = *patient ? "mm" : "";
  }
  if (figure.space && unit) figure.space->unit = *unit;
  if (caption) {
    figure.caption = *caption;
  } else if (figure.space) {
    FigureAccuracy accuracy = handle.accuracy;
    accuracy.largest_error = handle.report.largest_error;
    accuracy.pixels = handle.report.pixels;
    accuracy.pixels_proved = handle.report.pixels_proved;
    accuracy.pixels_over = handle.report.pixels_over_tolerance;
    figure.caption = accuracy_caption(accuracy);
  }
  check_figure(figure, {handle.image->width, handle.image->height},
               path ? figure_format(*path) : FigureFormat::svg);
  if (path) save_figure(made, *path);
  return made;
}

/// Returns objects of Python's ColorBar.
py::list color_bars_of(const ImageHandle& handle) {
  constexpr int count = 1024;
  const py::object type = py::module_::import("pellucid._image").attr("ColorBar");
  py::list bars;
  for (const ColorBar& bar : handle.bars) {
    const BarSamples samples = sample_bar(bar, count);
    py::object colors = py::none(), opacity = py::none(), range = py::none();
    if (bar.function) {
      py::array_t<double> signals({count, 3});
      auto at = signals.mutable_unchecked<2>();
      for (int i = 0; i < count; ++i) {
        const Rgb<double>& color = samples.colors[static_cast<std::size_t>(i)];
        at(i, 0) = linear_to_srgb(color.r);
        at(i, 1) = linear_to_srgb(color.g);
        at(i, 2) = linear_to_srgb(color.b);
      }
      colors = signals;
      range = py::make_tuple(bar.range[0], bar.range[1]);
    }
    if (!samples.opacity.empty()) {
      opacity = py::array_t<double>(static_cast<py::ssize_t>(samples.opacity.size()),
                                    samples.opacity.data());
    }
    py::list entries;
    for (const ColorBar::Entry& entry : bar.entries) {
      const auto signal = [](double x) { return linear_to_srgb(std::clamp(x, 0.0, 1.0)); };
      entries.append(py::make_tuple(
          entry.name,
          py::make_tuple(signal(entry.color.r), signal(entry.color.g), signal(entry.color.b))));
    }
    bars.append(type(bar.title, range, colors, opacity, entries));
  }
  return bars;
}

py::object compare(const ImageHandle& a, const py::object& other) {
  const ImageHandle b = image_of(other);
  const ImageDifference d = compare_images(*a.image, *b.image);
  const auto check = check_errors(*a.image, *b.image);
  const auto share_over = [&](double tolerance) {
    return static_cast<double>(pixels_over(*a.image, *b.image, tolerance)) /
           static_cast<double>(a.image->pixels.size());
  };
  const ImageHandle picture{std::make_shared<const Image>(difference_image(*a.image, *b.image))};
  return py::module_::import("pellucid._image")
      .attr("Comparison")(d.all.largest, d.all.root_mean_square, d.all.psnr, share_over(1.0 / 255),
                          py::make_tuple(d.row, d.column), d.all.not_finite,
                          check ? py::object(py::int_(check->over)) : py::object(py::none()),
                          py::cast(picture).attr("rgba"));
}

py::dict report_of(const ImageHandle& handle) {
  const RenderReport& r = handle.report;
  py::dict report;
  report["seconds"] = r.seconds;
  report["setup_seconds"] = r.setup_seconds;
  report["threads"] = r.threads;
  report["rays"] = r.rays;
  report["cells"] = r.cells;
  report["largest_error"] = r.largest_error;
  report["pixels"] = r.pixels;
  report["pixels_proved"] = r.pixels_proved;
  report["pixels_interpolated"] = r.pixels_interpolated;
  report["pixels_over_tolerance"] = r.pixels_over_tolerance;
  return report;
}

std::string image_repr(const ImageHandle& handle) {
  std::string text = "<pellucid.Image " + std::to_string(handle.image->width) + " x " +
                     std::to_string(handle.image->height);
  if (handle.tolerance > 0) {
    text += ", within " +
            py::cast<std::string>(py::str("{:.2g}").format(handle.report.largest_error)) +
            " of the integral";
    if (handle.report.pixels_over_tolerance > 0) {
      text +=
          ", " + std::to_string(handle.report.pixels_over_tolerance) + " pixels over the tolerance";
    }
  }
  return text + ">";
}

}  // namespace

ImageHandle image_of_scene(const SceneDescription& description, const Scene& scene,
                           std::optional<Background> background) {
  ImageHandle handle;
  handle.background = std::move(background);
  if (scene.integration.method == Method::exact) handle.tolerance = scene.integration.tolerance;
  handle.bars = color_bars(description, scene);
  handle.space = figure_space(description, scene);
  handle.accuracy.integration = scene.integration;
  handle.accuracy.transfer_function_error = approximation_error(scene);
  return handle;
}

void bind_images(py::module_& module) {
  py::class_<ImageHandle>(module, "Image", R"(
A rendered picture and how exact it is. Row 0 is at the top. Immutable: the arrays are views that
cannot be written to. A notebook shows it.

    Image(rgba)     of an array (height, width, 4), premultiplied linear light)")
      .def(py::init(&image_of), py::arg("rgba"))
      .def_property_readonly(
          "rgba",
          [](const py::object& self) {
            const Image& image = *py::cast<const ImageHandle&>(self).image;
            return view_of(image.pixels.data()->data(), {image.height, image.width, 4}, self);
          },
          "float32 (height, width, 4): premultiplied linear light, no copy.")
      .def(
          "__array__",
          [](const py::object& self, const py::object& type, const py::object& copy) {
            return array_as(self.attr("rgba"), type, copy);
          },
          py::arg("dtype") = py::none(), py::arg("copy") = py::none())
      .def_property_readonly(
          "error",
          [](const py::object& self) {
            return map_of(self, py::cast<const ImageHandle&>(self).image->error);
          },
          "float32 (height, width): largest possible error of any channel of a "
          "pixel, or None.")
      .def_property_readonly(
          "proved",
          [](const py::object& self) -> py::object {
            const py::object map = map_of(self, py::cast<const ImageHandle&>(self).image->proved);
            return map.is_none() ? map : map.attr("view")("bool");
          },
          "bool (height, width): whether the error is a proved bound, or None.")
      .def_property_readonly(
          "depth",
          [](const py::object& self) {
            return map_of(self, py::cast<const ImageHandle&>(self).image->depth);
          },
          "float32 (height, width): distance from the eye at which half of the "
          "opacity is reached, world units, inf in empty pixels; or None.")
      .def_property_readonly(
          "values",
          [](const py::object& self) {
            return map_of(self, py::cast<const ImageHandle&>(self).image->values);
          },
          "float32 (height, width): the numbers of a projection, NaN without "
          "data; or None.")
      .def_property_readonly("width", [](const ImageHandle& h) { return h.image->width; })
      .def_property_readonly("height", [](const ImageHandle& h) { return h.image->height; })
      .def_property_readonly(
          "tolerance",
          [](const ImageHandle& h) {
            return h.tolerance > 0 ? py::object(py::float_(h.tolerance)) : py::object(py::none());
          },
          "The tolerance it was rendered to; None if no error is known.")
      .def_property_readonly("report", &report_of, "Times and counts of the frame.")
      .def("to_srgb8", &srgb8, py::arg("background") = py::ellipsis(), R"(
Returns uint8 (height, width, 3), sRGB over the background, or without one (height, width, 4) with
straight alpha: the bytes of a PNG. `background`: the scene's by default, which is a dark gradient
unless it has one; None or "transparent": none; or a color, or two from above downwards.)")
      .def("save", &save, py::arg("path"), py::arg("background") = py::ellipsis(), py::kw_only(),
           py::arg("color_bar") = false, R"(
Writes .png (8 bits sRGB) or .exr (float, with depth, error and values if there are). color_bar=True
draws the colors of the values, or of the labels, over the right edge of a .png; a text is the title
of the first bar, for example "temperature in K". Raises Error if the file cannot be written, a
pixel is not finite, or there is no color bar.)")
      .def("figure", &figure_of, py::arg("path") = py::none(), py::arg("width_mm") = 85,
           py::kw_only(), py::arg("without") = py::tuple(), py::arg("axes") = py::none(),
           py::arg("unit") = py::none(), py::arg("patient") = py::none(),
           py::arg("title") = py::none(), py::arg("caption") = py::none(),
           py::arg("background") = py::ellipsis(), R"(
Returns the picture as a Figure of a paper: with color bars, axes, scale bar, letters of a patient
and a caption that tells its accuracy. A notebook shows it.

    path        also writes it: .pdf, .svg or .png
    width_mm    of the figure, 30 to 1000; text keeps its size, 6.5 and 7 pt
    without     parts that are left out: "color-bar", "axes", "scale-bar", "letters", "caption"
    axes        True or False: whether the box of the data has axes; None: unless of a patient
    unit        of length, for axes and scale bar; None: "mm" for data of a patient, else none
    patient     True if the world's x, y and z lead to a patient's left, back and head; None: as
                the files say that were read
    title       of the first color bar; None: the layer's name
    caption     in place of the sentence on the accuracy
    background  as of save()

An image that was not rendered here has neither bars nor axes. Raises Error if Cairo is missing, the
picture is too large, a name is unknown, or the file cannot be written.)")
      .def_property_readonly("color_bars", &color_bars_of,
                             "List of ColorBar: the legends of the visible layers.")
      .def("compare", &compare, py::arg("other"), R"(
Returns how far another image of the same size (or an array) is off: largest, rms, psnr,
share_over_255, at (row, column), not_finite, over_errors and difference (height, width, 4).)")
      .def("_repr_png_",
           [](const ImageHandle& h) { return py::bytes(encode_png(*h.image, h.background)); })
      .def("__repr__", &image_repr);
  py::class_<FigureHandle>(module, "Figure", R"(
A picture with text and lines around it, as for a paper (Image.figure()). A notebook shows it.)")
      .def("save", &save_figure, py::arg("path"), R"(
Writes .pdf, .svg or .png, complete or not at all. Raises Error if it cannot.)")
      .def(
          "encode",
          [](const FigureHandle& handle, const std::string& format) {
            return py::bytes(figure_bytes(handle, format));
          },
          py::arg("format"), "Returns the bytes of the file: \"pdf\", \"svg\" or \"png\".")
      .def_property_readonly("width_mm",
                             [](const FigureHandle& handle) { return handle.figure.width; })
      .def("_repr_svg_", [](const FigureHandle& handle) { return figure_bytes(handle, "svg"); })
      .def("__repr__", [](const FigureHandle& handle) {
        return py::str("<pellucid.Figure of {} x {} pixels, {:g} mm wide>")
            .format(handle.image->width, handle.image->height, handle.figure.width);
      });
  module.def(
      "read_image",
      [](const std::filesystem::path& path) {
        return ImageHandle{std::make_shared<const Image>(read_exr(path))};
      },
      py::arg("path"), "Reads an .exr with its error, depth and values.");
}

}  // namespace pellucid::python
