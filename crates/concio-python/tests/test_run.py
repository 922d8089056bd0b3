from __future__ import annotations

import os
import pickle
import signal
import threading
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import PLANAR

import concio
from concio import InputError, Record, Run, Wall


def test_histories_share_the_memory_of_the_engine(wall: Wall) -> None:
    run = wall.run()
    assert run.ok and run.stop_reason == "completed" and run.energy_residual < 0.05
    shear = run["base/shear"]
    assert shear.shape == run.time.shape and shear.base is not None
    assert np.shares_memory(shear, run["top/displacement"]) is False and np.shares_memory(shear, run._native.values)
    for array in (shear, run.time, run.frame_time, *run.frames.values()):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
    assert list(run) == list(run.channels) and len(run) == len(list(run))
    assert run.channels["base/shear"].unit == "N"
    with pytest.raises(KeyError, match="base/shear"):
        run["base/sheer"]


def test_the_base_shear_is_that_of_newton() -> None:
    """A rigid block that sticks on its base: the base bears its mass times the acceleration of the base."""
    wall = Wall.from_str(PLANAR).replace(
        {
            "panel[0].courses": 1,
            "panel[0].bricks": 1,
            "joint.friction.static": 2.0,
            "joint.friction.dynamic": 2.0,
            "load.top": 0,
        }
    )
    wall = wall.replace({"motion.base": {"pulse": {"shape": "rectangular", "acceleration": 1.0, "duration": 0.5}}})
    run = wall.run(duration=0.4)
    mass = float(wall.blocks["mass"][0])
    assert abs(run["base/shear"][100]) == pytest.approx(mass * 1.0, rel=1e-6)


def test_result_files_have_the_bytes_of_the_command_line(wall: Wall, tmp_path: Path, command) -> None:  # type: ignore[no-untyped-def]
    path = tmp_path / "wall.toml"
    path.write_text(wall._case.text or "")
    told = command("run", path, "--out", tmp_path / "typed")
    assert told.returncode == 0, told.stderr
    Wall.from_toml(path).run().save(tmp_path / "python")
    assert (tmp_path / "python/result.h5").read_bytes() == (tmp_path / "typed/result.h5").read_bytes()
    typed, ours = (concio.open(tmp_path / name).summary for name in ("typed", "python"))
    for summary in (typed, ours):
        del summary["solve_seconds"]
    assert typed == ours


def test_a_run_that_is_read_back_is_the_run(wall: Wall, tmp_path: Path) -> None:
    run = wall.run()
    run.save(tmp_path / "out")
    again = concio.open(tmp_path / "out/result.h5")
    np.testing.assert_array_equal(again._native.values, run._native.values)
    assert again.frames.keys() == run.frames.keys()
    for name, values in run.frames.items():
        np.testing.assert_array_equal(again.frames[name], values)
    assert again.wall == run.wall == wall
    again.save(tmp_path / "copy")
    assert (tmp_path / "copy/result.h5").read_bytes() == (tmp_path / "out/result.h5").read_bytes()
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "out/result.h5") as file:
        assert file.attrs["inputs_hash"] == run.inputs_hash


def test_runs_come_back_from_other_processes(wall: Wall, quake: Record) -> None:
    here = wall.run(base=quake, duration=0.2)
    # Not by fork: threads of the engine would not be there.
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        there = pool.submit(wall.run, quake, duration=0.2).result(timeout=120)
    back = pickle.loads(pickle.dumps(here))
    for again in (back, there):
        for array, own in ((again._native.values, here._native.values), (again.time, here.time)):
            assert array.tobytes() == own.tobytes() and not array.flags.writeable
        assert again.frames.keys() == here.frames.keys()
        for name, values in here.frames.items():
            np.testing.assert_array_equal(again.frames[name], values)
        assert again.warnings == here.warnings and again.wall == here.wall
        assert again.summary | {"solve_seconds": 0} == here.summary | {"solve_seconds": 0}
        assert repr(again) == repr(here)
        assert repr(again.events) == repr(here.events) and repr(again.joints) == repr(here.joints)
    assert back.summary == here.summary
    # Of which reports show the text.
    assert back._native.text == here._native.text == wall._case.text


def test_folders_that_hold_no_run(tmp_path: Path, planar: Wall) -> None:
    with pytest.raises(OSError):
        concio.open(tmp_path)
    (tmp_path / "result.h5").write_bytes(b"nothing")
    with pytest.raises(InputError) as caught:
        concio.open(tmp_path)
    assert caught.value.file == str(tmp_path / "result.h5")
    with pytest.raises(InputError, match="is a file"):
        planar.run(duration=0.01).save(tmp_path / "result.h5")


