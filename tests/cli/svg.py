# SPDX-License-Identifier: Apache-2.0
"""Properties and lines of what Cairo wrote into an .svg: 1.16 has properties in one attribute, as a
style, and 1.18 in an attribute each, with blanks in colors."""
import re

SVG = "{http://www.w3.org/2000/svg}"
XLINK = "{http://www.w3.org/1999/xlink}href"


def properties(element):
    """The properties of an element by name, such as "stroke-width": "1.4", without blanks."""
    style = (part.split(":") for part in (element.get("style") or "").split(";") if ":" in part)
    return {name: value.replace(" ", "") for name, value in [*element.attrib.items(), *style]}


def is_glyph(element):
    """Whether an element is the drawing of a letter, which stands among the definitions."""
    return (element.get("id") or "").startswith("glyph")


def points(path):
    """The (x, y) of a path's data."""
    numbers = [float(n) for n in re.findall(r"-?[0-9.]+", path)]
    return list(zip(numbers[::2], numbers[1::2]))


def lines(root):
    """The properties and the two ends of each straight line that is drawn."""
    for path in root.iter(SVG + "path"):
        drawn, ends = properties(path), points(path.get("d"))
        if "stroke-width" in drawn and drawn.get("fill") == "none" and len(ends) == 2:
            yield drawn, ends
