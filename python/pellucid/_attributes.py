# SPDX-License-Identifier: Apache-2.0
"""Numbers as the attributes of their array mean them, after the conventions of NetCDF (CF).

Libraries apply these when they open a file, unless they are told not to, and h5py and zarr never
do. Attributes that are still there are applied, and told.
"""
from __future__ import annotations

from typing import Any, List, Mapping, NamedTuple, Optional, Tuple

import numpy

from ._notes import tell
from ._pellucid import other_conventions


def scaled(stored: numpy.ndarray, slope: float, intercept: float) -> numpy.ndarray:
    """Returns slope * stored + intercept as our readers do: in f32 from 16 bits and less."""
    if (slope == 1 and intercept == 0) or stored.dtype.kind not in "biuf":
        return stored
    narrow = stored.dtype.itemsize <= 2 or stored.dtype.name == "float32"
    return (slope * stored.astype(numpy.float64) + intercept).astype(
        numpy.float32 if narrow else numpy.float64)


# What NetCDF has where nothing was written, by type; bytes have no such value.
_NEVER_WRITTEN = (9.969209968386869e36, -32767, 65535, -2147483647, 4294967295,
                  -9223372036854775806, 18446744073709551614)


class _Scale(NamedTuple):
    slope: float
    intercept: float
    is_applied: bool
    """Whether the values are scaled already, as those that xarray decodes."""


def applied(stored: numpy.ndarray, data: Any, name: str) -> numpy.ndarray:
    """Returns stored values of `data` as its attributes mean them: scaled, and masked."""
    if stored.dtype.kind not in "iuf":
        return stored
    attributes, fill = _attributes_of(data)
    told = []
    missing, values = numpy.ma.getmaskarray(stored), numpy.ma.getdata(stored)
    wrap = 0
    for said, kind, meant in (("true", "i", "u"), ("false", "u", "i")):
        if str(attributes.get("_Unsigned", "")).lower() == said and values.dtype.kind == kind:
            wrap = 2 ** (8 * values.dtype.itemsize)
            values = values.view(values.dtype.str.replace(kind, meant))
            told.append("_Unsigned")
            break
    scale = _scale_of(attributes, getattr(data, "encoding", None) or {})
    masks = [(key, _equal(values, number, wrap)) for key in ("_FillValue", "missing_value")
             for number in _numbers(attributes, key)]
    masks += [("a valid range", outside) for outside in _outside(values, attributes, scale, wrap)]
    for key, mask in masks:
        if (mask & ~missing).any():
            missing = missing | mask
            told.append(key)
    if not scale.is_applied and (scale.slope, scale.intercept) != (1, 0):
        values = scaled(values, scale.slope, scale.intercept)
        told.append("scale_factor and add_offset")
    if fill is not None and (_equal(values, fill, 0) & ~missing).any():
        tell(f"{name}: values that are its fill value, {fill}, are shown; mask them if they are "
             "missing")
    if not told:
        return stored
    tell(f"{name}: its attributes say {', '.join(dict.fromkeys(told))}: applied; give its values "
         "as an array of numpy to leave that out")
    return numpy.ma.MaskedArray(values, missing)


# What each attribute must be to be applied.
_KINDS = {"scale_factor": (1, "number"), "add_offset": (1, "number"),
          "_FillValue": (0, "number"), "missing_value": (0, "number"),
          "valid_range": (2, "pair of numbers"), "valid_min": (1, "number"),
          "valid_max": (1, "number")}


def tell_unapplied(data: Any, name: str) -> None:
    """Tells which attributes of `data` could change its values or its place, and do not."""
    attributes = getattr(data, "attrs", None)
    if callable(getattr(data, "ncattrs", None)):
        attributes = {key: data.getncattr(key) for key in data.ncattrs()}
    if attributes is None or not hasattr(attributes, "keys"):
        return
    for key, (count, what) in _KINDS.items():
        if key in attributes and not _is_usable(attributes, key, count):
            tell(f"{name}: its {key} is no {what} and is not applied")
    if any(key in attributes for key in ("flag_values", "flag_meanings", "flag_masks")):
        tell(f"{name}: its values are labels (flag_values) and no amounts")
    unread = other_conventions([str(key).encode("utf-8", "replace").decode()
                                for key in attributes.keys() if key not in _KINDS])
    if unread:
        tell(f"{name}: has attributes that are not applied ({', '.join(unread)})")


