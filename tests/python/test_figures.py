# SPDX-License-Identifier: Apache-2.0
"""Figures of papers, and pictures in figures of matplotlib."""
import itertools
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree

import numpy
import pytest

import pellucid
import pellucid.mpl
from conftest import smooth

sys.path.insert(0, os.path.join(os.environ["PELLUCID_SOURCE_DIR"], "tests", "cli"))
from svg import SVG, XLINK, lines  # noqa: E402

needs_cairo = pytest.mark.skipif(os.environ.get("PELLUCID_HAS_CAIRO") != "1",
                                 reason="built without Cairo")
HAZE = [(0, 0.05, (1, 0, 0)), (60, 0.1, (0.1, 0.8, 0.2)), (100, 0.15, (0, 0, 1))]
CAMERAS = {
    "perspective": pellucid.Camera(position=(40, -60, 45), focal_point=(9, 3, 3), up=(0, 0, 1),
                                   vertical_angle=35),
    "parallel": pellucid.Camera(position=(-30, -50, 25), focal_point=(9, 3, 3), up=(0, 0, 1),
                                projection="orthographic", parallel_scale=22),
    "tilted": pellucid.Camera(position=(35, 70, -38), focal_point=(9, 3, 3), up=(0.3, 0, 1),
                              vertical_angle=30),
    "front": pellucid.Camera(position=(9, -80, 3), focal_point=(9, 3, 3), up=(0, 0, 1),
                             vertical_angle=30),
}


def volume():
    """7, 9 and 11 values: x from 4 to 24, y from -5 to 11, z from 0 to 12."""
    return pellucid.Volume(smooth(), spacing=(2, 2, 2), origin=(0, -5, 4))


LOWER, UPPER = numpy.array([4.0, -5, 0]), numpy.array([24.0, 11, 12])


def render(camera, size=(120, 100), **options):
    return pellucid.render(volume(), HAZE, size=size, camera=camera, background="white", **options)


def projected(camera, size, points):
    """Pixels (n, 2) of points (n, 3): a pinhole, written anew."""
    eye, at, up = (numpy.array(v, dtype=float)
                   for v in (camera.position, camera.focal_point, camera.up))
    forward = (at - eye) / numpy.linalg.norm(at - eye)
    right = numpy.cross(forward, up)
    right /= numpy.linalg.norm(right)
    upward = numpy.cross(right, forward)
    offset = numpy.atleast_2d(points) - eye
    if camera.projection == "perspective":
        half = numpy.tan(numpy.radians(camera.vertical_angle) / 2) * (offset @ forward)
    else:
        half = camera.parallel_scale
    width, height = size
    return numpy.stack([width / 2 + offset @ right / half * height / 2,
                        height / 2 - offset @ upward / half * height / 2], axis=1)


class Drawn:
    """Lines of a figure, in pixels of its picture; the picture's place is that of its raster."""

    def __init__(self, figure, size):
        self.text = figure.encode("svg").decode()
        root = xml.etree.ElementTree.fromstring(self.text)
        by_id = {e.get("id"): e for e in root.iter() if e.get("id")}
        for use in root.iter(SVG + "use"):
            target = by_id[use.get(XLINK)[1:]]
            if target.tag == SVG + "image" and target.get("width") == str(size[0]):
                matrix = re.findall(r"-?[0-9.]+", use.get("transform"))
                self.scale, self.left, self.top = (float(matrix[i]) for i in (0, 4, 5))
        self.axes, self.ticks, self.scale_bars = [], [], []
        for drawn, ends in lines(root):
            line = (numpy.array(ends) - (self.left, self.top)) / self.scale
            if drawn["stroke-width"] == "1.4":
                self.scale_bars.append(line)
            if (drawn["stroke-width"], drawn["stroke-linecap"]) != ("0.6", "round"):
                continue
            length = numpy.linalg.norm(line[1] - line[0]) * self.scale
            (self.ticks if abs(length - 2.5) < 0.02 else self.axes).append(line)


def edges():
    """(axis, lower end, upper end) of the twelve edges of the box."""
    for axis in range(3):
        for others in itertools.product((0, 1), repeat=2):
            low = numpy.insert(numpy.array(others), axis, 0)
            high = numpy.insert(numpy.array(others), axis, 1)
            yield axis, LOWER + low * (UPPER - LOWER), LOWER + high * (UPPER - LOWER)


