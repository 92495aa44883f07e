"""What is wrong is said in one line with the remedy, under the right exit code, and nothing is left."""

import json
import os

import pytest

RENDER = ["render", "--size", "32x18"]
BAD_INPUT = [
    (["rendr"], ["rendr", "did you mean 'render'"]),
    ([], ["subcommand"]),
    (["render", "--scene", "boxes"], ["--method"]),
    (RENDER + ["--scene", "boxes", "--method", "refrence"], ["did you mean 'reference'"]),
    (RENDER + ["--scene", "boxs", "--method", "blend"], ["boxs", "did you mean 'boxes'"]),
    (RENDER + ["--scene", "nowhere.glb", "--method", "blend"], ["nowhere.glb"]),
    (RENDER + ["--scene", "boxes", "--method", "blend", "--set", "ordr=sorted"],
     ["did you mean 'order'"]),
    (RENDER + ["--scene", "boxes", "--method", "blend", "--set", "order=sortd"],
     ["submission | sorted", "did you mean 'sorted'"]),
    (RENDER + ["--scene", "boxes", "--method", "blend", "--set", "order"], ["name=value"]),
    (RENDER + ["--scene", "boxes", "--method", "reference", "--set", "initial_depth=5000"],
     ["out of range", "0 to 1024"]),
    (RENDER + ["--scene", "boxes", "--method", "blend", "--view", "defalt"],
     ["did you mean 'default'"]),
    (RENDER + ["--scene", "boxes", "--method", "blend", "--view", "orbit:1"], ["orbit:YAW"]),
    (RENDER + ["--scene", "boxes", "--method", "blend", "--opacity", "1.5"], ["opacity", "1.5"]),
    (RENDER + ["--scene", "boxes", "--method", "blend", "--format", "rgba16"], ["rgba16f"]),
    (RENDER + ["--scene", "boxes", "--method", "blend", "--out", "x.bmp"], [".bmp", ".png"]),
    (RENDER + ["--scene", "boxes", "--method", "blend", "--out", "no/such/folder/x.png"],
     ["no folder"]),
    (RENDER + ["--scene", "boxes", "--method", "blend", "--siz", "4x4"],
     ["did you mean '--size'"]),
    (["render", "--scene", "boxes", "--method", "blend", "--size", "0x18"], ["0x18", "1 to"]),
    (["render", "--scene", "boxes", "--method", "blend", "--size", "99999x18"], ["99999", "1 to"]),
    (["render", "--scene", "boxes", "--method", "blend", "--size", "big"], ["WxH"]),
    (["run", "nowhere.toml"], ["nowhere.toml"]),
    (["run", "nowhere.toml", "--shard", "5/4"], ["nowhere.toml"]),
    (["report", "nowhere"], ["nowhere"]),
    (["diff", "nowhere", "nowhere"], ["nowhere"]),
    (["paper", "nowhere"], ["nowhere"]),
    (["pack", "nowhere", "x.json.gz"], ["nowhere"]),
    (["run", "nowhere.toml", "--size", "8"], ["--size", "8: wanted WxH"]),
    (["compare", "a.png", "nowhere.png"], ["a.png"]),
    (["list", "metods"], ["did you mean 'methods'"]),
]


@pytest.mark.parametrize("arguments, expected", BAD_INPUT, ids=lambda v: " ".join(v)[-60:])
def test_bad_input_is_one_clear_line(oitlab, arguments, expected, tmp_path):
    done = oitlab(*arguments, cwd=tmp_path)
    assert done.returncode == 2, (done.returncode, done.stderr)
    assert done.stdout == ""
    assert len(done.stderr.strip().splitlines()) == 1, done.stderr
    for part in expected:
        assert part in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_broken_scene_file(oitlab, tmp_path):
    (tmp_path / "broken.glb").write_bytes(b"glTF\x02\x00\x00\x00\xff\x00\x00\x00")
    done = oitlab("render", "--scene", "broken.glb", "--method", "blend", cwd=tmp_path)
    assert done.returncode == 2 and "broken.glb" in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1


def test_no_vulkan_device(oitlab, tmp_path):
    none = {"VK_DRIVER_FILES": "/nonexistent.json", "VK_ICD_FILENAMES": "/nonexistent.json"}
    experiment = tmp_path / "x.toml"
    experiment.write_text('scenes = ["planes"]\nmethods = ["blend"]\n')
    for arguments in (["render", "--scene", "planes", "--method", "blend"], ["run", experiment],
                      ["info"]):
        done = oitlab(*arguments, env=none, cwd=tmp_path)
        assert done.returncode == 3, done.stderr
        assert "driver" in done.stderr or "device" in done.stderr
        assert len(done.stderr.strip().splitlines()) == 1, done.stderr
    assert sorted(p.name for p in tmp_path.iterdir()) == ["x.toml"]


