"""Stubs describe the module as it is, and everything public is documented."""

import ast
import inspect
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import kfrac
import kfrac._kfrac

FUNCTION = ast.FunctionDef

SLOTS = {"__len__", "__getitem__", "__init__"}
"""Methods whose arguments Python itself names."""


def stubs() -> Iterator[tuple[str, FUNCTION, Any]]:
    """Returns the functions and methods of the stubs, with their names and the objects that they describe."""
    stub = Path(kfrac.__file__).with_name("_kfrac.pyi")
    for node in ast.parse(stub.read_text()).body:
        if isinstance(node, FUNCTION):
            yield node.name, node, getattr(kfrac._kfrac, node.name)
        if isinstance(node, ast.ClassDef):
            described = getattr(kfrac._kfrac, node.name)
            for method in node.body:
                if isinstance(method, FUNCTION) and method.name not in SLOTS:
                    yield f"{node.name}.{method.name}", method, getattr(described, method.name)


@pytest.mark.parametrize(("name", "stub", "described"), list(stubs()), ids=lambda it: it if isinstance(it, str) else "")
def test_signatures_are_those_of_the_stubs(name: str, stub: FUNCTION, described: Any) -> None:
    if inspect.isgetsetdescriptor(described):
        assert [ast.unparse(it) for it in stub.decorator_list] == ["property"]
        return
    arguments = stub.args
    expected = [it.arg for it in [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]]
    expected += [it.arg for it in [arguments.vararg, arguments.kwarg] if it is not None]
    parameters = inspect.signature(described).parameters
    assert list(parameters) == expected
    defaults = dict(zip(reversed([it.arg for it in arguments.args]), reversed(arguments.defaults)))
    defaults |= {it.arg: value for it, value in zip(arguments.kwonlyargs, arguments.kw_defaults) if value}
    for parameter in parameters.values():
        assert (parameter.default is not parameter.empty) == (parameter.name in defaults), parameter


def test_all_that_is_public_is_in_the_stubs() -> None:
    described = {name for name, _, _ in stubs()}
    for owner in [kfrac.Fractal, kfrac.Table, kfrac._kfrac.Dataset]:
        public = [name for name in vars(owner) if not name.startswith("_")]
        assert {f"{owner.__name__}.{name}" for name in public} <= described


def test_everything_public_is_documented() -> None:
    for name in kfrac.__all__:
        described = getattr(kfrac, name)
        assert inspect.getdoc(described), name
        if inspect.isclass(described):
            for member, value in vars(described).items():
                if not member.startswith("_") and (callable(value) or inspect.isdatadescriptor(value)):
                    assert inspect.getdoc(value), f"{name}.{member}"
