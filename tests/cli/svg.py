# SPDX-License-Identifier: Apache-2.0
"""Properties of what Cairo wrote into an .svg: 1.16 has them in one attribute, as a style, and 1.18
in an attribute each, with blanks in colors."""


def properties(element):
    """The properties of an element by name, such as "stroke-width": "1.4", without blanks."""
    style = (part.split(":") for part in (element.get("style") or "").split(";") if ":" in part)
    return {name: value.replace(" ", "") for name, value in [*element.attrib.items(), *style]}


def is_glyph(element):
    """Whether an element is the drawing of a letter, which stands among the definitions."""
    return (element.get("id") or "").startswith("glyph")
