// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "volumes/components.h"
#include "vtk_piece_differences.h"

namespace pellucid {

/// A piece of an image in several files (.pvti).
struct ImagePiece {
  IndexBox box;  ///< its points, counted from the first of the whole; or its cells
  std::filesystem::path file;
};
/// Returns the pieces in the order of the list. Throws Error where one has no extent or no file.
std::vector<ImagePiece> image_pieces(const std::filesystem::path& path);

/// Reads a box of values out of pieces, which may overlap: a value is that of the first piece that
/// has it, whichever box is asked for. `read` gives the values of a box that lies in a piece, with
/// `components` side by side. A piece of whose values earlier ones have all, as of faces between
/// pieces, is read only to be compared, if `compares_all`. Adds what pieces disagree about to
/// `differences`. Throws Error where no piece has a value.
using ReadPiece = std::function<VolumeData(const ImagePiece&, const IndexBox& box)>;
VolumeData join_pieces(const std::vector<ImagePiece>& pieces, const IndexBox& box, int components,
                       PieceDifferences& differences, const ReadPiece& read,
                       const std::string& name, bool compares_all);

}  // namespace pellucid
