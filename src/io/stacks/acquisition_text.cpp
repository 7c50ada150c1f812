// SPDX-License-Identifier: Apache-2.0
//
// ScanImage: https://docs.scanimage.org/Appendix/ScanImage+BigTiff+Specification.html. LSM: the
// record CZ_LSMINFO, as tifffile and Bio-Formats know it. Micro-Manager: the tag 51123 of each page
// has SliceIndex, ChannelIndex and FrameIndex, NDTiff's an object "Axes".

#include "acquisition_text.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include "pellucid/scene/error.h"
#include "text/json_file.h"
#include "text/printable.h"
#include "text/text.h"

namespace pellucid {

using scene_json::Node;

namespace {

/// Returns the value of the first line whose key ends with one of these.
std::string_view setting(std::string_view text, std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys) {
    for (std::size_t at = text.find(key); at != std::string_view::npos;
         at = text.find(key, at + 1)) {
      const std::string_view rest = trimmed(text.substr(at + key.size(), 200), " \t");
      if (!rest.starts_with('=')) continue;
      return trimmed(rest.substr(1, std::min(rest.find_first_of("\r\n"), rest.size()) - 1), " \t");
    }
  }
  return {};
}

double number_in(std::string_view word, double otherwise) {
  double value = 0;
  const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
  return result.ec == std::errc{} && std::isfinite(value) ? value : otherwise;
}

std::int64_t count_in(std::string_view word) {
  const double value = number_in(word, 1);
  return value >= 1 && value <= 1e9 ? static_cast<std::int64_t>(value) : 1;
}

/// Returns how many numbers stand in "[1;2]" or "1".
std::int64_t numbers_in(std::string_view list) {
  std::int64_t count = 0;
  bool inside = false;
  for (const char c : list) {
    const bool is_digit = c >= '0' && c <= '9';
    count += is_digit && !inside ? 1 : 0;
    inside = is_digit;
  }
  return std::max<std::int64_t>(count, 1);
}

bool is_true(std::string_view word) {
  return word.starts_with("true") || word.starts_with('1');
}

/// Place of a page, in the words of its writer.
struct PagePlace {
  std::int64_t z = 0, t = 0;
  std::string channel;  ///< name or number
  std::string others;
};

std::string text_of(const Node& value) {
  return value.is_string() ? printable(value.string()) : value.value().dump();
}

std::int64_t index_of(const Node& object, std::initializer_list<const char*> keys) {
  constexpr long long most = 1LL << 30;
  for (const char* key : keys) {
    if (const auto value = object.find(key)) return value->integer(-most, most);
  }
  return 0;
}

std::optional<PagePlace> place_of(const Node& root) {
  PagePlace place;
  const auto axes = root.find("Axes");
  if (axes && axes->is_object()) {
    for (const auto& [key, value] : axes->value().items()) {
      const Node node = axes->at(key, "");
      if (key == "z") {
        place.z = index_of(*axes, {"z"});
      } else if (key == "time") {
        place.t = index_of(*axes, {"time"});
      } else if (key == "channel") {
        place.channel = text_of(node);
      } else {
        place.others += key + " " + text_of(node) + " ";
      }
    }
    return place;
  }
  if (!root.has("SliceIndex") && !root.has("ChannelIndex") && !root.has("FrameIndex")) {
    return std::nullopt;
  }
  place.z = index_of(root, {"SliceIndex", "Slice"});
  place.t = index_of(root, {"FrameIndex", "Frame"});
  place.channel = std::to_string(index_of(root, {"ChannelIndex"}));
  const std::int64_t position = index_of(root, {"PositionIndex"});
  if (position != 0) place.others = "position " + std::to_string(position);
  return place;
}

std::int64_t rank_of(const std::vector<std::int64_t>& sorted, std::int64_t key) {
  return std::ranges::lower_bound(sorted, key) - sorted.begin();
}

void make_distinct(std::vector<std::int64_t>& keys) {
  std::ranges::sort(keys);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

void read_page_distances(const Node& root, PageDescription& said) {
  const auto length = [&](const char* key) -> std::optional<SaidLength> {
    const auto value = root.find(key);
    if (!value || !value->is_number() || !(value->value().get<double>() > 0)) return std::nullopt;
    return SaidLength{value->value().get<double>(), "\u00b5m"};
  };
  for (const char* key : {"PixelSizeUm", "PixelSize_um"}) {
    if (!said.spacing[0]) said.spacing[0] = said.spacing[1] = length(key);
  }
  for (const char* key : {"z-step_um", "ZStepUm"}) {
    if (!said.spacing[2]) said.spacing[2] = length(key);
  }
}

}  // namespace

bool is_scanimage_text(std::string_view text) {
  return text.find("SI.hChannels.") != std::string_view::npos ||
         text.find("scanimage.SI") != std::string_view::npos ||
         text.find("state.acq.numberOfChannelsSave") != std::string_view::npos;
}

PageDescription read_scanimage_text(std::string_view text, const std::string& name) {
  PageDescription said;
  said.writer = "ScanImage";
  const std::string_view listed = setting(text, {"hChannels.channelSave", "channelsSave"});
  const std::int64_t channels =
      listed.empty() ? count_in(setting(text, {"acq.numberOfChannelsSave"})) : numbers_in(listed);
  const bool is_old = text.find("state.acq.") != std::string_view::npos;
  const bool is_stack = is_old || is_true(setting(text, {"hStackManager.enable"})) ||
                        is_true(setting(text, {"hFastZ.enable"}));
  std::int64_t slices = 1, frames = 1;
  if (is_stack) {
    slices = count_in(setting(text, {"hFastZ.numFramesPerVolume", "hStackManager.actualNumSlices",
                                     "hStackManager.numSlices", "acq.numberOfZSlices"}));
    frames = count_in(setting(text, {"hStackManager.framesPerSlice", "acq.numberOfFrames"}));
    const std::int64_t averaged =
        count_in(setting(text, {"hScan2D.logAverageFactor", "acq.numAvgFramesSave"}));
    frames = is_old && is_true(setting(text, {"acq.averaging"})) ? 1
             : averaged > 1 && frames % averaged == 0            ? frames / averaged
                                                                 : frames;
  }
  said.axes.push_back({'c', channels});
  if (frames > 1) {
    said.axes.push_back({'t', frames});
    said.axes.push_back({'z', slices > 1 ? slices : 0});
    if (slices == 1) said.axes = {{'c', channels}, {'t', 0}};
  } else {
    said.axes.push_back({'z', slices});
    said.axes.push_back({'t', 0});
  }
  if (const auto step = setting(text, {"hStackManager.actualStackZStepSize",
                                       "hStackManager.stackZStepSize", "acq.zStepSize"});
      !step.empty() && number_in(step, 0) != 0) {
    said.spacing[2] = {std::abs(number_in(step, 1)), "\u00b5m"};
  }
  if (channels > 1000000) throw Error(name + ": ScanImage's settings have too many channels");
  return said;
}

std::optional<PageDescription> read_lsm_record(std::span<const std::byte> record, int samples) {
  constexpr std::size_t needed = 90, dimensions = 8, voxel = 40, scan_type = 88;
  if (record.size() < needed) return std::nullopt;
  const auto number = [&](std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = size; i-- > 0;) {
      value = value << 8 | std::to_integer<std::uint64_t>(record[at + i]);
    }
    return value;
  };
  const auto side = [&](std::size_t i) {
    const std::uint64_t value = number(dimensions + 4 * i, 4);
    return value < 1 || value > 0x7fffffff ? std::int64_t{1} : static_cast<std::int64_t>(value);
  };
  PageDescription said;
  said.writer = "LSM";
  if (side(3) > 1 && side(3) != samples) said.axes.push_back({'c', side(3)});
  said.axes.push_back({'z', side(2)});
  said.axes.push_back({'t', side(4)});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double metres = std::bit_cast<double>(number(voxel + 8 * axis, 8));
    if (metres > 0 && metres < 1) said.spacing[axis] = {metres * 1e6, "\u00b5m"};
  }
  if (const auto type = number(scan_type, 2); type != 0) {
    said.notes.push_back("its record (LSM) says a scan of type " + std::to_string(type) +
                         ", which is no stack of x, y and z; pages are taken as such");
  }
  return said;
}

