// SPDX-License-Identifier: Apache-2.0
#include "array_axes.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <vector>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

/// Returns the places of the axes that are left when those of one entry in front, then behind, are
/// dropped until `wanted` are left.
std::vector<std::size_t> squeezed(std::span<const std::int64_t> shape, std::size_t wanted) {
  std::size_t begin = 0, end = shape.size();
  while (end - begin > wanted && shape[begin] == 1) ++begin;
  while (end - begin > wanted && shape[end - 1] == 1) --end;
  std::vector<std::size_t> places;
  for (std::size_t a = begin; a < end; ++a) places.push_back(a);
  return places;
}

/// Colors and vectors have up to 4 numbers, tensors and other lists up to 8; steps are in front.
const char* guess_of_four(const std::array<std::int64_t, 4>& sides) {
  constexpr const char *first = "czyx", *second = "zcyx", *last = "zyxc";
  for (const std::int64_t most : {4, 8}) {
    const bool first_is_short = sides[0] <= most, last_is_short = sides[3] <= most;
    if (first_is_short != last_is_short) return first_is_short ? first : last;
    if (most > 4 || !first_is_short) continue;
    // A few slices of colors, rather than rows of a few values; but small arrays have few of all.
    const bool is_small = sides[1] <= 8 && sides[2] <= 8;
    return is_small && sides[0] < std::min({sides[1], sides[2], sides[3]}) ? first : last;
  }
  // As programs of microscopy write them: the channels of each slice.
  return sides[0] > 8 && sides[1] <= 4 ? second : first;
}

template <std::size_t size>
void copy_tiles(const std::byte* from, std::byte* to, const std::array<std::size_t, 3>& sides,
                const std::array<std::size_t, 3>& strides) {
  // Tiles of x and of the axis along which the source goes on, so that both stay in the cache.
  constexpr std::size_t tile = 32;
  std::size_t near = 1, far = 2;
  if (strides[2] < strides[1]) std::swap(near, far);
  const std::array<std::size_t, 3> target{1, sides[0], sides[0] * sides[1]};
  for (std::size_t k = 0; k < sides[far]; ++k) {
    for (std::size_t j = 0; j < sides[near]; j += tile) {
      const std::size_t j_end = std::min(j + tile, sides[near]);
      for (std::size_t i = 0; i < sides[0]; i += tile) {
        const std::size_t i_end = std::min(i + tile, sides[0]);
        for (std::size_t b = j; b < j_end; ++b) {
          const std::byte* source = from + size * (k * strides[far] + b * strides[near]);
          std::byte* const row = to + size * (k * target[far] + b * target[near]);
          for (std::size_t a = i; a < i_end; ++a) {
            std::memcpy(row + size * a, source + size * (a * strides[0]), size);
          }
        }
      }
    }
  }
}

}  // namespace

std::string checked_axes(const std::string& letters) {
  std::string known;
  bool wrong = letters.size() < 3 || letters.size() > 4;
  for (const char c : letters) {
    const char letter = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const bool is_one = std::string_view("xyzct").find(letter) != std::string_view::npos;
    wrong = wrong || !is_one || known.find(letter) != std::string::npos;
    known += letter;
  }
  for (const char letter : {'x', 'y', 'z'}) {
    wrong = wrong || known.find(letter) == std::string::npos;
  }
  if (!wrong) return known;
  std::string shown = letters.substr(0, 20);
  std::ranges::replace_if(
      shown, [](char c) { return c < ' ' || c > '~'; }, '?');
  throw Error("the axes \"" + shown +
              "\" are not understood; give a letter for each axis of the array in the order of its "
              "indices: z, y and x, and c for components or t for steps in time, as in zyx, xyz or "
              "tzyx");
}

std::string shape_text(std::span<const std::int64_t> shape) {
  std::string text;
  for (const std::int64_t n : shape) text += (text.empty() ? "" : ", ") + std::to_string(n);
  return text;
}

ArrayAxes array_axes(std::span<const std::int64_t> shape, const std::optional<std::string>& letters,
                     const std::string& what) {
  std::string names;
  std::vector<std::size_t> places;
  ArrayAxes axes;
  if (letters) {
    names = checked_axes(*letters);
    places = squeezed(shape, names.size());
    if (places.size() != names.size()) {
      throw Error(what + " has " + std::to_string(shape.size()) + " axes, but the axes \"" + names +
                  "\" are given; give a letter for each");
    }
  } else {
    places = squeezed(shape, 3);
    if (places.size() == 2) {
      throw Error(what +
                  " is an image of 2 axes and no volume; stack its slices along a third axis with "
                  "numpy.stack");
    }
    if (places.size() < 3 || places.size() > 4) {
      throw Error(what + " is no volume; it must have 3 axes, and may have a fourth for " +
                  "components, not " + std::to_string(places.size()) +
                  ": select or reshape with numpy");
    }
    names = "zyx";
    if (places.size() == 4) {
      names =
          guess_of_four({shape[places[0]], shape[places[1]], shape[places[2]], shape[places[3]]});
      axes.guess = names;
    }
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (names[i] == 'c' || names[i] == 't') {
      axes.components = places[i];
      axes.are_steps = names[i] == 't';
    } else {
      axes.space[static_cast<std::size_t>(names[i] - 'x')] = places[i];
    }
  }
  return axes;
}

std::string axes_note(std::span<const std::int64_t> shape, const ArrayAxes& axes) {
  static constexpr std::array ordinals{"first", "second", "third", "fourth"};
  const std::size_t place = axes.guess.find('c');
  std::string other = axes.guess == "czyx" ? "zyxc" : "czyx";
  return "of the four axes (" + shape_text(shape) + ") the " + ordinals[place] + " is taken for " +
         std::to_string(shape[*axes.components]) + " components, axes " + axes.guess +
         "; give axes, as in " + other + ", if it is another";
}

void copy_permuted(const std::byte* from, std::byte* to, std::size_t size,
                   const std::array<std::int64_t, 3>& sides,
                   const std::array<std::size_t, 3>& strides) {
  std::array<std::size_t, 3> n{};
  std::ranges::transform(sides, n.begin(),
                         [](auto side) { return static_cast<std::size_t>(side); });
  if (size == 1) copy_tiles<1>(from, to, n, strides);
  if (size == 2) copy_tiles<2>(from, to, n, strides);
  if (size == 4) copy_tiles<4>(from, to, n, strides);
  if (size == 8) copy_tiles<8>(from, to, n, strides);
}

void read_permuted(std::span<std::byte> to, std::size_t size, const std::array<int, 3>& count,
                   const std::array<std::size_t, 3>& space,
                   const std::function<void(std::byte*)>& read) {
  if (space[0] > space[1] && space[1] > space[2]) {
    read(to.data());
    return;
  }
  std::vector<std::byte> stored(to.size());
  read(stored.data());
  std::array<std::size_t, 3> strides{};
  for (std::size_t a = 0; a < 3; ++a) {
    strides[a] = 1;
    for (std::size_t b = 0; b < 3; ++b) {
      if (space[b] > space[a]) strides[a] *= static_cast<std::size_t>(count[b]);
    }
  }
  copy_permuted(stored.data(), to.data(), size, {count[0], count[1], count[2]}, strides);
}

}  // namespace pellucid
