// SPDX-License-Identifier: Apache-2.0
#include "image_stack.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "image_pages.h"
#include "input_file.h"
#include "memory_limit.h"
#include "numbered_files.h"
#include "pellucid/scene/error.h"
#include "text.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

bool is_tiff(const std::string& name) {
  const std::string small = in_small_letters(name);
  return small.ends_with(".tif") || small.ends_with(".tiff");
}
bool is_image(const std::string& name) {
  return is_tiff(name) || in_small_letters(name).ends_with(".png");
}

// Those whose names differ from that of the first by a number alone, and the first.
std::vector<fs::path> same_around_the_number(const std::vector<fs::path>& files,
                                             const fs::path& first) {
  const std::optional<NumberedName> name = numbered_name(first.filename().string());
  std::vector<fs::path> same;
  for (const fs::path& file : files) {
    const std::optional<NumberedName> other = numbered_name(file.filename().string());
    if (file.filename() == first.filename() ||
        (name && other && other->before == name->before && other->behind == name->behind)) {
      same.push_back(file);
    }
  }
  return same;
}

std::vector<fs::path> files_of_folder(const fs::path& folder, const ReadOptions& options) {
  const std::string name = folder.string();
  std::size_t others = 0;
  const std::vector<fs::path> files = files_in(folder, is_image, &others);
  if (files.empty()) {
    throw Error(name +
                ": is a folder with no DICOM file and no .tif, .tiff or .png in it; folders "
                "within are not looked into");
  }
  const std::vector<fs::path> same = same_around_the_number(files, files.front());
  for (const fs::path& file : files) {
    if (std::ranges::find(same, file) != same.end()) continue;
    throw Error(name + ": the names of " + files.front().filename().string() + " and " +
                file.filename().string() +
                " differ by more than a number; give one file of the stack that is meant");
  }
  if (others > 0 && options.note) {
    options.note(name + ": " + std::to_string(others) + (others == 1 ? " file is" : " files are") +
                 " no image and left out");
  }
  return same;
}

std::vector<fs::path> files_of_pattern(const fs::path& path) {
  const NamePattern pattern = *name_pattern(path.filename().string());
  std::vector<fs::path> files =
      files_in(path.parent_path(), [&](const std::string& name) { return pattern.matches(name); });
  if (files.empty()) throw Error(path.string() + ": no file has a name of this pattern");
  return files;
}

struct Stack {
  std::vector<fs::path> files;
  int pages = 0;  // of the one file; of several, how many they are
  PageFormat format;
  PageSpacing spacing;
};

[[noreturn]] void refuse_odd(const std::string& name, const std::string& which,
                             const PageFormat& odd, const PageFormat& first) {
  throw Error(name + ": " + which + " is " + page_text(odd) + ", but the first is " +
              page_text(first) + "; all must be alike");
}

int count_pages(PageReader& reader, const PageFormat& first, const std::string& name) {
  int pages = 1;
  while (reader.next()) {
    if (pages == std::numeric_limits<int>::max()) throw Error(name + ": has too many pages");
    ++pages;
    const PageFormat format = reader.format();
    if (format != first) refuse_odd(name, "page " + std::to_string(pages), format, first);
  }
  return pages;
}

std::vector<fs::path> files_of(const fs::path& path, const ReadOptions& options) {
  if (fs::is_directory(path)) return files_of_folder(path, options);
  if (is_stack_pattern(path)) return files_of_pattern(path);
  return {path};
}

Stack find_stack(const fs::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  Stack stack;
  stack.files = files_of(path, options);
  std::unique_ptr<PageReader> first = open_pages(stack.files.front());
  stack.format = first->format();
  stack.spacing = first->spacing();
  if (first->is_inverted() && options.note) {
    options.note(name + ": small values are meant to be bright; they are read as they are");
  }
  if (stack.files.size() == 1) {
    stack.pages = count_pages(*first, stack.format, stack.files.front().string());
    if (stack.pages > 1) return stack;
    // A single image is one of those that are numbered like it.
    const fs::path& file = stack.files.front();
    stack.files = same_around_the_number(files_in(file.parent_path(), is_image), file);
  }
  stack.files = in_order(stack.files, name);
  for (const fs::path& file : stack.files) {
    const std::unique_ptr<PageReader> pages = open_pages(file);
    const PageFormat format = pages->format();
    const std::string which = file.filename().string();
    if (format != stack.format) refuse_odd(name, which, format, stack.format);
    if (pages->next()) {
      throw Error(name + ": " + which +
                  " has several pages, and there are several files; give one of them alone");
    }
  }
  stack.pages = static_cast<int>(stack.files.size());
  return stack;
}

