// SPDX-License-Identifier: Apache-2.0
#include <vtkExodusIIReader.h>
#include <vtkMultiBlockDataSet.h>
#include <vtk_exodusII.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "pellucid/scene/error.h"
#include "text/text.h"
#include "vtk_gather.h"
#include "vtk_readers.h"

namespace pellucid {

namespace {

/// Remedy for readers that need positions or values in arrays of their own.
constexpr const char* file_size_remedy =
    "give it file_size = 1, which some writers forget (ncatted -a file_size,global,c,l,1)";

/// A variable of nodes (EX_NODAL) or of elements (EX_ELEM_BLOCK), by the name that the file has.
struct Variable {
  ex_entity_type of;
  std::string name;
};

/// A file that Exodus has open, in doubles.
class ExodusFile {
 public:
  explicit ExodusFile(const std::filesystem::path& path) {
    int word = sizeof(double), word_in_file = 0;
    float version = 0;
    file_ = ex_open(path.c_str(), EX_READ, &word, &word_in_file, &version);
    if (file_ < 0) throw Error("is no Exodus II file, or is cut off or damaged");
  }
  ~ExodusFile() { ex_close(file_); }
  ExodusFile(const ExodusFile&) = delete;
  ExodusFile& operator=(const ExodusFile&) = delete;

  /// Throws Error where the library does not find the places of the nodes.
  void check_places() const {
    std::array<double, 3> place{};
    if (count(EX_INQ_NODES) == 0) return;
    if (ex_get_partial_coord(file_, 1, 1, place.data(), place.data() + 1, place.data() + 2) >= 0) {
      return;
    }
    throw Error(std::string("Exodus does not find the places of its nodes; the file is damaged, ") +
                "or lacks an attribute: " + file_size_remedy);
  }

  /// Throws Error where an element has a node that is not there: VTK does not look.
  void check_corners() const {
    const auto nodes = static_cast<std::int64_t>(count(EX_INQ_NODES));
    for (const int id : block_ids()) {
      ex_block block{};
      block.id = id;
      block.type = EX_ELEM_BLOCK;
      if (ex_get_block_param(file_, &block) < 0 || block.num_entry <= 0) continue;
      const std::string kind = in_small_letters(std::string_view(block.topology).substr(0, 6));
      constexpr std::int64_t max_corners = 1000;  // as of no element; polyhedra have lists
      if (kind == "nsided" || kind == "nfaced" || block.num_nodes_per_entry <= 0 ||
          block.num_nodes_per_entry > max_corners) {
        continue;
      }
      constexpr std::int64_t at_once = 1 << 16;
      std::vector<int> corners;
      for (std::int64_t first = 0; first < block.num_entry; first += at_once) {
        const std::int64_t here = std::min(at_once, block.num_entry - first);
        corners.assign(static_cast<std::size_t>(here * block.num_nodes_per_entry), 1);
        if (ex_get_partial_conn(file_, EX_ELEM_BLOCK, id, first + 1, here, corners.data(), nullptr,
                                nullptr) < 0) {
          break;
        }
        const auto wrong =
            std::ranges::find_if(corners, [&](int node) { return node < 1 || node > nodes; });
        if (wrong == corners.end()) continue;
        const std::int64_t element = first + (wrong - corners.begin()) / block.num_nodes_per_entry;
        throw Error("element " + std::to_string(element + 1) + " of block " + std::to_string(id) +
                    " has the node " + std::to_string(*wrong) + ", but there are " +
                    std::to_string(nodes) + "; the file is damaged");
      }
    }
  }

  /// Returns the variables whose first value of a step, from 1, the library does not find.
  std::vector<Variable> without_values(int step) const {
    std::vector<Variable> list;
    const std::vector<std::string> nodal = names(EX_NODAL);
    for (std::size_t v = 0; v < nodal.size() && count(EX_INQ_NODES) > 0; ++v) {
      if (!has_value(step, EX_NODAL, v, 1)) list.push_back({EX_NODAL, nodal[v]});
    }
    const std::vector<std::string> of_elements = names(EX_ELEM_BLOCK);
    if (of_elements.empty()) return list;
    const std::vector<int> blocks = block_ids();
    std::vector<int> table(blocks.size() * of_elements.size());
    if (ex_get_truth_table(file_, EX_ELEM_BLOCK, static_cast<int>(blocks.size()),
                           static_cast<int>(of_elements.size()), table.data()) < 0) {
      throw Error("its table of elements' variables (truth table) cannot be read; it is damaged");
    }
    for (std::size_t v = 0; v < of_elements.size(); ++v) {
      const bool has_all = std::ranges::all_of(blocks, [&](const int& block) {
        const auto b = static_cast<std::size_t>(&block - blocks.data());
        return table[b * of_elements.size() + v] == 0 || elements(block) == 0 ||
               has_value(step, EX_ELEM_BLOCK, v, block);
      });
      if (!has_all) list.push_back({EX_ELEM_BLOCK, of_elements[v]});
    }
    return list;
  }

