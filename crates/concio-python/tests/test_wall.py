from __future__ import annotations

import pickle
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import PLANAR, SHEAR

import concio
from concio import InputError, Record, Wall

ROOT = Path(__file__).parents[3]


def test_a_file_a_text_and_a_dict_say_the_same(tmp_path: Path, planar: Wall) -> None:
    path = tmp_path / "wall.toml"
    path.write_text(PLANAR)
    assert Wall.from_toml(path) == planar == Wall.from_dict(planar.settings)
    assert Wall.from_dict(planar.given) == planar and "solver" not in planar.given
    assert Wall.from_toml(path).path == str(path) and planar.path is None


def test_examples_are_those_of_the_folder() -> None:
    files = [path for path in sorted((ROOT / "examples").glob("*.toml"))]
    assert [path.stem.split("-", 1)[1] for path in files] == Wall.examples()
    for name, path in zip(Wall.examples(), files, strict=True):
        assert Wall.example(name) == Wall.from_toml(path)
    with pytest.raises(InputError, match="first-wall"):
        Wall.example("last-wall")


def test_replacing_makes_another_wall(planar: Wall) -> None:
    other = planar.replace({"joint.friction.static": np.float64(0.7), "load.top": "60 kN/m", "panel[0].courses": 5})
    assert other.settings["joint"]["friction"]["static"] == 0.7
    assert other.settings["load"]["top"] == 60e3
    assert len(other.blocks) > len(planar.blocks)
    assert planar.settings["joint"]["friction"]["static"] == 0.4
    assert planar.replace({}) == planar


def test_a_record_may_stand_in_the_wall(planar: Wall, quake: Record, quake_file: Path) -> None:
    record = Record.read(quake_file).scaled(0.5)
    inside = planar.replace({"motion.base": record, "motion.duration": record.duration})
    assert inside.given["motion"]["base"] == {"record": str(quake_file), "scale": 0.5}
    np.testing.assert_array_equal(inside.run()["top/displacement"], planar.run(record)["top/displacement"])
    with pytest.raises(InputError, match=r"record\.save") as caught:
        planar.replace({"motion.base": quake})
    assert caught.value.key == "motion.base"


def test_quantities_with_units_of_their_own(planar: Wall) -> None:
    pint = pytest.importorskip("pint")
    unit = pint.UnitRegistry()
    other = planar.replace({"load.top": 60 * unit.kN / unit.m, "panel[0].brick.height": 55 * unit.mm})
    assert other.settings["load"]["top"] == 60e3
    assert other.settings["panel"][0]["brick"]["height"] == 0.055
    spring = {"joint.bed": {"law": "elastic", "stiffness": 36 * unit.N / unit.mm**3}}
    assert planar.replace(spring).settings["joint"]["bed"]["stiffness"] == "36000000000 N/m3"
    with pytest.raises(InputError, match="force per length"):
        planar.replace({"load.top": 60 * unit.kg})


def test_a_mistake_in_a_file_is_told_with_its_place(tmp_path: Path) -> None:
    path = tmp_path / "wall.toml"
    path.write_text(PLANAR.replace("static = 0.4", "static = -0.4"))
    with pytest.raises(InputError) as caught:
        Wall.from_toml(path)
    error = caught.value
    assert isinstance(error, ValueError)
    line = 1 + PLANAR.splitlines().index('friction = { law = "coulomb", static = 0.4, on = "all" }')
    assert (error.key, error.file, error.line) == ("joint.friction.static", str(path), line)
    assert error.allowed is not None and "-0.4" in error.what
    assert str(error).startswith(f"{path}:{line}:")
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.key, again.line) == (str(error), error.key, line)


def test_all_mistakes_are_told_at_once() -> None:
    wrong = PLANAR.replace("static = 0.4", "static = -0.4").replace('top = "2 kN/m"', 'top = "-2 kN/m"')
    with pytest.raises(InputError) as caught:
        Wall.from_str(wrong)
    assert {caught.value.key, *(error.key for error in caught.value.more)} >= {"joint.friction.static", "load.top"}


