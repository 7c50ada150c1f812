# SPDX-License-Identifier: Apache-2.0
"""Renders by mpi4py on all ranks, twice: whole data, and arrays of which each rank has a part.

Prints "the same" on rank 0 if both pictures are those of one process within their errors.
"""
import sys

import numpy
import pellucid
from mpi4py import MPI

comm = MPI.COMM_WORLD
rank, size = comm.Get_rank(), comm.Get_size()
n = 24
z, y, x = numpy.mgrid[0:n, 0:n, 0:n].astype(numpy.float32)
whole = numpy.sin(0.4 * x) * numpy.cos(0.3 * y + 0.2 * z) + 1
points = [(0.5, 0, "#ffffff"), (1.2, 0.1, "#ff8000"), (2, 0.5, "#0080ff")]
camera = pellucid.Camera(position=(60, 45, 70), focal_point=(11.5, 11.5, 11.5))


def scene_of(volume):
    layer = pellucid.Layer(volume, pellucid.TransferFunction(points), shading=pellucid.Shading())
    return pellucid.Scene([layer], camera=camera, size=(32, 32))


everything = scene_of(pellucid.Volume(whole))
of_whole = pellucid.render_on_ranks(everything, comm)

# Slabs that meet half-way between values, with two planes of the neighbors.
first, end = n * rank // size, n * (rank + 1) // size
lowest, highest = max(first - 2, 0), min(end + 2, n)
own = scene_of(pellucid.Volume(whole[lowest:highest], origin=(lowest, 0, 0)))
box = ((0, 0, 0 if rank == 0 else first - 0.5),
       (n - 1, n - 1, n - 1 if rank == size - 1 else end - 0.5))
of_parts = pellucid.render_on_ranks(own, comm, box)

if rank == 0:
    alone = pellucid.render(everything)
    for image in (of_whole, of_parts):
        off = numpy.abs(image.rgba - alone.rgba).max(axis=-1)
        if not (off <= image.error + alone.error).all() or image.rgba[..., 3].max() < 0.5:
            sys.exit(f"differs by {off.max()}")
    print("the same")
else:
    assert of_whole is None and of_parts is None

# All ranks see what one of them does wrong.
try:
    pellucid.render_on_ranks(everything, comm, ((0, 0, 0), (1, 1, 1)))
except pellucid.Error as error:
    assert size == 1 or "plane" in str(error), error
else:
    assert size == 1
