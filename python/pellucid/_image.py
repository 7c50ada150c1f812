# SPDX-License-Identifier: Apache-2.0
"""What Image.compare() returns."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Optional

import numpy


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
