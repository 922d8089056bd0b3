from __future__ import annotations

import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest

import concio
from concio import InputError, Record, Wall


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


class Converting:
    """What pint gives: a number with a unit, that converts itself."""

    factors: ClassVar = {"m/s**2": 1.0, "cm/s**2": 0.01, "s": 1.0, "ms": 1e-3, "N": 1.0, "kN": 1e3}

    def __init__(self, magnitude: Any, units: str) -> None:
        self.magnitude, self.units = magnitude, units

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Any:
        return np.asarray(self.magnitude, dtype)

    def to(self, unit: str) -> Converting:
        if self.units.endswith("s**2") != unit.endswith("s**2"):
            raise TypeError(f"Cannot convert from '{self.units}' to '{unit}'")
        return Converting(self.magnitude * (self.factors[self.units] / self.factors[unit]), unit)


Quantity: Any = Converting


def test_quantities_are_converted(planar: Wall) -> None:
    samples = Quantity(np.array([0.0, 100.0, -200.0]), "cm/s**2")
    record = Record.from_array(samples, Quantity(5.0, "ms"))
    assert record.acceleration == pytest.approx([0, 1, -2]) and record.dt == pytest.approx(0.005)
    each = [Quantity(value, "cm/s**2") for value in samples.magnitude]
    np.testing.assert_array_equal(Record.from_array(each, "5 ms").acceleration, record.acceleration)
    assert record.spectrum(Quantity(np.array([100.0]), "ms")).period == pytest.approx([0.1])
    wrong: list[tuple[Callable[[], object], str]] = [
        (lambda: Record.from_array(Quantity(np.ones(3), "kN"), 0.005), "acceleration"),
        (lambda: Record.from_array([*each, 1.0], 0.005), "acceleration"),
        (lambda: Record.from_array(samples, 0.005, units="g"), "units"),
        (lambda: Record.from_array(each, 0.005, units="g"), "units"),
        (lambda: Record.from_array([0, 1], Quantity(5.0, "cm/s**2")), "dt"),
    ]
    for give, key in wrong:
        with pytest.raises(InputError) as caught:
            give()
        assert caught.value.key == key
    simulation = planar.simulation()
    simulation.advance(to=Quantity(20.0, "ms"))
    assert simulation.time == pytest.approx(0.02, abs=0.01)
    simulation.push(0, x=Quantity(1.0, "kN"))
    with pytest.raises(InputError, match="Cannot convert"):
        simulation.push(0, x=Quantity(1.0, "cm/s**2"))


def test_quantities_of_pint() -> None:
    pint = pytest.importorskip("pint")
    u = pint.UnitRegistry()
    record = Record.from_array(np.array([0.0, 100.0, -200.0]) * u.cm / u.s**2, 5 * u.ms)
    assert record.acceleration == pytest.approx([0, 1, -2]) and record.dt == pytest.approx(0.005)
    assert Record.from_array(np.array([0.0, 0.1]) * u.standard_gravity, 0.01).pga == pytest.approx(0.980665)
    with pytest.raises(InputError, match="Cannot convert"):
        Record.from_array(np.ones(3) * u.m, 0.005)


@pytest.mark.parametrize(
    ("samples", "dt", "units", "key"),
    [
        (np.ma.masked_greater(np.arange(5.0), 3), 0.01, "m/s2", "acceleration"),
        (np.arange(5).astype("datetime64[s]"), 0.01, "m/s2", "acceleration"),
        (np.arange(5).astype("timedelta64[s]"), 0.01, "m/s2", "acceleration"),
        (np.arange(5) * 1j, 0.01, "m/s2", "acceleration"),
        (np.arange(5) > 2, 0.01, "m/s2", "acceleration"),
        (["1", "2"], 0.01, "m/s2", "acceleration"),
        (np.array(["1", 2.0], dtype=object), 0.01, "m/s2", "acceleration"),
        ([0, 1], "5", "m/s2", "dt"),
        ([0, 1], "5 kg", "m/s2", "dt"),
        ([0, 1], True, "m/s2", "dt"),
        ([0, 1], None, "m/s2", "dt"),
        ([0, 1], 0.01 + 0j, "m/s2", "dt"),
        ([0, 1], np.timedelta64(5, "ms"), "m/s2", "dt"),
        ([0, 1], float("nan"), "m/s2", "dt"),
        ([0, 1], 0.01, None, "units"),
    ],
)
def test_what_is_no_row_of_numbers_is_refused(samples: Any, dt: Any, units: Any, key: str) -> None:
    with pytest.raises(InputError) as caught:
        Record.from_array(samples, dt, units=units)
    assert caught.value.key == key and caught.value.allowed


def test_an_interval_may_be_a_text() -> None:
    assert Record.from_array([0, 1, 2], "5 ms").dt == 0.005
    full = np.ma.masked_array([0.0, 1.0], mask=[False, False])
    assert Record.from_array(full, 0.01).pga == 1.0


def test_numbers_of_numpy_scale_a_record(quake: Record) -> None:
    numbers: list[Any] = [np.float64(2), np.int64(2), np.array(2.0)]
    for two in numbers:
        doubled = two * quake
        assert isinstance(doubled, Record) and doubled.pga == 2 * quake.pga and isinstance(quake * two, Record)
    window = np.ones(len(quake))
    np.testing.assert_array_equal(window * quake, quake.acceleration)
    np.testing.assert_array_equal(np.add(quake, quake), 2 * quake.acceleration)


@pytest.mark.parametrize("given", ["5%", None, True, float("nan"), 1])
def test_what_is_no_damping(quake: Record, given: Any) -> None:
    with pytest.raises(InputError) as caught:
        quake.spectrum(damping=given)
    assert caught.value.key == "damping" and caught.value.allowed


def test_a_file_that_changes_is_told(planar: Wall, quake: Record, quake_file: Path) -> None:
    read = Record.read(quake_file)
    treated = read.trim(0, 0.5).scaled(2)
    copy = pickle.loads(pickle.dumps(read))
    first = planar.run(read)
    study = concio.Study(planar, motions={"quake": read})
    Record.from_array(10 * quake.acceleration, quake.dt).save(quake_file.with_name("other.txt"))
    text = quake_file.read_text()
    quake_file.write_bytes(quake_file.with_name("other.txt").read_bytes())
    uses: list[Callable[[Record], object]] = [
        planar.run,
        planar.simulation,
        lambda record: planar.replace({"motion.base": record}),
        lambda record: concio.run_many([(planar, record)]),
        lambda record: concio.Study(planar, motions={"quake": record}),
        lambda _: study.check(),
        lambda _: study.run(quake_file.with_name("study")),
    ]
    for change in ("was changed", "is gone"):
        for record in (read, treated):
            for use in uses:
                with pytest.raises(InputError, match=f"{change}.*record.save") as caught:
                    use(record)
                assert caught.value.file == str(quake_file)
        quake_file.unlink(missing_ok=True)
    # The remedy, and a copy by pickle: the samples that were read.
    for kept in (read.save(quake_file.with_name("kept.txt")), copy):
        assert planar.run(kept)["base/shear"].tobytes() == first["base/shear"].tobytes()
    quake_file.write_text(text)
    assert planar.run(read)["base/shear"].tobytes() == first["base/shear"].tobytes()
