# SPDX-License-Identifier: Apache-2.0
"""Frames: lifetimes, the interpreter's lock, cancelling, and memory."""
import gc
import os
import resource
import signal
import subprocess
import sys
import threading
import time
import weakref

import numpy
import pytest

import pellucid
from conftest import smooth

SANITIZED = "PELLUCID_SANITIZED" in os.environ


class Tracked(numpy.ndarray):
    """An array that can be watched: weak references to plain arrays tell nothing of views."""


def tracked():
    return smooth().view(Tracked)


def slow_scene(size=2000):
    """Takes a minute or more."""
    field = pellucid.builtin_field("marschner_lobb", 96)
    peak = [(0.49, 0, "#ffffff"), (0.5, 300, "#ffffff"), (0.51, 0, "#ffffff")]
    return pellucid.scene_of(field, peak, size=size, tolerance=1e-6)


def test_an_array_lives_as_long_as_it_is_used():
    values = tracked()
    gone = weakref.ref(values)
    volume = pellucid.Volume(values)
    view = volume.array
    scene = pellucid.Scene([volume], size=(16, 16))
    renderer = pellucid.Renderer()
    expected = renderer.render(scene).rgba.copy()
    del values
    gc.collect()
    assert gone() is not None
    assert numpy.array_equal(renderer.render(scene).rgba, expected)
    del volume, scene
    gc.collect()
    assert gone() is not None and view[3, 4, 5] > 0
    del view
    renderer.clear()
    gc.collect()
    assert gone() is None


def test_an_image_lives_as_long_as_its_arrays():
    rgba = pellucid.render(smooth(), size=16).rgba
    gc.collect()
    assert rgba[8, 8, 3] > 0
    with pytest.raises(ValueError):
        rgba[0, 0, 0] = 1


def test_a_frame_keeps_its_array_and_lets_go_of_it():
    values = tracked()
    gone = weakref.ref(values)
    frame = pellucid.Renderer().start(pellucid.Scene([values], size=(64, 64)), preview=3)
    del values
    image = frame.wait()
    assert image.rgba[..., 3].max() > 0 and frame.level == 0 and frame.finished
    assert frame.wait() is not None  # again
    del frame
    gc.collect()
    assert gone() is None


def test_threads_come_and_go():
    results = []

    def work():
        results.append(pellucid.render(tracked(), size=32).rgba.copy())

    threads = [threading.Thread(target=work) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    gc.collect()
    assert len(results) == 8
    for result in results:
        assert numpy.array_equal(result, results[0])


def run(code, **options):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=300,
                          **options)


@pytest.mark.parametrize("last", [
    "",                              # a volume that is global until the end
    "renderer.render(scene)",        # a renderer that keeps what it had
    "frame = renderer.start(scene)",  # a frame that is being rendered
    "import sys; sys.exit(0)",
    "import sys; del sys.modules['pellucid'], sys.modules['pellucid._pellucid']",
])
def test_the_interpreter_ends(last):
    result = run("import numpy, pellucid\n"
                 "a = numpy.random.default_rng(1).random((40, 40, 40), dtype='f4')\n"
                 "scene = pellucid.Scene([a], size=(400, 400))\n"
                 "renderer = pellucid.Renderer()\n" + last)
    assert result.returncode == 0 and result.stderr == "", result.stderr


def test_a_thread_of_python_counts_while_a_frame_renders():
    count = 0
    stop = threading.Event()

    def counting():
        nonlocal count
        while not stop.is_set():
            count += 1
            time.sleep(0.001)

    thread = threading.Thread(target=counting)
    frame = pellucid.Renderer().start(slow_scene())
    threading.Timer(0.5, frame.cancel).start()
    thread.start()
    before = count
    with pytest.raises(pellucid.Cancelled):
        frame.wait()
    counted = count - before
    stop.set()
    thread.join()
    assert counted > 50, counted


def test_progress_rises_to_one():
    seen = []
    pellucid.render(pellucid.builtin_field("shells", 64), size=200, tolerance=1e-6,
                    progress=seen.append)
    assert seen == sorted(seen) and seen[-1] == 1 and len(seen) > 1