def test_a_record_of_a_file_is_that_of_the_wall_file(planar: Wall, quake_file: Path, tmp_path: Path) -> None:
    """Treated in the order of a wall file, it is what a wall file says: the same inputs, the same bits, the same warnings."""
    text = PLANAR.replace('duration = "0.6 s"', "").replace(
        '{ sine = { acceleration = "0.8 g", frequency = 3 } }',
        '{ record = "quake.csv", trim = ["0.1 s", "0.7 s"], pga = "0.3 g" }',
    )
    path = tmp_path / "wall.toml"
    path.write_text(text)
    typed = Wall.from_toml(path).run()
    quake = Record.read(quake_file).trim("0.1 s", "0.7 s").scaled(pga="0.3 g")
    ours = Wall.from_str(PLANAR, folder=tmp_path).run(base=quake)
    assert ours.time_reached == pytest.approx(quake.duration)
    np.testing.assert_array_equal(ours._native.values, typed._native.values)


def test_an_array_moves_the_wall_as_its_file_does(planar: Wall, quake: Record, quake_file: Path) -> None:
    of_file = planar.run(base=Record.read(quake_file))
    of_array = planar.run(base=quake)
    np.testing.assert_array_equal(of_file._native.values, of_array._native.values)
    # What is done in another order than a wall file's has no words there, and the same motion.
    swapped = Record.read(quake_file).scaled(2).trim(0, 0.5)
    np.testing.assert_array_equal(
        planar.run(base=swapped)._native.values,
        planar.run(base=Record.read(quake_file).trim(0, 0.5).scaled(2))._native.values,
    )


def test_a_motion_that_no_result_holds_is_told(planar: Wall, quake: Record, tmp_path: Path) -> None:
    (run,) = concio.run_many([(planar, quake)])
    assert run is not None and planar.run(base=quake).warnings == run.warnings
    assert run.warnings[-1].kind == "motion-in-no-file" and "no file gives" in repr(run)
    with pytest.warns(UserWarning, match=r"record\.save"):
        run.save(tmp_path / "out")
    with pytest.warns(UserWarning, match=r"record\.save"):
        run.report(tmp_path / "page.html")
    back = concio.open(tmp_path / "out")
    assert back.wall.settings["motion"]["base"] == "none"
    # Who opens it later is told too, as is who copies it.
    assert back.warnings == run.warnings and back.summary == run.summary
    with pytest.warns(UserWarning, match=r"record\.save"):
        back.save(tmp_path / "copy")
    # The remedy: the same motion by a file, which the result names.
    kept = planar.run(base=quake.save(tmp_path / "quake.txt"))
    np.testing.assert_array_equal(kept._native.values, run._native.values)
    kept.save(tmp_path / "out")
    assert kept.warnings == run.warnings[:-1]
    again = concio.open(tmp_path / "out").wall.run()
    np.testing.assert_array_equal(again._native.values, run._native.values)


def test_arrays_are_doubted_as_files_are(planar: Wall, quake: Record, tmp_path: Path) -> None:
    """An acceleration in cm/s² that was taken for m/s² and drifts, over a run that cuts it."""
    wrong = quake.scaled(100)
    kinds = ["record-cut", "drift", "unlikely-peak"]
    of_array = planar.run(base=wrong, duration="50 ms").warnings
    of_file = planar.run(base=wrong.save(tmp_path / "quake.txt"), duration="50 ms").warnings
    told = [warning for warning in of_array if warning.kind != "motion-in-no-file"]
    assert told == of_file and len(of_array) == len(of_file) + 1
    assert [warning.kind for warning in told if warning.kind in kinds] == kinds
    assert any("more than 60 m/s²" in warning.text for warning in told)
    # Samples in g that were taken for m/s²; who chooses a peak means it.
    in_g = Record.from_array(0.35 * np.sin(0.3 * np.arange(400)), dt=0.005)
    asked = 'the unit of the record is "m/s2", in which the record\'s peak acceleration is 0.0357 g: it hardly moves a wall. Is it 0.35 g?'
    assert any(asked in warning.text for warning in planar.run(base=in_g, duration="50 ms").warnings)
    for meant in (in_g.scaled(pga="0.03 g"), Record.from_array(in_g.acceleration, dt=0.005, units="g")):
        assert not any("hardly moves" in warning.text for warning in planar.run(base=meant, duration="50 ms").warnings)
    # What is doubtful in the wall file is told with them.
    doubtful = planar.replace({"panel[0].brick.specific_weight": 18})
    (run,) = concio.run_many([(doubtful, quake)])
    assert [warning.text for warning in run.warnings if "specific_weight" in warning.text]
    # A displacement history may end where it likes.
    t = np.linspace(0, 1, 201)
    rows = "\n".join(f"{k:.17g},{u:.17g}" for k, u in zip(t, t**3 * (10 - 15 * t + 6 * t**2), strict=True))
    (tmp_path / "path.csv").write_text(f"t [s],u [m]\n{rows}\n")
    path = Record.read(tmp_path / "path.csv", quantity="displacement").scaled(0.1).trim(0, 1)
    assert path._native.words("") is None
    assert "drift" not in [warning.kind for warning in planar.run(base=path).warnings]


