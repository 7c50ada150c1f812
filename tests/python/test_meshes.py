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
             CELLS.astype("u4")]
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


TRIANGLES = numpy.array([(0, 1, 2), (1, 2, 3), (0, 2, 3)])


@pytest.mark.parametrize("kind, points", [
    ("vertex", 1), ("line", 2), ("line3", 3), ("line4", 4), ("line11", 11), ("triangle", 3),
    ("triangle6", 6), ("triangle7", 7), ("triangle10", 10), ("triangle66", 66), ("quad", 4),
    ("quad6", 6), ("quad8", 8), ("quad9", 9), ("quad16", 16), ("quad121", 121), ("pixel", 4),
    ("polygon", 5), ("polygon5", 5), ("VTK_LAGRANGE_CURVE", 4), ("VTK_LAGRANGE_TRIANGLE", 10),
    ("VTK_LAGRANGE_QUADRILATERAL", 16), ("VTK_BEZIER_TRIANGLE", 6), ("empty", 0),
])
def test_cells_without_a_volume_are_left_out_and_counted(kind, points):
    """And the values of cells stay with their cells, wherever the others stand."""
    flat = numpy.resize(numpy.arange(5), (3, points))
    for blocks, values in [
            ([(kind, flat), ("tetra", CELLS)], [7, 8, 9, 1, 2]),
            ([("tetra", CELLS), (kind, flat)], [1, 2, 7, 8, 9]),
            ([("tetra", CELLS[:1]), (kind, flat), ("tetra", CELLS[1:])], [1, 7, 8, 9, 2])]:
        with pytest.warns(pellucid.Note, match="3 of 5 cells are surfaces, lines or points"):
            mesh = pellucid.Mesh(POINTS, blocks, {}, {"c": numpy.array(values, dtype=">f8")})
        assert mesh.range == (1, 2) and mesh.statistics["cells"] == 2
        assert same(mesh, pellucid.Mesh(POINTS, CELLS, {}, {"c": numpy.array([1.0, 2])}))


@pytest.mark.parametrize("kind", ["tetra20", "hexahedron64", "wedge40", "pyramid14", "trianglex",
                                  "VTK_BEZIER_TETRAHEDRON"])
def test_cells_of_other_kinds_are_refused(kind):
    with pytest.raises(pellucid.Error, match=f"\"{kind}\" are not read"):
        pellucid.Mesh(POINTS, {kind: numpy.zeros((1, 20), dtype=int)}, {"v": VALUES})


def gmsh(cell_data, cells=None):
    """A mesh with groups: surfaces before and behind the volumes."""
    blocks = cells or [("triangle", TRIANGLES), ("tetra", CELLS[:1]), ("line", TRIANGLES[:2, :2]),
                       ("tetra", CELLS[1:])]
    cells = [types.SimpleNamespace(type=kind, data=data) for kind, data in blocks]
    return types.SimpleNamespace(points=POINTS, cells=cells, point_data={}, cell_data=cell_data)


def test_groups_of_gmsh():
    groups = [numpy.array([1, 1, 2]), numpy.array([30]), numpy.array([4, 4]), numpy.array([50])]
    with pytest.warns(pellucid.Note, match="5 of 7 cells"):
        mesh = pellucid.mesh_of(gmsh({"gmsh:physical": groups}))
    assert mesh.range == (30, 50)
    masked = [*groups[:3], numpy.ma.masked_equal([50], 50)]
    with pytest.warns(pellucid.Note):
        mesh = pellucid.mesh_of(gmsh({"gmsh:physical": masked}))
    assert mesh.range == (30, 30) and mesh.statistics["vacuum"] == 1


@pytest.mark.parametrize("data, words", [
    ([[1, 1, 2], [3], [4, 4]], r"blocks of \[3, 1, 2\] values, but the cells have \[3, 1, 2, 1\]"),
    ([[1, 1], [3, 3], [4, 4], [5]], r"\[2, 2, 2, 1\] values"),
    ([[1, 1, 2], [[3, 3]], [4, 4], [5]], "another number of components"),
])
def test_blocks_of_values_that_do_not_fit_are_refused(data, words):
    with pytest.raises(pellucid.Error, match=words):
        pellucid.mesh_of(gmsh({"a": [numpy.array(part) for part in data]}))


def test_polyhedra_of_meshio():
    faces = [[0, 1, 2], [0, 1, 3], [1, 2, 3], [0, 2, 3]]
    block = [[numpy.array(face) for face in faces]]
    mesh = gmsh({"a": [[5.0]]}, [("polyhedron4", block)])
    assert pellucid.mesh_of(mesh).statistics["volume"] == pytest.approx(1 / 6)


