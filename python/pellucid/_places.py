# SPDX-License-Identifier: Apache-2.0
"""An array of three axes and its place. Everything has the order of the array's axes, (z, y, x)."""
from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy

from ._pellucid import Error


class Placed(NamedTuple):
    """An array of three axes and its place, as Volume() takes them."""

    array: numpy.ndarray
    spacing: Any = (1.0, 1.0, 1.0)
    origin: Any = (0.0, 0.0, 0.0)
    direction: Any = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    coordinates: Any = (None, None, None)
    centering: str = "point"
    name: str = "array"


def three_axes(array: numpy.ndarray, name: str) -> numpy.ndarray:
    """Returns the array without axes of one entry in front and behind. Throws for others."""
    given = array.shape
    while array.ndim > 3 and array.shape[0] == 1:
        array = array[0]
    while array.ndim > 3 and array.shape[-1] == 1:
        array = array[..., 0]
    if array.ndim != 3:
        advice = ("choose one of its volumes, as in a[..., 0] or a[0], or give several as Channels"
                  if array.ndim > 3 else "give three axes (z, y, x), as in a[numpy.newaxis] with "
                  "centering=\"cell\" for a single slice" if array.ndim == 2
                  else "give an array with three axes (z, y, x)")
        raise Error(f"{name}: an array of shape {given} has {len(given)} axes; {advice}")
    return array


def of_columns(array: numpy.ndarray, columns: numpy.ndarray, origin: Any, name: str) -> Placed:
    """An array (z, y, x) whose axes step by columns[a], all given as (x, y, z)."""
    spacing, direction = [], numpy.empty((3, 3))
    for axis, (x, y, z) in enumerate(columns):
        length = math.sqrt(x * x + y * y + z * z)
        spacing.append(length)
        inverse = 1 / length if length > 0 else 0.0
        direction[:, axis] = (z * inverse, y * inverse, x * inverse)
    return Placed(array, tuple(spacing), tuple(origin)[::-1], direction, name=name)
