// SPDX-License-Identifier: Apache-2.0
//
// OME-XML 2016-06 and the OME-TIFF specification:
// https://docs.openmicroscopy.org/ome-model/6.3.1/ome-tiff/specification.html
// <OME><Image><Pixels DimensionOrder= SizeX= … PhysicalSizeX= PhysicalSizeXUnit= …>
// <Channel Name=/> <TiffData IFD= FirstZ= FirstC= FirstT= PlaneCount=><UUID FileName=/></TiffData>
// <Plane TheZ= TheC= TheT= PositionZ=/>.

#include "ome_xml.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "pellucid/scene/error.h"
#include "text/printable.h"
#include "text/readable_number.h"
#include "text/text.h"
#include "text/xml_scanner.h"

namespace pellucid {

namespace {

std::string_view without_prefix(std::string_view name) {
  return name.substr(name.find(':') + 1);  // npos + 1 is 0
}

std::string attribute(const XmlTag& tag, std::string_view key) {
  const auto found = tag.attributes.find(key);
  return found == tag.attributes.end() ? std::string() : xml_text(trimmed(found->second));
}

std::optional<double> number(const XmlTag& tag, std::string_view key) {
  const std::string word = attribute(tag, key);
  double value = 0;
  const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool is_whole_word = result.ptr == word.data() + word.size();
  if (word.empty() || result.ec != std::errc{} || !is_whole_word || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

/// Reads one document, tag after tag.
class Reader {
 public:
  Reader(std::string_view text, int samples, const std::string& name)
      : scanner_(text, name), samples_(samples), name_(name) {}

  OmeDocument read() {
    while (const std::optional<XmlTag> tag = scanner_.next()) {
      const std::string_view element = without_prefix(tag->name);
      if (tag->closes) {
        if (element == "Pixels") finish_pixels();
        if (element == "TiffData") run_ = nullptr;
        continue;
      }
      if (element == "OME") document_.uuid = attribute(*tag, "UUID");
      if (element == "BinaryOnly") document_.metadata_file = attribute(*tag, "MetadataFile");
      if (element.starts_with("ModuloAlong")) document_.divided_axis = element;
      if (element == "Image") image_name_ = attribute(*tag, "Name");
      if (element == "Pixels") start_pixels(*tag);
      if (image_ == nullptr) continue;
      if (element == "Channel") channels_.push_back(attribute(*tag, "Name"));
      if (element == "TiffData") start_run(*tag);
      if (element == "UUID" && run_ != nullptr) name_run(*tag);
      if (element == "Plane") add_position(*tag);
    }
    return std::move(document_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(name_ + ": its OME-XML " + what);
  }

  /// Returns a whole number of at least `least`, or the default where there is none.
  std::int64_t count(const XmlTag& tag, const char* key, std::int64_t least,
                     std::int64_t otherwise) const {
    const std::string word = attribute(tag, key);
    if (word.empty()) return otherwise;
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || value < least ||
        value > std::numeric_limits<int>::max()) {
      fail("says " + std::string(key) + "=\"" + printable(word) + "\" in line " +
           std::to_string(tag.line) + ", which cannot be; mend the description");
    }
    return value;
  }

  void start_pixels(const XmlTag& tag) {
    OmeTiffImage image;
    image.name = image_name_;
    image.columns = count(tag, "SizeX", 1, 0);
    image.rows = count(tag, "SizeY", 1, 0);
    image.type = attribute(tag, "Type");
    PageDescription& pages = image.pages;
    pages.writer = "OME-XML";
    std::string order = attribute(tag, "DimensionOrder");
    if (order.empty()) order = "XYZCT";
    std::string sorted = order;
    std::ranges::sort(sorted);
    if (sorted != "CTXYZ" || !order.starts_with("XY")) {
      fail("says DimensionOrder=\"" + printable(order) + "\", which is no order of axes");
    }
    for (const char letter : order.substr(2)) {
      const std::string key = std::string("Size") + letter;
      std::int64_t size = count(tag, key.c_str(), 1, 1);
      if (letter == 'C' && size > 1) {
        if (size % samples_ != 0) {
          fail("says " + std::to_string(size) + " channels (SizeC), but each pixel has " +
               std::to_string(samples_) + " values");
        }
        size /= samples_;
      }
      pages.axes.push_back({letter == 'Z' ? 'z' : letter == 'C' ? 'c' : 't', size});
    }
    read_sizes(tag, pages);
    document_.images.push_back(std::move(image));
    image_ = tag.closed ? nullptr : &document_.images.back();
    channels_.clear();
    positions_ = {};
    position_units_ = {};
  }

  void read_sizes(const XmlTag& tag, PageDescription& pages) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string key = std::string("PhysicalSize") + "XYZ"[axis];
      const auto value = number(tag, key);
      if (!value && attribute(tag, key).empty()) continue;
      if (!value || *value <= 0) {
        pages.notes.push_back("its OME-XML says " + key + "=\"" + printable(attribute(tag, key)) +
                              "\", which is no distance");
        continue;
      }
      const std::string unit = attribute(tag, key + "Unit");
      pages.spacing[axis] = {*value, unit.empty() ? "\u00b5m" : unit};
    }
    for (const auto& [from, to] : {std::pair<std::size_t, std::size_t>{0, 1}, {1, 0}}) {
      if (!pages.spacing[from] || pages.spacing[to]) continue;
      pages.spacing[to] = pages.spacing[from];
      pages.notes.push_back(std::string("its OME-XML has no PhysicalSize") + "XY"[to] +
                            "; it is taken to be PhysicalSize" + "XY"[from]);
    }
    pages.time_step = number(tag, "TimeIncrement");
    const std::string step = attribute(tag, "TimeIncrement");
    if (!pages.time_step && !step.empty()) {
      pages.notes.push_back("its OME-XML says TimeIncrement=\"" + printable(step) +
                            "\", which is no number; times are counted");
    }
  }

  void start_run(const XmlTag& tag) {
    PageRun run;
    const bool has_page = tag.attributes.contains("IFD");
    run.directory = count(tag, "IFD", 0, 0);
    run.z = count(tag, "FirstZ", 0, 0);
    run.c = count(tag, "FirstC", 0, 0);
    run.t = count(tag, "FirstT", 0, 0);
    if (tag.attributes.contains("PlaneCount")) {
      run.count = count(tag, "PlaneCount", 0, 0);
    } else if (has_page) {
      run.count = 1;
    }
    // Channels of several values each are counted by their values in some files.
    const std::int64_t channels = size_of(image_->pages, 'c');
    if (run.c >= channels && run.c % samples_ == 0) run.c /= samples_;
    image_->pages.runs.push_back(run);
    run_ = tag.closed ? nullptr : &image_->pages.runs.back();
  }

  void name_run(const XmlTag& tag) {
    const std::string uuid = xml_text(trimmed(tag.text, " \t\r\n"));
    const bool is_own = !uuid.empty() && uuid == document_.uuid;
    run_->file = is_own ? std::string() : attribute(tag, "FileName");
  }

  void add_position(const XmlTag& tag) {
    const auto z = number(tag, "TheZ");
    if (!z || attribute(tag, "TheC") > "0" || attribute(tag, "TheT") > "0") return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string key = std::string("Position") + "XYZ"[axis];
      const auto position = number(tag, key);
      if (!position) continue;
      positions_[axis][*z] = *position;
      position_units_[axis] = attribute(tag, key + "Unit");
    }
  }

