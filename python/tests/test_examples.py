"""Programs of the examples, the README and the docstrings run."""

import doctest
import re
import runpy
from pathlib import Path

import pytest

import kfrac

FOLDER = Path(__file__).parent.parent


# Those for engines are run by `test_engines.py`.
EXAMPLES = [path for path in sorted((FOLDER / "examples").glob("*.py")) if not path.name.startswith("on_")]


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_examples_run(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(path), run_name="__main__")


def test_the_programs_of_the_readme_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    readme = (FOLDER / "README.md").read_text()
    program = "\n".join(re.findall(r"```python\n(.*?)```", readme, flags=re.DOTALL))
    exec(compile(program, "README.md", "exec"), {"__name__": "readme"})
    printed = capsys.readouterr().out
    # Comments after `print` are what it prints.
    for expected in re.findall(r"^ *print\(.*?# (Dimension\(.*\)|did you mean .*)$", readme, flags=re.MULTILINE):
        assert expected in printed


def test_docstrings_are_true() -> None:
    assert doctest.testmod(kfrac, optionflags=doctest.ELLIPSIS).failed == 0
    assert doctest.testmod(kfrac).attempted > 0
