# SPDX-License-Identifier: Apache-2.0
"""Runs the program and makes small files for it. Standard library only."""

import json
import math
import os
import re
import shutil
import struct
import subprocess
import tempfile
import unittest
import zlib

PROGRAM = os.environ.get("PELLUCID_PROGRAM", "pellucid")
SOURCE_DIR = os.environ.get(
    "PELLUCID_SOURCE_DIR",
    os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")))

# A transfer function that shows every value of the small volumes below.
HAZE = {"points": [{"value": 0, "extinction": 0.5, "color": [1, 0, 0]},
                   {"value": 1, "extinction": 1.5, "color": [0, 0, 1]}]}

# Cells that overlap, whose error is not known where they do.
OVERLAPPING = """# vtk DataFile Version 3.0
two cells
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 5 float
0 0 0  1 0 0  0 1 0  0 0 1  0.2 0.2 0.8
CELLS 2 10
4 0 1 2 3
4 0 1 2 4
CELL_TYPES 2
10 10
POINT_DATA 5
SCALARS v float 1
LOOKUP_TABLE default
0 1 2 3 4
"""


class ProgramTest(unittest.TestCase):
    """Each test has a folder of its own, which is the working folder of the program."""

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="pellucid_cli_")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, content):
        mode = "wb" if isinstance(content, bytes) else "w"
        newline = {} if mode == "wb" else {"newline": ""}
        with open(self.path(name), mode, **newline) as file:
            file.write(content)
        return name

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def files(self):
        return sorted(os.listdir(self.folder))

    def run_program(self, *arguments, **options):
        return subprocess.run([PROGRAM, *arguments], cwd=self.folder, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, timeout=3600, check=False, **options)

    def succeed(self, *arguments):
        """Runs, expects exit code 0 and gives stdout."""
        result = self.run_program(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr.decode(errors="replace"))
        return result.stdout.decode()

    def report(self, *arguments):
        """Runs with --json and gives what it printed."""
        text = self.succeed(*arguments, "--json")
        return json.loads(text, parse_constant=lambda name: self.fail(f"{name} is not JSON"))

    def fail_with(self, pattern, *arguments, code=1):
        """Runs, expects exactly one line on stderr and no new or changed file."""
        before = {name: self.read(name) for name in self.files()
                  if os.path.isfile(self.path(name)) and os.access(self.path(name), os.R_OK)}
        names_before = self.files()
        result = self.run_program(*arguments)
        message = result.stderr.decode(errors="replace")
        self.assertEqual(result.returncode, code, f"{arguments}: {message}")
        self.assertRegex(message, r"\Apellucid: error: [^\n]+\n\Z")
        self.assertRegex(message, pattern)
        self.assertEqual(result.stdout, b"")
        self.assertEqual(self.files(), names_before, "a file was left behind")
        for name, content in before.items():
            self.assertEqual(self.read(name), content, f"{name} was changed")
        return message


def npy(values, dimensions, kind="<f4"):
    """A .npy file of values with x fastest; its shape is (z, y, x) in C order."""
    shape = tuple(reversed(dimensions))
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}"
    header += " " * (-(len(header) + 11) % 64) + "\n"
    codes = {"f4": "f", "f8": "d", "u1": "B", "i2": "h", "u2": "H"}
    order = ">" if kind[0] == ">" else "<"
    data = struct.pack(f"{order}{len(values)}{codes[kind[1:]]}", *values)
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + data


def ramp(n):
    """n³ values from 0 to 1 along x."""
    return [i / (n - 1) for _ in range(n) for _ in range(n) for i in range(n)]


