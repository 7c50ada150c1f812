// SPDX-License-Identifier: Apache-2.0
#include "page_layout.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <unordered_map>
#include <unordered_set>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

using Note = std::function<void(const std::string&)>;

std::string pages_text(std::int64_t pages) {
  return std::to_string(pages) + (pages == 1 ? " page" : " pages");
}

/// Returns "6 slices of 2 channels".
std::string axes_text(const std::vector<PageAxis>& axes) {
  std::string text;
  for (const PageAxis& axis : axes) {
    if (axis.count == 1) continue;
    text += (text.empty() ? "" : " of ") + std::to_string(axis.count) +
            (axis.letter == 'z'   ? " slices"
             : axis.letter == 'c' ? " channels"
             : axis.letter == 't' ? " times"
                                  : " others");
  }
  return text.empty() ? "one page" : text;
}

class Layout {
 public:
  Layout(const PageDescription& said, const std::vector<FilePages>& files, const std::string& name)
      : said_(said), axes_(said.axes), files_(files), name_(name) {
    for (const FilePages& file : files) pages_ += std::ssize(file.directories);
    complete_axes();
    // Products of what comes are then no larger than numbers can be.
    constexpr std::int64_t max_planes = std::int64_t{1} << 40;
    if (plane_count(axes_) > max_planes) {
      fail("but the file has " + pages_text(pages_) + "; mend the description");
    }
    layout_.slices = size_of('z');
    layout_.channels = size_of('c');
    layout_.others = size_of('o');
    layout_.times = size_of('t');
  }