def test_a_dict_has_no_lines() -> None:
    with pytest.raises(InputError) as caught:
        Wall.from_dict({"model": "planar", "panl": []})
    assert (caught.value.file, caught.value.line) == (None, None)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("joint.frction.static", 1),
        ("panel[7].courses", 1),
        ("load.top", "60 kg"),
        ("load.top", float("nan")),
        ("load.top", object()),
        ("", 1),
    ],
)
def test_changes_that_no_wall_file_knows(planar: Wall, key: str, value: object) -> None:
    with pytest.raises(InputError):
        planar.replace({key: value})


def test_files_that_are_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        Wall.from_toml(tmp_path / "none.toml")


def test_blocks_of_arrays_are_the_arch_of_the_examples() -> None:
    arch = Wall.example("arch")
    given = arch.given
    radii, angles = np.array([1.5, 1.75]), np.linspace(np.pi, 0, 22)
    # Inner and outer end of the radial joints, the springing at the height of the base to the bit.
    ends = np.stack([1.75 + np.outer(np.cos(angles), radii), np.outer(np.sin(angles), radii)], axis=-1)
    ends[[0, -1], :, 1] = 0
    blocks = [np.concatenate([ends[k], ends[k + 1, ::-1]]) for k in range(21)]
    settings = {key: given[key] for key in ("joint", "motion", "output", "title")}
    wall = Wall.from_blocks(blocks, brick=given["panel"][0]["brick"], **settings)
    laid = wall.blocks.take([wall.blocks["name"].tolist().index(f"b{k}") for k in range(1, 22)])
    for name in ("x", "y", "mass"):
        np.testing.assert_allclose(laid[name], arch.blocks[name], rtol=1e-12)
    assert len(wall.joints) == len(arch.joints) == 22
    assert wall.limit().multiplier == pytest.approx(arch.limit().multiplier, rel=1e-9)


def test_blocks_of_arrays_are_a_running_bond(planar: Wall) -> None:
    corners = dict(zip(planar.blocks["name"], map(np.array, planar.blocks["corners"]), strict=True))
    given = planar.given
    (panel,) = given.pop("panel")
    wall = Wall.from_blocks(corners, brick=panel["brick"], mortar=panel["mortar"], **given)
    assert wall.blocks["name"].tolist() == planar.blocks["name"].tolist()
    assert wall.blocks["course"].tolist() == planar.blocks["course"].tolist()
    assert wall.joints["name"].tolist() == planar.joints["name"].tolist()
    run, laid = wall.run(), planar.run()
    np.testing.assert_allclose(run["top/displacement"], laid["top/displacement"], rtol=0, atol=1e-12)
    # In another order, given clockwise.
    other = Wall.from_blocks(
        {name: corners[name][::-1] for name in reversed(corners)}, brick=panel["brick"], mortar=panel["mortar"], **given
    )
    assert sorted(other.blocks["name"]) == sorted(corners) and len(other.joints) == len(wall.joints)


@pytest.mark.parametrize(
    ("blocks", "key"),
    [
        ([[(0, 0), (1, 0), (1, 1)], [0, 0]], "panel[0].block[1].corners"),
        ([["a", "b"]], "panel[0].block[0].corners"),
        ([[(0, 0), (1, 0)]], "panel[0].block[0].corners"),
        ([[(0, 0), (1, 0), (0.5, 0.1), (0.5, 1)]], "panel[0].block[0].corners[2]"),
        ({"a b": [(0, 0), (1, 0), (1, 1)]}, "panel[0].block[0].id"),
        ([], "panel[0].block"),
    ],
)
def test_blocks_that_are_none(planar: Wall, blocks: Any, key: str) -> None:
    given = planar.given
    with pytest.raises(InputError) as caught:
        Wall.from_blocks(blocks, brick=given["panel"][0]["brick"], joint=given["joint"]).run(duration=0.01)
    assert caught.value.key == key and caught.value.file is None


