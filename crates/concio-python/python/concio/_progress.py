"""How far a long call is."""

from __future__ import annotations

import importlib
import importlib.util
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any


@contextmanager
def shown(progress: bool | Callable[[float], object]) -> Iterator[Callable[[float], object] | None]:
    """What is called with the share that is done: a bar of tqdm where it is installed, else a line on standard error."""
    if callable(progress):
        yield progress
    elif not progress:
        yield None
    elif importlib.util.find_spec("tqdm") is not None:
        form = "{l_bar}{bar}| {elapsed}<{remaining}"
        bar: Any = importlib.import_module("tqdm.auto").tqdm(total=100.0, bar_format=form)
        with bar:

            def told(share: float) -> None:
                bar.update(100.0 * share - bar.n)

            yield told
    else:
        yield lambda share: print(f"\r{100 * share:3.0f} %", end="", file=sys.stderr, flush=True)
        print("\r     \r", end="", file=sys.stderr, flush=True)
