"""Values as a wall file takes them: numbers are SI, texts carry their unit."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from .errors import InputError


def plain(value: Any, key: str | None = None) -> Any:
    """What a wall file would say.

    Numbers and arrays of NumPy become numbers and lists, paths texts. A quantity with ``magnitude`` and ``units``, as pint makes them, becomes
    a text with its unit.
    """
    if value is None or isinstance(value, str | bool | int | float):
        return value
    if hasattr(value, "magnitude") and hasattr(value, "units"):
        unit = format(value.units, "~C").replace("**", "")
        return f"{float(value.magnitude)!r} {unit}" if unit else plain(value.magnitude, key)
    if isinstance(value, np.generic | np.ndarray):
        return plain(value.tolist(), key)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return {str(name): plain(inner, key) for name, inner in value.items()}
    if isinstance(value, list | tuple):
        return [plain(inner, key) for inner in value]
    raise InputError(
        f"{value!r} is of a type that no wall file has",
        key=key,
        allowed="numbers (SI), texts with units, lists, dicts, quantities with magnitude and units",
    )


def to_json(value: Any, key: str | None = None) -> str:
    """The JSON of a value; numbers that are not finite are no values."""
    try:
        return json.dumps(plain(value, key), allow_nan=False)
    except ValueError as error:
        if isinstance(error, InputError):
            raise
        raise InputError("a number is not finite", key=key, allowed="finite numbers") from None