def test_tables(planar: Wall) -> None:
    blocks, joints = planar.blocks, planar.joints
    # Two whole bricks, one and two halves, two whole bricks.
    assert list(blocks["name"]) == ["p1c1b1", "p1c1b2", "p1c2b1", "p1c2b2", "p1c2b3", "p1c3b1", "p1c3b2"]
    np.testing.assert_allclose(blocks["mass"].sum(), 3 * 0.5 * 0.055 * 0.12 * 18e3 / 9.81, rtol=1e-12)
    assert set(joints["kind"]) == {"bed", "head", "base"}
    assert [row["b"] for row in joints if row["kind"] == "base"] == ["base", "base"]
    assert blocks.nlargest(2, "y")["name"].tolist() == ["p1c3b1", "p1c3b2"]
    assert len(blocks.take(blocks["course"] == 2)) == 3
    with pytest.raises(KeyError, match="mass"):
        blocks["weight"]
    with pytest.raises(TypeError, match="take"):
        blocks[blocks["course"] == 2]
    with pytest.raises(ValueError, match="read-only"):
        blocks["mass"][0] = 0
    assert "p1c1b1" in repr(blocks) and "<td>p1c1b1</td>" in blocks._repr_html_()


def test_doubts() -> None:
    bare = Wall.from_str(SHEAR.replace('acceleration = "0.3 g"', "acceleration = 0.3")).check()
    assert [doubt.key for doubt in bare] == ["motion.base.sine.acceleration"]
    doubtful = Wall.from_str(PLANAR.replace('specific_weight = "18 kN/m3"', "specific_weight = 18"))
    (doubt,) = (d for d in doubtful.check() if "specific_weight" in d.text)
    assert (doubt.kind, doubt.key, doubt.line) == ("unlikely-number", "panel[0].brick.specific_weight", 8)
    assert "1 doubt: see check()" in repr(doubtful)


SPRUNG = """
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = { length = "0.5 m", height = "0.2 m", thickness = "0.5 m", specific_weight = "20 kN/m3" }
mortar = { bed = 0, head = 0 }
[joint]
bed = { law = "elastic", stiffness = "2 MN/m" }
head = { law = "none" }
[motion]
duration = "1 s"
"""


def test_the_first_period(tmp_path: Path, planar: Wall, command) -> None:  # type: ignore[no-untyped-def]
    """A block on a spring has T = 2π √(m/K)."""
    shear = Wall.from_str('model = "shear"\n' + SPRUNG)
    (mass,), (stiffness,) = shear.blocks["mass"], shear.joints["stiffness"]
    assert shear.first_period == pytest.approx(2 * np.pi * np.sqrt(mass / stiffness), rel=1e-9)
    # A planar one turns on its springs too, and is slower; it is what the command tells.
    (tmp_path / "wall.toml").write_text('model = "planar"\n' + SPRUNG)
    period = Wall.from_toml(tmp_path / "wall.toml").first_period
    told = re.search(r"first period +([\d.]+) ms", command("check", tmp_path / "wall.toml").stdout)
    assert period is not None and told is not None and period > (shear.first_period or 0)
    assert 1e3 * period == pytest.approx(float(told[1]), rel=5e-4)
    # Rigid joints have none, and what rocks has one for every amplitude.
    assert planar.first_period is None and Wall.example("rocking-facade").first_period is None


def test_a_wall_shows_itself(planar: Wall) -> None:
    # Blocks, and the load of 2 kN/m, which has mass.
    weight = 3 * 0.5 * 0.055 * 0.12 * 18 + 2 * 0.5
    assert repr(planar).splitlines() == [
        "Wall (planar): three courses",
        f"7 blocks, {len(planar.joints)} joints, {weight:.4g} kN",
        "runs 0.6 s",
    ]
    assert planar._repr_svg_().startswith("<svg") and "<svg" in planar._repr_html_()


