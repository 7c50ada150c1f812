// SPDX-License-Identifier: Apache-2.0
#include "itk_header.h"

#include "pellucid/scene/error.h"

#ifndef PELLUCID_HAVE_ITK

namespace pellucid {

namespace {

[[noreturn]] void refuse(const std::string& name) {
  throw Error(name +
              ": this build has no ITK, which reads NIfTI, NRRD and MetaImage; build with "
              "PELLUCID_WITH_ITK=ON, or convert the file to .npy");
}

}  // namespace

Volume::Description read_nifti_description(const std::filesystem::path& path, bool&) {
  refuse(path.string());
}
MetaImageHeader read_meta_image_header(const std::filesystem::path& path) {
  refuse(path.string());
}
VolumeFile open_nrrd_file(const std::filesystem::path&, const std::string& name, const NrrdText&,
                          const ReadOptions&) {
  refuse(name);
}

}  // namespace pellucid

#else

#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

#include <array>
#include <bit>
#include <iostream>
#include <limits>
#include <mutex>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

#include "input_file.h"

namespace pellucid {

namespace {

// ITK and MetaIO warn on stderr; a library has nothing to say there. The switches are the whole
// program's, so one header is read at a time.
class Silence {
 public:
  Silence()
      : lock_(mutex()),
        warnings_(itk::Object::GetGlobalWarningDisplay()),
        cerr_(std::cerr.rdbuf(text_.rdbuf())),
        cout_(std::cout.rdbuf(text_.rdbuf())) {
    itk::Object::SetGlobalWarningDisplay(false);
  }
  ~Silence() {
    std::cout.rdbuf(cout_);
    std::cerr.rdbuf(cerr_);
    itk::Object::SetGlobalWarningDisplay(warnings_);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

  // What was said meanwhile, by its last line.
  std::string last_line() const;

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  std::lock_guard<std::mutex> lock_;
  bool warnings_;
  std::ostringstream text_;
  std::streambuf *cerr_, *cout_;
};

// ITK says in several lines where in its own source something went wrong; the last one says what.
std::string last_line_of(const std::string& text) {
  std::istringstream lines(text);
  std::string line, last;
  while (std::getline(lines, line)) {
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin != std::string::npos) last = line.substr(begin);
  }
  // "ITK ERROR: NrrdImageIO(0x55d0c046c7b0): what went wrong"
  const std::size_t address = last.find("(0x");
  const std::size_t what = last.find("): ", address);
  if (address != std::string::npos && what != std::string::npos) last = last.substr(what + 3);
  return last;
}

std::string Silence::last_line() const {
  return last_line_of(text_.str());
}

std::string type_of(const itk::ImageIOBase& io, const std::string& name) {
  using Type = itk::IOComponentEnum;
  switch (io.GetComponentType()) {
    case Type::UCHAR:
      return "u8";
    case Type::CHAR:
      return "i8";
    case Type::USHORT:
      return "u16";
    case Type::SHORT:
      return "i16";
    case Type::UINT:
      return "u32";
    case Type::INT:
      return "i32";
    case Type::FLOAT:
      return "f32";
    case Type::DOUBLE:
      return "f64";
    case Type::ULONG:
    case Type::LONG:
    case Type::ULONGLONG:
    case Type::LONGLONG:
      throw Error(name + ": 64-bit integers are not read; convert the file to 32 bits or double");
    default:
      throw Error(name + ": values of this type are not read; convert the file to float");
  }
}

// What is more than one number at each point, or on more than three axes.
void find_components(const itk::ImageIOBase& io, const std::string& name, ItkHeader& header) {
  const unsigned components = io.GetNumberOfComponents();
  if (components > static_cast<unsigned>(std::numeric_limits<int>::max())) {
    throw Error(name + ": has " + std::to_string(components) + " components at each point");
  }
  // A list of one number at each point is that number.
  if (components == 1 && io.GetPixelType() != itk::IOPixelEnum::SCALAR &&
      io.GetPixelType() != itk::IOPixelEnum::VECTOR) {
    throw Error(name + ": its values are no plain numbers; convert the file to float");
  }
  if (components != 1) {
    header.components = static_cast<int>(components);
    header.interleaved = true;
    header.holds = std::to_string(components) + " components at each point";
  }
  for (unsigned a = 3; a < io.GetNumberOfDimensions(); ++a) {
    const auto n = io.GetDimensions(a);
    if (n == 1) continue;
    const std::string holds = std::to_string(n) + " volumes (axis " + std::to_string(a + 1) + ")";
    if (header.components != 1 || n < 1 || n > std::numeric_limits<std::int32_t>::max()) {
      throw Error(name + ": holds " + (header.holds.empty() ? "" : header.holds + " and ") + holds +
                  "; save one of them as a file of its own");
    }
    header.components = static_cast<int>(n);
    header.holds = holds;
  }
  if (header.components < 1) {
    throw Error(name + ": holds no components at all; its header is damaged");
  }
}

Volume::Description describe(const itk::ImageIOBase& io, const std::string& name) {
  const unsigned axes = io.GetNumberOfDimensions();
  if (axes < 3) {
    throw Error(name + ": an image of " + std::to_string(axes) +
                " axes is not read; a volume has three");
  }
  Volume::Description description;
  description.name = name;
  std::array<std::int64_t, 3> sides{};
  for (unsigned a = 0; a < 3; ++a) {
    // ITK holds a negative side of a MetaImage as a large number; value_count refuses both.
    sides[a] = static_cast<std::int64_t>(static_cast<std::int32_t>(io.GetDimensions(a)));
    if (io.GetDimensions(a) > 0xffffffff) sides[a] = -1;
    const std::vector<double> axis = io.GetDirection(a);
    const int i = static_cast<int>(a);
    description.placement.spacing[i] = io.GetSpacing(a);
    description.placement.origin[i] = io.GetOrigin(a);
    description.placement.direction.column[i] = {axis[0], axis[1], axis[2]};
  }
  value_count(sides, name);
  for (std::size_t a = 0; a < 3; ++a) description.dimensions[a] = static_cast<int>(sides[a]);
  return description;
}

// Runs what calls ITK, quietly, and turns its exceptions into one line.
template <class Function>
auto quietly(const std::string& name, const Function& function) {
  const Silence silence;
  try {
    return function();
  } catch (const itk::ExceptionObject& e) {
    const std::string said = silence.last_line();
    throw Error(name + ": cannot read the file: " +
                (said.empty() ? last_line_of(e.GetDescription()) : said));
  }
}

template <class ImageIO>
typename ImageIO::Pointer open_header(const std::filesystem::path& path, const std::string& name) {
  auto io = ImageIO::New();
  if (!io->CanReadFile(path.c_str())) {
    throw Error(name + ": is not what its extension says, or is damaged");
  }
  io->SetFileName(path.c_str());
  io->ReadImageInformation();
  return io;
}

std::vector<VolumeData> read_raw_values(const NrrdValues& values, ValueLayout layout,
                                        std::size_t points, ComponentRange range) {
  layout.big_endian = values.big_endian.value_or(false);
  if (values.compression) {
    DataStream stream(values.file, values.offset, *values.compression);
    stream.skip(values.skip_inside);
    std::vector<VolumeData> list = read_components(stream, layout, points, range);
    stream.finish();
    return list;
  }
  const ByteSource source = file_source(values.file);
  layout.offset = values.offset;
  const std::size_t count = value_count(points, layout.components, source.name);
  const std::uintmax_t bytes = std::uintmax_t{count} * value_size(layout.type, source.name);
  if (values.offset == NrrdValues::last_bytes) {
    layout.offset = source.size > bytes ? source.size - bytes : 0;
  }
  check_size(source, layout, count);
  return read_components(source, layout, points, range);
}

std::vector<VolumeData> read_by_itk(itk::ImageIOBase& io, ValueLayout layout, std::size_t points,
                                    ComponentRange range, const std::string& name) {
  itk::ImageIORegion region(io.GetNumberOfDimensions());
  for (unsigned a = 0; a < io.GetNumberOfDimensions(); ++a) {
    region.SetIndex(a, 0);
    region.SetSize(a, io.GetDimensions(a));
  }
  io.SetIORegion(region);
  std::vector<VolumeData> list;
  list.push_back(make_values(layout.type, value_count(points, layout.components, name), name));
  std::visit([&](auto& values) { io.Read(values.writable().data()); }, list.front());
  if (layout.components == 1) return list;
  layout.big_endian = std::endian::native == std::endian::big;
  return std::visit(
      [&](const auto& values) {
        const auto bytes = std::as_bytes(std::span(values.data(), values.size()));
        return read_components(memory_source(bytes, name), layout, points, range);
      },
      list.front());
}

}  // namespace

Volume::Description read_nifti_description(const std::filesystem::path& path, bool& sheared) {
  const std::string name = path.string();
  sheared = false;
  return quietly(name, [&] {
    try {
      return describe(*open_header<itk::NiftiImageIO>(path, name), name);
    } catch (const itk::ExceptionObject& e) {
      if (std::string(e.GetDescription()).find("orthonormal") == std::string::npos) throw;
      sheared = true;
      return Volume::Description{};
    }
  });
}

MetaImageHeader read_meta_image_header(const std::filesystem::path& path) {
  const std::string name = path.string();
  return quietly(name, [&] {
    const auto io = open_header<itk::MetaImageIO>(path, name);
    const MetaImage& image = *io->GetMetaImagePointer();
    MetaImageHeader header;
    header.description = describe(*io, name);
    header.type = type_of(*io, name);
    find_components(*io, name, header);
    header.big_endian = image.BinaryDataByteOrderMSB();
    header.text = !image.BinaryData();
    header.compressed = image.CompressedData();
    header.header_size = image.HeaderSize();
    header.data_file = image.ElementDataFileName();
    return header;
  });
}

VolumeFile open_nrrd_file(const std::filesystem::path& path, const std::string& name,
                          const NrrdText& text, const ReadOptions& options) {
  return quietly(name, [&] {
    const auto io = open_header<itk::NrrdImageIO>(path, name);
    Volume::Description description = describe(*io, name);
    ItkHeader header;
    find_components(*io, name, header);
    const std::string type = type_of(*io, name);
    std::size_t points = 1;
    for (const int side : description.dimensions) points *= static_cast<std::size_t>(side);
    const std::size_t count = value_count(points, header.components, name);
    const std::uintmax_t bytes = std::uintmax_t{count} * value_size(type, name);
    const auto itk_bytes = static_cast<std::uintmax_t>(io->GetImageSizeInBytes());
    if (text.count != count || itk_bytes != bytes ||
        (header.interleaved && text.components_axis == 0)) {
      throw Error(name + ": the NRRD header's sizes make " + std::to_string(text.count) +
                  " values, but ITK finds " + std::to_string(count) + " in " +
                  std::to_string(itk_bytes) + " bytes; mend the header");
    }
    int cell_centred = 0;
    for (int a = 0; a < 3; ++a) {
      std::string centering;
      itk::ExposeMetaData<std::string>(io->GetMetaDataDictionary(),
                                       "NRRD_centerings[" + std::to_string(a) + "]", centering);
      cell_centred += centering == "cell" ? 1 : 0;
    }
    if (cell_centred != 0 && cell_centred != 3 && !options.centering) {
      throw Error(name + ": some axes are cell-centred and some are not; give the centering");
    }
    if (cell_centred == 3) description.centering = Centering::cell;

    if (text.left_anterior_superior) {
      // ITK has turned x; from anterior to posterior is y.
      GridPlacement& placement = description.placement;
      const auto mend = [](Vec3<double> v) { return Vec3<double>{-v.x, -v.y, v.z}; };
      placement.origin = mend(placement.origin);
      for (Vec3<double>& axis : placement.direction.column) axis = mend(axis);
    }

    VolumeFile file;
    file.description = std::move(description);
    apply_overrides(options, file.description);
    file.components = header.components;
    file.holds = header.holds;
    file.read = [io, type, header, text, points, name](ComponentRange range) {
      ValueLayout layout{type, false, 0, header.components, header.interleaved};
      const bool order_is_known =
          text.values && (text.values->big_endian || value_size(type, name) == 1);
      if (text.values && text.values->compression && !order_is_known) {
        throw Error(name +
                    ": the NRRD header does not say the byte order (endian); mend the header");
      }
      if (order_is_known) {
        if (text.components_axis > 1) layout.interleaved = false;
        return read_raw_values(*text.values, layout, points, range);
      }
      return quietly(name, [&] { return read_by_itk(*io, layout, points, range, name); });
    };
    return file;
  });
}

}  // namespace pellucid

#endif
