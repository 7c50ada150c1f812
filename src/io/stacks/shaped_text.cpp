// SPDX-License-Identifier: Apache-2.0
//
// tifffile writes {"shape": [2, 6, 5, 4], "axes": "CZYX", "spacing": 3.0, "unit": "um"}, older ones
// shape=(2,6,5,4): https://github.com/cgohlke/tifffile, series of the kind "shaped". vigra and
// ilastik write {"axes": [{"key": "z"}, …]}. Pages hold the last axes.

#include "shaped_text.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "axes/array_axes.h"
#include "pellucid/scene/error.h"
#include "text/json_file.h"
#include "text/printable.h"
#include "text/text.h"

namespace pellucid {

using scene_json::Node;

namespace {

constexpr std::size_t max_axes = 32;

using Shape = std::vector<std::int64_t>;

Shape shape_in(const Node& list) {
  Shape shape;
  if (list.array_size() > max_axes) list.fail("has more than 32 axes");
  for (std::size_t i = 0; i < list.array_size(); ++i) {
    shape.push_back(list.element(i).integer(1, std::numeric_limits<int>::max()));
  }
  return shape;
}

/// Returns a letter for each axis, from a text or from axistags.
std::string letters_in(const Node& axes) {
  if (axes.is_string()) return in_small_letters(axes.string());
  std::string letters;
  if (!axes.is_array() || axes.array_size() > max_axes) return letters;
  for (std::size_t i = 0; i < axes.array_size(); ++i) {
    const Node axis = axes.element(i);
    const auto key = axis.is_object() ? axis.find("key") : axis;
    letters += key && key->is_string() && key->string().size() == 1
                   ? in_small_letters(key->string())
                   : std::string("?");
  }
  return letters;
}

/// Returns the number of the last axes that are a page's; nothing if they are not.
std::optional<std::size_t> axes_of_page(const Shape& shape, const DescribedPage& page) {
  const Shape choices[] = {{page.rows, page.columns, page.samples},
                           {page.samples, page.rows, page.columns},
                           {page.rows, page.columns}};
  for (const Shape& last : choices) {
    // Those of one sample may leave its axis out.
    if (last.size() == 2 && page.samples > 1) continue;
    if (last.size() == 3 && page.samples == 1) continue;
    if (shape.size() < last.size()) continue;
    if (std::equal(last.begin(), last.end(), shape.end() - std::ssize(last))) return last.size();
  }
  return std::nullopt;
}

[[noreturn]] void fail(const std::string& name, const Shape& shape, const std::string& what) {
  throw Error(name + ": its description says an array of shape (" + shape_text(shape) + "), " +
              what);
}

char axis_of(char letter) {
  return letter == 'z' ? 'z' : letter == 'c' || letter == 's' ? 'c' : letter == 't' ? 't' : 'o';
}

/// The axes before those of a page, without those of length 1, the slowest first.
struct Leading {
  std::vector<PageAxis> axes;
  std::string letters;  ///< as the file or the options say; '?' where nobody does
};

void name_axes(Leading& leading, PageDescription& said, const Shape& shape,
               const std::string& name) {
  const std::string& letters = leading.letters;
  if (letters.find('?') != std::string::npos) {
    if (leading.axes.size() == 2) {
      // The shorter one is that of components, as in NumPy's arrays; ImageJ's order if none is.
      const std::size_t c = leading.axes[1].count < leading.axes[0].count ? 1 : 0;
      leading.axes[c].letter = 'c';
      leading.axes[1 - c].letter = 'z';
      said.notes.push_back("an array of shape (" + shape_text(shape) +
                           ") whose axes have no names is taken as " + (c == 0 ? "czyx" : "zcyx") +
                           "; --array-axes says otherwise");
      return;
    }
    if (leading.axes.size() > 2) {
      fail(name, shape, "and not what its axes are; name them (\"axes\") or save a part of it");
    }
  }
  std::size_t others = 0;
  for (std::size_t i = 0; i < leading.axes.size(); ++i) {
    if (letters[i] == 'x' || letters[i] == 'y') {
      fail(name, shape,
           "whose pages go along " + std::string(1, letters[i]) +
               "; save it with the axes in the order z, y, x");
    }
    leading.axes[i].letter = axis_of(letters[i]);
    others += leading.axes[i].letter == 'o' ? 1 : 0;
  }
  const bool has_z = std::ranges::count(leading.axes, 'z', &PageAxis::letter) > 0;
  for (std::size_t i = 0; i < leading.axes.size(); ++i) {
    if (leading.axes[i].letter != 'o' || has_z || others > 1) continue;
    leading.axes[i].letter = 'z';
    if (letters[i] != '?') {
      said.notes.push_back("its pages go along an axis \"" + printable(letters.substr(i, 1)) +
                           "\"; they are taken as slices");
    }
  }
  for (const PageAxis& axis : leading.axes) {
    if (std::ranges::count(leading.axes, axis.letter, &PageAxis::letter) > 1) {
      fail(name, shape,
           "with several axes that are neither z, channels nor times (" + printable(letters) +
               "); save a part of it");
    }
  }
}

void read_distances(const Node& root, const DescribedPage& page, PageDescription& said) {
  const auto text = [&](const std::string& key) {
    const auto found = root.find(key);
    return found && found->is_string() ? printable(found->string()) : std::string();
  };
  const auto number = [&](const std::string& key) -> std::optional<double> {
    const auto found = root.find(key);
    if (!found || !found->is_number()) return std::nullopt;
    const double value = found->value().get<double>();
    return value > 0 && value < scene_json::largest_number ? std::optional(value) : std::nullopt;
  };
  const std::string unit = text("unit");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string key = std::string("PhysicalSize") + "XYZ"[axis];
    const std::string own = text(key + "Unit");
    if (const auto value = number(key)) said.spacing[axis] = {*value, own.empty() ? "µm" : own};
  }
  if (const auto z = number("spacing"); z && !said.spacing[2]) said.spacing[2] = {*z, unit};
  for (std::size_t axis = 0; axis < 2 && !unit.empty(); ++axis) {
    if (said.spacing[axis] || page.resolution[axis] <= 0) continue;
    said.spacing[axis] = {1 / page.resolution[axis], unit};
  }
  said.time_step = number("finterval");
}

/// Returns "shape=(6,5,4)" as JSON.
std::string as_json(std::string_view text) {
  if (!text.starts_with("shape=(")) return std::string(text);
  std::string list(text.substr(
      7, text.find(')') == std::string_view::npos ? std::string_view::npos : text.find(')') - 7));
  list = std::string(trimmed(list, " ,"));
  return "{\"shape\": [" + list + "]}";
}

}  // namespace

