"""Models and motions as values: numbers by address, copies, tables of pandas, shapes."""

import copy
import pickle
from collections.abc import Callable

import numpy as np
import pytest

import handstand as hs
from conftest import ARM, RUBBING


def test_a_value_is_set_by_its_address_and_stays_exact(truth: hs.Model) -> None:
    model = copy.deepcopy(truth)
    assert model == truth and model is not truth
    assert model["coulomb@1.torque_nm"] == 0.05
    model["coulomb@1.torque_nm"] = 0.1234567890123
    assert model["coulomb@1.torque_nm"] == 0.1234567890123
    assert model.values["link1.mass_kg"] == 0.3
    assert list(model) == list(model.values) and "link1.com_m" in model
    assert "0.1234567890123" in model.toml
    assert hs.Model.parse(model.toml) == model != truth
    assert truth["coulomb@1.torque_nm"] == 0.05, "a copy is its own"


@pytest.mark.parametrize("address", ["link9.mass_kg", "delay@1.delay_s", "mass", "link1.mass"])
def test_an_address_that_is_none_is_refused(truth: hs.Model, address: str) -> None:
    assert address not in truth
    with pytest.raises(KeyError, match="remedy") as told:
        truth[address]
    assert isinstance(told.value, hs.UsageError)
    with pytest.raises(hs.AddressError):
        truth[address] = 1.0


def test_a_value_that_is_impossible_is_refused_and_changes_nothing(truth: hs.Model) -> None:
    before = truth.toml
    with pytest.raises(hs.UsageError, match=r"link1.mass_kg = -1: .*impossible"):
        truth["link1.mass_kg"] = -1.0
    assert truth.toml == before


@pytest.mark.parametrize("again", [copy.deepcopy, lambda own: pickle.loads(pickle.dumps(own))])
def test_models_and_motions_are_copied(
    truth: hs.Model, logs: list[str], again: Callable[[object], object]
) -> None:
    (motion,) = hs.read_log(logs[0], truth)
    for own in (truth, motion):
        other = again(own)
        assert other == own and repr(other) == repr(own)
        with pytest.raises(TypeError):
            hash(own)
    angle = motion.position_rad.copy()
    angle[0, 7] = np.nan
    gap = hs.Motion(motion.time_s, angle, input=motion.input, name=motion.name)
    assert gap != motion and again(gap) == gap
    two = hs.Motion(motion.time_s, np.vstack([angle, angle]), input=[None, motion.input[0]])
    assert again(two) == two


def test_words_count(truth: hs.Model, motions: list[hs.Motion]) -> None:
    assert ": 1 link, " in repr(truth) and ": 1 joint, " in repr(motions[0])


def test_a_column_is_one_joint_and_a_row_per_sample_is_refused() -> None:
    time_s = 0.01 * np.arange(100)
    angle = np.sin(time_s)
    row = hs.Motion(time_s, angle, input=angle)
    column = hs.Motion(time_s[:, None], angle[:, None], input=angle[:, None])
    assert row == column
    with pytest.raises(hs.UsageError, match=r"position_rad.*\(100, 2\)(.|\n)*position_rad\.T"):
        hs.Motion(time_s, np.column_stack([angle, angle]))


def test_a_table_of_pandas_is_a_log(model: hs.Model, motions: list[hs.Motion]) -> None:
    pandas = pytest.importorskip("pandas")
    motion = motions[0]
    assert motion.input[0] is not None
    table = pandas.DataFrame(
        {
            "time_s": motion.time_s,
            "angle_rad": motion.position_rad[0],
            "torque_nm": motion.input[0],
        }
    )
    for frame in (table, table.set_index("time_s")):
        (read,) = hs.read_log(frame, model)
        np.testing.assert_array_equal(read.position_rad, motion.position_rad)
        np.testing.assert_array_equal(read.time_s, motion.time_s)
        assert hs.compare(model, frame).rms == hs.compare(model, motion).rms
    with pytest.raises(hs.DataError, match="^DataFrame.csv"):
        hs.read_log(table.rename(columns={"angle_rad": "angle"}), model)
    assert hs.log_check(model, table).verdict in ("clean", "warned", "refused")
    assert "torque_nm" in hs.init(table).model.toml