  static std::int64_t size_of(const PageDescription& pages, char letter) {
    return std::ranges::find(pages.axes, letter, &PageAxis::letter)->count;
  }

  void finish_pixels() {
    run_ = nullptr;
    if (image_ == nullptr) return;
    PageDescription& pages = image_->pages;
    const bool has_names = std::ranges::any_of(channels_, [](const auto& n) { return !n.empty(); });
    if (has_names && std::ssize(channels_) == size_of(pages, 'c')) pages.channels = channels_;
    compare_positions(pages);
    image_ = nullptr;
  }

  /// Compares the distance of slices with the stage's positions, where they are even.
  void compare_positions(PageDescription& pages) const {
    compare_across(pages);
    const std::map<double, double>& along = positions_[2];
    if (along.size() < 2) return;
    const double first_z = along.begin()->first, first = along.begin()->second;
    const double last_z = along.rbegin()->first, last = along.rbegin()->second;
    const double step = (last - first) / (last_z - first_z);
    // A stage that stays where it is may have its lens moved.
    if (std::ranges::all_of(along, [&](const auto& at) { return at.second == first; })) return;
    for (const auto& [z, position] : along) {
      if (std::abs(first + step * (z - first_z) - position) <= 0.01 * std::abs(step)) continue;
      pages.notes.emplace_back(
          "its planes' PositionZ are not even; the slices are taken to be even");
      return;
    }
    if (step < 0) {
      pages.notes.emplace_back("its planes' PositionZ go down with z; z goes up with the planes");
    }
    const std::string& unit = position_units_[2];
    const std::optional<double> metres = metres_of(unit);
    auto& said = pages.spacing[2];
    if (!said && metres) {
      said = {std::abs(step), unit};
      pages.notes.emplace_back("its OME-XML has no PhysicalSizeZ; the planes' PositionZ say it");
    } else if (!said) {
      pages.notes.push_back("its planes' PositionZ are " + readable_number(std::abs(step)) +
                            " apart, in no unit of length; they are not applied");
    } else if (const auto size = size_in_unit_of(said, metres);
               size && std::abs(std::abs(step) / *size - 1) > 0.01) {
      pages.notes.push_back("its planes' PositionZ are " + readable_number(std::abs(step)) +
                            (metres ? " " + printable(unit) : std::string(" (without a unit)")) +
                            " apart, another distance than PhysicalSizeZ, which is taken");
    }
  }

