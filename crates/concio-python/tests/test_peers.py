"""Records against what other programs make of the same samples: eqsig, pyRotd, ObsPy. Each is skipped where it is not installed."""

from __future__ import annotations

import importlib
import os
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from concio import InputError, Record


def peer(name: str) -> Any:
    """A package, whatever it warns of when it is imported."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pytest.importorskip(name.partition(".")[0], exc_type=ImportError)
        return importlib.import_module(name)


@pytest.fixture(scope="module")
def chirp() -> Record:
    """8 s of a chirp of 0.5 to 7 Hz under a bell, a sample per millisecond, and rest in which oscillators come to rest too."""
    t = np.arange(180_000) * 1e-3
    swept = np.sin(2 * np.pi * (0.5 + 0.4 * t) * t) + 0.5 * np.sin(9 * t + 1)
    return Record.from_array(np.where(t < 8, 3 * np.sin(np.pi * t / 8) ** 2 * swept, 0), dt=1e-3)


PERIODS = np.array([0.1, 0.2, 0.5, 1.0, 2.0, 3.0])


@pytest.mark.parametrize("damping", [0.02, 0.05, 0.2])
def test_spectra_are_those_of_eqsig(chirp: Record, damping: float) -> None:
    signal = peer("eqsig").AccSignal(np.array(chirp.acceleration), chirp.dt)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        signal.generate_response_spectrum(response_times=PERIODS, xi=damping)
    found = chirp.spectrum(PERIODS, damping=damping)
    # eqsig takes peaks at samples: of 100 in a period it misses 1 − cos(π/100) = 5e-4 at most.
    for own, theirs in ((found.psa, signal.s_a), (found.sd, signal.s_d)):
        assert ((theirs > own * (1 - 5e-4)) & (theirs < own * (1 + 1e-6))).all(), theirs / own - 1


@pytest.mark.parametrize("damping", [0.02, 0.05, 0.2])
def test_spectra_are_those_of_pyrotd(chirp: Record, damping: float, monkeypatch: pytest.MonkeyPatch) -> None:
    pyrotd = peer("pyrotd")
    monkeypatch.setattr(pyrotd, "processes", 1)
    theirs = pyrotd.calc_spec_accels(chirp.dt, chirp.acceleration, 1 / PERIODS, osc_damping=damping).spec_accel
    # Peaks at samples here too. It takes the motion as band-limited, not as straight between its samples: (ω dt)²/12 of 7 Hz is 2e-4.
    np.testing.assert_allclose(theirs, chirp.spectrum(PERIODS, damping=damping).psa, rtol=5e-4)


def test_intensities_are_those_of_eqsig(chirp: Record) -> None:
    eqsig, im = peer("eqsig"), peer("eqsig.im")
    signal = eqsig.AccSignal(np.array(chirp.acceleration[:20_000]), chirp.dt)
    record = Record.from_array(signal.values, chirp.dt)
    # The sum is the same, g is 9.81 m/s² there, and standard gravity here as in archives.
    assert im.calc_arias_intensity(signal)[-1] * 9.81 / 9.80665 == pytest.approx(record.arias, rel=1e-12)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        intensity = im.calc_vsi(signal)
    # The same sum over periods of 0.1 to 2.5 s, of spectra that miss 5e-4 at most.
    assert intensity == pytest.approx(record.measures["housner"], rel=5e-4)
    # Whole samples are counted there.
    assert im.calc_sig_dur(signal, start=0.05, end=0.95) == pytest.approx(record.d5_95, abs=2 * record.dt)


def test_traces_of_obspy_go_through_its_files(tmp_path: Path, quake: Record) -> None:
    obspy = peer("obspy")
    trace = obspy.Trace(np.array(quake.acceleration), {"delta": quake.dt})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        trace.write(str(tmp_path / "quake.mseed"), format="MSEED")
        (read,) = obspy.read(str(tmp_path / "quake.mseed"))
    again = Record.from_obspy(read, units="m/s2")
    np.testing.assert_array_equal(again.acceleration, quake.acceleration)
    assert again.dt == quake.dt
    # Counts are no acceleration, gaps no samples, several traces not one.
    read.stats.calib = 2e-6
    gappy = read.copy()
    gappy.stats.calib = 1.0
    gappy.data = np.ma.masked_greater(gappy.data, 1.0)
    for wrong, what in ((read, "calib"), (gappy, "gaps"), (obspy.Stream([read, read]), "Stream")):
        with pytest.raises(InputError, match=what) as caught:
            Record.from_obspy(wrong, units="m/s2")
        assert caught.value.key == "trace"


@pytest.mark.skipif("CONCIO_SHARED" not in os.environ, reason="CONCIO_SHARED names no folder of records")
@pytest.mark.parametrize("name", ["kiknet_AICH04.NS2", "knet_AOM001.EW"])
def test_records_of_knet_are_those_of_obspy(name: str) -> None:
    """The one format that both read."""
    obspy = peer("obspy")
    path = Path(os.environ["CONCIO_SHARED"]) / "records/knet_kiknet" / name
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        (trace,) = obspy.read(str(path), apply_calib=True)
    trace.stats.calib = 1.0
    read, given = Record.read(path), Record.from_obspy(trace, units="m/s2")
    assert given.dt == read.dt and len(given) == len(read) > 10_000
    # The mean is taken off here as the archive does it; 1e-15 m/s² is the rounding of samples of some 0.1 m/s².
    offset = given.acceleration.mean()
    np.testing.assert_allclose(given.acceleration - offset, read.acceleration, rtol=0, atol=1e-15)
    # The archive states its peak in gal, to three decimals.
    assert 100 * read.pga == pytest.approx(trace.stats.knet.accmax, abs=5.1e-4)
