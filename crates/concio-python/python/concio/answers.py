"""What walls answer without a run: limit analysis, mechanisms out of the plane, the continuum."""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from typing import Any, NamedTuple

from .table import Table


class Mechanism(NamedTuple):
    """How a wall falls."""

    kind: str
    """``sliding``, ``overturning`` or ``mixed``."""
    blocks: Table
    """Velocity and rotation of every body; the fastest corner has velocity 1."""
    joints: Table
    """The joints that slide or open."""


class _Drawn:
    """An answer that a notebook shows with its drawing."""

    def __init__(self, result: dict[str, Any], drawing: str | None) -> None:
        """Of what the command prints with ``--json``, and the mechanism as SVG where there is one."""
        self.result = result
        self.drawing = drawing

    def _repr_svg_(self) -> str | None:
        return self.drawing

    def _repr_html_(self) -> str:
        # No number without its warnings.
        lines = "<br>".join(escape(line) for line in repr(self).splitlines())
        return f"<div>{self.drawing or ''}<p>{lines}</p></div>"


class Limit(_Drawn):
    """What limit analysis found: the multiplier of the horizontal load, certified bounds of it, and the mechanism, whose SVG is ``drawing``.

    The multiplier is that of associative friction: what slides dilates. Where joints slide, real ones bear less;
    :attr:`without_dilation` estimates it.

    Example:
        >>> import concio
        >>> wall = concio.Wall.example("first-wall")
        >>> limit = wall.limit(towards="left")
        >>> limit.certified, limit.mechanism.kind
        (True, 'sliding')
    """

    @property
    def multiplier(self) -> float:
        """λ, the middle of its bounds."""
        return float(self.result["multiplier"])

    @property
    def bounds(self) -> tuple[float, float]:
        """Bounds of λ: from forces, from a mechanism."""
        lower, upper = self.result["bounds"]
        return float(lower), float(upper)

    @property
    def certified(self) -> bool:
        """Whether the bounds are so near to each other that λ is certain."""
        return bool(self.result["certified"])

    @property
    def without_dilation(self) -> float | None:
        """Estimate of λ without dilation; none where it was not asked, or not found."""
        found = self.result["non_associative"]
        return None if found is None else found["multiplier"]

    @property
    def towards(self) -> str:
        """Where it pushes to."""
        return str(self.result["towards"])

    @property
    def mechanism(self) -> Mechanism:
        """The mechanism of the upper bound."""
        found = self.result["mechanism"]
        return Mechanism(found["kind"], _table(found["blocks"]), _table(found["joints"]))

    @property
    def forces(self) -> Table:
        """Normal and tangential force of every contact point at the lower bound [N]."""
        return _table(self.result["forces"])

    @property
    def warnings(self) -> list[str]:
        """What speaks against believing the multiplier."""
        warnings: list[str] = list(self.result["warnings"])
        if self.result.get("falls_by_itself"):
            warnings.append("the wall falls under its own loads: the multiplier does not hold")
        if not self.certified:
            warnings.append(f"no certificate: the bounds are {self.result['gap']:.2g} of the multiplier apart")
        if self.result.get("slides_at") is not None:
            warnings.append("all that slides at one coefficient of friction slides: the multiplier is that coefficient")
        if self.result.get("twisting_joints") and not self.result.get("even_twist"):
            warnings.append("bed joints twist, whose corners bear too much: even_twist gives the low side")
        return warnings

    def __repr__(self) -> str:
        """Multiplier, bounds, mechanism, warnings."""
        lower, upper = self.bounds
        dilation = self.without_dilation
        without = "" if dilation is None else f"; without dilation {dilation:.4g}, an estimate"
        lines = [
            f"Limit: {self.multiplier:.6g} of the load to the {self.towards}, associative friction{without}",
            f"bounds {lower:.8g} by forces, {upper:.8g} by a mechanism",
            f"mechanism: {self.result['mechanism']['kind']}",
        ]
        return "\n".join(lines + [f"warning: {warning}" for warning in self.warnings])


class Mechanisms(_Drawn):
    """Mechanisms out of the plane, each with its multiplier, an upper bound in its class, and the checks of the code.

    ``drawing`` is an SVG of the least that counts, in elevation and section.
    """

    @property
    def table(self) -> Table:
        """All mechanisms: kind, hinge level [m], multiplier, and which equation gives it."""
        found = self.result["mechanisms"]
        names = (
            "kind",
            "equation",
            "counts",
            "hinge",
            "setback",
            "multiplier",
            "participation",
            "acceleration",
            "level",
        )
        return Table({name: [row[name] for row in found] for name in names})

    @property
    def least(self) -> dict[str, Any] | None:
        """The mechanism with the least multiplier."""
        least: dict[str, Any] | None = self.result["least"]
        return least

    @property
    def worst_check(self) -> dict[str, Any] | None:
        """The mechanism that is farthest from fulfilling its checks; none without a site."""
        worst: dict[str, Any] | None = self.result["worst_check"]
        return worst

    @property
    def time_history(self) -> dict[str, Any] | None:
        """The mechanisms under a motion, where one was asked."""
        history: dict[str, Any] | None = self.result.get("time_history")
        return history

    @property
    def assumed(self) -> list[str]:
        """What the wall file does not say, and what is assumed instead."""
        return [f"{row['key']}: {row['what']}" for row in self.result["assumed"]]

    @property
    def limits(self) -> list[str]:
        """What nobody should believe the numbers without."""
        return list(self.result["limits"])

    def __repr__(self) -> str:
        """The least, and what is assumed."""
        least = self.least
        head = (
            "Mechanisms: none"
            if least is None
            else (
                f"Mechanisms: {len(self.result['mechanisms'])}; the least multiplier is {least['multiplier']:.4g},"
                f" {least['kind']} at {least['hinge']:.4g} m, an upper bound in its class"
            )
        )
        return "\n".join([head, *(f"assumed: {line}" for line in self.assumed), "see also .limits"])


class Continuum:
    """The equivalent continuum of panels."""

    def __init__(self, result: dict[str, Any], card: Callable[[dict[str, Any]], str]) -> None:
        """Of what ``concio continuum --json`` prints, and what prints a card."""
        self.result = result
        self._card = card

    @property
    def panels(self) -> list[dict[str, Any]]:
        """What was found of each panel, SI."""
        panels: list[dict[str, Any]] = self.result["panels"]
        return panels

    @property
    def warnings(self) -> list[str]:
        """What speaks against believing it."""
        return [warning for panel in self.panels for warning in panel["warnings"]]

    def card(self, format: str = "json", *, units: str = "SI") -> str:
        """The card of the panel, for a finite element program.

        Args:
            format: ``"json"``, ``"lamina"``, ``"engineering"``, ``"shell"`` or ``"opensees"``.
            units: Force and length: ``"SI"``, ``"N-mm"``, ``"kN-m"``, ``"lbf-in"``.

        Raises:
            InputError: More panels than one: choose with ``panel``.
        """
        return self._card({"card": format, "units": units})

    def __repr__(self) -> str:
        """The panels and the warnings."""
        lines = [f"Continuum of {panel['name']}: {panel['bond']}" for panel in self.panels]
        return "\n".join(lines + [f"warning: {warning}" for warning in self.warnings])


def _table(rows: list[dict[str, Any]]) -> Table:
    names = list(rows[0]) if rows else []
    return Table({name: [row[name] for row in rows] for name in names})
