"""Studies that ask something of their runs, in the words of study files."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import SHEAR
from test_distributed import SLIDING

from concio import InputError, Study, Uniform, Wall


def pulse(shape: str) -> dict[str, Any]:
    return {"pulse": {"shape": shape, "acceleration": "0.5 g", "duration": "0.2 s"}}


@pytest.fixture
def bonded() -> Wall:
    bond = {"tensile_strength": "5 kPa", "cohesion": "8 kPa"}
    return Wall.from_str(SHEAR).replace({"joint.bond": bond})


def test_the_capacity_of_a_sliding_block(tmp_path: Path) -> None:
    """A rigid block on dry friction under a rectangular pulse of a and T slides (a − μg) T²/2 · a/(μg)."""
    ida = {
        "damage": "largest_slip",
        "limits": [{"name": "2 cm", "value": "20 mm"}],
        "collapse": "0.3 m",
        "hunt": {"first": "0.15 g", "step": "0.15 g", "most": "2 g", "runs": 12, "resolution": 0.02},
    }
    study = Study(Wall.from_str(SLIDING), motions={"rectangle": pulse("rectangular")}, ida=ida)
    rows = study.run(tmp_path)
    friction, time, slip = 0.2 * 9.81, 0.2, 0.02
    strength = 0.5 * (friction + np.sqrt(friction**2 + 8 * slip * friction / time**2))
    (capacity,) = rows.tables["capacities"]
    # The runs beside it lie within the resolution.
    assert capacity["2 cm from"] < strength < capacity["2 cm to"] < 1.02 * capacity["2 cm from"]
    # So steep a curve has its capacity in the middle of both, at most half of that off.
    assert capacity["2 cm"] == pytest.approx(strength, rel=0.01)
    assert {"fragility", "fractiles", "fragility_curves"} <= set(rows.tables)
    assert len(rows) == 12 and rows.units["PGA"] == "m/s²"


QUESTIONS: list[tuple[str, dict[str, Any], str]] = [
    (
        "ida",
        {"damage": "largest_slip", "limits": [{"name": "s", "value": "1 mm"}], "intensities": ["0.2 g", "0.4 g"]},
        "ida",
    ),
    ("first_crack", {}, "first-crack"),
    ("first_crack", {"criterion": "slip", "limit": "1 mm", "checks": 0}, "first-crack"),
    ("cracks", {"criterion": "slip"}, "cracks"),
    ("ranking", {"by": ["slip"], "listed": 3}, "ranking"),
    ("sensitivity", {"of": ["largest_slip"]}, "sensitivity"),
]


@pytest.mark.parametrize(("name", "asked", "table"), QUESTIONS)
def test_questions_are_those_of_study_files(
    tmp_path: Path,
    bonded: Wall,
    command: Callable[..., Any],
    capfd: pytest.CaptureFixture[str],
    name: str,
    asked: dict[str, Any],
    table: str,
) -> None:
    motions = {"half sine": pulse("half-sine"), "rectangle": pulse("rectangular")}
    question: dict[str, Any] = {name: asked}
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        rows = Study(bonded, motions=motions, **question).run(tmp_path / "python")
        assert rows.done and len(rows) > 0 and table in rows.tables and len(rows.tables[table]) > 0
    assert capfd.readouterr() == ("", "")
    told = command("study", "run", tmp_path / "python/study.json", "--out", tmp_path / "typed")
    assert told.returncode == 0, told.stderr
    # What the command says of its runs is told, in its words.
    warned = {line.removeprefix("warning: ") for line in told.stderr.splitlines() if line.startswith("warning: in ")}
    assert {str(warning.message) for warning in caught} == warned
    tables = {path.stem: path.read_bytes() for path in (tmp_path / "typed").glob("*.csv")}
    assert tables == {path.stem: path.read_bytes() for path in (tmp_path / "python").glob("*.csv")}
    assert set(rows.tables) == set(tables)


def test_a_wall_that_does_not_crack_has_its_table(tmp_path: Path, bonded: Wall) -> None:
    strong = bonded.replace({"joint.bond": {"tensile_strength": "5000 MPa", "cohesion": "8000 MPa"}})
    with pytest.warns(UserWarning, match=", more than ") as told:
        rows = Study(strong, motions={"A": pulse("half-sine")}, first_crack={}).run(tmp_path)
    assert {warning.filename for warning in told} == {__file__}
    (row,) = rows.tables["first-crack"]
    # The command says by its status that no crack was found up to the largest scale.
    assert row["motion"] == "A" and row["scale"] is None and row["scale_below"] > 1


def test_tables_of_earlier_questions_are_not_shown(tmp_path: Path, bonded: Wall) -> None:
    factors = {"joint.friction.static": Uniform(0.4, 0.6)}
    design = partial(Study, bonded, factors, design="random", runs=6)
    first = design(sensitivity={"of": ["largest_slip"]}).run(tmp_path)
    assert set(first.tables) == {"runs", "sensitivity"}
    second = design().run(tmp_path)
    assert set(second.tables) == {"runs"} and second["id"].tolist() == first["id"].tolist()
    assert second.tables["runs"].units["peak_displacement"] == "m"


def test_wrong_questions_are_told_before_anything_runs(tmp_path: Path, bonded: Wall) -> None:
    hunt = {"first": "0.1 g", "step": "0.1 g", "most": "1 g"}
    questions: list[tuple[dict[str, Any], str]] = [
        ({"sensitivity": {"of": ["slip"]}}, "sensitivity.of[0]"),
        ({"ida": {"damage": "largest_slip", "limits": [], "hunt": hunt}}, "ida.limits"),
        ({"ida": {"damage": "slip", "limits": [{"name": "s", "value": 1}], "hunt": hunt}}, "ida.damage"),
        ({"ida": {"damage": "peak_over_d0", "limits": [{"name": "s", "value": 1}], "hunt": hunt}}, "ida.damage"),
        ({"first_crack": {"criterium": "bond"}}, "first-crack.criterium"),
        ({"first_crack": {}, "ranking": {}}, "ranking"),
        ({"ranking": {"by": ["slips"]}}, "ranking.by[0]"),
        ({"cracks": {"threshold": 2}}, "cracks.threshold"),
    ]
    for question, key in questions:
        with pytest.raises(InputError) as caught:
            Study(bonded, motions={"A": pulse("half-sine")}, **question).run(tmp_path)
        assert caught.value.key == key
        if key == "ida.damage":
            # The measures that a wall of the shear model has.
            allowed = (caught.value.allowed or "").split(", ")
            assert "largest_slip" in allowed and not {"peak_over_d0", "beyond_d0"} & set(allowed)
        assert not list(tmp_path.glob("runs/*.jsonl"))
