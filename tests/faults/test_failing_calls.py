"""A sweep in which one call to Vulkan fails, or the device is lost: the run ends with exit code 0 or
1, every cell has a row, and what is `ok` is right. The layer is layer/fail_calls.cpp."""

import json
import os

import pytest
from small_sweep import COMPUTE_SWEEP, LAYERS, SWEEP, Sweep, assert_right

pytestmark = pytest.mark.skipif(not (LAYERS / "fail_calls.json").is_file(),
                                reason="the layer fail_calls is not built beside the program")

# Without one of these there is no device, and nothing to write a row about: exit code 3.
OPENS_THE_DEVICE = {"vkCreateInstance", "vkCreateDevice", "vkCreateCommandPool",
                    "vkCreateDescriptorSetLayout", "vkCreatePipelineLayout"}
OUT_OF_MEMORY = "out_of_device_memory"
LOST = "device_lost"
WAITS = {"vkQueueSubmit", "vkWaitForFences", "vkGetQueryPoolResults", "vkDeviceWaitIdle"}


def layer(folder, fault=""):
    return {"VK_ADD_LAYER_PATH": str(LAYERS), "VK_INSTANCE_LAYERS": "VK_LAYER_OITLAB_fail_calls",
            "OITLAB_FAULT": fault, "OITLAB_FAULT_CALLS": str(folder / "calls")}


def calls_of(folder):
    """How often each function was called, and whether the fault happened."""
    lines = [line.split() for line in (folder / "calls").read_text().splitlines()]
    counts = {name: int(count) for name, count in lines if name != "fault:"}
    return counts, ["fault:", "yes"] in lines


def count_calls(sweep):
    """Calls of each function in a whole run."""
    done = sweep.run(**layer(sweep.folder))
    assert done.returncode == 0, done.stderr
    counts, happened = calls_of(sweep.folder)
    assert not happened and counts["vkQueueSubmit"] > 100
    return counts


@pytest.fixture(scope="session")
def counts(program, tmp_path_factory):
    return count_calls(Sweep(program, tmp_path_factory.mktemp("counts")))


@pytest.fixture(scope="session")
def compute(program, tmp_path_factory):
    """The cells of a run with compute fragments in which nothing fails, and its calls."""
    whole = Sweep(program, tmp_path_factory.mktemp("compute"), COMPUTE_SWEEP)
    counts = count_calls(whole)
    cells = whole.cells()
    assert len(cells) == 16 and all(cell["status"] == "ok" for cell in cells.values())
    return cells, counts


def check(sweep, expected, function, fault):
    """One run with one fault; whether it happened."""
    done = sweep.run(**layer(sweep.folder, fault))
    said = f"{fault}: exit code {done.returncode}\n{done.stderr[-2000:]}"
    assert done.returncode in (0, 1, 3), said
    assert "terminate called" not in done.stderr and "Assertion" not in done.stderr, said
    cells = sweep.cells()
    if done.returncode == 3:
        assert function in OPENS_THE_DEVICE, said
        assert not cells and len(done.stderr.splitlines()) <= 2, said
    else:
        assert cells.keys() == expected.keys(), said
    for cell in cells.values():
        if cell["status"] == "ok":
            assert_right(cell, expected[cell["id"]])
        else:
            assert cell["status"] == "failed" and cell["reason"], said
    failed = sum(cell["status"] == "failed" for cell in cells.values())
    assert (done.returncode == 1) == (failed > 0), said
    return calls_of(sweep.folder)[1], failed


def mend(sweep, expected):
    """The same command without the fault makes the sweep whole."""
    done = sweep.run()
    assert done.returncode == 0, done.stderr
    cells = sweep.cells()
    assert cells.keys() == expected.keys()
    for cell in cells.values():
        assert cell["status"] == "ok"
        assert_right(cell, expected[cell["id"]])


@pytest.mark.parametrize(
    ("function", "where", "result"),
    [
        ("vkAllocateMemory", 0.5, OUT_OF_MEMORY),
        ("vkCreateComputePipelines", 0.7, OUT_OF_MEMORY),
        ("vkMapMemory", 0.6, OUT_OF_MEMORY),
        ("vkBeginCommandBuffer", 0.2, "out_of_host_memory"),
        ("vkGetQueryPoolResults", 0.5, OUT_OF_MEMORY),
        ("vkQueueSubmit", 0.1, LOST),
        ("vkWaitForFences", 0.8, LOST),
        ("vkCreateDevice", 0.0, "initialization_failed"),
    ],
)
def test_one_call_fails(sweep, undisturbed, counts, function, where, result):
    call = 1 + int(where * (counts[function] - 1))
    happened, _ = check(sweep, undisturbed, function, f"{function}:{call}:{result}")
    assert happened
    if function in ("vkAllocateMemory", "vkQueueSubmit"):  # one of each kind
        mend(sweep, undisturbed)


