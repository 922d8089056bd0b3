"""Files that are written whole or not at all."""

from __future__ import annotations

import os


def write(path: str, text: str) -> None:
    """Writes a text, beside what stands there until it is complete."""
    temporary = f"{path}.{os.getpid()}.tmp"
    with open(temporary, "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(temporary, path)
