"""The command ``concio``, which the wheel carries: that of the command line."""

from __future__ import annotations

import signal
import sys

from . import _native


def main() -> int:
    """Does what the arguments of the process say; the exit status."""
    # The command line ends at Ctrl-C as it does without Python: it keeps what was reached.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _native.command(["concio", *sys.argv[1:]])
