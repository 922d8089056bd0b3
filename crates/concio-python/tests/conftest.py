from __future__ import annotations

import subprocess
import sysconfig
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import concio

PLANAR = """
model = "planar"
title = "three courses"
[[panel]]
bond = "running"
courses = 3
bricks = 2
brick = { length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
mortar = { bed = 0, head = 0 }
[joint]
bed = { law = "rigid" }
head = { law = "rigid" }
friction = { law = "coulomb", static = 0.4, on = "all" }
[load]
top = "2 kN/m"
[motion]
base = { sine = { acceleration = "0.8 g", frequency = 3 } }
duration = "0.6 s"
[output]
blocks = ["all"]
"""

SHEAR = """
model = "shear"
set = "report"
[[panel]]
bond = "running"
courses = 4
bricks = 3
[motion]
duration = 0.3
base = { sine = { acceleration = "0.3 g", frequency = 5 } }
"""


@pytest.fixture(params=["planar", "shear"])
def wall(request: pytest.FixtureRequest) -> concio.Wall:
    return concio.Wall.from_str(PLANAR if request.param == "planar" else SHEAR)


@pytest.fixture
def planar() -> concio.Wall:
    return concio.Wall.from_str(PLANAR)


@pytest.fixture
def shear() -> concio.Wall:
    return concio.Wall.from_str(SHEAR)


@pytest.fixture(scope="session")
def quake() -> concio.Record:
    """A decaying sine of 2 Hz, 1 s at 5 ms."""
    t = np.arange(201) * 0.005
    return concio.Record.from_array(4.0 * np.exp(-t) * np.sin(4 * np.pi * t), dt=0.005)


@pytest.fixture
def quake_file(tmp_path: Path, quake: concio.Record) -> Path:
    path = tmp_path / "quake.csv"
    rows = [f"{k * quake.dt:.17g},{a:.17g}" for k, a in enumerate(quake.acceleration)]
    path.write_text("\n".join(["t [s],a [m/s2]", *rows]) + "\n")
    return path


@pytest.fixture(scope="session")
def command() -> Callable[..., subprocess.CompletedProcess[str]]:
    """The command that the wheel carries."""
    program = Path(sysconfig.get_path("scripts")) / "concio"
    return lambda *arguments: subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
