# SPDX-License-Identifier: Apache-2.0
"""Slices that pages ask for, against NumPy's own interpolation of the same files."""

import gzip
import json
import os
import struct
import sys
import tempfile
import unittest

from viewer_process import Viewer

try:
    import numpy as np
    rng = np.random.default_rng(7)
except ImportError:
    np = None


def write_nifti(path, data, affine):
    """`data[i, j, k]`; `affine` to right, anterior, superior."""
    code = {"float32": 16, "uint8": 2, "int16": 4}[data.dtype.name]
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, *data.shape, 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, code, 8 * data.itemsize)
    struct.pack_into("<8f", header, 76, 1, *np.linalg.norm(affine[:3, :3], axis=0), 0, 0, 0, 0)
    struct.pack_into("<3f", header, 108, 352, 1, 0)
    header[123] = 2  # mm
    struct.pack_into("<2h", header, 252, 0, 1)
    struct.pack_into("<12f", header, 280, *affine[:3].astype("f4").ravel())
    header[344:348] = b"n+1\0"
    with gzip.open(path, "wb") as file:
        file.write(bytes(header) + data.tobytes(order="F"))


def write_nrrd(path, data, origin, directions, centering):
    lines = ["NRRD0004", "type: " + {"float32": "float", "uint8": "uint8"}[data.dtype.name],
             "dimension: 3", "space: left-posterior-superior",
             "sizes: " + " ".join(map(str, data.shape)),
             "space directions: " + " ".join(
                 "(" + ",".join(map(repr, map(float, d))) + ")" for d in directions),
             "space origin: (" + ",".join(map(repr, map(float, origin))) + ")",
             f"centerings: {centering} {centering} {centering}", "endian: little", "encoding: raw"]
    with open(path, "wb") as file:
        file.write(("\n".join(lines) + "\n\n").encode() + data.tobytes(order="F"))


def write_rectilinear(path, data, axes):
    with open(path, "w", encoding="ascii") as file:
        file.write("# vtk DataFile Version 3.0\nx\nASCII\nDATASET RECTILINEAR_GRID\n"
                   f"DIMENSIONS {' '.join(map(str, data.shape))}\n")
        for name, axis in zip("XYZ", axes):
            file.write(f"{name}_COORDINATES {len(axis)} double\n{' '.join(map(repr, axis))}\n")
        file.write(f"POINT_DATA {data.size}\nSCALARS a float 1\nLOOKUP_TABLE default\n")
        file.write(" ".join(repr(float(value)) for value in data.ravel(order="F")) + "\n")


def interpolated(data, index):
    """Trilinear values at positions in indices, (3, n); NaN outside, and in cells with a NaN."""
    data = data.astype(float)
    size = np.array(data.shape)[:, None]
    inside = np.all((index >= 0) & (index <= size - 1), axis=0)
    cell = np.clip(np.floor(index), 0, size - 2).astype(int)
    part = index - cell
    value = np.zeros(index.shape[1])
    for corner in np.ndindex(2, 2, 2):
        which = np.array(corner)[:, None]
        weight = np.prod(np.where(which == 1, part, 1 - part), axis=0)
        value += weight * data[tuple(cell + which)]  # NaN · 0 is NaN: the cell is vacuum
    return np.where(inside, value, np.nan)


