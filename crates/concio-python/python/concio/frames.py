"""Runs as tables of pandas and datasets of xarray."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._optional import needed
from .run import settings_of

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from .run import Run

# Unit, meaning and dimension of what frames hold.
_FRAMES = {
    "displacement": ("m", "horizontal displacement of the centre relative to the base", "body"),
    "velocity": ("m/s", "horizontal velocity relative to the base", "body"),
    "acceleration": ("m/s2", "horizontal acceleration relative to the base", "body"),
    "vertical": ("m", "how far the centre has risen", "body"),
    "rotation": ("rad", "rotation about the centre, counterclockwise", "body"),
    "friction": ("N", "friction force, in planar walls the whole tangential force", "joint"),
    "slip": ("m", "sliding along the joint", "joint"),
    "opening": ("m", "widest opening over the length of the joint", "joint"),
    "pressure": ("N", "normal force, positive in compression", "joint"),
    "damage": ("1", "damage of the bond", "bonded_joint"),
}
_PEAKS = {
    "block": ("mass", "peak_displacement", "peak_velocity", "peak_acceleration"),
    "joint": ("stiffness", "peak_displacement", "slip", "opening", "peak_force", "dissipation"),
}


def histories(run: Run) -> pd.DataFrame:
    """The histories over the time, a column per channel, units in ``attrs``."""
    pandas = needed("pandas", "frames")
    frame: pd.DataFrame = pandas.DataFrame(
        run._native.values, index=pandas.Index(run.time, name="time"), columns=list(run), copy=False
    )
    frame.attrs["units"] = {name: channel.unit for name, channel in run.channels.items()}
    return frame


def dataset(run: Run) -> xr.Dataset:
    """Histories, frames and peaks with named dimensions.

    Names of histories are those of the channels; quantities of frames begin with ``frame_``, peaks of blocks and joints with ``block_`` and
    ``joint_``.
    """
    xarray = needed("xarray", "frames")
    blocks, joints = run.blocks, run.joints
    frames = run.frames
    bodies = frames["displacement"].shape[1] if "displacement" in frames else len(blocks)
    names = [*blocks["name"], *(["beam"] * (bodies - len(blocks)))]
    variables: dict[str, Any] = {}
    for name, channel in run.channels.items():
        attrs: dict[str, Any] = {"units": channel.unit, "long_name": channel.description}
        variables[name] = ("time", run[name], attrs)
    for name, values in frames.items():
        unit, text, dimension = _FRAMES[name]
        variables[f"frame_{name}"] = (("frame", dimension), values, {"units": unit, "long_name": text})
    for table, dimension in ((blocks, "block"), (joints, "joint")):
        for name in _PEAKS[dimension]:
            variables[f"{dimension}_{name}"] = (dimension, table[name], {"units": table.units[name]})
    coordinates = {
        "time": ("time", run.time, {"units": "s"}),
        "frame": ("frame", run.frame_time, {"units": "s"}),
        "body": names,
        "block": list(blocks["name"]),
        "joint": list(joints["name"]),
        "bonded_joint": [joints["name"][place] for place in run._native.bonded()],
    }
    attrs = {
        "title": str(settings_of(run)["title"]),
        "inputs_hash": run.inputs_hash,
        "version": str(run.summary["version"]),
        "stop_reason": run.stop_reason,
        "energy_residual": run.energy_residual,
        "warnings": "\n".join(map(str, run.warnings)),
    }
    made: xr.Dataset = xarray.Dataset(variables, coordinates, attrs)
    return made
