# SPDX-License-Identifier: Apache-2.0
"""Transfer functions of color maps, of matplotlib or of one's own."""
from __future__ import annotations

from typing import Any, Sequence, Tuple, Union

import numpy

from ._pellucid import (Error, TransferFunction, color_map, is_color_map, linear_color,
                        srgb_to_linear)

Extinction = Union[float, Sequence[Tuple[float, float]]]


def colormap_colors(colormap: Any, count: int = 256) -> numpy.ndarray:
    """Returns `count` linear colors (count, 3) of a color map.

    colormap is the name of one of color_map_names() or of matplotlib, a colormap object (a
    callable from [0, 1] to sRGB), a list of colors ("#rrggbb" or linear), or an array (n, 3) or
    (n, 4) of sRGB signals in [0, 1].
    """
    positions = numpy.linspace(0, 1, count)
    if isinstance(colormap, str):
        named = _of_matplotlib(colormap)
        if named is None:
            at, colors = zip(*color_map(colormap))
            return numpy.stack([numpy.interp(positions, at, c) for c in zip(*colors)], axis=1)
        colormap = named
    if callable(colormap):
        signals = numpy.asarray(colormap(positions), dtype=float)
    elif isinstance(colormap, numpy.ndarray):
        signals = _resampled(numpy.asarray(colormap, dtype=float), positions)
    else:
        colors = numpy.array([linear_color(color) for color in colormap], dtype=float)
        return _resampled(colors, positions)
    if signals.ndim != 2 or signals.shape[1] not in (3, 4):
        raise Error(f"color map: expected colors (n, 3) or (n, 4), got {signals.shape}")
    return srgb_to_linear(signals[:, :3])


def _of_matplotlib(name: str) -> Any:
    """Returns the map of this name; None if matplotlib is not there or has none."""
    try:
        import matplotlib
    except ImportError:
        return None
    return matplotlib.colormaps[name] if name in matplotlib.colormaps else None


def color_points(colormap: Any) -> list:
    """Returns [(position, linear color), ...] of what colormap_colors() takes."""
    if isinstance(colormap, str) and (is_color_map(colormap) or _of_matplotlib(colormap) is None):
        return color_map(colormap)
    colors = colormap_colors(colormap)
    return list(zip(numpy.linspace(0, 1, len(colors)).tolist(), colors.tolist()))


def _resampled(colors: numpy.ndarray, positions: numpy.ndarray) -> numpy.ndarray:
    if colors.ndim != 2 or len(colors) == 0:
        raise Error(f"color map: expected colors (n, 3), got an array of shape {colors.shape}")
    own = numpy.linspace(0, 1, len(colors))
    return numpy.stack([numpy.interp(positions, own, column) for column in colors.T], axis=1)


def from_colormap(colormap: Any, range: Tuple[float, float], extinction: Extinction,
                  count: int = 256) -> TransferFunction:
    """Returns a TransferFunction with the colors of a color map.

    colormap    the name of one of color_map_names() or of matplotlib ("viridis"), a colormap
                object, a list of colors, or an array (n, 3) of sRGB signals
    range       (first, last): the values of its ends
    extinction  per world length: one number, or points (value, extinction) in
                ascending order, linear between
    count       number of points over the range

    Colors between the points are linear in light.
    """
    first, last = (float(end) for end in range)
    if not first < last:
        raise Error(f"range: expected two ascending values, got {range!r:.60}")
    values = numpy.linspace(first, last, count)
    colors = colormap_colors(colormap, count)
    if numpy.ndim(extinction) == 0:
        extinctions = numpy.full(count, float(extinction))
    else:
        points = numpy.asarray(extinction, dtype=float)
        if points.ndim != 2 or points.shape[1] != 2 or not (numpy.diff(points[:, 0]) > 0).all():
            raise Error("extinction: expected a number, or points (value, extinction) in "
                        "ascending order")
        # Every point of the extinction is a point of the function, so that its corners are exact.
        values = numpy.union1d(values, points[:, 0])
        extinctions = numpy.interp(values, points[:, 0], points[:, 1])
        own = numpy.linspace(first, last, count)
        colors = numpy.stack([numpy.interp(values, own, c) for c in colors.T], axis=1)
    return TransferFunction(list(zip(values.tolist(), extinctions.tolist(), colors.tolist())))
