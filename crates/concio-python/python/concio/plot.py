"""Figures by Matplotlib, which ``pip install "concio[plot]"`` brings.

Each function draws into ``ax`` or a figure of its own, and returns the axes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._optional import needed
from .errors import InputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .record import Record
    from .run import Run

_BRICK = "#f4d9c0"
_JOINT = "#8a6d56"


def _axes(ax: Axes | None) -> Axes:
    if ax is not None:
        return ax
    made: Axes = needed("matplotlib.pyplot", "plot").subplots(layout="constrained")[1]
    return made


class RecordPlots:
    """Figures of a record."""

    def __init__(self, record: Record) -> None:
        """Of this record."""
        self._record = record

    def __call__(self, *, ax: Axes | None = None) -> Axes:
        """The acceleration over the time, as :meth:`history`."""
        return self.history(ax=ax)

    def history(self, *, ax: Axes | None = None) -> Axes:
        """The acceleration over the time."""
        ax = _axes(ax)
        ax.plot(self._record.time, self._record.acceleration, linewidth=0.8)
        ax.set(xlabel="time [s]", ylabel="acceleration [m/s²]")
        return ax

    def spectrum(self, *, damping: float = 0.05, ax: Axes | None = None) -> Axes:
        """Pseudo-acceleration over the period."""
        ax = _axes(ax)
        found = self._record.spectrum(damping=damping)
        ax.semilogx(found.period, found.psa, label=f"{100 * damping:g} %")
        ax.set(xlabel="period [s]", ylabel="pseudo-acceleration [m/s²]")
        ax.legend(title="damping")
        return ax


class RunPlots:
    """Figures of a run."""

    def __init__(self, run: Run) -> None:
        """Of this run."""
        self._run = run

    def history(self, *names: str, ax: Axes | None = None) -> Axes:
        """Histories over the time; of one unit, default the base shear."""
        names = names or ("base/shear",)
        ax = _axes(ax)
        values = [(name, self._run[name]) for name in names]
        units = {self._run.channels[name].unit for name in names}
        if len(units) > 1:
            raise InputError("the histories have several units", key="names", allowed="histories of one unit")
        for name, history in values:
            ax.plot(self._run.time, history, linewidth=0.8, label=name)
        ax.set(xlabel="time [s]", ylabel=f"[{units.pop()}]")
        ax.legend()
        return ax

    def hysteresis(self, x: str = "top/displacement", y: str = "base/shear", *, ax: Axes | None = None) -> Axes:
        """One history over another."""
        ax = _axes(ax)
        ax.plot(self._run[x], self._run[y], linewidth=0.8)
        ax.set(xlabel=f"{x} [{self._run.channels[x].unit}]", ylabel=f"{y} [{self._run.channels[y].unit}]")
        return ax

    def energies(self, *, ax: Axes | None = None) -> Axes:
        """What became of the work done on the wall, over the time."""
        ax = _axes(ax)
        for name in self._run:
            if name.startswith("energy/") and name != "energy/top" and np.any(self._run[name]):
                ax.plot(self._run.time, self._run[name], linewidth=0.8, label=name.removeprefix("energy/"))
        ax.set(xlabel="time [s]", ylabel="energy [J]")
        ax.legend()
        return ax

    def deformed(self, t: float | None = None, *, scale: float = 1.0, ax: Axes | None = None) -> Axes:
        """The wall at the frame next to the time ``t`` [s], displacements ``scale`` times enlarged; default the frame of the largest one.

        Rotations are enlarged too: a scale is for small ones.
        """
        run = self._run
        frames = run.frames
        if "displacement" not in frames or len(run.frame_time) == 0:
            raise InputError("the run keeps no frames", key="output.frames", allowed="above 0 s")
        ax = _axes(ax)
        displacement = frames["displacement"]
        if t is None:
            frame = int(np.argmax(np.max(np.abs(displacement), axis=1)))
        else:
            frame = int(np.argmin(np.abs(run.frame_time - t)))
        blocks = run.blocks
        none = np.zeros_like(displacement)
        rise, turn = frames.get("vertical", none)[frame], frames.get("rotation", none)[frame]
        patches: list[Any] = []
        polygon = needed("matplotlib.patches", "plot").Polygon
        for place, block in enumerate(blocks):
            centre = np.array([block["x"], block["y"]])
            angle = scale * turn[place]
            rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
            moved = centre + scale * np.array([displacement[frame, place], rise[place]])
            patches.append(moved + (np.array(block["corners"]) - centre) @ rotation.T)
        for corners in patches:
            ax.add_patch(polygon(corners, facecolor=_BRICK, edgecolor=_JOINT, linewidth=0.6))
        ax.autoscale_view()
        ax.set_aspect("equal")
        ax.set(xlabel="x [m]", ylabel="y [m]", title=f"t = {run.frame_time[frame]:.4g} s, enlarged {scale:g} times")
        return ax
