# SPDX-License-Identifier: Apache-2.0
import ast
import importlib.util
import inspect
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import mercurysim

FOLDER = Path(mercurysim.__file__).parent
MODULE = Path(mercurysim._mercury.__file__)


def test_the_version_is_that_of_the_program(mercury):
    assert mercury("--version").split()[1] == mercurysim.__version__


def test_the_version_of_the_distribution_is_that_of_the_module():
    project = (Path(__file__).resolve().parents[1] / "pyproject.toml").read_text()
    assert re.search(r'^version = "([^"]+)"', project, re.MULTILINE).group(1) == mercurysim.__version__


def test_everything_public_has_a_docstring():
    for name in mercurysim.__all__:
        thing = getattr(mercurysim, name)
        if name.startswith("__"):
            continue
        assert thing.__doc__, name
        if isinstance(thing, type) and thing.__module__.startswith("mercurysim"):
            for member, value in vars(thing).items():
                assert member.startswith("_") or value.__doc__, f"{name}.{member}"


def test_the_module_shows_nothing_but_its_entry():
    """Other libraries of the process, such as PyTorch, bring their own CUDA runtime, TBB and C++ templates."""
    nm = shutil.which("nm")
    if not nm:
        pytest.skip("there is no nm")
    lines = subprocess.run([nm, "-D", "--defined-only", MODULE], capture_output=True, text=True, check=True).stdout
    assert [line.split()[-1] for line in lines.splitlines()] == ["PyInit__mercury"]


def test_the_module_needs_no_library_of_cuda():
    if not shutil.which("ldd"):
        pytest.skip("there is no ldd")
    libraries = subprocess.run(["ldd", MODULE], capture_output=True, text=True, check=True).stdout
    assert "libtbb" in libraries and "cuda" not in libraries


def test_the_package_is_typed():
    assert (FOLDER / "py.typed").exists()
    stubs = FOLDER / "_mercury.pyi"
    if not stubs.exists():
        pytest.skip("this build has no stubs")
    names = {node.name for node in ast.parse(stubs.read_text()).body if isinstance(node, ast.ClassDef | ast.FunctionDef)}
    assert {name for name in vars(mercurysim._mercury) if not name.startswith("_")} <= names


PROGRAM = """
import numpy as np
import mercurysim

robots: list[mercurysim.Robot] = mercurysim.random_voxel(4, seed=1, voxels=(4, 3, 3), symmetry="none", edge=0.1)
ocean = mercurysim.Ocean(density=900, flow=(1, 0, 0), gravity=9.81).replace(density=1000)
density: float = ocean.density
robot = mercurysim.Robot(np.zeros((2, 3)), [[0, 1, 1, 0.1]], name="pair", actuators={"muscle": [0]})
center: float = float(robot.masses.mean())
names: list[str] = list(robot.actuators)
child: mercurysim.Robot = robots[0].cross(robots[1], seed=2).mutate(muscles=0.5)
child.save("child.json")
try:
    mercurysim.load("missing.json")
except mercurysim.InputError as error:
    print(error)
print(ocean == mercurysim.Ocean(), robot.info()["masses"], mercurysim.__version__)
"""

WRONG = """
import mercurysim

mercurysim.random_voxel("four")
mercurysim.random_voxel(symmetry="sideways")
mercurysim.Ocean(density="thick")
mercurysim.Robot([[0, 0, 0]])
"""


@pytest.fixture
def type_cache(tmp_path_factory):
    """Where mypy keeps what it knows of NumPy and others from one run of the tests to the next. By options, which it depends on."""
    return lambda options: tmp_path_factory.getbasetemp().parent / f"mypy-{options}"


