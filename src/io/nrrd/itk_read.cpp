// SPDX-License-Identifier: Apache-2.0
//
// The module that reads the headers of MetaImage and NRRD, and NRRD's values, through ITK.
#include "itk_module.h"

#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

#include <array>
#include <iostream>
#include <limits>
#include <mutex>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

#include "pellucid/scene/error.h"
#include "process/module_answer.h"

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
    case Type::ULONGLONG:
      return io.GetComponentSize() == 4 ? "u32" : "u64";
    case Type::LONG:
    case Type::LONGLONG:
      return io.GetComponentSize() == 4 ? "i32" : "i64";
    default:
      throw Error(name + ": values of this type are not read; convert the file to float");
  }
}

/// Sets how many components there are, and whether they lie at each point or along a fourth axis.
/// Throws Error if both hold several, or a pixel is no list of numbers.
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

void find_grid(const itk::ImageIOBase& io, const std::string& name, ItkHeader& header) {
  const unsigned axes = io.GetNumberOfDimensions();
  if (axes < 3) {
    throw Error(name + ": an image of " + std::to_string(axes) +
                " axes is not read; a volume has three");
  }
  for (unsigned a = 0; a < 3; ++a) {
    // ITK holds a negative side of a MetaImage as a large number.
    header.sides[a] = static_cast<std::int64_t>(static_cast<std::int32_t>(io.GetDimensions(a)));
    if (io.GetDimensions(a) > 0xffffffff) header.sides[a] = -1;
    const std::vector<double> axis = io.GetDirection(a);
    const int i = static_cast<int>(a);
    header.placement.spacing[i] = io.GetSpacing(a);
    header.placement.origin[i] = io.GetOrigin(a);
    header.placement.direction.column[i] = {axis[0], axis[1], axis[2]};
  }
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

constexpr const char* remedy = "crop or reduce the volume";

}  // namespace
}  // namespace pellucid

#define PELLUCID_MODULE_FUNCTION extern "C" __attribute__((visibility("default")))

PELLUCID_MODULE_FUNCTION void pellucid_read_meta_image_header_1(const std::filesystem::path& path,
                                                                pellucid::MetaImageHeader& header,
                                                                std::string& error) {
  using namespace pellucid;
  answer(error, remedy, [&] {
    const std::string name = path.string();
    quietly(name, [&] {
      const auto io = open_header<itk::MetaImageIO>(path, name);
      const MetaImage& image = *io->GetMetaImagePointer();
      find_grid(*io, name, header);
      header.type = type_of(*io, name);
      find_components(*io, name, header);
      header.big_endian = image.BinaryDataByteOrderMSB();
      header.text = !image.BinaryData();
      header.compressed = image.CompressedData();
      header.header_size = image.HeaderSize();
      header.data_file = image.ElementDataFileName();
    });
  });
}

PELLUCID_MODULE_FUNCTION void pellucid_read_nrrd_header_1(const std::filesystem::path& path,
                                                          const std::string& name,
                                                          pellucid::NrrdHeader& header,
                                                          std::string& error) {
  using namespace pellucid;
  answer(error, remedy, [&] {
    quietly(name, [&] {
      const auto io = open_header<itk::NrrdImageIO>(path, name);
      find_grid(*io, name, header);
      find_components(*io, name, header);
      header.type = type_of(*io, name);
      header.bytes = static_cast<std::uintmax_t>(io->GetImageSizeInBytes());
    });
  });
}

PELLUCID_MODULE_FUNCTION void pellucid_read_nrrd_values_1(const std::filesystem::path& path,
                                                          const std::string& name,
                                                          std::span<std::byte> to,
                                                          std::string& error) {
  using namespace pellucid;
  answer(error, remedy, [&] {
    quietly(name, [&] {
      const auto io = open_header<itk::NrrdImageIO>(path, name);
      if (static_cast<std::uintmax_t>(io->GetImageSizeInBytes()) != to.size()) {
        throw Error(name + ": the file has changed while it was read");
      }
      itk::ImageIORegion region(io->GetNumberOfDimensions());
      for (unsigned a = 0; a < io->GetNumberOfDimensions(); ++a) {
        region.SetIndex(a, 0);
        region.SetSize(a, io->GetDimensions(a));
      }
      io->SetIORegion(region);
      io->Read(to.data());
    });
  });
}
