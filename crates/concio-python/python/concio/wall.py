"""Walls: what a wall file says, and what it is asked."""

from __future__ import annotations

import json
import os
import re
import warnings
from collections.abc import Callable, Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from . import _native
from ._progress import shown
from ._values import plain, to_json
from .answers import Continuum, Limit, Mechanisms
from .errors import InputError
from .record import Record
from .run import Run
from .table import Table, in_si

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from .simulation import Simulation

Base: TypeAlias = Record | Mapping[str, Any] | str | os.PathLike[str]
"""What moves the base: a record, the path of its file, what stands at ``motion.base`` of a wall file, or ``"none"``."""
Progress: TypeAlias = bool | Callable[[float], object]
"""Whether a bar is shown, or what is called with the share of the work that is done, 0 … 1."""


_HARDLY_SI = 1.47  # m/s², 0.15 g: a peak below it is rather a multiple of g
_LOST = (
    "motion.base is none, but the run of this wall was moved by a record that no file gives: alone it stands still;"
    " give that record as base"
)
_TAIL = 60.0  # s that a rocking wall is followed beyond its motion at most


class Doubt(NamedTuple):
    """Something in a wall file that is allowed and hardly meant."""

    kind: str
    """Its kind, a word that stays."""
    text: str
    """What is doubtful, in a sentence."""
    line: int | None
    """Line of the wall file, where that is known."""

    @property
    def key(self) -> str | None:
        """Key of the wall file that it is about, where it is about one."""
        word = self.text.split(" ", 1)[0].rstrip(":")
        return word if "." in word and not word.endswith(".") else None

    def __str__(self) -> str:
        """The sentence."""
        return self.text


