"""Families of fractals."""

import pickle

import numpy as np
import pytest

import kfrac


def test_a_sweep_has_all_combinations() -> None:
    text = "params: {a: 1/3, b: 0.2}\ninitiator: segment\ngenerator: [[0, 0], [a, 0], [1/2, b], [1 - a, 0], [1, 0]]"
    sweep = kfrac.sweep(kfrac.parse(text), a=[0.2, 0.3], b=np.linspace(0.1, 0.3, 3))
    assert len(sweep) == 6
    expected = [(a, b) for a in (0.2, 0.3) for b in (0.1, 0.2, 0.3)]
    assert np.allclose(np.stack([sweep.parameters["a"], sweep.parameters["b"]], axis=1), expected)
    assert np.allclose([tuple(member.parameters.values()) for member in sweep], expected)
    part = sweep[1:5:2]
    assert [member.parameters for member in part] == [sweep[1].parameters, sweep[3].parameters]
    assert sweep[-1].parameters == sweep[5].parameters
    again = pickle.loads(pickle.dumps(part))
    assert [member.yaml() for member in again] == [member.yaml() for member in part]
    with pytest.raises(IndexError):
        sweep[6]


def test_functions_are_mapped_in_order() -> None:
    sweep = kfrac.sweep("pythagoras", angle=np.linspace(10, 80, 15))
    corners = sweep.map(lambda tree: tree.bounds(6).max, threads=3)
    assert corners == [tree.bounds(6).max for tree in sweep]
    assert len(set(corners)) == len(corners)


def test_parameters_are_checked() -> None:
    with pytest.raises(kfrac.KfracError, match="did you mean 'angle'"):
        kfrac.sweep("pythagoras", angel=[10, 20])
    assert len(kfrac.sweep("pythagoras", angle=[])) == 0
    assert kfrac.sweep("pythagoras")[0].parameters == kfrac.load("pythagoras").parameters
