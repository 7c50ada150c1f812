// SPDX-License-Identifier: Apache-2.0
//
// What VvdVolumeReader of Voreen takes of such a file: <RawData filename="" format="" x="" y=""
// z=""> or, since version 5, <RawData …> with <item value=""> for each path to try; then <MetaItem
// name=""> of Offset and Spacing with <value x="" y="" z="">, of Transformation with <value.row0
// x="" y="" z="" w=""> to row3, and of RealWorldMapping with <value scale="" offset="" unit="">.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "files/memory_limit.h"
#include "inviwo_values.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/scene/error.h"
#include "text/printable.h"
#include "text/text.h"
#include "text/xml_scanner.h"
#include "transfer_functions/import_text.h"
#include "volumes/components.h"
#include "volumes/volume_format.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

/// real = stored, as a share of its type's largest value, · scale + offset.
struct Mapping {
  double scale = 1, offset = 0;
};

struct VvdDocument {
  InviwoHeader header;
  Vec3<double> spacing{1, 1, 1}, offset{0, 0, 0};
  std::array<std::array<double, 4>, 4> rows{
      {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  std::optional<Mapping> mapping;
  std::vector<std::string> paths;  ///< of the values, to be tried in this order
  int volumes = 0;
};

/// One file's tags.
class VvdReader {
 public:
  VvdReader(std::string_view text, const std::string& name) : scanner_(text, name), name_(name) {}

  VvdDocument read() {
    while (const std::optional<XmlTag> tag = scanner_.next()) {
      const bool raw = tag->name == "RawData";
      if (tag->closes) {
        if (raw) in_raw_ = false;
        if (tag->name == "MetaItem" || tag->name == "MetaDataItem") item_.clear();
      } else if (raw) {
        take_raw(*tag);
      } else if (tag->name == "RawDataNoExternalFile" || tag->name == "OctreeData") {
        throw Error(name_ + ": keeps its values as " + std::string(tag->name) +
                    ", which is not read; save it in Voreen with a .raw file");
      } else if (in_raw_ && tag->name == "item") {
        document_.paths.emplace_back(attribute(*tag, "value"));
      } else if (tag->name == "MetaItem" || tag->name == "MetaDataItem") {
        note_item(attribute(*tag, "name"));
        item_ = tag->closed ? std::string() : in_small_letters(attribute(*tag, "name"));
      } else {
        take_value(*tag);
      }
    }
    if (document_.volumes == 0) throw Error(name_ + ": has no RawData; it is no volume of Voreen");
    if (document_.volumes > 1) {
      throw Error(name_ + ": holds " + std::to_string(document_.volumes) +
                  " volumes, of which one is read at a time; save one of them by itself");
    }
    if (document_.paths.empty()) throw Error(name_ + ": names no file of values");
    return document_;
  }

 private:
  std::string_view attribute(const XmlTag& tag, std::string_view key) const {
    const auto found = tag.attributes.find(key);
    if (found != tag.attributes.end()) return found->second;
    throw Error(scanner_.where(tag) + ": <" + printable(tag.name.substr(0, 40)) + "> has no " +
                std::string(key));
  }
  double number(const XmlTag& tag, std::string_view key) const {
    return imported::number_of(attribute(tag, key), scanner_.where(tag));
  }

  void take_raw(const XmlTag& tag) {
    ++document_.volumes;
    in_raw_ = !tag.closed;
    InviwoHeader& header = document_.header;
    header.format = std::string(attribute(tag, "format"));
    header.dimensions = {inviwo_side(number(tag, "x"), name_), inviwo_side(number(tag, "y"), name_),
                         inviwo_side(number(tag, "z"), name_)};
    if (const auto file = tag.attributes.find("filename"); file != tag.attributes.end()) {
      document_.paths.emplace_back(file->second);
    }
  }

  /// Keeps the name of an item that is neither read nor known to leave the picture as it is.
  void note_item(std::string_view item) {
    constexpr std::array known = std::to_array<std::string_view>(
        {"spacing", "offset", "transformation", "realworldmapping", "modality", "timestep"});
    constexpr std::array harmless = std::to_array<std::string_view>(
        {"patient", "study", "series", "image", "name", "uid", "acquisition", "institution"});
    const std::string small = in_small_letters(item);
    const bool is_known = std::ranges::find(known, small) != known.end() ||
                          std::ranges::any_of(harmless, [&](std::string_view word) {
                            return small.starts_with(word);
                          });
    if (!is_known) document_.header.ignored_keys.emplace_back(item);
    if (std::ranges::find(known, small) != known.end() && !seen_.insert(small).second) {
      document_.header.ignored_keys.push_back(std::string(item) + " (more than once)");
    }
  }

  void take_value(const XmlTag& tag) {
    if (tag.name == "value" && (item_ == "spacing" || item_ == "offset")) {
      Vec3<double>& to = item_ == "spacing" ? document_.spacing : document_.offset;
      to = {number(tag, "x"), number(tag, "y"), number(tag, "z")};
    } else if (tag.name == "value" && item_ == "realworldmapping") {
      document_.mapping = Mapping{number(tag, "scale"), number(tag, "offset")};
    } else if (item_ == "transformation" && tag.name.size() > 4) {
      const std::string_view end = tag.name.substr(tag.name.size() - 4);
      const auto row = static_cast<std::size_t>(end[3] - '0');
      if (!end.starts_with("row") || row > 3) return;
      document_.rows[row] = {number(tag, "x"), number(tag, "y"), number(tag, "z"),
                             number(tag, "w")};
    }
  }

  XmlScanner scanner_;
  const std::string& name_;
  VvdDocument document_;
  std::string item_;  ///< name of the MetaItem around, in small letters
  bool in_raw_ = false;
  std::set<std::string> seen_;
};

fs::path file_of(const VvdDocument& document, const fs::path& folder) {
  std::error_code error;
  for (const std::string& path : document.paths) {
    if (!path.empty() && fs::is_regular_file(folder / path, error)) return folder / path;
  }
  return folder / document.paths.front();
}

void place(const VvdDocument& document, const std::string& name, GridPlacement& placement) {
  const auto& rows = document.rows;
  if (rows[3] != std::array<double, 4>{0, 0, 0, 1}) {
    throw Error(name + ": its Transformation is no affine map, whose last row is 0 0 0 1");
  }
  const auto turned = [&](const Vec3<double>& v, double w) {
    Vec3<double> result{0, 0, 0};
    for (int i = 0; i < 3; ++i) {
      const auto& row = rows[static_cast<std::size_t>(i)];
      result[i] = row[0] * v.x + row[1] * v.y + row[2] * v.z + row[3] * w;
    }
    return result;
  };
  placement.origin = turned(document.offset, 1);
  for (int a = 0; a < 3; ++a) {
    Vec3<double> axis{0, 0, 0};
    axis[a] = document.spacing[a];
    const Vec3<double> step = turned(axis, 0);
    const double size = length(step);
    if (!(size > 0) || !std::isfinite(size)) {
      throw Error(name + ": its Spacing or Transformation leaves no distance along " +
                  std::string(1, "xyz"[a]) + "; give --spacing, or mend the header");
    }
    placement.spacing[a] = size;
    placement.direction.column[a] = step * (1 / size);
  }
}

/// Returns the values that a mapping makes of stored ones; the same data where it changes nothing.
VolumeData mapped(VolumeData stored, const Mapping& mapping, const std::string& name) {
  return std::visit(
      [&](const auto& values) -> VolumeData {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        using Real =
            std::conditional_t<(sizeof(Value) > 2 && !std::is_same_v<Value, float>), double, float>;
        double largest = 1;
        if constexpr (std::is_integral_v<Value>) {
          largest = static_cast<double>(std::numeric_limits<Value>::max());
        }
        if (mapping.scale == largest && mapping.offset == 0) return stored;
        check_memory(std::uintmax_t{values.size()} * sizeof(Real), name + ": its values");
        DataArray<Real> real(values.size());
        const std::span<Real> to = real.writable();
        for (std::size_t i = 0; i < values.size(); ++i) {
          double share = static_cast<double>(values[i]) / largest;
          if constexpr (std::is_integral_v<Value> && std::is_signed_v<Value>) {
            // Voreen maps the lowest to -1, the largest to 1 and 0 to 0.
            if (share < 0) {
              share = static_cast<double>(values[i]) /
                      -static_cast<double>(std::numeric_limits<Value>::lowest());
            }
          }
          to[i] = static_cast<Real>(share * mapping.scale + mapping.offset);
        }
        return real;
      },
      stored);
}

/// Opens a volume of Voreen (.vvd): a header in XML that names a file of values. Values stand at
/// the offset and from there at steps of the spacing, both turned by the transformation. A mapping
/// to real values other than Voreen's default is applied.
VolumeFile open_vvd(const fs::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  // Previews and histograms stand in it, too.
  constexpr std::size_t largest = std::size_t{1} << 26;
  const std::string text = read_text_file(path, largest);
  VvdDocument document = VvdReader(text, name).read();
  document.header.values = file_of(document, path.parent_path());
  ReadOptions rest = options;
  rest.spacing.reset();
  rest.origin.reset();
  VolumeFile file = open_inviwo_values(document.header, name, rest);
  if (!options.spacing) {
    place(document, name, file.description.placement);
  } else {
    file.description.placement.origin = document.offset;
  }
  apply_overrides(options, file.description);
  // Scale 1 and offset 0 is what Voreen writes where nobody said what the values are.
  if (document.mapping && (document.mapping->scale != 1 || document.mapping->offset != 0)) {
    file.read = [read = file.read, mapping = *document.mapping, name](ComponentRange range) {
      std::vector<VolumeData> list = read(range);
      for (VolumeData& data : list) data = mapped(std::move(data), mapping, name);
      return list;
    };
  }
  return file;
}

}  // namespace

extern const VolumeFormat vvd_format{.name = "Voreen", .extensions = ".vvd", .open = open_vvd};

}  // namespace pellucid
