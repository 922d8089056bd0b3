"""Accelerograms: read from the files of the archives or given as arrays."""

from __future__ import annotations

import hashlib
import json
import os
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import _native
from ._files import write
from ._values import amount, have_units, number, samples, to_json
from .errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from .plot import RecordPlots


class Spectrum(NamedTuple):
    """Peaks of oscillators of one damping ratio, an array each."""

    period: NDArray[np.float64]
    """Natural periods [s]."""
    sd: NDArray[np.float64]
    """Largest relative displacement [m]."""
    psv: NDArray[np.float64]
    """Pseudo-velocity [m/s]."""
    psa: NDArray[np.float64]
    """Pseudo-acceleration [m/s²]."""
    damping: float
    """Damping ratio."""


# The first line of files that are made here: others are not replaced.
_WRITTEN = "# written by concio"
_LENGTHS = {"m", "cm", "mm", "um", "µm", "μm", "in", "ft"}


def _digest(path: str) -> bytes | None:
    """What tells whether a file is the same; none of one that cannot be read."""
    try:
        with open(path, "rb") as file:
            return hashlib.sha256(file.read()).digest()
    except OSError:
        return None


class Record:
    """An accelerogram at equal intervals, linear between its samples. Nothing changes it: what is done to it makes another.

    Runs of a record that was read take it from its file again, whose name results keep. Where the file was changed or removed meanwhile they
    raise an :class:`InputError`.

    Example:
        >>> import numpy as np, concio
        >>> t = np.arange(0, 4, 0.01)
        >>> quake = concio.Record.from_array(np.sin(2 * np.pi * t), dt=0.01)
        >>> round(quake.scaled(pga="0.35 g").pga, 4)
        3.4335
        >>> quake.trim("1 s", "3 s").duration
        2.0
    """

    def __init__(self, native: _native.Record, seen: bytes | None = None) -> None:
        """Made by :meth:`read`, :meth:`from_array` and :meth:`from_obspy`; ``seen`` is the digest of its file when it was read."""
        self._native = native
        self._seen = seen
        self._measures: dict[str, Any] | None = None

    @classmethod
    def read(
        cls,
        path: str | os.PathLike[str],
        *,
        channel: int | str | None = None,
        quantity: str | None = None,
        units: str | None = None,
        dt: float | str | None = None,
        layout: str | None = None,
    ) -> Record:
        """Reads a file of an archive or of text; its format is found from its content.

        Args:
            path: The file.
            channel: Component of a file with several: its number from 1, or a word of its name; default the first horizontal one.
            quantity: Of a text file, ``"acceleration"`` (default) or ``"displacement"``.
            units: Unit of a text file that names none.
            dt: Sample interval of a text file without a time column that names none [s].
            layout: Of a text file, ``"columns"`` or ``"rows"``.

        Raises:
            InputError: The file cannot be read, or a keyword does not suit it.
        """
        given = {"channel": channel, "quantity": quantity, "units": units, "dt": dt, "layout": layout}
        file = os.path.abspath(path)
        keys = {"record": file} | {key: value for key, value in given.items() if value is not None}
        seen = _digest(file)
        return cls(_native.Record.read(to_json(keys)), seen)

    @classmethod
    def from_array(cls, acceleration: ArrayLike, dt: float | str, *, units: str = "m/s2") -> Record:
        """Of samples of the acceleration.

        Args:
            acceleration: Samples, two or more: real numbers, none of them masked. A quantity, as of pint, is converted from its own unit.
            dt: Time from one to the next, 1e-6 … 100 s: a number in s, a text such as ``"5 ms"``, a quantity.
            units: Their unit, where they are no quantity; ``"g"`` is standard gravity, 9.80665 m/s², as archives mean it.

        Raises:
            InputError: Samples that are not finite numbers, an interval out of range, a unit that is none of acceleration.
        """
        if not isinstance(units, str):
            raise InputError(f"is {units!r}", key="units", allowed="a unit of acceleration, such as g or m/s2")
        values = samples(acceleration, "m/s**2", "acceleration")
        if have_units(acceleration) and units != "m/s2":
            what = f"is {units}, but the samples have a unit of their own"
            raise InputError(what, key="units", allowed="one of the two")
        return cls(_native.Record.from_array(values, amount(dt, "time", "s", "dt"), units))

    @classmethod
    def from_obspy(cls, trace: Any, *, units: str) -> Record:
        """Of a ``Trace`` of ObsPy, whose samples are an acceleration in ``units``: traces do not know their unit.

        Args:
            trace: One of ``obspy.read(path)``. Counts have to be made an acceleration first; ObsPy does not say whether they were, so
                ``stats.calib`` has to be 1.
            units: As of :meth:`from_array`.

        Raises:
            InputError: A ``Stream``, gaps, a calibration factor that was not applied; what :meth:`from_array` refuses.
        """
        if not hasattr(trace, "data"):
            what = f"a {type(trace).__name__} is no Trace"
            raise InputError(what, key="trace", help="take one of a Stream, such as stream[0]")
        if np.ma.is_masked(trace.data):
            raise InputError("it has gaps", key="trace", help="close them in ObsPy, or take what is between them")
        calib = float(getattr(trace.stats, "calib", 1.0))
        if calib != 1:
            what = f"its factor of calibration, stats.calib, is {calib:g}: whether its samples are counts or {units} is not known"
            help = "once it is applied, as obspy.read(path, apply_calib=True) does, set stats.calib = 1"
            raise InputError(what, key="trace", allowed="1", help=help)
        return cls.from_array(np.asarray(trace.data), float(trace.stats.delta), units=units)

    def scaled(self, factor: float | None = None, *, pga: float | str | None = None) -> Record:
        """Multiplied by a factor of either sign, or scaled to a peak acceleration [m/s², or a text such as ``"0.35 g"``].

        In texts g is 9.81 m/s², as in wall files.
        """
        if (factor is None) == (pga is None):
            raise InputError("give either a factor or a pga", key="pga", allowed="one of the two")
        return self._treated("scale", factor) if pga is None else self._treated("pga", pga)

    def __mul__(self, factor: float) -> Record:
        """:meth:`scaled` by a factor."""
        return self.scaled(factor)

    __rmul__ = __mul__

    def trim(self, start: float | str, end: float | str) -> Record:
        """From ``start`` to ``end`` [s, or texts with units]; it starts at t = 0 then."""
        return self._treated("trim", [start, end])

    def baseline(
        self, *, polynomial: int | None = None, high_pass: float | str | None = None, order: int | None = None
    ) -> Record:
        """With a corrected baseline.

        Args:
            polynomial: Degree of the least-squares polynomial that is taken off the acceleration, 0 … 6.
            high_pass: Corner of a Butterworth high-pass, forward and backward [Hz].
            order: Its order, 1 … 8; default 4.
        """
        given = {"polynomial": polynomial, "high_pass": high_pass, "order": order}
        return self._treated("baseline", {key: value for key, value in given.items() if value is not None})

    def resample(self, dt: float | str) -> Record:
        """At another interval [s]; before coarsening a low-pass takes away what would be mirrored into the band."""
        return self._treated("resample", dt)

    def reversed(self) -> Record:
        """The last sample first."""
        return self._treated("reverse", True)

    def _treated(self, key: str, value: Any) -> Record:
        return Record(self._native.treated(to_json({key: value})), self._seen)

    def save(self, path: str | os.PathLike[str]) -> Record:
        """Writes the samples to a file of text and gives the record of that file, the same to the bit.

        A wall file, a study or a result names a record by its file: give one of an array, or treated in another order than a wall file's, a
        file of its own first. A displacement history is written as such; ``quantity="displacement"`` reads it again.

        Raises:
            InputError: A file of that name that holds something else: runs read records again.

        Example:
            >>> import concio, os, tempfile
            >>> with tempfile.TemporaryDirectory() as folder:
            ...     quake = concio.Record.from_array([0, 1, -2, 0], dt=0.01).save(os.path.join(folder, "quake.txt"))
            >>> quake.facts["format"], quake.pga
            ('text', 2.0)
        """
        out = os.path.abspath(path)
        displaced = self.facts["units"].strip().lower() in _LENGTHS
        quantity, unit = ("displacement", "m") if displaced else ("acceleration", "m/s2")
        values = self.displacement if displaced else self.acceleration
        lines = [_WRITTEN, f"# dt = {self.dt!r} s", f"# {quantity} [{unit}]", *map(repr, values.tolist())]
        text = "\n".join(lines) + "\n"
        if os.path.exists(out):
            with open(out, "rb") as file:
                if file.read() != text.encode():
                    raise InputError(
                        "the file is there already, and holds something else", file=out, help="another name"
                    )
        else:
            write(out, text)
        return Record.read(out, quantity=quantity if displaced else None)

    @property
    def dt(self) -> float:
        """Time from one sample to the next [s]."""
        return self._native.dt

    @property
    def duration(self) -> float:
        """Time from the first sample to the last [s]."""
        return self._native.duration

    def in_words(self, folder: str | os.PathLike[str], key: str) -> dict[str, Any]:
        """What a wall file in ``folder`` says of it, at ``key``.

        Raises:
            InputError: It has no words: no file gives the record, or what was done to it came in another order. Its file was changed or removed
                since it was read.
        """
        words = self._words(folder)
        if words is None:
            raise InputError(
                "the record is given by no file, or was treated in another order than a wall file's",
                key=key,
                allowed="records of files: trim, reversed, baseline, resample, scaled, in this order",
                help='record.save("quake.txt") writes it to a file and gives the record of that file',
            )
        said: dict[str, Any] = json.loads(words)
        return said

    def _words(self, folder: str | os.PathLike[str]) -> str | None:
        """What a wall file in ``folder`` says of it, none where it has no words; its file is the one that was read."""
        words = self._native.words("")
        if words is None:
            return None
        file = str(json.loads(words)["record"])
        if _digest(file) != self._seen:
            there = "was changed" if os.path.exists(file) else "is gone"
            what = f"the file of the record {there} since it was read, and runs read it again"
            help = 'read it again, or run record.save("other.txt"), which writes these samples to a file of their own'
            raise InputError(what, file=file, help=help)
        return self._native.words(folder)

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **kwargs: Any) -> Any:
        """Functions of NumPy take its samples; a number times a record is a record, whoever made the number."""
        others = [each for each in inputs if not isinstance(each, Record)]
        if (ufunc, method) == (np.multiply, "__call__") and not kwargs and [*map(np.ndim, others)] == [0]:
            return self.scaled(others[0])
        plain = [np.asarray(each) if isinstance(each, Record) else each for each in inputs]
        return getattr(ufunc, method)(*plain, **kwargs)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        """Samples of the acceleration [m/s²], for functions of NumPy."""
        return np.array(self.acceleration, dtype=dtype)

    def __len__(self) -> int:
        """Number of samples."""
        return len(self.acceleration)

    @property
    def acceleration(self) -> NDArray[np.float64]:
        """Samples of the acceleration [m/s²]."""
        return self._native.acceleration()

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Velocity at the samples [m/s], integrated from rest."""
        return self._native.integrated()[0]

    @property
    def displacement(self) -> NDArray[np.float64]:
        """Displacement at the samples [m], integrated from rest; of a displacement history its own."""
        return self._native.integrated()[1]

    @property
    def time(self) -> NDArray[np.float64]:
        """Times of the samples [s]."""
        return np.arange(len(self), dtype=np.float64) * self.dt

    @property
    def measures(self) -> dict[str, Any]:
        """All measures, SI: peaks with their times, intensities, durations."""
        if self._measures is None:
            self._measures = self._native.measures()
        return self._measures

    @property
    def pga(self) -> float:
        """Peak ground acceleration [m/s²], from 0."""
        return abs(float(self.measures["pga"]["value"]))

    @property
    def pgv(self) -> float:
        """Peak ground velocity [m/s], from 0."""
        return abs(float(self.measures["pgv"]["value"]))

    @property
    def pgd(self) -> float:
        """Peak ground displacement [m], from 0."""
        return abs(float(self.measures["pgd"]["value"]))

    @property
    def arias(self) -> float:
        """Arias intensity [m/s]."""
        return float(self.measures["arias"])

    @property
    def d5_95(self) -> float:
        """Significant duration, from 5 % to 95 % of the Arias intensity [s]."""
        return float(self.measures["d5_95"])

    @property
    def components(self) -> list[str]:
        """Names of the components in its file."""
        return self._native.components

    @property
    def facts(self) -> dict[str, Any]:
        """Format, station, event, channel, unit and remarks, as its file has them."""
        return self._native.facts()

    def spectrum(self, periods: ArrayLike | None = None, *, damping: float = 0.05) -> Spectrum:
        """Response spectrum; oscillators start at rest and swing on when the motion has ended.

        Args:
            periods: Natural periods [s]; default 200 from 0.02 to 5 s at equal ratios.
            damping: Damping ratio, from 0 to below 1.

        Raises:
            InputError: Periods or a damping ratio that are none.
        """
        wanted = np.geomspace(0.02, 5.0, 200) if periods is None else samples(periods, "s", "periods")
        if not np.all(np.isfinite(wanted) & (wanted >= 0)):
            raise InputError("are no natural periods", key="periods", allowed="numbers from 0 in one row [s]")
        damping = number(damping, "damping", "a ratio from 0 to below 1, such as 0.05")
        if not 0 <= damping < 1:
            raise InputError(f"is {damping}", key="damping", allowed="from 0 to below 1")
        found = self._native.spectrum(wanted, damping)
        return Spectrum(wanted, found["sd"], found["psv"], found["psa"], damping)

    @property
    def plot(self) -> RecordPlots:
        """Figures, by Matplotlib: ``record.plot.history()``, ``record.plot.spectrum()``."""
        from .plot import RecordPlots

        return RecordPlots(self)

    def __reduce__(self) -> tuple[Any, ...]:
        """For other processes, which get the samples and no file."""
        return Record.from_array, (np.array(self.acceleration), self.dt)

    def __repr__(self) -> str:
        """Format, length and peak."""
        facts = self.facts
        place = ", ".join(word for word in (facts["station"], facts["event"], facts["channel"]) if word)
        head = f"Record ({facts['format']})" + (f": {place}" if place else "")
        return f"{head}\n{len(self)} samples every {self.dt:g} s, {self.duration:g} s\nPGA {self.pga:.4g} m/s²"