void place(const Stack& stack, const ReadOptions& options, Volume::Description& description) {
  const auto usable = [](double x) { return x > 0 && x < 1e30; };
  const PageSpacing& said = stack.spacing;
  Vec3<double>& spacing = description.placement.spacing;
  std::string told;
  if (said.pixels && usable((*said.pixels)[0]) && usable((*said.pixels)[1])) {
    spacing.x = (*said.pixels)[0];
    spacing.y = (*said.pixels)[1];
    told = "pixels";
  }
  if (said.slices && usable(*said.slices)) {
    spacing.z = *said.slices;
    told += told.empty() ? "slices" : " and slices";
  }
  if (options.spacing || !options.note) return;
  if (told.empty()) {
    options.note(description.name + ": images say nothing of distances; the spacing is 1");
  } else {
    options.note(description.name + ": the spacing of " + told + " is the file's, in " + said.unit +
                 (told == "pixels and slices" ? "" : "; the other is 1"));
  }
}

/// One component of a page of several.
void take_component(std::span<const std::byte> page, std::size_t samples, std::size_t component,
                    std::size_t value_bytes, std::span<std::byte> to) {
  const std::size_t count = to.size() / value_bytes;
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(&to[i * value_bytes], &page[(i * samples + component) * value_bytes], value_bytes);
  }
}

std::vector<VolumeData> read_stack(const Stack& stack, ComponentRange range,
                                   const std::string& name) {
  const PageFormat& format = stack.format;
  const std::size_t per_page =
      static_cast<std::size_t>(format.columns) * static_cast<std::size_t>(format.rows);
  const std::size_t points = per_page * static_cast<std::size_t>(stack.pages);
  const std::size_t size = value_size(format.type, name);
  const auto samples = static_cast<std::size_t>(format.samples);
  const auto number = static_cast<std::size_t>(range.number);
  check_memory(std::uintmax_t{points} * number * size + per_page * samples * size,
               name + ": its values");
  std::vector<VolumeData> list;
  list.reserve(number);
  for (std::size_t c = 0; c < number; ++c) list.push_back(make_values(format.type, points, name));
  std::vector<std::byte> page(samples > 1 ? per_page * samples * size : 0);
  std::unique_ptr<PageReader> reader;
  for (std::size_t k = 0; k < static_cast<std::size_t>(stack.pages); ++k) {
    const fs::path& file = stack.files[stack.files.size() == 1 ? 0 : k];
    const bool goes_on = reader && stack.files.size() == 1 && reader->next();
    if (!goes_on) reader = open_pages(file);
    if (reader->format() != format || (k > 0 && stack.files.size() == 1 && !goes_on)) {
      throw Error(file.string() + ": has changed while it was read; is it being written?");
    }
    const auto part = [&](std::size_t c) {
      return std::visit(
          [&](auto& values) {
            return std::as_writable_bytes(values.writable())
                .subspan(k * per_page * size, per_page * size);
          },
          list[c]);
    };
    reader->read(samples > 1 ? std::span(page) : part(0));
    for (std::size_t c = 0; samples > 1 && c < number; ++c) {
      take_component(page, samples, static_cast<std::size_t>(range.first) + c, size, part(c));
    }
  }
  return list;
}

}  // namespace

std::string page_text(const PageFormat& format) {
  return std::to_string(format.columns) + " x " + std::to_string(format.rows) + " of " +
         (format.samples > 1 ? std::to_string(format.samples) + " x " : "") + format.type;
}

std::unique_ptr<PageReader> open_pages(const fs::path& file) {
  check_input_file(file);
  return is_tiff(file.filename().string()) ? open_tiff(file) : open_png(file);
}

bool is_stack_pattern(const fs::path& path) {
  std::error_code error;
  const std::string name = path.filename().string();
  return is_image(name) && name_pattern(name).has_value() && !fs::exists(path, error);
}

VolumeFile open_stack(const fs::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  const Stack stack = find_stack(path, options);
  const PageFormat& format = stack.format;
  const std::size_t points = value_count({format.columns, format.rows, stack.pages}, name);
  value_count(points, format.samples, name);
  VolumeFile file;
  file.description.name = name;
  file.description.dimensions = {format.columns, format.rows, stack.pages};
  place(stack, options, file.description);
  apply_overrides(options, file.description);
  file.components = format.samples;
  file.holds = format.samples == 3   ? "colors (RGB)"
               : format.samples == 4 ? "colors (RGBA)"
                                     : std::to_string(format.samples) + " samples";
  file.read = [stack, name](ComponentRange range) { return read_stack(stack, range, name); };
  return file;
}

}  // namespace pellucid
