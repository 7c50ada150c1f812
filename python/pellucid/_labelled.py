# SPDX-License-Identifier: Apache-2.0
"""Arrays whose axes have names and coordinates: of xarray, netCDF4, h5py and zarr."""
from __future__ import annotations

import json
from contextlib import contextmanager
from typing import Any, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Set, Tuple

import numpy

from . import _masks
from ._notes import tell
from ._pellucid import (Error, axis_roles, grows_downwards, other_conventions, space_axes,
                        unit_factors, unwrapped_longitudes)
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
    own = {str(key): each for key, each in data.coords.items()
           if key in data.dims or each.dtype.kind in "iufmM"}
    dims = {key: [str(dim) for dim in each.dims] for key, each in own.items()}

    def axis(dimension: str) -> _Axis:
        along = _along(dimension, dims, name)
        if along is None:
            return _Axis(dimension, None, {})
        return _Axis(dimension, _masks.with_mask(own[along], along), own[along].attrs)

    _tell_wide(name, dims)
    return _placed(_masks.as_array(data, name), [axis(str(each)) for each in data.dims], name)


def _along(dimension: str, dims: Mapping[str, Sequence[str]], name: str) -> Optional[str]:
    """The coordinate with the positions of an axis: that of its name, or one along it alone."""
    others = [key for key, own in dims.items() if list(own) == [dimension] and key != dimension]
    if list(dims.get(dimension, ())) == [dimension]:
        if others:
            tell(f"{name}: its coordinates {', '.join(others)} along {dimension} are left out; "
                 f"{dimension} itself has positions")
        return dimension
    if len(others) > 1:
        tell(f"{name}: its coordinates {', '.join(others)} are all along {dimension} and are left "
             "out; give the positions as coordinates")
    return others[0] if len(others) == 1 else None


def _tell_wide(name: str, dims: Mapping[str, Sequence[str]]) -> None:
    """Tells of coordinates that change along several axes."""
    wide = [key for key, own in dims.items() if len(own) > 1]
    if wide:
        tell(f"{name}: its coordinates {', '.join(wide)}, which change along several axes, are "
             "left out")


def is_netcdf4(data: Any) -> bool:
    """Whether data looks like a variable of the library netCDF4."""
    return all(hasattr(data, each) for each in ("dimensions", "group", "ncattrs", "__array__"))


@contextmanager
def _decoding(variable: Any) -> Iterator[bool]:
    """Lets a variable of netCDF4 mask and scale its values; yields whether it was told not to."""
    masks, scales = getattr(variable, "mask", True), getattr(variable, "scale", True)
    if masks and scales:
        yield False
        return
    variable.set_auto_maskandscale(True)
    try:
        yield True
    finally:
        variable.set_auto_mask(masks)
        variable.set_auto_scale(scales)


def of_netcdf4(variable: Any) -> Placed:
    """Returns the array of a variable of netCDF4, placed by its coordinate variables."""
    name = str(variable.name)

    def found(wanted: str) -> Any:
        group = variable.group()
        while group is not None and wanted not in group.variables:
            group = group.parent
        return None if group is None else group.variables[wanted]

    named = str(variable.getncattr("coordinates")) if "coordinates" in variable.ncattrs() else ""
    own = {each: found(each) for each in (*variable.dimensions, *named.split())}
    dims = {key: list(each.dimensions) for key, each in own.items()
            if each is not None and (key in variable.dimensions
                                     or getattr(each.dtype, "kind", "S") in "iuf")}

    def axis(dimension: str) -> _Axis:
        along = _along(dimension, dims, name)
        if along is None:
            return _Axis(dimension, None, {})
        with _decoding(own[along]):
            positions = own[along][...]
        return _Axis(dimension, positions,
                     {key: own[along].getncattr(key) for key in own[along].ncattrs()})

    axes = [axis(each) for each in variable.dimensions]
    _tell_wide(name, dims)
    with _decoding(variable) as is_raw:
        if is_raw:
            tell(f"{name}: its values are masked and scaled as its attributes say, though it is "
                 "told not to do so by itself; give variable[...] to leave that out")
        array = _masks.as_array(variable, name)
    return _placed(array, axes, name)