def test_other_motions_of_the_base(planar: Wall) -> None:
    run = planar.run(base={"tilt": {"acceleration": "0.1 g", "rise": "0.1 s"}}, duration="200 ms")
    assert run.time_reached == pytest.approx(0.2)
    with pytest.raises(InputError) as caught:
        planar.run(base={"sinus": {}})
    assert caught.value.key is not None and caught.value.key.startswith("motion.base")
    with pytest.raises(InputError):
        planar.run(duration="-1 s")


def test_other_threads_go_on(planar: Wall) -> None:
    counted = 0
    over = threading.Event()

    def count() -> None:
        nonlocal counted
        while not over.is_set():
            counted += 1
            time.sleep(1e-3)

    thread = threading.Thread(target=count)
    thread.start()
    before = counted
    planar.run(duration="20 s")
    after = counted
    over.set()
    thread.join()
    # Under a held interpreter lock it would not get its turn.
    assert after - before >= 3


def test_progress_is_told_and_may_stop_the_run(planar: Wall) -> None:
    shares: list[float] = []
    planar.run(duration="20 s", progress=shares.append)
    assert shares and shares == sorted(shares) and 0 < shares[0] <= shares[-1] <= 1

    class EnoughError(Exception):
        pass

    def stop(share: float) -> None:
        raise EnoughError

    with pytest.raises(EnoughError):
        planar.run(duration="20 s", progress=stop)


def test_ctrl_c_keeps_what_was_reached(planar: Wall, tmp_path: Path) -> None:
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.warns(RuntimeWarning, match="stopped"):
        run = planar.run(duration="3000 s")
    timer.join()
    assert not run.ok and run.stop_reason == "interrupted" and 0 < run.time_reached < 3000
    run.save(tmp_path / "part")
    assert concio.open(tmp_path / "part").stop_reason == "interrupted"
    assert "did not go" in repr(run)


def test_many_runs_have_the_bits_of_single_ones(planar: Wall, shear: Wall, quake: Record) -> None:
    walls = [shear.replace({"joint.friction.static": mu}) for mu in (0.5, 0.6, 0.7)]
    runs = concio.run_many([*walls, planar, (shear, quake)], threads=2)
    single = [*(wall.run() for wall in walls), planar.run(), shear.run(base=quake)]
    for many, one in zip(runs, single, strict=True):
        assert isinstance(many, Run)
        np.testing.assert_array_equal(many._native.values, one._native.values)
    assert concio.run_many([]) == []
    with pytest.raises(InputError, match="number 1"):
        concio.run_many([planar, (quake, planar)])  # type: ignore[list-item]


@pytest.mark.parametrize(("threads", "begun"), [(1, 1), (65535, 3)])
def test_ctrl_c_ends_many_runs(planar: Wall, threads: int, begun: int) -> None:
    long = planar.replace({"motion.duration": "3000 s"})
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.warns(RuntimeWarning, match=f"{3 - begun} that had not begun"):
        runs = concio.run_many([long, long, long], threads=threads)
    timer.join()
    assert [run.stop_reason for run in runs] == ["interrupted"] * begun


def test_a_collapse_is_told() -> None:
    # A slender block under a long push of more than its width over its height turns over.
    wall = Wall.from_str(PLANAR).replace(
        {
            "panel[0].courses": 1,
            "panel[0].bricks": 1,
            "panel[0].brick.height": "1 m",
            "load.top": 0,
            "motion.stop_at": "collapse",
        }
    )
    run = wall.run(
        base={"pulse": {"shape": "rectangular", "acceleration": "0.38 g", "duration": "2 s"}}, duration="4 s"
    )
    assert run.collapse is not None and run.stop_reason == "collapsed" and run.ok
    assert "collapse" in [warning.kind for warning in run.warnings]
    assert len(run.events) and "collapse" in run.events["kind"]
    assert "warning: " in repr(run) and "warning: " in run._repr_html_()


