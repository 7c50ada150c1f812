# SPDX-License-Identifier: Apache-2.0
"""Images of nibabel: their values as nibabel scales them, and their affine."""
from __future__ import annotations

import sys
from typing import Any, Optional

import numpy

from . import _attributes, _masks
from ._notes import tell
from ._pellucid import Error
from ._places import Placed, of_columns

_MILLIMETRES = {"meter": 1000.0, "micron": 0.001}


def is_image(data: Any) -> bool:
    """Whether data looks like an image of nibabel, with a place or without."""
    return hasattr(data, "dataobj") and hasattr(data, "header")


def refuse_proxy(data: Any) -> None:
    """Raises Error for the values of an image without the image, whose axes are x, y and z."""
    proxies = sys.modules.get("nibabel.arrayproxy")
    if proxies is not None and proxies.is_proxy(data):
        raise Error(f"{type(data).__name__}: is the dataobj of an image of nibabel, whose axes are "
                    "x, y and z and which has no place; give the image")


def placed(image: Any) -> Placed:
    """Returns its array and place: RAS becomes LPS, and its axes (i, j, k) are x, y, z."""
    file = image.get_filename() if hasattr(image, "get_filename") else None
    name = str(file or "nibabel image")
    if not hasattr(image, "affine"):
        raise Error(f"{name}: is a {type(image).__name__}, whose axes are not x, y and z; give an "
                    "image of voxels")
    if image.affine is None:
        raise Error(f"{name}: its affine is None, so that its place is not known; give the image "
                    "an affine")
    array = _three_axes(_values(image.dataobj, name), image, name)
    affine = numpy.array(image.affine, dtype=float)
    _tell_assumed_place(image, affine, name)
    affine[:3] *= _unit_of(image.header)
    affine[:2] *= -1
    return of_columns(array.T, affine[:3, 2::-1].T, affine[:3, 3], name)


def _values(dataobj: Any, name: str) -> numpy.ndarray:
    """The values as our own reader scales them, where the proxy says its only slope.

    Proxies of other formats have a factor for each volume or slice, or none to ask for.
    """
    proxies = sys.modules.get("nibabel.arrayproxy")
    if proxies is None or type(dataobj) is not proxies.ArrayProxy:
        return _masks.as_array(dataobj, name)
    stored = numpy.asanyarray(dataobj.get_unscaled())
    return _attributes.scaled(stored, float(dataobj.slope), float(dataobj.inter))


def _three_axes(array: numpy.ndarray, image: Any, name: str) -> numpy.ndarray:
    """The array without axes that are none of space: behind, but in front in MINC's files."""
    shape = array.shape
    is_minc = type(image).__name__.startswith("Minc")
    while array.ndim > 3 and array.shape[0 if is_minc else -1] == 1:
        array = array[0] if is_minc else array[..., 0]
    if array.ndim == 3:
        return array
    if array.ndim < 3:
        raise Error(f"{name}: an image of shape {shape} has {len(shape)} axes; give one with three")
    chosen = ("nibabel.Nifti1Image(image.dataobj[0], image.affine)" if is_minc
              else f"image.slicer[..., {', '.join('0' * (array.ndim - 3))}]")
    raise Error(f"{name}: an image of shape {shape} has {len(shape)} axes; choose one of its "
                f"volumes, as in {chosen}, or give several as Channels")


def _unit_of(header: Any) -> float:
    """The length of the header's unit in millimetres."""
    if not hasattr(header, "get_xyzt_units"):
        return 1.0
    try:
        return _MILLIMETRES.get(header.get_xyzt_units()[0], 1.0)
    except KeyError:  # a code that nibabel does not know
        return 1.0


def _code(header: Any, key: str) -> Optional[int]:
    try:
        return int(header[key])
    except (KeyError, IndexError, TypeError, ValueError):
        return None


def _tell_assumed_place(image: Any, affine: numpy.ndarray, name: str) -> None:
    """Tells where neither header nor user says how the image lies, and nibabel assumes it."""
    header, analyze = image.header, sys.modules.get("nibabel.analyze")
    if analyze is None or not isinstance(header, analyze.AnalyzeHeader):
        return
    if any(_code(header, key) for key in ("sform_code", "qform_code")):
        return
    if numpy.allclose(affine, header.get_best_affine()):
        tell(f"{name}: the header states no orientation; nibabel's assumption is taken (its "
             "affine)")
