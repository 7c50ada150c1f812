# SPDX-License-Identifier: Apache-2.0
"""What the tests of the Python module share: the program, and pictures of both to the bit."""
import os
import subprocess

import numpy
import pytest

import pellucid

SIZE = 40


class Program:
    """Runs `pellucid`, and keeps its pictures in a folder."""

    def __init__(self, folder):
        self.folder = folder

    def __call__(self, *arguments):
        """Returns what it prints."""
        result = subprocess.run([os.environ["PELLUCID_PROGRAM"], *map(str, arguments)],
                                capture_output=True, text=True, check=False)
        assert result.returncode == 0, result.stderr
        return result.stdout

    def render(self, *arguments):
        """Returns its picture of SIZE pixels, with error and depth."""
        path = self.folder / "program.exr"
        self("render", *arguments, "--size", f"{SIZE}x{SIZE}", "-o", path, "--quiet")
        return pellucid.read_image(path)


@pytest.fixture
def program(tmp_path):
    return Program(tmp_path)


def assert_same_bits(image, expected):
    """Pixels, errors, what is proved, and depths."""
    for name in ("rgba", "error", "proved", "depth"):
        ours, theirs = getattr(image, name), getattr(expected, name)
        assert ours.shape == theirs.shape, name
        different = numpy.count_nonzero(ours.view(numpy.uint8) != theirs.view(numpy.uint8))
        assert different == 0, f"{name}: {different} bytes differ"


def render(data, **options):
    return pellucid.render(data, size=SIZE, depth=True, **options)


def smooth(dtype=numpy.float32, shape=(7, 9, 11)):
    """A ball in a box, over the range of the type, with no symmetry."""
    z, y, x = numpy.meshgrid(*(numpy.linspace(-1, 1, n) for n in shape), indexing="ij")
    ball = numpy.clip(1.3 - numpy.sqrt((x - 0.1) ** 2 + (y + 0.2) ** 2 + z ** 2), 0, None)
    dtype = numpy.dtype(dtype)
    if dtype.kind == "b":
        return ball > 0.6
    return (100 * ball).astype(dtype)