bool is_shaped_text(std::string_view text) {
  const std::string_view begin = trimmed(text, " \t\r\n");
  return begin.starts_with("shape=(") ||
         (begin.starts_with('{') && (begin.find("\"shape\"") != std::string_view::npos ||
                                     begin.find("\"axes\"") != std::string_view::npos));
}

std::optional<PageDescription> read_shaped_text(std::string_view text, const DescribedPage& page,
                                                const std::optional<std::string>& letters,
                                                const std::string& name) {
  const JsonFile file = parse_data_json(as_json(trimmed(text, " \t\r\n")), name + ": description");
  const Node root = file.root();
  if (!root.is_object()) return std::nullopt;
  const auto list = root.find("shape");
  const auto axes = root.find("axes");
  if ((!list || !list->is_array()) && !axes) return std::nullopt;
  PageDescription said;
  said.writer = list ? "tifffile" : "axistags";
  read_distances(root, page, said);
  std::string named = axes ? letters_in(*axes) : std::string();
  Leading leading;
  Shape shape;
  if (list) {
    shape = shape_in(*list);
    const auto last = axes_of_page(shape, page);
    if (!last) {
      fail(name, shape,
           "whose last axes are not those of its pages, " + std::to_string(page.rows) +
               " rows of " + std::to_string(page.columns) + " columns; save it again");
    }
    const auto truncated = root.find("truncated");
    said.may_share_one_page = truncated && truncated->is_true();
    if (named.size() != shape.size()) named.assign(shape.size(), '?');
    for (std::size_t i = 0; i + *last < shape.size(); ++i) {
      if (shape[i] == 1) continue;
      leading.axes.push_back({'o', shape[i]});
      leading.letters += named[i];
    }
    const std::string of_page = named.substr(shape.size() - *last);
    if (of_page.find('?') == std::string::npos &&
        of_page.find_first_of("zt") != std::string::npos && !letters) {
      fail(name, shape,
           "whose axes (" + printable(named) +
               ") do not end with y and x; save it with the axes in the order z, y, x");
    }
  } else {
    // Tags of axes without a shape: the page's own are the last two, or have their samples behind.
    std::string rest = named;
    std::erase_if(rest, [](char c) { return c == 'x' || c == 'y' || c == 's'; });
    if (page.samples > 1) std::erase(rest, 'c');
    if (rest.size() != 1) {
      throw Error(name + ": its description names the axes " + printable(named) +
                  ", but not how long they are; save it with a shape, or a part of it");
    }
    leading.axes.push_back({'o', 0});
    leading.letters = rest;
  }
  if (letters) {
    std::string given = checked_axes(*letters);
    if (!given.ends_with("yx") || given.size() != leading.axes.size() + 2) {
      throw Error(name + ": the axes given, " + given + ", are not those of its pages; " +
                  (leading.axes.size() == 2 ? "give czyx or zcyx" : "leave them out"));
    }
    leading.letters = given.substr(0, given.size() - 2);
    said.obeys_axes = true;
  }
  name_axes(leading, said, shape, name);
  said.axes.assign(leading.axes.rbegin(), leading.axes.rend());
  return said;
}

}  // namespace pellucid
