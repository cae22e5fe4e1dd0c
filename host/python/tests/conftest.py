"""A bench: a driven arm whose truth rubs, and whose model does not know it."""

from pathlib import Path

import numpy as np
import pytest

import handstand as hs

HANDSTAND = Path(__file__).parents[2] / "models" / "handstand.toml"
"""The robot on the bar."""

ARM = """
[rig]
name = "arm"
angle_zero = "hanging"

[[link]]
length_m = 0.25
com_m = 0.125
mass_kg = 0.3
inertia_kg_m2 = 1.6e-3

[[joint]]
drive = "torque"
{effect}
[log]
time = {{ column = "time_s", unit = "s" }}

[[log.joint]]
position = {{ column = "angle_rad", unit = "rad", resolution_rad = 1e-4 }}
input = {{ column = "torque_nm", unit = "N m" }}
"""

RUBBING = """
[[effect]]
kind = "coulomb"
joint = 1
torque_nm = 0.05
"""


def measured(truth: hs.Model, seed: int) -> hs.Motion:
    """A measured motion: three sines of torque, 10 s at 100 Hz, rounded angles."""
    random = np.random.default_rng(seed)
    time_s = 0.01 * np.arange(1000)
    torque_nm = sum(
        random.uniform(0.1, 0.25) * np.sin(2 * np.pi * f * time_s + random.uniform(0, 6))
        for f in (0.3, 0.7, 1.3)
    )
    clean = hs.simulate(truth, time_s, input=torque_nm)
    noisy = clean.position_rad + random.normal(0, 2e-4, clean.position_rad.shape)
    return hs.Motion(
        time_s, np.round(noisy, 4), input=torque_nm, name=f"motion{seed}"
    )


@pytest.fixture(scope="session")
def model() -> hs.Model:
    return hs.Model.parse(ARM.format(effect=""), "arm.toml")


@pytest.fixture(scope="session")
def truth() -> hs.Model:
    return hs.Model.parse(ARM.format(effect=RUBBING), "truth.toml")


@pytest.fixture(scope="session")
def motions(truth: hs.Model) -> list[hs.Motion]:
    return [measured(truth, seed) for seed in range(3)]


@pytest.fixture(scope="session")
def logs(motions: list[hs.Motion], tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """The motions as CSV files."""
    folder = tmp_path_factory.mktemp("logs")
    files = []
    for motion in motions:
        torque = motion.input[0]
        assert torque is not None
        rows = np.column_stack([motion.time_s, motion.position_rad[0], torque])
        file = folder / f"{motion.name}.csv"
        with file.open("w") as out:
            out.write("time_s,angle_rad,torque_nm\n")
            for row in rows.tolist():
                out.write(",".join(repr(value) for value in row) + "\n")
        files.append(str(file))
    return files


@pytest.fixture(scope="session")
def model_file(model: hs.Model, tmp_path_factory: pytest.TempPathFactory) -> str:
    file = tmp_path_factory.mktemp("model") / "arm.toml"
    model.save(file)
    return str(file)