  /// Returns a size in the unit of positions, or, where theirs is not known, as it is written.
  static std::optional<double> size_in_unit_of(const std::optional<SaidLength>& size,
                                               const std::optional<double>& metres) {
    if (!metres) return size->value;
    const auto own = metres_of(size->unit);
    return own ? std::optional(size->value * *own / *metres) : std::nullopt;
  }

  /// Tells of slices that the stage moved aside by more than a pixel.
  void compare_across(PageDescription& pages) const {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto& said = pages.spacing[axis];
      if (!said || positions_[axis].size() < 2) continue;
      const auto size = size_in_unit_of(said, metres_of(position_units_[axis]));
      const auto by_position = [](const auto& a, const auto& b) { return a.second < b.second; };
      const auto [least, most] = std::ranges::minmax_element(positions_[axis], by_position);
      if (!size || most->second - least->second <= *size) continue;
      pages.notes.push_back(std::string("its planes' Position") + "XY"[axis] + " differ by " +
                            readable_number((most->second - least->second) / *size) +
                            " pixels; the slices are taken to lie one behind the other");
    }
  }

  XmlScanner scanner_;
  int samples_;
  const std::string& name_;
  OmeDocument document_;
  std::string image_name_;
  OmeTiffImage* image_ = nullptr;  ///< whose Pixels are being read
  PageRun* run_ = nullptr;         ///< whose TiffData is being read
  std::vector<std::string> channels_;
  std::array<std::map<double, double>, 3> positions_;  ///< along x, y, z, by the number of z
  std::array<std::string, 3> position_units_;
};

}  // namespace

bool is_ome_xml(std::string_view description) {
  for (const std::string_view start : {"<OME", ":OME"}) {
    const std::size_t at = description.find(start);
    if (at == std::string_view::npos) continue;
    const std::string_view rest = description.substr(at + start.size());
    if (!rest.empty() &&
        std::string_view(" \t\r\n>").find(rest.front()) != std::string_view::npos) {
      return true;
    }
  }
  return false;
}

OmeDocument read_ome_xml(std::string_view text, int samples, const std::string& name) {
  return Reader(text, samples, name).read();
}

}  // namespace pellucid
