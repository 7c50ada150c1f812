# SPDX-License-Identifier: Apache-2.0
"""Steps in time of each format, by the nearest time, whatever their order in the file."""

import json
import os
import struct
import unittest

from program import ProgramTest, npy

# Values of the step at a time are ten times it, all over; steps stand in the order 3, 1, 2.
TIMES = [3.0, 1.0, 2.0]
SIDES = (4, 3, 2)
POINTS = 24


def values_at(time):
    return [10 * time] * POINTS


def floats(values):
    return struct.pack(f"<{len(values)}f", *values)


def all_steps(times=TIMES):
    return [value for time in times for value in values_at(time)]


def nifti(dims, pixdim4=1.0, units=2 | 8, offset=0.0, values=()):
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, *dims)
    struct.pack_into("<2h", header, 70, 16, 32)
    struct.pack_into("<8f", header, 76, 1, 1, 1, 1, pixdim4, 1, 1, 1)
    struct.pack_into("<f", header, 108, 352)
    struct.pack_into("<b", header, 123, units)
    struct.pack_into("<f", header, 136, offset)
    header[344:348] = b"n+1\0"
    return bytes(header) + floats(values)


class Times(ProgramTest):
    def times(self, *arguments):
        return self.report("info", *arguments).get("times", [])

    def value(self, time, *arguments):
        report = self.report("info", *arguments, "--time", str(time))
        self.assertEqual(report["range"][0], report["range"][1])
        return report["range"][0]

    def expect_steps(self, name, *options, times=(1, 2, 3), factor=10):
        """Each time gives its own step, and a time between or outside the nearest one."""
        self.assertEqual(self.times(name, *options), list(times))
        for time in times:
            self.assertAlmostEqual(self.value(time, name, *options), factor * time, places=4)
        self.assertAlmostEqual(self.value(-5, name, *options), factor * times[0], places=4)
        self.assertAlmostEqual(self.value(99, name, *options), factor * times[-1], places=4)

    def notes(self, *arguments):
        result = self.run_program(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stderr.decode()

    def test_nifti(self):
        # Steps at 5, 3.5, 2: the axis of time goes back.
        name = self.write("a.nii", nifti((4, *SIDES, 3, 1, 1, 1), 1.5, 2 | 16, 2.0,
                                         all_steps([2, 3.5, 5])))
        self.expect_steps(name, times=(2, 3.5, 5))
        self.assertIn("3 times (2, 3.5, 5) in ms; --time chooses one",
                      self.notes("info", name))
        self.assertIn("step 2 of 3 is read, time 3.5 ms (nearest to 4)",
                      self.notes("info", name, "--time", "4"))
        # As a component, as ever, and not both.
        self.assertEqual(self.report("info", name, "--component", "2")["range"], [50, 50])
        self.fail_with("give a time or a component, not both", "info", name, "--component", "1",
                       "--time", "2")
        # Shifts (ppm) are no times, and neither are vectors.
        name = self.write("b.nii", nifti((4, *SIDES, 3, 1, 1, 1), 1.5, 2 | 40, 0, all_steps()))
        self.assertEqual(self.times(name), [])
        self.fail_with("has no steps in time", "info", name, "--time", "2")
        # Without a distance they are counted.
        name = self.write("c.nii", nifti((4, *SIDES, 3, 1, 1, 1), 0, 0, 0, all_steps([0, 1, 2])))
        self.expect_steps(name, times=(0, 1, 2))

    def nrrd(self, name, sizes, values, *lines):
        header = ["NRRD0005", "type: float", "dimension: 4", "encoding: raw", "endian: little",
                  "sizes: " + " ".join(map(str, sizes)), *lines]
        return self.write(name, "\n".join(header).encode() + b"\n\n" + floats(values))

    def test_nrrd_wherever_the_axis_of_time_is(self):
        shown = [10, 20, 30]
        for place in range(4):
            sizes = list(SIDES)
            sizes.insert(place, 3)
            kinds = ["domain"] * 3
            kinds.insert(place, "time")
            spacings, mins = ["1"] * 3, ["nan"] * 3
            spacings.insert(place, "0.5")
            mins.insert(place, "7")
            values = []
            for index in range(3 * POINTS):
                before = 1
                for side in sizes[:place]:
                    before *= side
                values.append(shown[index // before % 3])
            name = self.nrrd(f"{place}.nrrd", sizes, values, "kinds: " + " ".join(kinds),
                             "spacings: " + " ".join(spacings), "axis mins: " + " ".join(mins),
                             'units: "mm" "mm" "mm" "s"' if place == 3 else "content: a")
            self.assertEqual(self.times(name), [7, 7.5, 8], place)
            report = self.report("info", name, "--time", "7.5")
            self.assertEqual(report["dimensions"], list(SIDES))
            for time, value in zip((7, 7.5, 8), shown):
                self.assertEqual(self.value(time, name), value, place)
        self.assertIn("in s; --time", self.notes("info", "3.nrrd"))

    def test_nrrd_values_by_their_place(self):
        # Every value differs: that of x, y, z at step t is x + 10 y + 100 z + 1000 t.
        for place in range(4):
            sizes = list(SIDES)
            sizes.insert(place, 3)
            kinds = ["domain"] * 3
            kinds.insert(place, "time")
            values = []
            for index in range(3 * POINTS):
                at = []
                for side in sizes:
                    at.append(index % side)
                    index //= side
                step = at.pop(place)
                values.append(at[0] + 10 * at[1] + 100 * at[2] + 1000 * step)
            name = self.nrrd(f"{place}.nrrd", sizes, values, "kinds: " + " ".join(kinds))
            self.succeed("convert", name, "--time", "2", "-q", "-o", "one.raw")
            data = self.read("one.raw")
            expected = [x + 10 * y + 100 * z + 2000 for z in range(2) for y in range(3)
                        for x in range(4)]
            self.assertEqual(data, floats(expected), place)

    def test_nrrd_of_slicer(self):
        name = self.nrrd("a.nrrd", (3, *SIDES), [value for _ in range(POINTS)
                                                 for value in (30, 10, 20)],
                         "kinds: list domain domain domain", "space: left-posterior-superior",
                         "space directions: none (1,0,0) (0,1,0) (0,0,1)", "space origin: (0,0,0)",
                         "axis 0 index type:=numeric", "axis 0 index values:=3 1 2",
                         "axis 0 index unit:=ms")
        self.expect_steps(name)
        name = self.nrrd("b.nrrd", (3, *SIDES), [value for _ in range(POINTS)
                                                 for value in (30, 10, 20)],
                         "kinds: list domain domain domain",
                         "MultiVolume.FrameLabels:=3,1,2",
                         "MultiVolume.FrameIdentifyingDICOMTagUnits:=ms")
        self.expect_steps(name)
        self.assertIn("in ms", self.notes("info", name))
        # A space of time.
        name = self.nrrd("c.nrrd", (*SIDES, 3), all_steps([3, 2, 1]),
                         "space: left-posterior-superior-time",
                         "space directions: (1,0,0,0) (0,1,0,0) (0,0,1,0) (0,0,0,-1)",
                         "space origin: (0,0,0,3)")
        self.expect_steps(name)
        # Kinds that are no time.
        name = self.nrrd("d.nrrd", (3, *SIDES), all_steps(), "kinds: list domain domain domain")
        self.assertEqual(self.times(name), [])

    def test_meta_image(self):
        head = ("ObjectType = Image\nNDims = 4\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
                "Offset = 0 0 0 3\nElementSpacing = 1 1 1 {}\nDimSize = 4 3 2 3\n{}"
                "ElementType = MET_FLOAT\nElementDataFile = LOCAL\n")
        name = self.write("a.mha", head.format(0.5, "").encode() + floats(all_steps([3, 3.5, 4])))
        self.expect_steps(name, times=(3, 3.5, 4))
        stamps = "".join(f"Seq_Frame000{i}_Timestamp = {time}\n" for i, time in enumerate(TIMES))
        name = self.write("b.mha", head.format(1, stamps).encode() + floats(all_steps()))
        self.expect_steps(name)
        self.assertEqual(self.report("info", name, "--component", "0")["range"], [30, 30])

    def test_numpy(self):
        name = self.write("a.npy", npy(all_steps([0, 1, 2]), (*SIDES, 3)))
        self.assertEqual(self.times(name, "--array-axes", "czyx"), [])
        self.expect_steps(name, "--array-axes", "tzyx", times=(0, 1, 2))
        self.fail_with("has no steps in time", "info", name, "--time", "1", "--array-axes", "czyx")
        self.fail_with("--array-axes", "info", name, "--array-axes", "tczy", code=2)


    def vti(self, name, value, time=None, how="ascii"):
        """An image of one value, all over, as ParaView writes it."""
        field = ""
        if time is not None and how == "ascii":
            field = (f'<FieldData><DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" '
                     f'format="ascii">{time}</DataArray></FieldData>')
        elif time is not None:
            field = (f'<FieldData><DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" '
                     f'format="binary" RangeMin="{time}" RangeMax="{time}">'
                     f'CAAAAAAAAAA=</DataArray></FieldData>')
        numbers = " ".join(str(value) for _ in range(POINTS))
        os.makedirs(os.path.dirname(self.path(name)) or ".", exist_ok=True)
        return self.write(
            name, f'<VTKFile type="ImageData" version="0.1" byte_order="LittleEndian"><ImageData '
                  f'WholeExtent="0 3 0 2 0 1" Origin="0 0 0" Spacing="1 1 1">{field}'
                  f'<Piece Extent="0 3 0 2 0 1"><PointData Scalars="v"><DataArray type="Float32" '
                  f'Name="v" format="ascii">{numbers}</DataArray></PointData></Piece></ImageData>'
                  f'</VTKFile>')

    def legacy(self, name, value, time, binary):
        kind = "BINARY" if binary else "ASCII"
        stated = struct.pack(">d", time) if binary else str(time).encode()
        values = (struct.pack(">24f", *[value] * POINTS) if binary
                  else " ".join(str(value) for _ in range(POINTS)).encode())
        head = (f"# vtk DataFile Version 3.0\na\n{kind}\nDATASET STRUCTURED_POINTS\n"
                "FIELD FieldData 1\nTimeValue 1 1 double\n").encode()
        self.write(name, head + stated + b"\nDIMENSIONS 4 3 2\nSPACING 1 1 1\nORIGIN 0 0 0\n"
                   b"POINT_DATA 24\nSCALARS v float\nLOOKUP_TABLE default\n" + values + b"\n")

    def needs_vtk(self):
        if os.environ.get("PELLUCID_HAS_VTK") == "0":
            self.skipTest("this build does not read VTK files")

    def test_lists_of_images(self):
        self.needs_vtk()
        for time in TIMES:
            self.vti(f"d/s{time:g}.vti", 10 * time)
        inside = "".join(f'<DataSet timestep="{time}" group="" part="0" file="d/s{time:g}.vti"/>'
                         for time in TIMES)
        name = self.write("a.pvd", '<VTKFile type="Collection" version="0.1"><Collection>'
                          + inside + "</Collection></VTKFile>")
        self.expect_steps(name)
        # Without a time the first is read, and a note says so.
        self.assertEqual(self.report("info", name)["range"], [10, 10])
        self.assertIn("the first is read of 3 times (1, 2, 3)", self.notes("info", name))
        self.assertEqual(self.report("info", name, "--array", "v")["array"], "v")
        series = {"file-series-version": "1.0",
                  "files": [{"name": f"d/s{time:g}.vti", "time": time} for time in TIMES]}
        self.expect_steps(self.write("a.vti.series", json.dumps(series)))
        series["files"][0]["time"] = 1
        name = self.write("b.vti.series", json.dumps(series))
        self.fail_with("s3.vti and s1.vti have the same time", "info", name)
        self.fail_with("/files: ", "info", self.write("c.vti.series", "{}"))
        self.fail_with("lists no file", "info", self.write("d.vti.series", '{"files": []}'))
        self.fail_with("s7.vti", "info", self.write(
            "e.vti.series", '{"files": [{"name": "d/s7.vti", "time": 7}]}'))

    def test_patterns_of_files(self):
        self.needs_vtk()
        for time in TIMES:
            self.vti(f"run_{int(time):03}.vti", 10 * time)
        self.vti("run_x.vti", 99)
        for pattern in ("run_%03d.vti", "run_*.vti"):
            self.expect_steps(pattern)
        self.fail_with("no file has a name of this pattern", "info", "walk_*.vti")
        # Times that the files state themselves.
        for how in ("ascii", "binary"):
            for number, time in enumerate((0.5, 0.25, 0.75)):
                self.vti(f"{how}_{number}.vti", 10 * time, time, how)
            self.expect_steps(f"{how}_*.vti", times=(0.25, 0.5, 0.75))
        for binary in (False, True):
            for number, time in enumerate((0.5, 0.25, 0.75)):
                self.legacy(f"l{binary}{number}.vtk", 10 * time, time, binary)
            self.expect_steps(f"l{binary}*.vtk", times=(0.25, 0.5, 0.75))
        for time in (0.5, 0.25):
            self.write(f"v{time}.npy", npy(values_at(time), SIDES))
        self.expect_steps("v*.npy", times=(0.25, 0.5))

    def range_of_mesh(self, report):
        return report["arrays"][0]["components"][0]["range"]

    def test_patterns_of_meshes(self):
        self.needs_vtk()
        grid = ('<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">'
                '<UnstructuredGrid><Piece NumberOfPoints="4" NumberOfCells="1"><Points><DataArray '
                'type="Float32" NumberOfComponents="3" format="ascii">0 0 0 {x} 0 0 0 1 0 0 0 1'
                '</DataArray></Points><Cells><DataArray type="Int32" Name="connectivity" '
                'format="ascii">0 1 2 3</DataArray><DataArray type="Int32" Name="offsets" '
                'format="ascii">4</DataArray><DataArray type="UInt8" Name="types" format="ascii">'
                '10</DataArray></Cells><PointData><DataArray type="Float32" Name="v" '
                'format="ascii">{v} {v} {v} {v}</DataArray></PointData></Piece>'
                '</UnstructuredGrid></VTKFile>')
        for time in TIMES:
            self.write(f"m{time:g}.vtu", grid.format(x=1, v=10 * time))
        series = {"files": [{"name": f"m{time:g}.vtu", "time": time} for time in TIMES]}
        self.write("m.vtu.series", json.dumps(series))
        for name in ("m*.vtu", "m%d.vtu", "m.vtu.series"):
            report = self.report("info", name)
            self.assertEqual((report["times"], report["time"]), ([1, 2, 3], 1))
            for time in TIMES:
                report = self.report("info", name, "--time", str(time))
                self.assertEqual(self.range_of_mesh(report), [10 * time] * 2)
        report = self.report("info", "m*.vtu", "--time", "1.5", "--time-between", "linear")
        self.assertEqual((report["time"], self.range_of_mesh(report)), (1.5, [15, 15]))
        self.write("m3.vtu", grid.format(x=2, v=30))
        self.fail_with("different points or cells", "info", "m*.vtu", "--time", "2.5",
                       "--time-between", "linear")

    def test_linear_between_steps(self):
        name = self.write("a.nii", nifti((4, *SIDES, 3, 1, 1, 1), 1, 2 | 8, 1,
                                         all_steps([1, 2, 3])))
        linear = ("--time-between", "linear")
        for time, value in ((1.25, 12.5), (2, 20), (2.75, 27.5), (0, 10), (9, 30)):
            report = self.report("info", name, "--time", str(time), *linear)
            self.assertEqual(report["range"], [value, value], time)
        self.assertIn("time 1.25 lies between the steps 1 and 2; values are linear between them",
                      self.notes("info", name, "--time", "1.25", *linear))
        self.assertEqual(self.report("info", name, "--time", "1.25", "--time-between",
                                     "nearest")["range"], [10, 10])
        # A field again, which is written, rendered and named in scenes.
        self.succeed("convert", name, "--time", "1.25", *linear, "-q", "-o", "one.raw")
        self.assertEqual(self.read("one.raw"), floats([12.5] * POINTS))
        self.succeed("render", name, "--time", "1.25", *linear, "--save-scene", "s.json", "--size",
                     "8x8", "-q", "-o", "a.exr")
        scene = json.loads(self.read("s.json"))
        self.assertEqual((scene["layers"][0]["field"]["time"],
                          scene["layers"][0]["field"]["time_between"]), (1.25, "linear"))
        self.succeed("render", "s.json", "-q", "-o", "b.exr")
        self.assertTrue(self.report("compare", "a.exr", "b.exr")["identical"])
        del scene["layers"][0]["field"]["time"]
        self.write("t.json", json.dumps(scene))
        self.fail_with('linear between steps in time needs a time', "render", "t.json", "-o",
                       "c.png")
        self.fail_with("--time-between needs a --time", "info", name, *linear, code=2)
        self.fail_with("--time-between", "info", name, "--time", "1", "--time-between", "cubic",
                       code=2)

    def test_linear_between_grids(self):
        self.needs_vtk()
        for time in (1, 2):
            self.vti(f"r{time}.vti", time)
        text = self.read("r2.vti").replace(b'Spacing="1 1 1"', b'Spacing="1 1 2"')
        self.write("r2.vti", text)
        self.fail_with("different grids", "info", "r*.vti", "--time", "1.5", "--time-between",
                       "linear")
        # NaN in either is NaN.
        nan = float("nan")
        values = [nan] + [1] * (POINTS - 1) + [5] * (POINTS - 1) + [nan]
        name = self.write("n.npy", npy(values, (*SIDES, 2)))
        report = self.report("info", name, "--array-axes", "tzyx", "--time", "0.5",
                             "--time-between", "linear")
        self.assertEqual((report["nan"], report["range"], report["type"]), (2, [3, 3], "f32"))


if __name__ == "__main__":
    unittest.main()
