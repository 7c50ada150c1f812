// SPDX-License-Identifier: Apache-2.0
//
// MetaImage: lines "key = value" up to ElementDataFile, which says where the values are: LOCAL
// (behind that line), a file, a pattern ("slice%03d.raw 1 93 1") or LIST (a name per line).

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "data_stream.h"
#include "input_file.h"
#include "itk_header.h"
#include "medical_volumes.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

// The stream just behind the line of ElementDataFile.
std::ifstream open_behind_header(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  while (std::getline(file, line)) {
    if (line.starts_with("ElementDataFile")) return file;
  }
  throw Error(path.string() + ": the MetaImage header does not say where its values are");
}

std::vector<std::string> listed_files(const fs::path& path) {
  std::ifstream file = open_behind_header(path);
  std::vector<std::string> names;
  std::string line;
  while (std::getline(file, line)) {
    if (line = trimmed(line); !line.empty()) names.push_back(line);
  }
  return names;
}

// "name%03d.raw first last step", as printf has it; only one number, and only %d.
std::vector<std::string> files_of_pattern(const std::string& text, int slices,
                                          const std::string& name) {
  std::istringstream words(text);
  std::string pattern;
  long first = 1, last = slices, step = 1;
  words >> pattern >> first >> last >> step;
  const std::size_t percent = pattern.find('%');
  const std::size_t letter =
      percent == std::string::npos ? percent : pattern.find_first_not_of("0123456789", percent + 1);
  if (letter == std::string::npos || pattern[letter] != 'd' || letter - percent > 3 ||
      pattern.find('%', letter) != std::string::npos || step < 1 || first < 0 || last < first ||
      (last - first) / step >= slices) {
    throw Error(name + ": the pattern of files \"" + text + "\" is not understood");
  }
  const std::string width_text = pattern.substr(percent + 1, letter - percent - 1);
  const bool zeros = width_text.starts_with('0');
  const std::size_t width = width_text.empty() ? 0 : std::stoul(width_text);
  std::vector<std::string> names;
  for (long i = first; i <= last; i += step) {
    std::string number = std::to_string(i);
    if (number.size() < width) number.insert(0, width - number.size(), zeros ? '0' : ' ');
    names.push_back(pattern.substr(0, percent) + number + pattern.substr(letter + 1));
  }
  return names;
}

struct DataFile {
  fs::path path;
  std::uintmax_t offset = 0;
};

// The files that hold the values, in order, each the same share of them.
std::vector<DataFile> find_files(const fs::path& path, const MetaImageHeader& header,
                                 std::uintmax_t bytes) {
  const std::string name = path.string();
  const std::string where = trimmed(header.data_file);
  std::vector<DataFile> files;
  if (where == "LOCAL" || where == "Local" || where == "local") {
    const std::streamoff at = open_behind_header(path).tellg();
    files.push_back({path, static_cast<std::uintmax_t>(at)});
    return files;
  }
  std::vector<std::string> names{where};
  if (where == "LIST" || where.starts_with("LIST ")) {
    names = listed_files(path);
  } else if (where.find('%') != std::string::npos) {
    names = files_of_pattern(where, header.description.dimensions[2], name);
  }
  const std::size_t slices = static_cast<std::size_t>(header.description.dimensions[2]);
  if (names.empty() || slices % names.size() != 0) {
    throw Error(name + ": " + std::to_string(names.size()) + " files do not make " +
                std::to_string(slices) + " slices");
  }
  if (header.compressed && names.size() > 1) {
    throw Error(name + ": several compressed files are not read; save them as one");
  }
  for (const std::string& file : names) {
    DataFile part{path.parent_path() / file, 0};
    const std::uintmax_t size = check_input_file(part.path);
    const std::uintmax_t share = bytes / names.size();
    if (header.header_size > 0) part.offset = static_cast<std::uintmax_t>(header.header_size);
    // MetaIO: -1 means that the values are the file's last bytes.
    if (header.header_size == -1 && size > share) part.offset = size - share;
    files.push_back(part);
  }
  return files;
}

VolumeData read_compressed(const DataFile& file, const MetaImageHeader& header, std::size_t count) {
  // CompressedDataSize is often out of date; the compressed data knows where it ends.
  DataStream stream(file.path, file.offset, DataStream::Compression::deflate);
  VolumeData data = read_values(stream, {header.type, header.big_endian, file.offset}, count);
  stream.finish();
  return data;
}

// One file in place where that can be, several one behind the other.
VolumeData read_parts(const std::vector<DataFile>& files, const MetaImageHeader& header,
                      std::size_t count, const std::string& name) {
  const auto layout = [&](const DataFile& file) {
    return ValueLayout{header.type, header.big_endian, file.offset};
  };
  for (const DataFile& file : files) {
    check_size(file_source(file.path), layout(file), count / files.size());
  }
  if (files.size() == 1) return read_values(file_source(files[0].path), layout(files[0]), count);
  VolumeData data = make_values(header.type, count, name);
  std::visit(
      [&](auto& values) {
        std::span<std::byte> rest = std::as_writable_bytes(values.writable());
        const std::size_t share = rest.size() / files.size();
        for (const DataFile& file : files) {
          file_source(file.path).read(file.offset, rest.first(share));
          rest = rest.subspan(share);
        }
      },
      data);
  to_native_order(data, header.big_endian);
  return data;
}

}  // namespace

Volume read_meta_image(const fs::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  MetaImageHeader header = read_meta_image_header(path);
  if (header.text) {
    throw Error(name + ": values written as text are not read; save the MetaImage as binary");
  }
  std::size_t count = 1;
  for (const int side : header.description.dimensions) count *= static_cast<std::size_t>(side);
  const std::uintmax_t bytes = std::uintmax_t{count} * value_size(header.type, name);
  const std::vector<DataFile> files = find_files(path, header, bytes);
  VolumeData data = header.compressed ? read_compressed(files[0], header, count)
                                      : read_parts(files, header, count, name);
  apply_overrides(options, header.description);
  return Volume(std::move(header.description), std::move(data));
}

}  // namespace pellucid