@needs_cairo
@pytest.mark.parametrize("name", CAMERAS)
def test_axes_lie_where_the_box_is_seen(name):
    camera, size = CAMERAS[name], (120, 100)
    drawn = Drawn(render(camera).figure(unit="mm"), size)
    corners = projected(camera, size, list(itertools.product(*zip(LOWER, UPPER))))
    seen = {0, 2} if name == "front" else {0, 1, 2}
    assert len(drawn.axes) == len(seen)
    precision = 0.005 / drawn.scale  # an .svg of Cairo has points with 1/256
    found = set()
    for line in drawn.axes:
        axis, low, high = next(
            edge for edge in edges()
            if abs(projected(camera, size, edge[1:]) - line).max() < 2 * precision)
        found.add(axis)
        # Nothing of the box is on the other side of a silhouette.
        along = line[1] - line[0]
        along = along / numpy.linalg.norm(along)
        beside = (corners - line[0]) @ (-along[1], along[0])
        assert beside.max() < 2 * precision or beside.min() > -2 * precision
        # Its ticks are at multiples of 1, 2 or 5 times a power of ten, all that there are.
        fine = numpy.linspace(0, 1, 20001)
        path = projected(camera, size, low + fine[:, None] * (high - low))
        values = []
        for tick in drawn.ticks:
            distance = numpy.linalg.norm(path - tick[0], axis=1)
            if distance.min() < 3 * precision:
                values.append(low[axis] + fine[distance.argmin()] * (high - low)[axis])
                across = tick[1] - tick[0]
                # It leads away from the box.
                assert across @ (tick[0] - corners.mean(axis=0)) > 0
        values = sorted(values)
        # Two axes meet at a corner, whose ticks are found for both.
        steps = [step for step in (0.5, 1, 2, 5, 10) if all(
            abs(v / step - round(v / step)) < 0.01 for v in values
            if min(abs(v - low[axis]), abs(v - high[axis])) > 1e-3)]
        assert steps and len(values) >= 2, values
        wanted = numpy.arange(numpy.ceil(low[axis] / steps[-1] - 1e-9) * steps[-1],
                              high[axis] + 1e-9, steps[-1])
        for value in wanted:
            assert min(abs(numpy.array(values) - value)) < 0.02, (value, values)
    assert found == seen


@needs_cairo
def test_numbers_stand_at_the_ticks_of_axes(tmp_path):
    if not shutil.which("pdftotext"):
        pytest.skip("no pdftotext (Debian: poppler-utils)")
    camera, size = CAMERAS["parallel"], (120, 100)
    figure = render(camera).figure(tmp_path / "a.pdf",
                                   without=["color-bar", "caption", "scale-bar"])
    drawn = Drawn(figure, size)
    text = subprocess.run(["pdftotext", "-bbox", tmp_path / "a.pdf", "-"], check=True,
                          capture_output=True).stdout.decode()
    words = []
    for word in re.findall(r'xMin="([0-9.]+)" yMin="([0-9.]+)" xMax="([0-9.]+)" '
                           r'yMax="([0-9.]+)">(\u2212?[0-9.]+)<', text):
        left, top, right, bottom = (float(part) for part in word[:4])
        words.append((((left + right) / 2, (top + bottom) / 2),
                      float(word[4].replace("\u2212", "-"))))
    assert len(words) >= 6
    # Each number is that of an axis at a place that is seen within some points of it.
    for place, value in words:
        place = (numpy.array(place) - (drawn.left, drawn.top)) / drawn.scale
        nearest = min(drawn.ticks, key=lambda tick: numpy.linalg.norm(tick[1] - place))
        assert numpy.linalg.norm(nearest[1] - place) * drawn.scale < 12
        distances = []
        for axis, low, high in edges():
            if low[axis] <= value <= high[axis]:
                point = low.copy()
                point[axis] = value
                distances.append(numpy.linalg.norm(
                    projected(camera, size, point)[0] - nearest[0]))
        assert min(distances) * drawn.scale < 0.03, value


