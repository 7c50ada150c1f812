// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "page_description.h"

namespace pellucid {

/// The pages of a file by the numbers of their directories.
struct FilePages {
  std::filesystem::path file;
  std::vector<std::int64_t> directories;
};

/// The page that a plane is: its place in the list of files, and among the file's pages.
struct PlanePage {
  std::uint32_t file = 0;
  std::uint32_t page = 0;
};

/// Which page each plane of each component is.
struct PageLayout {
  std::int64_t slices = 1, channels = 1, others = 1, times = 1;
  std::vector<PlanePage> planes;  ///< slice by slice; channels, others and times follow

  std::int64_t components() const { return channels * others * times; }
};

/// Lays out pages that are slices one after the other, file by file.
PageLayout layout_of_slices(const std::vector<FilePages>& files);

/// Lays out pages as a description says. `file_number` returns the place of a run's file in the
/// list. Times at the end that lack planes are left out, and `note` is told. Throws Error that
/// begins with `name` where pages are missing, too many, or meant twice.
PageLayout layout_of_pages(const PageDescription& said, const std::vector<FilePages>& files,
                           const std::function<std::size_t(const PageRun&)>& file_number,
                           const std::function<void(const std::string&)>& note,
                           const std::string& name);

}  // namespace pellucid
