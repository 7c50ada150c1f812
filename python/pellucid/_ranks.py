# SPDX-License-Identifier: Apache-2.0
"""One picture by several processes of MPI."""
from __future__ import annotations

from typing import Any, Callable, Optional

from . import _pellucid
from ._pellucid import Image
from .scene import Scene


def render_on_ranks(scene: Scene, comm: Any = None, box: Any = None, *, depth: bool = False,
                    values: bool = False, threads: int = 1,
                    progress: Optional[Callable[[float], Any]] = None) -> Optional[Image]:
    """Renders a scene on all ranks of a communicator. Returns the Image on rank 0, None on others.

    scene      a Scene with a camera and transfer functions, on every rank
    comm       a communicator of mpi4py; None: this process alone
    box        ((x, y, z), (x, y, z)): the corners of the part of the world whose data this rank
               has. The boxes of the ranks fill a box and meet in faces. Each layer has the values
               of all cells in the box, and for light one more on each side. None: every rank has
               the whole scene, and renders a part
    depth, values, threads, progress   as render() has them; threads of each rank, default 1

    All ranks call it. If one fails, all raise Error with that rank's message.
    """
    lower, upper = (None, None) if box is None else box
    handle = None if comm is None else comm.py2f()
    return _pellucid.render_on_ranks(scene, handle, lower, upper, depth=depth, values=values,
                                     threads=threads, progress=progress)
