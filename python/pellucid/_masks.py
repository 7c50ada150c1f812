# SPDX-License-Identifier: Apache-2.0
"""Numbers behind objects that hold them, with what is missing as NaN.

Masks hide in what other libraries return: numpy.asanyarray() of a variable of netCDF4 or of an
array of dask has a mask, and a list of masked slices loses it. Files that are opened without
decoding say in attributes which values are missing, and how they are scaled.
"""
from __future__ import annotations

from typing import Any

import numpy

from . import _attributes
from ._notes import tell
from ._pellucid import Error

# Integers up to here are exact in f64.
_EXACT = 2 ** 53


def as_array(data: Any, name: str) -> numpy.ndarray:
    """Returns data as a numpy array, without a copy where that is possible. Missing is NaN."""
    if data is None or isinstance(data, (str, bytes, dict, set)):
        raise Error(f"{name}: expected an array, got {data!r:.60}")
    try:
        _attributes.tell_unapplied(data, name)
        array = with_mask(data, name)
    except (Error, MemoryError):
        raise
    except Exception as failure:  # whatever another library raises
        reason = (str(failure).splitlines() or [type(failure).__name__])[0]
        raise Error(f"{name}: expected an array, got {type(data).__name__} ({reason})") from None
    return _unmasked(array, name)


def with_mask(data: Any, name: str) -> numpy.ndarray:
    """Returns a plain or a masked array. Throws what the library of `data` throws."""
    if isinstance(data, numpy.ndarray):
        # astropy's masked arrays are not numpy's.
        if hasattr(data, "unmasked") and hasattr(data, "mask"):
            return numpy.ma.MaskedArray(data.unmasked, data.mask)
        return data
    if isinstance(data, (list, tuple)) and _may_have_mask(data):
        parts = [with_mask(part, name) for part in data]
        return numpy.ma.MaskedArray(numpy.stack([numpy.ma.getdata(part) for part in parts]),
                                    numpy.stack([numpy.ma.getmaskarray(part) for part in parts]))
    array = _attributes.applied(_asked(data, name), data, name)
    if array.dtype.kind == "O":
        if array.ndim == 0:
            raise Error(f"{name}: expected an array, got {data!r:.60}")
        if callable(getattr(data, "to_numpy", None)):  # pandas, where NA is no float
            array = numpy.asarray(data.to_numpy(dtype=numpy.float64, na_value=numpy.nan))
    return array


def _asked(data: Any, name: str) -> numpy.ndarray:
    if all(hasattr(data, each) for each in ("dims", "data", "attrs")):  # xarray
        # Its `values` lose the mask of an array of dask.
        return with_mask(data.data, name)
    if hasattr(data, "__dlpack__") and not (hasattr(data, "__array_interface__")
                                            or hasattr(data, "__array__")):
        try:
            return numpy.from_dlpack(data)
        except (RuntimeError, TypeError, BufferError) as failure:
            raise Error(f"{name}: its DLPack memory cannot be read ({failure}); move it to the "
                        "memory of the processor") from None
    return numpy.asanyarray(data)


def _may_have_mask(data: Any) -> bool:
    """Whether an entry of nested lists is masked, or an object that may be."""
    if type(data) in (int, float, bool, complex) or isinstance(data, numpy.generic):
        return False
    if isinstance(data, (list, tuple)):
        return any(_may_have_mask(part) for part in data)
    if isinstance(data, numpy.ndarray):
        return hasattr(data, "mask")
    return hasattr(data, "__array__") or hasattr(data, "__dlpack__")


def _unmasked(array: numpy.ndarray, name: str) -> numpy.ndarray:
    if not isinstance(array, numpy.ma.MaskedArray):
        return array
    values = array.data
    if values.dtype.kind not in "biuf":
        return values  # refused by its type
    mask = numpy.ma.getmaskarray(array)
    if not mask.any():
        return values
    if values.dtype.kind != "f":
        if values.dtype.itemsize == 8:
            largest = numpy.max(values, where=~mask, initial=0)
            least = numpy.min(values, where=~mask, initial=0)
            if largest > _EXACT or least < -_EXACT:
                tell(f"{name}: masked integers beyond 2^53 are rounded to f64")
        values = values.astype(numpy.float32 if values.dtype.itemsize <= 2 else numpy.float64)
    return numpy.where(mask, values.dtype.type(numpy.nan), values)
