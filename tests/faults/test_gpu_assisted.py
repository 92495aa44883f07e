"""No shader reads or writes outside of a buffer: the methods under GPU-assisted validation, which checks each access
by address while the shader runs."""

import json
import os
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from program import ROOT

MANIFEST = "VkLayer_khronos_validation.json"

# Buffer addresses are what methods reach memory by. The other checks would double the time.
SETTINGS = """
khronos_validation.gpuav_enable = true
khronos_validation.gpuav_descriptor_checks = false
khronos_validation.gpuav_buffers_validation = false
khronos_validation.gpuav_post_process_descriptor_indexing = false
khronos_validation.validate_core = false
"""

# What takes time on llvmpipe is compiling the checks: a fifth of it without optimization and with narrow vectors.
CPU_DEVICE = {"GALLIVM_PERF": "nopt", "LP_NATIVE_VECTOR_WIDTH": "128"}

# Every method, from both sources. What has more shaders comes first, so that two processes end at about the same time.
# With max_fragments=8 the A-buffer has shaders for one interval, and for the deeper pixels.
METHODS = [
    "lucid", "abuffer max_fragments=8", "abuffer max_fragments=8 source=compute", "blend source=compute",
    "wboit source=compute", "reference source=compute", "depth_peeling mode=dual source=compute", "reference",
    "depth_peeling mode=dual", "depth_peeling", "blend", "wboit", "local_memory passes=1",
]
# With --long: the other settings that choose shaders, and scenes with textures, smooth normals and long lists.
MORE_METHODS = [
    *METHODS, "blend order=sorted", "blend order=sorted source=compute", "abuffer", "abuffer mask=lists",
    "abuffer mask=stencil_increment", "abuffer sort=register", "abuffer sort=bitonic",
    "abuffer max_fragments=8 deep=truncate", "abuffer sort_memory=max", "depth_peeling mode=dual back=blend",
    "depth_peeling atomics=int32", "lucid depth_filter=1", "lucid ordered_first=off", "lucid repair=off",
    "lucid alpha_threshold=0.9",
    *(f"blend source=compute deliver={order}" for order in ("near_to_far", "far_to_near", "shuffled")),
]
MORE_SCENES = [("boxes", 1), ("planes", 1), ("smoke", 1), ("sponza_like", 0.05), ("hairball", 0.002), ("whiteoak", 0.1)]


def manifest_of_the_layer():
    """Where the loader finds the validation layer, which says there what settings it has. None without it."""
    folders = [folder for name in ("VK_LAYER_PATH", "VK_ADD_LAYER_PATH")
               for folder in os.environ.get(name, "").split(":") if folder]
    folders += [f"{root}/vulkan/explicit_layer.d" for root in ("/etc", "/usr/local/share", "/usr/share")]
    return next((path for folder in folders if (path := Path(folder) / MANIFEST).is_file()), None)


@pytest.fixture(scope="module")
def render(program, tmp_path_factory):
    """Renders under GPU-assisted validation, and returns what the layer said."""
    manifest = manifest_of_the_layer()
    if manifest is None:
        pytest.skip("no validation layer here (package vulkan-validationlayers)")
    text = manifest.read_text(encoding="utf-8")
    if '"gpuav_enable"' not in text:
        pytest.skip(f"the validation layer {json.loads(text)['layer']['api_version']} is too old to be told to check "
                    "the shaders' accesses (it has no setting gpuav_enable); that of Debian 13 is not")
    folder = tmp_path_factory.mktemp("gpu_assisted")
    (folder / "vk_layer_settings.txt").write_text(SETTINGS)
    environment = {**os.environ, **CPU_DEVICE, "VK_LAYER_SETTINGS_PATH": str(folder),
                   "MESA_SHADER_CACHE_DIR": str(folder / "compiled")}

    def render(method, scene="planes", detail=1, size="32x18", **more):
        name, *settings = method.split()
        done = subprocess.run(
            [program, "render", "--validation", "--scene", scene, "--detail", str(detail), "--size", size,
             "--method", name, *(word for setting in settings for word in ("--set", setting)),
             "--out", folder / f"{method}.png"],
            capture_output=True, text=True, check=False, env={**environment, **more})
        assert done.returncode == 0, f"{method} on {scene}: {done.stderr}"
        # When it is loaded, the layer tells which of the device's features and limits it changes for its own use.
        said = [message for message in done.stderr.split("validation: ")[1:] if "Internal Warning" not in message]
        return [f"{method} on {scene}: {message}" for message in said]

    return render


def test_an_access_outside_of_a_buffer_is_noticed(render, tmp_path):
    """Otherwise the tests below would show nothing."""
    for folder in ("shaders", "experiments"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    shader = tmp_path / "shaders" / "reference" / "resolve.comp"
    text = shader.read_text()
    begin = "void main() {\n"
    assert begin in text
    shader.write_text(text.replace(begin, begin + "  push.heads.at[push.frame.c.size.x * push.frame.c.size.y] = 0u;\n"))
    said = render("reference", OITLAB_ROOT=str(tmp_path))
    assert any("Out of bounds" in message and "reference/resolve.comp" in message for message in said), said


def test_no_method_reaches_outside_of_its_buffers(render, long):
    scenes = MORE_SCENES if long else [("planes", 1)]
    size = "160x100" if long else "32x18"
    jobs = [(method, scene, detail, size) for scene, detail in scenes for method in (MORE_METHODS if long else METHODS)]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        said = [message for messages in pool.map(lambda job: render(*job), jobs) for message in messages]
    assert not said, "\n".join(said)
