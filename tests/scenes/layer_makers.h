// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "tests/scenes/gallery.h"

/// Layers of which scenes are made.
namespace pellucid::scenes {

/// In [0, 1] within [-1,1]³.
double wave(double x, double y, double z);
Points ramp(double extinction, Rgb<double> low, Rgb<double> high);
/// A jump, a peak and a gap, in which nothing absorbs.
Points jumps(double extinction);
Layer grid(std::array<int, 3> dimensions, Points points);
Layer mesh(int cubes, Points points);
Layer gaussians();
/// Labels 0 to 5 in shells and halves, 2 without a style.
std::shared_ptr<const LabelVolume> segmentation(Centering centering);
Layer labels(Centering centering = Centering::point);
Layer masked();
/// A turn about an oblique axis, with a shear and a move.
Affine<double> oblique();
Layer moved(Layer layer, const Affine<double>& map);
/// A wave with vacuum around an oblique plane, and in one corner.
Layer with_vacuum(Points points);
/// A sheared grid of three spacings with oblique axes, of cells.
Layer oblique_cells(Points points);
Clip cut_away(Clip clip);
/// What everything in the gallery is about as large as.
Exhibit exhibit(std::vector<Layer> layers, std::vector<Clip> clips = {});

}  // namespace pellucid::scenes
