// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

namespace pellucid {

/// Which axes of an array, by their places in its shape from 0, are those of a volume. Axes that
/// are none of them have one entry.
struct ArrayAxes {
  std::array<std::size_t, 3> space{};     ///< those of x, y and z
  std::optional<std::size_t> components;  ///< the one beside them
  bool are_steps = false;                 ///< says that its letter is t, for steps in time
  std::string guess;  ///< letters of four axes that nobody named: "czyx"; else empty
};

/// Returns letters of axes in small letters, in the order of an array's indices: z, y and x once
/// each, and c for components or t for steps in time; "czyx". Throws Error for others.
std::string checked_axes(const std::string& letters);

/// Returns the axes of an array of this shape. Axes of one entry in front and behind do not count.
/// Three axes are z, y, x. Of four the components are the first or the last: the one that has at
/// most 4 entries, else at most 8; where both have at most 4, the last, unless all axes are short
/// and the first is the shortest; else the first, or the second where that has at most 4. `letters`
/// say otherwise (checked_axes). Throws Error that begins with `what`, "a.npy: an array of shape
/// (3, 4)". Needs pellucid::scene alone.
ArrayAxes array_axes(std::span<const std::int64_t> shape, const std::optional<std::string>& letters,
                     const std::string& what);

/// Returns "3, 4, 5".
std::string shape_text(std::span<const std::int64_t> shape);

/// Returns the guess of four axes, and how to say otherwise; for notes.
std::string axes_note(std::span<const std::int64_t> shape, const ArrayAxes& axes);

/// Copies values of `size` bytes, 1, 2, 4 or 8, so that x is the fastest axis and z the slowest.
/// `sides` and `strides`, in values, are those of x, y and z.
void copy_permuted(const std::byte* from, std::byte* to, std::size_t size,
                   const std::array<std::int64_t, 3>& sides,
                   const std::array<std::size_t, 3>& strides);

/// Reads values of `size` bytes of a box so that x is the fastest axis: `read` fills memory in the
/// order of the file, in which `space` are the places of x, y and z. `count` are the box's sides.
void read_permuted(std::span<std::byte> to, std::size_t size, const std::array<int, 3>& count,
                   const std::array<std::size_t, 3>& space,
                   const std::function<void(std::byte*)>& read);

}  // namespace pellucid
