// SPDX-License-Identifier: Apache-2.0
#include "grid_data.h"

#include <vtkAOSDataArrayTemplate.h>
#include <vtkArrayDispatch.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkRectilinearGrid.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkVersionMacros.h>

#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include "pellucid/scene/error.h"
#include "pellucid/scene/hidden_values.h"
#include "vtk/module/vtk_values.h"
#include "vtk_scene/placement.h"

namespace pellucid::plugin {
namespace {

ImageSettings settings_of(vtkImageData& image) {
  ImageSettings made;
  const double *const origin = image.GetOrigin(), *const spacing = image.GetSpacing();
  made.origin = {origin[0], origin[1], origin[2]};
  made.spacing = {spacing[0], spacing[1], spacing[2]};
  vtkMatrix3x3* const matrix = image.GetDirectionMatrix();
  for (int axis = 0; axis < 3; ++axis) {
    made.first[static_cast<std::size_t>(axis)] = image.GetExtent()[2 * axis];
    made.direction.column[axis] = {matrix->GetElement(0, axis), matrix->GetElement(1, axis),
                                   matrix->GetElement(2, axis)};
  }
  return made;
}

std::vector<double> coordinates_of(vtkDataArray* array) {
  std::vector<double> values;
  if (array == nullptr) return values;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i) {
    values.push_back(array->GetComponent(i, 0));
  }
  return values;
}

bool same_grid(const Volume::Description& a, const Volume::Description& b) {
  const auto same_placement = [](const GridPlacement& p, const GridPlacement& q) {
    return p.origin == q.origin && p.spacing == q.spacing && p.direction == q.direction;
  };
  return a.dimensions == b.dimensions && a.centering == b.centering &&
         a.coordinates == b.coordinates && same_placement(a.placement, b.placement);
}

/// Copies a component, or shares it where it lies alone.
struct Component {
  int index = 0;
  VolumeData values{};
  vtkDataArray* owner = nullptr;

  template <class Value>
  static constexpr bool is_ours() {
    return std::is_same_v<Value, float> || std::is_same_v<Value, double> ||
           (std::is_integral_v<Value> && sizeof(Value) <= 4);
  }
  /// Returns the type of the scene's values: char and long have another name than the type of their
  /// size.
  template <class Value>
  static auto kept_type() {
    if constexpr (std::is_floating_point_v<Value>) {
      return Value{};
    } else if constexpr (sizeof(Value) == 1) {
      return std::conditional_t<std::is_signed_v<Value>, std::int8_t, std::uint8_t>{};
    } else if constexpr (sizeof(Value) == 2) {
      return std::conditional_t<std::is_signed_v<Value>, std::int16_t, std::uint16_t>{};
    } else {
      return std::conditional_t<std::is_signed_v<Value>, std::int32_t, std::uint32_t>{};
    }
  }

  /// Since VTK 9.3 an array of components, each in memory of its own, may move them into one buffer
  /// whenever someone asks for that; 9.2 counts as 9.3.
  static constexpr bool components_lie_still = VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 2, 0);

