"""Runs that are over: histories, frames, peaks, energies, and what speaks against believing them."""

from __future__ import annotations

import difflib
import json
import os
import tempfile
import warnings
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from html import escape
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _native
from ._progress import shown
from ._values import threads_of
from .errors import InputError
from .table import Table, in_si

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    import pandas as pd
    import xarray as xr
    from numpy.typing import NDArray

    from .plot import RunPlots
    from .wall import Wall


class Warned(NamedTuple):
    """What a user should know before believing a run."""

    kind: str
    """Its kind, a word that stays."""
    text: str
    """The sentence."""

    def __str__(self) -> str:
        """The sentence."""
        return self.text


_FILES = ("result.h5", "summary.json")
_BESIDE = "motion-in-no-file"  # the kind of warning of a run whose motion its result does not hold


class Channel(NamedTuple):
    """What a history is."""

    name: str
    """Its name, such as ``top/force``."""
    unit: str
    """SI unit."""
    description: str
    """What it is, in a sentence."""


class Run(Mapping[str, "NDArray[np.float64]"]):
    """A run that is over, a mapping of its histories: ``run["top/force"]``, at the times ``run.time``.

    Arrays are read-only and share the memory in which the engine left them.

    Example:
        >>> import concio
        >>> run = concio.Wall.example().run(duration="1 s")
        >>> run.ok, run.stop_reason
        (True, 'completed')
        >>> run["base/shear"].shape == run.time.shape
        True
        >>> run.energy_residual < 0.01
        True
    """

    def __init__(self, native: _native.Run, folder: str | None = None) -> None:
        """Made by :meth:`concio.Wall.run`, :func:`concio.run_many` and :func:`concio.open`; paths of its records begin at ``folder``."""
        self._native = native
        self._folder = folder

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        """A history, a value per sample, SI."""
        if not isinstance(name, str):
            names = ", ".join(map(repr, list(self)[:3]))
            raise TypeError(f"histories are asked by their name, such as {names}; {name!r} is none")
        place = self._places.get(name)
        if place is None:
            near = difflib.get_close_matches(name, self._places, n=3)
            hint = f"did you mean {' or '.join(map(repr, near))}?" if near else "run.channels names them"
            more = (
                "; histories of blocks and joints are kept where output.blocks and output.joints say so"
                if "/" in name
                else ""
            )
            raise KeyError(f"no history {name!r}: {hint}{more}")
        return self._native.values[:, place]

    def __contains__(self, name: object) -> bool:
        """Whether there is a history of this name."""
        return isinstance(name, str) and name in self._places

    def __iter__(self) -> Iterator[str]:
        """Names of the histories."""
        return iter(self._places)

    def __len__(self) -> int:
        """Number of histories."""
        return len(self._places)

    @cached_property
    def channels(self) -> Mapping[str, Channel]:
        """Unit and meaning of every history."""
        return MappingProxyType({name: Channel(name, *rest) for name, *rest in self._native.channels()})

    @cached_property
    def _places(self) -> dict[str, int]:
        return {name: place for place, name in enumerate(self.channels)}

    @property
    def time(self) -> NDArray[np.float64]:
        """Times of the samples [s]."""
        return self._native.time

    @property
    def frame_time(self) -> NDArray[np.float64]:
        """Times of the frames [s]."""
        return self._native.frame_time

    @property
    def frames(self) -> Mapping[str, NDArray[np.float64]]:
        """Frames by quantity, a row per frame, SI.

        ``displacement``, ``velocity`` and ``acceleration`` (horizontal), of planar walls ``vertical`` and ``rotation`` too, have a column per block
        and one for a beam with motion of its own; ``friction``, ``slip``, ``opening`` and ``pressure`` one per joint; ``damage`` one per bonded
        joint. What a run does not keep is left out.
        """
        return MappingProxyType({name: rows for name, rows in self._native.frames().items() if rows.shape[1] > 0})

    @cached_property
    def summary(self) -> dict[str, Any]:
        """What ``summary.json`` holds."""
        return self._native.summary()

    @property
    def stop_reason(self) -> str:
        """Why it ended: ``completed``, ``collapsed``, ``interrupted``, ``step-too-short`` or ``not-finite``."""
        return str(self.summary["stop_reason"])

    @property
    def ok(self) -> bool:
        """Whether it went as far as it was to go. That does not make it right: see :attr:`warnings` and :attr:`energy_residual`."""
        return self.stop_reason in ("completed", "collapsed")

    @property
    def time_reached(self) -> float:
        """Time reached [s]."""
        return float(self.summary["time_reached"])

    @property
    def energy(self) -> dict[str, float]:
        """The energy account at the end [J], and its largest residual over the largest energy in play."""
        energy: dict[str, float] = self.summary["energy"]
        return energy

    @property
    def energy_residual(self) -> float:
        """Largest residual of the energy account over the largest energy in play."""
        return float(self.energy["residual_relative"])

    @property
    def warnings(self) -> list[Warned]:
        """What speaks against believing the run."""
        pairs = zip(self.summary["warning_kinds"], self.summary["warnings"], strict=True)
        return [Warned(*pair) for pair in pairs]

    @property
    def failure(self) -> dict[str, Any] | None:
        """How a planar wall failed; none where it did not."""
        failure: dict[str, Any] | None = self.summary["failure"]
        return failure

    @property
    def collapse(self) -> dict[str, Any] | None:
        """When and how a planar wall collapsed; none where it did not."""
        collapse: dict[str, Any] | None = self.summary["collapse"]
        return collapse

    @property
    def inputs_hash(self) -> str:
        """Hash over everything that the result depends on."""
        return str(self.summary["inputs_hash"])

    @property
    def wall(self) -> Wall:
        """The wall that was run, as results keep it.

        The motion of a record that no file gives is not in it: :meth:`concio.Wall.check` says so, and running it without ``base`` warns of it.
        """
        from .wall import Wall

        place = os.path.join(os.path.abspath(self._folder or os.curdir), "wall.json")
        wall = Wall(_native.Case.parse(self._native.case, True, place, False))
        wall._lost = any(warned.kind == _BESIDE for warned in self.warnings)
        return wall

    @property
    def blocks(self) -> Table:
        """The blocks and their peaks, SI, as ``units`` of the table names."""
        return in_si(self._native.blocks())

    @property
    def joints(self) -> Table:
        """The joints, their laws and peaks, SI, as ``units`` of the table names; ``slip`` is the path slipped [m]."""
        return in_si(self._native.joints())

    @property
    def events(self) -> Table:
        """Impacts, cracks, crushing and collapse, in the order of time."""
        return in_si(self._native.events())

    @property
    def drifts(self) -> Table:
        """How far every top went [m]: ``peak`` and its time [s], what is left at the end, and how far it still swings to either side of that."""
        rows = self._native.drifts()
        return in_si(
            {name: [row[name] for row in rows] for name in ("top", "height", "peak", "time", "residual", "swing")}
        )

    def to_xarray(self) -> xr.Dataset:
        """Everything as a Dataset of xarray, with units in ``attrs``; dimensions time, frame, body, block and joint."""
        from .frames import dataset

        return dataset(self)

    def to_frame(self) -> pd.DataFrame:
        """The histories as a DataFrame of pandas, over the time [s]."""
        from .frames import histories

        return histories(self)

    @property
    def plot(self) -> RunPlots:
        """Figures, by Matplotlib: ``run.plot.history("top/force")``, ``run.plot.hysteresis()``, ``run.plot.deformed()``."""
        from .plot import RunPlots

        return RunPlots(self)

    def save(self, folder: str | os.PathLike[str]) -> None:
        """Writes ``result.h5`` and ``summary.json`` into a folder, as the command line does.

        ``result.h5`` has the bytes of the command line's. Results of other inputs in the folder are removed. The motion of a record that no file
        gives is not in them, of which a ``UserWarning`` tells.
        """
        _refuse_a_file(folder)
        self._tell_beside()
        self._native.save(os.fspath(folder))

    def report(self, path: str | os.PathLike[str] = "report.html") -> None:
        """Writes the report, a page without references to others; of a motion that it does not hold a ``UserWarning`` tells."""
        self._tell_beside()
        name = os.path.splitext(os.path.basename(os.fspath(path)))[0]
        self._native.report(os.fspath(path), name)

    def _tell_beside(self) -> None:
        for warned in self.warnings:
            if warned.kind == _BESIDE:
                remedy = (
                    'run it with record.save("quake.txt"), which writes the record to a file and gives that of the file'
                )
                warnings.warn(f"{warned}; {remedy}", UserWarning, stacklevel=3)

    def __reduce__(self) -> tuple[Any, ...]:
        """For other processes: the bytes of its files."""
        with tempfile.TemporaryDirectory() as folder:
            self._native.save(folder)
            files = {name: Path(folder, name).read_bytes() for name in _FILES}
        return _again, (files, self._native.text, self._folder)

    def __eq__(self, other: object) -> bool:
        """Whether it is the same object."""
        return self is other

    def __hash__(self) -> int:
        """By the object."""
        return id(self)

    def __repr__(self) -> str:
        """How it ended, its energy account, its warnings."""
        return "\n".join(self._lines())

    def _lines(self) -> list[str]:
        end = "" if self.ok else ": it did not go as far as it was to go"
        lines = [
            f"Run: {self.stop_reason} at t = {self.time_reached:g} s{end}",
            f"{len(self.time)} samples of {len(self)} histories, {len(self.frame_time)} frames",
            f"energy account closes to {self.energy_residual:.1e}",
        ]
        return lines + [f"warning: {warning}" for warning in self.warnings]

    def _repr_html_(self) -> str:
        return "<p>" + "<br>".join(escape(line) for line in self._lines()) + "</p>"


