# SPDX-License-Identifier: Apache-2.0
"""What Image.compare() and Image.color_bars return."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Optional

import numpy


@dataclass(frozen=True)
class ColorBar:
    """Legend of a layer: the colors of its values, of its surfaces or of its labels. Colors are
    sRGB signals in [0, 1], as matplotlib has them."""

    title: str
    """The variable's name, with its unit in brackets if that is known."""
    range: Optional[tuple[float, float]]
    """Values of the ends of the bar; None: there are entries alone."""
    colors: Optional[numpy.ndarray] = field(repr=False)
    """float64 (1024, 3): at the middles of 1024 equal parts of the range, or None."""
    opacity: Optional[numpy.ndarray] = field(repr=False)
    """float64 (1024,): of a length in which the densest value has an optical depth of 3; None: of
    slices and surfaces."""
    entries: list[tuple[str, tuple[float, float, float]]]
    """Names and colors of isosurfaces and labels."""


@dataclass(frozen=True)
class Comparison:
    """How two pictures differ, over all four channels of premultiplied linear light."""

    largest: float
    rms: float
    psnr: float
    """Decibels, for a peak of 1; infinite if nothing differs."""
    share_over_255: float
    """Share of pixels with a channel that differs by more than 1/255."""
    at: tuple[int, int]
    """(row, column) of the largest difference."""
    not_finite: int
    """Numbers that are not finite in one of the pictures; left out of the rest."""
    over_errors: Optional[int]
    """Pixels that differ by more than the pictures' own errors allow; None: no errors known."""
    difference: numpy.ndarray = field(repr=False)
    """float32 (height, width, 4), |a - b| per channel."""
