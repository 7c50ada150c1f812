// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkIndent.h>
#include <vtkSmartPointer.h>

#include <functional>
#include <limits>
#include <memory>
#include <ostream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "grid_layers.h"
#include "mesh_layers.h"
#include "pellucid/cpu/internal/moving_pictures.h"
#include "pellucid/cpu/renderer.h"
#include "pellucid/scene/scene.h"
#include "view.h"

class vtkAbstractVolumeMapper;
class vtkAlgorithm;
class vtkDataSet;
class vtkRayCastImageDisplayHelper;
class vtkRenderer;
class vtkUnstructuredGridVolumeMapper;
class vtkVolume;
class vtkVolumeMapper;
class vtkWindow;

namespace pellucid::plugin {

inline constexpr int max_threads = 1024;

/// Settings of a mapper that VTK's own do not have.
struct Settings {
  double tolerance = default_tolerance;
  Grade grade = Grade::estimated;
  int threads = 0;  ///< up to max_threads; 0: one per core
};

/// Set a number, and return whether it is another one than before. The tolerance is brought into
/// its limits; what is not a positive number is not taken.
bool set_tolerance(Settings& settings, double tolerance);
bool set_grade(Settings& settings, int grade);
void set_threads(Settings& settings, int threads);

/// Report on the last picture.
struct Outcome {
  bool exact = false;    ///< whether all of its pixels were rendered by the exact method
  bool sampled = false;  ///< whether it was sampled instead, because frames were asked for in time
  /// Largest error of any pixel; infinite if it is not exact.
  double largest_error = std::numeric_limits<double>::infinity();
  long long pixels_over = 0;  ///< pixels whose error is over the tolerance
  double seconds = 0;
};

/// Changes of the rays' colors before a window shows them.
struct Finish {
  /// Shows optical depths, up to 1, as a grey that hides what is behind it, wherever rays meet the
  /// data: the sums of additive blending.
  bool shows_depths = false;
  double scale = 1, bias = 0;  ///< then a color becomes scale · color + bias · opacity
  /// True if pictures are put over each other in whole numbers, which overflow where a color is
  /// larger than its opacity, as bright lights make it: opacities are then raised to the color.
  bool is_composited = false;

  /// Returns by which factor errors of a picture grow, at most; 1 or more. The slope of -ln(1 -
  /// opacity) is at most e, as long as that is at most 1.
  double growth() const noexcept;
};

/// Sets scale and bias for VTK's window and level of the final color; what is no window is left
/// out, and `notes` say so.
void set_final_colors(Finish& finish, double window, double level, Notes& notes);

/// Brings the data of a mapper up to date, as far as it has any.
void update_inputs(vtkAlgorithm& mapper);

/// Base of all mappers of this plug-in: they make a scene of a volume, render it, and put the
/// picture into the window's framebuffer, over what is there and under geometry in front of it.
class MapperCore {
 public:
  MapperCore();
  ~MapperCore();
  MapperCore(const MapperCore&) = delete;
  MapperCore& operator=(const MapperCore&) = delete;

  Settings settings;
  Outcome outcome;
  Finish finish;  ///< draw() sets whether it shows depths
  /// Settings that a mapper knows to be left out, beside those that draw() finds.
  Notes left_out;

  /// Draws a volume of a grid or of a mesh. What fails is told by the mapper's error event, what is
  /// left out by its warnings; each once.
  void draw(vtkVolumeMapper& mapper, const MaskImage& mask, vtkRenderer& renderer,
            vtkVolume& volume);
  /// Draws several volumes with their data as one: where they overlap, they mix.
  void draw(vtkVolumeMapper& mapper, const std::vector<std::pair<vtkDataSet*, vtkVolume*>>& parts,
            const MaskImage& mask, vtkRenderer& renderer, vtkVolume& volume);
  void draw(vtkUnstructuredGridVolumeMapper& mapper, vtkRenderer& renderer, vtkVolume& volume);
  /// Returns the scene that draw() renders, without geometry. Throws Error.
  Scene scene_of(vtkVolumeMapper& mapper, const MaskImage& mask, vtkRenderer& renderer,
                 vtkVolume& volume);
  Scene scene_of(vtkUnstructuredGridVolumeMapper& mapper, vtkRenderer& renderer, vtkVolume& volume);
  /// Lets go of what the display holds in a window.
  void release(vtkWindow* window);
  /// Returns how often data were read anew.
  int data_made() const noexcept { return grids_.volumes.made() + meshes_.made; }

 private:
  using MakeLayers = std::function<std::vector<TableLayer>(Notes&)>;

  /// Returns the scene of layers without its backdrop, to a tolerance.
  Scene scene_with(std::vector<TableLayer> layers, double tolerance, vtkRenderer& renderer,
                   vtkVolume& volume, const WindowView& view, Notes& notes);
  void draw_layers(vtkAbstractVolumeMapper& mapper, vtkRenderer& renderer, vtkVolume& volume,
                   const MakeLayers& make_layers);
  Image picture(const Scene& scene, vtkRenderer& renderer, double seconds);
  Image picture_in_time(const Scene& scene, vtkRenderer& renderer, double seconds);
  /// Returns the tolerance of what the finish is applied to.
  double inner_tolerance() const noexcept { return settings.tolerance / finish.growth(); }
  void take(const RenderReport& report);
  void finish_picture(const Scene& scene, Image& image);
  void raise_opacities(Image& image);
  void show(const Image& image, const WindowView& view, vtkRenderer& renderer, vtkVolume& volume);
  void tell(vtkAbstractVolumeMapper& mapper, const Notes& notes);

  KeptOfGrids grids_;
  KeptOfMeshes meshes_;
  Renderer renderer_, sampler_, shape_renderer_;
  MovingPictures moving_;
  vtkSmartPointer<vtkRayCastImageDisplayHelper> display_;
  std::vector<unsigned short> pixels_;
  std::set<std::string> told_;
  bool is_drawing_ = false;
};

/// Prints what a mapper was told and what its last picture came to, as PrintSelf() does.
void print_state(std::ostream& out, vtkIndent indent, const MapperCore& core);

}  // namespace pellucid::plugin