@pytest.mark.parametrize("program, errors", [(PROGRAM, 0), (WRONG, 4)], ids=["right", "wrong"])
def test_the_type_checker_knows_the_package(tmp_path, type_cache, program, errors):
    if not importlib.util.find_spec("mypy"):
        pytest.skip("there is no mypy")
    if not (FOLDER / "_mercury.pyi").exists():
        pytest.skip("this build has no stubs")
    (tmp_path / "program.py").write_text(program)
    path = {} if "site-packages" in FOLDER.parts else {"MYPYPATH": str(FOLDER.parent)}
    result = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--no-error-summary", "--cache-dir", type_cache("strict"),
                             tmp_path / "program.py"], capture_output=True, text=True, env=path)
    found = [line for line in result.stdout.splitlines() if "program.py" in line and ": error: " in line]
    assert result.returncode < 2 and len(found) == errors, result.stdout + result.stderr


BLOCK = re.compile(r"```python\n(.*?)```", re.DOTALL)
ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = [*(ROOT / page for page in ("README.md", "docs/python.md", "docs/brains.md")),
            *sorted((ROOT / "examples/python").glob("*.py"))]


def test_the_type_checker_accepts_the_programs_of_the_documentation(tmp_path, type_cache):
    if not importlib.util.find_spec("mypy"):
        pytest.skip("there is no mypy")
    if not (FOLDER / "_mercury.pyi").exists():
        pytest.skip("this build has no stubs")
    for path in PROGRAMS:
        text = path.read_text()
        blocks = "\n".join(BLOCK.findall(text)) if path.suffix == ".md" else text
        (tmp_path / f"{path.stem}_program.py").write_text(blocks)
    variables = {} if "site-packages" in FOLDER.parts else {"MYPYPATH": str(FOLDER.parent)}
    # Other packages may be missing here, or have no types.
    result = subprocess.run([sys.executable, "-m", "mypy", "--disable-error-code", "import-untyped", "--disable-error-code",
                             "import-not-found", "--cache-dir", type_cache("lenient"), *tmp_path.glob("*_program.py")],
                            capture_output=True, text=True, env=variables)
    assert result.returncode == 0, result.stdout + result.stderr


WITHOUT_CONSTRUCTOR = {"Actuation", "Array", "BatchState", "Look", "Result", "Results"}


def test_everything_public_has_a_signature():
    for name in mercurysim.__all__:
        thing = getattr(mercurysim, name)
        if isinstance(thing, type) and issubclass(thing, Exception) or not callable(thing):
            continue
        if name not in WITHOUT_CONSTRUCTOR:
            inspect.signature(thing)
        for member, value in vars(thing).items() if isinstance(thing, type) else ():
            if not member.startswith("_") and callable(value):
                inspect.signature(value)


def test_signatures_are_those_of_the_functions():
    voxel = inspect.signature(mercurysim.random_voxel).parameters
    assert list(voxel)[:4] == ["count", "seed", "first", "lively"] and voxel["seed"].default == 1
    assert voxel["lively"].kind is inspect.Parameter.KEYWORD_ONLY
    assert list(inspect.signature(mercurysim.Batch).parameters)[:3] == ["robots", "environment", "solver"]
    assert list(inspect.signature(mercurysim.Batch([]).step).parameters) == ["n", "stream"]
    assert inspect.signature(mercurysim.Ocean).parameters["density"].default == 1000

    class Own(mercurysim.Batch):
        def __init__(self, size):
            super().__init__(mercurysim.random_voxel(size))

    assert list(inspect.signature(Own).parameters) == ["size"] and len(Own(2)) == 2


def test_the_package_itself_has_no_errors_of_types(type_cache):
    if not importlib.util.find_spec("mypy"):
        pytest.skip("there is no mypy")
    if not (FOLDER / "_mercury.pyi").exists():
        pytest.skip("this build has no stubs")
    result = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", type_cache("itself"), FOLDER],
                            capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr


def test_the_example_of_the_readme_runs(tmp_path, monkeypatch, capsys):
    readme = (Path(__file__).resolve().parents[2] / "README.md").read_text()
    monkeypatch.chdir(tmp_path)
    exec(re.search(r"```python\n(.*?)```", readme, re.DOTALL).group(1), {})
    assert re.fullmatch(r"Robot 'voxel-1-\d+': .* actuators swam \d+\.\d{3} m\n", capsys.readouterr().out)
    assert mercurysim.load("best.json").name.startswith("voxel-1-")
