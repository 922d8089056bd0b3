"""Stiffness of a panel of the continuum by CalculiX.

ccx_panel.py CARD.inp WIDTH HEIGHT THICKNESS ELEMENTS

CARD.inp is what `concio continuum --card engineering` prints; CalculiX reads it by *INCLUDE, without a change. The panel is fixed
along its base; its top moves along and stays level. Prints one line of JSON: the horizontal stiffness, in the units of the card.
WIDTH, HEIGHT and THICKNESS are in these units too.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile


def mesh(width, height, elements):
    """Nodes by number, and elements of 8 nodes: corners, then middles of the sides."""
    side = 2 * elements + 1
    number, nodes = {}, {}
    for j in range(side):
        for i in range(side):
            if i % 2 == 0 or j % 2 == 0:
                number[i, j] = len(nodes) + 1
                nodes[number[i, j]] = (width * i / (side - 1), height * j / (side - 1))
    order = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    corners = [(2 * i, 2 * j) for j in range(elements) for i in range(elements)]
    return nodes, [[number[i + di, j + dj] for di, dj in order] for i, j in corners]


def deck(card, material, width, height, thickness, elements):
    nodes, cells = mesh(width, height, elements)
    rows = ["*NODE, NSET=ALL"] + [f"{n}, {x:.12g}, {y:.12g}, 0." for n, (x, y) in nodes.items()]
    rows += ["*ELEMENT, TYPE=CPS8, ELSET=PANEL"]
    rows += [", ".join(str(v) for v in [k + 1, *cell]) for k, cell in enumerate(cells)]
    rows += [f"*INCLUDE, INPUT={card}"]
    rows += [f"*SOLID SECTION, ELSET=PANEL, MATERIAL={material}", f"{thickness:.12g}"]
    for name, level in [("BASE", 0.0), ("TOP", height)]:
        rows += [f"*NSET, NSET={name}"] + [str(n) for n, (_, y) in nodes.items() if abs(y - level) < 1e-9 * height]
    moved = 1e-3 * height
    rows += ["*STEP", "*STATIC", "*BOUNDARY", "BASE, 1, 2", f"TOP, 1, 1, {moved:.12g}", "TOP, 2, 2"]
    rows += ["*NODE PRINT, NSET=TOP, TOTALS=ONLY", "RF", "*END STEP", ""]
    return "\n".join(rows), moved


def stiffness(card, width, height, thickness, elements):
    text = pathlib.Path(card).read_text(encoding="utf-8")
    material = re.search(r"^\*MATERIAL, NAME=(\S+)", text, re.MULTILINE).group(1)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "card.inp").write_text(text, encoding="utf-8")
        lines, moved = deck("card.inp", material, width, height, thickness, elements)
        (folder / "panel.inp").write_text(lines, encoding="utf-8")
        done = subprocess.run(["ccx", "panel"], cwd=folder, capture_output=True, text=True, check=False)
        result = folder / "panel.dat"
        if done.returncode != 0 or not result.exists():
            raise SystemExit(done.stdout[-2000:])
        last = [line for line in result.read_text(encoding="utf-8").splitlines() if line.strip()][-1]
        return float(last.split()[0]) / moved


if __name__ == "__main__":
    card, *numbers, elements = sys.argv[1:]
    found = stiffness(card, *map(float, numbers), int(elements))
    version = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout.split()
    print(json.dumps({"program": f"CalculiX {version[-1] if version else ''}", "stiffness": found}))
