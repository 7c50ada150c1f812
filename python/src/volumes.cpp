// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "arrays.h"
#include "axes/array_axes.h"
#include "handles.h"
#include "pellucid/io/write_volume.h"
#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/derived_channels.h"
#include "volumes/volume_axes.h"

namespace pellucid::python {

namespace {

/// Reads three numbers in the order of an array's axes, (z, y, x), as x, y, z.
Vec3<double> from_zyx(const py::handle& object, const std::string& what) {
  const Vec3<double> v = vector_of(object, what);
  return {v.z, v.y, v.x};
}

/// Makes a volume of what pellucid._arrays.placed() found out about `data`.
VolumeHandle make_volume(const py::object& data, const py::object& spacing,
                         const py::object& origin, const py::object& direction,
                         const py::object& coordinates, const py::object& centering,
                         const py::object& name) {
  const py::object placed =
      py::module_::import("pellucid._arrays")
          .attr("placed")(data, spacing, origin, direction, coordinates, centering, name);
  const auto array = py::cast<py::array>(placed.attr("array"));
  Volume::Description description;
  description.name = py::cast<std::string>(placed.attr("name"));
  Notes notes;
  GridValues values = grid_values_of(array, description.name, notes);
  const Vec3<double> steps = vector_of(placed.attr("spacing"), "spacing");
  const std::array<double, 3> step{steps.x, steps.y, steps.z};
  const auto directions = doubles_of(placed.attr("direction"), 3, "direction");
  const auto axes = py::cast<py::tuple>(placed.attr("coordinates"));
  double* const spacing_of_grid[3] = {&description.placement.spacing.x,
                                      &description.placement.spacing.y,
                                      &description.placement.spacing.z};
  for (std::size_t g = 0; g < 3; ++g) {
    const std::size_t a = values.axes[g];
    const auto side = array.shape(static_cast<py::ssize_t>(a));
    if (side > std::numeric_limits<int>::max()) {
      throw Error(description.name + ": an axis has " + std::to_string(side) +
                  " values; at most 2147483647 are possible");
    }
    description.dimensions[g] = static_cast<int>(side);
    *spacing_of_grid[g] = step[a];
    const auto row = [&](py::ssize_t r) { return directions.at(r, static_cast<py::ssize_t>(a)); };
    description.placement.direction.column[g] = {row(2), row(1), row(0)};
  }
  description.placement.origin = from_zyx(placed.attr("origin"), "origin");
  description.centering = py::cast<std::string>(placed.attr("centering")) == "cell"
                              ? Centering::cell
                              : Centering::point;
  for (std::size_t g = 0; g < 3; ++g) {
    const py::object positions = axes[values.axes[g]];
    if (positions.is_none()) continue;
    const bool is_single = py::isinstance<py::array_t<float>>(positions);
    const auto list = doubles_of(positions, 0, "coordinates");
    place_axis(description, static_cast<int>(g),
               std::vector<double>(list.data(), list.data() + list.size()),
               is_single ? 0x1p-24 : 0x1p-53);
  }
  notes.warn();
  VolumeHandle handle;
  handle.axes = values.axes;
  const ReleasedLock released;
  handle.volume = std::make_shared<const Volume>(std::move(description), std::move(values.data));
  return handle;
}

/// Returns the volume's axis that is axis a of the array.
std::size_t grid_axis(const VolumeHandle& handle, std::size_t a) {
  return static_cast<std::size_t>(std::ranges::find(handle.axes, a) - handle.axes.begin());
}

}  // namespace

VolumeHandle in_order_of(const VolumeHandle& like, const VolumeHandle& volume) {
  if (volume.axes == like.axes) return volume;
  const Volume::Description& from = volume.volume->description();
  const double* const spacing[3] = {&from.placement.spacing.x, &from.placement.spacing.y,
                                    &from.placement.spacing.z};
  Volume::Description to = from;
  double* const new_spacing[3] = {&to.placement.spacing.x, &to.placement.spacing.y,
                                  &to.placement.spacing.z};
  const std::array<std::size_t, 3> steps{
      1, static_cast<std::size_t>(from.dimensions[0]),
      static_cast<std::size_t>(from.dimensions[0]) * static_cast<std::size_t>(from.dimensions[1])};
  std::array<std::int64_t, 3> sides{};
  std::array<std::size_t, 3> strides{};
  for (std::size_t g = 0; g < 3; ++g) {
    const std::size_t old = grid_axis(volume, like.axes[g]);
    to.dimensions[g] = from.dimensions[old];
    to.coordinates[g] = from.coordinates[old];
    to.placement.direction.column[g] = from.placement.direction.column[old];
    *new_spacing[g] = *spacing[old];
    sides[g] = from.dimensions[old];
    strides[g] = steps[old];
  }
  const ReleasedLock released;
  VolumeData data = std::visit(
      [&](const auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        std::vector<Value> copy(values.size());
        copy_permuted(reinterpret_cast<const std::byte*>(values.data()),
                      reinterpret_cast<std::byte*>(copy.data()), sizeof(Value), sides, strides);
        return VolumeData(DataArray<Value>(std::move(copy)));
      },
      volume.volume->data());
  return {std::make_shared<const Volume>(std::move(to), std::move(data)), like.axes, volume.source};
}

namespace {

py::tuple shape_of(const VolumeHandle& handle) {
  const auto& sides = handle.volume->description().dimensions;
  return py::make_tuple(sides[grid_axis(handle, 0)], sides[grid_axis(handle, 1)],
                        sides[grid_axis(handle, 2)]);
}

py::tuple spacing_of(const VolumeHandle& handle) {
  const Vec3<double>& s = handle.volume->description().placement.spacing;
  const std::array<double, 3> spacing{s.x, s.y, s.z};
  return py::make_tuple(spacing[grid_axis(handle, 0)], spacing[grid_axis(handle, 1)],
                        spacing[grid_axis(handle, 2)]);
}

py::array direction_of(const VolumeHandle& handle) {
  py::array_t<double> direction({3, 3});
  auto rows = direction.mutable_unchecked<2>();
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3<double>& c =
        handle.volume->description().placement.direction.column[grid_axis(handle, a)];
    const auto column = static_cast<py::ssize_t>(a);
    rows(0, column) = c.z;
    rows(1, column) = c.y;
    rows(2, column) = c.x;
  }
  return direction;
}

py::tuple coordinates_of(const VolumeHandle& handle) {
  py::tuple result(3);
  for (std::size_t a = 0; a < 3; ++a) {
    const auto& list = handle.volume->description().coordinates[grid_axis(handle, a)];
    result[a] =
        list.empty()
            ? py::object(py::none())
            : py::object(py::array_t<double>(static_cast<py::ssize_t>(list.size()), list.data()));
  }
  return result;
}

py::array array_of(const VolumeHandle& handle, const py::handle& owner) {
  const auto& sides = handle.volume->description().dimensions;
  const py::array memory = view_of(handle.volume->data(), {sides[2], sides[1], sides[0]}, owner);
  // Axis a of the array is grid axis g, which is axis 2 - g of the memory.
  return memory.attr("transpose")(2 - grid_axis(handle, 0), 2 - grid_axis(handle, 1),
                                  2 - grid_axis(handle, 2));
}

py::dict statistics_of(const VolumeStatistics& s) {
  py::dict result;
  result["minimum"] = s.minimum;
  result["maximum"] = s.maximum;
  result["finite"] = s.finite;
  result["nan"] = s.nan;
  return result;
}

template <class Derive>
VolumeHandle derived(const VolumeHandle& handle, Derive&& derive) {
  const ReleasedLock released;
  return {std::make_shared<const Volume>(derive(*handle.volume)), handle.axes, {}};
}

std::string volume_repr(const VolumeHandle& handle) {
  const Volume& volume = *handle.volume;
  return "<pellucid.Volume " + py::cast<std::string>(py::str(py::object(shape_of(handle)))) + " " +
         std::string(type_name(volume.data())) +
         (volume.description().centering == Centering::cell ? ", cell-centered" : "") + ", \"" +
         volume.description().name + "\">";
}

}  // namespace

