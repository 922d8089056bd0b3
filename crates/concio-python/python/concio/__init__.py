"""Concio: how walls of blocks move in their plane in an earthquake.

Example:
    >>> import concio
    >>> wall = concio.Wall.example("first-wall")         # or Wall.from_toml("wall.toml")
    >>> run = wall.run(duration="2 s")
    >>> run.ok, run["base/shear"].shape
    (True, (401,))

Everything is in SI; texts carry their unit. What is wrong with an input is an :class:`InputError`.
"""

from ._native import __version__
from .answers import Continuum, Limit, Mechanism, Mechanisms
from .errors import InputError
from .record import Record, Spectrum
from .run import Channel, Run, Warned, open, run_many
from .simulation import Simulation
from .study import Checked, LogNormal, LogUniform, Normal, Rows, Study, Triangular, Uniform
from .table import Table
from .wall import Doubt, Wall

__all__ = [
    "Channel",
    "Checked",
    "Continuum",
    "Doubt",
    "InputError",
    "Limit",
    "LogNormal",
    "LogUniform",
    "Mechanism",
    "Mechanisms",
    "Normal",
    "Record",
    "Rows",
    "Run",
    "Simulation",
    "Spectrum",
    "Study",
    "Table",
    "Triangular",
    "Uniform",
    "Wall",
    "Warned",
    "__version__",
    "open",
    "run_many",
]
