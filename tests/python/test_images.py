# SPDX-License-Identifier: Apache-2.0
"""What comes back: pictures, their errors and comparisons; segments and rays."""
import io
import math
import struct
import zlib

import numpy
import pytest

import pellucid
from conftest import smooth
from pellucid import segments


@pytest.fixture(scope="module")
def image():
    return pellucid.render(smooth(), size=(48, 32), depth=True)


def test_maps(image):
    assert image.rgba.shape == (32, 48, 4) and image.rgba.dtype == numpy.float32
    assert (image.width, image.height) == (48, 32)
    assert image.rgba.base is not None and not image.rgba.flags.writeable
    assert image.error.shape == image.proved.shape == image.depth.shape == (32, 48)
    assert image.proved.dtype == bool and image.values is None
    assert image.error.max() <= image.tolerance == 1 / 512
    assert image.report["largest_error"] == pytest.approx(image.error.max())
    empty = image.rgba[..., 3] == 0
    assert numpy.isinf(image.depth[empty]).all() and numpy.isfinite(image.depth[~empty]).all()
    assert numpy.array_equal(numpy.asarray(image), image.rgba)
    assert "within" in repr(image)
    assert pellucid.render(smooth(), size=8, error=False).error is None


@pytest.mark.filterwarnings("error")
def test_numpy_asks_for_an_array(image):
    for each, held in ((image, image.rgba), (pellucid.Volume(smooth()), smooth())):
        shared = numpy.asarray(each)
        assert numpy.shares_memory(shared, numpy.asarray(each, dtype=numpy.float32))
        copied = numpy.array(each)
        assert copied.flags.writeable and numpy.array_equal(copied, held)
        assert not numpy.shares_memory(copied, shared)
        assert numpy.asarray(each, dtype=float).dtype == numpy.float64
        # What numpy 2 passes; numpy 1 passes no copy.
        assert numpy.shares_memory(each.__array__(copy=False), shared)
        assert not numpy.shares_memory(each.__array__(copy=True), shared)
        assert each.__array__(dtype=numpy.float64, copy=True).dtype == numpy.float64
        with pytest.raises(ValueError, match="needs a copy"):
            each.__array__(dtype=numpy.float64, copy=False)