class Slices(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="pellucid_view_", ignore_cleanup_errors=True)
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def slices(self, inputs, box, layer=0, channel=0):
        """Each of three slices of a box: the world positions, (3, n), and the message."""
        lower, upper = map(np.array, box)
        with Viewer(*inputs, folder=self.folder) as viewer, viewer.open_socket() as page:
            for axis in range(3):
                u, v = [a for a in range(3) if a != axis]
                position = float(lower[axis] + 0.43 * (upper[axis] - lower[axis]))
                columns, rows = 41, 37
                page.send(type="slice", axis=axis, position=position, layer=layer, channel=channel,
                          **{"from": [float(lower[u]), float(upper[v])],
                             "to": [float(upper[u]), float(lower[v])]}, columns=columns, rows=rows)
                message = page.receive_until(lambda m: m["type"] in ("slice", "error"))
                self.assertEqual(message["type"], "slice", message)
                world = np.empty((3, rows, columns))
                world[axis] = position
                world[u] = (lower[u] + (upper[u] - lower[u]) *
                            (np.arange(columns) + 0.5) / columns)[None, :]
                world[v] = (upper[v] - (upper[v] - lower[v]) *
                            (np.arange(rows) + 0.5) / rows)[:, None]
                yield world.reshape(3, -1), message

    def check_values(self, inputs, box, index_of, data):
        """`index_of`: from world positions, (3, n), to indices."""
        scale = np.nanmax(np.abs(data.astype(float)))
        for world, message in self.slices(inputs, box):
            wanted = interpolated(data, index_of(world))
            found = np.frombuffer(message["bytes"], "<f4", wanted.size)
            # Positions at a border may be rounded to either side of it.
            index = index_of(world)
            near = np.abs(index - np.round(index)).min(axis=0) < 1e-4
            same = (np.isnan(wanted) == np.isnan(found)) | near
            self.assertTrue(same.all())
            both = ~(np.isnan(wanted) | np.isnan(found))
            self.assertGreater(both.sum(), 100)
            self.assertLessEqual(np.abs(wanted - found)[both].max(), 1e-6 * scale)

    def test_nifti_that_is_flipped_and_anisotropic(self):
        data = rng.normal(size=(9, 8, 7)).astype("f4")
        affine = np.diag([-1.5, 2, 3.25, 1])
        affine[:3, 3] = [12, -7, 4]
        write_nifti(self.path("a.nii.gz"), data, affine)
        to_ras = np.diag([-1, -1, 1.0])
        def index_of(world):
            return np.linalg.solve(affine[:3, :3], to_ras @ world - affine[:3, 3:])
        self.check_values(["a.nii.gz"], ([-13, -9, 3], [2, 9, 25]), index_of, data)

    def test_nifti_that_is_oblique(self):
        data = rng.normal(size=(9, 8, 7)).astype("f4")
        data[4, 4, 3] = np.nan
        turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        affine = np.eye(4)
        affine[:3, :3] = turn @ np.diag([1.5, 2, 1])
        affine[:3, 3] = [1, 2, 3]
        affine = affine.astype("f4").astype(float)
        write_nifti(self.path("a.nii.gz"), data, affine)
        to_ras = np.diag([-1, -1, 1.0])
        corners = to_ras @ (affine[:3, :3] @ (np.array(list(np.ndindex(2, 2, 2))).T *
                                              np.array([[8], [7], [6]])) + affine[:3, 3:])
        def index_of(world):
            return np.linalg.solve(affine[:3, :3], to_ras @ world - affine[:3, 3:])
        self.check_values(["a.nii.gz"], (corners.min(axis=1), corners.max(axis=1)), index_of, data)

    def test_nrrd_of_cells(self):
        data = rng.integers(0, 256, size=(9, 8, 7)).astype("u1")
        origin, directions = np.array([1.0, 2, 3]), np.diag([2, 1.5, -1.0])
        write_nrrd(self.path("a.nrrd"), data, origin, directions, "cell")
        def index_of(world):
            index = (world - origin[:, None]) / np.diag(directions)[:, None]
            size = np.array(data.shape)[:, None]
            # The outer half cells have the value of the border.
            outer = (index >= -0.5) & (index <= size - 0.5)
            return np.where(outer, np.clip(index, 0, size - 1), index)
        self.check_values(["a.nrrd"], ([-1, 0, -5], [20, 15, 5]), index_of, data)

    def test_rectilinear(self):
        axes = [np.cumsum(rng.uniform(0.2, 2, size=n)).tolist() for n in (9, 8, 7)]
        data = rng.normal(size=(9, 8, 7)).astype("f4")
        write_rectilinear(self.path("a.vtk"), data, axes)
        def index_of(world):
            return np.array([np.interp(p, axis, range(len(axis)), -1, -1)
                             for p, axis in zip(world, axes)])
        self.check_values(["a.vtk"], ([a[0] - 0.1 for a in axes], [a[-1] + 0.1 for a in axes]),
                          index_of, data)

    def test_labels_over_data(self):
        data = rng.normal(size=(9, 8, 7)).astype("f4")
        labels = rng.integers(0, 3, size=(9, 8, 7)).astype("u1")
        affine = np.diag([-1.5, 2, 3, 1])
        for name, values in (("a.nii.gz", data), ("l.nii.gz", labels)):
            write_nifti(self.path(name), values, affine)
        with open(self.path("scene.json"), "w", encoding="ascii") as file:
            json.dump({"layers": [{"field": {"file": "a.nii.gz"}}, {"labels": {
                "file": "l.nii.gz", "color_space": "srgb", "colors": [
                    {"label": 1, "name": "one", "color": [1, 0.5, 0], "extinction": 1},
                    {"label": 2, "color": [0, 0, 1], "extinction": 1}]}}]}, file)
        found = 0
        for world, message in self.slices(["scene.json"], ([0, -14, 0], [12, 0, 18])):
            index = np.linalg.solve(affine[:3, :3], np.diag([-1, -1, 1.0]) @ world)
            wanted = labels[tuple(np.round(index).astype(int))]
            numbers = np.frombuffer(message["bytes"], "<u2", wanted.size, 4 * wanted.size)
            shown = np.array([0] + [one["label"] for one in message["labels"]])
            clear = np.abs(index - np.floor(index) - 0.5).min(axis=0) > 1e-4
            self.assertTrue((shown[numbers] == wanted)[clear].all())
            one = next(one for one in message["labels"] if one["label"] == 1)
            self.assertEqual((one["name"], one["color"], one["layer"]), ("one", "#ff8000", 1))
            found += 1
        self.assertEqual(found, 3)

    def test_a_position(self):
        data = rng.normal(size=(9, 8, 7)).astype("f4")
        affine = np.diag([-1.5, 2, 3, 1])
        write_nifti(self.path("a.nii.gz"), data, affine)
        with Viewer("a.nii.gz", folder=self.folder) as viewer, viewer.open_socket() as page:
            steps = page.receive_type("scene")["layers"][0]["steps"]
            self.assertEqual(steps[0], {"step": 1.5, "first": 0, "count": 9})
            self.assertEqual(steps[1], {"step": 2, "first": -14, "count": 8})
            page.send(type="locate", position=[4.6, -5.9, 9.2])
            located = page.receive_type("located")
            self.assertEqual(located["voxels"], [{"layer": 0, "index": [3, 3, 3]}])
            self.assertEqual([one["channel"] for one in located["values"]], ["value"])
            wanted = interpolated(data, np.array([[4.6 / 1.5], [5.9 / 2], [9.2 / 3]]))
            self.assertAlmostEqual(located["values"][0]["value"], wanted[0], 6)

    def test_slices_do_not_wait_for_a_frame(self):
        with Viewer("builtin:marschner_lobb:200", folder=self.folder) as viewer, \
                viewer.open_socket() as page:
            page.exact_frame()

            def ask():
                page.send(type="slice", axis=2, position=0, layer=0, channel=0, columns=8, rows=8,
                          **{"from": [-1, 1], "to": [1, -1]})
            ask()
            page.receive_type("slice")
            page.send(type="size", width=1500, height=1500)
            page.send(type="tolerance", value=1e-6)
            page.receive_until(lambda m: m["type"] == "frame" and m["width"] == 1500)
            ask()
            first = page.receive_until(lambda m: m["type"] == "slice" or
                                       m["type"] == "frame" and m["state"] == "exact")
            self.assertEqual(first["type"], "slice")


if __name__ == "__main__":
    if np is None:
        print("skipped: NumPy is not installed")
        sys.exit(77)
    unittest.main(verbosity=2)