  template <class Value>
  void operator()(vtkSOADataArrayTemplate<Value>* array) {
    if constexpr (!components_lie_still) {
      copy_typed(*array);
    } else if constexpr (is_ours<Value>()) {
      using Kept = decltype(kept_type<Value>());
      const vtkSmartPointer<vtkDataArray> kept(array);
      const auto* const first =
          reinterpret_cast<const Kept*>(array->GetComponentArrayPointer(index));
      values = DataArray<Kept>(std::shared_ptr<const Kept>(first, [kept](const Kept*) {}),
                               static_cast<std::size_t>(array->GetNumberOfTuples()));
    } else {
      copy<double>(*array);
    }
  }
  template <class Value>
  void operator()(vtkAOSDataArrayTemplate<Value>* array) {
    copy_typed(*array);
  }
  template <class Array>
  void copy_typed(Array& array) {
    using Value = typename Array::ValueType;
    if constexpr (is_ours<Value>()) {
      copy<decltype(kept_type<Value>())>(array);
    } else {
      copy<double>(array);
    }
  }
  template <class Kept, class Array>
  void copy(Array& array) {
    DataArray<Kept> copied(static_cast<std::size_t>(array.GetNumberOfTuples()));
    vtkIdType tuple = 0;
    for (Kept& value : copied.writable()) {
      value = static_cast<Kept>(array.GetTypedComponent(tuple++, index));
    }
    values = std::move(copied);
  }
  /// Takes whatever other array it is.
  void copy_slowly(vtkDataArray& array) {
    DataArray<double> copied(static_cast<std::size_t>(array.GetNumberOfTuples()));
    vtkIdType tuple = 0;
    for (double& value : copied.writable()) value = array.GetComponent(tuple++, index);
    values = std::move(copied);
  }
};

/// Returns which axes of a rectilinear grid have coordinates that descend.
std::array<bool, 3> descending_axes(const Volume::Description& grid) {
  std::array<bool, 3> descends{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<double>& places = grid.coordinates[axis];
    descends[axis] = places.size() > 1 && places.front() > places.back();
  }
  return descends;
}

void turn_coordinates(Volume::Description& grid, const std::array<bool, 3>& descends) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (descends[axis]) std::ranges::reverse(grid.coordinates[axis]);
  }
}

/// Returns the values in the other order along some axes.
VolumeData turned(const VolumeData& values, const std::array<int, 3>& sides,
                  const std::array<bool, 3>& backwards) {
  return std::visit(
      [&](const auto& given) -> VolumeData {
        using Value = std::decay_t<decltype(*given.begin())>;
        const auto side = [&](std::size_t axis) { return static_cast<std::size_t>(sides[axis]); };
        const auto place = [&](std::size_t axis, std::size_t i) {
          return backwards[axis] ? side(axis) - 1 - i : i;
        };
        DataArray<Value> made(side(0) * side(1) * side(2));
        auto to = made.writable().begin();
        for (std::size_t z = 0; z < side(2); ++z) {
          for (std::size_t y = 0; y < side(1); ++y) {
            const std::size_t row = (place(2, z) * side(1) + place(1, y)) * side(0);
            for (std::size_t x = 0; x < side(0); ++x, ++to) {
              *to = *(given.begin() + static_cast<std::ptrdiff_t>(row + place(0, x)));
            }
          }
        }
        return made;
      },
      values);
}

/// Returns the memory by which a changed array is known: of other layouts none.
const void* memory_of(vtkDataArray& array) {
  return array.HasStandardMemoryLayout() ? array.GetVoidPointer(0) : nullptr;
}

}  // namespace

Volume::Description grid_of(vtkDataSet& data, bool of_cells, const std::string& name) {
  Volume::Description grid;
  grid.name = name;
  grid.centering = of_cells ? Centering::cell : Centering::point;
  if (auto* const image = vtkImageData::SafeDownCast(&data)) {
    image->GetDimensions(grid.dimensions.data());
    grid.placement = placement_of(settings_of(*image), of_cells);
  } else if (auto* const rectilinear = vtkRectilinearGrid::SafeDownCast(&data)) {
    rectilinear->GetDimensions(grid.dimensions.data());
    grid.coordinates = {coordinates_of(rectilinear->GetXCoordinates()),
                        coordinates_of(rectilinear->GetYCoordinates()),
                        coordinates_of(rectilinear->GetZCoordinates())};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (grid.coordinates[axis].size() != static_cast<std::size_t>(grid.dimensions[axis])) {
        throw Error(name + ": has " + std::to_string(grid.coordinates[axis].size()) +
                    " coordinates for " + std::to_string(grid.dimensions[axis]) +
                    " points along an axis; give it as many");
      }
    }
  } else {
    throw Error(name + ": is a " + data.GetClassName() +
                "; the mapper takes a vtkImageData or a vtkRectilinearGrid");
  }
  for (int& side : grid.dimensions) {
    if (side < 2) {
      throw Error(name + ": has a single point along an axis; a volume needs two or more");
    }
    if (of_cells) --side;
  }
  return grid;
}

