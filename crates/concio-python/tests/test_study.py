from __future__ import annotations

import os
import signal
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import PLANAR, SHEAR

import concio
from concio import InputError, LogNormal, Record, Rows, Study, Uniform, Wall


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


@pytest.mark.parametrize(
    ("question", "table"),
    [
        (
            {"ida": {"damage": "peak_drift", "intensities": [1.0, 6.0], "limits": [{"name": "1", "value": 1e-3}]}},
            "fragility",
        ),
        ({"ranking": {"by": ["slip"]}}, "ranking"),
    ],
)
def test_a_question(tmp_path: Path, planar: Wall, command, question: dict[str, Any], table: str) -> None:  # type: ignore[no-untyped-def]
    motions = {name: {"sine": {"acceleration": 2.0, "frequency": f}} for name, f in (("A", 3.0), ("B", 4.0))}
    rows = Study(planar, motions=motions, question=question).run(tmp_path / "here")
    study = tmp_path / "here" / "study.json"
    assert command("study", "run", study, "--out", tmp_path / "there").returncode == 0
    here, there = (tmp_path / folder / f"{table}.csv" for folder in ("here", "there"))
    assert rows.done and here.read_bytes() == there.read_bytes()
    found = Rows.read(here)
    assert len(found) > 0 and "[" not in "".join(found.keys())
    assert found.frame.attrs["units"] == found.units
    with pytest.raises(InputError, match="ranking"):
        Study(planar, question={"rankings": {}})


def test_motions_of_files(tmp_path: Path, planar: Wall, quake: Record, quake_file: Path) -> None:
    record = Record.read(quake_file).trim(0, 0.4).scaled(2)
    study = Study(planar, motions={"A": record, "B": {"sine": {"acceleration": "0.1 g", "frequency": 2}}})
    rows = study.run(tmp_path / "out")
    run = planar.run(base=record)
    assert rows["peak_displacement"][0] == run.summary["peak_relative_displacement"]
    with pytest.raises(InputError) as caught:
        Study(planar, motions={"A": quake})
    assert caught.value.key == "A"


def test_records_of_a_wall_keep_their_place(tmp_path: Path, quake_file: Path) -> None:
    text = PLANAR.replace('{ sine = { acceleration = "0.8 g", frequency = 3 } }', '{ record = "quake.csv" }')
    wall = Wall.from_str(text, folder=tmp_path)
    rows = Study(wall, {"load.top": [1e3]}).run(tmp_path / "elsewhere")
    assert rows["end"].tolist() == ["completed"]


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
