# SPDX-License-Identifier: Apache-2.0
"""The type stubs name what the compiled module has, with its arguments."""
import ast
import os
import re

import pellucid
from pellucid import _pellucid

STUBS = os.path.join(os.environ["PELLUCID_SOURCE_DIR"], "python", "pellucid", "_pellucid.pyi")
# Their arguments are documented in Python (pellucid/segments.py).
KERNELS = {"linear_segments", "piecewise_linear_segments", "gaussian_segments", "integrate_rays"}


def stubs():
    with open(STUBS, encoding="utf-8") as file:
        return ast.parse(file.read())


def arguments(function):
    names = [a.arg for a in function.args.args + function.args.kwonlyargs]
    return [name for name in names if name != "self"]


def told(docstring):
    """The names of the arguments in the first line of pybind11's docstring."""
    inside = docstring.splitlines()[0].partition("(")[2].rpartition(")")[0]
    return [name for name in re.findall(r"(?:^|, )(\w+): ", inside) if name != "self"]


def test_names_are_the_modules():
    kinds = (ast.ClassDef, ast.FunctionDef)
    named = {node.name for node in stubs().body if isinstance(node, kinds)}
    has = {name for name in vars(_pellucid) if not name.startswith("_")}
    assert named == has


def test_arguments_are_the_modules():
    for node in stubs().body:
        if isinstance(node, ast.FunctionDef) and node.name not in KERNELS:
            assert arguments(node) == told(getattr(_pellucid, node.name).__doc__), node.name
        if not isinstance(node, ast.ClassDef):
            continue
        made = getattr(_pellucid, node.name)
        for method in node.body:
            if not isinstance(method, ast.FunctionDef):
                continue
            assert hasattr(made, method.name), (node.name, method.name)
            text = getattr(made, method.name).__doc__ or ""
            named = text.startswith(method.name + "(") and "arg0" not in text
            if named and method.args.kwarg is None:
                assert arguments(method) == told(text), (node.name, method.name)


def test_everything_public_is_in_the_package():
    hidden = {"ViewerServer", "axis_roles", "changed_function", "choose_look",
              "grey_colors", "grows_downwards", "is_color_map", "linear_color", "look_lights",
              "other_conventions", "page_of_scene", "page_without_scene",
              "reduced_page_of_scene",
              "picture_advice", "save_scene", "space_axes", "surface_advice", "unit_factors",
              "unwrapped_longitudes"} | KERNELS
    has = {name for name in vars(_pellucid) if not name.startswith("_")}
    assert named == has


def test_arguments_are_the_modules():
    for node in stubs().body:
        if isinstance(node, ast.FunctionDef) and node.name not in KERNELS:
            assert arguments(node) == told(getattr(_pellucid, node.name).__doc__), node.name
        if not isinstance(node, ast.ClassDef):
            continue
        made = getattr(_pellucid, node.name)
        for method in node.body:
            if not isinstance(method, ast.FunctionDef):
                continue
            assert hasattr(made, method.name), (node.name, method.name)
            text = getattr(made, method.name).__doc__ or ""
            named = text.startswith(method.name + "(") and "arg0" not in text
            if named and method.args.kwarg is None:
                assert arguments(method) == told(text), (node.name, method.name)


def test_everything_public_is_in_the_package():
    hidden = {"ViewerServer", "axis_roles", "changed_function", "choose_look",
              "grey_colors", "grows_downwards", "is_color_map", "linear_color", "look_lights",
              "other_conventions", "page_of_scene", "page_without_scene",
              "reduced_page_of_scene",
              "picture_advice", "save_scene", "space_axes", "surface_advice", "unit_factors",
              "unwrapped_longitudes"} | KERNELS
    has = {name for name in vars(_pellucid) if not name.startswith("_")} - hidden
    assert has <= set(pellucid.__all__)
    assert all(hasattr(pellucid, name) for name in pellucid.__all__)