def test_meshio_itself(tmp_path):
    meshio = pytest.importorskip("meshio")
    mesh = meshio.Mesh(POINTS, [("triangle", TRIANGLES), ("tetra", CELLS)],
                       cell_data={"part:0": [[1.0, 1, 1], [2.0, 3.0]]})
    with pytest.warns(pellucid.Note, match="3 of 5"):
        assert pellucid.mesh_of(mesh).range == (2, 3)
    meshio.write(tmp_path / "a.vtu", mesh)
    with pytest.warns(pellucid.Note, match="3 of 5"):
        assert pellucid.mesh_of(meshio.read(tmp_path / "a.vtu"), ["part:0"]).range == (2, 3)


def test_arrays_of_one_name():
    """As files are read: the one of cells gets another name."""
    both = (POINTS, CELLS, {"v": VALUES}, {"v": numpy.array([10.0, 20])})
    assert pellucid.Mesh(*both).range == (0, 4)
    assert pellucid.Mesh(*both, channels=["v"]).range == (0, 4)
    assert pellucid.Mesh(*both, channels=["v_cell"]).range == (10, 20)
    assert pellucid.Mesh(*both, active="v_cell").range == (10, 20)


@pytest.mark.parametrize("name", ["a:0", "a:7", "gmsh:physical", "p=1", "a b: 2", "é:1"])
def test_names_with_signs(name):
    other = {"a": numpy.stack([VALUES + 50] * 3, axis=1), name: VALUES}
    assert pellucid.Mesh(POINTS, CELLS, other, active=name).range == (0, 4)
    assert pellucid.Mesh(POINTS, CELLS, other, channels=["w=" + name]).range == (0, 4)
    assert pellucid.Mesh(POINTS, CELLS, other, channels=["a:1"]).range == (50, 54)


def test_the_length_of_vectors_is_told():
    vectors = numpy.stack([3 * VALUES, 0 * VALUES, 4 * VALUES], axis=1)
    with pytest.warns(pellucid.Note, match="3 components, whose length is shown; .*\"v:0\""):
        mesh = pellucid.Mesh(POINTS, CELLS, {"v": vectors})
    assert mesh.range == (0, 20)
    with pytest.warns(pellucid.Note, match="whose length"):
        mesh = pellucid.Mesh(POINTS, CELLS, {"w": VALUES, "v": vectors}, active="v")
    assert mesh.range == (0, 20)
    assert pellucid.Mesh(POINTS, CELLS, {"w": VALUES, "v": vectors}).range == (0, 4)


def test_arrays_that_are_not_shown_may_be_anything():
    other = {"text": ["a"] * 5, "complex": VALUES * 1j, "records": numpy.zeros(5, [("a", "f4")]),
             "infinite": VALUES + numpy.inf, "long": VALUES.astype(numpy.longdouble)}
    assert pellucid.Mesh(POINTS, CELLS, {**other, "v": VALUES}, channels=["v"]).range == (0, 4)
    assert pellucid.Mesh(POINTS, CELLS, {"text": ["a"] * 5, "v": VALUES}).range == (0, 4)
    with pytest.raises(pellucid.Error, match="text; give an array of numbers"):
        pellucid.Mesh(POINTS, CELLS, {"text": ["a"] * 5})
    with pytest.raises(pellucid.Error, match="there is no array \"w\"; it has \"v\""):
        pellucid.Mesh(POINTS, CELLS, {"v": VALUES}, channels=["v", "w"])


def test_masked_cells_are_refused():
    cells = numpy.ma.MaskedArray(CELLS, [[False] * 4, [False, False, False, True]])
    with pytest.raises(pellucid.Error, match="masked"):
        pellucid.Mesh(POINTS, {"tetra": cells}, {"v": VALUES})
    assert same(pellucid.Mesh(POINTS, {"tetra": numpy.ma.MaskedArray(CELLS)}, {"v": VALUES}),
                pellucid.Mesh(POINTS, CELLS, {"v": VALUES}))


def test_cells_of_too_many_points_are_told():
    more = numpy.hstack([CELLS, CELLS[:, :1]])
    with pytest.warns(pellucid.Note, match="2 of 2 cells list more points than their shape has"):
        pellucid.Mesh(POINTS, {10: more}, {"v": VALUES})


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
    ((POINTS, CELLS, {"v": numpy.zeros((5, 0))}), "there are 5 points"),
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
