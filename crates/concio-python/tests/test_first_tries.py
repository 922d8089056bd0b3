"""What users of ObsPy, SALib, MuJoCo and pandas try first."""

from __future__ import annotations

import importlib
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import concio
from concio import Record, Study, Uniform, Wall


def other(name: str) -> Any:
    """Their own package, whatever it warns of when it is imported."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pytest.importorskip(name.partition(".")[0], exc_type=ImportError)
        return importlib.import_module(name)


def test_of_obspy(quake: Record, planar: Wall, quake_file: Path) -> None:
    trace = other("obspy").Trace(np.asarray(quake), header={"delta": quake.dt})
    record = Record.from_obspy(trace, units="m/s2")
    assert np.array_equal(record.acceleration, quake.acceleration) and record.duration == quake.duration
    part = record.trim("0.1 s", 0.5)
    assert len(part) < len(record) == len(quake)  # a copy
    assert (2 * record).pga == 2 * record.pga == (record * -2).pga
    other("matplotlib").use("Agg")
    assert record.plot().get_ylabel() == "acceleration [m/s²]"
    by_path = planar.run(quake_file, duration="0.2 s")
    assert np.array_equal(by_path["base/shear"], planar.run(Record.read(quake_file), duration="0.2 s")["base/shear"])


def test_of_salib(shear: Wall, tmp_path: Path) -> None:
    factors = {"joint.friction.static": Uniform(0.5, 0.8), "joint.damping_ratio": Uniform(0.02, 0.1)}
    study = Study(shear, factors, design="random", runs=2)
    problem = study.salib_problem
    samples = other("SALib.sample.sobol").sample(problem, 4, calc_second_order=False, seed=1)
    rows = study.at(samples).run(tmp_path)
    analyze = other("SALib.analyze.sobol").analyze
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # four points say nothing of its intervals
        indices = analyze(problem, rows["peak_displacement"], calc_second_order=False, seed=1)
    assert len(rows) == len(samples) and len(indices["ST"]) == 2


def test_of_mujoco(planar: Wall) -> None:
    simulation = planar.simulation()
    while simulation.time < 0.05:
        simulation.step()
    places = simulation.places
    simulation.push(0, x=100.0)
    simulation.step()
    simulation.reset()
    assert simulation.time == 0.0
    simulation.advance(to=0.05)
    assert np.array_equal(simulation.places, places)
    alike = concio.run_many([planar] * 3)
    assert all(np.array_equal(run["base/shear"], alike[0]["base/shear"]) for run in alike)


def test_of_pandas(planar: Wall, tmp_path: Path) -> None:
    pandas = other("pandas")
    run = planar.run()
    assert isinstance(run.to_frame(), pandas.DataFrame) and len(run.joints.frame.head()) == 5
    assert run.joints.frame.sort_values("slip")["slip"].iloc[-1] == run.joints["slip"].max()
