// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/io/color_bar.h"
#include "pellucid/io/scene_json.h"
#include "pellucid/scene/image.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

/// World that a picture shows.
struct FigureSpace {
  Camera camera;
  Vec3<double> lower{}, upper{};  ///< corners of a box around the data, along the world's axes
  std::string unit;               ///< unit of length; empty: not known
  bool is_anatomical = false;     ///< true if the axes lead to a patient's L, P and S
};

/// Returns the world of a scene whose data were read. Of patients the unit is "mm".
FigureSpace figure_space(const SceneDescription& description, const Scene& scene);

/// Accuracy of a picture, for the caption.
struct FigureAccuracy {
  bool is_reference = false;           ///< adaptive quadrature to 1e-12 (render_reference())
  Integration integration;             ///< method; of others than exact no error is known
  double largest_error = 0;            ///< largest error of a pixel; infinite: not known
  std::uint64_t pixels = 0;            ///< pixels whose error is known
  std::uint64_t pixels_proved = 0;     ///< pixels whose error is a proved bound
  std::uint64_t pixels_over = 0;       ///< pixels whose error is above the tolerance
  double transfer_function_error = 0;  ///< approximation_error() of the scene
};

/// Returns one or two sentences on the accuracy of a picture.
std::string accuracy_caption(const FigureAccuracy& accuracy);

/// Parts of a figure that are drawn.
struct FigureParts {
  bool color_bars = true;
  bool scale_bar = true;
  bool orientation = true;  ///< letters of a patient, or directions of the axes
  bool caption = true;
  std::optional<bool> axes{};  ///< none: unless the data are those of a patient
};

/// Description of a figure: a picture with text and lines around and over it.
struct Figure {
  std::vector<ColorBar> bars;
  std::optional<FigureSpace> space{};      ///< none: without axes, scale bar and orientation
  std::string caption{};                   ///< UTF-8; may be empty
  std::optional<Background> background{};  ///< behind the picture; none: the white of the paper
  double width = 85;                       ///< width of the figure, in mm; a column of a journal
  FigureParts parts{};
};

/// Limits of Figure::width, in mm.
inline constexpr double smallest_figure_width = 30, largest_figure_width = 1000;

/// File formats of figures. Text and lines are vectors in the first two. A .png has the pixels of
/// the picture, or whole multiples of them, so that it has at least 300 per inch.
enum class FigureFormat { pdf, svg, png };
/// Returns the format of a file by its extension. Throws Error for others than .pdf, .svg and .png.
FigureFormat figure_format(const std::filesystem::path& path);

/// Throws Error if encode_figure() could not draw a picture of this size: to be called before a
/// long computation. Text is drawn by Cairo in a module, which may not be there.
void check_figure(const Figure& figure, ImageSize size, FigureFormat format);
/// Returns the file of a figure: the picture, pixel for pixel, over its background, as wide as
/// Figure::width leaves; beside it its color bars, and over it or around it the other parts. Text
/// is at least 6 pt high. The same input gives the same file. Throws Error as check_figure() does,
/// and if a pixel is not finite.
std::string encode_figure(const Image& image, const Figure& figure, FigureFormat format);
/// Writes that file, complete or not at all. Throws Error.
void write_figure(const Image& image, const Figure& figure, const std::filesystem::path& path);

}  // namespace pellucid
