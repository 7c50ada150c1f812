// SPDX-License-Identifier: Apache-2.0
#include "mapper_core.h"

#include <vtkAbstractVolumeMapper.h>
#include <vtkAlgorithm.h>
#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkPropCollection.h>
#include <vtkRayCastImageDisplayHelper.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnstructuredGridVolumeMapper.h>
#include <vtkVolume.h>
#include <vtkVolumeMapper.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <thread>
#include <utility>

#include "pellucid/scene/error.h"
#include "selection.h"

namespace pellucid::plugin {
namespace {

using Clock = std::chrono::steady_clock;

/// A renderer that allows a volume so much time wants it still, and exact.
constexpr double still_seconds = 10;
/// Share of that time for the rays; the rest is for the display.
constexpr double share_for_rays = 0.85;
/// Every 8th pixel along each axis comes first.
constexpr int preview_levels = 3;
/// The display takes 15 bits.
constexpr float one = 32767;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

bool shows_translucent_geometry(vtkRenderer& renderer) {
  vtkPropCollection* const props = renderer.GetViewProps();
  for (int i = 0; i < props->GetNumberOfItems(); ++i) {
    auto* const prop = vtkProp::SafeDownCast(props->GetItemAsObject(i));
    if (prop->GetVisibility() != 0 && prop->HasTranslucentPolygonalGeometry() != 0) return true;
  }
  return false;
}

/// Keeps what VTK touches once a mapper has drawn, until the renderer ends its frame: a callback of
/// the check for an abort may take any of it from the scene. A volume that was given another mapper
/// has its own again until then.
class FrameKeeper : public vtkCommand {
 public:
  static FrameKeeper* New() { return new FrameKeeper; }
  vtkTypeMacro(FrameKeeper, vtkCommand)

  void begin(vtkRenderer& renderer, vtkVolume& volume, vtkAbstractVolumeMapper& mapper) {
    volume_ = &volume;
    mapper_ = volume.GetMapper();
    kept_.emplace_back(&mapper);
    kept_.emplace_back(&renderer);
    vtkPropCollection* const props = renderer.GetViewProps();
    for (int i = 0; i < props->GetNumberOfItems(); ++i) {
      kept_.emplace_back(props->GetItemAsObject(i));
    }
    renderer.AddObserver(vtkCommand::EndEvent, this);
  }
  /// Gives the volume its mapper again where it goes out of scope.
  struct Restorer {
    FrameKeeper& keeper;
    ~Restorer() { keeper.put_mapper_back(); }
  };
  void put_mapper_back() {
    if (volume_ == nullptr || volume_->GetMapper() == mapper_) return;
    wanted_ = volume_->GetMapper();
    is_changed_ = true;
    volume_->SetMapper(mapper_);
  }
  void Execute(vtkObject* renderer, unsigned long, void*) override {
    const vtkSmartPointer<FrameKeeper> self(this);
    renderer->RemoveObserver(this);
    if (is_changed_) volume_->SetMapper(wanted_);
    const std::vector<vtkSmartPointer<vtkObject>> end = std::move(kept_);
  }

