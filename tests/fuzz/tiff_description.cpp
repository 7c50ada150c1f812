// SPDX-License-Identifier: Apache-2.0

// What TIFF files say of their pages: any text gives a layout of the pages that are there, or an
// Error of one line. The first byte says whose text it is and how many pages there are.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

#include "pellucid/scene/error.h"
#include "src/io/stacks/acquisition_text.h"
#include "src/io/stacks/imagej_text.h"
#include "src/io/stacks/name_series.h"
#include "src/io/stacks/ome_xml.h"
#include "src/io/stacks/page_layout.h"
#include "src/io/stacks/shaped_text.h"

namespace {

using namespace pellucid;

void require(bool condition) {
  if (!condition) std::abort();
}

void lay_out(const PageDescription& said, std::int64_t pages) {
  std::vector<FilePages> files{{"fuzz.tif", {}}};
  for (std::int64_t page = 0; page < pages; ++page) files.front().directories.push_back(page);
  const PageLayout layout = layout_of_pages(
      said, files, [](const PageRun&) { return std::size_t{0}; }, {}, "fuzz");
  require(layout.slices > 0 && layout.components() > 0 &&
          std::ssize(layout.planes) == layout.slices * layout.components() &&
          std::ssize(layout.planes) <= pages);
  for (const PlanePage& plane : layout.planes) require(plane.file == 0 && plane.page < pages);
}

void sort_names(std::string_view text) {
  std::vector<std::filesystem::path> files;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string name(text.substr(0, end));
    std::erase_if(name, [](char c) { return c == '/' || c == '\0'; });
    if (!name.empty() &&
        std::find(files.begin(), files.end(), std::filesystem::path(name)) == files.end())
      files.emplace_back(name);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  std::size_t count = 0;
  for (const NameSeries& series : name_series(files)) count += series.files.size();
  require(count == files.size());
  for (const auto& file : files) require(!name_series_of(file, files).empty());
  for (const NameSeries& series : name_series(files))
    static_cast<void>(in_order(series.files, "fuzz"));
}

void read(std::uint8_t kind, std::string_view text, const std::string& whole) {
  const DescribedPage page{5, 4, kind % 3 == 0 ? 3 : 1, "u16", {2, 2}};
  const std::int64_t pages = kind / 16 + 1;
  switch (kind % 8) {
    case 0:
      for (const OmeTiffImage& image : read_ome_xml(text, page.samples, "fuzz").images) {
        lay_out(image.pages, pages);
      }
      return;
    case 1:
      return lay_out(read_imagej_text(text, page, "fuzz"), pages);
    case 2:
      if (const auto said = read_shaped_text(text, page, {}, "fuzz")) lay_out(*said, pages);
      return;
    case 3:
      if (const auto said = read_shaped_text(text, page, "zcyx", "fuzz")) lay_out(*said, pages);
      return;
    case 4:
      return lay_out(read_scanimage_text(text, "fuzz"), pages);
    case 5:
      if (const auto said = read_lsm_record(std::as_bytes(std::span(whole)), page.samples)) {
        lay_out(*said, pages);
      }
      return;
    case 6: {
      std::vector<std::string> texts(static_cast<std::size_t>(pages));
      for (std::size_t i = 0; i < texts.size(); ++i) {
        texts[i] = text;
        std::ranges::replace(texts[i], '#', static_cast<char>('0' + i % 10));
      }
      if (const auto said = read_page_metadata(texts, "fuzz")) lay_out(*said, pages);
      return;
    }
    default:
      sort_names(text);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    read(data[0], text.c_str(), text);
  } catch (const Error& error) {
    const std::string_view message = error.what();
    require(message.starts_with("fuzz") && message.size() < 2000);
    for (const char c : message) require(static_cast<unsigned char>(c) >= 0x20);
  }
  return 0;
}