  PageLayout make(const std::function<std::size_t(const PageRun&)>& file_number, const Note& note) {
    if (said_.runs.empty()) {
      place_all();
    } else {
      for (const PageRun& run : said_.runs) place(run, file_number(run));
    }
    if (note && pages_ > std::ssize(found_) && !said_.is_one_of_several) {
      const std::int64_t left_out = pages_ - std::ssize(found_);
      note(name_ + ": " + pages_text(left_out) + " of the file " +
           (left_out == 1 ? "stands" : "stand") + " for no plane of its description (" +
           said_.writer + ") and " + (left_out == 1 ? "is" : "are") + " left out");
    }
    keep_whole_times(note);
    list_planes();
    return std::move(layout_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(name_ + ": its description (" + said_.writer + ") says " + axes_text(axes_) + ", " +
                what);
  }

  /// Puts a count in the place of "the rest".
  void complete_axes() {
    if (axes_.empty()) axes_.push_back({'z', pages_});
    std::int64_t known = 1;
    for (const PageAxis& axis : axes_) {
      if (axis.count > 0 && known <= pages_) known *= axis.count;
    }
    for (PageAxis& axis : axes_) {
      if (axis.count > 0) continue;
      if (known > pages_ || pages_ % known != 0) {
        axis.count = 1;
        fail("but the file has " + pages_text(pages_) +
             "; it is not whole, or changed by another program");
      }
      axis.count = pages_ / known;
    }
  }

  std::int64_t size_of(char letter) const {
    const auto axis = std::ranges::find(axes_, letter, &PageAxis::letter);
    return axis == axes_.end() ? 1 : axis->count;
  }

  /// Returns the place of a plane among all, slices first, then channels, others and times.
  std::int64_t place_of(std::int64_t step) const {
    std::int64_t z = 0, c = 0, o = 0, t = 0;
    for (const PageAxis& axis : axes_) {
      (axis.letter == 'z'   ? z
       : axis.letter == 'c' ? c
       : axis.letter == 't' ? t
                            : o) = step % axis.count;
      step /= axis.count;
    }
    return ((t * layout_.others + o) * layout_.channels + c) * layout_.slices + z;
  }

  void place_all() {
    const std::int64_t planes = plane_count(axes_);
    if (planes != pages_) {
      fail("but the file has " + pages_text(pages_) +
           (planes > pages_ ? "; it is cut off, or changed by another program"
                            : "; save the pages that are meant as a file of their own"));
    }
    std::int64_t step = 0;
    for (std::size_t file = 0; file < files_.size(); ++file) {
      for (std::size_t page = 0; page < files_[file].directories.size(); ++page) {
        put(step++, file, page);
      }
    }
  }

  void place(const PageRun& run, std::size_t file) {
    const std::vector<std::int64_t>& directories = files_[file].directories;
    const auto first = std::ranges::lower_bound(directories, run.directory);
    const auto page = first - directories.begin();
    const std::int64_t left = std::ssize(directories) - page;
    const std::string which = files_[file].file.filename().string();
    if (run.count == 0) return;
    if (first == directories.end() || *first != run.directory || run.count.value_or(1) > left) {
      fail("and names page " + std::to_string(run.directory + run.count.value_or(1) - 1) +
           " (from 0) of " + which + ", which has " + pages_text(std::ssize(directories)) +
           "; it is cut off, or changed by another program");
    }
    std::int64_t begin = 0, factor = 1;
    for (const PageAxis& axis : axes_) {
      const std::int64_t at = axis.letter == 'z'   ? run.z
                              : axis.letter == 'c' ? run.c
                              : axis.letter == 't' ? run.t
                                                   : 0;
      if (at >= axis.count) {
        fail("but the planes that it names go on to " + std::string(1, axis.letter) + " = " +
             std::to_string(at) + "; mend the description");
      }
      begin += at * factor;
      factor *= axis.count;
    }
    const std::int64_t planes = plane_count(axes_);
    if (!run.count && left > planes - begin) {
      fail("but the file has " + pages_text(left) +
           "; save the pages that are meant as a file of their own");
    }
    for (std::int64_t i = 0; i < run.count.value_or(left); ++i) {
      if (begin + i >= planes) fail("but names more planes than that; mend the description");
      put(begin + i, file, static_cast<std::size_t>(page + i));
    }
  }

  void put(std::int64_t step, std::size_t file, std::size_t page) {
    const PlanePage place{static_cast<std::uint32_t>(file), static_cast<std::uint32_t>(page)};
    const bool is_first_use = used_.insert(std::uint64_t{place.file} << 32 | place.page).second;
    if (found_.emplace(place_of(step), place).second && is_first_use) return;
    fail(std::string(is_first_use ? "and two pages for one plane, the second being page "
                                  : "and two planes for one page, page ") +
         std::to_string(files_[file].directories[page]) + " (from 0) of " +
         files_[file].file.filename().string() + "; mend the description");
  }

  void keep_whole_times(const Note& note) {
    const std::int64_t all = plane_count(axes_);
    if (std::ssize(found_) == all) return;
    const std::int64_t of_time = all / layout_.times;
    std::unordered_map<std::int64_t, std::int64_t> planes;
    for (const auto& [place, page] : found_) ++planes[place / of_time];
    std::int64_t whole = 0;
    while (whole < layout_.times && planes[whole] == of_time) ++whole;
    const bool has_gap = std::ranges::any_of(
        planes, [&](const auto& time) { return time.first > whole && time.second == of_time; });
    if (whole == 0 || has_gap) {
      fail("but only " + std::to_string(found_.size()) + " of " + std::to_string(all) +
           " planes are in the file" + (files_.size() > 1 ? "s" : "") +
           "; some are missing, save it again");
    }
    if (note) {
      note(name_ + ": its description says " + std::to_string(layout_.times) + " times, of which " +
           std::to_string(whole) + (whole == 1 ? " is" : " are") +
           " whole; the others are left out");
    }
    layout_.times = whole;
  }

  void list_planes() {
    const std::int64_t count = layout_.slices * layout_.components();
    layout_.planes.reserve(static_cast<std::size_t>(count));
    for (std::int64_t place = 0; place < count; ++place) {
      layout_.planes.push_back(found_.at(place));
    }
  }

  const PageDescription& said_;
  std::vector<PageAxis> axes_;
  const std::vector<FilePages>& files_;
  const std::string& name_;
  std::int64_t pages_ = 0;
  PageLayout layout_;
  std::unordered_map<std::int64_t, PlanePage> found_;
  std::unordered_set<std::uint64_t> used_;  ///< pages
};

}  // namespace

std::string aspect_note(const std::string& source, double x, double y) {
  std::array<char, 32> ratio{};
  std::snprintf(ratio.data(), ratio.size(), "%.4g", x / y);
  return source + " makes pixels " + ratio.data() +
         " times as high as wide, which is not taken into account; give the spacing";
}

std::int64_t plane_count(const std::vector<PageAxis>& axes) {
  std::int64_t count = 1;
  for (const PageAxis& axis : axes) {
    if (axis.count > 0 && count > std::numeric_limits<std::int64_t>::max() / axis.count) {
      return std::numeric_limits<std::int64_t>::max();
    }
    count *= axis.count;
  }
  return count;
}

PageLayout layout_of_slices(const std::vector<FilePages>& files) {
  PageLayout layout;
  for (std::size_t file = 0; file < files.size(); ++file) {
    for (std::size_t page = 0; page < files[file].directories.size(); ++page) {
      layout.planes.push_back({static_cast<std::uint32_t>(file), static_cast<std::uint32_t>(page)});
    }
  }
  layout.slices = std::ssize(layout.planes);
  return layout;
}

PageLayout layout_of_pages(const PageDescription& said, const std::vector<FilePages>& files,
                           const std::function<std::size_t(const PageRun&)>& file_number,
                           const std::function<void(const std::string&)>& note,
                           const std::string& name) {
  return Layout(said, files, name).make(file_number, note);
}

}  // namespace pellucid
