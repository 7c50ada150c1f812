// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/interface.h"

extern "C" {

/// The next step of a ray through several layers, in records of floats: a head and, for each layer
/// that is there, a part.
struct PellucidLayerRow {
  enum Kind : int {
    medium,   ///< of the layers that `present` names
    absent,   ///< nothing but what is left out
    unknown,  ///< an opacity of at most `opacity`
    surface,  ///< at a place
    mark,     ///< the transparency in front of it is to be remembered
    doubt,    ///< an unknown opacity that is seen through the transparency at a mark
    by_host,  ///< a medium that is not for packets
    end       ///< of the ray
  };
  // Fields of a head. World lengths: of the row, of the ray from its begin on, of how far its ends
  // may be off; a bound on the extinction that is left out; the Kind; bits of the layers that are
  // present; the begin in the world, from PacketLight's origin; of surfaces and the like their
  // opacity, color and error, and the number of a mark.
  enum Head : int {
    length,
    left,
    position_error,
    left_out,
    kind,
    present,
    entry,
    opacity = entry + 3,
    color,
    error = color + 3,
    mark_number,
    head_fields = 16
  };
  // Fields of a part: the number of the function, PartKind, what the data may be off by; their
  // Bernstein coefficients, those of the gradient in the world, and of its magnitude. Of a cell its
  // place in the grid, and those of entry and exit in it; of a run of cells no more. Of layers of
  // several variables the data are elsewhere (PellucidLayeredJob::curves); here are the bits of the
  // primitives that may matter.
  enum Part : int {
    function,
    part_kind,
    rounding,
    data = 4,
    gradient = data + 4,
    magnitude = gradient + 12,
    part_fields = magnitude + 4,
    place = data,
    entry_in_cell = place + 4,
    exit_in_cell = entry_in_cell + 3,
    primitives_of_cell = exit_in_cell + 3,
    cell_fields = primitives_of_cell + 2,
    run_fields = 4,
    primitives_of_curve = data
  };
  enum PartKind : int {
    curve,
    constant,  ///< in place of data extinction and color
    cell,
    run  ///< of cells, through which the ray is to be followed
  };
  static constexpr int max_lanes = 16;
  static constexpr int of_a_ray = 16;  ///< rows, one after the other, and then the first again
  static constexpr int max_layers = 8, most_marks = 16;
  /// Returns how many numbers PellucidLayeredJob::curves has of a row: the Bernstein coefficients
  /// of each variable, and then what each may be off by, filled up to records of four.
  static constexpr int curve_fields(int variables) {
    return 4 * variables + (variables + 3) / 4 * 4;
  }
};

/// Rays in a grid, one in each lane, their parameter the world arc length. Planes of the grid are
/// at these places; null: in plane coordinates (PacketGrid).
struct PellucidGridRays {
  double origin[3][PellucidLayerRow::max_lanes], direction[3][PellucidLayerRow::max_lanes];
  const double* plane[3];
};

/// Rays through several layers, one in each lane, and what lies ahead of them. A packet is begun
/// once and goes on as often as it has new rows.
struct PellucidLayeredJob {
  enum Step : std::int32_t { size, begin, go_on, finish };
  Step step;
  unsigned char* state;     ///< aligned to 64 bytes; of state_size bytes
  std::int64_t state_size;  ///< out, of `size`
  std::int32_t lanes;       ///< out, of `size`

  // Of all rays.
  std::int32_t layers;
  const PellucidView<PellucidBinnedTransfer>* functions;
  const PellucidView<PellucidLight>* light;  ///< of each layer; null: unlit
  /// The grids of the variables of each layer whose cells parts name; null: they name none.
  const PellucidPacketJob* const* grid;
  const std::int32_t* lit_grid;  ///< of each layer, of these the variable whose gradient lights it
  const PellucidView<PellucidLaneMixture>* mixture;  ///< of each layer; null: of one variable
  /// Data of these layers' parts that are no cells: [lane][row], of each variable.
  const float* const* curves;
  double largest_color, largest_extinction;
  std::int32_t depth;  ///< whether results are to say where half of the opacity is

  // Of the lanes' rays.
  std::int32_t count;
  float tolerance[PellucidLayerRow::max_lanes], length[PellucidLayerRow::max_lanes];
  float to_eye[3][PellucidLayerRow::max_lanes];
  const float* head;                               ///< [lane][row]
  const float* part;                               ///< [layer][lane][row]
  const PellucidGridRays* walk;                    ///< of each layer, where parts are runs of cells
  const double* range;                             ///< [lane][row], of such parts: begin and end
  std::int32_t next[PellucidLayerRow::max_lanes];  ///< the first row that is not taken; in and out
  std::int32_t end[PellucidLayerRow::max_lanes];   ///< behind the last one that is there
  std::int32_t done[PellucidLayerRow::max_lanes];  ///< out: nothing more matters

  // Where a row is not for packets, or some of it: the caller integrates the share [from, to] of
  // the row before `next`.
  std::int32_t waits[PellucidLayerRow::max_lanes];     ///< out
  std::int32_t gives_up[PellucidLayerRow::max_lanes];  ///< in: such a ray is not followed further
  double from[PellucidLayerRow::max_lanes], to[PellucidLayerRow::max_lanes];
  double allowance_flat[PellucidLayerRow::max_lanes];
  double allowance_per_opacity[PellucidLayerRow::max_lanes];
  PellucidCellResult handed[PellucidLayerRow::max_lanes];  ///< in, of lanes that wait

  PellucidRayResult* results;  ///< of `finish`
};

PELLUCID_KERNEL(pellucid_integrate_layers, PellucidLayeredJob);
}