 private:
  vtkSmartPointer<vtkVolume> volume_;
  vtkSmartPointer<vtkAbstractVolumeMapper> mapper_, wanted_;
  bool is_changed_ = false;
  std::vector<vtkSmartPointer<vtkObject>> kept_;
};

/// Returns the optical depth of an opacity in a picture of optical depths, in which nothing is
/// brighter than 1.
float depth_of(float opacity) {
  constexpr double most = 1 - 1 / std::numbers::e;
  if (!(double{opacity} < most)) return 1;
  return static_cast<float>(-std::log1p(-std::max(double{opacity}, 0.0)));
}

/// Returns the scene as an opaque shape: where rays meet its data.
Scene shape_of(const Scene& scene) {
  static const auto opaque = std::make_shared<const TransferFunction>(
      std::vector<TransferFunction::Point>{{0, 1, {0, 0, 0}}});
  Scene shape = scene;
  for (Layer& layer : shape.layers) {
    auto& content = std::get<VolumeContent>(layer.content);
    content.transfer_function = opaque;
    content.mask = nullptr;
    layer.projection = LayerProjection::maximum;
    layer.gradient_opacity = nullptr;
  }
  shape.integration.tolerance = largest_tolerance;
  return shape;
}

/// Returns the picture as the display takes it: premultiplied 15 bits, row 0 at the bottom, each
/// pixel twice along each axis.
///
/// The display stretches a picture of n texels so that the middles of the outermost texels lie at
/// the edges of the viewport, and filters it: pixels of one texel each would be moved by up to half
/// of a pixel. Of n = 2 w + 1 texels over w pixels, the middle of pixel i is the middle of texel
/// 2 i + 1.
void to_display(const Image& image, const WindowView& view, std::vector<unsigned short>& pixels) {
  const auto line = 8 * static_cast<std::size_t>(view.width);
  pixels.resize(2 * line * static_cast<std::size_t>(view.height));
  unsigned short* to = pixels.data();
  for (int y = view.height - 1; y >= 0; --y) {
    const std::array<float, 4>* const from = &image.at(view.column, view.row + y);
    for (int x = 0; x < view.width; ++x) {
      for (std::size_t c = 0; c < 4; ++c) {
        const float channel = std::clamp(from[x][c], 0.0F, 1.0F);
        to[8 * x + static_cast<int>(c)] = to[8 * x + 4 + static_cast<int>(c)] =
            static_cast<unsigned short>(channel * one + 0.5F);
      }
    }
    std::copy_n(to, line, to + line);
    to += 2 * line;
  }
}

}  // namespace

void update_inputs(vtkAlgorithm& mapper) {
  for (int port = 0; port < mapper.GetNumberOfInputPorts(); ++port) {
    if (mapper.GetNumberOfInputConnections(port) == 0) continue;
    int output = 0;
    if (vtkAlgorithm* const source = mapper.GetInputAlgorithm(port, 0, output)) {
      source->UpdateWholeExtent();
    }
  }
}

bool set_tolerance(Settings& settings, double tolerance) {
  if (!(tolerance > 0)) return false;
  const double within = nearest_tolerance(tolerance);
  return std::exchange(settings.tolerance, within) != within;
}

bool set_grade(Settings& settings, int grade) {
  const Grade wanted = grade == 1 ? Grade::proved : Grade::estimated;
  return std::exchange(settings.grade, wanted) != wanted;
}

double Finish::growth() const noexcept {
  // Sums are opaque: what the bias adds is known.
  const double of_colors =
      shows_depths ? std::numbers::e * std::abs(scale) : std::abs(scale) + std::abs(bias);
  return std::max(of_colors, 1.0);
}

void set_final_colors(Finish& finish, double window, double level, Notes& notes) {
  const auto [scale, bias] = final_colors(window, level, notes);
  finish.scale = scale;
  finish.bias = bias;
}

void set_threads(Settings& settings, int threads) {
  settings.threads = std::clamp(threads, 0, max_threads);
}

void print_state(std::ostream& out, vtkIndent indent, const MapperCore& core) {
  out << indent << "Tolerance: " << core.settings.tolerance << "\n";
  out << indent << "Grade: " << (core.settings.grade == Grade::proved ? "proved" : "estimated")
      << "\n";
  out << indent << "NumberOfThreads: " << core.settings.threads << "\n";
  out << indent << "Exact: " << core.outcome.exact << "\n";
  out << indent << "Sampled: " << core.outcome.sampled << "\n";
  out << indent << "LargestError: " << core.outcome.largest_error << "\n";
  out << indent << "PixelsOver: " << core.outcome.pixels_over << "\n";
}

MapperCore::MapperCore() = default;
MapperCore::~MapperCore() = default;

void MapperCore::release(vtkWindow* window) {
  if (display_ != nullptr) display_->ReleaseGraphicsResources(window);
}

Scene MapperCore::scene_with(std::vector<TableLayer> layers, double tolerance,
                             vtkRenderer& renderer, vtkVolume& volume, const WindowView& view,
                             Notes& notes) {
  Scene scene;
  std::vector<std::optional<OpacityTable>> tables;
  for (TableLayer& each : layers) {
    scene.layers.push_back(std::move(each.layer));
    tables.push_back(std::move(each.table));
  }
  scene.camera = view.camera;
  scene.size = view.size;
  const bool is_lit = std::ranges::any_of(
      scene.layers, [](const Layer& layer) { return layer.shading.has_value(); });
  scene.lights = lights_of(renderer, is_lit, notes);
  scene.integration.tolerance = nearest_tolerance(tolerance);
  scene.integration.grade = settings.grade;
  if (const double* const bounds = volume.GetBounds()) {
    std::array<double, 6> box;
    std::copy_n(bounds, 6, box.begin());
    scene.clips = depth_clips(view, box);
  }
  fit_tables(tables, scene, grids_.fits);
  return scene;
}

Scene MapperCore::scene_of(vtkVolumeMapper& mapper, const MaskImage& mask, vtkRenderer& renderer,
                           vtkVolume& volume) {
  Notes notes;
  return scene_with(layers_of(mapper, mapper.GetDataSetInput(), volume, mask, settings.tolerance,
                              has_ambient_light(renderer), grids_, notes),
                    settings.tolerance, renderer, volume, view_of(renderer, notes), notes);
}

Scene MapperCore::scene_of(vtkUnstructuredGridVolumeMapper& mapper, vtkRenderer& renderer,
                           vtkVolume& volume) {
  Notes notes;
  return scene_with(layers_of(mapper, volume, settings.tolerance, meshes_, notes),
                    settings.tolerance, renderer, volume, view_of(renderer, notes), notes);
}

void MapperCore::draw(vtkVolumeMapper& mapper, const MaskImage& mask, vtkRenderer& renderer,
                      vtkVolume& volume) {
  draw(mapper, {{mapper.GetDataSetInput(), &volume}}, mask, renderer, volume);
}

void MapperCore::draw(vtkVolumeMapper& mapper,
                      const std::vector<std::pair<vtkDataSet*, vtkVolume*>>& parts,
                      const MaskImage& mask, vtkRenderer& renderer, vtkVolume& volume) {
  finish.shows_depths = mapper.GetBlendMode() == vtkVolumeMapper::ADDITIVE_BLEND;
  draw_layers(mapper, renderer, volume, [&](Notes& notes) {
    const double share = function_share(parts.size());
    std::vector<TableLayer> layers;
    for (const auto& [data, part] : parts) {
      for (TableLayer& layer : layers_of(mapper, data, *part, mask, share * inner_tolerance(),
                                         has_ambient_light(renderer), grids_, notes)) {
        layers.push_back(std::move(layer));
      }
    }
    return layers;
  });
  grids_.keep_used();
}

void MapperCore::draw(vtkUnstructuredGridVolumeMapper& mapper, vtkRenderer& renderer,
                      vtkVolume& volume) {
  draw_layers(mapper, renderer, volume, [&](Notes& notes) {
    return layers_of(mapper, volume, settings.tolerance, meshes_, notes);
  });
  meshes_.looks.functions.keep_used();
  meshes_.looks.curves.keep_used();
}

void MapperCore::draw_layers(vtkAbstractVolumeMapper& mapper, vtkRenderer& renderer,
                             vtkVolume& volume, const MakeLayers& make_layers) {
  const bool selects = is_selecting(renderer);
  if (selects && !is_selected_by_prop(renderer)) return;
  if (is_drawing_) return;  // a callback of the check for an abort draws
  // Of a picture in tiles, a tile may show nothing of the renderer.
  int width = 0, height = 0, left = 0, bottom = 0;
  renderer.GetTiledSizeAndOrigin(&width, &height, &left, &bottom);
  if (width < 1 || height < 1) return;
  const Clock::time_point start = Clock::now();
  const Outcome before = std::exchange(outcome, {});
  is_drawing_ = true;
  try {
    Notes notes = left_out;
    std::vector<TableLayer> layers = make_layers(notes);
    if (layers.empty()) {
      outcome = {true, 0, 0};
    } else {
      const WindowView view = view_of(renderer, notes);
      const double of_functions = finish.shows_depths ? sum_tolerance(inner_tolerance()) : 0;
      Scene scene = scene_with(std::move(layers), inner_tolerance() - of_functions, renderer,
                               volume, view, notes);
      scene.backdrop = geometry_of(renderer, view);
      if (shows_translucent_geometry(renderer)) {
        notes.add("translucent geometry lies behind volumes, wherever it is");
      }
      tell(mapper, notes);
      const vtkSmartPointer<vtkRenderWindow> window(renderer.GetRenderWindow());
      vtkNew<FrameKeeper> keeper;
      if (window->HasObserver(vtkCommand::AbortCheckEvent) != 0) {
        keeper->begin(renderer, volume, mapper);
      }
      const FrameKeeper::Restorer restorer{*keeper};
      Image image = picture(scene, renderer, volume.GetAllocatedRenderTime());
      finish_picture(scene, image);
      if (selects) show_number_of_prop(renderer, image);
      if (renderer.GetRenderWindow() == window) show(image, view, renderer, volume);
    }
  } catch (const Cancelled&) {
  } catch (const std::exception& error) {
    if (told_.insert(error.what()).second) {
      vtkErrorWithObjectMacro(&mapper, << "Pellucid draws nothing: " << error.what());
    }
  }
  is_drawing_ = false;
  outcome.seconds = seconds_since(start);
  if (selects) outcome = before;
}

Image MapperCore::picture(const Scene& scene, vtkRenderer& renderer, double seconds) {
  const bool may_be_aborted =
      renderer.GetRenderWindow()->HasObserver(vtkCommand::AbortCheckEvent) != 0;
  if (seconds < still_seconds || may_be_aborted) {
    return picture_in_time(scene, renderer, seconds);
  }
  RenderOptions options;
  options.machine.threads = settings.threads;
  RenderResult done = renderer_.render(scene, options);
  moving_.note(false, done.report.seconds, static_cast<double>(done.report.pixels));
  take(done.report);
  return std::move(done.image);
}

Image MapperCore::picture_in_time(const Scene& scene, vtkRenderer& renderer, double seconds) {
  const Clock::time_point start = Clock::now();
  const bool is_still = seconds >= still_seconds;
  const vtkSmartPointer<vtkRenderWindow> window(renderer.GetRenderWindow());
  RenderOptions options;
  options.machine.threads = settings.threads;
  options.monitor.preview = preview_levels;
  const double pixels = 1.0 * scene.size.width * scene.size.height;
  const double allowed = seconds * share_for_rays;
  const bool sampled = !is_still && moving_.are_sampled(pixels, allowed);
  outcome.sampled = sampled;
  RunningFrame frame =
      sampled ? sampler_.start(sampled_scene(scene), options) : renderer_.start(scene, options);
  const auto is_over = [&] {
    if (is_still) return window->CheckAbortStatus() != 0;
    return seconds_since(start) > allowed;
  };
  while (!frame.finished()) {
    const int level = frame.state().level;
    if (is_over() && level >= 0) {
      moving_.note(sampled, seconds_since(start), pixels / (1 << 2 * level));
      return frame.look();
    }
    std::this_thread::sleep_for(std::chrono::microseconds(300));
  }
  RenderResult done = frame.wait();
  moving_.note(sampled, seconds_since(start), pixels);
  if (!sampled) take(done.report);
  return std::move(done.image);
}

void MapperCore::take(const RenderReport& report) {
  outcome.exact = true;
  outcome.largest_error = report.largest_error * finish.growth();
  outcome.pixels_over = static_cast<long long>(report.pixels_over_tolerance);
}

void MapperCore::finish_picture(const Scene& scene, Image& image) {
  if (finish.shows_depths) {
    RenderOptions options;
    options.machine.threads = settings.threads;
    const Image shape = shape_renderer_.render(shape_of(scene), options).image;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      const float sum = depth_of(image.pixels[i][3]), covered = shape.pixels[i][3];
      image.pixels[i] = {sum * covered, sum * covered, sum * covered, covered};
    }
    // The depths are of chords of the functions: what the chords are off by adds up.
    outcome.largest_error += sum_tolerance(inner_tolerance()) * std::abs(finish.scale);
  } else {
    shape_renderer_.clear();
  }
  if (finish.scale != 1 || finish.bias != 0) {
    const auto scale = static_cast<float>(finish.scale), bias = static_cast<float>(finish.bias);
    for (std::array<float, 4>& pixel : image.pixels) {
      for (std::size_t c = 0; c < 3; ++c) pixel[c] = scale * pixel[c] + bias * pixel[3];
    }
  }
  if (finish.is_composited) raise_opacities(image);
}

