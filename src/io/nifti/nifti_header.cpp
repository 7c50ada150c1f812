// SPDX-License-Identifier: Apache-2.0
#include "nifti_header.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "axes/time_steps.h"
#include "pellucid/scene/error.h"
#include "ras_affine.h"

namespace pellucid {

namespace {

// Colors of three and four bytes.
constexpr int rgb_code = 128, rgba_code = 2304;

std::string type_of(int code, const std::string& name) {
  switch (code) {
    case 2:
    case rgb_code:
    case rgba_code:
      return "u8";
    case 4:
      return "i16";
    case 8:
      return "i32";
    case 16:
      return "f32";
    case 64:
      return "f64";
    case 256:
      return "i8";
    case 512:
      return "u16";
    case 768:
      return "u32";
    case 1024:
      return "i64";
    case 1280:
      return "u64";
    case 32:
    case 1792:
    case 2048:
      throw Error(name + ": complex numbers are not read; save their magnitude or one part");
    default:
      throw Error(name + ": NIfTI data type " + std::to_string(code) +
                  " is not read; convert the file to float");
  }
}

std::array<std::int64_t, 3> dimensions_of(const NiftiFields& fields, const std::string& name) {
  const std::int64_t axes = fields.dim[0];
  if (axes < 1 || axes > 7) {
    throw Error(name + ": the NIfTI header says " + std::to_string(axes) + " axes; it is damaged");
  }
  if (axes < 3) {
    throw Error(name + ": an image of " + std::to_string(axes) +
                " axes is not read; a volume has three");
  }
  return {fields.dim[1], fields.dim[2], fields.dim[3]};
}

// nifti1.h and the CIFTI-2 specification. Those of statistics say what the numbers mean.
void check_intent(int intent, const std::string& name) {
  if (intent >= 3000 && intent < 3100) {
    throw Error(name + ": is CIFTI-2 (intent " + std::to_string(intent) +
                "), a matrix over points of a surface and voxels, and no volume; convert it with "
                "wb_command -cifti-separate");
  }
  constexpr int points = 1008, triangles = 1009, nodes = 2002;
  if (intent == points || intent == triangles || intent == nodes) {
    throw Error(name + ": holds points of a surface (intent " + std::to_string(intent) +
                "), and no volume");
  }
}

/// Sets the times of the fourth axis. Codes of frequencies, shifts and angles say that it is no
/// time (nifti1.h, NIFTI_UNITS_HZ and the next).
void find_times(const NiftiFields& fields, NiftiHeader& header) {
  const int code = fields.version == NiftiVersion::analyze ? 0 : fields.units & 0x38;
  constexpr int seconds = 8, milliseconds = 16, microseconds = 24;
  if (code > microseconds) return;
  header.time_unit = code == seconds        ? "s"
                     : code == milliseconds ? "ms"
                     : code == microseconds ? "us"
                                            : "";
  const double step = fields.pixdim[4], first = fields.time_offset;
  const bool has_step = std::isfinite(step) && step > 0;
  if (!has_step) header.time_unit.clear();  // they are counted
  header.times = even_times(static_cast<std::size_t>(header.layout.components),
                            has_step && std::isfinite(first) ? first : 0, has_step ? step : 1);
}

// Colors, or one of the axes behind the third.
void find_components(const NiftiFields& fields, const std::string& name, NiftiHeader& header) {
  if (fields.datatype == rgb_code || fields.datatype == rgba_code) {
    header.layout.components = fields.datatype == rgb_code ? 3 : 4;
    header.layout.interleaved = true;
    header.holds = fields.datatype == rgb_code ? "colors (RGB)" : "colors (RGBA)";
  }
  // nifti1.h: matrices, vectors and the like, but for the series among them.
  const bool vectors = fields.intent > 1003 && fields.intent != 2001;
  for (std::size_t a = 4; a <= static_cast<std::size_t>(fields.dim[0]); ++a) {
    const std::int64_t n = fields.dim[a];
    // Old writers of Analyze leave 0 where an axis has one value.
    if (n == 1 || (n == 0 && fields.version == NiftiVersion::analyze)) continue;
    const std::string holds = std::to_string(n) +
                              (a == 4 && !vectors ? " time steps" : " components") + " (axis " +
                              std::to_string(a) + ")";
    if (n < 1 || n > std::numeric_limits<std::int32_t>::max()) {
      throw Error(name + ": the NIfTI header says " + holds + "; it is damaged");
    }
    if (header.layout.components > 1) {
      throw Error(name + ": holds " + header.holds + " and " + holds +
                  "; save one of these as a file of its own");
    }
    header.layout.components = static_cast<int>(n);
    header.holds = holds;
    if (a == 4 && !vectors) find_times(fields, header);
  }
}

std::uintmax_t offset_of(const NiftiFields& fields, const std::string& name) {
  // nifti1.h: in one file the values begin after the header and its four bytes of extension flag.
  const double smallest = !fields.single_file ? 0 : fields.version == NiftiVersion::two ? 544 : 352;
  const double offset = fields.vox_offset == 0 ? smallest : fields.vox_offset;
  if (!(offset >= smallest) || !(offset < 0x1p53) || offset != std::floor(offset)) {
    throw Error(name + ": the NIfTI header says that the values begin at byte " +
                std::to_string(offset) + "; it is damaged");
  }
  return static_cast<std::uintmax_t>(offset);
}

std::optional<GridPlacement> sform_of(const NiftiFields& fields) {
  if (fields.sform_code <= 0) return std::nullopt;
  RasRows rows;
  for (std::size_t i = 0; i < 12; ++i) rows[i / 4][i % 4] = fields.sform[i];
  return placement_from_ras(rows);
}

// nifti1.h, method 2: a rotation as a quaternion of positive a, and a flip of z.
std::optional<GridPlacement> qform_of(const NiftiFields& fields) {
  if (fields.qform_code <= 0) return std::nullopt;
  auto [b, c, d, x, y, z] = fields.qform;
  // Rounding may leave (b, c, d) longer than 1: half a turn then, as nifti1_io.c has it.
  const double length = std::sqrt(b * b + c * c + d * d);
  const double a = std::sqrt(std::max(0.0, 1 - length * length));
  if (length > 1) {
    b /= length;
    c /= length;
    d /= length;
  }
  const double flip = fields.pixdim[0] < 0 ? -1 : 1;
  GridPlacement placement;
  // Left and posterior instead of right and anterior.
  placement.origin = {-x, -y, z};
  placement.spacing = {fields.pixdim[1], fields.pixdim[2], fields.pixdim[3]};
  placement.direction.column[0] = {-(a * a + b * b - c * c - d * d), -2 * (b * c + a * d),
                                   2 * (b * d - a * c)};
  placement.direction.column[1] = {-2 * (b * c - a * d), -(a * a + c * c - b * b - d * d),
                                   2 * (c * d + a * b)};
  placement.direction.column[2] =
      Vec3<double>{-2 * (b * d + a * c), -2 * (c * d - a * b), a * a + d * d - b * b - c * c} *
      flip;
  return placement;
}

template <class Numbers>
void check_finite(const Numbers& numbers, const std::string& name, const char* what) {
  if (std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); })) return;
  throw Error(name + ": the " + what + " of the NIfTI header is not finite; mend the header");
}