def open(folder: str | os.PathLike[str]) -> Run:
    """Reads a run back from its folder, or its ``result.h5`` there, bit for bit what was written.

    Of a study that kept results it opens ``results/ID.h5`` too. Beside such a file stands no summary: what only that knows is None, such as
    ``summary["weight"]``, and instead of the warnings of the run one says where they are.

    Raises:
        InputError: A file that is broken, foreign, changed or of another version.
        OSError: A file that cannot be read.
    """
    place = os.fspath(folder)
    if os.path.basename(place) == "result.h5" and os.path.isfile(place):
        place = os.path.dirname(place) or os.curdir
    elif os.path.isfile(place):
        return Run(_native.Run.read(place))
    return Run(_native.Run.open(place, None))


def run_many(
    runs: Sequence[Wall | tuple[Wall, Any]], *, threads: int = 0, progress: bool | Callable[[float], object] = False
) -> list[Run]:
    """Simulates many walls at once, alike ones of the shear model side by side in the lanes of vector instructions.

    A run has the bits that it has alone. All results are held in memory: of many runs, make a study.

    Args:
        runs: Walls, or pairs of a wall and what moves its base (see :meth:`concio.Wall.run`).
        threads: Number of threads, no more than runs are used; 0 for one per core.
        progress: Show a bar, or call this with the share that is done, 0 … 1.

    Returns:
        The runs in their order. After Ctrl-C those that were under way are not ``ok``, and those that had not begun are left out.

    Raises:
        InputError: As :meth:`concio.Wall.run`, before anything runs.
    """
    from .wall import Wall

    threads = threads_of(threads)
    allowed = "walls, or pairs of a wall and a motion"
    if isinstance(runs, Wall) or not hasattr(runs, "__iter__"):
        raise InputError(f"a {type(runs).__name__} is no list", key="runs", allowed=f"a list of {allowed}")
    prepared, folders = [], []
    for number, asked in enumerate(runs):
        pair: Any = asked if isinstance(asked, tuple | list) and len(asked) == 2 else (asked, None)
        wall, base = pair
        if not isinstance(wall, Wall):
            raise InputError(f"number {number} is no wall", key="runs", allowed=allowed)
        prepared.append(wall._moved(base))
        folders.append(str(wall._case.folder))
    with shown(progress) as told:
        ended, interrupted = _native.run_many(prepared, min(threads, len(prepared)), told)
        if told is not None and not interrupted:
            told(1.0)
    if interrupted:
        warnings.warn(
            f"the runs were stopped: {ended.count(None)} that had not begun are left out", RuntimeWarning, stacklevel=2
        )
    return [Run(run, folder) for run, folder in zip(ended, folders, strict=True) if run is not None]


def _again(files: Mapping[str, bytes], text: str | None, place: str | None) -> Run:
    with tempfile.TemporaryDirectory() as folder:
        for name, content in files.items():
            Path(folder, name).write_bytes(content)
        return Run(_native.Run.open(folder, text), place)


def _refuse_a_file(folder: str | os.PathLike[str]) -> None:
    if os.path.exists(folder) and not os.path.isdir(folder):
        raise InputError("the folder for the results is a file", file=os.fspath(folder), help="give another folder")


def settings_of(run: Run) -> dict[str, Any]:
    """The resolved wall file of a run."""
    settings: dict[str, Any] = json.loads(run._native.case)
    return settings
