from __future__ import annotations

import os
import re
import signal
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import PLANAR, SHEAR

import concio
from concio import InputError, LogNormal, LogUniform, Normal, Record, Study, Triangular, Uniform, Wall


def test_rows_are_the_runs(tmp_path: Path, shear: Wall) -> None:
    rows = Study(shear, {"joint.friction.static": [0.5, 0.6, 0.7]}, scales=[1, 2]).run(tmp_path, threads=2)
    assert len(rows) == 6 and rows.done and rows.units["peak_displacement"] == "m"
    for row in rows:
        wall = shear.replace({"joint.friction.static": row["joint.friction.static"]})
        sine = wall.settings["motion"]["base"]["sine"]
        run = wall.run(base={"sine": {**sine, "acceleration": sine["acceleration"] * row["scale"]}}, duration=0.3)
        # A study samples less often, and peaks are taken at samples too.
        assert row["peak_displacement"] == pytest.approx(run.summary["peak_relative_displacement"], rel=1e-3)
    pytest.importorskip("pandas")
    assert rows.frame.attrs["units"]["peak_displacement"] == "m"


def test_a_study_is_checked_before_it_runs(tmp_path: Path, shear: Wall, command) -> None:  # type: ignore[no-untyped-def]
    doubtful = shear.replace({"panel[0].brick.specific_weight": 18})
    factors = {"load.top": Uniform("20 kN/m", "60 kN/m")}
    study = Study(doubtful, factors, design="random", runs=5, sensitivity={"of": ["largest_slip"]})
    runs, doubts = study.check()
    assert len(runs) == 5 and runs.units["load.top"] == "kN/m"
    assert any("specific_weight" in doubt and doubt.startswith("in every run") for doubt in doubts)
    rows = study.run(tmp_path)
    np.testing.assert_array_equal(runs["load.top"], rows["load.top"])
    told = command("study", "check", tmp_path / "study.json")
    assert told.returncode == 0 and re.search(r"^ +runs +5$", told.stdout, re.M)
    # The command adds where in the wall file it is.
    lines = [line.removeprefix("warning: ") for line in told.stderr.splitlines()]
    assert all(line.startswith(doubt) for line, doubt in zip(lines, doubts, strict=True))
    assert Study.from_toml(tmp_path / "study.json").check().doubts == doubts
    with pytest.raises(InputError) as caught:
        Study(shear, {"load.tip": [1, 2]}).check()
    assert caught.value.key == "vary[0].path" and caught.value.file is None


def test_a_study_goes_on_where_it_was(tmp_path: Path, planar: Wall) -> None:
    study = Study(planar, {"load.top": LogNormal("2 kN/m", 0.3)}, design="latin-hypercube", runs=8, seed=3)
    first = study.run(tmp_path / "whole")
    rows = (tmp_path / "whole").glob("*")
    before = {path: path.stat().st_mtime_ns for path in rows if path.suffix not in (".json",)}
    again = study.run(tmp_path / "whole")
    assert first["id"].tolist() == again["id"].tolist()
    assert before == {path: path.stat().st_mtime_ns for path in before}
    long = Study(planar.replace({"motion.duration": "400 s"}), {"load.top": [1e3, 2e3, 3e3, 4e3]})
    timer = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.warns(RuntimeWarning, match="goes on"):
        part = long.run(tmp_path / "part")
    timer.join()
    assert not part.done and "not run" in part["end"]


def test_the_command_line_knows_its_folder(tmp_path: Path, shear: Wall, command) -> None:  # type: ignore[no-untyped-def]
    rows = Study(shear, {"joint.friction.static": Uniform(0.5, 0.7)}, design="random", runs=3).run(tmp_path)
    told = command("study", "status", tmp_path / "study.json", "--out", tmp_path)
    assert told.returncode == 0, told.stderr
    assert told.stdout.split()[:4] == ["runs", "3", "completed", "3"]
    assert len(rows) == 3


def test_a_study_file(tmp_path: Path) -> None:
    (tmp_path / "wall.toml").write_text(SHEAR)
    (tmp_path / "study.toml").write_text(
        'wall = "wall.toml"\n[[vary]]\npath = "joint.friction.static"\nvalues = [0.5, 0.6]\n'
    )
    rows = Study.from_toml(tmp_path / "study.toml").run(tmp_path / "out")
    assert rows["joint.friction.static"].tolist() == [0.5, 0.6]


