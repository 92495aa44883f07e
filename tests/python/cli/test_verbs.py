"""Every verb does what its help says, and its JSON has what scripts rely on."""

import json

import pytest


def parse(done):
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_help_of_the_program_and_of_every_verb(oitlab):
    done = oitlab("--help")
    assert done.returncode == 0
    for verb in ("info", "list", "render", "run", "compare", "report", "diff", "paper", "pack"):
        assert verb in done.stdout
        help_text = oitlab(verb, "--help")
        assert help_text.returncode == 0 and "usage" in help_text.stdout.lower()


def test_info_tells_devices_and_what_methods_lack(oitlab):
    devices = parse(oitlab("info", "--json"))["devices"]
    assert devices and sum(d["best"] for d in devices) == 1
    for device in devices:
        assert {"name", "type", "driver", "subgroup_size", "max_image_size"} <= device.keys()
        assert {"blend", "reference"} <= device["methods"].keys()
        assert all(isinstance(m["missing"], list) for m in device["methods"].values())
    assert devices[0]["name"] in oitlab("info").stdout


def test_list_methods_tells_the_whole_declaration_of_a_parameter(oitlab):
    methods = {m["name"]: m for m in parse(oitlab("list", "methods", "--json"))["methods"]}
    assert methods["reference"]["exact"] and not methods["blend"]["exact"]
    order = methods["blend"]["parameters"][0]
    assert order["name"] == "order" and order["type"] == "enum"
    assert order["default"] == "submission" and order["choices"] == ["submission", "sorted"]
    depth = methods["reference"]["parameters"][0]
    assert depth["unit"] == "fragments" and depth["min"] == 0 and depth["max"] == 1024
    assert all(p["help"] for m in methods.values() for p in m["parameters"])


def test_list_scenes(oitlab):
    scenes = {s["name"]: s for s in parse(oitlab("list", "scenes", "--json"))["scenes"]}
    assert scenes["boxes"]["triangles"] == 12000
    assert scenes["planes"]["triangles"] == 64
    assert scenes["teapot"]["triangles"] == pytest.approx(16384, rel=0.02)
    assert "default" in scenes["boxes"]["views"]


def test_render_json(render_json):
    result = render_json("--scene", "boxes", "--method", "reference")
    assert result["size"] == [96, 54] and result["method"] == "reference"
    assert result["parameters"] == {"initial_depth": 4.0, "source": "hardware", "deliver": "auto", "deliver_seed": 0}
    assert result["device"]["name"]
    assert result["gpu_ms"]["frame"] > 0
    assert {"opaque", "clear", "capture", "resolve"} == result["gpu_ms"]["stages"].keys()
    assert result["counters"]["fragments"] > 10000
    memory = result["memory_bytes"]
    assert memory["total"] == sum(memory["buffers"].values()) > memory["method"] > 0
    assert len(result["image_hash"]) == 32
    shaders = result["provenance"]["shaders"]
    assert any(name.startswith("reference/resolve.comp") for name in shaders)


def test_exact_image_does_not_depend_on_submission_order(render_json):
    plain = render_json("--scene", "teapot", "--method", "reference")["image_hash"]
    for seed in (1, 2):
        shuffled = render_json("--scene", "teapot", "--method", "reference", "--shuffle", seed)
        assert shuffled["image_hash"] == plain


def test_render_writes_images_that_compare_reads(oitlab, tmp_path):
    for name in ("a.exr", "a.png"):
        done = oitlab("render", "--scene", "planes", "--method", "reference", "--size", "64x36",
                      "--out", tmp_path / name)
        assert done.returncode == 0 and (tmp_path / name).exists() and done.stdout == ""
    oitlab("render", "--scene", "planes", "--method", "blend", "--size", "64x36", "--out",
           tmp_path / "b.exr")
    same = parse(oitlab("compare", tmp_path / "a.exr", tmp_path / "a.exr", "--json"))
    assert same["rmse"] == 0 and same["psnr"] is None and same["pixels_off"] == 0
    other = parse(oitlab("compare", tmp_path / "b.exr", tmp_path / "a.exr", "--json", "--map",
                         tmp_path / "map.png"))
    assert other["rmse"] > 0.01 and other["max_error"] > 0.05 and 0 < other["pixels_off"] <= 1
    assert (tmp_path / "map.png").stat().st_size > 0
    # An 8-bit file differs from the linear one by its rounding alone.
    rounded = parse(oitlab("compare", tmp_path / "a.png", tmp_path / "a.exr", "--json"))
    assert 0 < rounded["max_error"] < 1 / 100


def test_opacity_override_and_views(render_json):
    opaque = render_json("--scene", "boxes", "--method", "blend", "--opacity", "1")
    clear = render_json("--scene", "boxes", "--method", "blend", "--opacity", "0.1")
    assert opaque["image_hash"] != clear["image_hash"]
    orbit = render_json("--scene", "boxes", "--method", "blend", "--view", "orbit:0.5,0.8,10,60")
    # That is how the default view was made, but for the centre of the jittered boxes' bounds.
    default = render_json("--scene", "boxes", "--method", "blend")
    assert orbit["camera"]["eye"] == pytest.approx(default["camera"]["eye"], abs=0.1)
    look = render_json("--scene", "boxes", "--method", "blend", "--view", "look:9,0,0,0,0,0,40")
    assert look["camera"]["eye"] == [9, 0, 0]
    assert look["camera"]["fov_y_degrees"] == pytest.approx(40)
