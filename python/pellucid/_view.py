# SPDX-License-Identifier: Apache-2.0
"""The viewer in a frame of a notebook, or in the browser."""
from __future__ import annotations

import atexit
import copy
import html
import json
import math
import numbers
import os
import pathlib
import secrets
import sys
import weakref
from typing import Any, Optional, Union

from ._notebook import frame_name
from ._notes import tell
from ._pellucid import (Error, ViewerServer, page_of_scene, page_without_scene,
                        reduced_page_of_scene)
from ._render import check_keywords, scene_of
from .scene import Scene

# Notebooks are served to a browser of this machine from any port.
_NOTEBOOKS = "http://localhost:* http://127.0.0.1:*"
_running: "weakref.WeakSet[Viewer]" = weakref.WeakSet()
# Bytes of data, compressed, that a notebook takes unless it is told to.
_MOST_EMBEDDED = 16_000_000
# In a frame: the server where the notebook is of this machine and its page answers, else the page
# itself, which asks the kernel and can do without it.
_FRAME = """<!doctype html><meta charset="utf-8"><style>body {{margin: 0}}
iframe {{position: fixed; width: 100%; height: 100%; border: 0}}</style>
<textarea hidden>{page}</textarea><script>
const embedded = document.querySelector("textarea").value;
const live = document.createElement("iframe");
const show = () => {{
  removeEventListener("message", answer);
  document.open();
  document.write(embedded);
  document.close();
}};
const timer = setTimeout(show, 3000);
const answer = ({{source, data}}) => {{
  if (source === live.contentWindow && data === "pellucid") clearTimeout(timer);
}};
if (/^http:\\/\\/(localhost|127\\.0\\.0\\.1)(:|$)/.test(self.origin)) {{
  addEventListener("message", answer);
  live.referrerPolicy = "no-referrer";
  live.src = {address};
  document.body.append(live);
}} else {{
  clearTimeout(timer);
  show();
}}
</script>"""


class Viewer:
    """A scene that is turned and edited in a page, on this machine alone; view() makes it.

    In a notebook it shows itself as a frame, which reaches it through the kernel where the notebook
    is of another machine. Letting go of it, stop() and the end of the program end its page. It can
    be used in a `with` statement. What a notebook keeps of it shows the scene as it was then,
    without this program.
    """

    def __init__(self, scene: Scene, port: int = 0, threads: int = 0, height: int = 600,
                 embed: Optional[bool] = None) -> None:
        if not 50 <= height <= 10000:
            raise Error(f"height: expected 50 to 10000 pixels, got {height!r:.60}")
        self._given = [copy.copy(layer) for layer in scene.layers]
        self._height = int(height)
        self._embed = embed
        self._server = ViewerServer(scene, port, threads, _NOTEBOOKS)
        self._file: Optional[str] = None
        self._process = os.getpid()
        # What a frame calls it: nobody who sees a saved notebook learns the address by it.
        self._number = secrets.token_hex(16)
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

    def _page(self) -> Optional[bytes]:
        """A page that holds the scene as it is now; None: it is not to be, or cannot."""
        if self._embed is False:
            return None
        try:
            if self._embed:
                return page_of_scene(self.scene)
            return page_of_scene(self.scene, _MOST_EMBEDDED)
        except Error:
            if self._embed:
                raise
            return None

    def _repr_html_(self) -> str:
        page = self._page()
        if page is None and not self.running:
            return "<p>This viewer was stopped.</p>"
        name = frame_name(self, self._number, away=page is None) if self.running else None
        if page is None and name is not None and self._embed is None:
            page = _page_for_kernel()
        if page is None:
            source = f'src="{self.address}"'
        else:
            # No server has the reserved port 0.
            address = json.dumps(self.address if self.running else "http://127.0.0.1:0/")
            frame = _FRAME.format(page=html.escape(page.decode(), quote=False), address=address)
            source = f'srcdoc="{html.escape(frame)}"'
        if name is not None:
            source += f' name="{name}"'
        return (f'<iframe {source} title="Pellucid" '
                f'style="width: 100%; height: {self._height}px; border: 0" '
                'referrerpolicy="no-referrer"></iframe>')

    def __repr__(self) -> str:
        return f"<pellucid.Viewer {'of a page' if self.running else 'that was stopped'}>"