def test_motions_of_files(tmp_path: Path, planar: Wall, quake: Record, quake_file: Path) -> None:
    record = Record.read(quake_file).trim(0, 0.4).scaled(2)
    study = Study(planar, motions={"A": record, "B": {"sine": {"acceleration": "0.1 g", "frequency": 2}}})
    rows = study.run(tmp_path / "out")
    run = planar.run(base=record)
    assert rows["peak_displacement"][0] == run.summary["peak_relative_displacement"]
    with pytest.raises(InputError) as caught:
        Study(planar, motions={"A": quake})
    assert caught.value.key == "A" and "record.save" in (caught.value.help or "")
    rows = Study(planar, motions={"A": quake.save(tmp_path / "quake.txt")}).run(tmp_path / "saved")
    assert rows["peak_displacement"][0] == planar.run(base=quake).summary["peak_relative_displacement"]


def test_records_of_a_wall_keep_their_place(tmp_path: Path, quake_file: Path) -> None:
    text = PLANAR.replace('{ sine = { acceleration = "0.8 g", frequency = 3 } }', '{ record = "quake.csv" }')
    wall = Wall.from_str(text, folder=tmp_path)
    rows = Study(wall, {"load.top": [1e3]}).run(tmp_path / "elsewhere")
    assert rows["end"].tolist() == ["completed"]


def test_factors_in_the_words_of_study_files(tmp_path: Path, shear: Wall) -> None:
    follows = {"values": [0.4, 0.8], "also": [{"path": "joint.friction.dynamic", "times": 0.5}]}
    bricks = {"choices": [{"name": "long", "set": {"panel[0].brick.length": "300 mm"}}, {"name": "as it is"}]}
    rows = Study(shear, {"joint.friction.static": follows, "bricks": bricks}).run(tmp_path)
    assert rows["bricks"].tolist() == ["long", "as it is"] * 2
    for row in rows:
        friction = row["joint.friction.static"]
        wall = shear.replace({"joint.friction.static": friction, "joint.friction.dynamic": 0.5 * friction})
        wall = wall.replace({"panel[0].brick.length": 0.3} if row["bricks"] == "long" else {})
        # A study samples less often, and peaks are taken at samples too.
        assert row["peak_displacement"] == pytest.approx(wall.run().summary["peak_relative_displacement"], rel=1e-3)


def test_what_a_study_may_not_say(tmp_path: Path, planar: Wall) -> None:
    for study, key in [
        (Study(planar, {"joint.frction": [1]}), "vary[0].path"),
        (Study(planar, {"load.top": [1e3]}, design="gird"), "design.kind"),
        (Study(planar, {"load.top": Uniform(1, "2 kg")}, design="random", runs=2), None),
        (Study(planar, {"load.top": [1e3]}, scales=[-1]), "scales[0]"),
    ]:
        with pytest.raises(InputError) as caught:
            study.run(tmp_path)
        assert key is None or caught.value.key == key
    with pytest.raises(InputError):
        Study(planar, {"load.top": 1e3})
    with pytest.raises(InputError):
        Study(planar, {"load.top": [1e3]}).run(tmp_path, threads=-1)


def test_what_a_file_leaves_out_follows_what_varies(tmp_path: Path, planar: Wall) -> None:
    """The file gives Coulomb's law one coefficient: the other one follows it, below and above."""
    rows = Study(planar, {"joint.friction.static": [0.2, 0.8]}).run(tmp_path)
    for row in rows:
        run = planar.replace({"joint.friction.static": row["joint.friction.static"]}).run()
        assert row["peak_displacement"] == pytest.approx(run.summary["peak_relative_displacement"], rel=1e-3)


def test_a_run_that_fails_says_why(tmp_path: Path, planar: Wall) -> None:
    rows = concio.Study(planar, {"motion.duration": [0.1, 0.2]}).run(tmp_path)
    assert np.isnan(rows["peak_displacement"]).sum() == 0 and rows["cause"].tolist() == [None, None]