def test_tqdm():
    tqdm = pytest.importorskip("tqdm")
    with tqdm.tqdm(total=1, file=open(os.devnull, "w", encoding="utf-8")) as bar:
        pellucid.render(smooth(), size=32, progress=lambda done: bar.update(done - bar.n))
        assert bar.n == 1


def test_what_progress_raises_cancels_and_is_raised():
    class Mine(Exception):
        pass

    def progress(done):
        raise Mine(f"at {done}")

    begin = time.perf_counter()
    with pytest.raises(Mine):
        pellucid.render(slow_scene(), progress=progress)
    assert time.perf_counter() - begin < 5


def test_cancel_from_another_thread():
    frame = pellucid.Renderer().start(slow_scene())
    threading.Timer(0.2, frame.cancel).start()
    with pytest.raises(pellucid.Cancelled):
        frame.wait()
    with pytest.raises(pellucid.Error):
        frame.wait()
    assert frame.look().width == 2000


def test_letting_go_of_a_frame_cancels_it():
    frame = pellucid.Renderer().start(slow_scene())
    begin = time.perf_counter()
    del frame
    gc.collect()
    assert time.perf_counter() - begin < 5


def test_ctrl_c_cancels():
    """Measured in a process of its own: from the signal to the exception."""
    result = run("""
import os, signal, sys, threading, time
sys.path.insert(0, os.path.join(os.environ["PELLUCID_SOURCE_DIR"], "tests", "python"))
from test_frames import slow_scene
import pellucid
scene = slow_scene()
sent = 0.0
def send():
    global sent
    sent = time.perf_counter()
    os.kill(os.getpid(), signal.SIGINT)
threading.Timer(1.5, send).start()
try:
    pellucid.render(scene)
except KeyboardInterrupt:
    print(time.perf_counter() - sent)
""")
    assert result.returncode == 0, result.stderr
    # 20 ms at most to notice, some 5 ms to stop; a machine that does other work takes longer.
    assert float(result.stdout) < 0.5


@pytest.mark.skipif(SANITIZED, reason="the sanitizer keeps what is freed")
def test_frames_do_not_grow_memory():
    renderer = pellucid.Renderer()

    def frames(count):
        for i in range(count):
            values = smooth(shape=(20, 20, 20)) + numpy.float32(i % 7)
            scene = pellucid.scene_of(values, size=8)
            renderer.render(scene).to_srgb8()
        gc.collect()
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * resource.getpagesize()

    before = frames(200)
    grown = []
    # oneTBB keeps arenas that busy cores have not left: up to 50 MB in all under a load of 16, and
    # no more. A volume that is kept for each frame takes 10 MB every time.
    for _ in range(8):
        after = frames(300)
        grown.append(after - before)
        if grown[-1] < 4 << 20:
            return
        before = after
    pytest.fail(f"each time {[size / 1e6 for size in grown]} MB")


def test_signals_are_handled_while_waiting():
    seen = []
    before = signal.signal(signal.SIGALRM, lambda *_: seen.append(time.perf_counter()))
    try:
        frame = pellucid.Renderer().start(slow_scene())
        begin = time.perf_counter()
        signal.setitimer(signal.ITIMER_REAL, 0.1)
        threading.Timer(1.5, frame.cancel).start()
        with pytest.raises(pellucid.Cancelled):
            frame.wait()
    finally:
        signal.signal(signal.SIGALRM, before)
    assert len(seen) == 1 and seen[0] - begin < 1


def test_a_daemon_thread_that_renders_does_not_hinder_the_exit():
    code = ("import sys, threading, time, numpy, pellucid\n"
            "scene = pellucid.scene_of(numpy.random.rand(24, 24, 24), size=400, tolerance=1e-6)\n"
            "threading.Thread(target=pellucid.render, args=(scene,), daemon=True).start()\n"
            "time.sleep(0.3)\n"
            "sys.exit(3)\n")
    result = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, timeout=60)
    assert result.returncode == 3, result.stderr
