// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arguments/color_arguments.h"
#include "arguments/import_arguments.h"
#include "arguments/input.h"
#include "arguments/light_arguments.h"
#include "arguments/mesh_input.h"
#include "arguments/output.h"
#include "pellucid/cpu/render.h"
#include "pellucid/io/film.h"
#include "pellucid/io/scene_json.h"

namespace pellucid::cli {

/// Figures that are written, as given.
struct FigureArguments {
  std::vector<std::string> files;
  std::string width, without, with, unit;

  void add_to(CommandLine& command);
};

struct RenderArguments {
  std::string input;
  std::vector<std::string> outputs;
  std::string depth_picture, error_map, values, save_tf, save_scene;
  std::vector<std::string> channels, gaussians, layers, labels, label_tables, clips;
  std::string transfer_function, preset, look, projection, camera, view, size, background, backdrop;
  ImportArguments import;
  ColorArguments colors;
  LightArguments light;
  std::string method, precision, grade, device;
  std::optional<std::string> tolerance;
  std::optional<double> step;
  std::optional<double> azimuth, elevation, zoom;
  std::optional<int> samples;
  int threads = 0;
  std::string balance;  ///< balance of the bricks of ranks
  bool ranks = false;
  FigureArguments figure;
  std::string color_bar_title;
  bool color_bar = false;
  bool print_tf = false, reference = false, strict = false, json = false, quiet = false,
       verbose = false;
  /// Several channels without a function get suggested Gaussians, in place of an error.
  bool suggests_functions = false;
  /// Values of INPUT that are read; none: all.
  std::optional<IndexBox> crop{};
  VolumeOptions volume;
  MeshOptions mesh;

  bool is_scene() const;
  /// Returns whether there is no layer but those of --layer and --labels.
  bool has_only_added_layers() const {
    return input.empty() && channels.empty() && !(layers.empty() && labels.empty());
  }
  /// Tells whether colors at the points of INPUT are shown as they are.
  bool takes_own_colors() const {
    return transfer_function.empty() && preset.empty() && gaussians.empty() && channels.empty() &&
           projection.empty() && colors.colormap.empty() && colors.range.empty();
  }
  bool wants_color_bar() const { return color_bar || !color_bar_title.empty(); }
  bool renders() const {
    return !outputs.empty() || !figure.files.empty() || !depth_picture.empty() ||
           !error_map.empty() || !values.empty();
  }
};

/// Returns whether an error comes with a picture by these.
inline bool knows_its_error(const RenderArguments& arguments, const Integration& integration) {
  return !arguments.reference && integration.method == Method::exact;
}

/// The scene, and what is told of how it came about.
struct PreparedScene {
  Scene scene;
  SceneDescription description;  ///< complete: with nothing left to defaults
  std::string transfer_function_from;
  std::vector<std::string> import_notes;  ///< of a transfer function of another program
  std::shared_ptr<Look> look;             ///< of a file alone, once it is loaded; null: none
  std::vector<std::size_t> quick_layers;  ///< whose Gaussians were suggested quickly
  bool array_chosen = false;              ///< of a mesh, for want of a name
  bool has_own_camera = false;            ///< the input has a camera
  double tolerance_asked = 0;             ///< Integration::tolerance is the one used
  /// Whole of a layer on all ranks, where `scene` has the part of one of them; else empty.
  struct WholeLayer {
    std::array<int, 3> dimensions{};
    std::size_t nan = 0;
  };
  std::vector<WholeLayer> whole_layers;
  /// The number of different values of each channel that looks like labels, by its name.
  std::vector<std::pair<std::string, std::size_t>> labels;