def test_no_such_device_number(oitlab):
    done = oitlab("render", "--scene", "planes", "--method", "blend", "--device", "99")
    assert done.returncode == 3 and "99" in done.stderr and "oitlab info" in done.stderr


TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
TOO_LONG = 300 * "x"  # no file system has names of more than 255 bytes
NAMES_OF_FILES = [
    ["render", "--method", "blend", "--scene", "{}.glb"],
    ["render", "--method", "blend", "--scene", "{}/x.obj"],
    ["render", "--method", "blend", "--scene", "boxes", "--out", "{}/x.png"],
    ["scene", "{}.obj"],
    ["compare", "{}.png", "{}.png"],
    ["run", "{}.toml"],
    ["report", "{}"],
    ["diff", "{}", "{}"],
]


def one_line(done):
    assert done.returncode == 2, (done.returncode, done.stderr)
    assert done.stdout == ""
    assert len(done.stderr.strip().splitlines()) == 1, done.stderr


@pytest.mark.parametrize("arguments", NAMES_OF_FILES, ids=" ".join)
def test_a_name_that_no_file_system_has(oitlab, arguments, tmp_path):
    one_line(oitlab(*[word.format(TOO_LONG, TOO_LONG) for word in arguments], cwd=tmp_path))


@pytest.mark.parametrize("arguments", NAMES_OF_FILES, ids=" ".join)
def test_a_link_to_itself(oitlab, arguments, tmp_path):
    for name in ("loop", "loop.glb", "loop.obj", "loop.png", "loop.toml"):
        (tmp_path / name).symlink_to(name)
    one_line(oitlab(*[word.format("loop", "loop") for word in arguments], cwd=tmp_path))


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
@pytest.mark.parametrize("arguments", NAMES_OF_FILES, ids=" ".join)
def test_a_folder_that_may_not_be_read(oitlab, arguments, tmp_path):
    folder = tmp_path / "closed"
    folder.mkdir()
    folder.chmod(0)
    try:
        one_line(oitlab(*[word.format("closed/x", "closed/x") for word in arguments], cwd=tmp_path))
    finally:
        folder.chmod(0o700)


def test_a_name_that_is_not_utf8_is_replaced_in_json(oitlab, tmp_path):
    name = os.fsdecode(b"\xff.obj")
    (tmp_path / name).write_text(TRIANGLE)
    done = oitlab("scene", name, "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "\ufffd" in json.loads(done.stdout)["scene"]


def test_a_scene_may_not_read_what_is_outside_its_folder(oitlab, tmp_path):
    folder = tmp_path / "scene"
    folder.mkdir()
    (folder / "x.obj").write_text("mtllib ../secret.mtl\n" + TRIANGLE)
    (tmp_path / "secret.mtl").write_text("newmtl m\n")
    done = oitlab("scene", "scene/x.obj", cwd=tmp_path)
    one_line(done)
    assert "'../secret.mtl'" in done.stderr and "--allow-outside" in done.stderr
    assert oitlab("scene", "scene/x.obj", "--allow-outside", cwd=tmp_path).returncode == 0


@pytest.mark.parametrize("verb, arguments", [
    ("depth", ["scene/x.obj", "--size", "8x8"]),
    ("render", ["--scene", "scene/x.obj", "--method", "blend", "--size", "8x8"]),
    ("run", ["x.toml"]),
    ("run", ["allowed.toml"])])
def test_every_verb_that_loads_a_scene_can_allow_it_other_folders(oitlab, tmp_path, verb, arguments):
    folder = tmp_path / "scene"
    folder.mkdir()
    (folder / "x.obj").write_text("mtllib ../secret.mtl\n" + TRIANGLE)
    (tmp_path / "secret.mtl").write_text("newmtl m\n")
    rest = 'sizes = ["8x8"]\nmethods = [{ method = "reference" }]\n[measure]\ntime_limit = 0.1\n'
    (tmp_path / "x.toml").write_text('scenes = ["scene/x.obj"]\n' + rest)
    allowed = '{ source = "scene/x.obj", allow_outside = true }'
    (tmp_path / "allowed.toml").write_text(f"scenes = [{allowed}]\n" + rest)
    refused = oitlab(verb, *arguments, cwd=tmp_path)
    if arguments == ["allowed.toml"]:
        assert refused.returncode == 0, refused.stderr
        return
    assert refused.returncode == (1 if verb == "run" else 2), refused.stderr
    assert "--allow-outside" in refused.stderr
    allowed = oitlab(verb, *arguments, "--allow-outside", cwd=tmp_path)
    assert allowed.returncode == 0, allowed.stderr


def test_a_scene_that_is_a_device_ends(oitlab, tmp_path):
    (tmp_path / "x.obj").symlink_to("/dev/zero")
    done = oitlab("scene", "x.obj", cwd=tmp_path)
    one_line(done)
    assert "not a regular file" in done.stderr
