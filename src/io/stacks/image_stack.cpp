// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "acquisition_text.h"
#include "axes/time_steps.h"
#include "files/input_file.h"
#include "files/numbered_files.h"
#include "image_pages.h"
#include "meshes/mesh_blocks.h"
#include "name_series.h"
#include "ome_xml.h"
#include "page_marks.h"
#include "page_placement.h"
#include "page_values.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/scene/error.h"
#include "text/json_file.h"
#include "text/printable.h"
#include "text/text.h"
#include "volumes/components.h"
#include "volumes/volume_format.h"

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
/// Returns whether a path is OME-XML beside the files of pages that it describes
/// (".companion.ome").
bool is_companion(const fs::path& path) {
  return in_small_letters(path.filename().string()).ends_with(".companion.ome");
}

/// Returns whether a path is a pattern of numbered images ("slice%03d.tif") and no file.
bool is_stack_pattern(const fs::path& path) {
  std::error_code error;
  const std::string name = path.filename().string();
  std::size_t conversions = 0;
  name_pattern(name, &conversions);
  return is_image(name) && conversions > 0 && !fs::exists(path, error);
}

/// Returns whether a name is that of an image which is not hidden: hidden files are of no stack.
bool is_shown_image(const std::string& name) {
  return is_image(name) && !name.starts_with('.');
}

[[noreturn]] void refuse_odd(const std::string& name, const std::string& which,
                             const PageFormat& odd, const PageFormat& first) {
  throw Error(name + ": " + which + " is " + page_text(odd) + ", but the first is " +
              page_text(first) + "; all must be alike");
}

/// Description of a stack before its values are read.
struct Stack {
  PageVolume volume;
  PageDescription said;
};

/// Opens the files of a stack one after the other.
class Finder {
 public:
  Finder(const fs::path& path, const ReadOptions& options)
      : path_(path), name_(path.string()), options_(options) {}

  Stack find() {
    if (fs::is_directory(path_)) {
      of_folder();
    } else if (is_stack_pattern(path_)) {
      of_pattern();
    } else if (is_companion(path_)) {
      of_companion();
    } else {
      of_file(path_);
    }
    for (std::string& text : marks_.notes()) stack_.said.notes.push_back(std::move(text));
    return std::move(stack_);
  }

 private:
  void note(const std::string& text) const {
    if (options_.note) options_.note(name_ + ": " + text);
  }

  static std::string longest_of(const std::vector<NameSeries>& series) {
    return std::ranges::max_element(series, {},
                                    [](const NameSeries& one) { return one.files.size(); })
        ->pattern;
  }

  void of_pattern() {
    std::size_t conversions = 0;
    const auto pattern = name_pattern(path_.filename().string(), &conversions);
    if (!pattern) {
      throw Error(name_ + ": has " + std::to_string(conversions) +
                  " numbers that vary; write digits in the place of all but that of the slices");
    }
    std::vector<NumberedFile> numbered;
    for (const fs::path& file : files_in(path_.parent_path(), is_image)) {
      if (const auto number = pattern->number(file.filename().string())) {
        numbered.push_back({*number, file});
      }
    }
    if (numbered.empty()) throw Error(name_ + ": no file has a name of this pattern");
    if (numbered.size() == 1) return of_alone(numbered.front().file);
    of_numbered(numbered);
  }

  void of_folder() {
    std::size_t others = 0;
    const std::vector<fs::path> files = files_in(path_, is_shown_image, &others);
    if (files.empty()) {
      throw Error(name_ +
                  ": is a folder with no DICOM file and no .tif, .tiff or .png in it; folders "
                  "within are not looked into");
    }
    if (files.size() == 1) {
      of_alone(files.front());
    } else if (!is_set_of_files(files)) {
      const std::vector<NameSeries> series = name_series(files);
      if (series.size() > 1) {
        throw Error(name_ + ": holds " + std::to_string(series.size()) +
                    " series of images, whose names differ by more than a number: " +
                    printable(series_text(series)) + "; give the pattern of one, as in " +
                    (path_ / longest_of(series)).string());
      }
      of_numbered(series.front().files);
    }
    const auto is_no_slice = [](const std::string& name) {
      return name.starts_with('.') || is_companion(name);
    };
    const std::size_t expected = files_in(path_, is_no_slice).size();
    if (others > expected) {
      others -= expected;
      note(std::to_string(others) + (others == 1 ? " file is" : " files are") +
           " no image and left out");
    }
  }

