"""Gains against python-control, and what is learned reaching control."""

import control
import numpy as np
import pytest

import handstand as hs
from conftest import HANDSTAND


def test_continuous_gains_are_those_of_python_control() -> None:
    model = hs.Model.load(HANDSTAND)
    found = hs.gains(model, q=100.0, r=1.0, ts_s=None)
    a, b = found.plant
    k, _, _ = control.lqr(a, b, 100.0 * np.eye(a.shape[0]), np.eye(b.shape[1]))
    np.testing.assert_allclose(found.k, k, rtol=1e-6, atol=1e-8)
    with pytest.raises(hs.HandstandError, match="fixed-point"):
        found.c_header()


def test_sampled_gains_stabilise_the_simulated_loop() -> None:
    found = hs.gains(hs.Model.load(HANDSTAND))
    assert found.stabilised and found.region_rad > 0.0
    assert not found.region_open and not found.stays_uncontrolled
    said = found.to_dict()["verification"]
    assert said["region_open"] == found.region_open
    assert said["stays_uncontrolled"] == found.stays_uncontrolled
    assert "#include" in found.c_header() and "WALK_STATES" in found.c_header("walk")
    least = found.margins["inputs"]["common"]["gain"][0]
    paper = hs.gains(hs.Model.load(HANDSTAND), q=100.0)
    assert 0.3 < least < 0.5 < 0.7 < paper.margins["inputs"]["common"]["gain"][0] < 1.0
    assert found.to_dict()["margins"] == found.margins
    assert found.k.shape[1] == len(found.states) == len(found.x0)


def test_the_simulated_law_is_given_what_sensors_give() -> None:
    model = hs.Model.load(HANDSTAND)
    coarse = hs.gains(model, position_step_rad=5e-3, speeds="difference")
    said = coarse.to_dict()["verification"]
    assert said["position_step_rad"] == 5e-3 and said["differences"]
    for keywords in ({"speeds": "filtered"}, {"position_step_rad": -1.0}, {"r": 2.0}):
        with pytest.raises(hs.UsageError, match="remedy"):
            hs.gains(model, **keywords)


def test_a_weight_of_the_wrong_size_is_refused() -> None:
    model = hs.Model.load(HANDSTAND)
    with pytest.raises(hs.HandstandError, match="remedy"):
        hs.gains(model, q=[1.0, 2.0])
    with pytest.raises(hs.UsageError, match="square"):
        hs.gains(model, q=np.ones((2, 3)))
