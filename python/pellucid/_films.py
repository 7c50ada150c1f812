# SPDX-License-Identifier: Apache-2.0
"""Films: scenes that change, one picture after the other."""
from __future__ import annotations

import copy
import json
import operator
import os
from typing import Any, Callable, Iterable, Iterator, Optional, SupportsIndex, Union, overload

from . import _pellucid
from ._pellucid import Error, Image, Renderer
from .scene import Scene

_FPS = 24.0


def _animation_text(scene: Scene, animation: Optional[dict]) -> str:
    """The animation as JSON; empty: the scene has none."""
    chosen = scene.animation if animation is None else animation
    if chosen is None:
        return ""
    try:
        return json.dumps(chosen)
    except (TypeError, ValueError) as error:
        raise Error(f"animation: expected what JSON can hold: {error}") from None


class _Frames:
    """The scenes of an animated scene, each made when it is asked for."""

    def __init__(self, scene: Scene, animation: Optional[dict]) -> None:
        if not isinstance(scene, Scene):
            raise Error(f"frames: expected a Scene, got {type(scene).__name__}; scene_of() makes "
                        "one of data")
        self._scenes = _pellucid._FilmScenes(scene, _animation_text(scene, animation))
        self._numbers = range(len(self._scenes))

    def __len__(self) -> int:
        return len(self._numbers)

    @overload
    def __getitem__(self, index: SupportsIndex) -> Scene: ...

    @overload
    def __getitem__(self, index: slice) -> _Frames: ...

    def __getitem__(self, index: Union[SupportsIndex, slice]) -> Union[Scene, _Frames]:
        if isinstance(index, slice):
            part = copy.copy(self)
            part._numbers = self._numbers[index]
            return part
        try:
            number = self._numbers[index]
        except IndexError:
            raise IndexError(f"frame {operator.index(index)} of {len(self)}") from None
        return self._scenes.frame(number)[0]

    def __iter__(self) -> Iterator[Scene]:
        return (scene for scene, _ in self.stamped())

    def check(self) -> None:
        """Makes each scene's description once. Raises Error where one cannot be made."""
        self._scenes.check()

    def stamped(self) -> Iterator[tuple[Scene, str]]:
        """Each scene with what it is made from, empty for arrays."""
        return (self._scenes.frame(number) for number in self._numbers)


def frames(scene: Scene, animation: Optional[dict] = None) -> _Frames:
    """Returns the scenes of an animated scene as a sequence: to be rendered, or changed before.
    A slice of it is a part of the film.

    scene      a Scene; load_scene() reads one
    animation  what changes, as the key "animation" of a scene file says (docs/reference/scene.md);
               None: scene.animation, or else a turntable of 5 s at 24 frames per second

        for each in pellucid.frames(scene, {"seconds": 2, "turntable": {"turns": 1}}):
            picture.set_data(pellucid.render(each).to_srgb8())

    Data of files with steps move in time if the animation has a "time", whatever step they were
    read at. What does not change from frame to frame is kept. All frames have the functions of the
    scene: one that was made from a step is that of this step, where `pellucid animate` makes one
    from all steps. Give clim=(low, high) of all of them.

    Raises Error if the animation is not valid, or names something that the scene has not. A frame
    whose values between two keys make no scene raises it when it is asked for.
    """
    return _Frames(scene, animation)


def _stamped(given: Any, animation: Optional[dict]) -> tuple[Iterator, Optional[int], float]:
    """Pairs of scenes or pictures and what they are made from, their number, and their speed."""
    if not isinstance(given, Scene):
        if animation is not None:
            raise Error("animate: an animation is of one Scene, but several are given")
        count = len(given) if hasattr(given, "__len__") else None
        return ((each, "") for each in given), count, _FPS
    made = frames(given, animation)
    made.check()
    chosen = given.animation if animation is None else animation
    return made.stamped(), len(made), float((chosen or {}).get("fps", _FPS))


def animate(scene: Union[Scene, Iterable[Any]], path: Union[str, os.PathLike],
            animation: Optional[dict] = None, *, fps: Optional[float] = None,
            keep_frames: bool = False, threads: int = 0,
            progress: Optional[Callable[[int, Optional[int]], Any]] = None) -> None:
    """Renders a film and writes it.

    scene        an animated Scene (frames()), or scenes or Images one after the other, as of a
                 generator: data of one's own that change
    path         a video, .webm or .mp4, for which the program ffmpeg must be there, or pictures: a
                 name with a place for their number, from 0, as "frames/%04d.png" or ".exr"
    animation    of one scene, as for frames()
    fps          frames per second of a video; None: the animation's, or 24
    keep_frames  keeps the pictures of a video, in the folder path + ".frames"
    threads      0: one per core
    progress     called with the number of frames that are done, and of all or None; what it raises
                 ends the film

        animate((Scene([Layer(step, function)], camera) for step in steps), "waves.webm", fps=12)

    Pictures that are there and made from the same scene and files are kept, so that a film that was
    interrupted goes on; those of arrays are made anew. Each picture is within the tolerance of its
    scene; a video is encoded with a loss.

    Raises Error if the path is no film, ffmpeg is not there or takes no such size, another call
    makes the same video now, or a scene is not valid.
    """
    if fps is not None and not (isinstance(fps, (int, float)) and 0 < fps <= 1000):
        raise Error(f"fps: expected a number above 0, up to 1000, got {fps!r:.60}")
    files = _pellucid._FilmFiles(os.fspath(path))
    made, count, own_fps = _stamped(scene, animation)
    files.hold()
    try:
        _write(files, made, count, own_fps if fps is None else fps, keep_frames, threads, progress)
    finally:
        # Tracebacks keep the files.
        files.release()


def _write(files: Any, made: Iterator, count: Optional[int], fps: float, keep_frames: bool,
           threads: int, progress: Optional[Callable[[int, Optional[int]], Any]]) -> None:
    """Renders the frames of a film, and makes its file."""
    renderer = Renderer(threads)
    index, size = 0, None
    for each, made_from in made:
        own = (each.width, each.height) if isinstance(each, Image) else tuple(each.size)
        if files.is_video and own != (size or own):
            raise Error(f"animate: frame {index + 1} has {own[0]} x {own[1]} pixels, but those "
                        f"before it have {size[0]} x {size[1]}; give all of them one size")
        if size is None:
            files.check_size(*own)
        size = own
        if not made_from or not files.has(index, made_from):
            image = each if isinstance(each, Image) else renderer.render(each)
            files.write(index, image, made_from)
        index += 1
        if progress is not None:
            progress(index, count)
    if index == 0:
        raise Error("animate: there is no frame")
    files.finish(index, fps, keep_frames)
