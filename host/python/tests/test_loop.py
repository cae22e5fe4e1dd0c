"""The measuring loop: compare, diagnose, add, fit, simulate."""

import numpy as np
import pytest

import handstand as hs


def test_simulation_follows_the_pendulum_s_equation(model: hs.Model) -> None:
    """Against Runge-Kutta written out here, of (I + m c^2) q'' = -m g c sin q + tau."""
    time_s = 0.01 * np.arange(300)
    torque_nm = 0.2 * np.sin(3 * time_s)
    found = hs.simulate(model, time_s, input=torque_nm, angle_rad=0.4, speed_rad_s=-1.0)

    def rate(state: np.ndarray, tau: float) -> np.ndarray:
        gravity = 0.3 * 9.81 * 0.125 * np.sin(state[0])
        return np.array([state[1], (tau - gravity) / (1.6e-3 + 0.3 * 0.125**2)])

    state, angles = np.array([0.4, -1.0]), []
    for tau in torque_nm:
        angles.append(state[0])
        for _ in range(20):
            h = 0.0005
            a = rate(state, tau)
            b = rate(state + h / 2 * a, tau)
            c = rate(state + h / 2 * b, tau)
            d = rate(state + h * c, tau)
            state = state + h / 6 * (a + 2 * b + 2 * c + d)
    np.testing.assert_allclose(found.position_rad[0], angles, atol=2e-6)


def test_diagnosis_names_the_friction_and_add_lowers_the_error(
    model: hs.Model, motions: list[hs.Motion]
) -> None:
    steps: list[tuple[str, int, int]] = []
    diagnosis = hs.diagnose(
        model, motions[:2], holdout=motions[2], progress=lambda *step: steps.append(step)
    )
    assert diagnosis.verdict == "named"
    assert diagnosis.effects == ["coulomb@1"]
    assert steps and all(0 <= done <= total for _, done, total in steps)
    assert "Coulomb" in str(diagnosis)
    assert "<iframe" in diagnosis._repr_html_() and "Coulomb" in diagnosis.html()

    added = hs.add(model, diagnosis.effects, motions[:2], holdout=motions[2])
    assert added.error_after_rad < 0.05 * added.error_before_rad
    value, low, high = added.values["coulomb@1.torque_nm"]
    assert low <= 0.05 <= high and abs(value - 0.05) < 1e-3
    assert added.model.effects == ["coulomb@1"]

    before, after = (hs.compare(m, motions[2]).rms[0] for m in (model, added.model))
    assert after < 0.05 * before


def test_an_effect_that_does_not_help_is_refused(
    truth: hs.Model, motions: list[hs.Motion]
) -> None:
    with pytest.raises(hs.HandstandError, match="remedy"):
        hs.add(truth, "cable_spring@1", motions[:2], holdout=motions[2])


def test_fit_finds_the_value(truth: hs.Model, motions: list[hs.Motion]) -> None:
    wrong = hs.Model.parse(truth.toml.replace("torque_nm = 0.05", "torque_nm = 0.02"))
    steps: list[str] = []
    fitted = hs.fit(
        wrong,
        motions,
        free="coulomb@1.torque_nm",
        progress=lambda what, done, total: steps.append(f"{what} {done}/{total}"),
    )
    assert steps == ["fit 0/2", "exact values 1/2"]
    value, low, high = fitted.values["coulomb@1.torque_nm"]
    assert low < 0.05 < high or abs(value - 0.05) < 2e-4
    assert f"{value:.6f}"[:5] in fitted.model.toml


def test_a_gap_and_a_row_range_are_read_as_by_the_command_line(
    model: hs.Model, logs: list[str]
) -> None:
    (part,) = hs.read_log(logs[0] + ":100-199", model)
    (whole,) = hs.read_log(logs[0], model)
    assert len(part) == 100
    np.testing.assert_array_equal(part.position_rad, whole.position_rad[:, 100:200])
    np.testing.assert_array_equal(part.time_s, whole.time_s[100:200])
