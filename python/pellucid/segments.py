# SPDX-License-Identifier: Apache-2.0
"""The kernels: exact segments of rays, for whole arrays at once, and rays through a scene.

Arguments broadcast against each other as in numpy. Extinctions and lengths are >= 0, in units that
are inverse to each other; colors have a last axis of three. Each function states its largest error
in units u = 1.1e-16 (docs/reference/specification.md has the formulas and the proofs).
"""
from __future__ import annotations

from typing import Any, NamedTuple

import numpy

from . import _pellucid
from ._pellucid import Error, Gaussians, TransferFunction


class Segments(NamedTuple):
    """Segments of rays: radiance + transparency * (what comes from behind)."""

    optical_depth: numpy.ndarray
    opacity: numpy.ndarray
    transparency: numpy.ndarray
    radiance: numpy.ndarray
    """Premultiplied; with a last axis of three."""


class Rays(NamedTuple):
    """What comes along rays."""

    optical_depth: numpy.ndarray
    opacity: numpy.ndarray
    radiance: numpy.ndarray
    """Premultiplied; with a last axis of three."""
    depth: numpy.ndarray
    """Distance from the origin, world units, at which half of the opacity is reached."""


def _array(what: str, value: Any) -> numpy.ndarray:
    try:
        return numpy.asarray(value, dtype=numpy.float64)
    except (TypeError, ValueError):
        raise Error(f"{what}: expected numbers, got {value!r:.60}") from None


def _broadcast(scalars: dict[str, Any], vectors: dict[str, tuple[Any, int]]):
    """Returns the common shape, and each argument flat: (n,) and (n, components)."""
    flat = {name: _array(name, value) for name, value in scalars.items()}
    rows = {}
    for name, (value, width) in vectors.items():
        rows[name] = _array(name, value)
        if rows[name].ndim < 1 or rows[name].shape[-1] != width:
            raise Error(f"{name}: expected a last axis of {width}, got {rows[name].shape}")
    try:
        shape = numpy.broadcast_shapes(*(a.shape for a in flat.values()),
                                       *(a.shape[:-1] for a in rows.values()))
    except ValueError:
        raise Error("the shapes " + ", ".join(str(a.shape) for a in {**flat, **rows}.values())
                    + " do not broadcast") from None
    for name, array in flat.items():
        flat[name] = numpy.ascontiguousarray(numpy.broadcast_to(array, shape)).ravel()
    for name, array in rows.items():
        width = array.shape[-1]
        rows[name] = numpy.ascontiguousarray(
            numpy.broadcast_to(array, shape + (width,))).reshape(-1, width)
    return shape, {**flat, **rows}


def _check_not_negative(**arrays: numpy.ndarray) -> None:
    for name, array in arrays.items():
        if not (array >= 0).all():
            worst = array[~(array >= 0)][0]
            raise Error(f"{name}: {worst} is not at least 0; give numbers >= 0")


def _segments(shape, parts) -> Segments:
    depth, opacity, transparency, radiance = parts
    return Segments(depth.reshape(shape), opacity.reshape(shape), transparency.reshape(shape),
                    radiance.reshape(shape + (3,)))


def linear_segment(extinction_f, extinction_b, color_f, color_b, length) -> Segments:
    """Returns segments whose extinction and color are linear from front (f) to back (b).

    The color is that of the particles. Largest error: 16 u relative.
    """
    return _linear(extinction_f, extinction_b, color_f, color_b, length, False)


def linear_segment_independent(extinction_f, extinction_b, emission_f, emission_b,
                               length) -> Segments:
    """Returns segments with a linear emission per length that does not depend on the extinction.

    Largest error: 32 u relative.
    """
    return _linear(extinction_f, extinction_b, emission_f, emission_b, length, True)


def _linear(extinction_f, extinction_b, color_f, color_b, length, independent) -> Segments:
    shape, a = _broadcast(
        {"extinction_f": extinction_f, "extinction_b": extinction_b, "length": length},
        {"color_f": (color_f, 3), "color_b": (color_b, 3)})
    _check_not_negative(extinction_f=a["extinction_f"], extinction_b=a["extinction_b"],
                        length=a["length"])
    return _segments(shape, _pellucid.linear_segments(
        a["extinction_f"], a["extinction_b"], a["color_f"], a["color_b"], a["length"], independent))


def piecewise_linear_segment(transfer_function: TransferFunction, value_f, value_b,
                             length) -> Segments:
    """Returns segments of data that are linear from value_f to value_b.

    Exact at every control point between the two. Largest error: 16 u * opacity for at most 16
    control points between the values.
    """
    shape, a = _broadcast({"value_f": value_f, "value_b": value_b, "length": length}, {})
    _check_not_negative(length=a["length"])
    for name in ("value_f", "value_b"):
        if not numpy.isfinite(a[name]).all():
            raise Error(f"{name}: holds NaN or an infinity; give finite values")
    return _segments(shape, _pellucid.piecewise_linear_segments(
        transfer_function, a["value_f"], a["value_b"], a["length"]))


def gaussian_segment(gaussian: Gaussians, values_f, values_b, length) -> Segments:
    """Returns segments of data that are linear in all channels, through a single Gaussian.

    values have a last axis of the channels of `gaussian`.
    """
    width = len(gaussian.channels)
    shape, a = _broadcast({"length": length},
                          {"values_f": (values_f, width), "values_b": (values_b, width)})
    _check_not_negative(length=a["length"])
    return _segments(shape, _pellucid.gaussian_segments(
        gaussian, a["values_f"], a["values_b"], a["length"]))


def compose(front: Segments, back: Segments) -> Segments:
    """Returns one segment in front of another, as one. Associative."""
    through = front.transparency
    return Segments(front.optical_depth + back.optical_depth,
                    front.opacity + through * back.opacity, through * back.transparency,
                    front.radiance + through[..., None] * back.radiance)


def integrate(scene: Any, origins: Any, directions: Any) -> Rays:
    """Returns what comes along rays through a scene, to 1e-12: the reference, without pixels.

    origins and directions are world positions and directions (x, y, z), in a last axis of three,
    and broadcast; a direction may have any length but 0. The scene's camera, size and tolerance do
    not matter. Raises Error if a number is not finite.
    """
    shape, a = _broadcast({}, {"origins": (origins, 3), "directions": (directions, 3)})
    for name, array in a.items():
        if not numpy.isfinite(array).all():
            raise Error(f"{name}: holds NaN or an infinity; give finite numbers")
    if scene.backdrop is not None:
        raise Error("integrate: the scene has a backdrop, which belongs to pixels; leave it out")
    depth, opacity, radiance, half = _pellucid.integrate_rays(scene, a["origins"], a["directions"])
    return Rays(depth.reshape(shape), opacity.reshape(shape), radiance.reshape(shape + (3,)),
                half.reshape(shape))
