# SPDX-License-Identifier: Apache-2.0
"""Damaged files end in pellucid.Error, and never end the interpreter that reads them."""
import os
import random
import struct
import subprocess
import sys

import numpy
import pytest

VALUES = numpy.arange(60, dtype=">f4").reshape(3, 4, 5)
MUTANTS = int(os.environ.get("PELLUCID_TEST_MUTANTS", "40"))

# Reads files by several threads at once; libraries that may crash run in processes of their own.
# Prints the file and what came of it; any other exception than Error, and any signal, is a failure.
READER = """
import concurrent.futures, signal, sys, warnings
import pellucid
if "ignored" in sys.argv[1]:
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
warnings.simplefilter("ignore")

def read(path):
    try:
        pellucid.read(path)
    except pellucid.Error as error:
        assert "\\n" not in str(error), (path, str(error))
        return "refused: " + str(error)
    except MemoryError:
        return "refused: memory"
    return "read"

with concurrent.futures.ThreadPoolExecutor(4) as pool:
    for path, said in zip(sys.argv[2:], pool.map(read, sys.argv[2:])):
        print(path, said)
print("alive")
"""


def results(files, children="waited for"):
    """What came of each file."""
    run = subprocess.run([sys.executable, "-c", READER, children, *map(str, files)],
                         capture_output=True, text=True, check=False, timeout=500)
    assert run.returncode == 0, (run.returncode, run.stderr[-2000:])
    lines = run.stdout.splitlines()
    assert lines[-1] == "alive"
    return [line.split(" ", 1)[1] for line in lines[:-1]]


def net_cdf(path):
    """Writes a NetCDF file of the classic format: a variable v(z, y, x) of floats."""
    def name(text):
        return struct.pack(">i", len(text)) + text.encode().ljust(-len(text) % 4 + len(text), b"\0")

    sides = dict(zip("zyx", VALUES.shape))
    head = b"CDF\x01" + struct.pack(">i", 0)
    head += struct.pack(">ii", 10, 3) + b"".join(
        name(axis) + struct.pack(">i", side) for axis, side in sides.items())
    head += struct.pack(">ii", 0, 0)
    head += struct.pack(">ii", 11, 1) + name("v") + struct.pack(">iiii", 3, 0, 1, 2)
    head += struct.pack(">ii", 0, 0) + struct.pack(">ii", 5, VALUES.nbytes)
    path.write_bytes(head + struct.pack(">i", len(head) + 4) + VALUES.tobytes())


def hdf5(path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w") as file:
        file.create_dataset("v", data=VALUES, chunks=(2, 2, 3), compression="gzip")


def polyhedron(path):
    """Writes a .vtu with a prism as a polyhedron."""
    faces = [[0, 2, 1], [3, 4, 5], [0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]]
    entries = [len(faces), *(number for face in faces for number in (len(face), *face))]

    def array(kind, name, numbers, more=""):
        return (f'<DataArray type="{kind}" Name="{name}" format="ascii"{more}>'
                + " ".join(map(str, numbers)) + "</DataArray>")

    path.write_text(
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian">'
        '<UnstructuredGrid><Piece NumberOfPoints="6" NumberOfCells="1"><PointData Scalars="v">'
        + array("Float32", "v", range(6)) + "</PointData><Points>"
        + array("Float32", "Points", [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1],
                ' NumberOfComponents="3"') + "</Points><Cells>"
        + array("Int64", "connectivity", range(6)) + array("Int64", "offsets", [6])
        + array("UInt8", "types", [42]) + array("Int64", "faces", entries)
        + array("Int64", "faceoffsets", [len(entries)])
        + "</Cells></Piece></UnstructuredGrid></VTKFile>")


SEEDS = {"a.nc": net_cdf, "a.h5": hdf5, "a.vtu": polyhedron}


def mutant(content, chance):
    """Cuts, fills or changes some bytes."""
    content = bytearray(content)
    kind = chance.randrange(4)
    at = chance.randrange(len(content))
    if kind == 0:
        del content[at:]
    elif kind == 1:
        end = min(len(content), at + chance.choice([1, 2, 4, 8]))
        content[at:end] = chance.choice([b"\0", b"\xff", b"\x7f"]) * (end - at)
    else:
        for _ in range(chance.randrange(1, 6)):
            content[chance.randrange(len(content))] = chance.randrange(256)
    return bytes(content)


@pytest.mark.parametrize("name", SEEDS)
def test_mutants_never_end_the_interpreter(tmp_path, name):
    seed = tmp_path / name
    SEEDS[name](seed)
    (first,) = results([seed])
    if "was built without" in first or "module" in first:
        pytest.skip(first)
    assert first == "read"
    chance = random.Random(7)
    files = []
    for i in range(MUTANTS):
        files.append(tmp_path / f"{i}{seed.suffix}")
        files[-1].write_bytes(mutant(seed.read_bytes(), chance))
    said = results(files)
    assert len(said) == len(files) and any(each != "read" for each in said)
    assert results([seed]) == ["read"]


def test_children_that_nobody_waits_for(tmp_path):
    """A program that ignores SIGCHLD has no status of the process that reads."""
    net_cdf(tmp_path / "a.nc")
    (tmp_path / "b.nc").write_bytes((tmp_path / "a.nc").read_bytes()[:90])
    first, second = results([tmp_path / "a.nc", tmp_path / "b.nc"], "ignored")
    if "was built without" in first:
        pytest.skip(first)
    assert first == "read" and second.startswith("refused")


@pytest.mark.skipif("PELLUCID_SANITIZED" in os.environ, reason="sanitizers reserve address space")
def test_too_little_memory_for_a_library_is_told(tmp_path):
    """That a library is not there is another thing, and has another remedy."""
    path = tmp_path / "a.vtk"
    path.write_text("# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET STRUCTURED_POINTS\n"
                    "DIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 8\n"
                    "SCALARS v float 1\nLOOKUP_TABLE default\n0 1 2 3 4 5 6 7\n")
    command = [os.environ["PELLUCID_PROGRAM"], "info", str(path)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        pytest.skip("this build reads none of VTK's files")
    for limit in (60000, 100000):
        limited = f"ulimit -v {limit}; exec \"$@\""
        run = subprocess.run(["bash", "-c", limited, "bash", *command],
                             capture_output=True, text=True, check=False)
        assert run.returncode != 0 and run.stderr.count("\n") == 1, run.stderr
        assert "ulimit -v" in run.stderr and "install" not in run.stderr, run.stderr