@needs_cairo
def test_scale_bar_is_as_long_as_it_says():
    size = (120, 100)
    drawn = Drawn(render(CAMERAS["parallel"]).figure(unit="mm"), size)
    (bar,) = drawn.scale_bars
    length = numpy.linalg.norm(bar[1] - bar[0]) * 2 * 22 / size[1]
    assert length == pytest.approx(10, abs=0.02)
    # In perspective at the focal point; axes have numbers, and one length would be wrong elsewhere.
    assert Drawn(render(CAMERAS["front"]).figure(), size).scale_bars == []
    (bar,) = Drawn(render(CAMERAS["front"]).figure(without="axes"), size).scale_bars
    height = 2 * 83 * numpy.tan(numpy.radians(15))
    length = numpy.linalg.norm(bar[1] - bar[0]) * height / size[1]
    assert length == pytest.approx(10, abs=0.02)


def words_of(figure, path):
    figure.save(path)
    return subprocess.run(["pdftotext", path, "-"], check=True, capture_output=True
                          ).stdout.decode().split()


@needs_cairo
def test_letters_of_a_patient(tmp_path):
    if not shutil.which("pdftotext"):
        pytest.skip("no pdftotext (Debian: poppler-utils)")
    image = render(CAMERAS["front"])
    path = tmp_path / "a.pdf"
    without = ["caption", "color-bar", "scale-bar"]
    # From the front, the patient's left is at the right.
    letters = words_of(image.figure(patient=True, without=without), path)
    assert sorted(letters) == ["I", "L", "R", "S"]
    text = subprocess.run(["pdftotext", "-bbox", path, "-"], check=True,
                          capture_output=True).stdout.decode()
    at = {word: (float(x), float(y)) for x, y, word in
          re.findall(r'xMin="([0-9.]+)" yMin="([0-9.]+)"[^>]*>(\w)<', text)}
    assert at["R"][0] < at["S"][0] < at["L"][0] and at["S"][1] < at["L"][1] < at["I"][1]
    oblique = render(CAMERAS["tilted"]).figure(patient=True, without=without)
    assert sorted(words_of(oblique, path)) == ["L", "P", "S"]
    words = words_of(render(CAMERAS["parallel"]).figure(patient=True, axes=True), path)
    # Ends are named as they are read: from here the patient's right is at the left.
    assert "R\u2013L" in words and "I\u2013S" in words and "(mm)" in words
    behind = pellucid.Camera(position=(9, 80, 3), focal_point=(9, 3, 3), up=(0, 0, 1))
    assert "L\u2013R" in words_of(render(behind).figure(patient=True, axes=True), path)
    assert not {"x", "y", "z"} & set(words)
    assert words_of(image.figure(patient=True, without=[*without, "letters"]), path) == []


@needs_cairo
def test_is_the_programs_figure(program, tmp_path):
    numpy.save(tmp_path / "a.npy", smooth())
    program("render", tmp_path / "a.npy", "--size", "60", "--figure", tmp_path / "a.svg",
            "--figure", tmp_path / "a.pdf", "-q", "--color-bar-title", "T (K)")
    figure = pellucid.render(tmp_path / "a.npy", size=60, depth=False).figure(title="T (K)")
    assert figure.encode("svg") == (tmp_path / "a.svg").read_bytes()
    assert figure.encode("pdf") == (tmp_path / "a.pdf").read_bytes()
    figure.save(tmp_path / "b.svg")
    assert (tmp_path / "b.svg").read_bytes() == (tmp_path / "a.svg").read_bytes()
    assert figure._repr_svg_() == (tmp_path / "a.svg").read_text()
    assert figure.encode("png")[:8] == b"\x89PNG\r\n\x1a\n"
    assert "85 mm" in repr(figure)


@needs_cairo
def test_an_image_of_no_scene_has_the_picture_alone():
    figure = pellucid.Image(numpy.zeros((20, 30, 4))).figure(width_mm=40)
    text = figure.encode("svg").decode()
    assert "symbol" not in text and "<image" in text
    assert "within" not in text


@needs_cairo
def test_refuses_in_one_line(tmp_path):
    image = render(CAMERAS["front"])
    for options, message in (
            ({"path": tmp_path / "a.jpg"}, "expected a name that ends in .pdf, .svg or .png"),
            ({"path": tmp_path / "missing" / "a.pdf"}, "missing"),
            ({"width_mm": 5}, "is 5 mm wide, but must be from 30 to 1000"),
            ({"width_mm": float("nan")}, "must be from 30"),
            ({"without": "axis"}, "there is no part 'axis'"),
            ({"without": 3}, "expected names of parts"),
            ({"background": "nonsense"}, "background")):
        with pytest.raises(pellucid.Error, match=message) as error:
            image.figure(**options)
        assert "\n" not in str(error.value)
    with pytest.raises(pellucid.Error, match="expected a name that ends"):
        image.figure().encode("jpg")
    assert list(tmp_path.iterdir()) == []


