"""Gains against python-control, and what is learned reaching control."""

from pathlib import Path

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


URDF = """<robot name="pan"><link name="base"/>
<link name="mast"><inertial><mass value="0.4"/>
<inertia ixx="1e-3" iyy="1e-3" izz="2e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="boom"><inertial><origin xyz="0.1 0 0"/><mass value="0.3"/>
<inertia ixx="3e-4" iyy="2e-3" izz="2e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="pan" type="continuous"><parent link="base"/><child link="mast"/>
<axis xyz="0 0 1"/></joint>
<joint name="tilt" type="revolute"><parent link="mast"/><child link="boom"/>
<axis xyz="0 -1 0"/><limit lower="-1" upper="1" effort="3" velocity="0"/></joint></robot>"""

MODEL = """[rig]
name = "pan"
robot = "pan.urdf"
[[joint]]
name = "pan"
drive = "torque"
[[joint]]
name = "tilt"
drive = "torque"
[log]
time = { column = "t", unit = "s" }
[[log.joint]]
position = { column = "pan", unit = "rad" }
input = { column = "pan_nm", unit = "N m" }
[[log.joint]]
position = { column = "tilt", unit = "rad" }
input = { column = "tilt_nm", unit = "N m" }
"""


def test_a_robot_in_space_is_held_at_a_pose_that_its_joints_name(tmp_path: Path) -> None:
    (tmp_path / "pan.urdf").write_text(URDF)
    (tmp_path / "pan.toml").write_text(MODEL)
    model = hs.Model.load(tmp_path / "pan.toml")
    found = hs.gains(model, pose_rad={"tilt": 0.5})
    assert found.stabilised
    assert found.states == ["q_pan", "q_tilt", "dq_pan", "dq_tilt"]
    np.testing.assert_allclose(found.x0, [0.0, 0.5, 0.0, 0.0])
    np.testing.assert_allclose(found.u0, [0.0, 0.3 * 9.81 * 0.1 * np.cos(0.5)], atol=1e-12)
    np.testing.assert_array_equal(found.k, hs.gains(model, pose_rad=[0.0, 0.5]).k)
    assert "GAINS_STATE_STEP_Q_TILT" in found.c_header()
    for pose in ({"tlt": 0.5}, {"tilt": 1.5}, [0.5]):
        with pytest.raises(hs.HandstandError, match="remedy"):
            hs.gains(model, pose_rad=pose)
