// SPDX-License-Identifier: Apache-2.0
//
// What Inviwo's IvfVolumeReader takes of such a file: <RawFile content="">, <Format content="">,
// <Dimension x="" y="" z="">, <ByteOffset content="">, <ByteOrder content=""> (1: big-endian), in
// older files <MetaDataItem key="LittleEndian"> with <MetaData content="0|1">, <Compression
// content=""> (1: gzip), <BasisAndOffset> and <WorldTransform> with <col0 x="" y="" z="" w="">.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "inviwo_values.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/scene/error.h"
#include "text/xml_scanner.h"
#include "transfer_functions/import_text.h"
#include "volumes/components.h"
#include "volumes/volume_format.h"

namespace pellucid {

namespace {

using Columns = std::array<Vec3<double>, 4>;

constexpr Columns identity{Vec3<double>{1, 0, 0}, Vec3<double>{0, 1, 0}, Vec3<double>{0, 0, 1},
                           Vec3<double>{0, 0, 0}};

struct IvfDocument {
  InviwoHeader header;
  std::optional<Columns> basis, world;
  int files = 0;
};

/// One file's tags.
class IvfReader {
 public:
  IvfReader(std::string_view text, const std::string& name) : scanner_(text, name), name_(name) {}

  IvfDocument read() {
    bool little = true;
    std::string_view key;
    Columns* columns = nullptr;
    while (const std::optional<XmlTag> tag = scanner_.next()) {
      if (tag->name == "BasisAndOffset" && !tag->closes) {
        columns = &document_.basis.emplace(identity);
      } else if (tag->name == "WorldTransform" && !tag->closes) {
        columns = &document_.world.emplace(identity);
      } else if (tag->closes) {
        if (tag->name == "BasisAndOffset" || tag->name == "WorldTransform") columns = nullptr;
      } else if (columns != nullptr && tag->name.starts_with("col") && tag->name.size() == 4) {
        take_column(*tag, *columns);
      } else if (tag->name == "MetaDataItem") {
        key = attribute(*tag, "key");
      } else if (tag->name == "MetaData") {
        if (key == "LittleEndian") little = number(*tag, "content") != 0;
      } else {
        take(*tag);
      }
    }
    document_.header.big_endian = document_.header.big_endian || !little;
    if (document_.files != 1) {
      throw Error(name_ + ": names " + (document_.files == 0 ? "no file" : "several files") +
                  " of values (RawFile); a volume has one");
    }
    if (!has_sides_) throw Error(name_ + ": has no Dimension; mend the header");
    return document_;
  }

 private:
  std::string_view attribute(const XmlTag& tag, std::string_view key) const {
    const auto found = tag.attributes.find(key);
    if (found != tag.attributes.end()) return found->second;
    throw Error(scanner_.where(tag) + ": <" + std::string(tag.name.substr(0, 40)) + "> has no " +
                std::string(key));
  }
  double number(const XmlTag& tag, std::string_view key) const {
    return imported::number_of(attribute(tag, key), scanner_.where(tag));
  }
  Vec3<double> vector(const XmlTag& tag) const {
    return {number(tag, "x"), number(tag, "y"), number(tag, "z")};
  }

  void take_column(const XmlTag& tag, Columns& columns) const {
    const auto number_of_column = static_cast<std::size_t>(tag.name[3] - '0');
    if (number_of_column > 3) return;
    if (number(tag, "w") != (number_of_column == 3 ? 1 : 0)) {
      throw Error(scanner_.where(tag) + ": is no affine map, which w = 0, 0, 0, 1 says");
    }
    columns[number_of_column] = vector(tag);
  }

