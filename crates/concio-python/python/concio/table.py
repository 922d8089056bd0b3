"""Tables without pandas: columns by name, of one length."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from ._optional import needed

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

_SHOWN = 10
# Units of the columns of blocks, joints, drifts and events; texts, counts and flags have none.
_UNITS = {
    "x": "m",
    "y": "m",
    "length": "m",
    "height": "m",
    "thickness": "m",
    "corners": "m",
    "mass": "kg",
    "stiffness": "N/m",
    "normal_stiffness": "N/m",
    "damping": "N s/m",
    "normal_force": "N",
    "friction_static": "1",
    "friction_dynamic": "1",
    "peak_displacement": "m",
    "peak_velocity": "m/s",
    "peak_acceleration": "m/s2",
    "slip": "m",
    "opening": "m",
    "closing": "m",
    "peak_force": "N",
    "dissipation": "J",
    "damage": "1",
    "cracked_at": "s",
    "peak": "m",
    "time": "s",
    "residual": "m",
    "swing": "m",
}


class Table:
    """Columns by name, read-only; its length is the number of rows, and it goes through them as dicts.

    ``"slip" in table`` asks for a column, ``row in table`` with a dict for a row. ``units`` has the units of the columns that have one.

    Example:
        >>> import concio
        >>> blocks = concio.Wall.example().blocks
        >>> len(blocks), blocks["name"][0]
        (27, 'p1c1b1')
        >>> blocks.nlargest(1, "y")["course"]
        array([6])
    """

    def __init__(self, columns: Mapping[str, Any], units: Mapping[str, str] | None = None) -> None:
        """Of lists or arrays of one length, and the units of columns that have one."""
        self._columns = {name: _column(values) for name, values in columns.items()}
        self.units = dict(units or {})

    def __getitem__(self, name: str) -> NDArray[Any]:
        """A column."""
        try:
            return self._columns[name]
        except KeyError:
            raise KeyError(f"no column {name!r}; there are {', '.join(self._columns)}") from None
        except TypeError:
            raise TypeError(
                "a column is asked by its name; take() gives rows, and frame is a table of pandas"
            ) from None

    def keys(self) -> Iterator[str]:
        """Names of the columns: ``dict(table)`` has the columns."""
        return iter(self._columns)

    def __contains__(self, asked: object) -> bool:
        """Whether there is a column of this name, or a row that is this dict."""
        return any(row == asked for row in self) if isinstance(asked, Mapping) else asked in self._columns

    def __len__(self) -> int:
        """Number of rows."""
        return max((len(values) for values in self._columns.values()), default=0)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        """A dict for each row."""
        lists = {name: values.tolist() for name, values in self._columns.items()}
        return ({name: values[k] for name, values in lists.items()} for k in range(len(self)))

    def take(self, places: Any) -> Table:
        """The rows at these places, or those of which a column of truth values says yes."""
        return Table({name: values[places] for name, values in self._columns.items()}, self.units)

    def nlargest(self, n: int, by: str) -> Table:
        """The ``n`` rows with the largest values of a column, the largest first; rows without a value are left out."""
        values = self[by]
        order = np.argsort(-values, kind="stable")
        return self.take([k for k in order if not np.isnan(values[k])][:n])

    @property
    def frame(self) -> pd.DataFrame:
        """As a DataFrame of pandas, which ``pip install "concio[frames]"`` brings; units in ``attrs``."""
        pandas = needed("pandas", "frames")
        frame: pd.DataFrame = pandas.DataFrame({name: list(values) for name, values in self._columns.items()})
        frame.attrs["units"] = self.units
        return frame

    def __repr__(self) -> str:
        """The first rows."""
        if len(self) == 0:
            return "no rows; columns: " + ", ".join(self._columns)
        cells = [[name, *map(_text, values[:_SHOWN].tolist())] for name, values in self._columns.items()]
        width = [max(map(len, column)) for column in cells]
        lines = [
            "  ".join(column[k].rjust(w) for column, w in zip(cells, width, strict=True)) for k in range(len(cells[0]))
        ]
        return "\n".join([*lines, *self._rest()])

    def _repr_html_(self) -> str:
        cells = [[name, *map(_text, values[:_SHOWN].tolist())] for name, values in self._columns.items()]
        head = "".join(f"<th>{escape(column[0])}</th>" for column in cells)
        count = len(cells[0]) if cells else 1
        rows = "".join(
            "<tr>" + "".join(f"<td>{escape(column[k])}</td>" for column in cells) + "</tr>" for k in range(1, count)
        )
        rest = "".join(f"<p>{line}</p>" for line in self._rest())
        return f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>{rest}"

    def _rest(self) -> list[str]:
        more = len(self) - _SHOWN
        return [f"… {more} more rows"] if more > 0 else []


def in_si(columns: Mapping[str, Any]) -> Table:
    """Columns of blocks, joints, drifts or events with their units."""
    return Table(columns, {name: _UNITS[name] for name in columns if name in _UNITS})


def _column(values: Any) -> NDArray[Any]:
    array: NDArray[Any]
    if len({len(value) if isinstance(value, list | tuple) else -1 for value in values}) > 1 or any(
        value is None for value in values
    ):
        array = np.empty(len(values), dtype=object)
        array[:] = list(values)
    else:
        array = np.array(values, dtype=object) if any(isinstance(v, str) for v in values) else np.array(values)
    array.flags.writeable = False
    return array


def _text(value: Any) -> str:
    match value:
        case float():
            return f"{value:.4g}"
        case None:
            return "–"
        case list():
            return f"[{len(value)}]"
        case _:
            return str(value)
