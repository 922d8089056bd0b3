from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest

from concio import InputError, Record


def test_measures_of_a_sine() -> None:
    # a = A sin(2 π t) over 4 s: the Arias intensity is π/(2 g) A² T/2, a whole number of periods by the trapezoidal rule without error.
    t = np.arange(4001) * 1e-3
    record = Record.from_array(2.0 * np.sin(2 * np.pi * t), dt=1e-3)
    assert record.pga == pytest.approx(2.0, rel=1e-12)
    assert record.arias == pytest.approx(np.pi / (2 * 9.80665) * 4.0 * 4.0 / 2, rel=1e-9)
    assert record.duration == pytest.approx(4.0)
    # From rest: v = A/ω (1 − cos ω t), whose peak is 2 A/ω.
    assert record.pgv == pytest.approx(2 * 2.0 / (2 * np.pi), rel=1e-5)
    np.testing.assert_allclose(record.velocity[-1], 0.0, atol=1e-9)


def test_the_spectrum_is_the_pga_of_a_rigid_oscillator(quake: Record) -> None:
    found = quake.spectrum([0.0, 1e-6, 0.5])
    np.testing.assert_allclose(found.psa[:2], quake.pga, rtol=1e-9)
    # An oscillator at the frequency of the motion answers with more.
    assert found.psa[2] > 2 * quake.pga
    assert found.psa[2] == pytest.approx((2 * np.pi / 0.5) ** 2 * found.sd[2], rel=1e-12)


def test_what_is_done_makes_another(quake: Record) -> None:
    before = quake.acceleration.copy()
    assert quake.scaled(-2).acceleration == pytest.approx(-2 * before)
    # g is 9.81 m/s² in texts with units.
    assert quake.scaled(pga="0.35 g").pga == pytest.approx(0.35 * 9.81, rel=1e-12)
    assert quake.scaled(pga=3.0).pga == pytest.approx(3.0, rel=1e-12)
    assert quake.reversed().acceleration == pytest.approx(before[::-1])
    assert quake.trim(0.1, "500 ms").acceleration == pytest.approx(before[20:101])
    assert quake.resample("1 ms").dt == 1e-3
    assert abs(quake.baseline(polynomial=0).acceleration.mean()) < 1e-14
    assert abs(quake.baseline(high_pass="0.5 Hz").displacement[-1]) < abs(quake.displacement[-1])
    np.testing.assert_array_equal(quake.acceleration, before)


def test_numpy_takes_a_record_for_its_samples(quake: Record) -> None:
    np.testing.assert_array_equal(np.asarray(quake), quake.acceleration)
    assert np.abs(quake).max() == quake.pga and np.asarray(quake, dtype=np.float32).dtype == np.float32


def test_arrays_are_read_only(quake: Record) -> None:
    with pytest.raises(ValueError, match="read-only"):
        quake.acceleration[0] = 1.0


def test_a_file_is_read_as_it_was_written(quake: Record, quake_file: Path) -> None:
    read = Record.read(quake_file)
    np.testing.assert_array_equal(read.acceleration, quake.acceleration)
    assert read.dt == pytest.approx(quake.dt) and read.facts["format"] == "text"
    assert read.components == ["a"]


def test_units_of_arrays_are_those_of_text_files(tmp_path: Path) -> None:
    path = tmp_path / "g.csv"
    path.write_text("t [s],a [g]\n0,0\n0.01,0.1\n0.02,-0.3\n")
    given = Record.from_array([0, 0.1, -0.3], dt=0.01, units="g")
    np.testing.assert_array_equal(given.acceleration, Record.read(path).acceleration)


@pytest.mark.parametrize(
    ("make", "key"),
    [
        (lambda r: r.scaled(), "pga"),
        (lambda r: r.scaled(1, pga=1), "pga"),
        (lambda r: r.scaled(pga=-1), "pga"),
        (lambda r: r.scaled(pga="1 kg"), "pga"),
        (lambda r: r.scaled(float("inf")), "scale"),
        (lambda r: r.trim(3, 4), "trim"),
        (lambda r: r.trim("1 m", 2), "trim[0]"),
        (lambda r: r.resample(0), "resample"),
        (lambda r: r.baseline(), "baseline"),
        (lambda r: r.baseline(polynomial=9), "baseline.polynomial"),
        (lambda r: r.spectrum([-1]), "periods"),
        (lambda r: r.spectrum(damping=2), "damping"),
        (lambda r: Record.from_array([1.0], 0.01), "acceleration"),
        (lambda r: Record.from_array([[1.0, 2.0]], 0.01), "acceleration"),
        (lambda r: Record.from_array([1.0, np.nan], 0.01), "acceleration"),
        (lambda r: Record.from_array(["a", "b"], 0.01), "acceleration"),
        (lambda r: Record.from_array([1.0, 2.0], 0), "dt"),
        (lambda r: Record.from_array([1.0, 2.0], 0.01, units="mm"), "units"),
    ],
)
def test_what_does_not_suit_a_record(quake: Record, make, key: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InputError) as caught:
        make(quake)
    assert caught.value.key == key
    assert caught.value.line is None and caught.value.file is None


