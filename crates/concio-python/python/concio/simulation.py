"""A run step by step."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .wall import Base, Wall

_MOST = 2**63 - 1


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

    def advance(self, *, to: float | None = None, steps: int | None = None) -> None:
        """Takes steps until the time ``to`` [s] is reached, or so many steps; default one step.

        Steps are those of a run: none is cut short, so that ``time`` may be a step beyond ``to``. At the end of the motion, and when the step
        becomes too short, ``stop_reason`` says why it goes no further. After Ctrl-C the steps that were taken stay.
        """
        if to is not None and not np.isfinite(to):
            raise InputError(f"is {to}", key="to", allowed="a time [s]")
        if steps is not None and steps < 0:
            raise InputError(f"is {steps}", key="steps", allowed="from 0")
        if to is None and steps is None:
            steps = 1
        self._native.advance(np.inf if to is None else float(to), _MOST if steps is None else steps)

    def step(self) -> None:
        """One step: :meth:`advance` without arguments."""
        self.advance()

    def reset(self) -> None:
        """Goes back to rest at t = 0, pushed by nothing."""
        self.restore(self._start)

    def push(self, block: str | int, *, x: float = 0.0, y: float = 0.0) -> None:
        """Pushes a block of a planar wall at its centre from now on, until it is pushed otherwise; 0 N ends it.

        The force stays as it is while the wall moves: a spring is followed by a push per step. The run is, to the bit, that of a wall
        file with these values in ``force``.

        Args:
            block: Its name or number.
            x: Force to the right [N].
            y: Force upwards [N].

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
        if not 0 <= number < len(self._names):
            raise InputError(f"there is no block {block!r}", key="block", allowed="names or numbers of `wall.blocks`")
        self._native.push(number, float(x), float(y))

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
        return bytes(self._native.save())

    def restore(self, state: bytes) -> None:
        """Goes back to a saved state.

        Raises:
            InputError: A state that is not of this wall.
        """
        if not self._native.restore(state):
            raise InputError("is no state of this wall", key="state", allowed="what save() of the same wall gave")

    def __repr__(self) -> str:
        """How far it is."""
        end = f", {self.stop_reason}" if self.stop_reason else ""
        return f"Simulation: t = {self.time:g} s of {self.duration:g} s{end}"
