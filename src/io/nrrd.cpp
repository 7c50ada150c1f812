// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "input_file.h"
#include "itk_header.h"
#include "medical_volumes.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

struct Header {
  std::vector<std::string> lines;  // up to the empty line, which is not among them
  bool attached = false;           // there was an empty line: data may follow
};

Header read_header(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  Header header;
  std::string line;
  std::size_t read = 0;
  // A header of more is not NRRD, whatever it begins with.
  constexpr std::size_t largest = std::size_t{1} << 20;
  while (std::getline(file, line)) {
    read += line.size() + 1;
    if (read > largest) throw Error(path.string() + ": the NRRD header does not end");
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) {
      header.attached = true;
      break;
    }
    header.lines.push_back(std::move(line));
  }
  return header;
}

// The value of "field: value", empty where the line is another.
std::string value_of(const std::string& line, std::string_view field) {
  if (!line.starts_with(field) || line.compare(field.size(), 2, ": ") != 0) return {};
  return line.substr(field.size() + 2);
}

const std::string* find_field(const Header& header, std::string_view field) {
  for (const std::string& line : header.lines) {
    if (!value_of(line, field).empty()) return &line;
  }
  return nullptr;
}

// Two kinds of file break the letter of the format and are common all the same: "space directions"
// without a space or before it, and "spacings" beside a space. NrrdIO refuses both. This is the
// header as it was meant, detached, or nothing where there is nothing to mend.
std::vector<std::string> mended_header(const Header& header, const fs::path& path) {
  const bool directions = find_field(header, "space directions") != nullptr;
  const bool space =
      find_field(header, "space") != nullptr || find_field(header, "space dimension") != nullptr;
  const bool spacings = find_field(header, "spacings") != nullptr;
  if (!(directions && !space) && !(spacings && space && !directions)) return {};

  const fs::path folder = fs::absolute(path).parent_path();
  std::vector<std::string> mended;
  bool detached = false;
  for (const std::string& line : header.lines) {
    std::string file = value_of(line, "data file");
    if (file.empty()) file = value_of(line, "datafile");
    if (file.starts_with("LIST")) return {};
    if (!file.empty()) {
      detached = true;
      mended.push_back("data file: " + (folder / file).string());
    } else if (directions || value_of(line, "space").empty()) {
      if (directions && !value_of(line, "space directions").empty()) {
        mended.emplace_back("space dimension: 3");
      }
      mended.push_back(line);
    }
  }
  if (!detached) {
    mended.push_back("line skip: " + std::to_string(header.lines.size() + 1));
    mended.push_back("data file: " + fs::absolute(path).string());
  }
  return mended;
}

/// A folder that goes with all that is in it.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& name) {
    std::string pattern = (fs::temp_directory_path() / "pellucid-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) {
      throw Error(name + ": cannot make a temporary folder " + pattern + " for a mended header");
    }
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const fs::path& path() const noexcept { return path_; }

 private:
  fs::path path_;
};

void check_sides(const Header& header, const std::string& name) {
  const std::string* line = find_field(header, "sizes");
  if (line == nullptr) return;
  // ITK 5.2 cuts sizes down to 32 bits.
  std::size_t digits = 0;
  for (const char c : *line) {
    digits = c >= '0' && c <= '9' ? digits + 1 : 0;
    if (digits > 9)
      throw Error(name + ": the NRRD header says \"" + *line + "\", too large to read");
  }
}

// A range of each axis instead of a spacing; ITK would take 1 for it.
void check_spacing(const Header& header, const ReadOptions& options, const std::string& name) {
  if (options.spacing || find_field(header, "axis maxs") == nullptr ||
      find_field(header, "spacings") != nullptr ||
      find_field(header, "space directions") != nullptr) {
    return;
  }
  throw Error(name +
              ": the NRRD header gives the range of the axes instead of a spacing; give the "
              "spacing and the origin");
}

bool is_left_anterior_superior(const Header& header) {
  const std::string* line = find_field(header, "space");
  if (line == nullptr) return false;
  std::string space = value_of(*line, "space");
  std::ranges::transform(space, space.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return space == "las" || space == "left-anterior-superior";
}

}  // namespace

Volume read_nrrd(const fs::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  check_input_file(path);
  const Header header = read_header(path);
  check_sides(header, name);
  check_spacing(header, options, name);
  const bool las = is_left_anterior_superior(header);
  const std::vector<std::string> mended = mended_header(header, path);
  if (mended.empty()) return read_nrrd_file(path, name, las, options);

  const TemporaryFolder folder(name);
  const fs::path mended_path = folder.path() / "mended.nhdr";
  std::ofstream stream(mended_path, std::ios::binary);
  for (const std::string& line : mended) stream << line << '\n';
  stream.close();
  if (!stream) throw Error(name + ": cannot write a temporary header for it");
  return read_nrrd_file(mended_path, name, las, options);
}

}  // namespace pellucid
