# SPDX-License-Identifier: Apache-2.0
"""`pellucid view` as others on the machine and in the network see it."""

import concurrent.futures
import errno
import json
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

from viewer_process import PROGRAM, Refused, Viewer, read_answer

SOURCE_DIR = os.environ.get("PELLUCID_SOURCE_DIR", os.path.join(os.path.dirname(__file__), "../.."))
sys.path.insert(0, os.path.join(SOURCE_DIR, "tests", "cli"))
from program import png  # noqa: E402

FIELD = "builtin:sphere:24"
RED = {"points": [{"value": 0, "extinction": 3, "color": "#ff0000"}]}


def picture_of_frame(frame):
    """Width, height, channels and rows of bytes, as png() gives them, without alpha."""
    width, height = frame["width"], frame["height"]
    pixels = frame["bytes"][:4 * width * height]
    colors = bytearray(3 * width * height)
    for channel in range(3):
        colors[channel::3] = pixels[channel::4]
    return width, height, 3, [bytes(colors[y * 3 * width:(y + 1) * 3 * width])
                              for y in range(height)]


def rendered(folder, scene, *arguments):
    """The picture that the command line makes of a saved scene."""
    with open(os.path.join(folder, "scene.json"), "wb") as file:
        file.write(scene)
    subprocess.run([PROGRAM, "render", "scene.json", "-o", "out.png", "-q", *arguments],
                   cwd=folder, check=True, timeout=600)
    with open(os.path.join(folder, "out.png"), "rb") as file:
        return png(file.read())


