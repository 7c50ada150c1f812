// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include "tests/scenes/cameras.h"
#include "tests/scenes/makers.h"

/// The scenes on which the tolerance is put to the test.
namespace pellucid::scenes {

/// Data behind a transfer function, and the cameras that look at it.
struct Exhibit {
  VolumePointer volume;
  TransferPointer transfer_function;
  std::vector<NamedCamera> cameras;
  int samples = 1;  ///< Scene::samples
  /// In place of the first two.
  std::shared_ptr<const Channels> channels{};
  std::shared_ptr<const MultivariateTransferFunction> multivariate{};
  /// In place of `volume` or `channels`.
  std::shared_ptr<const MeshChannels> mesh{};
  /// In place of all of these.
  std::vector<Layer> layers{};
  std::vector<Clip> clips{};
  std::vector<Light> lights{Light{}};
  bool backdrop = false;  ///< geometry among the data
};

/// Makes an exhibit for images of size × size pixels. Only cameras depend on the size: those that
/// send their rays through chosen places.
using MakeExhibit = std::function<Exhibit(int size)>;

struct GalleryEntry {
  std::string name;
  MakeExhibit make;
  std::filesystem::path file{};  ///< that `make` reads; empty: none
  /// Below this tolerance pixels may say that they are over it: the data, the table or the image
  /// does not have the digits.
  double min_tolerance = 0;
  /// Below this tolerance the grade `proved` is left out, and pixels of it may say that they are
  /// over it: where proofs take so many panels that a ray gives up.
  double least_proved = 0;

  /// Returns why `make` cannot read its file here; empty: it can.
  std::string why_missing() const;
};

using Gallery = std::vector<GalleryEntry>;

/// All of the following.
Gallery gallery();

Gallery marschner_lobb_gallery();  ///< one field, from a ramp to a peak of half width 2e-6
Gallery scan_gallery();            ///< files
Gallery cell_gallery();            ///< fields that are special inside of a cell
Gallery table_gallery();           ///< transfer functions that are special
Gallery grid_gallery();            ///< placements, types and values of the data
Gallery stride_gallery();          ///< what estimates over several cells can miss
Gallery gaussian_gallery();        ///< Gaussians over several channels
Gallery mesh_gallery();            ///< tetrahedra
Gallery layer_gallery();           ///< several layers, clips, labels and masks
Gallery light_gallery();           ///< shading, gradient opacity, isosurfaces and slices

/// One of the exhibit's cameras, with the integration that a scene has by default.
Scene scene_of(const Exhibit& exhibit, std::size_t camera, int size);

}  // namespace pellucid::scenes
