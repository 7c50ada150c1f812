# SPDX-License-Identifier: Apache-2.0
"""What a notebook keeps of view() turns in a browser without a kernel, and export() likewise."""
import os
import sys

import numpy
import pytest

import pellucid
from conftest import smooth

sys.path.insert(0, os.path.join(os.environ["PELLUCID_SOURCE_DIR"], "tests", "view"))
os.environ.setdefault("PELLUCID_PROGRAM", "pellucid")
import page_driver  # noqa: E402

CELL = """import numpy, pellucid
z, y, x = numpy.mgrid[-1:1:20j, -1:1:22j, -1:1:24j]
viewer = pellucid.view(numpy.exp(-2 * (x * x + y * y + z * z)), open=False, height=420)
viewer"""


class File:
    """A page on disk."""

    def __init__(self, path):
        self.address = "file://" + str(path)


@pytest.fixture(scope="module", autouse=True)
def page_is_built():
    try:
        pellucid._pellucid.page_of_scene(pellucid.scene_of("builtin:sphere:8"))
    except pellucid.Error as error:
        pytest.skip(str(error))


@pytest.fixture
def browse(tmp_path):
    """Opens a page; all are closed at the end."""
    reason = page_driver.why_not()
    if reason:
        pytest.skip(reason)
    pages = []

    def open_page(path, **options):
        pages.append(page_driver.Page(File(path), str(tmp_path), **options))
        return pages[-1]

    yield open_page
    for page in pages:
        page.browser.quit()


def test_export_holds_arrays(tmp_path, browse):
    data = smooth(numpy.int16, (12, 14, 16))
    volume = pellucid.Volume(data, spacing=(1, 2, 3), origin=(5, 6, 7))
    assert pellucid.export(volume, tmp_path / "a.html", preset="mr-t1-brain") is None
    page = browse(tmp_path / "a.html", window=(500, 400))
    assert "every pixel within" in page.text("#state")
    name = page.run("return [...document.querySelectorAll('button')].map((one) => "
                    "one.textContent).find((text) => text.startsWith('Data, '))")
    page.saved(name, name.split(", ")[1].split(" ")[0])
    saved = numpy.load(tmp_path / name.split(", ")[1].split(" ")[0])
    assert saved["values"].dtype == data.dtype
    numpy.testing.assert_array_equal(saved["values"].T, data)  # x, y, z, as nibabel has it


def test_export_holds_meshes(tmp_path, browse):
    points = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0], [1, 1, 1]])
    cells = numpy.array([[0, 1, 2, 3], [1, 2, 3, 4]])
    mesh = pellucid.Mesh(points, cells, {"heat": numpy.arange(5, dtype=numpy.float32)})
    pellucid.export(mesh, tmp_path / "a.html")
    page = browse(tmp_path / "a.html", window=(500, 400))
    assert "every pixel within" in page.text("#state")
    name = page.run("return [...document.querySelectorAll('button')].map((one) => "
                    "one.textContent).find((text) => text.startsWith('Data, '))")
    page.saved(name, name.split(", ")[1].split(" ")[0])
    saved = numpy.load(tmp_path / name.split(", ")[1].split(" ")[0])
    numpy.testing.assert_array_equal(saved["points"], points)
    numpy.testing.assert_array_equal(saved["tetrahedra"], cells)
    (heat,) = [name for name in saved.files if name.startswith("point_")]
    assert saved[heat].dtype == numpy.float32
    numpy.testing.assert_array_equal(saved[heat], numpy.arange(5))


def test_export_reduces(tmp_path):
    volume = pellucid.Volume(smooth(numpy.float32, (40, 40, 40)))
    pellucid.export(volume, tmp_path / "whole.html", max_size=50_000_000)
    most = (tmp_path / "whole.html").stat().st_size - 100_000
    with pytest.raises(pellucid.Error, match="not written.*reduce=True"):
        pellucid.export(volume, tmp_path / "a.html", max_size=most)
    with pytest.warns(pellucid.Note, match="21 x 21 x 21 of 40 x 40 x 40 values"):
        pellucid.export(volume, tmp_path / "a.html", max_size=most, reduce=True)
    assert (tmp_path / "a.html").stat().st_size <= most
    with pytest.raises(pellucid.Error, match="give max_size"):
        pellucid.export(volume, tmp_path / "b.html", reduce=True)


def test_export_refuses(tmp_path):
    with pytest.raises(pellucid.Error, match="ends in .html"):
        pellucid.export("builtin:sphere:8", tmp_path / "a.png")
    with pytest.raises(pellucid.Error, match="cannot write"):
        pellucid.export("builtin:sphere:8", tmp_path / "none" / "a.html")
    assert list(tmp_path.iterdir()) == []


def test_a_notebook_turns_without_a_kernel(tmp_path, browse):
    nbformat = pytest.importorskip("nbformat")
    nbconvert = pytest.importorskip("nbconvert")
    pytest.importorskip("ipykernel")
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(CELL)])
    runner = nbconvert.preprocessors.ExecutePreprocessor(timeout=600, kernel_name="python3")
    runner.preprocess(book, {"metadata": {"path": str(tmp_path)}})
    text, _ = nbconvert.HTMLExporter().from_notebook_node(book)
    (tmp_path / "book.html").write_text(text, encoding="utf-8")
    page = browse(tmp_path / "book.html", window=(900, 700), waits=False)
    frame = page.browser.find_element("css selector", "iframe")
    page.browser.switch_to.frame(frame)
    page.wait_exact(-1)
    before = page.frame()
    canvas = page.browser.find_element("css selector", "#picture")
    first = page.picture()
    canvas.send_keys("\ue014" * 6)  # to the right
    page.wait_exact(before)
    assert page.picture() != first


def test_what_is_embedded_is_chosen():
    with pellucid.view("builtin:sphere:8", open=False, embed=False) as viewer:
        assert viewer.address in viewer._repr_html_()
        assert "srcdoc" not in viewer._repr_html_()
    with pellucid.view("builtin:sphere:8", open=False) as viewer:
        assert "srcdoc" in viewer._repr_html_()
    assert "srcdoc" in viewer._repr_html_(), "what it shows stays when it is stopped"
