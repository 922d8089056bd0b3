from __future__ import annotations

import json
import os
from html import escape
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

import concio
from concio import InputError, Limit, Mechanisms, Wall

BLOCK = """
model = "planar"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = { length = "0.4 m", height = "1 m", thickness = "0.5 m", specific_weight = "20 kN/m3" }
mortar = { bed = 0, head = 0 }
[joint]
bed = { law = "rigid" }
head = { law = "none" }
friction = { law = "coulomb", static = MU }
[motion]
duration = "1 s"
"""


@pytest.mark.parametrize(("mu", "multiplier", "kind"), [(0.3, 0.3, "sliding"), (0.9, 0.4, "overturning")])
def test_a_block_slides_at_mu_or_turns_over_at_its_slenderness(mu: float, multiplier: float, kind: str) -> None:
    limit = Wall.from_str(BLOCK.replace("MU", str(mu))).limit(towards="left")
    assert limit.multiplier == pytest.approx(multiplier, rel=1e-6)
    # Bounds meet but for rounding.
    assert limit.bounds == pytest.approx((multiplier, multiplier), rel=1e-6) and limit.certified
    assert limit.mechanism.kind == kind and limit.towards == "left"
    assert limit.mechanism.blocks["name"].tolist() == ["p1c1b1"]
    assert limit.forces["normal"].sum() == pytest.approx(4e3, rel=1e-6)


def test_it_is_what_the_command_line_prints(tmp_path: Path, command) -> None:  # type: ignore[no-untyped-def]
    path = tmp_path / "wall.toml"
    path.write_text(BLOCK.replace("MU", "0.3"))
    wall = Wall.from_toml(path)
    for asked, options in [
        (wall.limit(load="top", heads="frictionless").result, ["limit", "--load", "top", "--heads", "frictionless"]),
        (wall.limit(out_of_plane=True, above="0.2 m").result, ["limit", "--out-of-plane", "--above", "0.2m"]),
        (wall.mechanisms(overlaps="code").result, ["mechanisms", "--overlaps", "code"]),
    ]:
        told = command(options[0], path, *options[1:], "--json")
        assert told.returncode in (0, 1), told.stderr
        assert asked == json.loads(told.stdout)


def test_mechanisms_are_drawn() -> None:
    wall = Wall.from_str(BLOCK.replace("MU", "0.3"))
    answers: list[Limit | Mechanisms] = [wall.limit(towards="left"), wall.limit(towards="right")]
    answers += [wall.limit(out_of_plane=True), wall.mechanisms()]
    for answer in answers:
        drawing = answer.drawing or ""
        assert ElementTree.fromstring(drawing).tag.endswith("svg")
        assert answer._repr_svg_() == drawing and drawing in answer._repr_html_()
        assert all(escape(line) in answer._repr_html_() for line in repr(answer).splitlines())
    assert len({answer.drawing for answer in answers}) == len(answers)


def test_words_that_limit_analysis_does_not_know(tmp_path: Path) -> None:
    wall = Wall.from_str(BLOCK.replace("MU", "0.3"))
    with pytest.raises(InputError) as caught:
        wall.limit(towards="up")
    assert caught.value.key == "towards" and "left" in (caught.value.allowed or "")
    with pytest.raises(InputError) as caught:
        wall.limit(out_of_plane=True, above="1 kg")
    assert caught.value.key == "above" and caught.value.file is None
    for words in ({"above": "1 m"}, {"above": 1.0}, {"even_twist": True}, {"without_dilation": True}):
        with pytest.raises(InputError, match="out_of_plane=True") as caught:
            wall.limit(**words)
        assert caught.value.key == next(iter(words))
    with pytest.raises(InputError):
        Wall.from_str(BLOCK.replace("MU", "0.3")).limit(towards="outwards")


def test_numbers_are_si_where_the_command_line_wants_a_unit() -> None:
    wall = Wall.from_str(BLOCK.replace("MU", "0.3"))
    for number, text in ((0.2, "200 mm"), (np.float64(0.2), "0.2 m")):
        asked = [wall.limit(out_of_plane=True, above=above).result for above in (number, text)]
        assert asked[0] == asked[1]
    panel = Wall.example("bonded-joints")
    with_numbers = panel.continuum(brick_modulus=8e9, brick_poisson=0.1, pressure=200000).panels
    assert with_numbers == panel.continuum(brick_modulus="8 GPa", brick_poisson=0.1, pressure="0.2 MPa").panels
    assert with_numbers != panel.continuum(brick_modulus="9 GPa", brick_poisson=0.1, pressure="0.3 MPa").panels


def test_the_continuum_of_a_running_bond() -> None:
    wall = Wall.example("bonded-joints")
    found = wall.continuum()
    assert len(found.panels) == 1 and found.panels[0]["bond"]
    assert isinstance(json.loads(found.card("json")), dict)
    assert "*ELASTIC" in found.card("lamina", units="N-mm")
    with pytest.raises(InputError) as caught:
        wall.continuum(panel="none")
    assert "p1" in (caught.value.allowed or "")


def test_what_falls_out_of_the_plane() -> None:
    found = Wall.from_str(BLOCK.replace("MU", "0.6")).mechanisms()
    assert found.least is not None
    # A free-standing wall of thickness t and height h turns over at t/h.
    assert found.least["multiplier"] == pytest.approx(0.5, rel=1e-6)
    assert len(found.table) >= 1 and found.limits and "upper bound" in repr(found)


@pytest.mark.skipif("CONCIO_SHARED" not in os.environ, reason="CONCIO_SHARED names no folder of records")
def test_records_of_the_archives_have_the_measures_of_the_manifest() -> None:
    folder = Path(os.environ["CONCIO_SHARED"]) / "records"
    files = [path for path in sorted(folder.rglob("*")) if path.suffix.lower() in (".at2", ".asc")]
    assert files
    for path in files:
        record = concio.Record.read(path)
        assert record.pga > 0 and record.facts["format"] != "text"


@pytest.mark.parametrize(
    ("given", "key", "what"),
    [
        ({"scale": 2.0}, "record or shaken", "needs it"),
        ({"restitution": 0.5}, "record or shaken", "needs it"),
        ({"pga": "0.3 g"}, "record", "needs it"),
        ({"vertical": "up.csv"}, "record", "needs it"),
        ({"record": "a.csv", "shaken": True}, "record", "cannot be given with shaken"),
        ({"record": "a.csv", "scale": 2.0, "pga": "0.3 g"}, "pga", "cannot be given with scale"),
        ({"overlaps": "none"}, "overlaps", "is not allowed"),
    ],
)
def test_arguments_that_do_not_suit_each_other_are_named(given: dict[str, Any], key: str, what: str) -> None:
    with pytest.raises(InputError, match=what) as caught:
        Wall.from_str(BLOCK.replace("MU", "0.6")).mechanisms(**given)
    assert caught.value.key == key and "--" not in str(caught.value) and "Usage" not in str(caught.value)


def test_options_are_told_as_keywords() -> None:
    wall = Wall.from_str(BLOCK.replace("MU", "0.6"))
    with pytest.raises(InputError) as caught:
        wall.limit(out_of_plane=True, heads="frictionless")
    assert "--" not in str(caught.value) and "out_of_plane" in str(caught.value)
