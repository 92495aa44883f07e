"""One image of each method, whatever the number of threads and the width of vectors of a CPU device,
and however busy the machine is."""

import json
import multiprocessing
import os
import signal
import subprocess
import time

import pytest
from small_sweep import Sweep


def cpu_device(program):
    told = subprocess.run([program, "info", "--json"], capture_output=True, text=True, check=False)
    devices = json.loads(told.stdout)["devices"] if told.returncode == 0 else []
    return any(d["best"] and "llvmpipe" in d["name"] for d in devices)


def driver_environment(folder, threads, width):
    """What sets llvmpipe so. With a shader cache for each width: Mesa 25.0 keeps compiled shaders without the
    width in their key, so that the user's cache would give a run the code of another width."""
    return {"LP_NUM_THREADS": str(threads), "LP_NATIVE_VECTOR_WIDTH": str(width),
            "MESA_SHADER_CACHE_DIR": str(folder / f"shaders of {width} bits")}


def widths_of_the_driver(program, folder):
    """128 and 256 bits, and 512 where the driver can draw with them: the llvmpipe of Mesa 25.0 crashes in its
    own compiler (llvm::ConstantVector) with the first pipeline that blends."""
    blend = subprocess.run([program, "render", "--scene", "planes", "--method", "blend", "--size", "24x16",
                            "--out", folder / "blend.png"], capture_output=True, check=False,
                           env={**os.environ, **driver_environment(folder, 1, 512)})
    assert blend.returncode in (0, -signal.SIGSEGV), blend.stderr
    return (128, 256, 512) if blend.returncode == 0 else (128, 256)


def spin(until):
    while time.monotonic() < until:
        sum(range(10000))


@pytest.fixture
def load(long):
    """Other processes that want the processors, in the long test."""
    busy = [multiprocessing.Process(target=spin, args=(time.monotonic() + 3600,), daemon=True)
            for _ in range(4 if long else 0)]
    for process in busy:
        process.start()
    yield
    for process in busy:
        process.terminate()
        process.join()


def test_every_method_has_one_image(program, tmp_path, undisturbed, long, load):
    if not cpu_device(program):
        pytest.skip("the default device is not llvmpipe, whose threads and vectors can be set")
    widths = widths_of_the_driver(program, tmp_path)
    # 30 runs each: every pair several times; otherwise the corners.
    pairs = ([(t, w) for t in range(1, 5) for w in widths] * 4)[:30] if long else [
        (1, widths[0]), (4, widths[-1])]
    expected = {cell["id"].rsplit("-", 1)[0]: cell["image_hash"] for cell in undisturbed.values()}
    wrong = []
    for repeat, (threads, width) in enumerate(pairs):
        folder = tmp_path / str(repeat)
        folder.mkdir()
        sweep = Sweep(program, folder)
        done = sweep.run(**driver_environment(tmp_path, threads, width))
        assert done.returncode == 0, done.stderr
        cells = sweep.cells()
        assert len(cells) == len(undisturbed)
        for cell in cells.values():
            # The device's name has the width in it, and so the end of the id.
            if cell["image_hash"] != expected[cell["id"].rsplit("-", 1)[0]]:
                wrong.append((cell["id"], threads, width))
    assert not wrong
