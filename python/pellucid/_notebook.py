# SPDX-License-Identifier: Apache-2.0
"""Frames of a notebook, joined to their viewers through its kernel.

A page in a frame (apps/web/page/end.js) opens a comm of Jupyter. What comes through it goes to the
viewer's server by a WebSocket within the kernel's machine, and back. So the browser needs no port
of that machine.
"""
from __future__ import annotations

import sys
import weakref
from typing import Any, Optional

TARGET = "pellucid.viewer"
_viewers: "weakref.WeakValueDictionary[str, Any]" = weakref.WeakValueDictionary()


class _Relay:
    """Passes messages on between a comm and the server of a viewer, in the kernel's loop."""

    def __init__(self, comm: Any, address: str) -> None:
        from tornado.httpclient import HTTPRequest
        from tornado.ioloop import IOLoop
        from tornado.websocket import websocket_connect

        self._comm = comm
        self._socket: Any = None
        comm.on_msg(self._send)
        comm.on_close(self._end)
        scheme, rest = address.split("://", 1)
        request = HTTPRequest(f"ws://{rest}socket",
                              headers={"Origin": f"{scheme}://{rest.split('/', 1)[0]}"})
        # Frames of large pages have more than the 10 MB that are usual.
        connecting = websocket_connect(request, on_message_callback=self._receive,
                                       max_message_size=1 << 30)
        IOLoop.current().add_future(connecting, self._connected)

    def _connected(self, connecting: Any) -> None:
        try:
            self._socket = connecting.result()
        except Exception:  # whatever it is: there is no viewer
            self._comm.close()
        else:
            self._comm.send({"ready": True})

    def _send(self, message: Any) -> None:
        from tornado.websocket import WebSocketClosedError

        text = message["content"]["data"].get("text")
        if self._socket is not None and isinstance(text, str):
            try:
                self._socket.write_message(text)
            except WebSocketClosedError:
                self._comm.close()

    def _receive(self, message: Any) -> None:
        if message is None:
            self._comm.close()
        elif isinstance(message, str):
            self._comm.send({"text": message})
        else:
            self._comm.send({}, buffers=[message])

    def _end(self, unused: Any) -> None:
        if self._socket is not None:
            self._socket.close()


def _open(comm: Any, message: Any) -> None:
    """Joins a page to the viewer that it names."""
    viewer = _viewers.get(str(message["content"]["data"].get("viewer")))
    if viewer is None or not viewer.running:
        comm.close()
    else:
        _Relay(comm, viewer.address)


def frame_name(viewer: Any, number: str, away: bool) -> Optional[str]:
    """The name of a frame that can reach the viewer through the kernel; None outside of one.

    number  of the viewer, of letters and digits
    away    whether the data are in the kernel alone
    """
    application = getattr(sys.modules.get("ipykernel.kernelapp"), "IPKernelApp", None)
    if application is None or not application.initialized():
        return None
    comms = getattr(application.instance().kernel, "comm_manager", None)
    if comms is None:
        return None
    comms.register_target(TARGET, _open)
    _viewers[number] = viewer
    return f"pellucid:{number}{':away' if away else ''}"