def test_indices_are_those_of_salib(tmp_path: Path, shear: Wall) -> None:
    sobol, morris = (pytest.importorskip(f"SALib.analyze.{name}") for name in ("sobol", "morris"))
    factors = {"joint.friction.static": Uniform(0.45, 0.75), "motion.base.sine.acceleration": Uniform("0.2 g", "0.4 g")}
    asked = {"of": ["friction_energy", "peak_displacement"]}
    study = Study(shear, factors, design="sobol", runs=32, sensitivity=asked)
    rows = study.run(tmp_path / "sobol")
    found = rows.tables["sensitivity"]
    assert found["factor"].tolist() == 2 * study.salib_problem["names"] and len(rows) == 32 * 4
    for place, measure in enumerate(asked["of"]):
        # Base points A, then B, then A with a column of B each; SALib has all of a base point together.
        a, b, *mixed = rows[measure].reshape(4, 32)
        peer = sobol.analyze(study.salib_problem, np.column_stack([a, *mixed, b]).ravel(), False, seed=1)
        own = found.take(slice(2 * place, 2 * place + 2))
        assert set(own["measure"]) == {measure}
        # The same sums in another order: 128 terms, whose rounding is far below 1e-12.
        np.testing.assert_allclose(own["total"], peer["ST"], rtol=1e-9)
        # SALib takes the mean of all runs from the values of B, here it is that of the base points.
        shift = rows[measure].mean() - np.mean([a, b])
        first = peer["S1"] + shift * np.mean(np.array(mixed) - a, axis=1) / np.var([a, b])
        np.testing.assert_allclose(own["first_order"], first, rtol=1e-9, atol=1e-12)
    study = Study(shear, factors, design="morris", runs=6, levels=6, sensitivity=asked)
    rows = study.run(tmp_path / "morris")
    drawn = np.column_stack([rows[name] for name in study.salib_problem["names"]])
    peer = morris.analyze(study.salib_problem, drawn, rows["friction_energy"], num_levels=6, seed=1)
    own = rows.tables["sensitivity"].take(slice(0, 2))
    for name in ("mu", "mu_star", "sigma"):
        np.testing.assert_allclose(own[name], np.array(peer[name]), rtol=1e-9)


def test_laws_are_those_of_salib(tmp_path: Path, shear: Wall) -> None:
    util = pytest.importorskip("SALib.util")
    # A value per layer of a Latin hypercube: it lies between the quantiles of the ends of its layer.
    runs = 40
    factors = {
        "load.top": LogNormal("12 kN/m", 0.3),
        "panel[0].brick.height": Triangular("50mm", "52 mm", "60 mm"),
        "panel[0].brick.thickness": Normal("0.12 m", "0.01 m"),
        "joint.friction.static": Normal(0.6, 0.05, low=0.55),
        "joint.damping_ratio": LogUniform(0.01, 0.1),
        "panel[0].brick.length": Uniform("240 mm", "260 mm"),
    }
    quick = shear.replace({"motion.duration": 0.01})
    study = Study(quick, factors, design="latin-hypercube", runs=runs)
    rows = study.run(tmp_path)
    assert rows.done and rows.units["panel[0].brick.height"] == "mm"
    problem = study.salib_problem
    assert problem["dists"] == ["lognorm", "triang", "norm", "truncnorm", "logunif", "unif"]
    ends = np.repeat(np.clip(np.arange(runs + 1) / runs, 1e-9, 1 - 1e-9)[:, None], len(factors), axis=1)
    quantiles = util.scale_samples(ends, problem)
    drawn = np.sort(np.column_stack([rows[name] for name in problem["names"]]), axis=0)
    # Quantiles of both are good to some 1e-12.
    assert (quantiles[:-1] <= drawn * (1 + 1e-9)).all() and (drawn <= quantiles[1:] * (1 + 1e-9)).all()


def test_samples_of_other_programs(tmp_path: Path, shear: Wall) -> None:
    factors = {"joint.friction.static": Uniform(0.45, 0.75), "panel[0].brick.height": Uniform("50 mm", "60 mm")}
    study = Study(shear, factors, design="sobol", runs=8, keep=["slip"])
    samples = [[0.5, 55.0], [0.7, 52.0], [0.5, 55.0]]
    rows = study.at(samples).run(tmp_path / "out")
    assert rows["sample"].tolist() == ["1", "2", "3"] and rows["id"][0] == rows["id"][2] != rows["id"][1]
    for (friction, height), row in zip(samples, rows, strict=True):
        wall = shear.replace({"joint.friction.static": friction, "panel[0].brick.height": height / 1e3})
        # A study samples less often, and peaks are taken at samples too.
        assert row["peak_displacement"] == pytest.approx(wall.run().summary["peak_relative_displacement"], rel=1e-3)
    (tmp_path / "wall.toml").write_text(SHEAR)
    (tmp_path / "study.toml").write_text(
        """wall = "wall.toml"
        design = { kind = "random", runs = 2 }
        [[vary]]
        name = "height"
        path = "panel[0].brick.height"
        from = "50 mm"
        to = "60 mm"
        spacing = "log"
        also = [{ path = "panel[0].brick.length", times = 4.0 }]
        """
    )
    of_file = Study.from_toml(tmp_path / "study.toml")
    assert of_file.salib_problem == {
        "num_vars": 1,
        "names": ["height"],
        "bounds": [[50.0, 60.0]],
        "dists": ["logunif"],
    }
    (row,) = of_file.at([[55.0]]).run(tmp_path / "file")
    wall = shear.replace({"panel[0].brick.height": 0.055, "panel[0].brick.length": 0.22})
    assert row["peak_displacement"] == pytest.approx(wall.run().summary["peak_relative_displacement"], rel=1e-3)
    (tmp_path / "study.toml").write_text("[[")
    with pytest.raises(InputError, match="neither JSON nor TOML"):
        _ = of_file.salib_problem
    for wrong in ([0.5, 55.0], [[0.5]], "x", np.empty((0, 2))):
        with pytest.raises(InputError) as caught:
            study.at(wrong)
        assert caught.value.key == "samples"