  /// Takes OME-XML in a file of its own: opens the first file that it names, which must name it.
  void of_companion() {
    constexpr std::size_t largest = std::size_t{1} << 28;
    const OmeDocument document = read_ome_xml(read_text_file(path_, largest), 1, name_);
    std::string first;
    for (const OmeTiffImage& image : document.images) {
      for (const PageRun& run : image.pages.runs) {
        if (first.empty()) first = run.file;
      }
    }
    if (first.empty()) {
      throw Error(name_ + ": its OME-XML names no file of pages (TiffData, UUID FileName)");
    }
    const fs::path file = path_inside(path_.parent_path(), first, name_);
    std::error_code error;
    if (!fs::exists(file, error)) {
      throw Error(name_ + ": its OME-XML says that pages are in " + printable(first) +
                  ", which is not beside it; put it there");
    }
    of_file(file);
    if (stack_.said.writer != "OME-XML") {
      throw Error(name_ + ": its OME-XML names " + printable(first) +
                  ", which has no OME-XML that says whose its pages are; give the images instead");
    }
  }

  void of_file(const fs::path& file) {
    open_first(file);
    if (stack_.volume.files.front().directories.size() > 1 || names_other_files()) {
      return describe();
    }
    if (share_first_page()) return describe();
    // A single image is one of those that are numbered like it.
    std::vector<fs::path> files = files_in(file.parent_path(), is_shown_image);
    const auto same_name = [&](const fs::path& f) { return f.filename() == file.filename(); };
    if (std::ranges::none_of(files, same_name)) files.push_back(file);
    const std::vector<NameSeries> series = name_series_of(file, files);
    if (series.size() > 1) {
      throw Error(name_ + ": may be of " + std::to_string(series.size()) +
                  " series of images, for more than one number of its name varies: " +
                  printable(series_text(series)) + "; give the pattern of one, as in " +
                  (file.parent_path() / longest_of(series)).string());
    }
    if (series.front().files.size() > 1) return of_numbered(series.front().files);
    describe();
  }

  /// Takes a file that has no others beside it.
  void of_alone(const fs::path& file) {
    open_first(file);
    if (stack_.volume.files.front().directories.size() == 1 && !names_other_files()) {
      share_first_page();
    }
    describe();
  }

  /// Opens the file that describes the stack, and counts its pages.
  void open_first(const fs::path& file) {
    stack_ = {};
    const std::unique_ptr<PageReader> reader = open_pages(file);
    stack_.volume.format = reader->format();
    stack_.said = reader->describe(options_);
    stack_.volume.calibration = stack_.said.calibration;
    marks_ = PageMarks(marks_of(*reader, stack_.said));
    stack_.volume.files = {count_pages(file, *reader)};
  }

  /// Returns the marks of a page beside its values, and the distances of its description.
  static std::vector<PageMark> marks_of(const PageReader& reader, const PageDescription& said) {
    std::vector<PageMark> marks = reader.marks();
    if (!said.writer.empty()) marks.push_back(distances_mark(said));
    return marks;
  }

  FilePages count_pages(const fs::path& file, PageReader& reader) {
    FilePages pages{file, {reader.directory()}};
    std::vector<std::string> metadata{reader.metadata()};
    while (reader.next()) {
      if (pages.directories.size() == std::numeric_limits<int>::max()) {
        throw Error(file.string() + ": has too many pages");
      }
      pages.directories.push_back(reader.directory());
      if (!metadata.front().empty()) metadata.push_back(reader.metadata());
      const PageFormat format = reader.format();
      if (format != stack_.volume.format) {
        refuse_odd(file.string(), "page " + std::to_string(pages.directories.size()), format,
                   stack_.volume.format);
      }
      marks_.compare(reader.marks(), "page " + std::to_string(pages.directories.size()));
    }
    if (!metadata.front().empty() && stack_.said.writer.empty()) {
      if (auto said = read_page_metadata(metadata, file.string())) {
        for (PageRun& run : said->runs) {
          run.directory = pages.directories[static_cast<std::size_t>(run.directory)];
        }
        said->notes = std::move(stack_.said.notes);
        if (!said->spacing[0]) {
          said->spacing[0] = stack_.said.spacing[0];
          said->spacing[1] = stack_.said.spacing[1];
        }
        stack_.said = *std::move(said);
      }
    }
    return pages;
  }