// What a reader should know of the header that the picture does not show.
void note_header(const NiftiFields& fields, const std::string& name, NiftiHeader& header) {
  const auto note = [&](const std::string& text) { header.notes.push_back(name + ": " + text); };
  constexpr int labels = 1002;
  if (fields.intent == labels) {
    note("its values are labels (intent_code 1002); between them nothing is meant, see --labels");
  }
  if (const int unit = fields.units & 7; unit == 0 && fields.version != NiftiVersion::analyze) {
    note("does not say the unit of lengths (xyzt_units 0); taken to be millimetres");
  } else if (unit > 3) {
    note("the unit of lengths (xyzt_units " + std::to_string(unit) +
         ") is not known; taken to be millimetres");
  }
  if (fields.version != NiftiVersion::analyze) return;
  if (fields.orient != 0) {
    note("says orient " + std::to_string(fields.orient) +
         ", which is not taken into account: programs differ in what it means");
  }
  if (fields.has_ranges && header.slope == 1 && header.intercept == 0) {
    note(
        "glmax, glmin, cal_max and cal_min may mean a scale of the values, which is not taken into "
        "account");
  }
}

}  // namespace

NiftiHeader read_nifti_header(const std::filesystem::path& path) {
  const std::string name = path.string();
  const NiftiFields fields = read_nifti_fields(path);
  check_finite(std::span(fields.pixdim).first<4>(), name, "spacing (pixdim)");
  if (fields.qform_code > 0) check_finite(fields.qform, name, "qform");
  if (fields.sform_code > 0) check_finite(fields.sform, name, "sform");
  check_intent(fields.intent, name);
  NiftiHeader header;
  header.version = fields.version;
  header.single_file = fields.single_file;
  header.dimensions = dimensions_of(fields, name);
  header.layout = {type_of(fields.datatype, name), fields.big_endian, offset_of(fields, name)};
  find_components(fields, name, header);
  // nifti1.h: a slope of 0 means none, and colors have none; writers leave NaN where they mean
  // none, too.
  if (!header.layout.interleaved && std::isfinite(fields.slope) && fields.slope != 0) {
    if (std::isfinite(fields.intercept)) {
      header.slope = fields.slope;
      header.intercept = fields.intercept;
    } else if (fields.version == NiftiVersion::analyze) {
      header.slope = fields.slope;
    }
  }
  for (std::size_t a = 0; a < 3; ++a) header.spacing[a] = fields.pixdim[a + 1];
  const int unit_code = fields.units & 7;
  header.unit = unit_code == 1 ? 1e3 : unit_code == 3 ? 1e-3 : 1;
  header.sform = sform_of(fields);
  header.qform = qform_of(fields);
  header.origin = fields.origin;
  note_header(fields, name, header);
  return header;
}

NiftiFiles find_nifti_files(const std::filesystem::path& path) {
  std::string name = path.string();
  const auto ends_with = [&](std::string_view extension) {
    if (name.size() < extension.size()) return false;
    return std::ranges::equal(name.substr(name.size() - extension.size()), extension,
                              [](char a, char b) { return (a | 0x20) == (b | 0x20); });
  };
  std::string packed;
  if (ends_with(".gz")) {
    packed = name.substr(name.size() - 3);
    name.resize(name.size() - 3);
  }
  const bool is_header = ends_with(".hdr"), is_values = ends_with(".img");
  if (!is_header && !is_values) return {path, path};

  const bool upper = name.back() == 'R' || name.back() == 'G';
  const std::string_view extension =
      is_header ? (upper ? ".IMG" : ".img") : (upper ? ".HDR" : ".hdr");
  const std::string other = name.substr(0, name.size() - 4) + std::string(extension);
  for (const std::string& candidate : {other + packed, other, other + ".gz"}) {
    if (!std::filesystem::exists(candidate)) continue;
    return is_header ? NiftiFiles{path, candidate} : NiftiFiles{candidate, path};
  }
  throw Error(path.string() + ": its other half " + other + " is missing; NIfTI pairs need both");
}

}  // namespace pellucid