def test_what_salib_has_no_words_for(shear: Wall) -> None:
    friction = "joint.friction.static"
    sine = {"sine": {"acceleration": "0.1 g", "frequency": 2}}
    for study, key in [
        (Study(shear, {friction: [0.5, 0.6]}), "vary[0]"),
        (Study(shear, {friction: LogNormal(0.6, 0.1, high=0.8)}), "vary[0]"),
        (Study(shear, {"load.top": Uniform(0, "2 kN/m")}), "vary[0]"),
        (Study(shear, {friction: Uniform(0.5, 0.6)}, scales=[1, 2]), "scales"),
        (Study(shear, {friction: Uniform(0.5, 0.6)}, motions={"A": sine}), "motion"),
        (Study(shear), "vary"),
    ]:
        with pytest.raises(InputError) as caught:
            _ = study.salib_problem
        assert caught.value.key == key
        with pytest.raises(InputError):
            study.at([[0.5]])


def test_a_study_writes_over_no_file_of_another(tmp_path: Path, shear: Wall) -> None:
    (tmp_path / "study.json").write_text("{}")
    with pytest.raises(InputError, match="no study was run"):
        Study(shear, {"joint.friction.static": [0.5, 0.6]}).run(tmp_path)
    assert (tmp_path / "study.json").read_text() == "{}" and not (tmp_path / "wall.json").exists()


def test_motions_are_records_and_paths_of_records(tmp_path: Path, quake_file: Path) -> None:
    (tmp_path / "wall.toml").write_text(SHEAR)
    wall = Wall.from_toml(tmp_path / "wall.toml")
    motions: list[Any] = [{"record": quake_file.name}, quake_file, Record.read(quake_file)]
    for number, motion in enumerate(motions):
        rows = Study(wall, motions={"A": motion}, scales=[0.5]).run(tmp_path / str(number))
        assert rows.done and len(rows) == 1


def test_a_refused_study_leaves_its_folder_as_it_was(tmp_path: Path, shear: Wall) -> None:
    def study(runs: int) -> Study:
        return Study(shear, {"joint.friction.static": Uniform(0.5, 0.6)}, design="random", runs=runs)

    assert study(2).run(tmp_path / "good").done
    before = (tmp_path / "good/study.json").read_text()
    for folder in ("good", "new"):
        with pytest.raises(InputError):
            study(0).run(tmp_path / folder)
    assert (tmp_path / "good/study.json").read_text() == before and not list((tmp_path / "new").glob("*.json"))


def test_tables_are_those_of_their_rows(tmp_path: Path, shear: Wall) -> None:
    asked: dict[str, Any] = {"sensitivity": {"of": ["peak_displacement"]}, "design": "latin-hypercube", "runs": 6}
    first = Study(shear, {"joint.friction.static": Uniform(0.5, 0.6)}, **asked).run(tmp_path)
    Study(shear, {"joint.damping_ratio": Uniform(0.02, 0.1)}, **asked).run(tmp_path)
    with pytest.raises(InputError, match="another study"):
        first.tables["sensitivity"]


def test_bounds_without_a_unit_are_refused(shear: Wall) -> None:
    with pytest.raises(InputError, match="'20' has no unit"):
        Study(shear, {"load.top": Uniform("20", "60 kN/m")})


@pytest.mark.parametrize("scales", [2, "2"])
def test_scales_are_a_list(shear: Wall, scales: Any) -> None:
    with pytest.raises(InputError) as caught:
        Study(shear, scales=scales)
    assert caught.value.key == "scales" and caught.value.allowed
