# SPDX-License-Identifier: Apache-2.0
"""Color maps, ranges and opacity of layers, color bars, and short words of looks."""
import dataclasses
import os
import struct
import zlib

import numpy
import pytest

import pellucid
from conftest import SIZE, assert_same_bits, render, smooth

HAZE = [(0, 0.5, (1, 0, 0)), (100, 1.5, (0, 0, 1))]


def test_color_maps_need_no_other_package():
    assert {"viridis", "cool to warm", "batlow"} <= set(pellucid.color_map_names())
    points = pellucid.color_map("Viridis")
    assert points[0][0] == 0 and points[-1][0] == 1 and 10 < len(points) < 40
    assert pellucid.color_map("viridis_r")[0][1] == points[-1][1]
    with pytest.raises(pellucid.Error, match="did you mean viridis"):
        pellucid.color_map("virdis")


def test_cmap_is_within_a_step_of_matplotlib():
    matplotlib = pytest.importorskip("matplotlib")
    layer = pellucid.Layer(smooth(), HAZE, cmap="magma", clim=(10, 60))
    values = numpy.linspace(10, 60, 256)
    at, _, colors = zip(*layer.transfer_function.points)
    light = numpy.stack([numpy.interp(values, at, c) for c in zip(*colors)], axis=1)
    expected = matplotlib.colormaps["magma"](numpy.linspace(0, 1, 256))[:, :3]
    assert numpy.abs(pellucid.linear_to_srgb(light) - expected).max() < 1 / 255
    # Maps that are not ours, objects and lists.
    for cmap in ("ocean", matplotlib.colormaps["ocean"], ["#000000", "#ffffff"]):
        points = pellucid.Layer(smooth(), HAZE, cmap=cmap).transfer_function.points
        assert len(points) >= 2 and [points[0][0], points[-1][0]] == [0, 100]


