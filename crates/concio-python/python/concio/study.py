"""Studies: many runs of one wall, resumed where they were left."""

from __future__ import annotations

import csv
import json
import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from . import _native
from ._progress import shown
from ._values import plain, to_json
from .distributed import Executor, rows
from .errors import InputError
from .record import Record
from .table import Table
from .wall import Wall

if TYPE_CHECKING:
    import pandas as pd

_WALL = "wall.json"
_STUDY = "study.json"
_QUESTIONS = ("sensitivity", "ida", "first-crack", "cracks", "ranking", "interfaces")


@dataclass(frozen=True)
class Uniform:
    """All values from ``low`` to ``high`` alike: numbers in SI, or texts with units."""

    low: Any
    high: Any

    def _distribution(self) -> dict[str, Any]:
        return {"law": "uniform", "low": self.low, "high": self.high}


@dataclass(frozen=True)
class LogUniform:
    """The logarithms of values from ``low`` to ``high`` alike."""

    low: Any
    high: Any

    def _distribution(self) -> dict[str, Any]:
        return {"law": "log-uniform", "low": self.low, "high": self.high}


@dataclass(frozen=True)
class Normal:
    """The bell curve, cut off at ``low`` and ``high`` where they are given."""

    mean: Any
    deviation: Any
    low: Any = None
    high: Any = None

    def _distribution(self) -> dict[str, Any]:
        return {"law": "normal", "mean": self.mean, "deviation": self.deviation, "low": self.low, "high": self.high}


@dataclass(frozen=True)
class LogNormal:
    """The bell curve of the logarithm; ``dispersion`` is its standard deviation."""

    median: Any
    dispersion: float
    low: Any = None
    high: Any = None

    def _distribution(self) -> dict[str, Any]:
        return {
            "law": "lognormal",
            "median": self.median,
            "dispersion": self.dispersion,
            "low": self.low,
            "high": self.high,
        }


@dataclass(frozen=True)
class Triangular:
    """From ``low`` up to ``mode`` and down to ``high``."""

    low: Any
    mode: Any
    high: Any

    def _distribution(self) -> dict[str, Any]:
        return {"law": "triangular", "low": self.low, "mode": self.mode, "high": self.high}


class Rows(Table):
    """The runs of a study, a row each: values of the factors, what was measured, how the run ended and what it warns of."""

    def __init__(self, columns: Mapping[str, Any], units: Mapping[str, str], done: bool) -> None:
        """Of the columns, their units, and whether all runs are done."""
        super().__init__(columns)
        self.units = dict(units)
        self.done = done

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Rows:
        """A table that a study left in its folder, such as ``fragility.csv``, ``first-crack.csv`` or ``ranking.csv``."""
        with open(path, encoding="utf-8", newline="") as text:
            head, *lines = csv.reader(text)
        parted = [name.removesuffix("]").partition(" [") if name.endswith("]") else (name, "", "") for name in head]
        columns = {name: _numbers([_cell(line[k]) for line in lines]) for k, (name, _, _) in enumerate(parted)}
        return cls(columns, {name: unit for name, _, unit in parted}, True)

    @property
    def frame(self) -> pd.DataFrame:
        """As a DataFrame of pandas, units in ``attrs``."""
        frame = super().frame
        frame.attrs["units"] = self.units
        return frame