VolumeData component_of(vtkDataArray& array, int component) {
  if (array.GetNumberOfComponents() == 1 && array.HasStandardMemoryLayout()) {
    std::string rounded;
    return values_in_place(array, rounded);
  }
  Component chosen{component};
  using Layouts = vtkArrayDispatch::DispatchByArray<vtkTypeList::Create<
      vtkAOSDataArrayTemplate<float>, vtkAOSDataArrayTemplate<double>,
      vtkAOSDataArrayTemplate<char>, vtkAOSDataArrayTemplate<signed char>,
      vtkAOSDataArrayTemplate<unsigned char>, vtkAOSDataArrayTemplate<short>,
      vtkAOSDataArrayTemplate<unsigned short>, vtkAOSDataArrayTemplate<int>,
      vtkAOSDataArrayTemplate<unsigned int>, vtkSOADataArrayTemplate<float>,
      vtkSOADataArrayTemplate<double>, vtkSOADataArrayTemplate<char>,
      vtkSOADataArrayTemplate<signed char>, vtkSOADataArrayTemplate<unsigned char>,
      vtkSOADataArrayTemplate<short>, vtkSOADataArrayTemplate<unsigned short>,
      vtkSOADataArrayTemplate<int>, vtkSOADataArrayTemplate<unsigned int>>>;
  if (!Layouts::Execute(&array, chosen)) chosen.copy_slowly(array);
  return std::move(chosen.values);
}

std::uint64_t fingerprint_of(vtkDataArray& array, int component) {
  constexpr vtkIdType looked_at = 4096;
  const vtkIdType count = array.GetNumberOfTuples();
  const vtkIdType step = std::max<vtkIdType>(count / looked_at, 1);
  std::uint64_t state = 0xcbf29ce484222325U;  // FNV-1a, of 64 bits at a time
  for (vtkIdType tuple = 0; tuple < count; tuple += step) {
    // Another place in its step each time: data repeat along their axes.
    const vtkIdType place = std::min(tuple + (tuple / step * 7919) % step, count - 1);
    const auto bits = std::bit_cast<std::uint64_t>(array.GetComponent(place, component));
    state = (state ^ bits) * 0x100000001b3U;
    state ^= state >> 29;
  }
  return state;
}

bool KeptGrids::Recipe::operator==(const Recipe& other) const {
  return array == other.array && memory == other.memory && time == other.time &&
         fingerprint == other.fingerprint && values == other.values &&
         component == other.component && ghosts == other.ghosts && same_grid(grid, other.grid);
}

std::shared_ptr<const Volume> KeptGrids::find(vtkDataSet& data, vtkDataArray& array, bool of_cells,
                                              int component) {
  const char* const name = array.GetName();
  Volume::Description grid =
      grid_of(data, of_cells, name != nullptr && *name != '\0' ? name : data.GetClassName());
  const std::array<bool, 3> descends = descending_axes(grid);
  turn_coordinates(grid, descends);
  const Recipe recipe{&array,
                      memory_of(array),
                      array.GetMTime(),
                      fingerprint_of(array, component),
                      array.GetNumberOfValues(),
                      component,
                      ghost_times(data),
                      std::move(grid)};
  return kept_.find(recipe, [&](const Recipe& wanted) {
    VolumeData values = component_of(array, component);
    if (const std::vector<bool> hidden = hidden_places(data, of_cells); !hidden.empty()) {
      values = without_hidden(values, hidden);
    }
    if (descends != std::array<bool, 3>{}) {
      values = turned(values, wanted.grid.dimensions, descends);
    }
    return Volume(wanted.grid, std::move(values));
  });
}

}  // namespace pellucid::plugin
