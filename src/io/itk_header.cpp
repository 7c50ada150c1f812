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
Volume read_nrrd_file(const std::filesystem::path&, const std::string& name, std::uint64_t, bool,
                      const std::optional<NrrdValues>&, const ReadOptions&) {
  refuse(name);
}

}  // namespace pellucid

#else

#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

#include <array>
#include <iostream>
#include <mutex>
#include <sstream>

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

Volume::Description describe(const itk::ImageIOBase& io, const std::string& name) {
  const unsigned axes = io.GetNumberOfDimensions();
  if (axes < 3) {
    throw Error(name + ": an image of " + std::to_string(axes) +
                " axes is not read; a volume has three");
  }
  for (unsigned a = 3; a < axes; ++a) {
    if (io.GetDimensions(a) == 1) continue;
    throw Error(name + ": holds " + std::to_string(io.GetDimensions(a)) + " volumes (axis " +
                std::to_string(a + 1) + "); save one of them as a file of its own");
  }
  if (io.GetNumberOfComponents() != 1) {
    throw Error(name + ": has " + std::to_string(io.GetNumberOfComponents()) +
                " components at each point; save one of them as a file of its own");
  }
  if (io.GetPixelType() != itk::IOPixelEnum::SCALAR) {
    throw Error(name + ": its values are no plain numbers; convert the file to float");
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

VolumeData read_raw_values(const NrrdValues& values, const std::string& type, std::size_t count) {
  const ByteSource source = file_source(values.file);
  ValueLayout layout{type, values.big_endian.value_or(false), values.offset};
  const std::uintmax_t bytes = std::uintmax_t{count} * value_size(type, source.name);
  if (values.offset == NrrdValues::last_bytes) {
    layout.offset = source.size > bytes ? source.size - bytes : 0;
  }
  check_size(source, layout, count);
  return read_values(source, layout, count);
}

VolumeData read_by_itk(itk::ImageIOBase& io, const std::string& type, std::size_t count,
                       const std::string& name) {
  itk::ImageIORegion region(io.GetNumberOfDimensions());
  for (unsigned a = 0; a < io.GetNumberOfDimensions(); ++a) {
    region.SetIndex(a, 0);
    region.SetSize(a, io.GetDimensions(a));
  }
  io.SetIORegion(region);
  VolumeData data = make_values(type, count, name);
  std::visit([&](auto& list) { io.Read(list.writable().data()); }, data);
  return data;
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
    header.big_endian = image.BinaryDataByteOrderMSB();
    header.text = !image.BinaryData();
    header.compressed = image.CompressedData();
    header.header_size = image.HeaderSize();
    header.data_file = image.ElementDataFileName();
    return header;
  });
}

Volume read_nrrd_file(const std::filesystem::path& path, const std::string& name,
                      std::uint64_t header_count, bool left_anterior_superior,
                      const std::optional<NrrdValues>& values, const ReadOptions& options) {
  return quietly(name, [&] {
    const auto io = open_header<itk::NrrdImageIO>(path, name);
    Volume::Description description = describe(*io, name);
    const std::string type = type_of(*io, name);
    std::size_t count = 1;
    for (const int side : description.dimensions) count *= static_cast<std::size_t>(side);
    const std::uintmax_t bytes = std::uintmax_t{count} * value_size(type, name);
    const auto itk_bytes = static_cast<std::uintmax_t>(io->GetImageSizeInBytes());
    if (header_count != count || itk_bytes != bytes) {
      throw Error(name + ": the NRRD header's sizes make " + std::to_string(header_count) +
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

    if (left_anterior_superior) {
      // ITK has turned x; from anterior to posterior is y.
      GridPlacement& placement = description.placement;
      const auto mend = [](Vec3<double> v) { return Vec3<double>{-v.x, -v.y, v.z}; };
      placement.origin = mend(placement.origin);
      for (Vec3<double>& axis : placement.direction.column) axis = mend(axis);
    }

    VolumeData data = values && (values->big_endian || value_size(type, name) == 1)
                          ? read_raw_values(*values, type, count)
                          : read_by_itk(*io, type, count, name);
    apply_overrides(options, description);
    return Volume(std::move(description), std::move(data));
  });
}

}  // namespace pellucid

#endif