def test_residuals_are_there_at_every_sample(model: hs.Model, motions: list[hs.Motion]) -> None:
    compared = hs.compare(model, motions)
    assert [own.name for own in compared.motions] == [own.name for own in motions]
    errors = []
    for motion, predicted, residual in zip(
        motions, compared.predictions, compared.residuals, strict=True
    ):
        assert predicted.shape == residual.shape == (1, len(motion))
        np.testing.assert_array_equal(motion.position_rad - predicted, residual)
        errors.append(residual[0])
    rms = np.sqrt(np.mean(np.concatenate(errors) ** 2))
    np.testing.assert_allclose(rms, compared.rms[0], rtol=1e-12)


def test_what_is_learned_from_does_not_judge(model: hs.Model, motions: list[hs.Motion]) -> None:
    first, second = motions[:2]
    copied = hs.Motion(first.time_s, first.position_rad, input=first.input, name="copy")
    for judge, said in (
        (first, "motion0 is fitted and held out"),
        (copied, "copy is held out, and shares rows with motion0, which is fitted"),
    ):
        for work in (
            lambda: hs.diagnose(model, [first, second], holdout=judge),
            lambda: hs.add(model, "coulomb@1", [first, second], holdout=judge),
            lambda: hs.fit(model, [first, second], free="link1.com_m", holdout=judge),
        ):
            with pytest.raises(hs.UsageError, match=said):
                work()


def test_the_old_name_of_holdout_still_works(truth: hs.Model, motions: list[hs.Motion]) -> None:
    with pytest.warns(DeprecationWarning, match="holdout"):
        old = hs.fit(truth, motions[:2], free="link1.com_m", hold_out=motions[2])  # type: ignore[call-arg]
    new = hs.fit(truth, motions[:2], free="link1.com_m", holdout=motions[2])
    assert old.to_dict() == new.to_dict()
    fitted = new.values["link1.com_m"]
    assert fitted.low <= fitted.value <= fitted.high


def test_effects_are_described() -> None:
    every = {effect["id"] for effect in hs.effects()}
    assert {"coulomb", "viscous"} <= every
    assert hs.effects("coulomb")["parameters"][0]["key"] == "torque_nm"
    with pytest.raises(hs.UsageError, match="remedy"):
        hs.effects("magic")


def test_values_drift_between_sessions(truth: hs.Model, motions: list[hs.Motion]) -> None:
    worn = hs.Model.parse(ARM.format(effect=RUBBING.replace("0.05", "0.08")))
    again = hs.simulate(worn, motions[2].time_s, input=motions[2].input)
    noise = np.random.default_rng(7).normal(0, 2e-4, again.position_rad.shape)
    late = hs.Motion(
        again.time_s, again.position_rad + noise, input=again.input, name="late"
    )
    found = hs.drift(truth, [*motions[:2], late], free="coulomb@1.torque_nm")
    (value,) = found["sessions"]
    assert value["differ"] and [own["of"] for own in value["values"]][-1] == "late"
    with pytest.raises(hs.UsageError, match="share a motion"):
        hs.drift(truth, [motions[0], motions[0]])
    with pytest.raises(hs.UsageError, match="two"):
        hs.drift(truth, motions[:1])


def test_the_next_experiment_tightens_a_value(truth: hs.Model, motions: list[hs.Motion]) -> None:
    found = hs.next(truth, motions[:2], value="link1.com_m", seconds=5.0, mass_kg=0.0)
    assert found.helps and found.instructions == found.to_dict()["proposal"]["experiment"]["instructions"]
    assert found.motion is not None and found.motion.time_s[-1] <= 5.1
    with pytest.raises(hs.UsageError, match="angles_rad"):
        hs.next(truth, motions, value="link1.com_m", angles_rad=(1.0, -1.0))


def test_functions_say_their_parameters() -> None:
    for own in (hs.Motion, hs.Model, hs.diagnose, hs.add, hs.fit, hs.compare, hs.simulate, hs.next):
        assert own.__doc__ is not None and "Parameters\n----------" in own.__doc__
    assert hs.__version__.count(".") == 2
