// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "acquisition_text.h"
#include "imagej_text.h"
#include "ome_xml.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/scene/error.h"
#include "shaped_text.h"
#include "text/json_file.h"
#include "text/printable.h"
#include "text/readable_number.h"
#include "text/text.h"
#include "tiff_tags.h"

namespace pellucid {

namespace {

constexpr std::uint32_t lsm_tag = 34412, metamorph_tag = 33629, scale_tag = 33550,
                        transform_tag = 34264, gdal_tag = 42112, no_data_tag = 42113;

/// Returns the image that the options choose, or the first. Throws Error.
OmeTiffImage chosen_image(OmeDocument& document, const ReadOptions& options,
                          const std::string& name) {
  std::vector<OmeTiffImage>& images = document.images;
  if (images.empty()) throw Error(name + ": its OME-XML describes no image (Pixels)");
  const auto list = [&] {
    std::string text;
    for (std::size_t i = 0; i < images.size() && i < 12; ++i) {
      text += (i == 0 ? "" : ", ") + std::to_string(i + 1) + ": " +
              (images[i].name.empty() ? "without a name" : images[i].name);
    }
    return printable(text) + (images.size() > 12 ? ", ..." : "");
  };
  std::size_t chosen = 0;
  std::string note;
  if (options.series) {
    const std::string& wanted = *options.series;
    const char* const end = wanted.data() + wanted.size();
    std::size_t number = 0;
    const auto [stop, error] = std::from_chars(wanted.data(), end, number);
    const bool is_number = error == std::errc{} && stop == end;
    std::size_t found = 0;
    for (std::size_t i = 0; i < images.size(); ++i) {
      if (images[i].name != wanted) continue;
      chosen = i;
      ++found;
    }
    if (found == 0 && is_number && number >= 1 && number <= images.size()) {
      chosen = number - 1;
      found = 1;
    }
    if (found != 1) {
      throw Error(name + ": " + (found == 0 ? "none" : "more than one") +
                  " of its images is meant by \"" + printable(wanted) + "\"; there are " + list());
    }
  } else if (images.size() > 1) {
    note = "describes " + std::to_string(images.size()) + " images (" + list() +
           "); the first is read, --series chooses another";
  }
  OmeTiffImage image = std::move(images[chosen]);
  image.pages.obeys_series = true;
  image.pages.is_one_of_several = images.size() > 1;
  if (!note.empty()) image.pages.notes.push_back(std::move(note));
  if (images.size() > 1 && image.pages.runs.empty()) {
    throw Error(name +
                ": its OME-XML has several images, but does not say which pages are whose "
                "(TiffData); save one of them as a file of its own");
  }
  return image;
}

/// Returns our name of a type of OME-XML; empty for others.
std::string type_of_ome(const std::string& type) {
  constexpr std::array<std::pair<std::string_view, const char*>, 8> names{{{"int8", "i8"},
                                                                           {"uint8", "u8"},
                                                                           {"int16", "i16"},
                                                                           {"uint16", "u16"},
                                                                           {"int32", "i32"},
                                                                           {"uint32", "u32"},
                                                                           {"float", "f32"},
                                                                           {"double", "f64"}}};
  const auto found =
      std::ranges::find(names, type, &std::pair<std::string_view, const char*>::first);
  return found == names.end() ? "" : found->second;
}

/// Reads the document of another file: XML, or a TIFF whose own planes it then names.
OmeDocument read_companion(const std::filesystem::path& file, const std::string& written_name,
                           int samples) {
  const std::string small = in_small_letters(written_name);
  if (!small.ends_with(".tif") && !small.ends_with(".tiff")) {
    constexpr std::size_t largest = std::size_t{1} << 28;
    return read_ome_xml(read_text_file(file, largest), samples, file.string());
  }
  const std::string text = tiff_description(file);
  if (!is_ome_xml(text)) {
    throw Error(file.string() + ": has no OME-XML, which another file says that it has");
  }
  OmeDocument document = read_ome_xml(text, samples, file.string());
  for (OmeTiffImage& image : document.images) {
    for (PageRun& run : image.pages.runs) {
      if (run.file.empty()) run.file = written_name;
    }
  }
  return document;
}

PageDescription read_ome(const std::string& text, const std::filesystem::path& file,
                         const DescribedPage& page, const ReadOptions& options) {
  const std::string name = file.string();
  OmeDocument document = read_ome_xml(text, page.samples, name);
  if (document.images.empty() && !document.metadata_file.empty()) {
    const auto other = path_inside(file.parent_path(), document.metadata_file, name);
    std::error_code error;
    if (!std::filesystem::exists(other, error)) {
      throw Error(name + ": its pages are described in " + printable(document.metadata_file) +
                  ", which is not beside it; put it there");
    }
    document = read_companion(other, document.metadata_file, page.samples);
  }
  OmeTiffImage image = chosen_image(document, options, name);
  if ((image.columns != 0 && image.columns != page.columns) ||
      (image.rows != 0 && image.rows != page.rows)) {
    image.pages.notes.push_back("its OME-XML says planes of " + std::to_string(image.columns) +
                                " x " + std::to_string(image.rows) + ", but its pages are " +
                                std::to_string(page.columns) + " x " + std::to_string(page.rows) +
                                "; it may be that of another file");
  }
  if (!document.divided_axis.empty()) {
    image.pages.notes.push_back("its OME-XML divides an axis further (" +
                                printable(document.divided_axis) +
                                "), which is not taken into account");
  }
  if (const std::string said = type_of_ome(image.type); !said.empty() && said != page.type) {
    image.pages.notes.push_back("its OME-XML says values of " + image.type +
                                ", but its pages have " + page.type + ", which are read");
  }
  return std::move(image.pages);
}

PageDescription read_text(TIFF* tiff, const std::filesystem::path& file, const DescribedPage& page,
                          const ReadOptions& options) {
  const std::string name = file.string();
  PageDescription nothing;
  const std::string text = tiff_text(tiff, TIFFTAG_IMAGEDESCRIPTION);
  if (is_ome_xml(text)) return read_ome(text, file, page, options);
  if (is_imagej_text(text)) return read_imagej_text(text, page, name);
  if (is_shaped_text(text)) {
    try {
      if (auto said = read_shaped_text(text, page, options.axes, name)) return *std::move(said);
    } catch (const Error& error) {
      // A text of braces that is no JSON is somebody's words, or cut off.
      if (!std::string_view(error.what()).starts_with(name + ": description: line ")) throw;
      nothing.notes.emplace_back(
          "its description begins like that of tifffile, but is no JSON (cut off?); it is not "
          "read");
    }
  }
  if (private_tiff_count(tiff, lsm_tag) > 0) {
    const std::string record = private_tiff_bytes(tiff, lsm_tag);
    if (auto said = read_lsm_record(std::as_bytes(std::span(record)), page.samples)) {
      return *std::move(said);
    }
  }
  for (const int tag : {TIFFTAG_SOFTWARE, TIFFTAG_ARTIST, TIFFTAG_IMAGEDESCRIPTION}) {
    const std::string settings = tiff_text(tiff, static_cast<std::uint32_t>(tag));
    if (is_scanimage_text(settings)) return read_scanimage_text(settings, name);
  }
  return nothing;
}

/// Returns the distances of pixels in millimetres, by pixels per unit; nothing where they are not
/// known. Programs that know no distance write those of screens.
std::optional<std::array<double, 2>> pixel_distances(std::uint16_t unit, double x, double y) {
  const bool has_both = x > 0 && y > 0 && std::isfinite(1 / x) && std::isfinite(1 / y);
  const bool is_screen = unit == RESUNIT_INCH && (x == 72 || x == 96) && y == x;
  const double millimetres = unit == RESUNIT_CENTIMETER ? 10 : unit == RESUNIT_INCH ? 25.4 : 0;
  if (millimetres == 0 || !has_both || is_screen) return std::nullopt;
  return std::array{millimetres / x, millimetres / y};
}

/// Takes the distances of pixels that the file states without words.
void read_resolution(TIFF* tiff, const DescribedPage& page, PageDescription& said) {
  if (said.spacing[0] || said.spacing[1] || said.writer == "ImageJ") return;
  const auto unit = tiff_field<std::uint16_t>(tiff, TIFFTAG_RESOLUTIONUNIT);
  const auto [x, y] = page.resolution;
  const bool has_both = x > 0 && y > 0 && std::isfinite(1 / x) && std::isfinite(1 / y);
  if (has_both && unit == RESUNIT_NONE && std::abs(x / y - 1) > 1e-3) {
    said.notes.push_back(aspect_note("its resolution without a unit", x, y));
  }
  if (const auto distances = pixel_distances(unit, x, y)) {
    said.spacing[0] = {(*distances)[0], "mm"};
    said.spacing[1] = {(*distances)[1], "mm"};
  }
}

/// Returns whether GDAL's metadata have a scale or an offset of the values.
bool has_gdal_scale(TIFF* tiff) {
  if (private_tiff_count(tiff, gdal_tag) == 0) return false;
  const std::string text = private_tiff_bytes(tiff, gdal_tag);
  return text.find("role=\"scale\"") != std::string::npos ||
         text.find("role=\"offset\"") != std::string::npos;
}
bool has_place_on_earth(TIFF* tiff) {
  return private_tiff_count(tiff, scale_tag) + private_tiff_count(tiff, transform_tag) > 0;
}
bool is_inverted(TIFF* tiff) {
  return tiff_field<std::uint16_t>(tiff, TIFFTAG_PHOTOMETRIC) == PHOTOMETRIC_MINISWHITE;
}

/// Tells of tags that could change the picture and are not taken into account.
void tell_tags(TIFF* tiff, PageDescription& said) {
  const auto tell = [&](const std::string& text) { said.notes.push_back(text); };
  const auto orientation = tiff_field<std::uint16_t>(tiff, TIFFTAG_ORIENTATION);
  if (orientation != ORIENTATION_TOPLEFT) {
    tell("its tag Orientation is " + std::to_string(orientation) +
         " (the first row is not the top, or the first column not the left); the first row is "
         "y = 0, the first column x = 0");
  }
  if (private_tiff_count(tiff, no_data_tag) > 0) {
    tell("its tag GDAL_NODATA says that " + printable(private_tiff_bytes(tiff, no_data_tag)) +
         " is no value; it is read as one");
  }
  if (is_inverted(tiff)) {
    tell(
        "small values are meant to be bright (PhotometricInterpretation); they are read as they "
        "are");
  }
  if (has_gdal_scale(tiff)) {
    tell(
        "its tag GDAL_METADATA has a scale or an offset of the values; they are read as they "
        "are stored");
  }
  if (has_place_on_earth(tiff)) {
    tell(
        "its place on earth (GeoTIFF: ModelPixelScale, ModelTransformation) is not read; give "
        "--spacing and --origin");
  }
  static constexpr std::pair<std::uint32_t, const char*> records[] = {
      {34361, "FluoView"}, {34362, "FluoView"}, {43314, "NIH Image"}, {65006, "Gatan"},
      {4864, "Andor"},     {34680, "FEI"},      {34682, "FEI"},       {51179, "Imaris"}};
  for (const auto& [tag, writer] : records) {
    if (!said.writer.empty() || private_tiff_count(tiff, tag) == 0) continue;
    tell(std::string("its description by ") + writer + " (tag " + std::to_string(tag) +
         ") is not read; its pages are taken as slices");
    break;
  }
}

/// Returns who describes a page, with ImageJ's distances; empty: nobody does.
std::string description_mark(TIFF* tiff) {
  const std::string text = tiff_text(tiff, TIFFTAG_IMAGEDESCRIPTION);
  if (is_ome_xml(text)) return "OME-XML";
  if (is_shaped_text(text)) return "tifffile";
  if (!is_imagej_text(text)) return {};
  std::string said = "ImageJ";
  for (const std::string_view key : {"\nspacing=", "\nunit=", "\nzunit="}) {
    const std::size_t at = text.find(key);
    if (at == std::string::npos) continue;
    said += ", " + text.substr(at + 1, std::min(text.find('\n', at + 1), text.size()) - at - 1);
  }
  return said;
}

}  // namespace

std::string tiff_text(TIFF* tiff, std::uint32_t tag) {
  const char* value = nullptr;
  return TIFFGetField(tiff, tag, &value) != 0 && value != nullptr ? value : "";
}

std::size_t private_tiff_count(TIFF* tiff, std::uint32_t tag) {
  const TIFFField* const field = TIFFFindField(tiff, tag, TIFF_ANY);
  std::uint32_t count = 0;
  const void* values = nullptr;
  const bool is_there = field != nullptr && TIFFFieldPassCount(field) != 0 &&
                        TIFFFieldReadCount(field) == TIFF_VARIABLE2 &&
                        TIFFGetField(tiff, tag, &count, &values) != 0 && values != nullptr;
  return is_there ? count : 0;
}

std::string private_tiff_bytes(TIFF* tiff, std::uint32_t tag) {
  const std::size_t size = private_tiff_count(tiff, tag);
  if (size == 0) return {};
  const TIFFDataType type = TIFFFieldDataType(TIFFFindField(tiff, tag, TIFF_ANY));
  if (type != TIFF_ASCII && type != TIFF_BYTE && type != TIFF_UNDEFINED) return {};
  std::uint32_t count = 0;
  const void* values = nullptr;
  TIFFGetField(tiff, tag, &count, &values);
  std::string bytes(static_cast<const char*>(values), size);
  if (type == TIFF_ASCII) bytes.resize(std::min(bytes.find('\0'), bytes.size()));
  return bytes;
}

std::vector<PageMark> tiff_marks(TIFF* tiff, double x_resolution, double y_resolution) {
  const auto unit = tiff_field<std::uint16_t>(tiff, TIFFTAG_RESOLUTIONUNIT);
  const auto distances = pixel_distances(unit, x_resolution, y_resolution);
  return {{"Orientation", std::to_string(tiff_field<std::uint16_t>(tiff, TIFFTAG_ORIENTATION))},
          {"PhotometricInterpretation",
           is_inverted(tiff) ? "small values bright" : "large values bright"},
          {"GDAL_NODATA", private_tiff_bytes(tiff, no_data_tag)},
          {"GDAL_METADATA", has_gdal_scale(tiff) ? "a scale or an offset" : ""},
          {"ModelPixelScale", has_place_on_earth(tiff) ? "a place on earth" : "", true},
          {"XResolution and YResolution",
           distances
               ? readable_number((*distances)[0]) + " x " + readable_number((*distances)[1]) + " mm"
               : "",
           true},
          {"ImageDescription", description_mark(tiff), true, true}};
}

PageDescription describe_tiff(TIFF* tiff, const std::filesystem::path& file,
                              const DescribedPage& page, const ReadOptions& options) {
  PageDescription said = read_text(tiff, file, page, options);
  if (const std::size_t planes = private_tiff_count(tiff, metamorph_tag);
      said.writer.empty() && planes > 1) {
    throw Error(file.string() + ": is a stack of MetaMorph, whose " + std::to_string(planes) +
                " planes share one page (tag UIC2); save it as numbered images");
  }
  read_resolution(tiff, page, said);
  tell_tags(tiff, said);
  return said;
}

}  // namespace pellucid