std::optional<PageDescription> read_page_metadata(const std::vector<std::string>& pages,
                                                  const std::string& name) {
  std::vector<PagePlace> places;
  PageDescription said;
  said.writer = "Micro-Manager";
  for (const std::string& text : pages) {
    if (text.empty()) return std::nullopt;
    JsonFile file;
    try {
      file = parse_data_json(text, name);
    } catch (const Error&) {
      return std::nullopt;  // the words of another program
    }
    const Node root = file.root();
    if (!root.is_object()) return std::nullopt;
    auto place = place_of(root);
    if (!place) return std::nullopt;
    places.push_back(*std::move(place));
    if (places.front().others != places.back().others) {
      throw Error(name + ": its pages are of several positions (" +
                  printable(places.front().others) + ", " + printable(places.back().others) +
                  "); save one of them as a file of its own");
    }
    read_page_distances(root, said);
  }
  std::vector<std::int64_t> slices, times;
  std::vector<std::string> channels;  // in the order of the pages
  for (const PagePlace& place : places) {
    slices.push_back(place.z);
    times.push_back(place.t);
    if (std::ranges::find(channels, place.channel) == channels.end()) {
      channels.push_back(place.channel);
    }
  }
  make_distinct(slices);
  make_distinct(times);
  said.axes = {{'z', std::ssize(slices)}, {'c', std::ssize(channels)}, {'t', std::ssize(times)}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    PageRun run;
    run.directory = static_cast<std::int64_t>(i);
    run.count = 1;
    run.z = rank_of(slices, places[i].z);
    run.c = std::ranges::find(channels, places[i].channel) - channels.begin();
    run.t = rank_of(times, places[i].t);
    said.runs.push_back(run);
  }
  const bool are_names = std::ranges::none_of(channels, [](const std::string& channel) {
    return channel.empty() || channel.find_first_not_of("0123456789") == std::string::npos;
  });
  if (are_names) said.channels = channels;
  return said;
}

}  // namespace pellucid
