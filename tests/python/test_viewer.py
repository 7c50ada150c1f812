# SPDX-License-Identifier: Apache-2.0
"""The viewer that Python serves: what its page shows is the scene, and back."""
import gc
import http.server
import os
import subprocess
import sys
import threading
import time
import urllib.parse
import weakref

import numpy
import pytest

import pellucid
from conftest import smooth

sys.path.insert(0, os.path.join(os.environ["PELLUCID_SOURCE_DIR"], "tests", "view"))
import viewer_process  # noqa: E402
sys.path.insert(0, os.path.join(os.environ["PELLUCID_SOURCE_DIR"], "tests", "cli"))
from program import png  # noqa: E402


class Client(viewer_process.Viewer):
    """Speaks with a server of this process."""

    def __init__(self, viewer):
        self.address = viewer.address
        url = urllib.parse.urlsplit(self.address)
        self.host, self.port, self.path = url.netloc, url.port, url.path


@pytest.fixture
def ball():
    return smooth(numpy.float32, (20, 22, 24))


def exact(page, width=48, height=40):
    """The picture of a page."""
    page.send(type="size", width=width, height=height)
    return page.receive_until(lambda m: m["type"] == "frame" and m["state"] == "exact"
                              and m["width"] == width)


def test_its_picture_is_renders(ball, tmp_path):
    with pellucid.view(ball, open=False) as viewer:
        with Client(viewer).open_socket() as page:
            exact(page)
            page.send(type="save", what="png")
            saved = page.receive_type("file")["bytes"]
        pellucid.render(viewer.scene).save(tmp_path / "ours.png")
    page, ours = png(saved), png((tmp_path / "ours.png").read_bytes())
    assert page[:2] == (48, 40)
    assert page == ours and len(set(ours[3][20])) > 20


def test_edits_come_back(ball):
    scene = pellucid.Scene([pellucid.Layer(ball, [(0, 0, (1, 0, 0)), (100, 1, (0, 1, 0))])])
    with pellucid.view(scene, open=False) as viewer:
        with Client(viewer).open_socket() as page:
            exact(page)
            before = viewer.scene.camera.position
            page.send(type="turn", x=0.2, y=0.1)
            points = [{"value": 0, "extinction": 0, "color": [0, 0, 1]},
                      {"value": 90, "extinction": 2, "color": [0, 0, 1]}]
            page.send(type="edit", layer=0, key="transfer_function", value={"points": points},
                      gesture=1)
            page.receive_until(lambda m: m["type"] == "scene" and
                               m["scene"]["layers"][0]["transfer_function"]["points"][1]["value"]
                               == 90)
        after = viewer.scene
        assert after.camera.position != before
        assert after.layers[0].transfer_function.points[1][:2] == (90, 2)
        assert after.layers[0].data is scene.layers[0].data
        assert scene.layers[0].transfer_function.points[1][:2] == (100, 1)


def test_all_kinds_of_arrays_are_shown():
    points = numpy.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
    mesh = pellucid.Mesh(points, [("tetra", [[0, 1, 2, 3]])], point_data={"t": [0., 1, 2, 3]})
    a, b = smooth(numpy.float32), smooth(numpy.uint8)
    channels = pellucid.Channels({"a": a, "b": b})
    gaussians = [pellucid.Gaussian((50, 50), 0.3, widths=(20, 20), channels=("a", "b"))]
    labels = pellucid.LabelVolume((b > 40).astype(numpy.uint8))
    for layer in (pellucid.Layer(mesh), pellucid.Layer(channels, gaussians),
                  pellucid.Layer(labels), pellucid.Layer(numpy.asfortranarray(a))):
        with pellucid.view(layer, open=False) as viewer:
            with Client(viewer).open_socket() as page:
                assert len(exact(page)["bytes"]) > 100
                page.send(type="save", what="scene")
                message = page.receive_type("error")["message"]
                assert "its data are arrays" in message
            again = viewer.scene
            assert again.layers[0].data is layer.data
            pellucid.render(again, size=20)


def test_arrays_take_gaussians_and_curves(ball):
    """The page computes the channels of a function from the values in memory."""
    with pellucid.view(ball, open=False) as viewer:
        with Client(viewer).open_socket() as page:
            exact(page)
            for kind, channels in (("gaussians", ["value", "gradient_magnitude"]), ("curve", None)):
                page.send(type="suggest", layer=0, kind=kind)
                message = page.receive_until(lambda m: m["type"] in ("error", "scene"))
                assert message["type"] == "scene", message
                data = viewer.scene.layers[0].data
                assert getattr(data, "names", None) == channels
                pellucid.render(viewer.scene, size=16)
        assert isinstance(data, pellucid.Volume)


def test_a_file_beside_an_array_changes_alone(ball, tmp_path):
    pellucid.Volume(ball).write(tmp_path / "ball.nii")
    scene = pellucid.Scene([pellucid.Layer(pellucid.read(tmp_path / "ball.nii")),
                            pellucid.Layer(ball)])
    with pellucid.view(scene, open=False) as viewer:
        with Client(viewer).open_socket() as page:
            exact(page)
            page.send(type="component", layer=0, component=0)
            message = page.receive_until(lambda m: m["type"] in ("error", "scene"))
            assert message["type"] == "scene", message
            page.send(type="component", layer=1, component=0)
            message = page.receive_until(lambda m: m["type"] in ("error", "scene"))
            assert "its data are arrays" in message["message"]
        assert viewer.scene.layers[1].data is scene.layers[1].data
        assert viewer.scene.layers[0].data is not scene.layers[0].data


