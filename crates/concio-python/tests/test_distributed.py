from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from concio import InputError, Study, Uniform, Wall
from concio.distributed import rows, work

IDA = """wall = "wall.toml"
[[motion]]
name = "rectangle"
base = { pulse = { shape = "rectangular", acceleration = "0.5 g", duration = "0.2 s" } }
[[motion]]
name = "half sine"
base = { pulse = { shape = "half-sine", acceleration = "0.5 g", duration = "0.2 s" } }
[ida]
damage = "largest_slip"
limits = [{ name = "2 cm", value = "20 mm" }]
collapse = "0.3 m"
hunt = { first = "0.15 g", step = "0.15 g", most = "2 g", runs = 6 }
"""
SLIDING = """model = "shear"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = { length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
[joint]
bed = { law = "none" }
head = { law = "none" }
friction = { law = "coulomb", static = 0.2, dynamic = 0.2 }
[motion]
duration = "1.5 s"
base = { pulse = { shape = "rectangular", acceleration = "0.5 g", duration = "0.2 s" } }
"""
CRACK = """wall = "wall.json"
[[motion]]
name = "sine"
base = { sine = { acceleration = "0.3 g", frequency = "5 Hz", ramp = "0.1 s" } }
duration = "0.4 s"
[first-crack]
"""


def tables(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.glob("*.csv"))}


def kept(folder: Path) -> int:
    """Rows that the folder holds whole."""
    return sum(path.read_bytes().count(b"\n") for path in folder.glob("runs/*.jsonl"))


def study_of(wall: Wall, runs: int = 256) -> Study:
    return Study(wall, {"joint.friction.static": Uniform(0.5, 0.8)}, design="latin-hypercube", runs=runs, seed=4)


def test_processes_do_what_threads_do(tmp_path: Path, shear: Wall, command: Any) -> None:
    here = study_of(shear, 20).run(tmp_path / "here")
    with ProcessPoolExecutor(2) as pool:
        there = study_of(shear, 20).run(tmp_path / "there", executor=pool, runs_per_task=3)
    assert there.done and there["id"].tolist() == here["id"].tolist()
    for name in ("here", "there"):
        assert command("study", "report", tmp_path / name / "study.json", "--out", tmp_path / name).returncode == 0
    assert tables(tmp_path / "here") == tables(tmp_path / "there") != {}


@pytest.mark.parametrize("text", [IDA, CRACK], ids=["ida", "first-crack"])
def test_searches_go_through_executors(tmp_path: Path, shear: Wall, command: Any, text: str) -> None:
    bonded = shear.replace({"joint.bond": {"tensile_strength": "5 kPa", "cohesion": "8 kPa"}})
    (tmp_path / "wall.toml").write_text(SLIDING)
    (tmp_path / "wall.json").write_text(json.dumps(bonded.settings))
    (tmp_path / "study.toml").write_text(text)
    assert command("study", "run", tmp_path / "study.toml", "--out", tmp_path / "here").returncode == 0
    with ProcessPoolExecutor(2) as pool:
        found = Study.from_toml(tmp_path / "study.toml").run(tmp_path / "there", executor=pool, runs_per_task=2)
    assert found.done and len(found) > 0
    assert tables(tmp_path / "here") == tables(tmp_path / "there") != {}


def test_what_a_worker_raises_is_raised_and_rows_stay(tmp_path: Path, shear: Wall) -> None:
    class Broken:
        """Does two tasks and no more."""

        def __init__(self) -> None:
            self.left = 2
            self.pool = ProcessPoolExecutor(1)

        def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Any:
            self.left -= 1
            return self.pool.submit(fn if self.left >= 0 else _fails, *args, **kwargs)

    with pytest.raises(RuntimeError, match="no more"):
        study_of(shear, 20).run(tmp_path, executor=Broken(), runs_per_task=4)
    assert kept(tmp_path) == 8
    assert study_of(shear, 20).run(tmp_path).done and kept(tmp_path) == 20