  /// Returns the names of files that a description has beside that of the file itself.
  std::set<std::string> named_files() const {
    std::set<std::string> names;
    const fs::path& own = stack_.volume.files.front().file;
    bool is_each_named = true;
    for (const PageRun& run : stack_.said.runs) {
      if (!run.file.empty()) names.insert(run.file);
      is_each_named = is_each_named && !run.file.empty();
    }
    // A file that alone is named is this one, whatever its name is now.
    std::error_code error;
    if (names.size() == 1 && is_each_named &&
        !fs::exists(own.parent_path() / *names.begin(), error)) {
      return {};
    }
    names.erase(own.filename().string());
    return names;
  }
  bool names_other_files() const { return !named_files().empty(); }

  /// Returns whether the first of the files describes all of them as its own.
  bool is_set_of_files(const std::vector<fs::path>& files) {
    if (!is_tiff(files.front().filename().string())) return false;
    const std::unique_ptr<PageReader> reader = open_pages(files.front());
    stack_.said = reader->describe(ReadOptions{});
    stack_.volume.files = {{files.front(), {0}}};
    std::set<std::string> names = named_files();
    if (names.empty()) return false;
    names.insert(files.front().filename().string());
    for (const fs::path& file : files) {
      if (!names.contains(file.filename().string())) return false;
    }
    open_first(files.front());
    describe();
    return true;
  }

  /// Takes the planes of a description to lie behind the first page where they may; whether so.
  bool share_first_page() {
    const std::int64_t planes = plane_count(stack_.said.axes);
    if (!stack_.said.may_share_one_page || planes < 2) return false;
    if (planes > std::numeric_limits<int>::max()) {
      throw Error(name_ + ": its description says too many planes; mend it");
    }
    const FilePages& only = stack_.volume.files.front();
    const std::unique_ptr<PageReader> reader = open_pages(only.file);
    try {
      reader->share_first_page(planes);
    } catch (const Error&) {
      return false;  // what is missing is told where the pages are laid out
    }
    stack_.volume.shared_planes = planes;
    std::vector<std::int64_t>& directories = stack_.volume.files.front().directories;
    directories.clear();
    for (std::int64_t plane = 0; plane < planes; ++plane) directories.push_back(plane);
    return true;
  }

  /// Lays out the pages of the first file, and of those that it names, as it says.
  void describe() {
    PageVolume& volume = stack_.volume;
    if (stack_.said.axes.empty()) {
      volume.layout = layout_of_slices(volume.files);
      return;
    }
    const fs::path folder = volume.files.front().file.parent_path();
    std::map<std::string, std::size_t> places;
    for (const std::string& other : named_files()) {
      places[other] = volume.files.size();
      const fs::path file = path_inside(folder, other, name_);
      std::error_code error;
      if (!fs::exists(file, error)) {
        throw Error(name_ + ": its description (" + stack_.said.writer +
                    ") says that some of its planes are in " + printable(other) +
                    ", which is not beside it; put it there");
      }
      const std::unique_ptr<PageReader> reader = open_pages(file);
      if (reader->format() != volume.format) {
        refuse_odd(name_, file.filename().string(), reader->format(), volume.format);
      }
      marks_.compare(reader->marks(), file.filename().string());
      volume.files.push_back(count_pages(file, *reader));
    }
    volume.layout = layout_of_pages(
        stack_.said, volume.files,
        [&](const PageRun& run) {
          const auto place = places.find(run.file);
          return place == places.end() ? std::size_t{0} : place->second;
        },
        options_.note, name_);
  }

  /// Takes files of one page each.
  void of_numbered(const std::vector<NumberedFile>& numbered) {
    const std::vector<fs::path> files = in_order(numbered, name_);
    open_first(files.front());
    PageVolume& volume = stack_.volume;
    PageDescription& said = stack_.said;
    if (plane_count(said.axes) > 1 || names_other_files()) {
      said.notes.push_back("its files describe several pages each (" + said.writer +
                           "), but have one; they are slices in the order of their numbers");
    }
    said.axes.clear();
    said.runs.clear();
    for (const fs::path& file : files) {
      const std::string which = file.filename().string();
      const std::unique_ptr<PageReader> reader = open_pages(file);
      const PageFormat format = reader->format();
      if (format != volume.format) refuse_odd(name_, which, format, volume.format);
      const PageDescription own = reader->describe(options_);
      if (own.calibration != said.calibration) {
        throw Error(
            name_ + ": the values of " + which +
            " have another calibration (ImageJ: c0, c1; PNG: pCAL) than those of the first; give "
            "all the same");
      }
      if (reader->next()) {
        throw Error(name_ + ": " + which +
                    " has several pages, and there are several files; give one of them alone");
      }
      std::vector<PageMark> marks = marks_of(*reader, own);
      // Descriptions of files differ in much; their distances are a mark.
      std::erase_if(marks, [](const PageMark& mark) { return mark.key == "ImageDescription"; });
      marks_.compare(marks, which);
      if (file != files.front()) volume.files.push_back({file, {0}});
    }
    volume.files.front().directories.resize(1);
    volume.layout = layout_of_slices(volume.files);
  }