def is_hdf5(data: Any) -> bool:
    """Whether data looks like a dataset of h5py, of a file that is open."""
    names = ("dims", "attrs", "file", "parent", "fillvalue")
    return all(hasattr(type(data), each) for each in names) and bool(data)


def of_hdf5(data: Any, name: str) -> Optional[Placed]:
    """Returns the array of a dataset of h5py, placed by labels and scales; None: it has none."""
    tags = _axis_tags(data.attrs.get("axistags"))
    scales = {data.name}

    def axis(number: int) -> _Axis:
        own = data.dims[number]
        label = tags[number] if len(tags) == data.ndim else str(own.label or "")
        if len(own) == 0:
            return _Axis(label, None, {})
        scale = own[0]
        scales.add(scale.name)
        texts = {key: _text(value) for key, value in scale.attrs.items()
                 if isinstance(value, (str, bytes))}
        is_bare = texts.get("NAME", "").startswith("This is a netCDF dimension but not a netCDF")
        positions = None
        if scale.shape == (data.shape[number],) and not is_bare:
            positions = _masks.with_mask(scale, str(scale.name))
        return _Axis(label or str(scale.name).rpartition("/")[2], positions, texts)

    axes = [axis(number) for number in range(data.ndim)]
    _tell_beside(data, scales, name)
    if not any(each.name for each in axes):
        return None
    return _placed(_masks.as_array(data, name), axes, name)


def _text(value: Any) -> str:
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def _axis_tags(tags: Any) -> List[str]:
    """The keys of ilastik's and vigra's axis tags; none where there are none."""
    if tags is None:
        return []
    try:
        return [str(each["key"]) for each in json.loads(_text(tags))["axes"]]
    except (ValueError, KeyError, TypeError):
        return []


def _tell_beside(data: Any, known: Set[str], name: str) -> None:
    """Tells of datasets beside one of h5py that may place it, as those of a file do."""
    beside = []
    group = data.parent
    while group is not None:
        for key in list(group.keys())[:4096]:
            if type(group.get(key, getlink=True)).__name__ != "HardLink":
                continue
            other = group[key]
            if not hasattr(other, "shape") or other.shape is None or other.name in known:
                continue
            is_along = key.lower() in ("x", "y", "z") and other.shape in [(n,) for n in data.shape]
            is_small = numpy.prod(other.shape, dtype=float) <= 64
            if is_along or (is_small and other_conventions([key])):
                beside.append(key)
        group = None if group.name == "/" else group.parent
    if beside:
        tell(f"{name}: beside it stand {', '.join(dict.fromkeys(beside))}, which are not read; "
             "give the file's path, or spacing, origin and direction")


def is_zarr(data: Any) -> bool:
    """Whether data looks like an array of zarr."""
    return all(hasattr(data, each) for each in ("attrs", "chunks", "store", "fill_value", "shape"))


def of_zarr(data: Any, name: str) -> Optional[Placed]:
    """Returns the array of an array of zarr by the names of its axes; None: it has none."""
    names = getattr(getattr(data, "metadata", None), "dimension_names", None)
    names = names or data.attrs.get("_ARRAY_DIMENSIONS")
    if not names or isinstance(names, str):
        return None
    if len(names) != len(data.shape):
        tell(f"{name}: has {len(names)} names of axes (_ARRAY_DIMENSIONS), but {len(data.shape)} "
             "axes; they are left out")
        return None
    axes = [_Axis("" if each is None else str(each), None, {}) for each in names]
    placed = _placed(_masks.as_array(data, name), axes, name)
    tell(f"{name}: coordinates of its axes {', '.join(axis.name for axis in axes)}, which its "
         "store may have, are not read; give the store's path, or spacing and origin")
    return placed


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
