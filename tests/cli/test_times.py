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


if __name__ == "__main__":
    unittest.main()