def _fails(task: str) -> list[str]:
    raise RuntimeError("no more")


def test_what_is_no_task(tmp_path: Path) -> None:
    with pytest.raises(InputError):
        work("{}")
    with ProcessPoolExecutor(1) as pool, pytest.raises(InputError):
        list(rows(pool, ["no task"]))


CLIENT = """
import sys
from distributed import Client, LocalCluster
from concio import Study
if __name__ == "__main__":
    folder, workers, at_once = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    with LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        pids = [w.pid for w in cluster.workers.values()]
        print(*pids, flush=True)
        rows = Study.from_toml(folder + "/study.json").run(folder, executor=client.get_executor(), runs_per_task=at_once)
        print("done" if rows.done else "stopped", flush=True)
"""


def killed_study(kind: str, planar: Wall, shear: Wall) -> tuple[Study, int, tuple[int, int, int]]:
    """A study, runs per task, and after how many rows two workers and the client are killed."""
    motions = {
        f"{frequency} Hz": {"sine": {"acceleration": "0.3 g", "frequency": frequency, "ramp": "0.1 s"}}
        for frequency in range(3, 13)
    }
    if kind == "sweep":
        return study_of(planar.replace({"motion.duration": "0.4 s"})), 8, (16, 64, 120)
    if kind == "ida":
        wall = planar.replace({"motion.duration": "1 s"})
        ida = {
            "intensity": "pga",
            "damage": "peak_displacement",
            "limits": [{"name": "1 mm", "value": "1 mm"}],
            "collapse": "0.1 m",
            "hunt": {"first": "0.2 g", "step": "0.2 g", "most": "3 g", "runs": 8},
        }
        return Study(wall, motions=motions, ida=ida), 1, (5, 15, 30)
    bonded = shear.replace({"joint.bond": {"tensile_strength": "5 kPa", "cohesion": "8 kPa"}})
    return Study(bonded, motions=motions, first_crack={"interval": 0.01}), 1, (5, 15, 30)


@pytest.mark.parametrize("kind", ["sweep", "ida", "first-crack"])
def test_dask_survives_kills_of_workers_and_client(
    tmp_path: Path, planar: Wall, shear: Wall, command: Any, kind: str
) -> None:
    pytest.importorskip("distributed")
    study, at_once, (*workers_after, client_after) = killed_study(kind, planar, shear)
    whole, killed = tmp_path / "whole", tmp_path / "killed"
    assert study.run(whole).done
    killed.mkdir()
    for name in ("wall.json", "study.json"):
        (killed / name).write_bytes((whole / name).read_bytes())
    script = tmp_path / "client.py"
    script.write_text(CLIENT)

    def begin(workers: int) -> tuple[subprocess.Popen[str], list[int]]:
        client = subprocess.Popen(
            [sys.executable, str(script), str(killed), str(workers), str(at_once)],
            stdout=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )
        assert client.stdout is not None
        return client, [int(pid) for pid in client.stdout.readline().split()]

    def wait_for(rows: int, client: subprocess.Popen[str]) -> None:
        while kept(killed) < rows and client.poll() is None:
            time.sleep(0.005)

    client, workers = begin(2)
    for pid, rows_before in zip(workers, workers_after, strict=True):
        wait_for(rows_before, client)
        os.kill(pid, signal.SIGKILL)
    wait_for(client_after, client)
    os.killpg(client.pid, signal.SIGKILL)
    client.communicate()
    before = kept(killed)
    assert 0 < before < kept(whole), before
    client, _ = begin(3)
    assert client.communicate()[0].split()[-1] == "done"
    assert kept(killed) == kept(whole)
    for folder in (whole, killed):
        assert command("study", "report", folder / "study.json", "--out", folder).returncode == 0
    assert tables(whole) == tables(killed) != {}