 private:
  /// Returns a number of things; 0 where there are none or the file does not say.
  std::size_t count(ex_inquiry what) const {
    // Damaged files say any number; VTK has read these before.
    constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
    const std::int64_t number = ex_inquire_int(file_, what);
    return static_cast<std::size_t>(std::clamp(number, std::int64_t{0}, most));
  }

  std::vector<std::string> names(ex_entity_type of) const {
    int number = 0;
    if (ex_get_variable_param(file_, of, &number) < 0 || number < 0) return {};
    std::vector<std::string> names;
    for (int v = 1; v <= number; ++v) {
      std::array<char, MAX_STR_LENGTH + NC_MAX_NAME + 1> name{};
      names.emplace_back(ex_get_variable_name(file_, of, v, name.data()) < 0 ? "" : name.data());
    }
    return names;
  }

  std::vector<int> block_ids() const {
    std::vector<int> ids(count(EX_INQ_ELEM_BLK));
    if (!ids.empty() && ex_get_ids(file_, EX_ELEM_BLOCK, ids.data()) < 0) ids.clear();
    return ids;
  }

  std::int64_t elements(int block) const {
    ex_block about{};
    about.id = block;
    about.type = EX_ELEM_BLOCK;
    return ex_get_block_param(file_, &about) < 0 ? 0 : about.num_entry;
  }

  /// Values of nodes are the object 1.
  bool has_value(int step, ex_entity_type of, std::size_t variable, ex_entity_id object) const {
    double value = 0;
    return ex_get_partial_var(file_, step, of, static_cast<int>(variable) + 1, object, 1, 1,
                              &value) == EX_NOERR;
  }

  int file_ = -1;
};

/// Leaves out arrays without values, each with those that VTK joins it with: "V" of "V_x".
void leave_out(const std::vector<Variable>& variables, vtkExodusIIReader& reader, MeshFile& file) {
  std::string list;
  for (const Variable& variable : variables) {
    const int kind =
        variable.of == EX_NODAL ? vtkExodusIIReader::NODAL : vtkExodusIIReader::ELEM_BLOCK;
    for (int a = 0; a < reader.GetNumberOfObjectArrays(kind); ++a) {
      const char* const name = reader.GetObjectArrayName(kind, a);
      if (name != nullptr && *name != '\0' && variable.name.starts_with(name)) {
        reader.SetObjectArrayStatus(kind, a, 0);
      }
    }
    constexpr std::size_t most = 200;
    if (list.size() < most) list += (list.empty() ? "\"" : ", \"") + variable.name + "\"";
  }
  if (variables.empty()) return;
  file.notes.push_back(std::to_string(variables.size()) +
                       " variables have names, but Exodus finds no values: " + list +
                       "; they are left out. If values are in arrays of their own, " +
                       file_size_remedy);
}

/// NetCDF's fill of floats and doubles: 2^123 less 15 * 2^119.
constexpr double fill = 9.9692099683868690e+36;

/// Puts NaN in the place of values that were never written. Returns how many there were; adds the
/// names of their arrays.
std::size_t remove_fill(MeshBlocks& mesh, std::vector<std::string>& names) {
  std::size_t count = 0;
  for (UnstructuredGrid& block : mesh.blocks) {
    for (MeshArray& array : block.arrays) {
      const std::size_t before = count;
      std::visit(
          [&](auto& values) {
            using Value = typename std::decay_t<decltype(values)>::value_type;
            if constexpr (std::is_floating_point_v<Value>) {
              for (Value& value : values.writable()) {
                if (static_cast<double>(value) != fill) continue;
                value = std::numeric_limits<Value>::quiet_NaN();
                ++count;
              }
            }
          },
          array.values);
      const bool is_new = std::ranges::find(names, array.name) == names.end();
      if (count > before && is_new) names.push_back(array.name);
    }
  }
  return count;
}

/// Returns whether VTK moves the points by an array of this name.
bool displaces(const std::string& name) {
  const auto is = [&](std::size_t i, char small, char capital) {
    return name.size() > i && (name[i] == small || name[i] == capital);
  };
  return is(0, 'd', 'D') && is(1, 'i', 'I') && is(2, 's', 'S');
}

void tell_fill(std::size_t count, const std::vector<std::string>& names, bool displaced,
               MeshFile& file) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "\"" : ", \"") + name + "\"";
  constexpr std::size_t most = 200;
  file.notes.push_back(std::to_string(count) + " values of this step were never written (" +
                       list.substr(0, most) +
                       "), as a run that was ended leaves them; they are "
                       "missing" +
                       (displaced ? ", and the points are not displaced" : ""));
}