def exr(pixels, error=None, proved=None, depth=None):
    """An uncompressed OpenEXR file of float RGBA; `pixels` is a list of rows of (r, g, b, a).

    `error`, `proved` and `depth` are rows of numbers for the channels error (float), error.proved
    (half) and Z (float).
    """
    height, width = len(pixels), len(pixels[0])
    planes = {name: (2, [[pixel[c] for pixel in row] for row in pixels])
              for name, c in ((b"A", 3), (b"B", 2), (b"G", 1), (b"R", 0))}
    if depth is not None:
        planes[b"Z"] = (2, depth)
    if error is not None:
        planes[b"error"] = (2, error)
    if proved is not None:
        planes[b"error.proved"] = (1, proved)

    def attribute(name, kind, value):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value

    channels = b"".join(name + b"\0" + struct.pack("<iB3xii", kind, 0, 1, 1)
                        for name, (kind, _) in planes.items())
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = struct.pack("<ii", 20000630, 2)
    head += attribute(b"channels", b"chlist", channels + b"\0")
    head += attribute(b"compression", b"compression", b"\0")
    head += attribute(b"dataWindow", b"box2i", window)
    head += attribute(b"displayWindow", b"box2i", window)
    head += attribute(b"lineOrder", b"lineOrder", b"\0")
    head += attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
    head += attribute(b"screenWindowCenter", b"v2f", struct.pack("<ff", 0, 0))
    head += attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0"
    size = sum(2 * kind for kind, _ in planes.values()) * width
    offsets = b"".join(struct.pack("<Q", len(head) + 8 * height + y * (8 + size))
                       for y in range(height))
    body = b""
    for y in range(height):
        body += struct.pack("<ii", y, size)
        for kind, rows in planes.values():
            body += struct.pack(f"<{width}{'_ef'[kind]}", *rows[y])
    return head + offsets + body


def exr_attributes(data):
    """The header of a single-part OpenEXR file: name to (type, bytes)."""
    assert data[:4] == struct.pack("<i", 20000630)
    attributes, at = {}, 8
    while data[at] != 0:
        name, kind = (part.decode() for part in data[at:].split(b"\0", 2)[:2])
        at += len(name) + len(kind) + 2
        size = struct.unpack_from("<i", data, at)[0]
        attributes[name] = (kind, data[at + 4:at + 4 + size])
        at += 4 + size
    return attributes


def exr_channels(data):
    """The channels of an OpenEXR file: name to type (1 half, 2 float)."""
    found, text = {}, exr_attributes(data)["channels"][1]
    while text[0] != 0:
        name, text = text.split(b"\0", 1)
        found[name.decode()] = struct.unpack_from("<i", text)[0]
        text = text[16:]
    return found


def exr_texts(data):
    """Its string attributes."""
    return {name: value.decode() for name, (kind, value) in exr_attributes(data).items()
            if kind == "string"}


def png_texts(data):
    """The texts of a PNG: its chunks iTXt, compressed or not."""
    texts, at = {}, 8
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        if kind == b"iTXt":
            key, _, rest = data[at + 8:at + 8 + size].partition(b"\0")
            value = rest[2:].split(b"\0", 2)[2]
            texts[key.decode()] = (zlib.decompress(value) if rest[0] else value).decode()
        at += 12 + size
    return texts


def png(data):
    """Width, height, channels and the rows of bytes of an 8-bit PNG."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, compressed, header = 8, b"", None
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        chunk = data[at + 8:at + 8 + size]
        assert zlib.crc32(kind + chunk) == struct.unpack_from(">I", data, at + 8 + size)[0]
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", chunk)
        if kind == b"IDAT":
            compressed += chunk
        at += 12 + size
    width, height, depth, color, _, _, interlace = header
    assert depth == 8 and interlace == 0
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[color]
    raw, stride, rows = zlib.decompress(compressed), width * channels, []
    above = bytearray(stride)
    for y in range(height):
        kind = raw[y * (stride + 1)]
        row = bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            left = row[i - channels] if i >= channels else 0
            corner = above[i - channels] if i >= channels else 0
            if kind == 1:
                row[i] = (row[i] + left) & 255
            elif kind == 2:
                row[i] = (row[i] + above[i]) & 255
            elif kind == 3:
                row[i] = (row[i] + (left + above[i]) // 2) & 255
            elif kind == 4:
                p = left + above[i] - corner
                a, b, c = abs(p - left), abs(p - above[i]), abs(p - corner)
                nearest = left if a <= b and a <= c else above[i] if b <= c else corner
                row[i] = (row[i] + nearest) & 255
        rows.append(bytes(row))
        above = row
    return width, height, channels, rows


def pixel(picture, column, row):
    _, _, channels, rows = picture
    return tuple(rows[row][channels * column:channels * (column + 1)])


def options_of(help_text):
    """The long options that a help text lists."""
    return sorted(set(re.findall(r"^\s+(?:-\w,)?(--[a-z][a-z-]*)", help_text, re.MULTILINE)))


def is_finite(x):
    return isinstance(x, (int, float)) and math.isfinite(x)