def test_walls_go_to_other_processes(planar: Wall, tmp_path: Path) -> None:
    assert pickle.loads(pickle.dumps(planar)) == planar
    assert len({planar, pickle.loads(pickle.dumps(planar))}) == 1
    inside = Wall.from_str(PLANAR, folder=tmp_path)
    assert pickle.loads(pickle.dumps(inside))._case.folder == tmp_path


def test_the_version_is_that_of_the_engine(command) -> None:  # type: ignore[no-untyped-def]
    told = command("--version")
    assert told.stdout.split() == ["concio", concio.__version__]
    assert told.returncode == 0


def test_the_command_tells_what_is_wrong_by_its_status(command, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    assert command("run", tmp_path / "none.toml").returncode == 2
    assert command("rnu").returncode == 2
    assert "Usage" in command("run", "--help").stdout


def test_a_rocking_wall_is_followed_beyond_its_record(quake: Record) -> None:
    wall = Wall.example("rocking-facade")
    assert wall._moved(quake).duration == pytest.approx(quake.duration + 60)
    assert wall._moved(quake, 2.0).duration == pytest.approx(2.0)


def test_what_is_wrong_in_dicts_has_no_file(tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        Wall.from_dict({"model": "planar", "panel": []}, folder=tmp_path)
    assert caught.value.file is None and caught.value.line is None and caught.value.key is not None
    assert Wall.from_str(PLANAR, folder=tmp_path).path is None


@pytest.mark.parametrize("kind", ["text", "values"])
def test_records_of_a_wall_without_a_file_stay_where_they_are(
    kind: str, tmp_path: Path, quake_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    base = {"record": quake_file.name}
    monkeypatch.chdir(quake_file.parent)
    given = Wall.from_str(PLANAR).given
    given["motion"] = {"base": base, "duration": 0.1}
    wall = Wall.from_dict(given)
    if kind == "text":
        wall = Wall.from_str(
            PLANAR.split("[motion]")[0] + f'[motion]\nduration = 0.1\nbase = {{ record = "{quake_file.name}" }}\n'
        )
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert wall.run().ok and pickle.loads(pickle.dumps(wall)).run().ok
    quake_file.unlink()
    with pytest.raises(InputError) as caught:
        wall.replace({"motion.duration": 0.2}).run()
    # The wall is in no file, and none is named.
    assert caught.value.file == str(quake_file) and "wall.toml" not in str(caught.value)
    assert "named in the wall file as motion.base.record" in str(caught.value)


def test_a_value_that_is_not_finite_is_named(planar: Wall) -> None:
    for change in (
        lambda: planar.replace({"joint.friction.static": float("nan")}),
        lambda: planar.replace({"joint.friction": {"static": np.inf}}),
        lambda: planar.run(duration=float("nan")),
        lambda: Wall.from_dict({"panel": [{"courses": np.nan}]}),
    ):
        with pytest.raises(InputError) as caught:
            change()
        assert caught.value.key in ("joint.friction.static", "motion.duration", "panel[0].courses")
    with pytest.raises(InputError) as caught:
        planar.replace(None)  # type: ignore[arg-type]
    assert caught.value.key == "changes" and caught.value.allowed


def test_columns_are_asked_with_in_and_know_their_units(planar: Wall, shear: Wall) -> None:
    blocks = planar.blocks
    assert "mass" in blocks and "masses" not in blocks and 3 not in blocks
    assert next(iter(blocks)) in blocks and {"name": "none"} not in blocks
    for wall in (planar, shear):
        run = wall.run(duration=0.05)
        texts = {"name", "panel", "course", "kind", "a", "b", "law", "impacts", "top", "joint", "value", "unit"}
        for table in (wall.blocks, wall.joints, run.blocks, run.joints, run.drifts, run.events):
            assert set(table.keys()) - texts == set(table.units)
        assert run.joints.units["slip"] == "m" and run.joints.units["stiffness"] == "N/m"
        assert run.blocks.take([0]).units["mass"] == "kg"