  void take(const XmlTag& tag) {
    InviwoHeader& header = document_.header;
    constexpr std::array once =
        std::to_array<std::string_view>({"Format", "Dimension", "ByteOffset", "ByteOrder",
                                         "Compression", "DataRange", "ValueRange"});
    if (std::ranges::find(once, tag.name) != once.end() &&
        !seen_.insert(std::string(tag.name)).second) {
      header.ignored_keys.push_back(std::string(tag.name) + " (more than once)");
    }
    if (tag.name == "RawFile") {
      header.values = std::string(attribute(tag, "content"));
      ++document_.files;
    } else if (tag.name == "Format") {
      header.format = std::string(attribute(tag, "content"));
    } else if (tag.name == "Dimension") {
      const Vec3<double> sides = vector(tag);
      for (int a = 0; a < 3; ++a) {
        header.dimensions[static_cast<std::size_t>(a)] = inviwo_side(sides[a], name_);
      }
      has_sides_ = true;
    } else if (tag.name == "ByteOffset") {
      const double bytes = number(tag, "content");
      constexpr double most = 9007199254740992;  // 2^53
      if (!(bytes >= 0 && bytes <= most && bytes == std::floor(bytes))) {
        throw Error(scanner_.where(tag) + ": ByteOffset is no number of bytes");
      }
      header.skip_bytes = static_cast<std::uint64_t>(bytes);
    } else if (tag.name == "ByteOrder") {
      header.big_endian = number(tag, "content") == 1;
    } else if (tag.name == "Compression") {
      header.compressed = number(tag, "content") != 0;
    } else if (tag.name == "DataRange") {
      header.data_range = {number(tag, "x"), number(tag, "y")};
    } else if (tag.name == "ValueRange") {
      header.value_range = {number(tag, "x"), number(tag, "y")};
    } else if (tag.name == "Unit" || tag.name == "ValueUnit") {
      const auto content = tag.attributes.find("content");
      if (content != tag.attributes.end()) header.unit = std::string(content->second);
    } else if (!is_harmless(tag)) {
      header.ignored_keys.emplace_back(tag.name);
    }
  }

  /// Returns whether a tag leaves the picture as it is: a name, the document's own, or what is so
  /// without it.
  static bool is_harmless(const XmlTag& tag) {
    constexpr std::array known = std::to_array<std::string_view>(
        {"InviwoVolume", "InviwoTreeData", "InviwoWorkspace", "MetaDataMap", "MetaData", "Wrapping",
         "RawFiles", "ValueName", "Axis1Name", "Axis2Name", "Axis3Name", "Axis1Unit", "Axis2Unit",
         "Axis3Unit"});
    if (tag.name.starts_with('?') || tag.name.starts_with('!') ||
        std::ranges::find(known, tag.name) != known.end()) {
      return true;
    }
    const auto content = tag.attributes.find("content");
    if (content == tag.attributes.end()) return false;
    return (tag.name == "SwizzleMask" && content->second == "rgba") ||
           (tag.name == "Interpolation" && (content->second == "linear" || content->second == "1"));
  }

  XmlScanner scanner_;
  const std::string& name_;
  IvfDocument document_;
  bool has_sides_ = false;
  std::set<std::string> seen_;
};

/// Opens Inviwo's XML header (.ivf) and its file of values, which may be gzipped. Its
/// BasisAndOffset spans the cells that the values are the centres of, in the world that
/// WorldTransform says. Throws Error, also for several files of values.
VolumeFile open_ivf(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  constexpr std::size_t largest = std::size_t{1} << 24;
  const std::string text = read_text_file(path, largest);
  const IvfDocument document = IvfReader(text, name).read();
  InviwoHeader header = document.header;
  header.values = path.parent_path() / header.values;
  header.world = document.world;
  if (document.basis || document.world) {
    const auto& [x, y, z, offset] = document.basis ? *document.basis : identity;
    header.basis = {x, y, z};
    header.offset = offset;
  }
  return open_inviwo_values(header, name, options);
}

}  // namespace

extern const VolumeFormat ivf_format{.name = "Inviwo", .extensions = ".ivf", .open = open_ivf};

}  // namespace pellucid
