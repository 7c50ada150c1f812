# SPDX-License-Identifier: Apache-2.0
"""Meshes of points and cells."""
import types

import numpy
import pytest

import pellucid
from conftest import render

POINTS = numpy.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1.25)], dtype=float)
CELLS = numpy.array([(0, 1, 2, 3), (1, 2, 3, 4)])
VALUES = numpy.array([0.0, 1, 2, 3, 4])


def same(a, b):
    return numpy.array_equal(render(a).rgba, render(b).rgba)


def test_all_forms_of_cells_are_one():
    expected = pellucid.Mesh(POINTS, CELLS, {"v": VALUES})
    assert expected.statistics["tetrahedra"] == 2 and expected.channels == ["value"]
    assert expected.range == (0, 4)
    forms = [{"tetra": CELLS}, {10: CELLS}, [("tetra", CELLS[:1]), ("tetra", CELLS[1:])],
             (numpy.array([10, 10]), numpy.array([0, 4, 8]), CELLS.ravel()),
             [("triangle", numpy.array([[0, 1, 2]])), ("tetra", CELLS)], CELLS.astype("u4")]
    for form in forms:
        assert same(pellucid.Mesh(POINTS, form, {"v": VALUES}), expected)
    assert same(pellucid.Mesh(POINTS.astype("f4"), CELLS, {"v": VALUES.astype(">f4")}), expected)


@pytest.mark.parametrize("kind, points, volume", [
    ("tetra", [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], 1 / 6),
    ("pyramid", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)], 1 / 3),
    ("wedge", [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)], 1 / 2),
    ("hexahedron", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0),
                    (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)], 1),
    ("voxel", [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], 1),
])
def test_names_of_cells(kind, points, volume):
    cells = numpy.arange(len(points))[numpy.newaxis]
    mesh = pellucid.Mesh(points, {kind: cells}, {"v": numpy.arange(len(points))})
    assert mesh.statistics["volume"] == pytest.approx(volume, rel=1e-14)
    assert mesh.statistics["overlapping_cells"] == 0
    if kind != "voxel":  # which a bare array of 8 columns is not
        assert same(pellucid.Mesh(points, cells, {"v": numpy.arange(len(points))}), mesh)


def test_meshio_by_what_it_offers():
    blocks = [types.SimpleNamespace(type="tetra", data=CELLS)]
    mesh = types.SimpleNamespace(points=POINTS, cells=blocks, point_data={"v": VALUES},
                                 cell_data={"c": [numpy.array([5.0, 6])]})
    assert same(mesh, pellucid.Mesh(POINTS, CELLS, {"v": VALUES}))
    assert pellucid.mesh_of(mesh, channels=["cell=c"]).channels == ["cell"]


def test_channels_are_arrays_components_and_lengths():
    vectors = numpy.stack([VALUES, 0 * VALUES, VALUES], axis=1)
    mesh = pellucid.Mesh(POINTS, CELLS, {"v": vectors}, channels=["v", "x=v:0"])
    assert mesh.channels == ["v", "x"]
    with pytest.raises(pellucid.Error, match="transfer function"):
        pellucid.render(mesh)
    image = render(mesh, transfer_function=["v=3~2, x=2~2; extinction 3"])
    assert image.rgba[..., 3].max() > 0.1


def test_nan_is_vacuum():
    values = VALUES.copy()
    values[4] = numpy.nan
    assert pellucid.Mesh(POINTS, CELLS, {"v": values}).statistics["vacuum"] == 1


@pytest.mark.parametrize("arguments, words", [
    ((POINTS[:, :2], CELLS, {"v": VALUES}), r"points: expected an array of shape \(n, 3\)"),
    ((POINTS, CELLS + 3, {"v": VALUES}), "refers to point"),
    ((POINTS, CELLS - 1, {"v": VALUES}), "refers to point -1"),
    ((POINTS, CELLS * 1.5, {"v": VALUES}), "whole numbers"),
    ((POINTS, CELLS[:, :3], {"v": VALUES}), "does not say which cells"),
    ((POINTS, {"tetrahedra": CELLS}, {"v": VALUES}), "tetrahedra"),
    ((POINTS, {"triangle": CELLS[:, :3]}, {"v": VALUES}), "no cell with a volume"),
    ((POINTS, CELLS, {"v": VALUES[:3]}), "there are 5 points"),
    ((POINTS, CELLS, {}), "has no values"),
    ((POINTS, 7, {"v": VALUES}), "expected a dict"),
    ((POINTS, {}, {"v": VALUES}), "no cell with a volume"),
    ((POINTS, {10: CELLS[:, :3]}, {"v": VALUES}), "points"),
    ((POINTS, (numpy.array([10]), numpy.array([0]), CELLS.ravel()), {"v": VALUES}), "offsets"),
    ((POINTS, {41: CELLS}, {"v": VALUES}), "convex point set"),
])
def test_what_is_refused_is_refused_in_one_line(arguments, words):
    with pytest.raises(pellucid.Error, match=words) as error:
        pellucid.Mesh(*arguments, name="mine")
    assert "\n" not in str(error.value)