def test_clim_and_opacity():
    points = pellucid.Layer(smooth(), HAZE, clim=(20, 40), opacity=2).transfer_function.points
    assert points == [(20, 1, (1, 0, 0)), (40, 3, (0, 0, 1))]
    values = numpy.arange(1000, dtype=numpy.float32).reshape(10, 10, 10)
    points = pellucid.Layer(values, HAZE, clim=("10%", "90%")).transfer_function.points
    assert abs(points[0][0] - 100) <= 1 and abs(points[-1][0] - 899) <= 1
    table = pellucid.OpacityTable([(0, 0, "#ffffff"), (100, 0.5, "#ffffff")], unit_distance=4)
    made = pellucid.Layer(smooth(), table, opacity=2).transfer_function
    assert isinstance(made, pellucid.OpacityTable) and made.unit_distance == 2
    # A copy of a layer is not changed once more.
    layer = pellucid.Layer(smooth(), HAZE, opacity=2)
    assert dataclasses.replace(layer, name="a").transfer_function.points[0][1] == 1
    for wrong, message in (({"clim": (3, 1)}, "ascending"), ({"clim": 3}, "clim: expected two"),
                           ({"clim": ("a", "b")}, "percentages as"),
                           ({"opacity": -1}, "factor"), ({"cmap": "virdis"}, "did you mean")):
        with pytest.raises(pellucid.Error, match=message):
            pellucid.Layer(smooth(), HAZE, **wrong)
    with pytest.raises(pellucid.Error, match="one variable"):
        pellucid.Layer(pellucid.Channels({"a": smooth(), "b": smooth()}),
                       [pellucid.Gaussian((50, 50), 1, widths=(5, 5))], cmap="jet")
    with pytest.raises(pellucid.Error, match="labels have colors"):
        pellucid.Layer(pellucid.LabelVolume(smooth(numpy.uint8) // 50), cmap="jet")


def test_is_the_programs_picture(program, tmp_path):
    numpy.save(tmp_path / "a.npy", smooth())
    image = render(smooth(), cmap="plasma", clim=("5%", "95%"), opacity=1.5)
    assert_same_bits(image, program.render(tmp_path / "a.npy", "--colormap", "plasma", "--range",
                                           "5%:95%", "--opacity", "1.5"))


def test_short_words_of_looks():
    layer = pellucid.Layer(smooth(), isosurfaces=[60], shading=True)
    assert layer.isosurfaces == [pellucid.Isosurface(60)] and layer.shading == pellucid.Shading()
    # Values alone are lit, as those of the program are.
    assert pellucid.Layer(smooth(), isosurfaces=60).shading == pellucid.Shading()
    assert pellucid.Layer(smooth(), isosurfaces=[60], shading=False).shading is None
    assert pellucid.Layer(smooth(), isosurfaces=[pellucid.Isosurface(60)]).shading is None
    short = render(smooth(), isosurfaces=[60], background="white")
    long = render(smooth(), isosurfaces=[pellucid.Isosurface(60)], shading=pellucid.Shading())
    assert_same_bits(short, long)


def bar_of(plain, drawn):
    return numpy.argwhere((plain != drawn).any(axis=2))


@pytest.mark.skipif(os.environ.get("PELLUCID_HAS_CAIRO") != "1", reason="built without Cairo")
def test_color_bar(tmp_path):
    image = pellucid.render(smooth(), HAZE, size=160, cmap="viridis", background="white")
    before = image.rgba.copy()
    image.save(tmp_path / "plain.png")
    image.save(tmp_path / "bar.png", color_bar=True)
    image.save(tmp_path / "titled.png", color_bar="temperature (K)")
    assert numpy.array_equal(before, image.rgba)
    files = [(tmp_path / f"{name}.png").read_bytes() for name in ("plain", "bar", "titled")]
    assert len(set(files)) == 3
    pillow = pytest.importorskip("PIL.Image")
    plain, bar = (numpy.asarray(pillow.open(tmp_path / f"{n}.png")) for n in ("plain", "bar"))
    assert bar_of(plain, bar)[:, 1].min() > 80
    with pytest.raises(pellucid.Error, match="drawn in a .png"):
        image.save(tmp_path / "a.exr", color_bar=True)
    with pytest.raises(pellucid.Error, match="expected True, False or a title"):
        image.save(tmp_path / "a.png", color_bar=3)


def test_color_bar_of_no_scene(tmp_path):
    with pytest.raises(pellucid.Error, match="the image knows none"):
        pellucid.Image(numpy.zeros((SIZE, SIZE, 4))).save(tmp_path / "a.png", color_bar=True)


def rgb_png(path, values):
    """A PNG of bytes (rows, columns, channels), written here."""
    rows, columns, channels = values.shape

    def chunk(kind, content):
        return (struct.pack(">I", len(content)) + kind + content
                + struct.pack(">I", zlib.crc32(kind + content)))

    lines = b"".join(b"\0" + row.tobytes() for row in values)
    head = struct.pack(">IIBBBBB", columns, rows, 8, 2 if channels == 3 else 6, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head)
                     + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b""))


@pytest.mark.parametrize("channels", [3, 4])
def test_files_of_colors_are_shown_as_they_are(program, tmp_path, channels):
    folder = tmp_path / "stack"
    folder.mkdir()
    random = numpy.random.default_rng(5)
    for z in range(3):
        rgb_png(folder / f"p{z}.png", random.integers(0, 256, (4, 5, channels), dtype=numpy.uint8))
    layer = pellucid.read(folder)
    assert isinstance(layer, pellucid.Layer)
    assert layer.data.names == ["red", "green", "blue", "opacity"]
    expected = program.render(folder)
    assert_same_bits(render(layer), expected)
    assert_same_bits(render(folder), expected)
    assert pellucid.read_volume(folder, component=1).shape == (3, 4, 5)
    with pytest.raises(pellucid.Error, match=r"read_volume\(path, component=0\)"):
        pellucid.render(folder, preset="xray")
    with pytest.raises(pellucid.Error, match="holds 3 colors|colors|component"):
        pellucid.read_volume(folder)
