# SPDX-License-Identifier: Apache-2.0
"""DICOM series and stacks of images: folders as input, --series, and what is told of them."""

import json
import os
import struct
import unittest

from program import ProgramTest


def element(tag, kind, value):
    value += b"" if len(value) % 2 == 0 else b"\0" if kind == "UI" else b" "
    length = struct.pack("<2xI", len(value)) if kind == "OW" else struct.pack("<H", len(value))
    return struct.pack("<HH", tag >> 16, tag & 0xffff) + kind.encode() + length + value


def dicom(z, first, uid=b"1.2.3.4", description=b"head", more=()):
    """A slice of 3 x 2 values from `first` on at height z, explicit and little-endian."""
    def us(value):
        return struct.pack("<H", value)
    elements = {
        0x00080060: ("CS", b"CT"), 0x0008103e: ("LO", description), 0x00180050: ("DS", b"8"),
        0x0020000e: ("UI", uid), 0x00200013: ("IS", b"1"),
        0x00200032: ("DS", b"0\\0\\%d" % z), 0x00200037: ("DS", b"1\\0\\0\\0\\1\\0"),
        0x00280002: ("US", us(1)), 0x00280004: ("CS", b"MONOCHROME2"), 0x00280010: ("US", us(2)),
        0x00280011: ("US", us(3)), 0x00280030: ("DS", b"2\\1"), 0x00280100: ("US", us(16)),
        0x00280101: ("US", us(12)), 0x00280102: ("US", us(11)), 0x00280103: ("US", us(0)),
        0x00281052: ("DS", b"-1024"), 0x00281053: ("DS", b"1"),
        0x7fe00010: ("OW", struct.pack("<6H", *range(first, first + 6)))}
    elements.update(more)
    body = b"".join(element(tag, *elements[tag]) for tag in sorted(elements))
    return bytes(128) + b"DICM" + element(0x00020010, "UI", b"1.2.840.10008.1.2.1") + body


