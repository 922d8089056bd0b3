"""A run step by step."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from ._values import amount, count
from .errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .wall import Base, Wall

_MOST = 2**63 - 1
_DIGEST = 16  # bytes behind a state that tell whether it is what was saved


class Simulation:
    """A run under way, taken as far as one asks. It has the bits of :meth:`concio.Wall.run`; it keeps no histories.

    Example:
        >>> import concio
        >>> simulation = concio.Simulation(concio.Wall.example())
        >>> simulation.advance(to=0.5)
        >>> state = simulation.save()
        >>> simulation.advance(steps=10)
        >>> simulation.restore(state)
        >>> simulation.time >= 0.5 and simulation.stop_reason is None
        True
    """

    def __init__(self, wall: Wall, base: Base | None = None, *, duration: float | str | None = None) -> None:
        """At rest at t = 0.

        Args:
            wall: The wall.
            base: What moves its base; see :meth:`concio.Wall.run`.
            duration: Length of the run [s].
        """
        prepared = wall._moved(base, duration)
        self._native = prepared.simulation()
        self.wall = wall
        self.duration = prepared.duration
        self._start = self.save()
        blocks = prepared.blocks()
        self._names = {name: number for number, name in enumerate(blocks["name"])}
        self._centres = np.column_stack([blocks["x"], blocks["y"]])

    def advance(self, *, to: float | str | None = None, steps: int | None = None) -> None:
        """Takes steps until the time ``to`` is reached [s, or a text with its unit], or so many steps; default one step.

        Steps are those of a run: none is cut short, so that ``time`` may be a step beyond ``to``. At the end of the motion, and when the step
        becomes too short, ``stop_reason`` says why it goes no further. After Ctrl-C the steps that were taken stay.

        Raises:
            InputError: No time, no number of steps, or both.
        """
        if to is not None and steps is not None:
            raise InputError("is given beside to", key="steps", allowed="either to or steps")
        if to is not None:
            self._native.advance(amount(to, "time", "s", "to"), _MOST)
        else:
            self._native.advance(np.inf, 1 if steps is None else count(steps, "steps", "whole numbers from 0", _MOST))

    def step(self) -> None:
        """One step: :meth:`advance` without arguments."""
        self.advance()

    def reset(self) -> None:
        """Goes back to rest at t = 0, pushed by nothing."""
        self.restore(self._start)

    def push(self, block: str | int, *, x: float | str = 0.0, y: float | str = 0.0) -> None:
        """Pushes a block of a planar wall at its centre from now on, until it is pushed otherwise; 0 N ends it.

        The force stays as it is while the wall moves: a spring is followed by a push per step. The run is, to the bit, that of a wall
        file with these values in ``force``.

        Args:
            block: Its name or number.
            x: Force to the right [N, or a text with its unit].
            y: Force upwards, likewise.

        Raises:
            InputError: No such block, a force that is not finite, a wall of another model.

        Example:
            >>> import concio
            >>> wall = concio.Wall.example("sliding-wall")
            >>> simulation = wall.simulation()
            >>> block, stiffness, speed = wall.blocks["name"][-1], 1e6, 0.01
            >>> while simulation.time < 0.1:
            ...     pulled = simulation.displacements[-1, 0]
            ...     simulation.push(block, x=stiffness * (speed * simulation.time - pulled))
            ...     simulation.advance()
        """
        number = self._names.get(block, -1) if isinstance(block, str) else block
        whole = isinstance(number, int | np.integer) and not isinstance(number, bool)
        if not whole or not 0 <= number < len(self._names):
            raise InputError(f"there is no block {block!r}", key="block", allowed="names or numbers of `wall.blocks`")
        self._native.push(int(number), amount(x, "force", "N", "x"), amount(y, "force", "N", "y"))

    @property
    def time(self) -> float:
        """Time reached [s]."""
        return self._native.time

    @property
    def stop_reason(self) -> str | None:
        """Why it goes no further; none while it does."""
        return self._native.stop_reason

    @property
    def displacements(self) -> NDArray[np.float64]:
        """Of every block and of a beam with motion of its own: along x, along y, relative to the base [m], and rotation in rad; (bodies, 3)."""
        return self._native.places()

    @property
    def places(self) -> NDArray[np.float64]:
        """Where the centre of every block is relative to the base, x and y [m], and its rotation in rad; (blocks, 3)."""
        moved = self._native.places()[: len(self._centres)].copy()
        moved[:, :2] += self._centres
        return moved

    @property
    def velocities(self) -> NDArray[np.float64]:
        """Horizontal velocity of every block relative to the base [m/s]."""
        return self._native.velocity()[: len(self._centres)]

    @property
    def energy(self) -> dict[str, Any]:
        """The energy account so far [J]."""
        return self._native.energy()

    def save(self) -> bytes:
        """The state, from which :meth:`restore` goes on with the same bits; of this wall, motion and version alone."""
        state = bytes(self._native.save())
        return state + hashlib.sha256(state).digest()[:_DIGEST]

    def restore(self, state: bytes) -> None:
        """Goes back to a saved state.

        Raises:
            InputError: A state that is not of this wall, or was damaged.
        """
        allowed = "what save() of the same wall gave"
        if not isinstance(state, bytes | bytearray | memoryview):
            raise InputError(f"a {type(state).__name__} is no state", key="state", allowed=allowed)
        whole = bytes(state)
        own, digest = whole[:-_DIGEST], whole[-_DIGEST:]
        if hashlib.sha256(own).digest()[:_DIGEST] != digest:
            raise InputError("is no state, or was damaged since it was saved", key="state", allowed=allowed)
        if not self._native.restore(own):
            raise InputError("is no state of this wall", key="state", allowed=allowed)

    def __reduce__(self) -> NoReturn:
        """Copies would move on together, and no other process has its thread: refused."""
        raise TypeError(
            "a simulation cannot be copied or pickled: hand on simulation.save(), and restore() it in another"
            " simulation of the same wall and motion"
        )

    def __repr__(self) -> str:
        """How far it is."""
        end = f", {self.stop_reason}" if self.stop_reason else ""
        return f"Simulation: t = {self.time:g} s of {self.duration:g} s{end}"
