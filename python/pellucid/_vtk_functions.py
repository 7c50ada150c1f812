# SPDX-License-Identifier: Apache-2.0
"""Functions of VTK's volume properties as curves, with a bound on what they are off by."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, List, Optional, Tuple

import numpy

from ._pellucid import _fit_vtk_function  # type: ignore[attr-defined]

# VTK's numbers of color spaces and scales.
_RGB, _CIEDE2000, _LOG10 = 0, 4, 1

Range = Optional[Tuple[float, float]]


@dataclass
class Curve:
    """Linear between its points, constant outside of them. Two points at one place are a jump."""

    x: numpy.ndarray
    y: numpy.ndarray
    """(points, 1) or (points, 3)."""
    deviation: float = 0.0
    """Of a channel of a color; else |ln| of the ratio of the values and of their depths."""

    def limits(self, x: numpy.ndarray) -> Tuple[numpy.ndarray, numpy.ndarray]:
        """Returns the values just below and just above each place of an array."""
        first = numpy.searchsorted(self.x, x, "left")
        end = numpy.searchsorted(self.x, x, "right")
        last = len(self.x) - 1
        before, after = numpy.clip(first - 1, 0, last), numpy.clip(first, 0, last)
        width = self.x[after] - self.x[before]
        share = numpy.where(width > 0, (x - self.x[before]) / numpy.where(width > 0, width, 1), 0)
        between = self.y[before] + share[:, None] * (self.y[after] - self.y[before])
        at_point = (first != end)[:, None]
        return (numpy.where(at_point, self.y[after], between),
                numpy.where(at_point, self.y[numpy.clip(end - 1, 0, last)], between))


def joined(a: Curve, b: Curve) -> List[Tuple[float, float, Tuple[float, ...]]]:
    """Returns a value and a color at the points of each curve, twice where one of them jumps."""
    places = numpy.union1d(a.x, b.x)
    below = numpy.hstack([a.limits(places)[0], b.limits(places)[0]])
    above = numpy.hstack([a.limits(places)[1], b.limits(places)[1]])
    points = []
    for x, low, high in zip(places.tolist(), below.tolist(), above.tolist()):
        points.append((x, low[0], tuple(low[1:])))
        if low != high:
            points.append((x, high[0], tuple(high[1:])))
    return points


class FunctionReader:
    """Reads functions of a volume property to a tolerance, as VTK's GPU mapper shows them."""

    def __init__(self, look: Any, tolerance: float, what: str, notes: List[str]) -> None:
        self._look, self._what, self._notes = look, what, notes
        self._deviation = tolerance / 16

    def opacities(self, component: int, largest: float, ramp: Range) -> Curve:
        """Returns the scalar opacities of a component, cut at 0 and `largest`."""
        return self._values(self._look.GetScalarOpacity(component), largest, ramp)

    def gradients(self, component: int, ramp: Range) -> Optional[Curve]:
        """Returns the gradient opacity from 0 on; None if the component has none."""
        look = self._look
        if look.GetDisableGradientOpacity(component) or not look.HasGradientOpacity(component):
            return None
        curve = self._values(look.GetGradientOpacity(component), math.inf, ramp)
        if curve.x[0] >= 0:
            return curve
        at_zero, keep = curve.limits(numpy.zeros(1))[1], curve.x > 0
        return Curve(numpy.concatenate([[0.0], curve.x[keep]]),
                     numpy.concatenate([at_zero, curve.y[keep]]), curve.deviation)

    def colors(self, component: int, ramp: Range) -> Curve:
        """Returns the colors of a component: grey or RGB, as the property says."""
        if self._look.GetColorChannels(component) == 1:
            grey = self._values(self._look.GetGrayTransferFunction(component), math.inf, None)
            return Curve(grey.x, numpy.repeat(grey.y, 3, axis=1),
                         math.expm1(grey.deviation) * float(grey.y.max()))
        function = self._look.GetRGBTransferFunction(component)
        self._tell_what_mappers_leave_out(function)
        empty = function.GetSize() == 0
        space = function.GetColorSpace()

        def own(first: float, last: float, count: int) -> List[List[float]]:
            return _table(function, first, last, count)

        # A way of CIEDE2000 takes VTK too long to ask for each place anew, and is measured.
        is_compared = not empty and space != _CIEDE2000
        return self._fitted(
            "colors", 3, _nodes(function, 6) or _ramp(ramp, 1.0), True, _RGB if empty else space,
            bool(function.GetHSVWrap()), function.GetScale() == _LOG10,
            True, bool(function.GetClamping()),
            tuple(function.GetBelowRangeColor()) if function.GetUseBelowRangeColor() else None,
            tuple(function.GetAboveRangeColor()) if function.GetUseAboveRangeColor() else None,
            math.inf, self._deviation, own if is_compared else None, _way(function))

    def looks(self, component: int, values: List[float],
              ramp: Range) -> List[Tuple[float, Tuple[float, ...]]]:
        """Returns VTK's own opacity and color at each value: at a jump those of VTK's choice."""
        opacity = self._look.GetScalarOpacity(component)
        if self._look.GetColorChannels(component) == 1:
            grey = self._look.GetGrayTransferFunction(component)
            colors = [[grey.GetValue(x)] * 3 for x in values]
            empty = grey.GetSize() == 0
        else:
            function = self._look.GetRGBTransferFunction(component)
            colors = [_table(function, x, x, 1)[0] for x in values]
            empty = function.GetSize() == 0
        opacities = [opacity.GetValue(x) for x in values]
        places = numpy.array(values, dtype=float)
        if opacity.GetSize() == 0 or numpy.isnan(opacities).any():
            opacities = self.opacities(component, 1.0, ramp).limits(places)[0][:, 0].tolist()
        if empty or numpy.isnan(colors).any():
            colors = self.colors(component, ramp).limits(places)[0].tolist()
        return [(min(max(a, 0.0), 1.0), tuple(max(c, 0.0) for c in color))
                for a, color in zip(opacities, colors)]

    def _values(self, function: Any, largest: float, ramp: Range) -> Curve:
        def own(first: float, _last: float, _count: int) -> List[List[float]]:
            return [[function.GetValue(first)] * 3]

        empty = function.GetSize() == 0
        nodes = [[x, y, y, y, middle, sharpness]
                 for x, y, middle, sharpness in _nodes(function, 4)]
        return self._fitted("opacities", 1, nodes or _ramp(ramp, 0.5), False, _RGB, True,
                            bool(function.GetUseLogScale()), _jumps(function),
                            bool(function.GetClamping()), None, None, largest, self._deviation,
                            None if empty else own, None)

    def _fitted(self, kind: str, width: int, nodes: List[List[float]], *settings: Any) -> Curve:
        numbers = [node for node in nodes if not any(math.isnan(each) for each in node)]
        if len(numbers) < len(nodes):
            self._tell("nodes of functions that are no numbers are left out")
        points, deviation, is_coarse, has_no_number = _fit_vtk_function(numbers, *settings)
        if is_coarse:
            self._tell(f"{kind} of so many bends are fitted more coarsely than asked for, and the "
                       "error says so")
        if has_no_number:
            self._tell(f"{kind} on a logarithmic scale begin at 0 or below, where VTK has no "
                       "number: they are linear up to the first node above 0")
        return Curve(points[:, 0], points[:, 1:1 + width], deviation)

    def _tell_what_mappers_leave_out(self, function: Any) -> None:
        if function.GetIndexedLookup():
            self._tell("IndexedLookup of colors is left out, as VTK's mappers leave it out")
        if function.IsA("vtkDiscretizableColorTransferFunction") and function.GetDiscretize():
            self._tell("the steps of discretized colors are left out, as VTK's mappers leave them "
                       "out")
        if function.GetScale() == _LOG10 and function.GetSize() and function.GetRange()[0] > 0:
            self._tell("logarithmic colors are those of GetColor(); the GPU mapper of VTK 9.1 "
                       "looks them up at other values")

    def _tell(self, line: str) -> None:
        line = f"{self._what}: {line}"
        if line not in self._notes:
            self._notes.append(line)


