# SPDX-License-Identifier: Apache-2.0
"""Folders that are volumes: stores of Zarr, images of OME-Zarr, data sets of vtk.js."""

import json
import os
import struct
import unittest

from program import ProgramTest


class Stores(ProgramTest):
    def make_folder(self, name, files):
        for file, content in files.items():
            path = os.path.join(name, file)
            os.makedirs(os.path.dirname(self.path(path)), exist_ok=True)
            self.write(path, content if isinstance(content, bytes) else json.dumps(content))

    def array(self, name, shape, values):
        self.make_folder(name, {
            ".zarray": {"zarr_format": 2, "shape": shape, "chunks": shape, "dtype": "<f4",
                        "order": "C", "compressor": None, "filters": None, "fill_value": 0},
            ".".join("0" for _ in shape): struct.pack(f"<{len(values)}f", *values)})

    def image(self, name="cells.ome.zarr"):
        axes = [{"name": a, "type": "space", "unit": "micrometer"} for a in "zyx"]
        levels = [{"path": str(i),
                   "coordinateTransformations": [{"type": "scale", "scale": [3, 2, 2 ** i]}]}
                  for i in range(2)]
        self.make_folder(name, {".zgroup": {"zarr_format": 2},
                           ".zattrs": {"multiscales": [{"version": "0.4", "axes": axes,
                                                        "datasets": levels}]}})
        self.array(f"{name}/0", [2, 2, 4], range(16))
        self.array(f"{name}/1", [2, 2, 2], range(8))
        return name

    def test_levels(self):
        name = self.image()
        report = self.report("info", name)
        self.assertEqual(report["dimensions"], [4, 2, 2])
        self.assertEqual(report["spacing"], [1, 2, 3])
        self.assertEqual(report["pyramid"]["unit"], "micrometer")
        self.assertEqual(report["pyramid"]["axes"], "z y x")
        self.assertEqual([level["dimensions"] for level in report["pyramid"]["levels"]],
                         [[4, 2, 2], [2, 2, 2]])
        coarse = self.report("info", name + "/", "--level", "1")
        self.assertEqual((coarse["dimensions"], coarse["range"]), ([2, 2, 2], [0, 7]))
        self.assertEqual(coarse["pyramid"]["level"], 1)
        text = self.succeed("info", name, "--level", "1")
        self.assertIn("\n  1 (1, shown here)  2 x 2 x 2, 2 2 3\n", text)
        self.fail_with("there is no level 2", "info", name, "--level", "2")
        self.fail_with("--level", "info", name, "--level", "-1", code=2)
        self.fail_with("--level applies to volume files", "info", "builtin:ramp", "--level", "0",
                       code=2)

    def test_level_of_a_scene(self):
        name = self.image()
        self.succeed("render", name, "--level", "1", "--save-scene", "s.json", "--size", "8x8",
                     "-q", "-o", "a.exr")
        scene = json.loads(self.read("s.json"))
        self.assertEqual(scene["layers"][0]["field"]["level"], 1)
        self.succeed("render", "s.json", "-q", "-o", "b.exr")
        # Headers name the input; the pixels stand behind them.
        self.assertEqual(self.read("a.exr")[-1000:], self.read("b.exr")[-1000:])

    def test_converting_a_level(self):
        self.succeed("convert", self.image(), "--level", "1", "-q", "-o", "out.nrrd")
        report = self.report("info", "out.nrrd")
        self.assertEqual((report["dimensions"], report["spacing"]), ([2, 2, 2], [2, 2, 3]))

    def test_arrays_of_a_group(self):
        self.make_folder("g.zarr", {".zgroup": {"zarr_format": 2}})
        self.array("g.zarr/a", [2, 2, 2], range(8))
        self.array("g.zarr/b", [2, 2, 2], range(10, 18))
        report = self.report("info", "g.zarr", "--array", "b")
        self.assertEqual((report["array"], report["range"]), ("b", [10, 17]))
        self.assertEqual([array["name"] for array in report["arrays"]], ["a", "b"])

    def test_axes_of_an_array(self):
        self.array("a.zarr", [2, 3, 4], range(24))
        report = self.report("info", "a.zarr", "--axes", "xyz")
        self.assertEqual(report["dimensions"], [2, 3, 4])
        self.fail_with("leave the axes out", "info", self.image(), "--array-axes", "zyx")

    def test_data_set_of_vtk_js(self):
        data = {"data": {"name": "f", "dataType": "Float32Array", "numberOfComponents": 1,
                         "size": 8, "ref": {"encode": "LittleEndian", "basepath": "data",
                                            "id": "f"}}}
        self.make_folder("head.vti", {
            "index.json": {"vtkClass": "vtkImageData", "extent": [0, 1, 0, 1, 0, 1],
                           "origin": [0, 0, 0], "spacing": [1, 2, 3],
                           "pointData": {"arrays": [data]}},
            "data/f": struct.pack("<8f", *range(8))})
        for name in ("head.vti", "head.vti/", os.path.join("head.vti", "index.json")):
            report = self.report("info", name)
            self.assertEqual((report["range"], report["spacing"]), ([0, 7], [1, 2, 3]))
            self.succeed("render", name, "--size", "8x8", "-q", "-o", "a.exr")


if __name__ == "__main__":
    unittest.main()
