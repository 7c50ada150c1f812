// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkBoundingBox.h>
#include <vtkPVDataRepresentation.h>
#include <vtkSmartPointer.h>

#include <array>

#include "mapper_core.h"

class vtkAbstractVolumeMapper;
class vtkInformation;
class vtkInformationVector;
class vtkProp3D;

namespace pellucid::plugin {

/// A representation's picture, which the ranks of a server, or of pvbatch, make together. Each rank
/// draws its part of the data, and ParaView puts the parts over each other: C = C1 + (1 - a1) C2.
/// The errors of the colors add up. An error of an opacity changes how much of C2 is seen, and C2
/// is at most 1, so it adds as much again. Each of n ranks has 1 / 2n of the tolerance.
class SharedPicture {
 public:
  /// Shares the pictures of a mapper. Core and mapper outlive it.
  SharedPicture(MapperCore& core, vtkAbstractVolumeMapper& mapper);
  ~SharedPicture();
  SharedPicture(const SharedPicture&) = delete;
  SharedPicture& operator=(const SharedPicture&) = delete;

  /// Returns whether the tolerance of the whole picture is another one than before.
  bool set_tolerance(double tolerance);
  bool set_grade(int grade);
  void set_threads(int threads);

  /// Prepares a picture, on every rank: until it is drawn, there is nothing to draw. Warns, once,
  /// if the representation has no array to color by, for it then shows nothing. Has its view draw
  /// volumes after translucent geometry instead of peeling them together, which ParaView's views do
  /// unless told otherwise and Pellucid's mappers refuse. When the renderer ends its frame, the
  /// ranks tell each other what became of it.
  void prepare(vtkPVDataRepresentation& representation);

  /// Says, after prepare(), that the picture will not be drawn.
  void refuse() { core_.outcome = {}; }
  /// Looks, on every rank, whether ParaView can put the ranks' pictures over each other from back
  /// to front: by boxes, one for all that a rank shows in the view, which must not overlap. `own`:
  /// the box around this rank's part of the data, in the world of the view; invalid: it has none.
  /// If it cannot, the picture is one of an unknown error, and the first rank warns once.
  void check_order(vtkPVDataRepresentation& representation, const vtkBoundingBox& own);

  /// Returns what is known of the last picture: of those of all ranks.
  Outcome outcome() const;
  /// Returns how many processes' data a picture is of.
  static int ranks();

 private:
  class Gatherer;
  void gather();
  double share() const;

  MapperCore& core_;
  vtkAbstractVolumeMapper& mapper_;
  vtkSmartPointer<Gatherer> gatherer_;
  double tolerance_ = default_tolerance;
  Outcome gathered_;
  vtkSmartPointer<vtkPVDataRepresentation> representation_;  ///< of a picture on its way
  bool is_told_ = false, is_order_told_ = false;
  bool has_order_ = true;
};

/// Asks the pipeline of a representation for two layers of ghost cells if ranks share its data:
/// values and gradients at the borders are then those of the whole. A gradient of cell data takes
/// the cells around a ghost cell.
void request_ghosts(vtkInformationVector** inputs);

/// Tells a view where a representation's data are, by which it orders ranks: a box in the data's
/// own world, as the volume moves it. ParaView leaves the volume's transform out.
void set_bounds(vtkInformation& view, vtkPVDataRepresentation& representation,
                const vtkBoundingBox& own, vtkProp3D& volume);
/// Returns the box around a box that a volume moves.
vtkBoundingBox moved(const vtkBoundingBox& box, vtkProp3D& volume);

/// Watch on a volume: tells whether it was moved since the last call.
class Mover {
 public:
  bool moved(vtkProp3D& volume);

 private:
  std::array<double, 16> last_{};
};

/// Returns the smallest box that holds those of all ranks.
vtkBoundingBox joined_over_ranks(const vtkBoundingBox& own);

}  // namespace pellucid::plugin
