# SPDX-License-Identifier: Apache-2.0
"""Pictures in figures of matplotlib, with color bars that are right.

    import matplotlib.pyplot as plt
    import pellucid, pellucid.mpl

    image = pellucid.render(field, cmap="viridis", background="white")
    figure, axes = plt.subplots()
    pellucid.mpl.show(axes, image)
    pellucid.mpl.colorbar(image, axes)

matplotlib is imported when a function is called. Image.figure() needs none.
"""
from __future__ import annotations

from typing import Any, Optional

from ._image import ColorBar
from ._pellucid import Error, Image

__all__ = ["colorbar", "colormap", "legend", "mappable", "norm", "show"]


def show(axes: Any, image: Image, background: Any = ..., **options: Any) -> Any:
    """Puts a picture into axes of matplotlib and takes their frame away.

    axes        matplotlib.axes.Axes
    image       pellucid.Image
    background  as of Image.to_srgb8(): the scene's, a color, two, or None for none
    options     of Axes.imshow()

    Returns the matplotlib.image.AxesImage. Its extent is in pixels, row 0 at the top; the bytes are
    those of the PNG.
    """
    shown = axes.imshow(image.to_srgb8(background), **options)
    axes.set_axis_off()
    return shown


def colormap(bar: ColorBar) -> Any:
    """Returns a matplotlib.colors.ListedColormap of 1024 colors. Raises Error for entries alone."""
    from matplotlib.colors import ListedColormap

    if bar.colors is None:
        raise Error(f"color bar '{bar.title}': has no function, only entries; see legend()")
    return ListedColormap(bar.colors, name=bar.title or "pellucid")


def norm(bar: ColorBar) -> Any:
    """Returns a matplotlib.colors.Normalize of the bar's range. Raises Error as colormap()."""
    from matplotlib.colors import Normalize

    if bar.range is None:
        raise Error(f"color bar '{bar.title}': has no function, only entries; see legend()")
    return Normalize(*bar.range)


def mappable(image: Image, index: Optional[int] = None) -> Any:
    """Returns a matplotlib.cm.ScalarMappable: the values of a layer, and their colors.

    index  number of the bar in image.color_bars; None: the first with a function

    Raises Error if there is none.
    """
    from matplotlib.cm import ScalarMappable

    bar = _bar(image, index)
    return ScalarMappable(norm(bar), colormap(bar))


def colorbar(image: Image, axes: Any, index: Optional[int] = None, label: Optional[str] = None,
             **options: Any) -> Any:
    """Draws the color bar of a layer beside axes, as Figure.colorbar() does.

    axes     the matplotlib.axes.Axes that show the image
    index    number of the bar in image.color_bars; None: the first with a function
    label    text beside it; None: the title of the bar
    options  of matplotlib's Figure.colorbar()

    Returns the matplotlib.colorbar.Colorbar. Raises Error if there is none.
    """
    bar = _bar(image, index)
    return axes.figure.colorbar(mappable(image, index), ax=axes,
                                label=bar.title if label is None else label, **options)


def legend(image: Image, axes: Any, **options: Any) -> Any:
    """Draws a legend of isosurfaces and labels into axes.

    options  of Axes.legend()

    Returns the matplotlib.legend.Legend. Raises Error if there are no entries.
    """
    from matplotlib.patches import Patch

    patches = [Patch(facecolor=color, edgecolor="black", linewidth=0.5, label=name)
               for bar in image.color_bars for name, color in bar.entries]
    if not patches:
        raise Error("legend: the image has no isosurfaces and labels; see colorbar()")
    return axes.legend(handles=patches, **options)


def _bar(image: Image, index: Optional[int]) -> ColorBar:
    bars = image.color_bars
    if index is None:
        for bar in bars:
            if bar.colors is not None:
                return bar
        raise Error("color bar: the image has no function of one variable")
    if not -len(bars) <= index < len(bars):
        raise Error(f"index: there are {len(bars)} color bars, got {index}")
    return bars[index]