  /// Returns whether an error comes with the picture.
  bool knows_its_error(const RenderArguments& arguments) const {
    return cli::knows_its_error(arguments, scene.integration);
  }
};

/// Returns all that is read as data, as it was given.
std::string source_text(const RenderArguments& arguments);

void add_render_options(CommandLine& command, RenderArguments& arguments);
/// Adds the part of them that says what is seen, and from where.
void add_scene_options(CommandLine& command, RenderArguments& arguments);

/// Adds the options of the picture: its size, its background and its color bar.
void add_picture_options(CommandLine& command, RenderArguments& arguments);
/// Adds the options of the integration: method, tolerance, machine.
void add_integration_options(CommandLine& command, RenderArguments& arguments);

/// Gives a file alone a look where nothing says how it is shown, or that of --look; one that has a
/// function, to print or save it. Throws UsageError.
void want_look(const RenderArguments& arguments, PreparedScene& prepared);
/// Throws UsageError if a function is to be printed or saved, but the look has none.
void check_look(const RenderArguments& arguments, const PreparedScene& prepared);
/// Returns the line that tells of prepared.look and names the others of the data.
std::string look_line(const PreparedScene& prepared);
/// Gives a look in light its lights, unless the arguments have some.
void light_look(const RenderArguments& arguments, PreparedScene& prepared);

/// Throws UsageError for what cannot be done, and Error where a file could not be written later.
void check_arguments(const RenderArguments& arguments);
/// The points that stand for an opacity table have an error; the reference should have none worth
/// speaking of. Each further digit makes it three times slower.
inline constexpr double reference_tolerance = 1e-5;
/// Puts that of --preset or --tf into the description; `import_notes` gets what is told of a file
/// of another program. Throws Error.
void set_transfer_function(const RenderArguments& arguments, SceneDescription& description,
                           std::vector<std::string>& import_notes);
/// A scene that is described, and whose data are not read yet.
struct SceneRequest {
  PreparedScene prepared;        ///< without the scene
  SceneDescription description;  ///< scene that is to be read
  std::shared_ptr<std::vector<std::string>> mesh_notes;
  /// Layers whose data were read for a suggested function, with these; none of the others.
  std::vector<std::optional<Layer>> loaded;
  /// Steps of the data, one of which is asked for; none: no time is, or that of a film.
  std::optional<SceneTimes> times;
};
/// Puts the arguments over what the input says. Throws Error.
SceneRequest request_scene(const RenderArguments& arguments);
/// Returns visible_corners() of a scene.
using VisibleCorners = std::function<std::array<Vec3<double>, 8>(const Scene&)>;
/// Completes the request with the scene that was read. Throws Error.
PreparedScene complete_scene(const RenderArguments& arguments, SceneRequest request, Scene loaded,
                             const std::vector<MeshSource>& meshes, const VisibleCorners& visible);
/// Moves the camera of a scene until what is seen fills the picture (framed_camera()).
using CameraFraming = std::function<Camera(const Scene&)>;
/// Turns the camera as the arguments say, moves it by `frame` unless it is the input's own, and
/// enlarges the picture. Throws Error.
void place_camera(const RenderArguments& arguments, PreparedScene& prepared,
                  const CameraFraming& frame);
/// Does the same in this process, by drafts, which a signal ends. Throws Interrupted too.
void place_camera(const RenderArguments& arguments, PreparedScene& prepared);
/// Reads the input and puts the arguments over what it says; `change`, unless it is empty, may
/// change the request before its data are read. Throws Error.
PreparedScene prepare(const RenderArguments& arguments,
                      const std::function<void(SceneRequest&)>& change = {});

/// A picture and what is told of it.
struct RenderedPicture {
  Image image;
  RenderReport report;
  std::optional<std::string> over;  ///< why it is over the tolerance
  std::string ranks_json;           ///< an object of --json; empty: one process
  std::vector<std::string> notes{};
};
/// Returns the options of drafts, which a signal ends.
RenderOptions quiet_options_of(const RenderArguments& arguments);
/// Returns the options of a frame.
RenderOptions options_of(const RenderArguments& arguments, const PreparedScene& prepared);
/// Shows colors at the points of INPUT as they are if nothing else is asked for; `notes` get a
/// line. Throws Error.
void set_own_colors(const RenderArguments& arguments, LayerDescription& layer,
                    std::vector<std::string>& notes);
/// Throws UsageError if --color-bar has no .png to be drawn in, and Error if it cannot be drawn.
void check_color_bar(const RenderArguments& arguments);
/// Returns the picture with the color bars that are asked for; none: it has none. `notes` get a
/// line if there is nothing to draw. Throws Error.
std::optional<Image> with_wanted_color_bars(const RenderArguments& arguments,
                                            const PreparedScene& prepared, const Image& image,
                                            std::vector<std::string>& notes);
/// Throws UsageError for wrong options of figures, and Error if Cairo, which draws them, is
/// missing.
void check_figures(const RenderArguments& arguments);
/// Throws Error if the figures of a scene could not be drawn.
void check_figures(const RenderArguments& arguments, const PreparedScene& prepared);
/// Writes a figure. Throws Error.
void write_figure(const RenderArguments& arguments, const PreparedScene& prepared,
                  const RenderedPicture& picture, const std::string& file);
/// Writes the pictures and other files, the report and the notes. Throws Error, and OverTolerance
/// if the picture is over the tolerance.
void write_picture(const RenderArguments& arguments, const PreparedScene& prepared,
                   const std::string& transfer_function, RenderedPicture& picture);
/// Renders on the ranks that this process is one of, and writes on the first. Returns the exit
/// status.
int run_on_ranks(const RenderArguments& arguments);
/// Returns whether this process is one of several ranks, by its arguments and its environment.
bool is_rank(int argc, char** argv);
/// Ends the program on all of its ranks, of which this one has wrong arguments, with one line in
/// all. Returns the exit status. Throws Error if messages cannot be passed.
int fail_on_ranks(const std::string& wrong_use);

/// Makes `tolerance` that of the scene, or the nearest one within the limits; opacity tables are
/// approximated anew. Throws Error.
void set_scene_tolerance(PreparedScene& prepared, double tolerance);

/// Counts NaN in all channels together; of a mesh over the points or cells that are used.
std::size_t nan_values(const PreparedScene& prepared);
/// Calls visit(name, volume) for each volume of a layer that comes from a file and is shown as a
/// field. `index` and `layers`: of the layer among so many, for the name.
void visit_fields_of_files(const Layer& layer, const LayerDescription& description,
                           std::size_t index, std::size_t layers,
                           const std::function<void(const std::string&, const Volume&)>& visit);
/// Adds the arguments that determine the picture, and its error, and nothing else: no time, no
/// thread count, so that the same scene gives the same file.
void add_metadata(const RenderArguments& arguments, const PreparedScene& prepared,
                  const RenderReport& report, Image& image);
/// Returns the depths as a picture: nearest white, farthest black, transparent where the pixel is
/// empty.
Image depth_picture(const Image& image);
/// Returns the time and the accuracy of a picture, a few lines for people.
std::vector<std::string> report_lines(const RenderArguments& arguments,
                                      const PreparedScene& prepared, const RenderReport& report);
/// Returns the report as JSON. `largest` is the largest channel of any pixel.
Json report_json(const RenderArguments& arguments, const PreparedScene& prepared,
                 const RenderedPicture& picture, double largest,
                 const std::vector<std::string>& written);

}  // namespace pellucid::cli
