"""Studies: many runs of one wall, resumed where they were left."""

from __future__ import annotations

import csv
import json
import os
import re
import sys
import tempfile
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import _native
from ._files import write
from ._progress import shown
from ._values import count, plain, threads_of, to_json
from .distributed import Executor, rows
from .errors import InputError
from .record import Record
from .table import Table
from .wall import _LOST, Wall

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

_WALL = "wall.json"
_STUDY = "study.json"


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

    def __init__(
        self, columns: Mapping[str, Any], units: Mapping[str, str], done: bool, study: tuple[str, str] | None = None
    ) -> None:
        """Of the columns, their units, whether all runs are done, and the study file with its folder."""
        super().__init__(columns, units)
        self.done = done
        self._study = study
        self._asked = None if study is None else _text(study[0])

    @cached_property
    def tables(self) -> Mapping[str, Table]:
        """What the report of the study says, by the names of its files: ``rows.tables["sensitivity"]``, ``["fragility"]``, ``["first-crack"]``.

        Reading it writes ``report.html`` and the tables into the folder, as ``concio study report`` does; the documents say what is in them.
        What the command would warn of is a ``UserWarning``.

        Raises:
            InputError: Another study was run in the folder since.
            RuntimeError: The report cannot be written.
        """
        if self._study is not None and _text(self._study[0]) != self._asked:
            what = "another study was run in the folder since: these rows have no tables any more"
            raise InputError(what, file=self._study[0], help="run this study again, in a folder of its own")
        return MappingProxyType({} if self._study is None else _report(*self._study))