class Series(ProgramTest):
    def setUp(self):
        super().setUp()
        os.mkdir(self.path("ct"))
        for k in range(4):
            self.write(f"ct/{9 - k}", dicom(12 * k, 1000 + 6 * k))

    def add_other(self):
        for k in range(3):
            self.write(f"ct/other{k}", dicom(k, 0, b"1.2.3.99", b"other\x1b"))

    def test_a_folder_is_a_volume(self):
        for given in ("ct", "ct/8"):
            report = self.report("info", given)
            self.assertEqual(report["dimensions"], [3, 2, 4])
            self.assertEqual(report["spacing"], [1, 2, 12])
            self.assertEqual(report["type"], "i16")
            self.assertEqual(report["range"], [-24, -1])
            self.assertEqual(report["orientation"], "LPS")
        self.succeed("render", "ct", "-o", "o.png", "--size", "8")
        self.succeed("convert", "ct", "-o", "o.vtu")

    def test_acquisitions_between_each_other_are_series(self):
        os.mkdir(self.path("two"))
        for k in range(8):
            more = {0x00200012: ("IS", b"%d" % (1 + k // 4)), 0x00200013: ("IS", b"%d" % (k + 1))}
            self.write(f"two/{k}", dicom(30 + 4 * (k % 4) + 2 * (k // 4), 1000 + 6 * k, more=more))
        report = self.report("info", "two")
        self.assertEqual([s["slices"] for s in report["series"]], [4, 4])
        self.assertEqual(report["series"][1]["description"], "head, AcquisitionNumber 2")
        self.fail_with("2 DICOM series", "render", "two", "-o", "o.png")
        report = self.report("info", "two", "--series", "2")
        self.assertEqual(report["range"], [0, 23])
        self.assertEqual(report["spacing"], [1, 2, 4])

    def test_several_series_are_listed_and_chosen(self):
        self.add_other()
        report = self.report("info", "ct")
        self.assertEqual([s["uid"] for s in report["series"]], ["1.2.3.4", "1.2.3.99"])
        self.assertEqual([s["slices"] for s in report["series"]], [4, 3])
        self.assertEqual(report["series"][1]["number"], 2)
        text = self.succeed("info", "ct")
        self.assertRegex(text, r"(?m)^ +2 other\?, CT, 3 x 2 x 3, UID 1\.2\.3\.99$")
        self.fail_with(r"2 DICOM series, 1: head \(CT, 4 slices of 3 x 2\), 2: other", "render",
                       "ct", "-o", "o.png")
        for chosen, slices in (("1", 4), ("2", 3), ("99", 3), ("1.2.3.4", 4)):
            self.assertEqual(self.report("info", "ct", "--series", chosen)["dimensions"][2], slices)
        self.fail_with("none of its series", "info", "ct", "--series", "3")
        self.write("a.raw", bytes(8))
        self.fail_with("no DICOM", "info", "a.raw", "--dimensions", "2,2,2", "--type", "u8",
                       "--series", "1")

    def test_scenes_keep_the_series(self):
        self.add_other()
        self.succeed("render", "ct", "--series", "99", "--save-scene", "s.json", "-o", "a.exr",
                     "--size", "8")
        scene = json.loads(self.read("s.json"))
        self.assertEqual(scene["layers"][0]["field"]["series"], "99")
        self.succeed("render", "s.json", "-o", "b.exr")
        self.succeed("compare", "a.exr", "b.exr")
        scene["layers"][0]["field"]["series"] = "7"
        self.write("s.json", json.dumps(scene))
        self.fail_with("none of its series", "render", "s.json", "-o", "c.png")

    def test_what_is_assumed_is_told(self):
        self.write("ct/notes.txt", "hello")
        self.write("ct/7", dicom(30, 1012))
        result = self.run_program("info", "ct")
        self.assertEqual(result.returncode, 0)
        self.assertEqual(result.stderr.decode().splitlines(), [
            "pellucid: ct: 1 file holds no DICOM image and is left out",
            "pellucid: ct: the distance of slices is 12 mm, but 18 mm from 8 to 7; the grid is "
            "rectilinear"])
        noted = self.run_program("render", "ct", "-o", "o.png", "--size", "8").stderr
        self.assertIn(b"rectilinear", noted)
        quiet = self.run_program("render", "ct", "-o", "o.png", "--size", "8", "-q")
        self.assertEqual((quiet.returncode, quiet.stderr), (0, b""))

    def test_bad_folders(self):
        os.mkdir(self.path("empty"))
        for command in (("info",), ("render", "-o", "o.png")):
            self.fail_with("no DICOM file and no .tif", *command, "empty")
            self.write("ct/9", dicom(12, 0))
            self.fail_with("8 and 9 stand at the same place", *command, "ct")
            self.write("ct/9", dicom(0, 0)[:-1])
            size = ("--size", "8") if "render" in command else ()
            result = self.run_program(*command, "ct", *size)
            self.assertEqual(result.returncode, 0)
            self.assertRegex(result.stderr.decode(), r"(?m)^pellucid: ct: 1 file is left out: ct/9:"
                             " has 11 bytes of pixels, but its header needs 12")
            self.fail_with("ct/9: has 11 bytes of pixels, but its header needs 12", *command,
                           "ct/9")
            os.remove(self.path("ct/9"))

    def test_damaged_files_of_several_series(self):
        self.add_other()
        self.write("ct/9", dicom(0, 0)[:-1])
        self.write("ct/91", dicom(0, 0)[:150])
        self.write("ct/empty.dcm", b"")
        result = self.run_program("info", "ct")
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stderr.decode(),
                         r"\Apellucid: ct: 3 files are left out; the first: "
                         r"ct/9: has 11 bytes of pixels[^\n]*\n\Z")
        self.assertIn(b"choose one by --series", result.stdout)
        self.fail_with("2 DICOM series[^\n]*; 3 files are left out; the first: ct/9: ", "render",
                       "ct", "-o", "o.png")


class Stacks(ProgramTest):
    def test_a_pattern_of_images(self):
        def tiff(first):
            fields = ((256, 3), (257, 2), (258, 8), (259, 1), (262, 1), (273, 8), (277, 1),
                      (278, 2), (279, 6))
            directory = struct.pack("<H", len(fields)) + b"".join(
                struct.pack("<HHII", tag, 4, 1, value) for tag, value in fields) + bytes(4)
            return b"II*\0" + struct.pack("<I", 14) + bytes(range(first, first + 6)) + directory
        for k in range(12):
            self.write(f"slice{k}.tif", tiff(6 * k))
        for given in ("slice%d.tif", "slice3.tif", "."):
            report = self.report("info", given, "--spacing", "1,1,2")
            self.assertEqual(report["dimensions"], [3, 2, 12])
            self.assertEqual(report["range"], [0, 71])
            self.assertEqual(report["world_box"][1], [2, 1, 22])
        self.succeed("render", "slice%d.tif", "-o", "o.png", "--size", "8")
        os.remove(self.path("slice5.tif"))
        self.fail_with("by 2 from slice4.tif to slice6.tif", "info", "slice%d.tif")

    def test_components_by_name(self):
        xml = (b'<OME><Image Name="a"><Pixels DimensionOrder="XYZCT" SizeX="3" SizeY="2" SizeZ="2" '
               b'SizeC="2" SizeT="1"><Channel Name="DAPI"/><Channel Name="1"/></Pixels></Image>'
               b'</OME>\0')
        data = b"II*\0" + bytes(4) + xml + bytes(range(24))
        link = 4
        for page in range(4):
            fields = [(256, 4, 1, 3), (257, 4, 1, 2), (258, 4, 1, 8), (259, 4, 1, 1),
                      (262, 4, 1, 1), (273, 4, 1, 8 + len(xml) + 6 * page), (277, 4, 1, 1),
                      (278, 4, 1, 2), (279, 4, 1, 6)]
            if page == 0:
                fields.insert(5, (270, 2, len(xml), 8))
            data = data[:link] + struct.pack("<I", len(data)) + data[link + 4:]
            data += struct.pack("<H", len(fields)) + b"".join(
                struct.pack("<HHII", *field) for field in fields)
            link = len(data)
            data += bytes(4)
        self.write("a.ome.tif", data)
        self.assertEqual(len(self.report("info", "a.ome.tif")["components"]), 2)
        report = self.report("info", "a.ome.tif", "--component", "DAPI")
        self.assertEqual(report["range"], [0, 11])
        # A number is a number, whatever names there are.
        self.assertEqual(self.report("info", "a.ome.tif", "--component", "1")["range"], [12, 23])
        self.fail_with("no component is called \"GFP\"; their names are DAPI, 1", "render",
                       "a.ome.tif", "-q", "--component", "GFP", "-o", "o.png")
        self.succeed("render", "a.ome.tif", "--component", "DAPI", "-o", "o.png", "--size", "8")


if __name__ == "__main__":
    unittest.main()
