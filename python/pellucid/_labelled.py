# SPDX-License-Identifier: Apache-2.0
"""Arrays whose axes have names and coordinates: xarray's, and variables of netCDF4."""
from __future__ import annotations

from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Tuple

import numpy

from . import _masks
from ._notes import tell
from ._pellucid import (Error, axis_roles, grows_downwards, space_axes, unit_factors,
                        unwrapped_longitudes)
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

    axes = [axis(each) for each in variable.dimensions]
    return _placed(_masks.as_array(variable, name), axes, name)


_Given = Tuple[str, Dict[str, str]]
"""An axis as the compiled part takes it: its name, and the attributes of its coordinate."""

_NO_PLACES = {"time": "time", "member": "members of an ensemble", "channel": "channels"}


def _given(axis: _Axis) -> _Given:
    texts = {str(key): value for key, value in axis.attributes.items() if isinstance(value, str)}
    if axis.positions is not None and _are_dates(axis.positions):
        texts["units"] = "days since 1970-01-01"
    return axis.name, texts


def _are_dates(positions: numpy.ndarray) -> bool:
    """Whether coordinates are dates or times, of numpy or of cftime."""
    if positions.dtype.kind == "O":
        return positions.size > 0 and hasattr(positions.flat[0], "timetuple")
    return positions.dtype.kind in "mM"


def _placed(array: numpy.ndarray, axes: List[_Axis], name: str) -> Placed:
    """Turns the axes to z, y, x by their meaning, by the rules of files, and places them."""
    if array.ndim < 3:
        three_axes(array, name)  # throws
    order = _order(array.shape, axes, name)
    if order is not None:
        rest = [a for a in range(array.ndim) if a not in order]
        array = array.transpose([*rest, *order])[(0,) * len(rest)]
        axes = [axes[a] for a in order]
    else:
        if array.ndim > 3:
            axes = [axis for axis, side in zip(axes, array.shape) if side != 1]
            array = array.squeeze()
        array = three_axes(array, name)
        tell(f"{name}: its axes {', '.join(axis.name for axis in axes)} are taken as z, y and x; "
             "transpose it if they are others")
    return Placed(array, coordinates=_positions(axes, name), name=name)


def _order(shape: Tuple[int, ...], axes: List[_Axis], name: str) -> Optional[Tuple[int, ...]]:
    """Which axes are z, y and x; None where nothing says what they are."""
    given = [_given(axis) for axis in axes]
    roles = axis_roles(given, shape)

    def refuse(axis: _Axis, what: str) -> None:
        raise Error(f"{name}: its axis \"{axis.name}\" is {what}; choose one, as in "
                    f"data.isel({axis.name}=0) or data[0], or give an array of numpy to take it "
                    "as a place")

    for axis, role, side in zip(axes, roles, shape):
        # Bands of an image are its slices.
        is_slice = role == "channel" and "z" not in roles
        if role in _NO_PLACES and side > 1 and not is_slice:
            refuse(axis, _NO_PLACES[role])
    # One time or member of several axes is no choice.
    kept = [a for a, role in enumerate(roles)
            if len(axes) <= 3 or shape[a] > 1 or role not in _NO_PLACES]
    try:
        found = space_axes([given[a] for a in kept], [shape[a] for a in kept])
    except Error as error:
        raise Error(f"{name}: is {error}") from None
    if found is None:
        return None
    order, notes = tuple(kept[a] for a in found[0]), found[1]
    for a, (axis, side) in enumerate(zip(axes, shape)):
        if side > 1 and a not in order:
            refuse(axis, _NO_PLACES.get(roles[a], "none of x, y and z"))
    for note in notes:
        tell(f"{name}: {note}")
    return order


def _positions(axes: List[_Axis], name: str) -> Tuple[Optional[numpy.ndarray], ...]:
    """The coordinates along z, y and x, in one unit and upwards; None where there are none."""
    given = [_given(axis) for axis in axes]
    factors, note = unit_factors(["" if axis.positions is None else texts.get("units", "")
                                   for axis, (_, texts) in zip(axes, given)])
    positions: List[Optional[numpy.ndarray]] = []
    for letter, axis, text, factor in zip("zyx", axes, given, factors):
        found = axis.positions
        if found is not None and found.dtype.kind not in "iuf":
            raise Error(f"{name}: the coordinates of its axis \"{axis.name}\" are no numbers; "
                        f"choose one of its entries, or drop them (drop_vars(\"{axis.name}\"))")
        if found is not None and numpy.ma.getmaskarray(found).any():
            raise Error(f"{name}: coordinates of its axis \"{axis.name}\" are missing; leave "
                        "those places out")
        if found is None:
            positions.append(None)
            continue
        found, down = numpy.ma.getdata(found), grows_downwards(text)
        if down == "down":
            found = -found if found.dtype.kind == "f" else -found.astype(numpy.float64)
            tell(f"{name}: {letter} is minus {axis.name} (positive: down)")
        elif down:
            tell(f"{name}: {letter} is {axis.name}, which grows downwards; the picture shows it "
                 "upwards")
        if letter == "x":
            going_on = unwrapped_longitudes(text[1].get("units", ""),
                                            found.astype(numpy.float64))
            if going_on is not None:
                kind = found.dtype if found.dtype.kind == "f" else numpy.dtype("f8")
                found = numpy.array(going_on, kind)
                tell(f"{name}: longitudes go on where they jump by 360 degrees")
        if factor != 1:
            kind = found.dtype if found.dtype.kind == "f" else numpy.dtype("f8")
            found = (found.astype(numpy.float64) * factor).astype(kind)
        positions.append(found)
    if note:
        tell(f"{name}: {note}")
    return tuple(positions)
