// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkSmartPointer.h>

#include "mapper_core.h"

class vtkAbstractVolumeMapper;
class vtkInformationVector;
class vtkPVDataRepresentation;

namespace pellucid::plugin {

/// A representation's picture, which the ranks of a server, or of pvbatch, make together. Each rank
/// draws its part of the data, and ParaView puts the parts over each other, so that their errors
/// add up: each has an equal share of the tolerance.
class SharedPicture {
 public:
  /// Both outlive it.
  SharedPicture(MapperCore& core, vtkAbstractVolumeMapper& mapper);
  ~SharedPicture();
  SharedPicture(const SharedPicture&) = delete;
  SharedPicture& operator=(const SharedPicture&) = delete;

  /// Returns whether the tolerance of the whole picture is another one than before.
  bool set_tolerance(double tolerance);
  bool set_grade(int grade);
  void set_threads(int threads);

  /// Prepares a picture, on every rank. Warns, once, if the representation has no array to color
  /// by, for it then shows nothing. Has its view draw volumes after translucent geometry instead of
  /// peeling them together, which ParaView's views do unless told otherwise and Pellucid's mappers
  /// refuse. When the renderer ends its frame, the ranks tell each other what became of it.
  void prepare(vtkPVDataRepresentation& representation);

  /// Looks, on every rank, whether the parts of the data lie beside each other: boxes of parts that
  /// overlap have no order from back to front. Warns, once, and takes the picture as one of an
  /// unknown error.
  void check_order(vtkPVDataRepresentation& representation);

  /// Returns what is known of the last picture: of those of all ranks.
  Outcome outcome() const;
  /// Returns of how many processes' data pictures are.
  static int ranks();

 private:
  class Gatherer;
  void gather();

  MapperCore& core_;
  vtkAbstractVolumeMapper& mapper_;
  vtkSmartPointer<Gatherer> gatherer_;
  double tolerance_ = default_tolerance;
  Outcome gathered_;
  bool is_told_ = false, is_order_told_ = false;
  bool has_order_ = true;
};

/// Asks the pipeline of a representation for a layer of ghost cells if ranks share its data: values
/// and gradients at the borders are then those of the whole.
void request_ghosts(vtkInformationVector** inputs);

}  // namespace pellucid::plugin