class Checked(NamedTuple):
    """What is known of a study before any run."""

    runs: Table
    """The runs of its design, a row each with the values of its factors. With ``ida`` each is a curve, with ``first_crack`` a search."""
    doubts: list[str]
    """What is allowed and hardly meant, and what speaks against believing what it will answer."""


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
        levels: int | None = None,
        seed: int = 1,
        title: str = "",
        keep: Sequence[str] = (),
        results: bool = False,
        sensitivity: Mapping[str, Any] | None = None,
        ida: Mapping[str, Any] | None = None,
        first_crack: Mapping[str, Any] | None = None,
        cracks: Mapping[str, Any] | None = None,
        ranking: Mapping[str, Any] | None = None,
        interfaces: Mapping[str, Any] | None = None,
    ) -> None:
        """Of a wall, and what is asked of its runs: the questions are the tables of a study file, in its words.

        What they answer is in ``rows.tables``, of which each question names those that it makes.

        Args:
            wall: What everything starts from.
            factors: Key paths of the wall file, each with a list of values, a distribution, or a dict of what a study file says of a factor:
                ``{"from": 0.4, "to": 0.8, "also": [{"path": "joint.friction.dynamic", "times": 0.7}]}``. Of named ``choices`` the
                name instead of the path.
            motions: Motions of the base by name: records of files, or what stands at ``motion.base`` of a wall file.
            scales: Factors on the motion of the base, each above 0.
            design: ``"grid"``, ``"list"``, ``"latin-hypercube"``, ``"random"``, ``"morris"`` or ``"sobol"``.
            runs: Number of runs of a Latin hypercube or of random draws, of trajectories or base points.
            levels: Levels of each factor in design ``"morris"``; default 4.
            seed: Seed of everything that is drawn.
            title: Title in reports.
            keep: What is kept per joint, such as ``"slip"``.
            results: Keep the whole result of every run: large.
            sensitivity: Which factors matter: ``{"of": ["peak_drift"]}``; ``sensitivity``.
            ida: Every motion at rising intensity, and how probable limits are: ``{"damage": "largest_slip", "limits": [{"name": "slip",
                "value": "1 mm"}], "hunt": {"first": "0.1 g", "step": "0.1 g", "most": "2 g"}}``; ``capacities``, ``fragility``,
                ``fractiles``, ``fragility_curves``.
            first_crack: At which scale of each motion a first joint cracks: ``{}`` or ``{"criterion": "slip"}``; ``first-crack``.
            cracks: Where cracks run: ``{}`` or ``{"threshold": 0.3}``; ``cracks``, ``crack-lines``.
            ranking: Which joints are critical: ``{}`` or ``{"by": ["slip"]}``; ``ranking``.
            interfaces: Which joints should be replaced by what; ``interfaces``.

        Raises:
            InputError: A record that no file gives: a study is resumed, and its inputs have to be on the disk. What the questions may not
                say is told by :meth:`run`.
        """
        settings = wall.given
        folder = os.path.abspath(wall._case.folder)
        for key in ("base", "top", "vertical"):
            signal = settings.get("motion", {}).get(key)
            if isinstance(signal, dict) and "record" in signal:
                signal["record"] = os.path.join(folder, signal["record"])
        study: dict[str, Any] = {"title": title, "wall": _WALL, "design": {"kind": design, "seed": seed}}
        study["design"] |= {key: n for key, n in (("runs", runs), ("levels", levels)) if n is not None}
        if factors:
            study["vary"] = [_vary(path, over) for path, over in factors.items()]
        if motions:
            study["motion"] = [{"name": name, **_motion(name, base, wall)} for name, base in motions.items()]
        scales = () if scales is None else scales
        if isinstance(scales, str) or not hasattr(scales, "__iter__"):
            raise InputError(f"{scales!r} is no list", key="scales", allowed="a list of factors, such as [0.5, 1]")
        if wall._lost and not motions:
            warnings.warn(_LOST, UserWarning, stacklevel=2)
        if len(scales) > 0:
            study["scales"] = plain(list(scales), "scales")
        study["keep"] = {"joints": list(keep), "results": results}
        questions = {
            "sensitivity": sensitivity,
            "ida": ida,
            "first-crack": first_crack,
            "cracks": cracks,
            "ranking": ranking,
            "interfaces": interfaces,
        }
        study |= {name: plain(asked, name) for name, asked in questions.items() if asked is not None}
        self._texts: dict[str, str] | None = {_WALL: to_json(settings), _STUDY: to_json(study)}
        self._file: str | None = None
        self._records = [base for base in (motions or {}).values() if isinstance(base, Record)]

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> Study:
        """Reads a study file. What is wrong with it is told by :meth:`run`."""
        study = cls.__new__(cls)
        study._texts, study._file, study._records = None, os.path.abspath(path), []
        return study

    def check(self) -> Checked:
        """The runs of its design and what is doubtful, as ``concio study check`` tells; nothing is run.

        Raises:
            InputError: As :meth:`run`.

        Example:
            >>> import concio
            >>> study = concio.Study(concio.Wall.example(), {"joint.friction.static": [0.5, 0.6]}, scales=[1, 2])
            >>> runs, doubts = study.check()
            >>> len(runs), list(runs.take([3]))
            (4, [{'run': 4.0, 'joint.friction.static': 0.6, 'scale': 2.0}])
        """
        self._look_at_records()
        if self._file is not None:
            columns, doubts = _native.study_check(self._file)
            return Checked(Table(*_cells(columns)), doubts)
        # It is in no file yet.
        with tempfile.TemporaryDirectory() as folder:
            for name, text in (self._texts or {}).items():
                write(os.path.join(folder, name), text)
            try:
                columns, doubts = _native.study_check(os.path.join(folder, _STUDY))
            except InputError as error:
                for told in (error, *error.more):
                    if told.file is not None and os.path.dirname(told.file) == folder:
                        told.file = told.line = told.column = None
                raise
        return Checked(Table(*_cells(columns)), doubts)

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
            A row per run, those of curves and searches too. A run that failed says why in ``cause``; ``warning_kinds`` says what speaks
            against the others. ``rows.tables`` has what the study answers.

        Raises:
            InputError: What the study file may not say.
            Exception: What a task on an executor ended with; all rows that came before are kept.
        """
        threads = threads_of(threads)
        if count(runs_per_task, "runs_per_task", "from 1") < 1:
            raise InputError(f"is {runs_per_task}", key="runs_per_task", allowed="from 1")
        self._look_at_records()
        out = os.path.abspath(folder)
        if os.path.exists(out) and not os.path.isdir(out):
            raise InputError("the folder for the results is a file", file=out, help="give another folder")
        file = self._file
        before: dict[str, str | None] = {}
        if file is None:
            os.makedirs(out, exist_ok=True)
            for name, text in (self._texts or {}).items():
                _refuse_another(os.path.join(out, name), text)
            before = {name: _text(os.path.join(out, name)) for name in self._texts or {}}
            for name, text in (self._texts or {}).items():
                write(os.path.join(out, name), text)
            file = os.path.join(out, _STUDY)
        client: Any = executor
        if hasattr(client, "get_executor"):
            executor = client.get_executor()  # Dask's client itself was given
        given = None if executor is None else partial(rows, executor)
        try:
            with shown(progress) as told:
                columns, done = _native.study_run(file, out, threads, told, given, runs_per_task)
                if told is not None and done:
                    told(1.0)
        except InputError:
            # A study that is refused leaves its folder as it was.
            for name, earlier in before.items():
                if earlier is None:
                    os.remove(os.path.join(out, name))
                else:
                    write(os.path.join(out, name), earlier)
            raise
        if not done:
            warnings.warn("the study was stopped; the same call goes on", RuntimeWarning, stacklevel=2)
        if columns is None:
            return _asked(file, out, done)
        return Rows(*_cells(columns), done, (file, out))

    @property
    def salib_problem(self) -> dict[str, Any]:
        """The factors as a problem of SALib: ``num_vars``, ``names``, ``bounds``, ``dists``.

        Bounds have the units of the columns of rows, those in which the factors were given; :meth:`at` runs what SALib draws.

        Raises:
            InputError: Factors for which SALib has no distribution: lists of values, named choices, motions, scales, a lognormal that is cut off.

        Example:
            >>> import concio
            >>> study = concio.Study(concio.Wall.example(), {"load.top": concio.Uniform("20 kN/m", "60 kN/m")}, design="random", runs=8)
            >>> study.salib_problem
            {'num_vars': 1, 'names': ['load.top'], 'bounds': [[20.0, 60.0]], 'dists': ['unif']}
        """
        names, laws, bounds, _ = zip(*map(_drawn, *self._factors()), strict=True)
        return {"num_vars": len(names), "names": list(names), "bounds": list(bounds), "dists": list(laws)}

    def at(self, samples: ArrayLike) -> Study:
        """The same study at values that another program drew, such as SALib of :attr:`salib_problem`.

        Its rows have no columns of the factors: the row whose ``sample`` is ``k`` was run with ``samples[k - 1]``, in the units of
        :attr:`salib_problem`. What it measured is in SI, as in all rows.

        Args:
            samples: A row per run, a column per factor, in the order and the units of :attr:`salib_problem`; 10,000 rows at most. The column
                ``sample`` of the rows is the number of the row, from 1.

        Raises:
            InputError: No table of numbers with a column per factor.
        """
        factors, keys = self._factors()
        units = [unit for *_, unit in map(_drawn, factors, keys)]
        try:
            values = np.asarray(samples, dtype=np.float64)
        except (TypeError, ValueError):
            raise InputError("is no table of numbers", key="samples", allowed="a row per run") from None
        if values.ndim != 2 or values.shape[1] != len(factors) or len(values) == 0:
            what = f"has the shape {values.shape}"
            raise InputError(what, key="samples", allowed=f"a row per run, {len(factors)} columns, as many as factors")
        choices = []
        for number, row in enumerate(values.tolist(), start=1):
            changes: dict[str, Any] = {}
            for vary, unit, value in zip(factors, units, row, strict=True):
                for path, times in [(vary["path"], 1.0), *((f["path"], f["times"]) for f in vary.get("also", ()))]:
                    changes[path] = f"{value * times!r} {unit}" if unit else value * times
            choices.append({"name": str(number), "set": changes})
        table = self._table() | {"vary": [{"name": "sample", "choices": choices}], "design": {"kind": "grid"}}
        if self._file is not None:
            table["wall"] = os.path.join(os.path.dirname(self._file), table["wall"])
        study = Study.__new__(Study)
        study._texts, study._file = (self._texts or {}) | {_STUDY: to_json(table)}, None
        study._records = self._records
        return study

    def _look_at_records(self) -> None:
        """Refuses records whose files are not those that were read."""
        for record in self._records:
            record._words("")

    def _table(self) -> dict[str, Any]:
        """What the study file says."""
        if self._file is None:
            table: dict[str, Any] = json.loads((self._texts or {})[_STUDY])
            return table
        with open(self._file, "rb") as file:
            text = file.read()
        try:
            table = json.loads(text)
        except ValueError:
            try:
                table = tomllib.loads(text.decode())
            except ValueError as error:
                raise InputError(f"is neither JSON nor TOML: {error}", file=self._file) from None
        return table

    def _factors(self) -> tuple[list[dict[str, Any]], list[str]]:
        """The entries of ``vary`` with their keys, where they are all that varies."""
        table = self._table()
        for key in ("motion", "scales"):
            if table.get(key):
                raise InputError(
                    "is a factor that has no distribution",
                    key=key,
                    help="the wall file may say what moves its base: one study per motion or scale then",
                )
        factors: list[dict[str, Any]] = table.get("vary", [])
        if not factors:
            raise InputError("nothing varies", key="vary", allowed="one factor or more")
        return factors, [f"vary[{k}]" for k in range(len(factors))]


# What a study that asks a question has of every run.
_RUNS = ("ida", "first-crack-runs", "runs")


def _asked(file: str, out: str, done: bool) -> Rows:
    """The runs of a study that asks a question, which only its report has."""
    if not done:
        return Rows({}, {}, done)
    tables = _report(file, out)
    runs = next((tables[name] for name in _RUNS if name in tables), None)
    if runs is None:
        raise RuntimeError(f"{out} has no table of runs: the study has not ended, run it again")
    rows = Rows({name: runs[name] for name in runs.keys()}, runs.units, done, (file, out))
    rows.__dict__["tables"] = MappingProxyType(tables)
    return rows


def _report(file: str, out: str) -> dict[str, Table]:
    """The tables that the report writes; others, of earlier questions, may lie in the folder.

    What the command would warn of is a ``UserWarning``.
    """
    before = _written(out)
    for told in _native.study_report(file, out):
        if told.startswith("warning: "):
            warnings.warn(told.removeprefix("warning: "), UserWarning, stacklevel=4)
    after = _written(out)
    return {name: _read(os.path.join(out, f"{name}.csv")) for name in after if after[name] != before.get(name)}


def _written(folder: str) -> dict[str, tuple[int, int]]:
    """The tables of a folder, each with what tells whether it was written anew."""
    if not os.path.isdir(folder):
        return {}
    with os.scandir(folder) as entries:
        found = ((entry.name.removesuffix(".csv"), entry.stat()) for entry in entries if entry.name.endswith(".csv"))
        return {name: (stat.st_ino, stat.st_mtime_ns) for name, stat in sorted(found, key=lambda pair: pair[0])}


def _read(path: str) -> Table:
    with open(path, encoding="utf-8", newline="") as text:
        head, *lines = csv.reader(text)
    parted = [name.removesuffix("]").partition(" [") if name.endswith("]") else (name, "", "") for name in head]
    columns = {name: _numbers([_cell(line[k]) for line in lines]) for k, (name, _, _) in enumerate(parted)}
    return Table(columns, {name: unit for name, _, unit in parted})


def _drawn(vary: Mapping[str, Any], key: str) -> tuple[str, str, list[float], str]:
    """Name, law and parameters of a factor in the words of SALib, and its unit."""
    if "distribution" in vary:
        given: dict[str, Any] = vary["distribution"]
    elif "from" in vary and "to" in vary:
        given = {"law": "log-uniform" if vary.get("spacing") == "log" else "uniform"}
        given |= {"low": vary["from"], "high": vary["to"]}
    else:
        raise InputError("values one by one have no distribution", key=key, allowed="a range or a distribution")
    parted = {name: _amount(value) for name, value in given.items() if name != "law"}
    units = {unit for name, (_, unit) in parted.items() if name != "dispersion"}
    if len(units) != 1:
        raise InputError("has several units, or none", key=key, allowed="all parameters in one unit")
    at = {name: number for name, (number, _) in parted.items()}
    name, (unit,) = vary.get("name", vary.get("path", "")), units
    match given["law"]:
        case "uniform":
            return name, "unif", [at["low"], at["high"]], unit
        case "log-uniform":
            return name, "logunif", [at["low"], at["high"]], unit
        case "normal" if "low" in at or "high" in at:
            ends = [at.get("low", -np.inf), at.get("high", np.inf)]
            return name, "truncnorm", [*ends, at["mean"], at["deviation"]], unit
        case "normal":
            return name, "norm", [at["mean"], at["deviation"]], unit
        case "lognormal" if "low" not in at and "high" not in at:
            return name, "lognorm", [float(np.log(at["median"])), at["dispersion"]], unit
        case "triangular":
            share = (at["mode"] - at["low"]) / (at["high"] - at["low"])
            return name, "triang", [at["low"], at["high"], share], unit
    allowed = "uniform, log-uniform, normal, triangular, lognormal without low and high"
    raise InputError(f"SALib has no such distribution: {given['law']}", key=key, allowed=allowed)


_NUMBER = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*")


def _amount(value: Any) -> tuple[float, str]:
    """Number and unit of what stands in a file."""
    found = _NUMBER.fullmatch(value) if isinstance(value, str) else None
    if found is not None:
        return float(found[1]), found[2]
    try:
        return float(value), ""
    except (TypeError, ValueError):
        raise InputError(f"{value!r} is no amount", key="vary", allowed="a number, or a text with its unit") from None


def _cell(text: str) -> Any:
    try:
        return float(text)
    except ValueError:
        return text or None


def _vary(path: str, over: Any) -> dict[str, Any]:
    if hasattr(over, "_distribution"):
        given = over._distribution()
        for word in given.values():
            if isinstance(word, str) and re.fullmatch(r"[\s\d.eE+-]*\d[\s\d.eE+-]*", word):
                raise InputError(f"{word!r} has no unit", key=path, allowed="numbers in SI, texts with units")
        return {"path": path, "distribution": {key: value for key, value in given.items() if value is not None}}
    if isinstance(over, Mapping):
        return {"name" if "choices" in over else "path": path, **plain(over, path)}
    if isinstance(over, str) or not hasattr(over, "__iter__"):
        allowed = "a list of values, a distribution, or what a study file says of a factor"
        raise InputError(f"{over!r} says not what it varies over", key=path, allowed=allowed)
    return {"path": path, "values": list(over)}


def _motion(name: str, base: Any, wall: Wall) -> dict[str, Any]:
    if isinstance(base, Mapping) and isinstance(base.get("record"), str | os.PathLike):
        return {"base": {**base, "record": os.path.join(os.path.abspath(wall._case.folder), base["record"])}}
    if isinstance(base, str | os.PathLike) and base != "none":
        base = Record.read(base)
    if not isinstance(base, Record):
        return {"base": base}
    words = {"base": base.in_words("", name)}
    # A rocking wall is followed until it rests, unless its file says how long.
    return words if wall.model == "rocking" else {**words, "duration": base.duration}


def _text(path: str) -> str | None:
    """What a file says; nothing where there is none."""
    if not os.path.exists(path):
        return None
    with open(path, encoding="utf-8") as file:
        return file.read()


def _refuse_another(path: str, text: str) -> None:
    """Refuses to write over a file that is not of a study in this folder: there it stands beside ``runs``."""
    if not os.path.exists(path) or os.path.isdir(os.path.join(os.path.dirname(path), "runs")):
        return
    with open(path, "rb") as file:
        if file.read() != text.encode():
            what = "the file is there already, and no study was run in its folder"
            raise InputError(what, file=path, help="another folder for the study")


def _cells(columns: list[dict[str, Any]]) -> tuple[dict[str, Any], dict[str, str]]:
    """The columns of a table of the engine, and their units."""
    cells = {column["name"]: _numbers(column["cells"]) for column in columns}
    return cells, {column["name"]: column["unit"] for column in columns}


def _numbers(cells: list[Any]) -> list[Any]:
    """Cells without a value as numbers that are none, in columns of numbers."""
    if any(isinstance(cell, str) for cell in cells) or all(cell is None for cell in cells):
        return cells
    return [float("nan") if cell is None else cell for cell in cells]
