# SPDX-License-Identifier: Apache-2.0
"""The viewer in a frame of a notebook, or in the browser."""
from __future__ import annotations

import atexit
import copy
import os
import sys
import weakref
from typing import Any, Optional

from ._pellucid import Error, ViewerServer
from ._render import scene_of
from .scene import Scene

# Notebooks are served to a browser of this machine from any port.
_NOTEBOOKS = "http://localhost:* http://127.0.0.1:*"
_running: "weakref.WeakSet[Viewer]" = weakref.WeakSet()


class Viewer:
    """A scene that is turned and edited in a page, on this machine alone; view() makes it.

    In a notebook it shows itself as a frame. Letting go of it, stop() and the end of the program
    end its page. It can be used in a `with` statement.
    """

    def __init__(self, scene: Scene, port: int = 0, threads: int = 0, height: int = 600) -> None:
        if not 50 <= height <= 10000:
            raise Error(f"height: expected 50 to 10000 pixels, got {height!r:.60}")
        self._given = [copy.copy(layer) for layer in scene.layers]
        self._height = int(height)
        self._server = ViewerServer(scene, port, threads, _NOTEBOOKS)
        self._file: Optional[str] = None
        self._process = os.getpid()
        _running.add(self)

    @property
    def address(self) -> str:
        """Where the page is. It holds a random token: who has it can see the data."""
        return self._server.address

    @property
    def running(self) -> bool:
        """Whether the page is still served."""
        return self._server.running

    @property
    def scene(self) -> Scene:
        """The scene as it is now, with the camera and what was edited in the page."""
        scene = self._server.scene()
        # Arrays come back as they were given: the same object, with its order of axes.
        for layer, given, is_same in zip(scene.layers, self._given, self._server.same_data()):
            if is_same:
                layer.data, layer.mask = given.data, given.mask
        return scene

    def open(self) -> bool:
        """Opens the page in the browser. Returns whether one was found."""
        if not self.running:
            return False
        import tempfile
        import webbrowser

        # Other users of the machine can read the arguments of a browser, but not this file.
        if self._file is None:
            handle, self._file = tempfile.mkstemp(prefix="pellucid-", suffix=".html")
            with os.fdopen(handle, "w", encoding="ascii") as file:
                file.write('<!doctype html><meta charset="utf-8">'
                           '<meta name="referrer" content="no-referrer">'
                           f'<meta http-equiv="refresh" content="0; url={self.address}">'
                           "<title>Pellucid</title>\n")
        return webbrowser.open("file://" + self._file)

    def wait(self) -> None:
        """Returns when the viewer was stopped. Ctrl-C raises KeyboardInterrupt."""
        self._server.wait()

    def stop(self) -> None:
        """Ends the page. The scene can still be read."""
        if self._process != os.getpid():
            return  # a child has neither the threads nor the file
        self._server.stop()
        if self._file is not None:
            try:
                os.unlink(self._file)
            except OSError:
                pass
            self._file = None

    def __enter__(self) -> Viewer:
        return self

    def __exit__(self, *unused: Any) -> None:
        self.stop()

    def __del__(self) -> None:
        if hasattr(self, "_server"):
            self.stop()

    def _repr_html_(self) -> str:
        if not self.running:
            return "<p>This viewer was stopped.</p>"
        return (f'<iframe src="{self.address}" title="Pellucid" '
                f'style="width: 100%; height: {self._height}px; border: 0" '
                'referrerpolicy="no-referrer"></iframe>')

    def __repr__(self) -> str:
        return f"<pellucid.Viewer {'of a page' if self.running else 'that was stopped'}>"


def view(data: Any, transfer_function: Any = None, *, open: Optional[bool] = None, port: int = 0,
         threads: int = 0, height: int = 600, **how: Any) -> Viewer:
    """Shows data in a page where they are turned and edited, as `pellucid view` does.

    data, transfer_function, **how  as render() takes them, except depth, error, values, progress
                                    and renderer; size is that of the page, tolerance a number
    open      whether to open the browser of this machine; None: unless this is a notebook
    port      of the loopback interface; 0: any that is free
    threads   0: one per core
    height    of the frame in a notebook, in pixels

    Returns a Viewer: in a notebook, the last value of a cell, it shows itself. A script calls its
    wait(). Its `scene` is what is seen, to be rendered or kept. The data are not copied, and a page
    cannot write them. The page is at the loopback interface: where the notebook runs on another
    machine, forward the port and open the address. Raises Error as render() does.
    """
    if isinstance(how.get("tolerance"), str):
        raise Error(f"tolerance: expected a number, got {how['tolerance']!r:.60}; shares are for "
                    "render(), and the page has a slider")
    viewer = Viewer(scene_of(data, transfer_function, **how), port, threads, height)
    if open or (open is None and "ipykernel" not in sys.modules):
        viewer.open()
    return viewer


@atexit.register
def _stop_all() -> None:
    for viewer in list(_running):
        viewer.stop()