  const fs::path& path_;
  const std::string name_;
  const ReadOptions& options_;
  Stack stack_;
  PageMarks marks_;
};

/// Keeps the step in time that is nearest to what the options say, or tells which there are.
/// Returns the times.
std::vector<double> choose_time(Stack& stack, const ReadOptions& options, const std::string& name) {
  PageLayout& layout = stack.volume.layout;
  if (options.time && layout.times < 2) {
    throw Error(name + ": has no steps in time; leave the time out");
  }
  if (layout.times < 2) return {};
  const double step = stack.said.time_step.value_or(1);
  std::vector<double> times =
      even_times(static_cast<std::size_t>(layout.times), 0, step > 0 ? step : 1);
  refuse_movie(times.size(), layout.slices, options, name);
  if (!options.time) {
    if (options.note) options.note(name + ": holds " + times_note(times));
    return times;
  }
  const std::size_t nearest = nearest_step(times, options.time);
  if (options.note) options.note(name + ": " + step_note(times, nearest, *options.time));
  const auto chosen = static_cast<std::ptrdiff_t>(nearest);
  const auto planes = std::ssize(layout.planes) / layout.times;
  const auto begin = layout.planes.begin() + chosen * planes;
  layout.planes = std::vector<PlanePage>(begin, begin + planes);
  layout.times = 1;
  return times;
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

PageDescription PageReader::describe(const ReadOptions&) const {
  return {};
}

void PageReader::share_first_page(std::int64_t) {
  throw Error("the format has one page for each plane");
}

namespace {

/// Opens a stack of images (.tif, .tiff, .png): a file of several pages; numbered files, by any of
/// them, by a pattern or by the folder that holds them and no other images. All are of one size and
/// type, and their numbers go up in equal steps. Samples are components. Distances are those of the
/// file where it states a unit, else 1.
VolumeFile open_stack(const fs::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  Stack stack = Finder(path, options).find();
  const PageDescription& said = stack.said;
  if (options.axes && !said.obeys_axes) {
    throw Error(name +
                ": its description says which axes its pages have, or has none; leave the "
                "axes out");
  }
  if (options.series && !said.obeys_series) {
    throw Error(name +
                ": is no DICOM and has no OME-XML, and only of those a series may be chosen");
  }
  std::vector<double> times = choose_time(stack, options, name);
  const PageFormat& format = stack.volume.format;
  const PageLayout& layout = stack.volume.layout;
  const std::size_t points = value_count({format.columns, format.rows, layout.slices}, name);
  VolumeFile file;
  file.times = std::move(times);
  file.description.name = name;
  file.description.dimensions = {format.columns, format.rows, static_cast<int>(layout.slices)};
  place_pages(said, options, file.description);
  if (layout.components() > std::numeric_limits<int>::max() / format.samples) {
    throw Error(name + ": has too many components");
  }
  file.components = static_cast<int>(layout.components()) * format.samples;
  value_count(points, file.components, name);
  file.holds = holds_of(layout, said, format.samples);
  if (layout.components() == 1 && (format.samples == 3 || format.samples == 4)) {
    file.largest_color = format.type == "u8" ? 255 : format.type == "u16" ? 65535 : 0;
  }
  if (layout.components() > 1 && options.note) {
    options.note(name + ": holds " + file.holds + ", which are its components" +
                 (layout.times > 1 && !said.time_step ? "; times are counted from 0" : ""));
  }
  if (layout.components() == layout.channels && format.samples == 1) {
    file.component_names = said.channels;
  }
  file.read = [volume = std::move(stack.volume), name](ComponentRange range) {
    return read_page_values(volume, range, name);
  };
  return file;
}

}  // namespace

extern const VolumeFormat stack_format{.name = "stack of images",
                                       .extensions = ".tif .tiff .png .companion.ome",
                                       .takes_path = is_stack_pattern,
                                       .takes_other_folders = true,
                                       .open = open_stack,
                                       .takes_axes = true,
                                       .has_times = true,
                                       .has_series = true};

}  // namespace pellucid