/// Returns a reader that has read the head of a file.
vtkSmartPointer<vtkExodusIIReader> open_exodus(const std::filesystem::path& path,
                                               const VtkMessages& messages) {
  auto reader = vtkSmartPointer<vtkExodusIIReader>::New();
  ex_opts(0);  // else Exodus prints what it finds wrong
  if (reader->CanReadFile(path.c_str()) == 0) {
    throw Error("is no Exodus II file, or is cut off or damaged");
  }
  reader->SetFileName(path.c_str());
  reader->UpdateInformation();
  messages.check();
  return reader;
}

/// Runs a reader at the step that it has been told. Throws Error where VTK says one.
void update_whole(vtkExodusIIReader& reader, const VtkMessages& messages) {
  reader.Update();
  messages.check();
  if (reader.GetErrorCode() != 0) throw Error("the file is cut off or damaged");
}

/// Returns the times without those that were never written.
std::vector<double> known_times(const std::vector<double>& times) {
  std::vector<double> known;
  std::ranges::copy_if(times, std::back_inserter(known), [](double t) { return t != fill; });
  return known;
}

}  // namespace

std::vector<double> exodus_times(const std::filesystem::path& path, const VtkMessages& messages) {
  return known_times(times_of(*open_exodus(path, messages)));
}

void read_exodus(const std::filesystem::path& path, const MeshReadOptions& options,
                 const VtkMessages& messages, MeshBlocks& mesh) {
  const auto reader = open_exodus(path, messages);
  reader->GenerateObjectIdCellArrayOff();
  for (const int kind : {vtkExodusIIReader::ELEM_BLOCK, vtkExodusIIReader::NODAL}) {
    reader->SetAllArrayStatus(kind, 1);
  }
  for (int i = 0; i < reader->GetNumberOfObjects(vtkExodusIIReader::ELEM_BLOCK); ++i) {
    reader->SetObjectStatus(vtkExodusIIReader::ELEM_BLOCK, i, 1);
  }
  mesh.file.format = "Exodus II";
  const std::vector<double> times = times_of(*reader);
  const std::vector<double> known = known_times(times);
  const std::size_t without_time = times.size() - known.size();
  if (without_time > 0) {
    mesh.file.notes.push_back(std::to_string(without_time) + " of " + std::to_string(times.size()) +
                              " steps have no time, as a run that was ended leaves them; they are "
                              "not read");
    if (known.empty()) throw Error("none of its steps has a time; the file is cut off");
  }
  const ExodusFile file(path);
  file.check_places();
  file.check_corners();
  if (!times.empty()) {
    const double wanted = known[nearest_step(known, options.time)];
    const auto step = static_cast<int>(std::ranges::find(times, wanted) - times.begin());
    leave_out(file.without_values(step + 1), *reader, mesh.file);
    // By its number: VTK looks for a time among ascending ones.
    reader->SetTimeStep(step);
    mesh.file.times = known;
    mesh.file.time = wanted;
  } else {
    refuse_time(options);
  }
  update_whole(*reader, messages);
  gather(*reader->GetOutput(), mesh);
  std::vector<std::string> names;
  const std::size_t unwritten = remove_fill(mesh, names);
  if (unwritten == 0) return;
  const bool displaced = std::ranges::any_of(names, displaces);
  if (displaced) {
    reader->SetApplyDisplacements(0);
    mesh.blocks.clear();
    mesh.cells = mesh.file.flat_cells = mesh.file.ghost_cells = mesh.file.trimmed_cells = 0;
    update_whole(*reader, messages);
    gather(*reader->GetOutput(), mesh);
    remove_fill(mesh, names);
  }
  tell_fill(unwritten, names, displaced, mesh.file);
}

}  // namespace pellucid