class Wall:
    """A wall file: blocks, joints, loads and motion. Nothing changes it: :meth:`replace` makes another.

    Example:
        >>> import concio
        >>> wall = concio.Wall.example("first-wall")
        >>> wall
        Wall (planar): Brick panel under a heavy floor, synthetic record of 0.6 g
        27 blocks, 70 joints, 39.95 kN
        runs 6 s
        >>> wall.replace({"joint.friction.static": 0.5, "load.top": "60 kN/m"}).settings["joint"]["friction"]["static"]
        0.5
    """

    def __init__(self, case: _native.Case) -> None:
        """Made by :meth:`from_toml`, :meth:`from_str`, :meth:`from_dict`, :meth:`from_blocks` and :meth:`example`."""
        self._case = case
        self._ready: _native.Prepared | None = None
        # Whether a run that it is of was moved by what its file does not hold.
        self._lost = False

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> Wall:
        """Reads a wall file, TOML or JSON; records in it are relative to its folder.

        Raises:
            InputError: What the file may not say, with line, key and what is allowed; all mistakes at once.
        """
        return cls(_native.Case.read(os.path.abspath(path)))

    @classmethod
    def from_str(cls, text: str, *, folder: str | os.PathLike[str] | None = None) -> Wall:
        """Reads the text of a wall file in TOML; records in it are relative to ``folder``, default the working directory of now.

        Raises:
            InputError: As :meth:`from_toml`.
        """
        return cls(_native.Case.parse(text, False, _inside(folder, "wall.toml"), True))

    @classmethod
    def from_dict(cls, values: Mapping[str, Any], *, folder: str | os.PathLike[str] | None = None) -> Wall:
        """Of what a wall file says, as dicts and lists: numbers are SI, texts carry their unit.

        Records in it are relative to ``folder``, default the working directory of now.

        Raises:
            InputError: As :meth:`from_toml`, by keys alone.
        """
        return cls(_native.Case.parse(to_json(values), True, _inside(folder, "wall.json"), False))

    @classmethod
    def from_blocks(
        cls,
        blocks: Sequence[ArrayLike] | Mapping[str, ArrayLike],
        *,
        brick: Mapping[str, Any],
        mortar: Mapping[str, Any] | None = None,
        folder: str | os.PathLike[str] | None = None,
        **settings: Any,
    ) -> Wall:
        """Of blocks of any convex shape. Sides that face each other across no more than the mortar form joints.

        Args:
            blocks: Corners [m] of each block, an array of shape (corners, 2), 3 to 16 of them in order round the block; y is from 0, where the
                base is. By name, or in a list, whose blocks are called ``b1``, ``b2``, …
            brick: Depth, specific weight and size of reference, as ``panel.brick`` of a wall file: ``{"length": 0.25, "height": 0.25,
                "thickness": 0.5, "specific_weight": "20 kN/m3"}``.
            mortar: Thickness of the joints, as ``panel.mortar``; default dry.
            folder: What paths of records are relative to; default the working directory of now.
            settings: The other tables of a wall file: ``joint``, ``load``, ``motion``, ``output``, …; ``model`` is ``"planar"``.

        Courses are counted from the base, block upon block; ``load.top`` acts on the last one.

        Raises:
            InputError: As :meth:`from_dict`; the place of a block in ``panel[0].block`` is that in the list.

        Example:
            >>> import concio
            >>> brick = {"length": 1, "height": 1, "thickness": 0.5, "specific_weight": "20 kN/m3"}
            >>> block = [(0, 0), (0.4, 0), (0.3, 1), (0.1, 1)]
            >>> friction = {"law": "coulomb", "static": 0.7}
            >>> joint = {"bed": {"law": "rigid"}, "head": {"law": "none"}, "friction": friction}
            >>> wall = concio.Wall.from_blocks([block], brick=brick, joint=joint, motion={"duration": "1 s"})
            >>> round(wall.limit(towards="left").multiplier, 4)
            0.45
        """
        named = blocks if isinstance(blocks, Mapping) else {f"b{k}": block for k, block in enumerate(blocks, start=1)}
        shapes = []
        for k, block in enumerate(named.values()):
            key = f"panel[0].block[{k}].corners"
            try:
                corners = np.asarray(block, dtype=np.float64)
            except (TypeError, ValueError):
                raise InputError("is no array of numbers", key=key, allowed="corners [m], (x, y) each") from None
            if corners.ndim != 2 or corners.shape[1:] != (2,) or len(corners) == 0:
                raise InputError(f"has the shape {corners.shape}", key=key, allowed="corners [m], (x, y) each")
            shapes.append(corners)
        courses = _courses(shapes)
        laid = [
            {"id": name, "course": course, "corners": corners}
            for name, course, corners in zip(named, courses, shapes, strict=True)
        ]
        panel = {"bond": "explicit", "brick": brick, "mortar": mortar or {"bed": 0, "head": 0}, "block": laid}
        return cls.from_dict({"model": "planar", "panel": [panel], **settings}, folder=folder)

    @classmethod
    def example(cls, name: str = "first-wall") -> Wall:
        """A wall of the folder ``examples``, by its name.

        Raises:
            InputError: There is none of that name; :meth:`examples` names them.
        """
        case = _native.Case.example(name)
        if case is None:
            raise InputError(f"no example is called {name!r}", key="name", allowed=", ".join(cls.examples()))
        return cls(case)

    @staticmethod
    def examples() -> list[str]:
        """Names of the examples."""
        return _native.example_names()

    def replace(self, changes: Mapping[str, Any]) -> Wall:
        """The same wall with other values.

        Args:
            changes: Key paths of the wall file (``joint.friction.static``, ``panel[0].courses``, ``[*]`` for every element of a list), each with what
                stands there instead: a number in SI, a text with its unit, a quantity of pint, a list, a dict, a record of a file.

        Raises:
            InputError: A path that leads nowhere, a key or value that a wall file does not know.
        """
        if not isinstance(changes, Mapping):
            allowed = "a dict of key paths, such as {'joint.friction.static': 0.5}"
            raise InputError(f"{changes!r} says not what changes", key="changes", allowed=allowed)

        def said(key: str, value: Any) -> Any:
            return value.in_words(self._case.folder, key) if isinstance(value, Record) else plain(value, key)

        made = Wall(self._case.changed(json.dumps({str(key): said(str(key), value) for key, value in changes.items()})))
        made._lost = self._lost and made._still
        return made

    @property
    def _still(self) -> bool:
        return bool(self.settings.get("motion", {}).get("base", "none") == "none")

    @property
    def settings(self) -> dict[str, Any]:
        """All that the wall file says, defaults in it, in SI where no unit is written."""
        settings: dict[str, Any] = json.loads(self._case.json)
        return settings

    @property
    def given(self) -> dict[str, Any]:
        """What the wall file says itself, with what was replaced: without defaults. ``Wall.from_dict(wall.given)`` is the wall."""
        given: dict[str, Any] = json.loads(self._case.given)
        return given

    @property
    def title(self) -> str:
        """Title of the wall file."""
        return str(self.settings["title"])

    @property
    def path(self) -> str | None:
        """The file that it was read from."""
        path = self._case.path
        return None if path is None else str(path)

    @property
    def model(self) -> str:
        """``shear``, ``planar`` or ``rocking``."""
        return str(self.settings["model"])

    @property
    def blocks(self) -> Table:
        """The blocks: name, panel, course from 1, centre, sizes [m], mass [kg], corners [m]."""
        return in_si(self._prepared.blocks())

    @property
    def joints(self) -> Table:
        """The joints: name, kind, the blocks at both sides, law, stiffness [N/m], friction."""
        return in_si(self._prepared.joints())

    def check(self) -> list[Doubt]:
        """What is allowed and hardly meant, such as a number in another unit.

        Raises:
            InputError: A wall that cannot be laid, a record that cannot be read.
        """
        lost = [Doubt("motion-in-no-file", _LOST, None)] if self._lost else []
        return lost + [Doubt(*doubt) for doubt in self._prepared.check()]

    @property
    def first_period(self) -> float | None:
        """First natural period of the wall as it stands, its joints intact [s].

        None where it has none: joints that hold are rigid, nothing holds a block, the wall falls, or it rocks out of its plane.

        Raises:
            InputError: As :meth:`check`.
        """
        return self._prepared.first_period()

    @property
    def _prepared(self) -> _native.Prepared:
        if self._ready is None:
            self._ready = self._case.prepare(None)
        return self._ready

    def _moved(self, base: Base | None = None, duration: float | str | None = None) -> _native.Prepared:
        """Ready to run under another motion of the base; see :meth:`run`."""
        if self._lost and base is None:
            warnings.warn(_LOST, UserWarning, stacklevel=3)
        if base is None and duration is None:
            return self._prepared
        if isinstance(base, str | os.PathLike) and base != "none":
            base = Record.read(base)
        changes: dict[str, Any] = {}
        beside = None
        if isinstance(base, Record):
            words = base._words(self._case.folder)
            beside = base._native if words is None else None
            changes["motion.base"] = "none" if words is None else json.loads(words)
            # A rocking wall is followed beyond its motion, as a file without a duration has it.
            if duration is None and (beside or self.model != "rocking"):
                duration = base.duration + (_TAIL if self.model == "rocking" else 0.0)
        elif base is not None:
            changes["motion.base"] = base
        if duration is not None:
            changes["motion.duration"] = duration
        return self.replace(changes)._case.prepare(beside)

    def run(self, base: Base | None = None, *, duration: float | str | None = None, progress: Progress = False) -> Run:
        """Simulates the wall.

        Other threads of Python go on meanwhile. Ctrl-C ends the run, which comes back with what it reached: ``run.ok`` is false then.

        Args:
            base: What moves the base instead of what the wall file says: a record, the path of its file, or what stands at ``motion.base`` of a
                wall file. Of a record that no file gives the result does not hold the motion, of which it warns: see :meth:`concio.Record.save`.
            duration: Length of the run [s]; default that of the record given, else of the wall file.
            progress: Show a bar, or call this with the share that is done, 0 … 1.

        Returns:
            The run. ``run.warnings`` says what speaks against believing it.

        Raises:
            InputError: What the wall file may not say, records that cannot be read.
        """
        prepared = self._moved(base, duration)
        with shown(progress) as told:
            native = prepared.run(told)
            if told is not None and not native.interrupted:
                told(1.0)
        run = Run(native, str(self._case.folder))
        if native.interrupted:
            warnings.warn(f"the run was stopped at t = {run.time_reached:g} s", RuntimeWarning, stacklevel=2)
        return run

    def simulation(self, base: Base | None = None, *, duration: float | str | None = None) -> Simulation:
        """A run to be taken step by step; see :class:`concio.Simulation`."""
        from .simulation import Simulation

        return Simulation(self, base=base, duration=duration)

    def limit(
        self,
        *,
        load: str = "body",
        towards: str | None = None,
        heads: str = "as-given",
        out_of_plane: bool = False,
        above: float | str | None = None,
        even_twist: bool = False,
        without_dilation: bool = False,
    ) -> Limit:
        """Limit analysis: the horizontal load under which the wall, taken as dry and rigid, becomes a mechanism.

        Args:
            load: ``"body"``, the weight of every block, or ``"top"``, the dead load of the top course.
            towards: ``"left"`` or ``"right"``, out of the plane ``"outwards"`` or ``"inwards"``; default the weaker of left and right, or outwards.
            heads: Friction of head joints: ``"as-given"`` or ``"frictionless"``.
            out_of_plane: Push the wall across its plane, as blocks in space.
            above: Hold what is below this height [m], out of the plane.
            even_twist: Draw contact points in, out of the plane: a low side.
            without_dilation: Estimate the multiplier without dilation for large walls too, out of the plane.

        Raises:
            InputError: A wall that does not stand, or that limit analysis has no words for.
        """
        across = {"above": above, "even_twist": even_twist, "without_dilation": without_dilation}
        for key, value in across.items():
            if not out_of_plane and value is not None and value is not False:
                raise InputError("is for walls pushed out of their plane", key=key, allowed="with out_of_plane=True")
        options = _options(load=load, towards=towards, heads=heads if heads != "as-given" or not out_of_plane else None)
        options += _options(out_of_plane=out_of_plane, **across)
        return Limit(*self._answer(["limit", *options]))

    def mechanisms(
        self,
        *,
        overlaps: str = "summed",
        record: str | os.PathLike[str] | None = None,
        pga: float | str | None = None,
        scale: float | None = None,
        vertical: str | os.PathLike[str] | None = None,
        shaken: bool = False,
        every: bool = False,
        restitution: float | None = None,
    ) -> Mechanisms:
        """What may fall out of the plane of the wall, with the checks of the Italian code where the wall file has a site.

        Args:
            overlaps: Sum of the friction of side walls, ``"summed"`` or ``"code"``.
            record: A file that shakes the wall across its plane.
            pga: Peak acceleration that it is scaled to [m/s²].
            scale: Factor on it instead.
            vertical: A file that shakes it up and down.
            shaken: Shake it by the motion of the wall file instead.
            every: Follow every hinge level through the motion, not the least of each kind.
            restitution: Coefficient of restitution of impacts.

        Raises:
            InputError: A wall without what the mechanisms need, a record that cannot be read.
        """
        if isinstance(pga, int | float) and abs(pga) < _HARDLY_SI:
            what = f"pga = {pga} m/s² is {pga / 9.81:.3f} g; did you mean '{pga} g'?"
            warnings.warn(what, RuntimeWarning, stacklevel=2)
        options = _options(overlaps=overlaps, record=record, pga=pga, scale=scale, vertical=vertical, shaken=shaken)
        options += _options(all=every, restitution=restitution)
        return Mechanisms(*self._answer(["mechanisms", *options]))

    def continuum(
        self,
        *,
        panel: str | None = None,
        heads: str = "closed",
        repeated: bool = False,
        brick_modulus: float | str | None = None,
        brick_poisson: float | None = None,
        pressure: float | str | None = None,
    ) -> Continuum:
        """The equivalent continuum of the panels: moduli, strength, how far it is off, cards for finite element programs.

        Args:
            panel: Name of a panel; default all.
            heads: Head joints ``"closed"``, as the file says, or ``"open"``.
            repeated: Take an irregular panel as a cell that repeats.
            brick_modulus: Young's modulus of bricks that deform [Pa]; default rigid bricks.
            brick_poisson: Their Poisson's ratio.
            pressure: Pressure on bed joints at which strength is told [Pa].

        Raises:
            InputError: A panel that no continuum stands for.
        """
        options = _options(panel=panel, heads=heads, repeated=repeated, brick_modulus=brick_modulus)
        options += _options(brick_poisson=brick_poisson, pressure=pressure)
        return Continuum(
            self._answer(["continuum", *options])[0],
            lambda card: str(self._answer(["continuum", *options, *_options(**card)])[0]),
        )

    def _answer(self, arguments: list[str]) -> tuple[Any, str | None]:
        """What a command says of the wall; its errors have keywords for options."""
        try:
            return self._case.answer(arguments)
        except InputError as error:
            for told in (error, *error.more):
                told.what = _keywords(told.what)
                told.allowed, told.help = (text and _keywords(text) for text in (told.allowed, told.help))
            raise

    def __eq__(self, other: object) -> bool:
        """Whether both wall files say the same."""
        return isinstance(other, Wall) and self._case.json == other._case.json

    def __hash__(self) -> int:
        """Of what the wall file says."""
        return hash(self._case.json)

    def __reduce__(self) -> tuple[Any, ...]:
        """For other processes."""
        return _again, (self._case.given, str(self._case.folder), self._lost)

    def __repr__(self) -> str:
        """Three lines: title, size, motion."""
        title = self.title or os.path.basename(self.path or "") or "without a title"
        return "\n".join([f"Wall ({self.model}): {title}", *self._lines()])

    def _lines(self) -> list[str]:
        try:
            ready = self._prepared
        except (InputError, OSError) as error:
            first = str(error).splitlines()[0]
            return ["cannot be run:", first]
        blocks, joints = len(self.blocks), len(self.joints)
        doubts = len(ready.check())
        doubt = f", {doubts} doubt{'s' if doubts > 1 else ''}: see check()" if doubts else ""
        return [f"{blocks} blocks, {joints} joints, {ready.weight / 1e3:.4g} kN", f"runs {ready.duration:g} s{doubt}"]

    def _repr_svg_(self) -> str:
        return self._prepared.svg()

    def _repr_html_(self) -> str:
        lines = "<br>".join(escape(line) for line in repr(self).splitlines())
        try:
            return f"<div>{self._prepared.svg()}<p>{lines}</p></div>"
        except (InputError, OSError):
            return f"<p>{lines}</p>"


