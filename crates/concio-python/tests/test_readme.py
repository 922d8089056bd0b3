from __future__ import annotations

import re
from pathlib import Path

import pytest
from conftest import PLANAR

import concio

ROOT = Path(__file__).parents[3]
README = ROOT / "README.md"


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
    (code,) = re.findall(r"```python\n(.*?)```", README.read_text(), flags=re.DOTALL)
    (tmp_path / "wall.toml").write_text(PLANAR)
    rows = "\n".join(f"{k * quake.dt:.17g},{a:.17g}" for k, a in enumerate(quake.acceleration))
    (tmp_path / "quake.at2").write_text(f"t [s],a [m/s2]\n{rows}\n")
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    exec(code, names)
    assert isinstance(names["run"], concio.Run) and names["run"].ok
    assert "energy account" in capsys.readouterr().out