def _is_usable(attributes: Mapping[str, Any], key: str, count: int) -> bool:
    numbers = _numbers(attributes, key)
    if key in ("_FillValue", "missing_value"):
        return bool(numbers)
    if key in ("scale_factor", "add_offset"):
        return len(numbers) == count and bool(numpy.isfinite(numbers[0]))
    return len(numbers) == count and not any(numpy.isnan(number) for number in numbers)


def _usable(attributes: Mapping[str, Any], key: str) -> List[Any]:
    """The numbers of an attribute that can be applied; else none."""
    return _numbers(attributes, key) if _is_usable(attributes, key, _KINDS[key][0]) else []


def _attributes_of(data: Any) -> Tuple[Mapping[str, Any], Optional[Any]]:
    """The attributes of data, and a fill value that need not mean missing values."""
    attributes = getattr(data, "attrs", None)
    if attributes is None or not hasattr(attributes, "keys"):
        return {}, None
    found = dict(attributes)
    fill = getattr(data, "fillvalue", getattr(data, "fill_value", None))  # of h5py, of zarr
    is_number = numpy.ndim(fill) == 0 and numpy.asarray(fill).dtype.kind in "iuf"
    if not is_number or "_FillValue" in found:
        return found, None
    # xarray marks its stores of Zarr so, where the fill value is its _FillValue.
    if "_ARRAY_DIMENSIONS" in found or fill in _NEVER_WRITTEN:
        return {**found, "_FillValue": fill}, None
    return found, fill if fill != 0 else None


def _numbers(attributes: Mapping[str, Any], key: str) -> List[Any]:
    """The numbers of an attribute; none where it is missing, or text."""
    found = attributes.get(key)
    if found is None or isinstance(found, (str, bytes)):
        return []
    numbers = numpy.atleast_1d(numpy.asarray(found))
    return list(numbers) if numbers.dtype.kind in "iuf" else []


def _scale_of(attributes: Mapping[str, Any], encoding: Mapping[str, Any]) -> _Scale:
    keys = ("scale_factor", "add_offset")
    is_applied = not any(_usable(attributes, key) for key in keys)
    slope, intercept = (_usable(encoding if is_applied else attributes, key) for key in keys)
    return _Scale(float((slope or [1])[0]), float((intercept or [0])[0]), is_applied)


def _wrapped(number: int, kind: numpy.dtype, wrap: int) -> int:
    """A whole number with the sign that its type is meant to have: 255 of -1."""
    least = int(numpy.iinfo(kind).min)
    return (number - least) % wrap + least if wrap > 0 else number


def _equal(values: numpy.ndarray, number: Any, wrap: int) -> numpy.ndarray:
    """Which values are a marker, which is written in their type or in a wider one."""
    if values.dtype.kind == "f":
        return values == values.dtype.type(number)
    if numpy.isfinite(number) and number == int(number):
        whole, limits = _wrapped(int(number), values.dtype, wrap), numpy.iinfo(values.dtype)
        if limits.min <= whole <= limits.max:
            return values == values.dtype.type(whole)
    return numpy.zeros(values.shape, dtype=bool)


def _outside(values: numpy.ndarray, attributes: Mapping[str, Any], scale: _Scale,
             wrap: int) -> List[numpy.ndarray]:
    """Which values are below the least valid one, and which above the largest."""
    both = _usable(attributes, "valid_range")
    lower: Optional[Any] = (both or _usable(attributes, "valid_min") or [None])[0]
    upper: Optional[Any] = (both[1:] or _usable(attributes, "valid_max") or [None])[0]
    found = []
    for bound, sign in ((lower, 1), (upper, -1)):
        if bound is None or scale.slope == 0:
            continue
        number, slack, turn = _own_bound(bound, scale, values.dtype, wrap)
        found.append(sign * turn * (values.astype(numpy.float64) - number) < -slack)
    return found


def _own_bound(bound: Any, scale: _Scale, kind: numpy.dtype,
               wrap: int) -> Tuple[float, float, int]:
    """A bound among the values as they are, its rounding there, and -1 where scales turn it round.

    Bounds are whole numbers where they mean packed values, and else mean scaled ones.
    """
    is_packed = isinstance(bound, numpy.integer)
    number = float(_wrapped(int(bound), kind, wrap) if is_packed and kind.kind in "iu" else bound)
    slope, intercept, is_applied = scale
    if (slope, intercept) == (1, 0) or is_packed != is_applied:
        return number, 0.0, 1
    rounding, turn = 1e-6, 1 if slope > 0 else -1
    if is_packed:
        number *= slope
        return number + intercept, rounding * (abs(number) + abs(intercept)), turn
    return ((number - intercept) / slope,
            rounding * (abs(number) + abs(intercept)) / abs(slope), turn)