def test_a_file_that_is_none(tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        Record.read(tmp_path / "none.at2")
    assert caught.value.file == str(tmp_path / "none.at2")
    (tmp_path / "text.csv").write_text("hello\n")
    with pytest.raises(InputError):
        Record.read(tmp_path / "text.csv")


def test_a_trace_of_obspy() -> None:
    class Stats:
        delta = 0.01

    class Trace:
        data = np.array([0.0, 1.0, -2.0])
        stats = Stats()

    assert Record.from_obspy(Trace(), units="cm/s2").pga == pytest.approx(0.02)


def test_records_go_to_other_processes(quake: Record) -> None:
    again = pickle.loads(pickle.dumps(quake.scaled(2)))
    np.testing.assert_array_equal(again.acceleration, 2 * quake.acceleration)


def test_arrays_may_begin_anywhere_in_memory(quake: Record) -> None:
    """As those do that Dask hands on without a copy."""
    askew = np.frombuffer(b"-" + quake.acceleration.tobytes(), offset=1)
    assert not askew.flags.aligned
    again = Record.from_array(askew, quake.dt)
    np.testing.assert_array_equal(again.acceleration, quake.acceleration)
    periods = np.frombuffer(b"-" + np.array([0.1, 0.5]).tobytes(), offset=1)
    np.testing.assert_array_equal(again.spectrum(periods).psa, quake.spectrum([0.1, 0.5]).psa)


def test_a_record_shows_itself(quake: Record) -> None:
    assert repr(quake).splitlines()[1:] == ["201 samples every 0.005 s, 1 s", f"PGA {quake.pga:.4g} m/s²"]


@pytest.mark.parametrize("dt", [0.005, 1 / 256, 1e-5, 0.1 + 0.2, 60.0])
def test_a_record_is_saved_to_the_bit(tmp_path: Path, dt: float) -> None:
    samples = np.random.default_rng(1).normal(size=300) * 10.0 ** np.arange(-297, 3)
    samples[:3] = -0.0, 5e-324, 1 / 3
    record = Record.from_array(samples, dt)
    saved = record.save(tmp_path / "quake.txt")
    for again in (saved, Record.read(tmp_path / "quake.txt")):
        assert again.acceleration.tobytes() == record.acceleration.tobytes() and again.dt == record.dt
        assert again.facts["remarks"] == [] and again.components == ["acceleration"]
    # What is done to the saved one has words; another record needs another name, for runs read the file again.
    other = record.scaled(2).trim(0, 100 * dt)
    assert other.save(tmp_path / "other.txt").scaled(0.5)._native.words("") is not None
    assert len(Record.read(tmp_path / "other.txt")) == 101
    record.save(tmp_path / "quake.txt")
    with pytest.raises(InputError, match="something else"):
        other.save(tmp_path / "quake.txt")


def test_a_displacement_history_is_saved_as_one(tmp_path: Path) -> None:
    t = np.arange(201) * 0.01
    rows = "\n".join(f"{k:.17g},{u:.17g}" for k, u in zip(t, 20 * np.sin(np.pi * t) ** 2, strict=True))
    (tmp_path / "path.csv").write_text(f"t [s],u [mm]\n{rows}\n")
    read = Record.read(tmp_path / "path.csv", quantity="displacement")
    saved = read.save(tmp_path / "path.txt")
    np.testing.assert_array_equal(saved.displacement, read.displacement)
    # Its interval is that of the column of times, which rounding leaves some 1e-15 off.
    np.testing.assert_allclose(saved.acceleration, read.acceleration, atol=1e-9 * np.abs(read.acceleration).max())


def test_files_of_others_are_not_replaced(tmp_path: Path, quake: Record, quake_file: Path) -> None:
    before = quake_file.read_bytes()
    with pytest.raises(InputError, match="another name") as caught:
        Record.read(quake_file).scaled(2).save(quake_file)
    assert caught.value.file == str(quake_file) and quake_file.read_bytes() == before
    with pytest.raises(OSError):
        quake.save(tmp_path / "none" / "quake.txt")
