// SPDX-License-Identifier: Apache-2.0
#include "vtk_hdf.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "axes/time_steps.h"
#include "files/input_file.h"
#include "files/memory_limit.h"
#include "pellucid/io/internal/module.h"
#include "pellucid/scene/error.h"
#include "process/answer_json.h"
#include "process/child_process.h"
#include "text/text.h"

namespace pellucid {

namespace {

using namespace answer_json;

constexpr Module module{"pellucid_hdf5.so", "reads HDF5 files", "HDF5 (Debian: libhdf5-dev)"};

/// Calls a function of the module in a process of its own.
template <class Function>
std::shared_ptr<std::byte> module_in_child(
    const char* name, const std::filesystem::path& path, std::size_t bytes,
    const std::function<bool(Function&, std::span<std::byte>)>& work) {
  const std::uintmax_t file_bytes = check_input_file(path);
  std::shared_ptr<std::byte> answer;
  try {
    module_file(module);  // says at once if it is not there
    answer = run_in_child(
        bytes,
        [&](std::span<std::byte> to) {
          return work(*reinterpret_cast<Function*>(module_function(module, name)), to);
        },
        file_bytes);
  } catch (const Error& error) {
    throw Error(path.string() + ": " + one_line(error.what()));
  }
  if (answer) return answer;
  throw Error(path.string() +
              ": the library that reads HDF5 files fails on it, or takes far more memory or time "
              "than its size lets expect; it is damaged");
}

bool write(const VtkHdfContents& contents, std::span<std::byte> to) {
  json arrays = json::array();
  for (const VtkHdfArray& array : contents.arrays) {
    arrays.push_back({static_cast<int>(array.place), of_text(array.name), array.type, array.sides,
                      of_text(array.fault)});
  }
  json lists = json::array();
  for (const VtkHdfStepList& list : contents.step_lists) {
    lists.push_back({of_text(list.name), list.numbers});
  }
  const json j{of_text(contents.type),
               contents.version,
               contents.steps,
               contents.extent,
               contents.origin,
               contents.spacing,
               contents.direction,
               of_text(contents.point_scalars),
               of_text(contents.cell_scalars),
               arrays,
               of_text(contents.error),
               lists};
  return write_answer(j, to);
}

/// Throws json::exception where the bytes are no contents.
VtkHdfContents read_contents(std::span<const std::byte> from) {
  std::uint64_t size = 0;
  std::memcpy(&size, from.data(), sizeof(size));
  size = std::min<std::uint64_t>(size, from.size() - sizeof(size));
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(from.data() + sizeof(size));
  const json j = json::from_cbor(bytes, bytes + size);
  VtkHdfContents contents;
  contents.type = text_of(j.at(0));
  j.at(1).get_to(contents.version);
  j.at(2).get_to(contents.steps);
  j.at(3).get_to(contents.extent);
  j.at(4).get_to(contents.origin);
  j.at(5).get_to(contents.spacing);
  j.at(6).get_to(contents.direction);
  contents.point_scalars = text_of(j.at(7));
  contents.cell_scalars = text_of(j.at(8));
  for (const json& a : j.at(9)) {
    VtkHdfArray array;
    array.place = static_cast<VtkHdfArray::Place>(a.at(0).get<int>());
    array.name = text_of(a.at(1));
    a.at(2).get_to(array.type);
    a.at(3).get_to(array.sides);
    array.fault = text_of(a.at(4));
    contents.arrays.push_back(std::move(array));
  }
  contents.error = text_of(j.at(10));
  for (const json& l : j.at(11)) {
    contents.step_lists.push_back({text_of(l.at(0)), l.at(1).get<std::vector<double>>()});
  }
  return contents;
}

/// Looks for HDF5's signature, and for the name or the group's name, which stands in the root
/// group's list: near the beginning of nearly all files, near the end of those whose group came
/// last.
bool looks_like_vtk_hdf(const std::filesystem::path& path) {
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n", group = "VTKHDF";
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;  // opening a pipe would wait
  std::ifstream stream(path, std::ios::binary);
  const auto bytes_from = [&](std::uintmax_t from, std::size_t most) {
    std::string bytes(most, '\0');
    stream.clear();
    stream.seekg(static_cast<std::streamoff>(from));
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
    return bytes;
  };
  if (bytes_from(0, signature.size()) != signature) return false;
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  if (extension == ".vtkhdf" || extension == ".hdf") return true;
  constexpr std::size_t most = std::size_t{1} << 20;
  if (bytes_from(0, most).find(group) != std::string::npos) return true;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  return !error && size > most && bytes_from(size - most, most).find(group) != std::string::npos;
}

/// Returns the number of values of an array, or of one component of it. Throws Error where no
/// machine holds them.
std::size_t count_of(const VtkHdfArray& array, bool component, const std::string& name) {
  constexpr std::int64_t largest = std::int64_t{1} << 58;
  std::int64_t count = 1;
  const std::size_t axes = array.sides.size() - (component ? 1 : 0);
  for (std::size_t a = 0; a < axes; ++a) {
    const std::int64_t side = array.sides[a];
    if (side < 0 || (side > 0 && count > largest / side)) {
      throw Error(name + ": the array \"" + one_line(array.name) + "\" is too large");
    }
    count *= side;
  }
  return static_cast<std::size_t>(count);
}

}  // namespace

std::vector<double> VtkHdfContents::times() const {
  for (const VtkHdfStepList& list : step_lists) {
    if (list.name == "Values") return list.numbers;
  }
  return even_times(static_cast<std::size_t>(steps), 0, 1);
}

std::int64_t VtkHdfContents::of_step(const std::string& list, std::size_t step,
                                     std::int64_t otherwise) const {
  const auto found = std::ranges::find(step_lists, list, &VtkHdfStepList::name);
  if (found == step_lists.end()) return otherwise;
  const double number = step < found->numbers.size() ? found->numbers[step] : -1;
  constexpr double largest = 0x1p53;
  if (!(number >= 0 && number <= largest) || number != std::floor(number)) {
    throw Error("its list " + one_line(list) +
                " of the group Steps has no whole number for the step; the file is damaged");
  }
  return static_cast<std::int64_t>(number);
}

std::optional<VtkHdfContents> vtk_hdf_contents(const std::filesystem::path& path) {
  if (!looks_like_vtk_hdf(path)) return std::nullopt;
  // Room for the times of many steps; what is not written to is no memory.
  constexpr std::size_t room = std::size_t{64} << 20;
  const auto bytes = module_in_child<ListVtkHdf>(list_vtk_hdf_name, path, room,
                                                 [&](ListVtkHdf& list, std::span<std::byte> to) {
                                                   VtkHdfContents contents;
                                                   list(path, contents);
                                                   return write(contents, to);
                                                 });
  VtkHdfContents contents;
  try {
    contents = read_contents({bytes.get(), room});
  } catch (const json::exception&) {
    throw Error(path.string() + ": its list of arrays is damaged");
  }
  if (!contents.error.empty()) throw Error(path.string() + ": " + one_line(contents.error));
  if (contents.type.empty()) return std::nullopt;
  return contents;
}

VtkHdfContents vtk_hdf_contents(const std::filesystem::path& path, const char* type) {
  const std::string name = path.string();
  std::optional<VtkHdfContents> contents = vtk_hdf_contents(path);
  if (!contents) {
    throw Error(name + ": is no VTKHDF file: it is not HDF5, or has no group VTKHDF");
  }
  if (contents->type != type) {
    throw Error(name + ": holds " + one_line(contents->type.substr(0, 40)) +
                " of VTKHDF; read are ImageData and UnstructuredGrid, so write that");
  }
  constexpr std::int64_t newest = 2;
  if (contents->version > newest) {
    throw Error(name + ": is VTKHDF of version " + std::to_string(contents->version) +
                "; read are versions 1 and 2");
  }
  return *std::move(contents);
}

std::string vtk_hdf_type(const std::filesystem::path& path) {
  try {
    const std::optional<VtkHdfContents> contents = vtk_hdf_contents(path);
    return contents ? contents->type : "";
  } catch (const Error&) {
    return "";
  }
}

std::size_t VtkHdfValues::want(const VtkHdfArray& array, std::optional<std::int64_t> component,
                               const std::optional<IndexBox>& box,
                               const std::optional<std::array<std::int64_t, 2>>& rows) {
  const std::string name = path_.string();
  if (!array.fault.empty()) {
    throw Error(name + ": the array \"" + one_line(array.name) + "\" is " + one_line(array.fault));
  }
  std::size_t all = count_of(array, component.has_value(), name);
  if (rows) {
    const std::int64_t side = array.sides.front();
    const auto [first, number] = *rows;
    if (first < 0 || number < 0 || first > side || number > side - first) {
      throw Error(name + ": the array \"" + one_line(array.name) +
                  "\" ends before the values of the step; the file is cut off or damaged");
    }
    all = side == 0 ? 0 : all / static_cast<std::size_t>(side) * static_cast<std::size_t>(number);
  }
  const std::size_t count = box ? value_count(*box) : all;
  const std::size_t bytes = count * value_size(array.type, name);
  entries_.push_back({array, component, box, rows, count, bytes_});
  constexpr std::size_t alignment = 8, most = std::size_t{1} << 61;
  if (bytes > most - bytes_) throw Error(name + ": its arrays are too large");
  bytes_ += (bytes + alignment - 1) / alignment * alignment;
  return entries_.size() - 1;
}

void VtkHdfValues::read() {
  check_memory(bytes_, path_.string() + ": its values");
  constexpr std::size_t longest = 4096;
  all_ = module_in_child<ReadVtkHdf>(
      read_vtk_hdf_name, path_, bytes_ + longest, [&](ReadVtkHdf& read, std::span<std::byte> to) {
        std::vector<VtkHdfWanted> wanted;
        wanted.reserve(entries_.size());
        for (const Entry& entry : entries_) {
          const std::size_t bytes = entry.count * value_size(entry.array.type, "");
          wanted.push_back({entry.array, entry.component, entry.box, entry.rows,
                            to.subspan(entry.offset, bytes)});
        }
        std::string error;
        read(path_, wanted, error);
        std::memcpy(to.data() + bytes_, error.data(), std::min(error.size(), longest - 1));
        return true;
      });
  const auto* const message = reinterpret_cast<const char*>(all_.get() + bytes_);
  const std::string error(message, std::find(message, message + longest - 1, '\0'));
  if (!error.empty()) throw Error(path_.string() + ": " + one_line(error));
}

VolumeData VtkHdfValues::operator[](std::size_t number) const {
  const Entry& entry = entries_[number];
  VolumeData data = make_volume_data(entry.array.type, 0);
  std::visit(
      [&](auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        const auto* const first = reinterpret_cast<const Value*>(all_.get() + entry.offset);
        values = DataArray<Value>(std::shared_ptr<const Value>(all_, first), entry.count);
      },
      data);
  return data;
}

}  // namespace pellucid
