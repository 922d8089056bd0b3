"""A panel of bricks beside its continuum in finite element programs.

compare.py CONCIO [WALL.toml]

CONCIO is the program, WALL.toml a wall file of one panel under a driven beam; default examples/continuum/panel.toml. Runs the
panel in Concio, writes its cards, and lets each program that is there read its card without a change. Prints a table.
scikit-fem: `pip install scikit-fem`, in the Python that runs this. CalculiX: `apt-get install calculix-ccx`.
"""

import importlib.util
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).parent
ELEMENTS = [4, 8, 16, 32]


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))}\n{done.stderr}")
    return done.stdout


def main(concio, wall):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        found = json.loads(run(concio, "continuum", wall, "--json"))["panels"][0]
        width, height, thickness = [1e3 * v for v in [*found["size"], found["thickness"]]]
        card, inp = folder / "card.json", folder / "card.inp"
        card.write_text(run(concio, "continuum", wall, "--card", "json", "--units", "N-mm"), encoding="utf-8")
        inp.write_text(run(concio, "continuum", wall, "--card", "engineering", "--units", "N-mm"), encoding="utf-8")
        run(concio, "run", wall, "--out", folder / "run")
        summary = json.loads((folder / "run" / "summary.json").read_text(encoding="utf-8"))
        bricks = 1e-3 * summary["push"]["stiffness"]
        assembly, continuum = [1e-3 * k for k in found["scale"]["panel"]]
        rows = [
            ("Concio, run of the bricks", bricks),
            ("Concio, assembly of the bricks", assembly),
            ("Concio, continuum, 32 x 32 elements of 8 nodes", continuum),
        ]
        if importlib.util.find_spec("skfem"):
            for n in ELEMENTS:
                told = json.loads(run(sys.executable, HERE / "skfem_panel.py", card, width, height, n))
                rows.append((f"{told['program']}, {n} x {n} elements of 9 nodes", told["stiffness"]))
        else:
            print("skipped: scikit-fem is not installed")
        if shutil.which("ccx"):
            for n in ELEMENTS:
                told = json.loads(run(sys.executable, HERE / "ccx_panel.py", inp, width, height, thickness, n))
                rows.append((f"{told['program']}, {n} x {n} elements of 8 nodes", told["stiffness"]))
        else:
            print("skipped: CalculiX (ccx) is not installed")
        print(f"{'program':55} {'K [N/mm]':>12} {'beside the bricks':>18}")
        for name, k in rows:
            print(f"{name:55} {k:12.1f} {100.0 * (k / bricks - 1.0):+17.2f} %")


if __name__ == "__main__":
    example = HERE.parent.parent / "examples" / "continuum" / "panel.toml"
    main(sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else example)
