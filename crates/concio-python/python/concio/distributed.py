"""Studies on any executor: processes of this machine, Dask, MPI, whatever has ``submit``.

The seam is :class:`concurrent.futures.Executor`. A task is a line of text that holds all that its runs need, their records
included; a worker needs this package and nothing else. Rows are written where the study is asked for, as they come.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, wait
from itertools import islice
from typing import Any, Protocol

from . import _native

_LOOK = 0.2  # s between two looks whether somebody wants no more
_AHEAD = 512  # tasks that are handed out at once: each holds its records


class Executor(Protocol):
    """What a study asks of an executor."""

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Begins a call elsewhere."""
        ...


def work(task: str, threads: int = 1) -> list[str]:
    """Does the runs of a task; what an executor calls on its workers.

    Args:
        task: A line of ``concio study plan --json``.
        threads: Number of threads; 0 for one per core.

    Returns:
        A line per run, as ``concio study work`` prints them.

    Raises:
        InputError: The task is none, was changed on its way or is of another version.
    """
    return _native.task_work(task, threads)


def rows(executor: Executor, tasks: Iterable[str]) -> Iterator[list[str]]:
    """Hands tasks to an executor and gives their lines as they come; nothing now and then, so that who asks can stop.

    At most 512 tasks are under way at once.

    Raises:
        Exception: What a task ended with, once the others that had ended were given.
    """
    pending: set[Future[list[str]]] = set()
    left = iter(tasks)
    try:
        while True:
            pending.update(executor.submit(work, task) for task in islice(left, _AHEAD - len(pending)))
            if not pending:
                return
            done, pending = wait(pending, timeout=_LOOK, return_when=FIRST_COMPLETED)
            failed = [future for future in done if future.cancelled() or future.exception() is not None]
            for future in done.difference(failed):
                yield future.result()
            for future in failed:
                future.result()
            if not done:
                yield []
    finally:
        for future in pending:
            future.cancel()
