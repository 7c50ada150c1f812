#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Uses an installed wheel as somebody would who has it and numpy alone.

  try_wheel.py [PICTURE.npz]

Renders each look and compares the picture with that of the reference renderer. Reads files of
formats that need each of the libraries inside of the wheel, and is told what it lacks. Needs numpy
and the standard library. With an argument, keeps the pictures of all looks there, or, if the file
is there, compares them with those to the bit.
"""
import bz2
import gzip
import json
import os
import pathlib
import struct
import sys
import tempfile
import warnings
import zlib

import numpy

import pellucid

SIZE = 24
TOLERANCE = 1 / 1024
made = []


def done(what):
    made.append(what)
    print(f"  {what}", flush=True)


# ----- pictures ---------------------------------------------------------------------------------

def ball(shape=(14, 15, 16)):
    """1.3 in the middle, 0 at the border; no symmetry."""
    z, y, x = numpy.meshgrid(*(numpy.linspace(-1, 1, n) for n in shape), indexing="ij")
    return numpy.clip(1.3 - numpy.sqrt((x - 0.1) ** 2 + (y + 0.2) ** 2 + z ** 2), 0, None)


def mesh():
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)]
    return pellucid.Mesh(points, {"tetra": [(0, 1, 2, 3), (1, 2, 3, 4)]},
                         {"speed": numpy.arange(5.0)})


def data_for(look):
    values = ball()
    if look in ("ct", "ct-skin"):
        return numpy.where(values > 0.7, 900, numpy.where(values > 0.3, 40, -1000)).astype("i2")
    if look == "labels":
        return (3 * values).astype("u1")
    if look == "mask":
        return (values > 0.5).astype("u1")
    if look == "body":
        return mesh()
    return values.astype("f4")


def pictures():
    """{look: pixels}, each within its errors of the reference's."""
    found = {}
    for name in [*pellucid.looks(), "body"]:
        layer = pellucid.look(data_for(name), name)
        scene = pellucid.Scene([layer], size=(SIZE, SIZE))
        scene.integration = pellucid.Integration(tolerance=TOLERANCE)
        scene.camera = pellucid.default_camera(scene)
        image = pellucid.Renderer().render(scene)
        truth = pellucid.render_reference(scene)
        compared = image.compare(truth)
        assert compared.not_finite == 0, f"{name}: numbers that are not finite"
        assert compared.largest <= TOLERANCE, f"{name}: off by {compared.largest}"
        assert compared.over_errors == 0, f"{name}: {compared.over_errors} pixels over their errors"
        opacity = float(image.rgba[..., 3].max())
        assert opacity > 0.01, f"{name}: nothing is to be seen"
        found[name] = image.rgba
        done(f"look {name}: within {compared.largest:.2g} of the reference")
    assert len(found) >= 12, f"looks are missing: {sorted(found)}"
    return found


def same_everywhere(found, path):
    """Keeps pictures, or compares them with those kept on another machine."""
    if not os.path.exists(path):
        numpy.savez(path, **found)
        return
    kept = numpy.load(path)
    assert sorted(kept.files) == sorted(found)
    for name, pixels in found.items():
        assert numpy.array_equal(kept[name], pixels), f"{name}: other pixels than in {path}"
    done(f"the same {len(found)} pictures to the bit as in {path}")


# ----- files ------------------------------------------------------------------------------------

def png(pixels):
    """A gray image of 8 bits."""
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    height, width = pixels.shape
    parts = [(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)),
             (b"IDAT", zlib.compress(rows)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in parts)


def tiff(pages, compression, pack):
    """Pages of 8 bits, or of one bit for JBIG."""
    data, links = bytearray(b"II*\0\0\0\0\0"), 4
    for page in pages:
        packed = pack(page)
        bits = 1 if compression == 34661 else 8
        begin = len(data)
        data += packed + b"\0" * (len(packed) % 2)
        struct.pack_into("<I", data, links, len(data))
        tags = [(256, page.shape[1]), (257, page.shape[0]), (258, bits), (259, compression),
                (262, 1), (273, begin), (277, 1), (278, page.shape[0]), (279, len(packed))]
        data += struct.pack("<H", len(tags))
        for tag, value in tags:
            data += struct.pack("<HHII", tag, 4, 1, value)
        links = len(data)
        data += b"\0\0\0\0"
    return bytes(data)


def nifti(values):
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, *values.shape[::-1], 1, 1, 1, 1)
    struct.pack_into("<hh", header, 70, 16, 32)
    struct.pack_into("<8f", header, 76, 1, 1, 1, 1, 0, 0, 0, 0)
    struct.pack_into("<ff", header, 108, 352, 1)
    header[344:348] = b"n+1\0"
    return bytes(header) + values.astype("<f4").tobytes()