def _inside(folder: str | os.PathLike[str] | None, name: str) -> str:
    """Where a wall that is in no file stands: in a folder that no later change of the working directory moves."""
    return os.path.join(os.path.abspath(folder or os.curdir), name)


def _courses(shapes: list[NDArray[np.float64]]) -> list[int]:
    """The course of every block, from 1: above those of the blocks that are below it."""
    courses = [1] * len(shapes)
    if not shapes:
        return courses
    low, high = np.array([s.min(axis=0) for s in shapes]), np.array([s.max(axis=0) for s in shapes])
    # Corners that were rounded to a thousandth of a side count as one.
    near = 1e-3 * (high - low)
    for i in np.argsort(low[:, 1], kind="stable"):
        beside = np.minimum(high[:, 0], high[i, 0]) - np.maximum(low[:, 0], low[i, 0]) > near[i, 0]
        below = beside & (high[:, 1] <= low[i, 1] + near[i, 1])
        courses[i] = 1 + max((courses[j] for j in np.flatnonzero(below)), default=0)
    return courses


def _again(settings: str, folder: str, lost: bool = False) -> Wall:
    wall = Wall(_native.Case.parse(settings, True, _inside(folder, "wall.json"), False))
    wall._lost = lost
    return wall


_UNITS = {"above": "m", "brick_modulus": "Pa", "pga": "m/s2", "pressure": "Pa"}
"""Units of the options of the command line that want one: numbers are SI here."""


def _keywords(text: str) -> str:
    """A text of the command line with keywords for its options, outside of commands that it quotes."""
    parts = re.split("(`concio [^`]*`)", text)
    words = {"all": "every"}
    named = [
        re.sub(r"--([a-z][a-z-]*)", lambda found: words.get(found[1], found[1].replace("-", "_")), part)
        for part in parts[::2]
    ]
    parts[::2] = named
    return "".join(parts)


def _options(**given: Any) -> list[str]:
    """Keywords as options of the command line."""
    options = []
    for name, value in given.items():
        option = "--" + name.replace("_", "-")
        if value is True:
            options.append(option)
        elif value is not None and value is not False:
            value = plain(value, name)
            if not isinstance(value, str):
                unit = _UNITS.get(name)
                value = repr(value) if unit is None else f"{float(value)!r} {unit}"
            options.append(f"{option}={value}")
    return options
