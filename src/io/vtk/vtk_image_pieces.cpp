// SPDX-License-Identifier: Apache-2.0
#include "vtk_image_pieces.h"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/scene/error.h"
#include "text/xml_scanner.h"

namespace pellucid {

namespace {

/// First and last along each axis.
using Extent = std::array<int, 6>;

Extent extent_of(const XmlTag& tag, const char* attribute, const XmlScanner& scanner) {
  Extent extent{};
  const auto found = tag.attributes.find(attribute);
  if (found != tag.attributes.end()) {
    std::istringstream numbers{std::string(found->second)};
    for (int& number : extent) numbers >> number;
    // Far from what differences of int hold.
    constexpr int most = 1 << 30;
    const bool fits = std::ranges::all_of(extent, [](int n) { return n > -most && n < most; });
    if (numbers && fits) return extent;
  }
  throw Error(scanner.where(tag) + ": " + std::string(tag.name) + " has no " + attribute +
              " of six whole numbers; it is damaged");
}

/// Returns the values that two boxes have in common; nothing if there are none.
std::optional<IndexBox> common(const IndexBox& a, const IndexBox& b) {
  IndexBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.first[axis] = std::max(a.first[axis], b.first[axis]);
    box.count[axis] =
        std::min(a.first[axis] + a.count[axis], b.first[axis] + b.count[axis]) - box.first[axis];
    if (box.count[axis] < 1) return std::nullopt;
  }
  return box;
}

std::size_t size(int n) {
  return static_cast<std::size_t>(n);
}

/// Calls visit(at, index, row) for each row of `part`: its first value in `box` and in itself, and
/// the number of values.
template <class Visit>
void visit_rows(const IndexBox& part, const IndexBox& box, const Visit& visit) {
  const std::size_t row = size(part.count[0]);
  std::size_t index = 0;
  for (int k = 0; k < part.count[2]; ++k) {
    for (int j = 0; j < part.count[1]; ++j, index += row) {
      const std::size_t z = size(part.first[2] - box.first[2] + k),
                        y = size(part.first[1] - box.first[1] + j),
                        x = size(part.first[0] - box.first[0]);
      visit(x + size(box.count[0]) * (y + size(box.count[1]) * z), index, row);
    }
  }
}

}  // namespace

std::vector<ImagePiece> image_pieces(const std::filesystem::path& path) {
  const std::string name = path.string();
  constexpr std::size_t largest = std::size_t{1} << 26;
  const std::string text = read_text_file(path, largest);
  XmlScanner scanner(text, name);
  std::optional<Extent> whole;
  std::vector<ImagePiece> pieces;
  while (const std::optional<XmlTag> tag = scanner.next()) {
    if (tag->closes) continue;
    if (tag->name == "PImageData") whole = extent_of(*tag, "WholeExtent", scanner);
    if (tag->name != "Piece" || !whole) continue;
    const Extent extent = extent_of(*tag, "Extent", scanner);
    const auto source = tag->attributes.find("Source");
    if (source == tag->attributes.end()) {
      throw Error(scanner.where(*tag) + ": Piece has no Source, the name of its file");
    }
    ImagePiece piece;
    piece.file = path.parent_path() / std::string(source->second);
    for (std::size_t a = 0; a < 3; ++a) {
      piece.box.first[a] = extent[2 * a] - (*whole)[2 * a];
      piece.box.count[a] = extent[2 * a + 1] - extent[2 * a] + 1;
    }
    pieces.push_back(piece);
  }
  return pieces;
}

VolumeData join_pieces(const std::vector<ImagePiece>& pieces, const IndexBox& box, int components,
                       PieceDifferences& differences, const ReadPiece& read,
                       const std::string& name, bool compares_all) {
  std::vector<std::pair<const ImagePiece*, IndexBox>> parts;
  for (const ImagePiece& piece : pieces) {
    const auto part = common(piece.box, box);
    const bool is_needed =
        part && (compares_all || std::ranges::none_of(parts, [&](const auto& earlier) {
                   return common(earlier.second, *part) == part;
                 }));
    if (is_needed) parts.emplace_back(&piece, *part);
  }
  if (parts.size() == 1 && parts.front().second == box) return read(*parts.front().first, box);
  const std::size_t count = value_count(box);
  std::vector<bool> known(count);
  std::optional<VolumeData> joined;
  // The first piece has the last word.
  std::ranges::reverse(parts);
  for (const auto& [piece, part] : parts) {
    const VolumeData values = read(*piece, part);
    if (!joined) {
      joined = make_values(std::string(type_name(values)), count * size(components), name);
    }
    if (joined->index() != values.index()) {
      throw Error(name + ": its pieces have values of different types; write them alike");
    }
    const IndexBox& its = part;
    std::visit(
        [&](const auto& of_part) {
          auto& all = std::get<std::decay_t<decltype(of_part)>>(*joined);
          auto* const to = all.writable().data();
          visit_rows(its, box, [&](std::size_t at, std::size_t from, std::size_t row) {
            for (std::size_t i = 0; i < row; ++i) {
              if (!known[at + i]) continue;
              for (std::size_t c = 0; c < size(components); ++c) {
                differences.add(static_cast<double>(to[(at + i) * size(components) + c]),
                                static_cast<double>(of_part[(from + i) * size(components) + c]));
              }
            }
            std::copy_n(of_part.data() + from * size(components), row * size(components),
                        to + at * size(components));
            std::fill_n(known.begin() + static_cast<std::ptrdiff_t>(at), row, true);
          });
        },
        values);
  }
  const auto gap = std::ranges::find(known, false);
  if (gap == known.end()) return *std::move(joined);
  auto index = static_cast<std::size_t>(gap - known.begin());
  std::string place;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t side = size(box.count[a]);
    place += (a == 0 ? "" : ", ") + std::to_string(size(box.first[a]) + index % side);
    index /= side;
  }
  throw Error(name + ": no piece has the value at (" + place +
              "); one is missing in its list, or its extent is wrong");
}

}  // namespace pellucid
