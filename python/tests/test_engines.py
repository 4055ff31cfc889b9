"""Recipes for engines that work on several machines, each with two workers, of which one is killed.

They need the dependency group `engines`, and Spark needs Java.
"""

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parent

# Of Ray's message when it aborts: it may if a worker is killed while the result of its task before arrives.
ABORTED = "You have likely discovered a bug in Ray"

MODULES = {"dask": ["dask", "distributed"], "ray": ["ray"], "spark": ["pyspark", "pandas", "pyarrow"]}


def run(engine: str, arguments: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """Runs a program in a folder."""
    for module in MODULES[engine]:
        if importlib.util.find_spec(module) is None:
            pytest.skip(f"{module} is not installed: pip install --group engines")
    if engine == "spark" and shutil.which("java") is None:
        pytest.skip("Spark needs Java, and there is no java")
    return subprocess.run(
        [sys.executable, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=300,
        cwd=folder,
        env=os.environ | {"PYSPARK_PYTHON": sys.executable},
    )


def succeeded(done: subprocess.CompletedProcess[str]) -> str:
    """Checks that a program did not fail, and returns what it printed."""
    assert done.returncode == 0, done.stdout
    return done.stdout


@pytest.mark.parametrize("scenario", ["same", "interrupted"])
@pytest.mark.parametrize("engine", MODULES)
def test_workers_do_what_one_process_does(engine: str, scenario: str, tmp_path: Path) -> None:
    for attempt in range(3):
        folder = tmp_path / str(attempt)
        folder.mkdir()
        done = run(engine, [str(FOLDER / "cluster.py"), engine, str(folder), scenario], folder)
        if ABORTED not in done.stdout:
            assert succeeded(done).splitlines()[-1] == "done"
            return
    pytest.fail("Ray aborted three times")


@pytest.mark.parametrize("engine", MODULES)
def test_recipes_run(engine: str, tmp_path: Path) -> None:
    printed = succeeded(run(engine, [str(FOLDER.parent / "examples" / f"on_{engine}.py")], tmp_path))
    assert "pictures (100, 256, 256)" in printed and "height" in printed
