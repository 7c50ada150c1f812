# SPDX-License-Identifier: Apache-2.0
"""What a notebook keeps of view() turns in a browser without a kernel, and export() likewise."""
import http.client
import json
import os
import socket
import subprocess
import sys
import time

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


# A notebook of another machine, whose ports the browser does not reach.
HUB = "hub.example"
AWAY = """import pellucid
import pellucid._view
pellucid._view._MOST_EMBEDDED = 100
viewer = pellucid.view("builtin:marschner_lobb:24", open=False, height=420)
viewer"""


class File:
    """A page on disk."""

    def __init__(self, path):
        self.address = "file://" + str(path)


class Place:
    """A page of a server."""

    def __init__(self, address):
        self.address = address


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

    def open_page(path, address=None, **options):
        place = Place(address) if path is None else File(path)
        pages.append(page_driver.Page(place, str(tmp_path), **options))
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
    for most in ("20M", 0, float("nan"), float("inf")):
        with pytest.raises(pellucid.Error, match="max_size: expected a number of bytes"):
            pellucid.export(None, tmp_path / "a.html", max_size=most)
    for function in (lambda **how: pellucid.export(None, "a.html", **how),
                     lambda **how: pellucid.view(None, open=False, **how)):
        with pytest.raises(TypeError, match=r"^(export|view)\(\) got .* argument 'depth'"):
            function(depth=True)
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


@pytest.fixture
def hub(tmp_path):
    """A server of notebooks; gives the address of one with these cells."""
    nbformat = pytest.importorskip("nbformat")
    pytest.importorskip("notebook")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    home = tmp_path / "home"
    home.mkdir()
    options = [f"--port={port}", "--port-retries=0", "--no-browser", "--allow-root",
               *(f"--NotebookApp.{name}" for name in (
                   "token=", "password=", "allow_remote_access=True", f"notebook_dir={tmp_path}"))]
    with open(tmp_path / "server.log", "w", encoding="utf-8") as log:
        server = subprocess.Popen(
            [sys.executable, "-m", "notebook", *options], stdout=log, stderr=log,
            env={**os.environ, "HOME": str(home), "JUPYTER_RUNTIME_DIR": str(home)})

    def answers():
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=5)
        try:
            connection.request("GET", "/api")
            return connection.getresponse().status == 200
        except OSError:
            return False
        finally:
            connection.close()

    def address(*cells):
        book = nbformat.v4.new_notebook(
            cells=[nbformat.v4.new_code_cell(cell) for cell in cells],
            metadata={"kernelspec": {"name": "python3", "display_name": "Python 3",
                                     "language": "python"}})
        nbformat.write(book, str(tmp_path / "book.ipynb"))
        return f"http://{HUB}:{port}/notebooks/book.ipynb"

    try:
        deadline = time.monotonic() + 60
        while not answers():
            assert server.poll() is None and time.monotonic() < deadline, \
                (tmp_path / "server.log").read_text(encoding="utf-8")
            time.sleep(0.2)
        yield address
    finally:
        server.terminate()
        server.wait(30)


class Notebook:
    """A notebook in a browser that reaches the server of notebooks alone."""

    def __init__(self, browse, address):
        self.page = browse(None, address=address, window=(1000, 800), waits=False,
                           arguments=[f"--host-resolver-rules=MAP {HUB} 127.0.0.1"])
        self.page.wait_for(lambda: self.page.run(
            "return Boolean(window.Jupyter?.notebook?.kernel?.is_connected?.())"), "a kernel")

    def execute(self, cell, is_done):
        """Executes a cell; gives what the page says once it is done."""
        self.page.browser.switch_to.default_content()
        self.page.run("Jupyter.notebook.execute_cells([arguments[0]])", cell)
        return self.page.wait_for(lambda: self.page.run(is_done, cell), f"cell {cell}")

    def printed(self, cell):
        return self.execute(cell, """
            const {outputs} = Jupyter.notebook.get_cell(arguments[0]).output_area;
            return outputs.map(({text, evalue}) => text ?? evalue ?? '').join('')""")

    def enter_frame(self, cell):
        self.execute(cell, "return Boolean(document.querySelector('iframe[title=Pellucid]'))")
        self.page.browser.switch_to.frame(0)
        self.page.wait_exact(-1)

    def turn(self):
        before = self.page.frame()
        self.page.browser.find_element("css selector", "#picture").send_keys("\ue014" * 6)
        self.page.wait_exact(before)


TELL = "import json; print(json.dumps(list(viewer.scene.camera.position)))"


@pytest.mark.parametrize("cell", [CELL, AWAY], ids=["embedded", "away"])
def test_a_frame_reaches_the_kernel_alone(hub, browse, cell):
    notebook = Notebook(browse, hub(cell, TELL, TELL.replace("json;", "json ;")))
    notebook.enter_frame(0)
    before = json.loads(notebook.printed(1))
    notebook.page.browser.switch_to.frame(0)
    notebook.turn()
    after = json.loads(notebook.printed(2))
    assert numpy.abs(numpy.subtract(before, after)).max() > 0.1


def test_a_frame_goes_on_without_its_kernel(hub, browse):
    notebook = Notebook(browse, hub(CELL))
    page = notebook.page
    notebook.enter_frame(0)
    page.browser.switch_to.default_content()
    page.run("Jupyter.notebook.kernel.restart()")
    page.browser.switch_to.frame(0)
    page.wait_for(lambda: "Run the cell again" in page.text("#lost"), "the end of the kernel")
    page.press_button("Start again")
    page.wait_for(lambda: page.run("return document.getElementById('lost').hidden"), "a worker")
    page.wait_exact(-1)
    notebook.turn()