class Study:
    """Many runs of one wall: what varies, under which motions, in which combinations.

    Example:
        >>> import concio, tempfile
        >>> from concio.study import Study, Uniform
        >>> wall = concio.Wall.example().replace({"motion.duration": "0.2 s"})
        >>> study = Study(wall, {"load.top": Uniform("20 kN/m", "60 kN/m")}, design="latin-hypercube", runs=3)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     rows = study.run(folder)
        >>> len(rows), rows.done, set(rows["end"])
        (3, True, {'completed'})
    """

    def __init__(
        self,
        wall: Wall,
        factors: Mapping[str, Any] | None = None,
        *,
        motions: Mapping[str, Record | Mapping[str, Any]] | None = None,
        scales: Sequence[float] = (),
        design: str = "grid",
        runs: int | None = None,
        seed: int = 1,
        title: str = "",
        keep: Sequence[str] = (),
        results: bool = False,
        question: Mapping[str, Any] | None = None,
    ) -> None:
        """Of a wall.

        Args:
            wall: What everything starts from.
            factors: Key paths of the wall file, each with a list of values or a distribution.
            motions: Motions of the base by name: records of files, or what stands at ``motion.base`` of a wall file.
            scales: Factors on the motion of the base, each above 0.
            design: ``"grid"``, ``"list"``, ``"latin-hypercube"``, ``"random"``, ``"morris"`` or ``"sobol"``.
            runs: Number of runs of a Latin hypercube or of random draws, of trajectories or base points.
            seed: Seed of everything that is drawn.
            title: Title in reports.
            keep: What is kept per joint, such as ``"slip"``.
            results: Keep the whole result of every run: large.
            question: What it asks, as a study file does: ``{"ida": {"damage": "peak_drift", ...}}``, ``{"ranking": {"by": ["slip"]}}``.
                The tables that answer are in the folder of :meth:`run`, for :meth:`Rows.read`.

        Raises:
            InputError: A record that no file gives: a study is resumed, and its inputs have to be on the disk.
        """
        settings = wall.given
        folder = os.path.abspath(wall._case.folder)
        for key in ("base", "top", "vertical"):
            signal = settings.get("motion", {}).get(key)
            if isinstance(signal, dict) and "record" in signal:
                signal["record"] = os.path.join(folder, signal["record"])
        study: dict[str, Any] = {"title": title, "wall": _WALL, "design": {"kind": design, "seed": seed}}
        if runs is not None:
            study["design"]["runs"] = runs
        if factors:
            study["vary"] = [_vary(path, over) for path, over in factors.items()]
        if motions:
            study["motion"] = [{"name": name, **_motion(name, base)} for name, base in motions.items()]
        if scales:
            study["scales"] = plain(list(scales), "scales")
        study["keep"] = {"joints": list(keep), "results": results}
        for name, table in (question or {}).items():
            if name not in _QUESTIONS:
                raise InputError(f"there is no question {name!r}", key="question", allowed=", ".join(_QUESTIONS))
            study[name] = plain(table, name)
        self._asks = bool(question)
        self._texts: dict[str, str] | None = {_WALL: to_json(settings), _STUDY: to_json(study)}
        self._file: str | None = None

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> Study:
        """Reads a study file. What is wrong with it is told by :meth:`run`."""
        study = cls.__new__(cls)
        study._texts, study._file, study._asks = None, os.path.abspath(path), False
        return study

    def run(
        self,
        folder: str | os.PathLike[str],
        *,
        threads: int = 0,
        progress: bool | Callable[[float], object] = False,
        executor: Executor | None = None,
        runs_per_task: int = 8,
    ) -> Rows:
        """Does the runs that the folder lacks, each known by the hash of everything that its result depends on.

        After Ctrl-C or an end by force the same call goes on. The folder is that of ``concio study run --out``.

        Args:
            folder: Where rows are kept; a study made in Python writes its study file there too.
            threads: Number of threads; 0 for one per core.
            progress: Show a bar, or call this with the share that is done, 0 … 1.
            executor: Has the runs done elsewhere: anything with ``submit`` that gives futures of :mod:`concurrent.futures`, such as
                a ``ProcessPoolExecutor``, ``dask.distributed.Client.get_executor()`` or ``mpi4py.futures``. Tables are the same, to the
                byte. Rows are kept as they come: a worker or a client that dies costs what it had under way.
            runs_per_task: Runs that a worker takes at a time.

        Returns:
            A row per run; of a study that asks a question, what its report has of every run: ``ida.csv``, ``first-crack-runs.csv`` or
            ``runs.csv`` in the folder. A run that failed says why in ``cause``; ``warning_kinds`` says what speaks against the others.

        Raises:
            InputError: What the study file may not say.
            Exception: What a task on an executor ended with; all rows that came before are kept.
        """
        if threads < 0:
            raise InputError(f"is {threads}", key="threads", allowed="from 0; 0 is one per core")
        out = os.fspath(folder)
        if os.path.exists(out) and not os.path.isdir(out):
            raise InputError("the folder for the results is a file", file=out, help="give another folder")
        file = self._file
        if file is None:
            os.makedirs(out, exist_ok=True)
            for name, text in (self._texts or {}).items():
                _write(os.path.join(out, name), text)
            file = os.path.join(out, _STUDY)
        if runs_per_task < 1:
            raise InputError(f"is {runs_per_task}", key="runs_per_task", allowed="from 1")
        given = None if executor is None else partial(rows, executor)
        with shown(progress) as told:
            columns, done = _native.study_run(file, out, threads, told, given, runs_per_task)
        if not done:
            warnings.warn("the study was stopped; the same call goes on", RuntimeWarning, stacklevel=2)
        if columns is None:
            return _report(file, out, done)
        if self._asks and done:
            _native.command(["concio", "study", "report", file, "--out", out])
        cells = {column["name"]: _numbers(column["cells"]) for column in columns}
        return Rows(cells, {column["name"]: column["unit"] for column in columns}, done)


def _report(file: str, out: str, done: bool) -> Rows:
    """The table of every run of a study that asks a question; its report and the other tables stay in the folder."""
    status = _native.command(["concio", "study", "report", file, "--out", out]) if done else 1
    tables = [os.path.join(out, name) for name in ("ida.csv", "first-crack-runs.csv", "runs.csv")]
    table = next((path for path in tables if os.path.exists(path)), None)
    if status != 0 or table is None:
        return Rows({}, {}, done)
    return Rows.read(table)


def _cell(text: str) -> Any:
    try:
        return float(text)
    except ValueError:
        return text or None


def _vary(path: str, over: Any) -> dict[str, Any]:
    if hasattr(over, "_distribution"):
        given = over._distribution()
        return {"path": path, "distribution": {key: value for key, value in given.items() if value is not None}}
    if isinstance(over, str | Mapping) or not hasattr(over, "__iter__"):
        raise InputError(
            f"{over!r} says not what it varies over", key=path, allowed="a list of values, or a distribution"
        )
    return {"path": path, "values": list(over)}


def _motion(name: str, base: Any) -> dict[str, Any]:
    if not isinstance(base, Record):
        return {"base": base}
    words = base._native.words("")
    if words is None:
        raise InputError(
            "the record is given by no file, or was treated in another order than a wall file's",
            key=name,
            allowed="records of files: trim, reversed, baseline, resample, scaled, in this order",
        )
    return {"base": json.loads(words), "duration": base.duration}


def _numbers(cells: list[Any]) -> list[Any]:
    """Cells without a value as numbers that are none, in columns of numbers."""
    if any(isinstance(cell, str) for cell in cells) or all(cell is None for cell in cells):
        return cells
    return [float("nan") if cell is None else cell for cell in cells]


def _write(path: str, text: str) -> None:
    """Whole or not at all."""
    temporary = f"{path}.{os.getpid()}.tmp"
    with open(temporary, "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(temporary, path)
