"""Documentation: pages whose programs are executed when it is built, and the reference from the docstrings."""

import re
from importlib.metadata import version as version_of
from typing import Any

project = "kfrac"
copyright = "the kfrac authors"  # noqa: A001
version = release = version_of("kfrac")

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
html_theme = "furo"
html_title = f"kfrac {version}"
html_copy_source = False

# Every cell is executed, and an exception ends the build. One cell waits for a measurement of seconds at most.
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_show_tb = True
nb_execution_timeout = 120

myst_heading_anchors = 2
suppress_warnings = ["myst-nb.mime_priority"]

autodoc_member_order = "bysource"
autodoc_typehints = "description"
napoleon_google_docstring = False
napoleon_use_rtype = False


def code_spans(_app: Any, _what: str, _name: str, _object: object, _options: Any, lines: list[str]) -> None:
    """Marks names in single backquotes, as the docstrings have them, as code."""
    lines[:] = [re.sub(r"(?<![`:])`([^`]+)`(?![`_])", r"``\1``", line) for line in lines]


def is_left_out(_app: Any, _what: str, _name: str, member: object, _skip: bool, _options: Any) -> bool | None:
    """Leaves out fields of named tuples that have no documentation but their number."""
    return True if (getattr(member, "__doc__", None) or "").startswith("Alias for field number") else None


def setup(app: Any) -> None:
    app.connect("autodoc-skip-member", is_left_out)
    app.connect("autodoc-process-docstring", code_spans, priority=0)
