"""The stubs say what the module has."""

import subprocess
import sys


def test_stubs_and_module_agree() -> None:
    words = [sys.executable, "-m", "mypy.stubtest", "handstand"]
    ran = subprocess.run(words, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stdout + ran.stderr
