"""Values as a wall file takes them: numbers are SI, texts carry their unit."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native
from .errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray


def plain(value: Any, key: str | None = None) -> Any:
    """What a wall file would say.

    Numbers and arrays of NumPy become numbers and lists, paths texts. A quantity, as pint makes them with ``magnitude`` and ``units``, becomes
    a text with its unit.
    """
    if isinstance(value, float) and not math.isfinite(value):
        raise InputError(f"is {value}", key=key, allowed="finite numbers")
    if value is None or isinstance(value, str | bool | int | float):
        return value
    if hasattr(value, "magnitude") and hasattr(value, "units"):
        unit = format(value.units, "~C").replace("**", "")
        return _with_unit(value.magnitude, unit, key)
    if _has_units(value):
        unit = str(value.unit if hasattr(value, "unit") else value.units).replace("**", "").replace(" ", "")
        return _with_unit(value.value, "" if unit == "dimensionless" else unit, key)
    if isinstance(value, np.generic | np.ndarray):
        return plain(value.tolist(), key)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return {str(name): plain(inner, f"{key}.{name}" if key else str(name)) for name, inner in value.items()}
    if isinstance(value, list | tuple):
        return [plain(inner, f"{key or ''}[{place}]") for place, inner in enumerate(value)]
    raise InputError(
        f"{value!r} is of a type that no wall file has",
        key=key,
        allowed="numbers (SI), texts with units, lists, dicts, quantities with magnitude and units",
    )


def _with_unit(magnitude: Any, unit: str, key: str | None) -> Any:
    if not unit:
        return plain(magnitude, key)
    if np.ndim(magnitude) != 0:
        raise InputError(f"is an array in {unit}", key=key, allowed="one quantity, or a list of them")
    return f"{float(magnitude)!r} {unit}"


def to_json(value: Any, key: str | None = None) -> str:
    """The JSON of a value; numbers that are not finite are no values."""
    return json.dumps(plain(value, key), allow_nan=False)


def _has_units(value: Any) -> bool:
    """Whether it is a quantity of pint, astropy or unyt: arrays of NumPy would drop its unit."""
    return hasattr(value, "to") and (hasattr(value, "units") or hasattr(value, "unit"))


def _magnitude(value: Any, unit: str, key: str) -> Any:
    """The number, or the array, of a quantity in ``unit``."""
    try:
        in_unit = value.to(unit)
        return in_unit.magnitude if hasattr(in_unit, "magnitude") else in_unit.value
    except Exception as error:  # each package has its own
        raise InputError(f"{error}", key=key, allowed=f"quantities that can be converted to {unit}") from None


def number(value: Any, key: str, allowed: str = "a number") -> float:
    """A finite number, of any type of number."""
    known = isinstance(value, Real) or (isinstance(value, np.generic | np.ndarray) and np.ndim(value) == 0)
    if not known or np.asarray(value).dtype.kind not in "iuf":
        raise InputError(f"{value!r} is no number", key=key, allowed=allowed)
    made = float(value)
    if not math.isfinite(made):
        raise InputError(f"is {made}", key=key, allowed=f"{allowed}, finite")
    return made


def amount(value: Any, of: str, unit: str, key: str) -> float:
    """A finite number in SI: of a number as it is, of a text with its unit, of a quantity. ``of`` is ``time`` or ``force``."""
    if _has_units(value):
        value = _magnitude(value, unit, key)
    elif hasattr(value, "magnitude"):
        value = plain(value, key)
    if isinstance(value, str):
        value = _native.in_si(value, of, key)
    example = {"time": "5 ms", "force": "1 kN"}[of]
    return number(value, key, f"a number [{unit}], or a text with its unit, such as '{example}'")


def have_units(values: Any) -> bool:
    """Whether values are quantities, or a list of them."""
    return _has_units(values) or (isinstance(values, list | tuple) and any(map(_has_units, values)))


def samples(values: Any, unit: str, key: str) -> NDArray[np.float64]:
    """Numbers in one row as the engine takes them; quantities are converted to ``unit``.

    Buffers that others hand on without copying, as Dask does, may begin anywhere.
    """
    allowed = "numbers in one row"
    if _has_units(values):
        values = _magnitude(values, unit, key)
    elif hasattr(values, "magnitude"):
        raise InputError("is a quantity that cannot be converted", key=key, allowed=f"{allowed}, pint's quantities")
    elif have_units(values):
        if not all(_has_units(value) for value in values):
            raise InputError("only some of the values have a unit", key=key, allowed="all of them, or none")
        values = [_magnitude(value, unit, key) for value in values]
    if isinstance(values, np.ma.MaskedArray) and np.any(values.mask):
        what = f"{int(np.sum(values.mask))} values are masked"
        raise InputError(what, key=key, allowed=allowed, help="close the gaps, or take what is between them")
    try:
        array = np.asarray(values)
        of_numbers = array.dtype.kind in "iuf" or (array.dtype.kind == "O" and all(map(_real, array.flat)))
        made = np.require(array, np.float64, ["C_CONTIGUOUS", "ALIGNED"]) if of_numbers else None
    except (TypeError, ValueError):
        raise InputError("is no array of numbers", key=key, allowed=allowed) from None
    if made is None:
        raise InputError(f"is an array of {array.dtype}, not of real numbers", key=key, allowed=allowed)
    if made.ndim != 1:
        raise InputError(f"has {made.ndim} dimensions", key=key, allowed=allowed)
    return made


def _real(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def count(value: Any, key: str, allowed: str, most: int | None = None) -> int:
    """A whole number from 0."""
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if not whole or value < 0 or (most is not None and value > most):
        raise InputError(f"is {value!r}", key=key, allowed=allowed)
    return int(value)


def threads_of(threads: Any) -> int:
    """A number of threads, as the command takes it."""
    most = 65535
    return count(threads, "threads", f"from 0 to {most}; 0 is one per core", most)