def test_tables_and_report(planar: Wall, tmp_path: Path) -> None:
    run = planar.run()
    worst = run.joints.nlargest(3, "slip")
    assert len(worst) == 3 and worst["slip"][0] == run.joints["slip"].max() > 0
    assert run.blocks["peak_displacement"].max() == pytest.approx(run.summary["peak_relative_displacement"])
    assert run.drifts["peak"].shape == (1,)
    run.report(tmp_path / "page.html")
    assert "three courses" in (tmp_path / "page.html").read_text()


def test_the_wall_of_a_motion_in_no_file_says_that_it_stands_still(planar: Wall, quake: Record, tmp_path: Path) -> None:
    run = planar.run(base=quake)
    with pytest.warns(UserWarning):
        run.save(tmp_path)
    for wall in (run.wall, pickle.loads(pickle.dumps(run.wall)), concio.open(tmp_path).wall):
        assert "motion-in-no-file" in [doubt.kind for doubt in wall.check()]
        for again in (wall, wall.replace({"motion.duration": 0.2})):
            with pytest.warns(UserWarning, match="stands still"):
                again.run()
        with pytest.warns(UserWarning, match="stands still"):
            concio.run_many([wall])
        with pytest.warns(UserWarning, match="stands still"):
            concio.Study(wall, {"joint.friction.static": [0.4, 0.5]})
        # With the motion it is the run.
        np.testing.assert_array_equal(wall.run(base=quake)["base/shear"], run["base/shear"])
        moved = wall.replace({"motion.base": {"sine": {"acceleration": "0.1 g", "frequency": 3}}})
        assert moved.run().ok and "motion-in-no-file" not in [doubt.kind for doubt in moved.check()]
    assert "motion-in-no-file" not in [doubt.kind for doubt in planar.run().wall.check()]


def test_histories_are_asked_by_name(planar: Wall) -> None:
    run = planar.run(duration=0.05)
    with pytest.raises(TypeError, match="by their name"):
        run[0]  # type: ignore[index]
    number: Any = 0
    assert "base/shear" in run and number not in run and "base/sheer" not in run


def test_progress_ends_with_all_of_it(planar: Wall, tmp_path: Path) -> None:
    short = planar.replace({"motion.duration": 0.05})
    study = concio.Study(short, {"joint.friction.static": [0.4, 0.5]})
    for work in (
        lambda told: short.run(progress=told),
        lambda told: concio.run_many([short], progress=told),
        lambda told: study.run(tmp_path, progress=told),
    ):
        shares: list[float] = []
        work(shares.append)
        assert shares[-1] == 1.0 and shares == sorted(shares)


def test_threads_are_no_more_than_runs(planar: Wall) -> None:
    short = planar.replace({"motion.duration": 0.02})
    assert len(concio.run_many([short, short], threads=65535)) == 2
    for threads in (-1, 65536, 10**9, 1.5, True, "2"):
        with pytest.raises(InputError) as caught:
            concio.run_many([short], threads=threads)  # type: ignore[arg-type]
        assert caught.value.key == "threads"


@pytest.mark.parametrize("runs", [None, 3, "planar"])
def test_what_is_no_list_of_runs(planar: Wall, runs: Any) -> None:
    lists: list[Any] = [runs, [planar, runs], [planar, (planar, None, 1)], planar]
    for given in lists:
        with pytest.raises(InputError) as caught:
            concio.run_many(given)
        assert caught.value.key == "runs" and caught.value.allowed


def test_a_result_that_a_study_kept_is_opened(planar: Wall, tmp_path: Path) -> None:
    short = planar.replace({"motion.duration": 0.1})
    rows = concio.Study(short, {"joint.friction.static": [0.4]}, results=True).run(tmp_path / "study")
    (file,) = (tmp_path / "study" / "results").glob("*.h5")
    run, alone = concio.open(file), short.run()
    np.testing.assert_array_equal(run._native.values, alone._native.values)
    assert run.ok and run.energy == alone.energy and run.stop_reason == rows["end"][0]
    assert run.summary["weight"] is None and run.summary["duration"] == pytest.approx(0.1)
    assert [warned.kind for warned in run.warnings] == ["no-summary"] and "warning_kinds" in repr(run)
    run.save(tmp_path / "copy")
    run.report(tmp_path / "page.html")
    assert (tmp_path / "copy/result.h5").read_bytes() == file.read_bytes()
    assert concio.open(tmp_path / "copy").warnings == run.warnings
    (tmp_path / "notes.txt").write_text("nothing")
    with pytest.raises(InputError):
        concio.open(tmp_path / "notes.txt")
