# SPDX-License-Identifier: Apache-2.0
"""Arrays whose axes have names and coordinates: xarray's, and variables of netCDF4."""
from __future__ import annotations

from typing import Any, List, Mapping, NamedTuple, Optional, Tuple

import numpy

from . import _masks
from ._notes import tell
from ._pellucid import Error
from ._places import Placed, three_axes


class _Axis(NamedTuple):
    name: str
    positions: Optional[numpy.ndarray]
    """Its coordinates as they are, of any type; None: it has none."""
    attributes: Mapping[str, Any]


def of_xarray(data: Any) -> Placed:
    """Returns the array of an xarray.DataArray, placed by its coordinates."""
    name = str(getattr(data, "name", None) or "xarray")
    if hasattr(data, "data_vars"):
        raise Error(f"{name}: is a Dataset; choose one variable, as in data[\"density\"], or give "
                    "several as Channels")
    if len(data.dims) > 3:
        data = data.squeeze()

    def axis(dimension: Any) -> _Axis:
        if dimension not in data.coords:
            return _Axis(str(dimension), None, {})
        coordinate = data.coords[dimension]
        return _Axis(str(dimension), _masks.with_mask(coordinate, str(dimension)),
                     coordinate.attrs)

    wide = [str(key) for key, each in data.coords.items()
            if each.ndim > 1 and set(each.dims) <= set(data.dims)]
    if wide:
        tell(f"{name}: its coordinates {', '.join(wide)}, which change along several axes, are "
             "left out")
    return _placed(_masks.as_array(data, name), [axis(each) for each in data.dims], name)


def is_netcdf4(data: Any) -> bool:
    """Whether data looks like a variable of the library netCDF4."""
    return all(hasattr(data, each) for each in ("dimensions", "group", "ncattrs", "__array__"))


def of_netcdf4(variable: Any) -> Placed:
    """Returns the array of a variable of netCDF4, placed by its coordinate variables."""
    name = str(variable.name)

    def axis(dimension: str) -> _Axis:
        group = variable.group()
        while group is not None and dimension not in group.variables:
            group = group.parent
        found = None if group is None else group.variables[dimension]
        if found is None or found.dimensions != (dimension,):
            return _Axis(dimension, None, {})
        return _Axis(dimension, found[...], {key: found.getncattr(key) for key in found.ncattrs()})

    axes, array = [axis(each) for each in variable.dimensions], _masks.as_array(variable, name)
    if array.ndim > 3:
        kept = [a for a, side in enumerate(array.shape) if side != 1]
        axes, array = [axes[a] for a in kept], array.squeeze()
    return _placed(array, axes, name)


def _is_time(axis: _Axis) -> bool:
    kind = "" if axis.positions is None else axis.positions.dtype.kind
    units = str(axis.attributes.get("units", ""))
    return (kind in ("m", "M") or " since " in units
            or axis.attributes.get("axis") == "T"
            or axis.attributes.get("standard_name") == "time"
            or axis.name.lower() in ("time", "t"))


def _placed(array: numpy.ndarray, axes: List[_Axis], name: str) -> Placed:
    for axis in axes:
        if _is_time(axis):
            raise Error(f"{name}: its axis \"{axis.name}\" is time; choose one, as in "
                        f"data.isel({axis.name}=0) or data[0], or give an array of numpy to take "
                        "it as a place")
    array = three_axes(array, name)
    names = [axis.name for axis in axes]
    if set(names) == {"x", "y", "z"}:
        order = [names.index(letter) for letter in "zyx"]
        array, axes = array.transpose(order), [axes[a] for a in order]
    elif not _is_known_order(names):
        tell(f"{name}: its axes {', '.join(names)} are taken as z, y and x; transpose it if they "
             "are others")
    for axis in axes:
        if str(axis.attributes.get("positive", "")).lower() == "down":
            tell(f"{name}: its axis \"{axis.name}\" is positive down, and is taken as one that "
                 "goes up; negate its coordinates to turn it")
    return Placed(array, coordinates=_positions(axes, name), name=name)


def _is_known_order(names: List[str]) -> bool:
    """Whether the last two axes are named as y and x are in maps, and the first is neither."""
    maps = (("y", "x"), ("lat", "lon"), ("latitude", "longitude"))
    first, *last = (each.lower() for each in names)
    return tuple(last) in maps and not any(first in each for each in maps)


def _positions(axes: List[_Axis], name: str) -> Tuple[Optional[numpy.ndarray], ...]:
    """The coordinates along each axis; None where there are none."""
    positions = []
    for axis in axes:
        found = axis.positions
        if found is not None and found.dtype.kind not in "iuf":
            raise Error(f"{name}: the coordinates of its axis \"{axis.name}\" are no numbers; "
                        f"choose one of its entries, or drop them (drop_vars(\"{axis.name}\"))")
        if found is not None and numpy.ma.getmaskarray(found).any():
            raise Error(f"{name}: coordinates of its axis \"{axis.name}\" are missing; leave "
                        "those places out")
        positions.append(None if found is None else numpy.ma.getdata(found))
    return tuple(positions)
