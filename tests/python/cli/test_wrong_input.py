"""What is wrong is said in one line with the remedy, under the right exit code, and nothing is left."""

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
