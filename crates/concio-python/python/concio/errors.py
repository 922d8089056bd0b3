"""What is wrong with an input, where, and what is allowed."""

from __future__ import annotations

from typing import Any


class InputError(ValueError):
    """An input that the user mends: a wall file, a record, a value that is given.

    Example:
        >>> import concio
        >>> try:
        ...     concio.Wall.example().replace({"joint.friction.static": -1})
        ... except concio.InputError as error:
        ...     print(error.key, "|", error.allowed)
        joint.friction.static | from 0

    Attributes:
        what: What is wrong, with the value found.
        key: Key of the wall file (``panel[0].brick.length``), keyword, or field of the header of a record.
        file: The file, where the input came from one.
        line: Line in it, from 1.
        column: Column in the line, from 1.
        allowed: The allowed values or range.
        help: How to mend it, where that is known.
        more: Further mistakes that were found with this one.
    """

    more: tuple[InputError, ...] = ()

    def __init__(
        self,
        what: str,
        *,
        key: str | None = None,
        file: str | None = None,
        line: int | None = None,
        column: int | None = None,
        allowed: str | None = None,
        help: str | None = None,
    ) -> None:
        """Says what is wrong; place, range and help where they are known."""
        super().__init__(what)
        self.what = what
        self.key = key
        self.file = file
        self.line = line
        self.column = column
        self.allowed = allowed
        self.help = help

    def __str__(self) -> str:
        """``FILE:LINE:COLUMN: key: what; allowed: range; help``, a line for each further mistake."""
        place = [str(part) for part in (self.file, self.line, self.column) if part is not None]
        text = ":".join(place) + ": " if self.file is not None else ""
        text += f"{self.key}: {self.what}" if self.key else self.what
        if self.allowed:
            text += f"; allowed: {self.allowed}"
        if self.help:
            text += f"; {self.help}"
        return "\n".join([text, *map(str, self.more)])

    def __reduce__(self) -> tuple[Any, ...]:
        """For processes that hand errors on."""
        return _again, (self.what, {k: v for k, v in self.__dict__.items() if k not in ("what", "more")}, self.more)


def _again(what: str, fields: dict[str, Any], more: tuple[InputError, ...]) -> InputError:
    error = InputError(what, **fields)
    error.more = more
    return error
