"""The numbers are those of the command line, which HANDSTAND names."""

import json
import os
import subprocess

import pytest

import handstand as hs
from conftest import HANDSTAND


def command(*words: str) -> dict[str, object]:
    program = os.environ.get("HANDSTAND")
    if program is None:
        pytest.skip("the variable HANDSTAND does not name the program")
    ran = subprocess.run([program, *words, "--json"], capture_output=True, text=True, check=True)
    found = json.loads(ran.stdout)
    assert isinstance(found, dict)
    return found


def test_diagnosis(model_file: str, logs: list[str]) -> None:
    by_command = command("diagnose", model_file, *logs[:2], "--holdout", logs[2])
    diagnosis = hs.diagnose(hs.Model.load(model_file), logs[:2], holdout=logs[2]).to_dict()
    del by_command["closed_loop"]
    assert diagnosis == by_command


def test_log_check(model_file: str, logs: list[str]) -> None:
    by_command = command("log", "check", model_file, *logs)
    assert hs.log_check(hs.Model.load(model_file), logs).to_dict() == by_command


def test_init(logs: list[str]) -> None:
    by_command = command("init", logs[0], "--mass", "0.3", "--length", "0.25")
    assert hs.init(logs[0], mass_kg=[0.3], length_m=[0.25]).to_dict() == by_command


def test_drift(model_file: str, logs: list[str]) -> None:
    by_command = command("drift", model_file, *logs, "--free", "link1.com_m")
    model = hs.Model.load(model_file)
    assert hs.drift(model, logs, free="link1.com_m") == by_command


def test_effects() -> None:
    program = os.environ.get("HANDSTAND")
    if program is None:
        pytest.skip("the variable HANDSTAND does not name the program")
    ran = subprocess.run([program, "effects", "--json"], capture_output=True, text=True, check=True)
    assert hs.effects() == json.loads(ran.stdout)


def test_next(model_file: str, logs: list[str]) -> None:
    words = ("--value", "link1.com_m", "--seconds", "5")
    by_command = command("next", model_file, *logs, *words)["proposal"]
    found = hs.next(hs.Model.load(model_file), logs, value="link1.com_m", seconds=5.0)
    assert found.to_dict()["proposal"] == by_command


def test_comparison(model_file: str, logs: list[str]) -> None:
    by_command = command("compare", model_file, *logs)
    comparison = hs.compare(hs.Model.load(model_file), logs).to_dict()
    # They differ in what made them alone.
    for report in (by_command, comparison):
        assert isinstance(report["provenance"], dict)
        del report["provenance"]["command"]
        del report["title"]
    assert comparison == by_command


def test_gains() -> None:
    by_command = command("gains", str(HANDSTAND))
    found = hs.gains(hs.Model.load(HANDSTAND)).to_dict()
    del by_command["provenance"], found["provenance"]
    assert found == by_command