def nrrd(values):
    sizes = " ".join(map(str, values.shape[::-1]))
    return (f"NRRD0004\ntype: uchar\ndimension: 3\nsizes: {sizes}\nencoding: raw\n"
            "spacings: 1 1 1\n\n").encode() + values.tobytes()


def element(group, number, kind, data):
    data += b"\0" * (len(data) % 2)
    head = struct.pack("<HH2s", group, number, kind.encode())
    if kind in ("OB", "OW", "SQ", "UN"):
        return head + struct.pack("<HI", 0, len(data)) + data
    return head + struct.pack("<H", len(data)) + data


def dicom(pixels, place):
    """A slice of 8 bits, compressed by runs (RLE): GDCM decompresses it."""
    def text(group, number, kind, value):
        data = value.encode()
        data += (b"\0" if kind == "UI" else b" ") * (len(data) % 2)
        return element(group, number, kind, data)

    meta = (element(2, 1, "OB", b"\0\1") + text(2, 2, "UI", "1.2.840.10008.5.1.4.1.1.7")
            + text(2, 3, "UI", f"1.2.3.{place + 1}") + text(2, 16, "UI", "1.2.840.10008.1.2.5"))
    packed = b"".join(struct.pack("B", len(part) - 1) + part for part in (
        pixels.tobytes()[i:i + 128] for i in range(0, pixels.size, 128)))
    packed = struct.pack("<16I", 1, 64, *[0] * 14) + packed
    packed += b"\0" * (len(packed) % 2)
    item = struct.pack("<HHI", 0xfffe, 0xe000, 0)
    item += struct.pack("<HHI", 0xfffe, 0xe000, len(packed)) + packed
    item += struct.pack("<HHI", 0xfffe, 0xe0dd, 0)
    words = lambda value: struct.pack("<H", value)
    rows, columns = pixels.shape
    body = b"".join((
        text(8, 0x16, "UI", "1.2.840.10008.5.1.4.1.1.7"), text(8, 0x18, "UI", f"1.2.3.{place + 1}"),
        text(8, 0x60, "CS", "OT"), text(0x20, 0xd, "UI", "1.2.4"), text(0x20, 0xe, "UI", "1.2.5"),
        text(0x20, 0x13, "IS", str(place + 1)), text(0x20, 0x32, "DS", f"0\\0\\{place}"),
        text(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0"), element(0x28, 2, "US", words(1)),
        text(0x28, 4, "CS", "MONOCHROME2"), element(0x28, 0x10, "US", words(rows)),
        element(0x28, 0x11, "US", words(columns)), text(0x28, 0x30, "DS", "1\\1"),
        element(0x28, 0x100, "US", words(8)), element(0x28, 0x101, "US", words(8)),
        element(0x28, 0x102, "US", words(7)), element(0x28, 0x103, "US", words(0))))
    head = element(2, 0, "UL", struct.pack("<I", len(meta)))
    return (b"\0" * 128 + b"DICM" + head + meta + body
            + struct.pack("<HH2sHI", 0x7fe0, 0x10, b"OB", 0, 0xffffffff) + item)


def zarr(folder, values, compressor, chunk):
    folder.mkdir()
    (folder / ".zarray").write_text(json.dumps({
        "zarr_format": 2, "shape": values.shape, "chunks": values.shape, "dtype": "|u1",
        "compressor": compressor, "fill_value": 0, "filters": None, "order": "C"}))
    (folder / ".zattrs").write_text("{}")
    (folder / "0.0.0").write_bytes(chunk)


def zstd(data):
    """A frame of one block that is stored as it is."""
    return (struct.pack("<IBI", 0xfd2fb528, 0xa0, len(data))
            + struct.pack("<I", len(data) << 3 | 1)[:3] + data)


def lz4(data):
    """A block that is one run of literals, behind its length."""
    rest = len(data) - 15
    return (struct.pack("<I", len(data)) + b"\xf0" + b"\xff" * (rest // 255)
            + struct.pack("B", rest % 255) + data)


def blosc(data):
    """A buffer that is stored as it is."""
    return struct.pack("<4B3I", 2, 1, 2, 1, len(data), len(data), len(data) + 16) + data


def files(folder):
    values = (190 * ball()).astype("u1")
    stored = values.tobytes()
    numpy.save(folder / "a.npy", values)
    (folder / "b.nii.gz").write_bytes(gzip.compress(nifti(values)))
    for kind in ("png", "dicom"):
        (folder / kind).mkdir()
    for i, page in enumerate(values):
        (folder / "png" / f"slice{i:03}.png").write_bytes(png(page))
        (folder / "dicom" / f"{i:03}.dcm").write_bytes(dicom(page, i))
    (folder / "d.tif").write_bytes(tiff(values, 8, lambda page: zlib.compress(page.tobytes())))
    zarr(folder / "bz2.zarr", values, {"id": "bz2", "level": 1}, bz2.compress(stored))
    zarr(folder / "zstd.zarr", values, {"id": "zstd", "level": 1}, zstd(stored))
    zarr(folder / "lz4.zarr", values, {"id": "lz4", "acceleration": 1}, lz4(stored))
    zarr(folder / "blosc.zarr", values, {"id": "blosc", "cname": "lz4", "clevel": 1, "shuffle": 0,
                                         "blocksize": 0}, blosc(stored))
    for name in ("a.npy", "b.nii.gz", "png", "d.tif", "dicom", "bz2.zarr", "zstd.zarr", "lz4.zarr",
                 "blosc.zarr"):
        volume = pellucid.read_volume(folder / name)
        read = numpy.asarray(volume)
        assert sorted(read.shape) == sorted(values.shape), f"{name}: {read.shape}"
        assert numpy.array_equal(numpy.sort(read, axis=None).astype("u1"),
                                 numpy.sort(values, axis=None)), f"{name}: other values"
        assert numpy.array_equal(read, values), f"{name}: values at other places"
        done(f"read {name}")


def written(folder):
    image = pellucid.render("builtin:sphere:20", size=SIZE)
    for name in ("a.exr", "a.png"):
        image.save(folder / name)
    again = pellucid.read_image(folder / "a.exr")
    assert numpy.array_equal(again.rgba, image.rgba)
    done("a picture written and read as OpenEXR, and written as PNG")


def refused(folder):
    """What a wheel lacks is said in one line."""
    (folder / "e.h5").write_bytes(b"\x89HDF\r\n\x1a\n" + b"\0" * 100)
    (folder / "f.nrrd").write_bytes(nrrd(numpy.zeros((2, 2, 2), "u1")))
    page = numpy.zeros((64, 64), "u1")
    (folder / "g.tif").write_bytes(tiff([page, page], 34661, lambda _: b"\0" * 40))
    for name, said in (("e.h5", "module pellucid_hdf5.so, which reads HDF5 files, is not there"),
                       ("f.nrrd", "pellucid_itk.so, which reads NRRD and MetaImage, is not there"),
                       ("g.tif", "1 bits")):
        try:
            pellucid.read_volume(folder / name)
        except pellucid.Error as error:
            assert said in str(error) and "\n" not in str(error), f"{name}: {error}"
            done(f"refused {name}: {error}".replace(str(folder), ""))
        else:
            raise AssertionError(f"{name} is read")
    try:
        pellucid.vtk.use()
    except pellucid.Error as error:
        done(f"refused VTK's windows: {error}"[:70] + "…")


def viewer():
    from urllib.request import urlopen
    with pellucid.view("builtin:shells:20", open=False) as shown:
        page = urlopen(shown.address, timeout=60).read()
    assert b"<html" in page, "the viewer's page is not there"
    done("the viewer's page")


def own_libraries():
    """What is loaded is what the wheel brought, whatever else is installed."""
    package = os.path.dirname(pellucid.__file__)
    with open("/proc/self/maps", encoding="utf-8") as file:
        loaded = {line.split(maxsplit=5)[5].strip() for line in file if ".so" in line}
    used = [path for path in loaded if path.startswith(f"{package}.libs/")]
    for path in loaded - set(used):
        name = os.path.basename(path)
        assert not name.startswith(("libtbb", "libtiff", "libpng", "libOpenEXR", "libgdcm",
                                    "libblosc", "libfmt")), f"{path} is loaded"
    assert len(used) == len(os.listdir(f"{package}.libs")), used
    done(f"{len(used)} libraries loaded, all of the wheel")


def main():
    warnings.simplefilter("ignore", pellucid.Note)
    print(f"Python {sys.version.split()[0]}, numpy {numpy.__version__}, pellucid "
          f"{pellucid.__version__} in {os.path.dirname(pellucid.__file__)}")
    found = pictures()
    if len(sys.argv) > 1:
        same_everywhere(found, sys.argv[1])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        files(folder)
        written(folder)
        refused(folder)
    viewer()
    own_libraries()
    print(f"{len(made)} things done")


if __name__ == "__main__":
    import pellucid.vtk
    main()
