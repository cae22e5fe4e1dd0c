"""A robot in space, from its file and a log of it."""

from pathlib import Path

import numpy as np
import pytest

import handstand as hs

JOINTS = ("pan", "lift")
URDF = """<robot name="crane"><link name="base"/>
<link name="mast"><inertial><origin xyz="0.05 0 0"/><mass value="0.4"/>
<inertia ixx="1e-3" iyy="1e-3" izz="2e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="boom"><inertial><origin xyz="0.1 0 0"/><mass value="0.2"/>
<inertia ixx="3e-4" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="pan" type="continuous"><parent link="base"/><child link="mast"/>
<axis xyz="0 0 1"/></joint>
<joint name="lift" type="continuous"><parent link="mast"/><child link="boom"/>
<origin xyz="0.1 0 0.1"/><axis xyz="0 1 0"/></joint>
</robot>"""


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    """The robot's file, and a log whose columns have the joints' names."""
    robot, log = tmp_path / "crane.urdf", tmp_path / "a.csv"
    robot.write_text(URDF)
    time_s = 0.02 * np.arange(300)
    columns, names = [time_s], ["time_s"]
    for joint, name in enumerate(JOINTS):
        goal = 0.3 * np.sin(1.3 * time_s + joint)
        columns += [0.98 * goal, goal]
        names += [f"{name}.position", f"{name}.goal_rad"]
    np.savetxt(log, np.column_stack(columns), delimiter=",", header=",".join(names), comments="")
    return robot, log


def test_a_robot_in_space_finds_its_file_from_anywhere(
    files: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot, log = files
    monkeypatch.chdir(tmp_path)
    draft = hs.init(log, robot=robot.name)
    assert draft.model.drives == ["position", "position"]
    assert any("pan" in own["what"] + own["guess"] for own in draft.guesses)
    elsewhere = tmp_path / "models" / "crane.toml"
    elsewhere.parent.mkdir()
    draft.model.save(elsewhere)
    monkeypatch.chdir("/")
    model = hs.Model.load(elsewhere)
    assert model.links == 2
    compared = hs.compare(model, log)
    assert len(compared.rms) == 2
    assert all(np.isfinite(compared.rms))
    assert "lift" in str(compared) and "joint 2" not in str(compared)
    model["link.boom.mass_kg"] = 0.3
    assert hs.compare(model, log).rms != compared.rms


def test_joints_are_held_and_named(files: tuple[Path, Path]) -> None:
    robot, log = files
    held = hs.init(log, robot=robot, lock={"pan": 0.5})
    assert held.model.links == 1
    robot.write_text(URDF.replace('"lift"', '"boom_lift"'))
    named = hs.init(log, robot=robot, lock={"pan": 0.5}, names={"boom_lift": "lift"})
    assert named.model.links == 1


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({"unit": "grad"}, "grad"),
        ({"mass_kg": [0.3]}, "mass_kg"),
        ({"drive": "torque"}, "torque"),
        ({"lock": {"tilt": 0.0}}, "tilt"),
    ],
)
def test_what_a_robot_cannot_be_is_told(
    files: tuple[Path, Path], wrong: dict[str, object], told: str
) -> None:
    robot, log = files
    with pytest.raises(hs.HandstandError, match=told):
        hs.init(log, robot=robot, **wrong)  # type: ignore[arg-type]
    with pytest.raises(hs.UsageError, match="robot"):
        hs.init(log, lock={"pan": 0.5})
    with pytest.raises(FileNotFoundError, match=r"none\.urdf"):
        hs.init(log, robot=robot.with_name("none.urdf"))