def test_color_bars_are_those_of_the_function():
    (bar,) = render(CAMERAS["front"]).color_bars
    assert bar.range == (0, 100) and bar.colors.shape == (1024, 3) and bar.entries == []
    values = (numpy.arange(1024) + 0.5) / 1024 * 100
    at, extinction, colors = zip(*HAZE)
    light = numpy.stack([numpy.interp(values, at, c) for c in zip(*colors)], axis=1)
    assert abs(bar.colors - pellucid.linear_to_srgb(light)).max() < 1e-12
    depth = 3 * numpy.interp(values, at, extinction) / 0.15
    assert abs(bar.opacity - (1 - numpy.exp(-depth))).max() < 1e-12
    surfaces = pellucid.render(pellucid.scene_of(pellucid.Layer(
        smooth(), isosurfaces=[pellucid.Isosurface(60, color=(1, 0, 0))])), size=8)
    (bar,) = surfaces.color_bars
    assert bar.colors is None and bar.range is None and len(bar.entries) == 1
    assert bar.entries[0][0] == "60" and bar.entries[0][1] == pytest.approx((1, 0, 0))
    assert pellucid.Image(numpy.zeros((2, 2, 4))).color_bars == []


@pytest.fixture
def plt():
    pytest.importorskip("matplotlib", reason="no matplotlib (Debian: python3-matplotlib)")
    import matplotlib
    matplotlib.use("agg")
    import matplotlib.pyplot
    yield matplotlib.pyplot
    matplotlib.pyplot.close("all")


def test_matplotlib_shows_the_bytes(plt):
    image = render(CAMERAS["front"])
    figure, axes = plt.subplots(figsize=(1.2, 1), dpi=100)
    axes.set_position([0, 0, 1, 1])
    pellucid.mpl.show(axes, image)
    figure.canvas.draw()
    shown = numpy.asarray(figure.canvas.buffer_rgba())[..., :3]
    assert numpy.array_equal(shown, image.to_srgb8())


def test_matplotlibs_color_bar_has_the_colors_of_the_picture(plt):
    # Slabs of known values: each is as opaque as can be, and shows the color of its value.
    opaque = [(value, 1e4, color) for value, _, color in HAZE]
    figure, axes = plt.subplots()
    for value in (7, 42.5, 93):
        slab = numpy.full((5, 5, 5), value, dtype="f4")
        image = pellucid.render(slab, opaque, size=21, view="front", background="black")
        pixel = image.to_srgb8()[10, 10]
        color = pellucid.mpl.mappable(image).to_rgba(value, bytes=True)[:3]
        assert abs(pixel.astype(int) - color).max() <= 1, value
    pellucid.mpl.show(axes, image)
    bar = pellucid.mpl.colorbar(image, axes, label="density")
    assert (bar.vmin, bar.vmax) == (0, 100) and bar.ax.get_ylabel() == "density"
    assert pellucid.mpl.colorbar(image, axes).ax.get_ylabel() == image.color_bars[0].title
    figure.canvas.draw()


def test_matplotlibs_legend_has_surfaces_and_labels(plt):
    _, axes = plt.subplots()
    labels = pellucid.LabelVolume(numpy.arange(64, dtype="u1").reshape(4, 4, 4) % 3)
    image = pellucid.render(labels, size=8)
    texts = [text.get_text() for text in pellucid.mpl.legend(image, axes).get_texts()]
    assert texts == ["1", "2"]
    with pytest.raises(pellucid.Error, match="no function of one variable"):
        pellucid.mpl.colorbar(image, axes)
    with pytest.raises(pellucid.Error, match="only entries; see legend"):
        pellucid.mpl.mappable(image, 0)
    with pytest.raises(pellucid.Error, match="there are 1 color bars, got 5"):
        pellucid.mpl.mappable(image, 5)
    with pytest.raises(pellucid.Error, match="no isosurfaces and labels"):
        pellucid.mpl.legend(render(CAMERAS["front"]), axes)


def test_matplotlib_is_imported_when_it_is_used():
    program = "import sys, pellucid.mpl; sys.exit('matplotlib' in sys.modules)"
    import sys
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0
