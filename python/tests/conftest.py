"""Fractals that tests share."""

import pytest

import kfrac


@pytest.fixture(scope="session")
def pythagoras() -> kfrac.Fractal:
    """Tree with the parameter `angle`, in degrees."""
    return kfrac.load("pythagoras")


@pytest.fixture(scope="session")
def fern() -> kfrac.Fractal:
    """System of four maps."""
    return kfrac.load("barnsley-fern")
