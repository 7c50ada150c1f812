// SPDX-License-Identifier: Apache-2.0
#include "images.h"

#include <string>
#include <utility>

#include "arrays.h"
#include "pellucid/io/image_files.h"
#include "pellucid/scene/image_difference.h"

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
      .def("compare", &compare, py::arg("other"), R"(
Returns how far another image of the same size (or an array) is off: largest, rms, psnr,
share_over_255, at (row, column), not_finite, over_errors and difference (height, width, 4).)")
      .def("_repr_png_",
           [](const ImageHandle& h) { return py::bytes(encode_png(*h.image, h.background)); })
      .def("__repr__", &image_repr);
  module.def(
      "read_image",
      [](const std::filesystem::path& path) {
        return ImageHandle{std::make_shared<const Image>(read_exr(path))};
      },
      py::arg("path"), "Reads an .exr with its error, depth and values.");
}

}  // namespace pellucid::python