@pytest.mark.parametrize(("function", "where", "result"), [
    ("vkCreateComputePipelines", 0.9, OUT_OF_MEMORY), ("vkQueueSubmit", 0.6, LOST)])
def test_one_call_fails_with_compute_fragments(program, tmp_path, compute, function, where, result):
    expected, counts = compute
    sweep = Sweep(program, tmp_path, COMPUTE_SWEEP)
    happened, _ = check(sweep, expected, function, f"{function}:{1 + int(where * (counts[function] - 1))}:{result}")
    assert happened
    mend(sweep, expected)


def test_memory_that_stays_short_fails_what_needs_it(sweep, undisturbed, counts):
    call = counts["vkAllocateMemory"] // 2
    _, failed = check(sweep, undisturbed, "vkAllocateMemory",
                      f"vkAllocateMemory:{call}+:{OUT_OF_MEMORY}")
    assert 0 < failed < len(undisturbed)


def test_a_device_lost_again_and_again_ends_with_rows(sweep, undisturbed):
    """Whatever is opened is lost at its first work: every cell says so, and the run ends."""
    _, failed = check(sweep, undisturbed, "vkQueueSubmit", f"vkQueueSubmit:1+:{LOST}")
    assert failed == len(undisturbed)


def test_after_a_frame_that_does_not_end_nothing_is_destroyed_that_it_uses(sweep, undisturbed, counts):
    """The validation layer is behind ours: it sees no wait, and would report what is destroyed."""
    call = counts["vkWaitForFences"] // 4
    done = sweep.run("--validation", **layer(sweep.folder, f"vkWaitForFences:{call}:timeout"))
    if "VK_LAYER_KHRONOS_validation is not installed" in done.stderr:
        pytest.skip("no validation layer here")
    assert done.returncode == 1 and "validation:" not in done.stderr, done.stderr
    cells = sweep.cells()
    assert cells.keys() == undisturbed.keys()
    failed = [cell for cell in cells.values() if cell["status"] != "ok"]
    assert len(failed) == len(cells) // 2 and len({cell["scene"]["name"] for cell in failed}) == 1
    for cell in cells.values():
        if cell["status"] == "ok":
            assert_right(cell, undisturbed[cell["id"]])
        else:
            assert "did not finish a frame within 600 s" in cell["reason"]
    mend(sweep, undisturbed)


def numbers(count):
    """All of few calls; of many, the first and the last and more than a hundred between them."""
    return range(1, count + 1) if count <= 150 else sorted(
        {*range(1, 21), *range(count - 9, count + 1), *range(1, count, max(1, count // 120))})


@pytest.mark.parametrize("source", ["hardware", "compute"])
def test_every_call_of_every_function_fails_once(program, tmp_path, request, source, long):
    if not long:
        pytest.skip("more than a thousand runs of a second each: pytest --long")
    if source == "compute":
        text, (undisturbed, counts) = COMPUTE_SWEEP, request.getfixturevalue("compute")
    else:
        text, undisturbed, counts = SWEEP, *map(request.getfixturevalue, ("undisturbed", "counts"))
    happened, wrong = 0, []
    for function, count in sorted(counts.items()):
        for result in (OUT_OF_MEMORY, *([LOST] if function in WAITS else [])):
            for call in numbers(count):
                folder = tmp_path / f"{function}-{call}-{result}"
                folder.mkdir()
                try:
                    happened += check(Sweep(program, folder, text), undisturbed, function,
                                      f"{function}:{call}:{result}")[0]
                except (AssertionError, json.JSONDecodeError) as error:
                    wrong.append(str(error))
                    print(error, flush=True)
    assert not wrong, f"{len(wrong)} of {happened} faults"
    assert happened > 1000


def test_a_fault_that_nobody_can_mean_is_refused(sweep):
    for fault in ("vkAllocateMemory", "vkAllocateMemory:x:device_lost", "vkAllocateMemory:0:device_lost",
                  "vkAllocateMemory:1:sunshine"):
        done = sweep.run(**layer(sweep.folder, fault))
        assert done.returncode < 0 and "OITLAB_FAULT" in done.stderr and os.path.exists(sweep.experiment)