/// Raises opacities to the colors, and adds to the error. The color behind a pixel is at most 1,
/// and loses at most the increase of the opacity. A color over 1 is cut off, too.
void MapperCore::raise_opacities(Image& image) {
  const double before = outcome.largest_error;
  long long over = 0;
  for (std::array<float, 4>& pixel : image.pixels) {
    const float most = std::max({pixel[0], pixel[1], pixel[2]});
    if (!(most > pixel[3])) continue;
    const double lost = before + double{most} - double{pixel[3]};
    if (lost > settings.tolerance) ++over;
    outcome.largest_error = std::max(outcome.largest_error, lost);
    pixel[3] = std::min(most, 1.0F);
  }
  outcome.pixels_over = std::max(outcome.pixels_over, over);
}

void MapperCore::show(const Image& image, const WindowView& view, vtkRenderer& renderer,
                      vtkVolume& volume) {
  if (display_ == nullptr) {
    display_.TakeReference(vtkRayCastImageDisplayHelper::New());
    if (display_ == nullptr) {
      throw Error(
          "VTK has no display for pictures; link and initialize "
          "VTK::RenderingVolumeOpenGL2");
    }
    display_->PreMultipliedColorsOn();
    display_->SetPixelScale(2);  // of 15 bits
  }
  to_display(image, view, pixels_);
  int memory[2] = {2 * view.width, 2 * view.height}, origin[2] = {0, 0};
  int texels[2] = {memory[0] + 1, memory[1] + 1};
  // In front of all geometry: the rays know where it is.
  constexpr float at_the_front = 1e-7F;
  display_->RenderTexture(&volume, &renderer, memory, texels, texels, origin, at_the_front,
                          pixels_.data());
}

void MapperCore::tell(vtkAbstractVolumeMapper& mapper, const Notes& notes) {
  for (const std::string& line : notes.lines()) {
    if (!told_.insert(line).second) continue;
    vtkWarningWithObjectMacro(&mapper, << "Pellucid: " << line);
  }
}

}  // namespace pellucid::plugin
