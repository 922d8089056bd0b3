"""Stiffness of a panel of the continuum by scikit-fem.

skfem_panel.py CARD.json WIDTH HEIGHT ELEMENTS

CARD.json is what `concio continuum --card json` prints. The panel is fixed along its base; its top moves along and stays level.
Prints one line of JSON: the horizontal stiffness, in the units of the card. WIDTH and HEIGHT are in these units too.
"""

import json
import sys

import numpy as np
import skfem
from skfem.helpers import ddot, sym_grad


def stiffness(card, width, height, elements):
    """Horizontal force on the top over its displacement."""
    a = np.array(card["moduli"]["membrane"])
    x = np.linspace(0.0, width, elements + 1)
    y = np.linspace(0.0, height, elements + 1)
    mesh = skfem.MeshQuad2.from_mesh(skfem.MeshQuad.init_tensor(x, y))
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementQuad2()), intorder=4)

    @skfem.BilinearForm
    def energy(u, v, _):
        e = sym_grad(u)
        # N11, N22, N12 of eps11, eps22, gamma12 = 2 eps12.
        strain = [e[0, 0], e[1, 1], 2.0 * e[0, 1]]
        n = [sum(a[i, j] * strain[j] for j in range(3)) for i in range(3)]
        stress = np.array([[n[0], n[2]], [n[2], n[1]]])
        return ddot(stress, sym_grad(v))

    matrix = energy.assemble(basis)
    low = basis.get_dofs(lambda p: p[1] < 1e-9 * height).flatten()
    high = basis.get_dofs(lambda p: p[1] > height * (1.0 - 1e-9))
    moved = np.zeros(basis.N)
    moved[high.all("u^1")] = 1.0
    fixed = np.concatenate([low, high.flatten()])
    moved = skfem.solve(*skfem.condense(matrix, x=moved, D=fixed))
    return float(moved @ (matrix @ moved))


if __name__ == "__main__":
    path, width, height, elements = sys.argv[1:]
    with open(path, encoding="utf-8") as file:
        card = json.load(file)
    found = stiffness(card, float(width), float(height), int(elements))
    print(json.dumps({"program": f"scikit-fem {skfem.__version__}", "stiffness": found, "units": card["units"]}))