class Gatekeeping(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.viewer = Viewer(FIELD)
        cls.addClassCleanup(cls.viewer.stop)

    def refused(self, path, headers=None, method="GET"):
        status, _, body = self.viewer.request(path, headers, method)
        self.assertEqual((status, body), (403, b""), (path, headers))

    def test_the_page_is_served_to_its_address(self):
        for name in ("", "index.html", "main.js", "style.css", "icon.svg"):
            status, headers, body = self.viewer.request(self.viewer.path + name)
            self.assertEqual(status, 200, name)
            self.assertGreater(len(body), 100)
            policy = headers["content-security-policy"]
            self.assertIn("default-src 'none'", policy)
            self.assertNotIn("unsafe", policy)
            self.assertNotIn("*", policy)
            self.assertEqual(headers["referrer-policy"], "no-referrer")
            self.assertEqual(headers["x-content-type-options"], "nosniff")
            self.assertEqual(headers["cache-control"], "no-store")
            self.assertNotIn("access-control-allow-origin", headers)

    def test_the_page_asks_nobody_else(self):
        _, _, index = self.viewer.request(self.viewer.path)
        names = set(re.findall(r'(?:src|href)="([^"]+)"', index.decode()))
        pending, seen = set(names), set()
        while pending:
            name = pending.pop()
            seen.add(name)
            status, _, body = self.viewer.request(self.viewer.path + name)
            self.assertEqual(status, 200, name)
            text = body.decode()
            addresses = re.findall(r"\b(?:https?|wss?|ftp)://[^\s'\"`]+", text)
            self.assertLessEqual(set(addresses), {"http://www.w3.org/2000/svg"}, name)
            pending |= set(re.findall(r"from '\./([^']+)'", text)) - seen
        self.assertIn("curve_editor.js", seen)

    def test_a_wrong_token(self):
        token = self.viewer.path.strip("/")
        wrong = token[:-1] + ("0" if token[-1] != "0" else "1")
        for path in ("/", "/index.html", "/socket", f"/{wrong}/", f"/{token[:-1]}/", f"/{token}",
                     f"/{token}0/", f"/?token={token}", f"/x/{token}/", "*"):
            self.refused(path)

    def test_a_wrong_host(self):
        path = self.viewer.path
        for host in ("evil.example", f"evil.example:{self.viewer.port}", "127.0.0.1", "localhost",
                     f"127.0.0.1:{self.viewer.port}.evil.example", "", None):
            self.refused(path, {"Host": host})
        status, _, _ = self.viewer.request(path, {"Host": f"localhost:{self.viewer.port}"})
        self.assertEqual(status, 200)

    def test_two_hosts(self):
        with self.viewer.connect() as connection:
            connection.sendall(f"GET {self.viewer.path} HTTP/1.1\r\nHost: {self.viewer.host}\r\n"
                               "Host: evil.example\r\nConnection: close\r\n\r\n".encode())
            self.assertIn(read_answer(connection)[0], (0, 403))

    def test_a_wrong_origin(self):
        own = "http://" + self.viewer.host
        for origin in ("http://evil.example", "null", "https://" + self.viewer.host, own + "0",
                       f"http://localhost:{self.viewer.port}", ""):
            self.refused(self.viewer.path, {"Origin": origin})
            with self.assertRaises(Refused) as caught:
                self.viewer.open_socket(Origin=origin)
            self.assertEqual((caught.exception.status, caught.exception.body), (403, b""))
        with self.assertRaises(Refused) as caught:
            self.viewer.open_socket(Origin=None)
        self.assertEqual(caught.exception.status, 403)

    def test_a_socket_without_the_token_or_for_another_host(self):
        for path in ("/socket", "/0123/socket"):
            with self.assertRaises(Refused) as caught:
                self.viewer.open_socket(path)
            self.assertEqual(caught.exception.status, 403)
        rebound = f"evil.example:{self.viewer.port}"
        with self.assertRaises(Refused) as caught:
            self.viewer.open_socket(Host=rebound, Origin="http://" + rebound)
        self.assertEqual(caught.exception.status, 403)

    def test_other_paths_and_methods(self):
        path = self.viewer.path
        for name in ("../index.html", "/etc/passwd", "..%2f..%2fetc/passwd", "index.html?x", "x"):
            self.assertEqual(self.viewer.request(path + name)[0], 404, name)
        for method in ("HEAD", "PUT", "OPTIONS", "DELETE"):
            self.assertIn(self.viewer.request(path, method=method)[0], (0, 405))
        self.assertEqual(self.viewer.request(path, {"Content-Length": "7"}, "POST")[0], 0)

    def test_long_headers_are_not_read(self):
        self.assertEqual(self.viewer.request("/" + "a" * 100000)[0], 0)
        self.assertEqual(self.viewer.request(self.viewer.path, {"X": "a" * 100000})[0], 0)
        self.assertEqual(self.viewer.request(self.viewer.path)[0], 200)

    def test_what_is_not_http(self):
        for data in (b"\0" * 100, b"GET\r\n\r\n", b"\x16\x03\x01\x02\x00" * 20, b"\xff" * 9000):
            with self.viewer.connect() as connection:
                try:
                    connection.sendall(data)
                    connection.shutdown(socket.SHUT_WR)
                except ConnectionError:
                    pass  # it was closed before it had all
                except OSError as error:
                    self.assertEqual(error.errno, errno.ENOTCONN)
                self.assertEqual(read_answer(connection)[0], 0)
        self.assertEqual(self.viewer.request(self.viewer.path)[0], 200)

    def test_only_this_machine_can_connect(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.connect(("192.0.2.1", 9))  # sends nothing
            except OSError:
                self.skipTest("there is no other network interface")
            own = probe.getsockname()[0]
        if own.startswith("127."):
            self.skipTest("there is no other network interface")
        with self.assertRaises(OSError):
            socket.create_connection((own, self.viewer.port), timeout=5)


class Messages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.viewer = Viewer(FIELD)
        cls.addClassCleanup(cls.viewer.stop)

    def test_malformed_messages_are_answered_and_change_nothing(self):
        with self.viewer.open_socket() as page:
            before = page.receive_type("scene")["scene"]
            for message in (b"", b"{", b"\xff\xfe\0", b"[1]", b'{"type": "steal"}', b"{}",
                            b'{"type": "turn", "x": 1e9, "y": 0}', b"[" * 50000,
                            b'{"type": "edit", "layer": 0, "key": "field", '
                            b'"value": {"file": "/etc/passwd"}, "gesture": 1}'):
                page.send_bytes(message, 2 if message.startswith(b"\xff") else 1)
                self.assertIn("message", page.receive_type("error"))
            page.send(type="undo")
            self.assertEqual(page.receive_type("scene")["scene"], before)

    def test_oversized_messages_end_the_connection(self):
        page = self.viewer.open_socket()
        with page, self.assertRaises(ConnectionError):
            page.send_bytes(b'{"type": "import", "text": "' + b"a" * (3 << 20) + b'"}')
            while True:
                page.receive()
        with self.viewer.open_socket() as again:
            again.receive_type("scene")

    def test_a_frame_that_breaks_the_protocol_ends_the_connection(self):
        page = self.viewer.open_socket()
        with page, self.assertRaises(ConnectionError):
            page.connection.sendall(b"\xf3\x05hello")  # reserved bits, not masked
            while True:
                page.receive()

    def test_all_pages_see_edits(self):
        with self.viewer.open_socket() as first, self.viewer.open_socket() as second:
            second.receive_type("scene")
            first.send(type="edit", layer=0, key="transfer_function", value=RED, gesture=1)

            def is_red(message):
                return message["type"] == "scene" and message["scene"]["layers"][0][
                    "transfer_function"]["points"][0]["color"] == [1, 0, 0]
            first.receive_until(is_red)
            second.receive_until(is_red)

    def test_a_page_is_greeted_before_it_is_told_the_scene(self):
        # In one of six openings the scene came first, by itself or as others were told it.
        with self.viewer.open_socket() as busy:
            busy.send(type="size", width=16, height=16)
            for _ in range(60):
                busy.send(type="turn", x=0.01, y=0)
                with self.viewer.open_socket() as page:
                    self.assertEqual(page.receive()["type"], "start")
                    page.receive_type("scene")

    def test_an_error_is_told_to_who_caused_it(self):
        with self.viewer.open_socket() as page:
            page.send(type="edit", layer=0, key="transfer_function", gesture=2,
                      value={"points": []})
            self.assertRegex(page.receive_type("error")["message"], "transfer_function/points")
            page.send(type="import", layer=0, name="a.json", text="nothing")
            self.assertRegex(page.receive_type("error")["message"], "^a.json")


# As numpy writes a volume of 4 x 4 x 4 bytes.
NPY_HEADER = b"{'descr': '|u1', 'fortran_order': False, 'shape': (4, 4, 4), }"
NPY = (b"\x93NUMPY\x01\x00" + bytes([118, 0]) + NPY_HEADER.ljust(117) + b"\n" +
       bytes(range(0, 256, 4)))


class Opening(unittest.TestCase):
    """`pellucid view` alone: the page chooses the file."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.temporary = os.path.join(self.folder, "temporary")
        os.mkdir(self.temporary)
        os.environ["TMPDIR"] = self.temporary
        self.addCleanup(os.environ.pop, "TMPDIR")
        self.viewer = Viewer(folder=self.folder)
        self.addCleanup(self.viewer.stop)

    def write(self, name, data):
        with open(os.path.join(self.folder, name), "wb") as file:
            file.write(data)

    def saved_field(self, page):
        page.receive_type("opened")
        scene = page.receive_type("scene")
        page.exact_frame()
        page.send(type="save", what="scene")
        return scene, json.loads(page.receive_type("file")["bytes"])["layers"][0]["field"]

    def test_from_a_folder(self):
        self.write("a.npy", NPY)
        self.write("b.txt", b"?")
        with self.viewer.open_socket() as page:
            start = page.receive_type("start")
            self.assertEqual((start["has_scene"], start["can_open"]), (False, True))
            self.assertGreater(start["upload_bytes"], 1 << 30)
            page.send(type="size", width=64, height=48)  # nothing is shown yet
            page.send(type="list_folder", folder="")
            folder = page.receive_type("folder")
            self.assertEqual(folder["path"], os.path.realpath(self.folder))
            self.assertEqual([(e["name"], e["known"]) for e in folder["entries"]],
                             [("temporary", False), ("a.npy", True), ("b.txt", False)])
            page.send(type="open", input=os.path.join(folder["path"], "a.npy"))
            self.assertIn("a.npy", page.receive_type("opening")["name"])
            scene, field = self.saved_field(page)
            self.assertFalse(scene["temporary"])
            self.assertEqual(field["file"], os.path.join(folder["path"], "a.npy"))
            with self.viewer.open_socket() as other:
                self.assertTrue(other.receive_type("start")["has_scene"])
                other.receive_type("scene")

    def test_another_one_and_one_that_fails(self):
        with self.viewer.open_socket() as page:
            page.send(type="open", input="builtin:ramp:8")
            _, field = self.saved_field(page)
            self.assertEqual(field["builtin"], "ramp")
            page.send(type="open", input="none.npy")
            self.assertRegex(page.receive_type("error")["message"], r"^none\.npy: [^\n]*$")
            page.send(type="open", input="builtin:sphere:8")
            _, field = self.saved_field(page)
            self.assertEqual(field["builtin"], "sphere")
            page.send(type="list_folder", folder="/none/such")
            self.assertRegex(page.receive_type("error")["message"], "^/none/such: ")

    def test_files_that_are_dropped(self):
        for name, data in (("a%20b.npy", NPY), ("more/c.raw", bytes(64))):
            self.assertEqual(self.viewer.upload(f"5/{name}", data), (200, ""))
        with self.viewer.open_socket() as page:
            page.send(type="open_upload", set=5, name="a b.npy")
            scene, field = self.saved_field(page)
            # What is saved beside the data finds them.
            self.assertTrue(scene["temporary"])
            self.assertEqual(field["file"], "a b.npy")
            folders = os.listdir(self.temporary)
            self.assertEqual(len(folders), 1)
            self.assertEqual(os.stat(os.path.join(self.temporary, folders[0])).st_mode & 0o77, 0)
            page.send(type="open_upload", set=6, name="a")
            self.assertRegex(page.receive_type("error")["message"], "drop them again")
        self.assertEqual(self.viewer.stop()[0], 0)
        self.assertEqual(os.listdir(self.temporary), [])

    def test_what_is_not_taken(self):
        upload = self.viewer.upload
        for name in ("..%2fa", "a/../../b", "%00", "", "a//b", "%2fetc%2fpasswd", "%2"):
            status, text = upload(f"1/{name}", b"x")
            self.assertEqual(status, 400, name)
            self.assertRegex(text, r"\Aupload: [^\n]+\Z")
        for path in ("x/a", "-1/a", "a", "99999999999999/a"):
            self.assertEqual(upload(path, b"x")[0], 400, path)
        self.assertEqual(upload("1/a", b"x", length=1 << 40)[0], 400)
        self.assertEqual(upload("1/a", b"", {"Content-Length": None})[0], 411)
        for origin in (None, "http://evil.example", "null"):
            self.assertIn(upload("1/a", b"x", {"Origin": origin})[0], (0, 403))
        self.assertIn(upload("1/a", b"x", {"Host": "evil.example"})[0], (0, 403))
        self.assertEqual(upload("1/a", b"x"), (200, ""))
        self.assertEqual(upload("1/a", b"y")[0], 400)
        self.assertEqual(self.viewer.request(self.viewer.path)[0], 200)


class Freshness(unittest.TestCase):
    """Frames tell each page which of its messages they follow."""

    def test_frames_follow_messages(self):
        with Viewer(FIELD) as viewer, viewer.open_socket() as page:
            name = str(page.receive_type("start")["page"])

            def answered(count):
                return lambda m: m.get("answered", {}).get(name, 0) >= count
            page.send(type="size", width=96, height=64)
            page.send(type="turn", x=0.1, y=0)
            page.receive_type("changing")
            frame = page.receive_until(lambda m: m["type"] == "frame" and answered(2)(m) and
                                       m["state"] == "exact")
            self.assertEqual(frame["width"], 96)
            # A message that is refused makes no frame, and is answered too.
            page.send(type="turn", x=1e9, y=0)
            self.assertEqual({page.receive()["type"], page.receive()["type"]},
                             {"current", "error"})
            page.send(type="turn", x=1e9, y=0)
            self.assertEqual(page.receive_until(answered(4))["type"], "current")
            with viewer.open_socket() as other:
                second = str(other.receive_type("start")["page"])
                other.send(type="zoom", factor=1.5)
                frame = page.receive_until(lambda m: m.get("answered", {}).get(second, 0) >= 1)
                self.assertEqual(frame["type"], "frame")


class Crowds(unittest.TestCase):
    def test_fifty_connections_at_once(self):
        with Viewer(FIELD) as viewer:
            connections = [viewer.connect() for _ in range(50)]
            # Those beyond the limit are closed at once, the others wait for a request.
            deadline = time.monotonic() + 30
            closed = 0
            while closed < 18 and time.monotonic() < deadline:
                closed = 0
                for connection in connections:
                    connection.settimeout(0.05)
                    try:
                        closed += connection.recv(1, socket.MSG_PEEK) == b""
                    except TimeoutError:
                        pass
                    except ConnectionError:
                        closed += 1
            self.assertEqual(closed, 18)
            for connection in connections:
                connection.close()
            with concurrent.futures.ThreadPoolExecutor(50) as pool:
                answers = list(pool.map(lambda _: viewer.request(viewer.path)[0], range(50)))
            self.assertLessEqual(set(answers), {0, 200})
            self.assertIn(200, answers)
            self.until_it_answers(viewer)
            self.assertEqual(viewer.stop()[0], 0)

    def until_it_answers(self, viewer):
        for _ in range(100):
            if viewer.request(viewer.path)[0] == 200:
                return
            time.sleep(0.1)
        self.fail("the server does not answer any more")

    def test_a_client_that_sends_slowly_is_cut_off(self):
        with Viewer(FIELD) as viewer, viewer.connect() as slow:
            start = time.monotonic()
            slow.settimeout(60)
            slow.sendall(b"GET / HTTP/1.1\r\n")
            data = b""
            try:
                while True:
                    # A byte now and then does not help.
                    slow.settimeout(1)
                    try:
                        data = slow.recv(1)
                        break
                    except TimeoutError:
                        slow.sendall(b"X")
                    self.assertLess(time.monotonic() - start, 60)
            except ConnectionError:
                pass
            self.assertEqual(data, b"")
            self.assertGreater(time.monotonic() - start, 5)
            self.assertEqual(viewer.request(viewer.path)[0], 200)

    def test_a_page_that_does_not_read_holds_up_nobody(self):
        with Viewer(FIELD) as viewer, viewer.open_socket() as deaf, viewer.open_socket() as page:
            deaf.send(type="size", width=600, height=600)
            for _ in range(100):
                page.send(type="turn", x=0.01, y=0)
                page.receive_type("frame")
            page.exact_frame()
            with open(f"/proc/{viewer.program()}/status", encoding="ascii") as file:
                size = int(re.search(r"VmRSS:\s+(\d+)", file.read()).group(1))
            self.assertLess(size, 1500000)


class Pictures(unittest.TestCase):
    def check_frame_is_of_saved_scene(self, page, *arguments):
        frame = page.exact_frame()
        page.send(type="save", what="scene")
        saved = page.receive_type("file")
        with tempfile.TemporaryDirectory() as folder:
            picture = rendered(folder, saved["bytes"], *arguments)
        self.assertEqual(picture, picture_of_frame(frame))

    def settled(self, page, width, height):
        page.send(type="size", width=width, height=height)
        page.receive_until(lambda m: m["type"] == "frame" and m["state"] == "exact" and
                           (m["width"], m["height"]) == (width, height))

    def test_a_color_bar_is_drawn_over_a_saved_picture(self):
        if os.environ.get("PELLUCID_HAS_CAIRO") != "1":
            self.skipTest("built without Cairo")
        with Viewer(FIELD) as viewer, viewer.open_socket() as page:
            self.settled(page, 240, 160)
            pictures = []
            for what in ("png", "png_with_color_bar"):
                page.send(type="save", what=what)
                pictures.append(png(page.receive_type("file")["bytes"]))
            (width, _, channels, plain), (_, _, _, drawn) = pictures
            pixels = [slice(channels * x, channels * (x + 1)) for x in range(width)]
            different = {x for a, b in zip(plain, drawn) for x, at in enumerate(pixels)
                         if a[at] != b[at]}
            self.assertGreater(min(different), width // 2)

    def test_the_last_frame_is_that_of_the_last_command(self):
        with Viewer(FIELD) as viewer, viewer.open_socket() as page:
            self.settled(page, 96, 64)
            for i in range(40):
                page.send(type="turn", x=0.02, y=0.005)
                page.send(type="edit", layer=0, key="transfer_function", gesture=5, value={
                    "points": [{"value": 0, "extinction": 0.2 + i / 10, "color": "#ff8040"},
                               {"value": 1, "extinction": 3, "color": [0, i / 40, 1]}]})
            page.send(type="zoom", factor=1.3)
            page.send(type="save", what="png")  # follows all of them
            picture = page.receive_type("file")
            page.send(type="save", what="scene")
            saved = page.receive_until(lambda m: m["type"] == "file" and m["name"] == "scene.json")
            page.send(type="error_map", shown=True)
            frame = page.receive_until(lambda m: m["type"] == "frame" and m.get("error_map"))
            with tempfile.TemporaryDirectory() as folder:
                again = rendered(folder, saved["bytes"])
            self.assertEqual(again, png(picture["bytes"]))
            self.assertEqual(again, picture_of_frame(frame))
            self.assertEqual(json.loads(saved["bytes"])["layers"][0]["transfer_function"]["points"][
                0]["extinction"], 0.2 + 39 / 10)

    def test_a_frame_is_the_picture_of_the_command_line(self):
        with Viewer(FIELD) as viewer, viewer.open_socket() as page:
            self.settled(page, 80, 60)
            page.send(type="edit", key="background", value="#204060", gesture=1)
            self.check_frame_is_of_saved_scene(page)
            page.send(type="projection", name="orthographic")
            self.check_frame_is_of_saved_scene(page)
            page.send(type="edit", key="clip", gesture=2, value=[
                {"box": {"lower": [-1, -1, -1], "upper": [0.3, 1, 1]}}])
            self.check_frame_is_of_saved_scene(page)
            page.send(type="handle", clip=0, handle="x1", x=-0.05, y=0.02, gesture=3)
            self.check_frame_is_of_saved_scene(page)
            page.send(type="suggest", layer=0, kind="gaussians")
            self.check_frame_is_of_saved_scene(page)
            page.send(type="tolerance", value=1e-4)
            self.check_frame_is_of_saved_scene(page)

    def test_coarse_frames_come_first(self):
        with Viewer("builtin:marschner_lobb:96") as viewer, viewer.open_socket() as page:
            page.send(type="size", width=900, height=900)
            states = []
            page.receive_until(lambda m: m["type"] == "frame" and not states.append(
                (m["state"], m["stride"], m["width"])) and m["state"] == "exact" and
                m["width"] == 900)
            ours = [state for state in states if state[2] == 900]
            self.assertGreater(len(ours), 1, states)
            strides = [stride for _, stride, _ in ours]
            self.assertEqual(strides, sorted(strides, reverse=True))

    def test_a_save_as_exr_is_an_exr(self):
        with Viewer(FIELD) as viewer, viewer.open_socket() as page:
            self.settled(page, 32, 32)
            page.send(type="save", what="exr")
            self.assertEqual(page.receive_type("file")["bytes"][:4], b"\x76\x2f\x31\x01")


class Ending(unittest.TestCase):
    def test_control_c(self):
        viewer = Viewer(FIELD)
        with viewer.open_socket() as page:
            page.receive_type("scene")
            status, errors = viewer.stop(signal.SIGINT)
        self.assertEqual(status, 0, errors)

    def test_a_signal_while_a_frame_is_rendered(self):
        viewer = Viewer("builtin:marschner_lobb:128")
        with viewer.open_socket() as page:
            page.send(type="size", width=1500, height=1500)
            page.receive_type("frame")
            start = time.monotonic()
            status, errors = viewer.stop(signal.SIGTERM)
        self.assertEqual(status, 0, errors)
        self.assertLess(time.monotonic() - start, 20)

    def test_a_signal_while_saves_wait(self):
        viewer = Viewer("builtin:marschner_lobb:32")
        with viewer.open_socket() as page:
            page.receive_type("scene")
            page.send(type="size", width=1400, height=1400)
            page.send(type="tolerance", value=1e-6)
            for _ in range(200):
                page.send(type="save", what="exr")
            time.sleep(0.5)
            start = time.monotonic()
            status, errors = viewer.stop(signal.SIGINT)
        self.assertEqual(status, 0, errors)
        self.assertLess(time.monotonic() - start, 20)

    def test_a_name_that_no_page_can_be_told(self):
        with tempfile.TemporaryDirectory() as folder:
            name = os.path.join(os.fsencode(folder), b"caf\xe9.nrrd")
            with open(name, "wb") as file:
                file.write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\n"
                           b"encoding: raw\n\n" + bytes(range(8)))
            result = subprocess.run([os.fsencode(PROGRAM), b"view", name, b"--no-open"],
                                    capture_output=True, timeout=60)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr.decode(errors="replace"),
                         r"\Apellucid: error: [^\n]*UTF-8[^\n]*\n\Z")

    def test_with_the_last_page(self):
        with Viewer(FIELD, "--end-with-page") as viewer:
            for _ in range(2):  # a page that is loaded again goes and comes
                with viewer.open_socket() as page:
                    page.receive_type("scene")
            self.assertEqual(viewer.process.wait(60), 0)

    def test_a_port_that_is_taken(self):
        with Viewer(FIELD) as viewer:
            result = subprocess.run([PROGRAM, "view", FIELD, "--no-open", "--port",
                                     str(viewer.port)], capture_output=True, timeout=60)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr.decode(),
                         rf"\Apellucid: error: port {viewer.port}: [^\n]*--port[^\n]*\n\Z")

    def test_a_port_of_choice(self):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        with Viewer(FIELD, "--port", str(port)) as viewer:
            self.assertEqual(viewer.port, port)


if __name__ == "__main__":
    unittest.main()
