# SPDX-License-Identifier: Apache-2.0
"""Emission and absorption along a segment by adaptive Gauss-Legendre panels in arbitrary precision.

Shares no closed form with the kernels: depth inside a panel comes from the collocation matrix,
panels are halved until whole and halves agree.
"""
from functools import lru_cache

from mpmath import mp, mpf

from gauss_legendre import rule

NODES = 20


@lru_cache(maxsize=None)
def panel_rule(digits):
    with mp.workdps(digits + 15):
        return rule(NODES)


def panel(rates, a, b):
    """[optical depth, radiance per channel] of [a, b]; rates(u) = [τ, g per channel] per unit of
    u."""
    nodes, weights, collocation = panel_rule(mp.dps)
    width = b - a
    values = [rates(a + width * u) for u in nodes]
    tau = [v[0] for v in values]
    result = [width * mp.fdot(weights, tau)]
    attenuated = [w * mp.exp(-width * mp.fdot(line, tau)) for w, line in zip(weights, collocation)]
    for c in range(1, len(values[0])):
        result.append(width * mp.fdot(attenuated, [v[c] for v in values]))
    return result


def compose(front, back):
    transparency = mp.exp(-front[0])
    return [front[0] + back[0]] + [x + transparency * y for x, y in zip(front[1:], back[1:])]


def integrate(rates, breaks, depth, tolerance):
    """[optical depth, radiances] over [breaks[0], breaks[-1]]. `breaks` ascend and hold every point
    where the rates are not smooth, and enough points that no peak hides between nodes. `depth` is
    (nearly) the total: errors are small beside it and beside its opacity. What lies behind a
    transparency of 1e-60 is given depth but no radiance."""
    stack = [(a, b, panel(rates, a, b), 0) for a, b in zip(breaks, breaks[1:]) if a < b][::-1]
    # An estimate that is far too small would ask for more digits than there are.
    depth = max(depth, mp.fsum(whole[0] for _, _, whole, _ in stack))
    opacity = -mp.expm1(-depth)
    total = None
    while stack:
        a, b, whole, level = stack.pop()
        hidden = total is not None and total[0] > 140
        middle = (a + b) / 2
        halves = [panel(rates, a, middle), panel(rates, middle, b)]
        both = compose(*halves)
        # A deep panel may have all its emission in front of the first node.
        agree = abs(both[0] - whole[0]) <= tolerance * max(depth, both[0]) and (hidden or (
            both[0] < 8 and
            all(abs(x - y) <= tolerance * opacity for x, y in zip(both[1:], whole[1:]))))
        if agree:
            if hidden:
                both = [both[0]] + [mpf(0)] * (len(both) - 1)
            total = both if total is None else compose(total, both)
        elif level > 60:
            raise ArithmeticError("the rates are not smooth between the breaks")
        else:
            stack.append((middle, b, halves[1], level + 1))
            stack.append((a, middle, halves[0], level + 1))
    return total