void bind_volumes(py::module_& module) {
  py::class_<VolumeHandle>(module, "Volume", R"(
A scalar field on a structured grid. Immutable.

    Volume(data, spacing=None, origin=None, direction=None, coordinates=None,
           centering=None, name=None)

data        anything with three axes (z, y, x): a numpy array of any number type, byte order and
            memory order; a masked array (masked values are vacuum); an object with
            __array_interface__, __array__, __dlpack__ or a buffer; an image of nibabel, ITK or
            SimpleITK, an xarray.DataArray, a vtkImageData or vtkRectilinearGrid, which bring
            their own places
spacing     distance between values along (z, y, x), world units, > 0; one number for all three
origin      world position of data[0, 0, 0], as (z, y, x)
direction   3 x 3: column a is the direction of axis a, as (z, y, x); need not be orthogonal
coordinates positions of the values along (z, y, x) of a rectilinear grid, or None for an axis
            with a spacing; cell-centered: of the cell faces, one more than values
centering   "point" (values at grid points, linear between) or "cell"
name        begins error messages

    position (z, y, x) = origin + direction @ (spacing * index)

Memory that is dense in any order of the axes (C, Fortran, transposed) is not copied: it stays
alive as long as the volume, is never written to, and must not change. Other memory, the other
byte order, float16 and integers of 64 bits are copied once. NaN is vacuum.

Raises Error for other types, shapes that do not agree, a spacing that is not positive, a
singular direction, infinite values and values beyond 2.1e37.)")
      .def(py::init(&make_volume), py::arg("data"), py::arg("spacing") = py::none(),
           py::arg("origin") = py::none(), py::arg("direction") = py::none(),
           py::arg("coordinates") = py::none(), py::arg("centering") = py::none(),
           py::arg("name") = py::none())
      .def_property_readonly("shape", &shape_of, "Number of values along (z, y, x).")
      .def_property_readonly(
          "array",
          [](const py::object& self) {
            return array_of(py::cast<const VolumeHandle&>(self), self);
          },
          "The values as a read-only array (z, y, x), without a copy.")
      .def(
          "__array__",
          [](const py::object& self, const py::object& type, const py::object& copy) {
            return array_as(array_of(py::cast<const VolumeHandle&>(self), self), type, copy);
          },
          py::arg("dtype") = py::none(), py::arg("copy") = py::none())
      .def_property_readonly("spacing", &spacing_of, "Along (z, y, x), in world units.")
      .def_property_readonly(
          "origin",
          [](const VolumeHandle& handle) {
            const auto& o = handle.volume->description().placement.origin;
            return py::make_tuple(o.z, o.y, o.x);
          },
          "World position of the first value, as (z, y, x).")
      .def_property_readonly("direction", &direction_of,
                             "Directions of the axes (z, y, x) in columns, as (z, y, x).")
      .def_property_readonly(
          "coordinates", &coordinates_of,
          "Positions along the directions of the axes (z, y, x); None for axes with a "
          "spacing. Descending ones come back negated, their direction turned.")
      .def_property_readonly(
          "centering",
          [](const VolumeHandle& handle) {
            return handle.volume->description().centering == Centering::cell ? "cell" : "point";
          },
          "\"point\" or \"cell\".")
      .def_property_readonly(
          "name", [](const VolumeHandle& h) { return h.volume->description().name; },
          "Begins error messages.")
      .def_property_readonly(
          "type", [](const VolumeHandle& h) { return std::string(type_name(h.volume->data())); },
          "\"u8\", \"i8\", \"u16\", \"i16\", \"u32\", \"i32\", \"f32\" or \"f64\".")
      .def_property_readonly(
          "statistics", [](const VolumeHandle& h) { return statistics_of(h.volume->statistics()); },
          "minimum and maximum of the finite values, and the counts finite and nan.")
      .def_property_readonly(
          "voxel_size", [](const VolumeHandle& h) { return h.volume->voxel_size(); },
          "Shortest edge of a cell, in world units.")
      .def_property_readonly(
          "corners",
          [](const VolumeHandle& h) {
            py::list list;
            for (const Vec3<double>& c : h.volume->world_corners()) {
              list.append(to_tuple(c));
            }
            return list;
          },
          "The eight corners of the grid's box, as world positions (x, y, z).")
      .def(
          "gradient_magnitude",
          [](const VolumeHandle& h) {
            return derived(h, [](const Volume& v) { return gradient_magnitude(v, all_cores()); });
          },
          "Returns the length of the gradient, in data units per world length.")
      .def(
          "second_derivative",
          [](const VolumeHandle& h) {
            return derived(h, [](const Volume& v) { return second_derivative(v, all_cores()); });
          },
          "Returns the second derivative along the gradient.")
      .def(
          "smoothed",
          [](const VolumeHandle& h, double sigma) {
            return derived(h, [&](const Volume& v) { return smoothed(v, sigma, all_cores()); });
          },
          py::arg("sigma"),
          "Returns the data convolved with a Gaussian of standard deviation sigma, world units.")
      .def(
          "write",
          [](const VolumeHandle& h, const std::filesystem::path& path, const std::string& array) {
            std::vector<std::string> texts;
            {
              const ReleasedLock released;
              texts = write_volume(std::span(h.volume.get(), 1), path, array);
            }
            Notes notes;
            for (const std::string& text : texts) notes(text);
            notes.warn();
          },
          py::arg("path"), py::arg("array") = "values", R"(
Writes the volume: .nrrd, .nii, .nii.gz, .vti or .raw. `array` names the values in a .vti.
Warns of what the format cannot hold. Raises Error if the file cannot be written.)")
      .def("__repr__", &volume_repr);

  py::class_<ChannelsHandle>(module, "Channels", R"(
One to eight variables on one grid. Immutable.

    Channels(t1=volume_or_array, t2=..., ...)
    Channels({"t1": volume_or_array, ...}, units={"t1": "ms"})

Values are volumes or what Volume() takes. A cell with a NaN corner in any channel is vacuum.
Those in another memory order than the first are copied. Raises Error if the grids differ.)")
      .def(py::init([](const py::dict& volumes, const py::dict& units, const py::kwargs& more) {
             std::vector<Channel> channels;
             std::vector<ChannelSource> sources;
             std::vector<std::array<std::size_t, 3>> axes;
             const py::object make = py::type::of<VolumeHandle>();
             for (const py::dict* part : {&volumes, static_cast<const py::dict*>(&more)}) {
               for (const auto& [name, data] : *part) {
                 const py::object volume = py::isinstance<VolumeHandle>(data)
                                               ? py::reinterpret_borrow<py::object>(data)
                                               : make(data, py::arg("name") = name);
                 std::string unit;
                 if (units.contains(name)) unit = py::cast<std::string>(units[name]);
                 const VolumeHandle handle =
                     channels.empty() ? py::cast<VolumeHandle>(volume)
                                      : in_order_of({nullptr, axes.front()},
                                                    py::cast<const VolumeHandle&>(volume));
                 channels.push_back({py::cast<std::string>(name), unit, handle.volume});
                 axes.push_back(handle.axes);
                 if (handle.source) sources.push_back({channels.back().name, unit, *handle.source});
               }
             }
             if (sources.size() < channels.size()) sources.clear();
             return ChannelsHandle{std::make_shared<const Channels>(std::move(channels)),
                                   std::move(axes), std::move(sources)};
           }),
           py::arg("volumes") = py::dict(), py::arg("units") = py::dict())
      .def_property_readonly("names",
                             [](const ChannelsHandle& h) {
                               std::vector<std::string> names;
                               for (const Channel& c : *h.channels) names.push_back(c.name);
                               return names;
                             })
      .def("__len__", [](const ChannelsHandle& h) { return h.channels->count(); })
      .def("__getitem__",
           [](const ChannelsHandle& h, const std::string& name) {
             const auto index = h.channels->find(name);
             if (!index) throw py::key_error(name);
             return VolumeHandle{
                 (*h.channels)[*index].volume, h.axes[static_cast<std::size_t>(*index)], {}};
           })
      .def("__repr__", [](const ChannelsHandle& h) {
        std::string text = "<pellucid.Channels";
        for (const Channel& c : *h.channels) text += " " + c.name;
        return text + ">";
      });

  module.def(
      "builtin_field",
      [](const std::string& name, int points) {
        FieldSource source;
        source.builtin = name;
        source.points = points;
        const ReleasedLock released;
        return VolumeHandle{
            std::make_shared<const Volume>(make_builtin_field(name, points)), {2, 1, 0}, source};
      },
      py::arg("name"), py::arg("points") = 128, R"(
Returns a field that needs no file: floats at points^3 positions of the box [-1, 1]^3.
Names: marschner_lobb, hydrogen, shells, sphere, ramp, constant. Raises Error for others.)");
}

}  // namespace pellucid::python