def _page_for_kernel() -> Optional[bytes]:
    """A page whose data the kernel has; None: it was not built."""
    try:
        return page_without_scene()
    except Error:
        return None


def view(data: Any, transfer_function: Any = None, *, open: Optional[bool] = None, port: int = 0,
         threads: int = 0, height: int = 600, embed: Optional[bool] = None, **how: Any) -> Viewer:
    """Shows data in a page where they are turned and edited, as `pellucid view` does.

    data, transfer_function, **how  as render() takes them, except depth, error, values, progress
                                    and renderer; size is that of the page, tolerance a number
    open      whether to open the browser of this machine; None: unless this is a notebook
    port      of the loopback interface; 0: any that is free
    threads   0: one per core
    height    of the frame in a notebook, in pixels
    embed     whether a notebook keeps the data too, so that the frame turns where it is exported,
              hosted or opened again, without this program; None: if the data have 16 MB at most
              where they are compressed

    Returns a Viewer: in a notebook, the last value of a cell, it shows itself. A script calls its
    wait(). Its `scene` is what is seen, to be rendered or kept. The data are not copied, and a page
    cannot write them. The page is at the loopback interface: where the notebook runs on another
    machine, forward the port and open the address. Raises Error as render() does.
    """
    check_keywords("view", how)
    if isinstance(how.get("tolerance"), str):
        raise Error(f"tolerance: expected a number, got {how['tolerance']!r:.60}; shares are for "
                    "render(), and the page has a slider")
    viewer = Viewer(scene_of(data, transfer_function, **how), port, threads, height, embed)
    if open or (open is None and "ipykernel" not in sys.modules):
        viewer.open()
    return viewer


def export(data: Any, path: Union[str, "os.PathLike[str]"], transfer_function: Any = None,
           *, max_size: Optional[int] = None, reduce: bool = False, **how: Any) -> None:
    """Writes a page (.html) that shows data in any browser, exact, without this program, as
    `pellucid export` does.

    data, transfer_function, **how  as render() takes them, except depth, error, values, progress
                                    and renderer; tolerance is a number
    path                            of the page, whose name ends in .html
    max_size                        bytes that the page may have; a larger one is not written
    reduce                          True: makes data coarser until the page has max_size

    The page holds the values as they are. To reduce is to halve the resolution of the largest data
    along each axis, again and again; a Note and the page say to what. Raises Error as render()
    does, where the page is too large, and for what a page cannot hold: fields of one's own, a
    backdrop.
    """
    check_keywords("export", how)
    target = pathlib.Path(path)
    if target.suffix.lower() != ".html":
        raise Error(f"{target}: expected a name that ends in .html")
    if max_size is not None and not (isinstance(max_size, numbers.Real)
                                     and 0 < max_size < math.inf):
        raise Error(f"max_size: expected a number of bytes, got {max_size!r:.60}")
    if reduce and max_size is None:
        raise Error("reduce: give max_size, the bytes to reduce to")
    scene = scene_of(data, transfer_function, **how)
    page, note = reduced_page_of_scene(scene, int(max_size)) if reduce \
        else (page_of_scene(scene), "")
    if max_size is not None and len(page) > max_size:
        raise Error(f"{target}: not written: it would have {len(page)} bytes, more than max_size "
                    f"{max_size}; make the data smaller or raise it"
                    + ("" if reduce else ", or give reduce=True"))
    if note:
        tell(note)
    partial = target.with_name(target.name + ".part")
    try:
        partial.write_bytes(page)
        partial.replace(target)
    except OSError as error:
        partial.unlink(missing_ok=True)
        raise Error(f"{target}: cannot write: {error.strerror}") from None


@atexit.register
def _stop_all() -> None:
    for viewer in list(_running):
        viewer.stop()
