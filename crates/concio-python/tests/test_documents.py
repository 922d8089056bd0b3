from __future__ import annotations

import re
from pathlib import Path

import pytest
from conftest import PLANAR

import concio

ROOT = Path(__file__).parents[3]


def blocks(page: str) -> list[str]:
    return re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), flags=re.DOTALL)


def test_the_site_has_a_place_for_every_name() -> None:
    pages = [path.read_text() for path in (ROOT / "xtask/site/python").glob("*.rst")]
    shown = [
        name for page in pages for name in re.findall(r"^\.\. auto(?:class|exception|function):: (\w+)$", page, re.M)
    ]
    assert sorted(shown) == sorted(name for name in concio.__all__ if name != "__version__")


def test_what_the_readme_shows_runs(
    tmp_path: Path, quake: concio.Record, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("matplotlib").use("Agg")
    (code,) = blocks("README.md")
    (tmp_path / "wall.toml").write_text(PLANAR)
    rows = "\n".join(f"{k * quake.dt:.17g},{a:.17g}" for k, a in enumerate(quake.acceleration))
    (tmp_path / "quake.at2").write_text(f"t [s],a [m/s2]\n{rows}\n")
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    exec(code, names)
    assert isinstance(names["run"], concio.Run) and names["run"].ok
    assert "energy account" in capsys.readouterr().out


def test_what_the_guide_shows_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("distributed")
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {"__name__": "__main__"}
    for code in blocks("docs/guide/14-python.md"):
        exec(code, names)
    said = capsys.readouterr().out
    assert "joint.friction.static" in said
    simulation = names["simulation"]
    assert isinstance(simulation, concio.Simulation)
    # By hand: it gives way once the spring bears 0.6 (2 N + w) = 6.04 kN; after 0.2 s that is 6.04 mm of 10 mm.
    assert simulation.displacements[2, 0] == pytest.approx(0.010 - 0.00604, abs=2e-4)
    limit = names["limit"]
    assert isinstance(limit, concio.Limit)
    assert limit.bounds[0] <= limit.multiplier <= limit.bounds[1] * (1 + 1e-9)
    rows = names["rows"]
    assert isinstance(rows, concio.Rows) and rows.done and len(rows) == 8
