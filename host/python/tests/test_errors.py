"""What is wrong is said, with the remedy; nothing crashes; Ctrl-C ends long work."""

import errno
import pickle
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import numpy as np
import pytest

import handstand as hs
from conftest import ARM


def test_a_wrong_model_file_is_refused_with_its_place(tmp_path: Path) -> None:
    file = tmp_path / "wrong.toml"
    file.write_text(ARM.format(effect="").replace('"hanging"', '"sideways"'))
    with pytest.raises(hs.DataError, match=r"wrong\.toml:4:\d+: .*sideways.*\nremedy: "):
        hs.Model.load(file)


def test_every_error_has_one_root(model: hs.Model, tmp_path: Path) -> None:
    missing = str(tmp_path / "missing.toml")
    with pytest.raises(FileNotFoundError, match="missing.toml: cannot read.*\\nremedy") as told:
        hs.Model.load(missing)
    assert isinstance(told.value, hs.HandstandError) and isinstance(told.value, hs.FileError)
    assert told.value.errno == errno.ENOENT and told.value.filename == missing
    with pytest.raises(FileNotFoundError):
        hs.compare(model, missing)
    for kind in (hs.UsageError, hs.DataError, hs.FileError, hs.AddressError):
        assert issubclass(kind, hs.HandstandError)
    assert issubclass(hs.UsageError, ValueError) and issubclass(hs.DataError, ValueError)
    with pytest.raises(IsADirectoryError):
        hs.Model.load(tmp_path)
    copied = pickle.loads(pickle.dumps(told.value))
    assert (copied.errno, copied.filename, str(copied)) == (
        told.value.errno,
        told.value.filename,
        str(told.value),
    )


def test_nothing_is_overwritten_unasked(model: hs.Model, tmp_path: Path) -> None:
    file = tmp_path / "arm.toml"
    model.save(file)
    with pytest.raises(Exception, match="arm.toml"):
        model.save(file)
    model.save(file, overwrite=True)
    assert file.read_text() == model.toml


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"time_s": np.zeros(100)}, "does not increase"),
        ({"time_s": [0.0, 0.1]}, "no motion"),
        ({"position_rad": np.zeros((2, 3, 4))}, "position_rad"),
        ({"position_rad": "text"}, "position_rad"),
        ({"input": np.zeros(99)}, "99 samples"),
        ({"input": np.full(100, np.nan)}, "no number"),
        ({"input": [None, None]}, "2 rows for 1 joint"),
        ({"payload_kg": float("inf")}, "payload"),
        ({"time_s": [*range(99), float("inf")]}, "infinite"),
        ({"position_rad": np.full(100, np.inf)}, "infinite"),
        ({"supply_v": np.full(100, -np.inf)}, "infinite"),
    ],
)
def test_arrays_that_make_no_motion_are_refused(change: dict[str, object], said: str) -> None:
    given: dict[str, object] = {
        "time_s": 0.01 * np.arange(100),
        "position_rad": np.zeros(100),
        "input": np.zeros(100),
    }
    with pytest.raises(hs.UsageError, match=said):
        hs.Motion(**(given | change))  # type: ignore[arg-type]


def test_a_motion_of_another_rig_is_refused(model: hs.Model) -> None:
    two = hs.Motion(0.01 * np.arange(100), np.zeros((2, 100)), input=np.zeros((2, 100)))
    with pytest.raises(hs.UsageError, match="2 joints, the model 1"):
        hs.compare(model, two)
    passive = hs.Motion(0.01 * np.arange(100), np.zeros(100))
    with pytest.raises(hs.UsageError, match="no input of joint 1"):
        hs.compare(model, passive)


def test_an_unknown_effect_is_refused(model: hs.Model, motions: list[hs.Motion]) -> None:
    with pytest.raises(ValueError, match="remedy"):
        hs.add(model, "magic@1", motions)
    with pytest.raises(ValueError, match="remedy"):
        hs.diagnose(model, motions, without=["magic"])


def test_an_exception_of_the_progress_ends_the_work(
    model: hs.Model, motions: list[hs.Motion]
) -> None:
    def progress(what: str, done: int, total: int) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        hs.diagnose(model, motions, progress=progress)


def test_ctrl_c_ends_a_diagnosis(model_file: str, logs: list[str]) -> None:
    program = textwrap.dedent(
        f"""
        import signal
        import handstand as hs
        # A shell that started the tests in the background leaves Ctrl-C ignored.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        model = hs.Model.load({model_file!r})
        print("begun", flush=True)
        while True:
            hs.diagnose(model, {logs!r})
        """
    )
    child = subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert child.stdout is not None and child.stdout.readline() == "begun\n"
    time.sleep(0.3)
    child.send_signal(signal.SIGINT)
    try:
        _, said = child.communicate(timeout=60)
    finally:
        child.kill()
    assert "KeyboardInterrupt" in said
    assert child.returncode != 0


def test_other_threads_run_meanwhile(model: hs.Model, motions: list[hs.Motion]) -> None:
    """The lock is free: a counter goes on while the library diagnoses."""
    import threading

    ticks, done = 0, threading.Event()

    def count() -> None:
        nonlocal ticks
        while not done.wait(0.01):
            ticks += 1

    counter = threading.Thread(target=count)
    counter.start()
    begun = time.monotonic()
    hs.diagnose(model, motions)
    seconds = time.monotonic() - begun
    done.set()
    counter.join()
    assert ticks > 10 * seconds