def test_what_the_caller_changes_later_is_not_shown(ball):
    layer = pellucid.Layer(ball)
    with pellucid.view(layer, open=False) as viewer:
        data, layer.data, layer.mask = layer.data, None, "nonsense"
        assert viewer.scene.layers[0].data is data and viewer.scene.layers[0].mask is None


def test_programs_that_are_started_do_not_keep_the_port(ball):
    viewer = pellucid.view(ball, open=False)
    port = urllib.parse.urlsplit(viewer.address).port
    child = subprocess.Popen(["sleep", "60"], close_fds=False)
    try:
        viewer.stop()
        pellucid.view(ball, open=False, port=port).stop()
    finally:
        child.kill()
        child.wait()


def test_only_notebooks_of_this_machine_may_frame_it(ball):
    with pellucid.view(ball, open=False) as viewer:
        client = Client(viewer)
        status, headers, body = client.request(client.path)
        assert status == 200 and b"<html" in body
        policy = headers["content-security-policy"]
        assert "frame-ancestors http://localhost:* http://127.0.0.1:*" in policy
        assert client.request("/")[0] == 403
        assert viewer.address in viewer._repr_html_()
        assert viewer.address not in repr(viewer)


def test_letting_go_ends_it(ball):
    viewer = pellucid.view(ball, open=False)
    client = Client(viewer)
    kept = weakref.ref(viewer)
    with client.open_socket() as page:
        exact(page)
        del viewer
        gc.collect()
        assert kept() is None
        with pytest.raises(ConnectionError):
            while True:
                page.receive()
    with pytest.raises(OSError):
        client.connect()


def test_a_stopped_one_still_knows_its_scene(ball):
    viewer = pellucid.view(ball, open=False)
    assert viewer.running
    viewer.stop()
    viewer.stop()
    viewer.wait()
    assert not viewer.running and "stopped" in viewer._repr_html_()
    assert viewer.scene.layers[0].data.shape == ball.shape


def test_bad_arguments(ball):
    with pytest.raises(pellucid.Error, match="port: expected"):
        pellucid.view(ball, open=False, port=70000)
    with pellucid.view(ball, open=False) as viewer:
        port = urllib.parse.urlsplit(viewer.address).port
        with pytest.raises(pellucid.Error, match=f"port {port}: "):
            pellucid.view(ball, open=False, port=port)
    with pytest.raises(pellucid.Error, match="tolerance: expected a number"):
        pellucid.view(ball, open=False, tolerance="1%")
    with pytest.raises(pellucid.Error, match="height: "):
        pellucid.view(ball, open=False, height=-5)
    with pytest.raises(pellucid.Error, match="layer 1"):
        pellucid.view(pellucid.Layer(ball, [(0, 1, (0, 0, 0))], isosurfaces=["3"]), open=False)


def test_a_program_that_ends_with_one_ends_quietly():
    code = ("import numpy, pellucid, threading\n"
            "a = numpy.random.rand(20, 20, 20)\n"
            "v = [pellucid.view(a, open=False) for _ in range(3)]\n")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120,
                          check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_a_program_that_ends_beside_a_busy_thread_ends_quietly():
    code = ("import numpy, pellucid, threading, time\n"
            "layer = pellucid.Layer(numpy.random.rand(9, 9, 9))\n"
            "def work():\n"
            "    while True:\n"
            "        pellucid.view(layer, open=False, size=8).stop()\n"
            "threading.Thread(target=work, daemon=True).start()\n"
            "time.sleep(0.5)\n")
    for _ in range(3):
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                              timeout=120, check=False)
        assert (done.returncode, done.stderr) == (0, "")


def test_a_notebook_shows_it(ball, tmp_path):
    """A page of another port of this machine, as of a notebook, has it in a frame."""
    page_driver = pytest.importorskip("page_driver")
    if why := page_driver.why_not():
        pytest.skip(why)
    with pellucid.view(ball, open=False) as viewer:
        text = f"<!doctype html><title>n</title>{viewer._repr_html_()}".encode()

        class Notebook(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                self.send_response(200)
                self.send_header("Content-Type", "text/html")
                self.end_headers()
                self.wfile.write(text)

            def log_message(self, *unused):
                pass

        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Notebook)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        browser = page_driver.make_browser(str(tmp_path))
        try:
            browser.get(f"http://localhost:{server.server_port}/")
            browser.switch_to.frame(browser.find_element("tag name", "iframe"))
            # Within what the notebook keeps, where it keeps something, the program's page is shown.
            for inner in browser.find_elements("tag name", "iframe"):
                browser.switch_to.frame(inner)
            deadline = time.monotonic() + page_driver.SECONDS
            while "every pixel within" not in browser.find_element("css selector", "#state").text:
                assert time.monotonic() < deadline
                time.sleep(0.1)
        finally:
            browser.quit()
            server.shutdown()
        assert viewer.scene.size[0] > 100