def decode(png):
    """Returns the bytes (height, width, channels) of an 8-bit PNG without filters of rows."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    position, data = 8, b""
    while position < len(png):
        length, kind = struct.unpack(">I4s", png[position:position + 8])
        chunk = png[position + 8:position + 8 + length]
        if kind == b"IHDR":
            width, height, _, color = struct.unpack(">IIBB", chunk[:10])
        if kind == b"IDAT":
            data += chunk
        position += 12 + length
    return width, height, {2: 3, 6: 4}[color], zlib.decompress(data)


def test_notebooks_get_a_picture(image, tmp_path):
    png = image._repr_png_()
    assert decode(png)[:3] == (48, 32, 3)
    image.save(tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes() == png
    black = pellucid.render(smooth(), size=8, background="#000000")
    assert decode(black._repr_png_())[:3] == (8, 8, 3)


def test_srgb(image):
    calm = image.to_srgb8()
    assert calm.shape == (32, 48, 3)
    straight = image.to_srgb8("transparent")
    assert straight.shape == (32, 48, 4) and straight.dtype == numpy.uint8
    over = image.to_srgb8("#ffffff")
    assert over.shape == (32, 48, 3)
    alpha = image.rgba[..., 3:]
    expected = pellucid.linear_to_srgb(numpy.clip(image.rgba[..., :3] + (1 - alpha), 0, 1))
    assert abs(over - 255 * expected).max() <= 0.5001
    nan = numpy.zeros((1, 1, 4), dtype="f4")
    nan[...] = numpy.nan
    assert not pellucid.Image(nan).to_srgb8().any()


def test_files(image, tmp_path):
    image.save(tmp_path / "a.exr")
    again = pellucid.read_image(tmp_path / "a.exr")
    for name in ("rgba", "error", "proved", "depth"):
        assert numpy.array_equal(getattr(again, name), getattr(image, name)), name
    with pytest.raises(pellucid.Error, match=r"ends in \.png or \.exr"):
        image.save(tmp_path / "a.jpg")
    with pytest.raises(pellucid.Error):
        image.save(tmp_path / "none" / "a.png")


def test_comparisons(image):
    same = image.compare(image)
    assert same.largest == same.rms == same.share_over_255 == 0 and math.isinf(same.psnr)
    other = image.rgba.copy()
    other[5, 7, 1] += 0.25
    difference = image.compare(other)
    assert difference.largest == pytest.approx(0.25, abs=1e-6) and difference.at == (5, 7)
    assert difference.share_over_255 == pytest.approx(1 / (48 * 32))
    assert difference.over_errors == 1 and difference.difference.shape == (32, 48, 4)
    assert difference.rms == pytest.approx(0.25 / math.sqrt(48 * 32 * 4), rel=1e-5)
    with pytest.raises(pellucid.Error, match="differ in size"):
        image.compare(other[1:])
    with pytest.raises(pellucid.Error, match="expected an Image or an array"):
        image.compare("a.png")


def test_previews():
    frame = pellucid.Renderer().start(pellucid.scene_of(smooth(), size=64), preview=3)
    image = frame.wait()
    assert numpy.array_equal(frame.look().rgba, image.rgba)
    assert frame.fraction == 1 and frame.level == 0


def test_matplotlib_shows_it(image):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.switch_backend("agg")
    figure, axes = pyplot.subplots()
    axes.imshow(image.to_srgb8("#ffffff"))
    figure.savefig(io.BytesIO())


# Segments.

def test_constant_segments():
    s = segments.linear_segment(2.0, 2.0, (1, 0.5, 0), (1, 0.5, 0), [0, 0.5, 3])
    assert s.opacity.shape == (3,) and s.radiance.shape == (3, 3)
    assert numpy.allclose(s.opacity, 1 - numpy.exp([0, -1.0, -6]), rtol=1e-15)
    assert numpy.allclose(s.radiance[:, 1], 0.5 * s.opacity, rtol=1e-15)


def test_linear_segments_are_the_programs(program, tmp_path):
    random = numpy.random.default_rng(3)
    rows = random.random((50, 5)) * (5, 5, 1, 1, 3)
    text = "id,tau_f,tau_b,C_f,C_b,D\n" + "".join(
        f"{i}," + ",".join(repr(float(x)) for x in row) + "\n" for i, row in enumerate(rows))
    (tmp_path / "in.csv").write_text(text)
    program("evaluate", "linear_segment", tmp_path / "in.csv", "-o", tmp_path / "out.csv")
    lines = (tmp_path / "out.csv").read_text().splitlines()
    names = lines[0].split(",")
    table = numpy.array([[float(x) for x in line.split(",")] for line in lines[1:]])
    colors = numpy.zeros((2, 50, 3))
    colors[:, :, 0] = rows[:, 2], rows[:, 3]
    s = segments.linear_segment(rows[:, 0], rows[:, 1], colors[0], colors[1], rows[:, 4])
    independent = segments.linear_segment_independent(rows[:, 0], rows[:, 1], colors[0], colors[1],
                                                      rows[:, 4])
    for name, values in (("optical_depth", s.optical_depth), ("opacity", s.opacity),
                         ("transparency", s.transparency), ("radiance", s.radiance[:, 0]),
                         ("radiance_independent", independent.radiance[:, 0])):
        assert numpy.array_equal(values, table[:, names.index(name)]), name


def test_piecewise_linear_segments_see_what_lies_between():
    peak = pellucid.TransferFunction([(0.49, 0, "#ffffff"), (0.5, 100, "#ffffff"),
                                      (0.51, 0, "#ffffff")])
    s = segments.piecewise_linear_segment(peak, 0.2, [0.8, 0.45], 1.2)
    assert s.opacity[0] == pytest.approx(1 - math.exp(-2), rel=1e-14) and s.opacity[1] == 0
    halves = segments.compose(segments.piecewise_linear_segment(peak, 0.2, 0.5, 0.6),
                              segments.piecewise_linear_segment(peak, 0.5, 0.8, 0.6))
    assert halves.opacity == pytest.approx(s.opacity[0], rel=1e-14)


def test_gaussian_segments():
    gaussian = pellucid.Gaussians(["a=0~1; extinction 2"], ["a"])
    s = segments.gaussian_segment(gaussian, [[-1.0]], [[1.0]], [0.5, 2])
    mean = math.sqrt(math.pi) / 2 * math.erf(1)
    assert numpy.allclose(s.optical_depth, 2 * mean * numpy.array([0.5, 2]), rtol=1e-14)


@pytest.mark.parametrize("arguments, words", [
    ((-1, 1, (1, 1, 1), (1, 1, 1), 1), "extinction_f: -1.0 is not at least 0"),
    ((1, float("nan"), (1, 1, 1), (1, 1, 1), 1), "extinction_b: nan"),
    ((1, 1, (1, 1), (1, 1, 1), 1), "color_f: expected a last axis of 3"),
    (([1, 2], [1, 2, 3], (1, 1, 1), (1, 1, 1), 1), "do not broadcast"),
    (("a", 1, (1, 1, 1), (1, 1, 1), 1), "extinction_f: expected numbers"),
])
def test_wrong_segments(arguments, words):
    with pytest.raises(pellucid.Error, match=words) as error:
        segments.linear_segment(*arguments)
    assert "\n" not in str(error.value)


def test_rays():
    constant = pellucid.builtin_field("constant", 4)
    scene = pellucid.scene_of(constant, [(0, 0.5, (1, 0.5, 0))])
    rays = pellucid.integrate(scene, [(0.1, 0.2, -5), (5, 5, -5)], (0, 0, 2))
    assert rays.opacity[0] == pytest.approx(1 - math.exp(-1), abs=1e-12)
    assert rays.optical_depth[0] == pytest.approx(1, abs=1e-12)
    assert rays.radiance[0, 1] == pytest.approx(0.5 * rays.opacity[0], abs=1e-12)
    assert rays.depth[0] == pytest.approx(4 - 2 * math.log(0.5 * (1 + math.exp(-1))), abs=1e-9)
    assert rays.opacity[1] == 0 and math.isinf(rays.depth[1])
    with pytest.raises(pellucid.Error, match="directions"):
        pellucid.integrate(scene, (0, 0, 0), (0, 0, float("inf")))
    with pytest.raises(pellucid.Error, match="direction"):
        pellucid.integrate(scene, (0, 0, 0), (0, 0, 0))
    with pytest.raises(pellucid.Error, match="last axis of 3"):
        pellucid.integrate(scene, (0, 0), (0, 0, 1))


def test_the_documentation_says_shapes_units_and_errors():
    for name in pellucid.__all__:
        if name in ("__version__", "Light", "Clip"):
            continue
        text = getattr(pellucid, name).__doc__
        assert text and len(text.strip()) > 15, name
    assert "Raises" in pellucid.render.__doc__ and "(z, y, x)" in pellucid.Volume.__doc__
