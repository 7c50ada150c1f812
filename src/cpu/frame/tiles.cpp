// SPDX-License-Identifier: Apache-2.0
#include "tiles.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <tuple>
#include <utility>

namespace pellucid {
namespace {

/// A tile's place on the way from the middle outwards: square rings, and around each.
struct TilePlace {
  int ring;
  double angle;
  Tile tile;

  bool operator<(const TilePlace& other) const {
    return std::tuple(ring, angle, tile.row, tile.column) <
           std::tuple(other.ring, other.angle, other.tile.row, other.tile.column);
  }
};

int divided_up(int n, int by) {
  return (n + by - 1) / by;
}

/// Adds the tiles of the pixels (first_column + i·stride, first_row + j·stride).
void add_lattice(ImageSize size, int level, int stride, int first_column, int first_row,
                 std::vector<TilePlace>& places) {
  const int step = stride * tile_edge;
  const int across = divided_up(size.width, step), down = divided_up(size.height, step);
  for (int j = 0; j < down; ++j) {
    for (int i = 0; i < across; ++i) {
      const int column = first_column + i * step, row = first_row + j * step;
      if (column >= size.width || row >= size.height) continue;
      const Tile tile{column,
                      row,
                      std::min(tile_edge, divided_up(size.width - column, stride)),
                      std::min(tile_edge, divided_up(size.height - row, stride)),
                      stride,
                      level};
      // Twice the distance from the middle, so that it is a whole number.
      const int x = 2 * i - (across - 1), y = 2 * j - (down - 1);
      places.push_back({std::max(std::abs(x), std::abs(y)), std::atan2(y, x), tile});
    }
  }
}

void append_in_order(std::vector<TilePlace> places, std::vector<Tile>& tiles) {
  std::sort(places.begin(), places.end());
  for (const TilePlace& place : places) tiles.push_back(place.tile);
}

}  // namespace

std::vector<Tile> make_tiles(ImageSize size, int preview) {
  std::vector<Tile> tiles;
  for (int level = preview; level >= 0; --level) {
    const int square = 1 << level;
    std::vector<TilePlace> places;
    if (level == preview) {
      add_lattice(size, level, square, 0, 0, places);
    } else {
      // Of each four squares, the upper left one has its pixel from the level before.
      add_lattice(size, level, 2 * square, square, 0, places);
      add_lattice(size, level, 2 * square, 0, square, places);
      add_lattice(size, level, 2 * square, square, square, places);
    }
    append_in_order(std::move(places), tiles);
  }
  return tiles;
}

std::vector<Tile> make_lattice(ImageSize size, int stride) {
  std::vector<TilePlace> places;
  add_lattice(size, 0, stride, 0, 0, places);
  std::vector<Tile> tiles;
  append_in_order(std::move(places), tiles);
  return tiles;
}

}  // namespace pellucid