def _nodes(function: Any, count: int) -> List[List[float]]:
    nodes = []
    for i in range(function.GetSize()):
        node = [0.0] * count
        function.GetNodeValue(i, node)
        nodes.append(node)
    return nodes


def _jumps(function: Any) -> bool:
    """Whether this VTK's opacities jump where the sharpness is above 0.99."""
    sharp = function.NewInstance()
    sharp.AddPoint(0, 0, 0.5, 1)
    sharp.AddPoint(1, 1, 0.5, 1)
    return bool(sharp.GetValue(0.25) == 0)


def _ramp(ramp: Range, end: float) -> List[List[float]]:
    """What VTK's GPU mapper puts into a function without nodes."""
    if ramp is None:
        return []
    first, last = ramp
    ends = [(last, end)] if first == last else [(first, 0.0), (last, end)]
    return [[x, y, y, y, 0.5, 0.0] for x, y in ends]


def _table(function: Any, first: float, last: float, count: int) -> List[List[float]]:
    """VTK's colors as its mappers take them: GetColor() of a discretized function has steps."""
    numbers = [0.0] * (3 * count)
    function.GetTable(first, last, count, numbers)
    return [numbers[i:i + 3] for i in range(0, len(numbers), 3)]


def _way(function: Any) -> Any:
    """Returns what samples the way of CIEDE2000 from one color to another."""
    def sampled(start: Tuple[float, ...], end: Tuple[float, ...], count: int) -> Any:
        way = function.NewInstance()
        way.SetColorSpaceToLabCIEDE2000()
        way.AddRGBPoint(0, *start)
        way.AddRGBPoint(1, *end)
        return _table(way, 0.0, 1.0, count)

    return sampled
