# SPDX-License-Identifier: Apache-2.0
"""Small types that the compiled part of the package fills in, and how notes are told."""
from __future__ import annotations

import re
import sys
import warnings
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from ._pellucid import GradientOpacity, OpacityTable
    from .scene import Shading


class Note(UserWarning):
    """What a reader or a converter assumed, rounded or left out."""


# Options of the program that notes name, and their words here.
_KEYWORDS = {"array-axes": "axes", **{name: name for name in (
    "axes", "centering", "level", "origin", "series", "spacing", "time")}}
_OPTION = re.compile(rf"(?<=[ (])--({'|'.join(_KEYWORDS)})(?: (point|cell)\b)?(?![\w.=-])")


def in_keywords(text: str) -> str:
    """A note with keywords in place of options: "time= chooses one"."""
    return _OPTION.sub(lambda option: f"{_KEYWORDS[option[1]]}="
                       + (f'"{option[2]}"' if option[2] else ""), text)


def tell(text: str) -> None:
    """Warns of `text`, as of the line that called the package."""
    text = in_keywords(text)
    level, frame = 1, sys._getframe()
    while frame is not None and _is_of_package(frame.f_globals.get("__name__", "")):
        level, frame = level + 1, frame.f_back
    warnings.warn(text, Note, stacklevel=level)


def _is_of_package(module: str) -> bool:
    return module == "pellucid" or module.startswith("pellucid.")


class Preset(NamedTuple):
    """A transfer function for one kind of data."""

    name: str
    description: str
    hounsfield: bool
    """Whether values are Hounsfield units and lengths millimetres."""
    lit: bool
    """Whether it is made for data in light: render() adds a Shading."""


class ImportedTransferFunction(NamedTuple):
    """A transfer function of another program."""

    transfer_function: OpacityTable
    shading: Shading | None
    gradient_opacity: GradientOpacity | None
    format: str
    name: str
    notes: list[str]
