"""What a user is told of a fragment program that does not compile."""

import re

import pytest
from toys import TOY, Toys

FILES = {"sum_of_layers": "sum_of_layers/sum.glsl", "nearest_layers": "nearest_layers/nearest.glsl"}


@pytest.fixture(scope="module")
def toys(tmp_path_factory):
    return Toys(tmp_path_factory.mktemp("root"))


@pytest.fixture
def render_edited(toys):
    """Renders with the first file of a method edited by re.sub(pattern, replacement)."""

    def render(method, source, pattern, replacement, file=None, scene="planes"):
        file = file or FILES[method]
        path = toys.root / "shaders" / file
        kept = path.read_text()
        text, count = re.subn(pattern, replacement, kept)
        assert count > 0
        path.write_text(text)
        try:
            return toys.try_run("render", "--scene", scene, "--size", "48x27", "--method", method,
                                "--set", f"source={source}")
        finally:
            path.write_text(kept)

    return render


@pytest.mark.parametrize("method, source", [("sum_of_layers", "hardware"), ("sum_of_layers", "compute"),
                                            ("nearest_layers", "compute")])
def test_an_error_has_the_file_and_line_of_the_program(render_edited, method, source):
    lines = (TOY / "shaders" / FILES[method]).read_text().splitlines()
    number = 1 + next(i for i, line in enumerate(lines) if "shadeFragment(" in line)
    done = render_edited(method, source, r"shadeFragment\(", "shadeFragmen(")
    assert done.returncode == 2
    first = next(line for line in done.stderr.splitlines() if line.startswith("ERROR: "))
    assert first.startswith(f"ERROR: {FILES[method]}:{number}: 'shadeFragmen' ")


@pytest.mark.parametrize("method, source, pattern, replacement, missing", [
    ("sum_of_layers", "hardware", "contribute", "gives", "bool contribute(Fragment f, out vec4 c[1])"),
    ("sum_of_layers", "compute", "contribute", "gives", "bool contribute(Fragment f, out vec4 c[1])"),
    ("sum_of_layers", "hardware", "composite", "ends", "bool composite(vec4 sums[1], out vec4 color)"),
    ("sum_of_layers", "compute", "composite", "ends", "bool composite(vec4 sums[1], out vec4 color)"),
    ("nearest_layers", "compute", "PixelState", "Layers", "struct PixelState"),
    ("nearest_layers", "compute", "openPixel", "opens", "void openPixel(uvec2 pixel, out PixelState state)"),
    # Of the same name, with other parameters.
    ("nearest_layers", "compute", r"openPixel\(uvec2 pixel, ", "openPixel(",
     "void openPixel(uvec2 pixel, out PixelState state)"),
    ("nearest_layers", "compute", "addFragment", "adds",
     "bool addFragment(inout PixelState state, Fragment f)"),
    ("nearest_layers", "compute", "closePixel", "closes",
     "bool closePixel(PixelState state, out vec4 color)")])
def test_a_missing_function_is_named(render_edited, method, source, pattern, replacement, missing):
    done = render_edited(method, source, pattern, replacement)
    assert done.returncode == 2
    assert done.stderr == (f"oitlab: shaders/{FILES[method]}: has no {missing}; its access needs it, as "
                           "shaders/source/fragment.glsl says\n")


@pytest.mark.parametrize("source", ["hardware", "compute"])
def test_a_missing_function_of_a_program_with_its_own_buffers_is_named(render_edited, source):
    done = render_edited("my_none", source, r"void fragment\(", "void take_it(", file="my_none/my_none.glsl")
    assert done.returncode == 2
    assert done.stderr == ("oitlab: shaders/my_none/my_none.glsl: has no void fragment(Fragment f); its access "
                           "needs it, as shaders/source/fragment.glsl says\n")


@pytest.mark.parametrize("method, source", [("sum_of_layers", "hardware"), ("sum_of_layers", "compute"),
                                            ("nearest_layers", "compute")])
def test_a_program_that_does_not_end_is_named(render_edited, method, source):
    """The compiler reads on, and finds the error in a file of the source."""
    done = render_edited(method, source, r"\}\n\Z", "")
    assert done.returncode == 2
    first = next(line for line in done.stderr.splitlines() if line.startswith("ERROR: "))
    assert first.startswith("ERROR: source/")
    assert done.stderr.startswith(f"oitlab: shaders/{FILES[method]}: the errors are behind its end; a bracket "
                                  "or a semicolon may be missing there, or a name may be one of the source's. ")
