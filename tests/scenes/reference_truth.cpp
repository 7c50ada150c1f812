// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/reference_truth.h"

#include <bit>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "tests/scenes/scene_hash.h"

namespace pellucid::scenes {
namespace {

// The file: `magic`, then for each frame its scene's hash, width, height and pixels, all numbers of
// 8 bytes, then a checksum of all before.
static_assert(std::endian::native == std::endian::little, "the file is little endian");
constexpr char magic[] = "PellucidTruth";

std::string head() {
  return std::string(magic) + " " + std::to_string(reference_version) + "\n";
}

std::uint64_t checksum(const char* bytes, std::size_t count) {
  std::uint64_t state = 0xcbf29ce484222325u;
  for (std::size_t i = 0; i < count; ++i) {
    state = (state ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3u;
  }
  return state;
}

template <class Number>
void append(std::string& bytes, Number number) {
  static_assert(sizeof number == 8);
  char raw[8];
  std::memcpy(raw, &number, 8);
  bytes.append(raw, 8);
}

/// What is left of the file.
class Reader {
 public:
  Reader(const char* next, const char* end) : next_(next), end_(end) {}
  bool at_end() const { return next_ == end_; }
  void read(void* out, std::uint64_t size) {
    if (static_cast<std::uint64_t>(end_ - next_) < size) throw std::runtime_error("it is cut off");
    std::memcpy(out, next_, size);
    next_ += size;
  }
  std::uint64_t number() {
    std::uint64_t value = 0;
    read(&value, sizeof value);
    return value;
  }

 private:
  const char *next_, *end_;
};

std::map<std::uint64_t, ReferenceFrame> parse(const std::string& bytes) {
  const std::string begin = head();
  if (bytes.compare(0, begin.size(), begin) != 0) {
    throw std::runtime_error("it was made by another version of the reference");
  }
  if (bytes.size() < begin.size() + 8) throw std::runtime_error("it is cut off");
  const std::size_t size = bytes.size() - 8;
  if (Reader(bytes.data() + size, bytes.data() + bytes.size()).number() !=
      checksum(bytes.data(), size)) {
    throw std::runtime_error("it is damaged");
  }
  std::map<std::uint64_t, ReferenceFrame> frames;
  Reader reader(bytes.data() + begin.size(), bytes.data() + size);
  while (!reader.at_end()) {
    const std::uint64_t hash = reader.number(), width = reader.number(), height = reader.number();
    if (width == 0 || width > 4096 || height == 0 || height > 4096) {
      throw std::runtime_error("it is damaged");
    }
    ReferenceFrame frame{static_cast<int>(width), static_cast<int>(height), {}};
    frame.pixels.resize(width * height);
    reader.read(frame.pixels.data(), frame.pixels.size() * sizeof(frame.pixels[0]));
    frames.emplace(hash, std::move(frame));
  }
  return frames;
}

}  // namespace

ReferenceTruth::ReferenceTruth(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(stream), {});
  try {
    if (!stream) throw std::runtime_error("it cannot be read");
    frames_ = parse(bytes);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file.string() + ": " + error.what() + "; scripts/truth makes it anew");
  }
}

void ReferenceTruth::add(const Scene& scene, ReferenceFrame frame) {
  frames_[scene_hash(scene)] = std::move(frame);
}

const ReferenceFrame* ReferenceTruth::find(const Scene& scene) const {
  const auto found = frames_.find(scene_hash(scene));
  if (found == frames_.end() || found->second.width != scene.size.width ||
      found->second.height != scene.size.height) {
    return nullptr;
  }
  return &found->second;
}

void ReferenceTruth::write(const std::filesystem::path& file) const {
  std::string bytes = head();
  for (const auto& [hash, frame] : frames_) {
    append(bytes, hash);
    append(bytes, static_cast<std::uint64_t>(frame.width));
    append(bytes, static_cast<std::uint64_t>(frame.height));
    for (const auto& pixel : frame.pixels) {
      for (const double channel : pixel) append(bytes, channel);
    }
  }
  append(bytes, checksum(bytes.data(), bytes.size()));
  std::ofstream stream(file, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) throw std::runtime_error(file.string() + ": it cannot be written");
}

std::filesystem::path truth_file() {
  return std::filesystem::path(PELLUCID_SOURCE_DIR) / "tests" / "scenes" / "truth.rgba64f";
}

std::size_t camera_in_turn(const std::string& scene, std::size_t cameras) {
  return checksum(scene.data(), scene.size()) % cameras;
}

}  // namespace pellucid::scenes
