"""Integrates a system that `concio system` printed with SciPy's solve_ivp.

    scipy_shear.py METHOD SYSTEM.json RTOL ATOL INTERVAL HISTORY.bin

METHOD is Radau, BDF or LSODA. The right-hand side is vectorised over the joints; the Jacobian is analytic, sparse for
Radau and BDF. Prints one line of JSON; HISTORY.bin gets the displacements of all unknowns at INTERVAL, 2 INTERVAL, …
Where the base moves by a record, the longest step is its interval, because a solver that is not held there steps over
an earthquake after a silence.
"""

import json
import sys
import time

import numpy as np
import scipy
from scipy.integrate import solve_ivp
from scipy.sparse import coo_matrix


class System:
    """Equations (1) to (6) of docs/theory.md; unknowns are first all displacements, then all velocities."""

    def __init__(self, path):
        with open(path) as file:
            data = json.load(file)
        self.mass = np.array(data["mass"])
        self.n = len(self.mass)
        self.duration = data["duration"]
        joints = data["joints"]
        # Sides after the unknowns: the base, then the top.
        place = {"base": self.n, "top": self.n + 1}
        self.a = np.array([j["a"] for j in joints])
        self.b = np.array([place[j["b"]] if isinstance(j["b"], str) else j["b"] for j in joints])
        self.one_sided = np.array([j["law"] == "no-tension" for j in joints])
        self.k = np.array([j["stiffness"] for j in joints])
        self.c = np.array([j["damping"] for j in joints])
        rubs = np.array([j["friction"] is not None for j in joints])
        law = lambda key, other: np.array([j["friction"][key] if j["friction"] else other for j in joints])
        self.normal = np.array([j["normal_force"] for j in joints]).T * rubs
        self.dynamic, self.excess = law("dynamic", 0.0), law("static", 0.0) - law("dynamic", 0.0)
        self.slip, self.alpha = law("slip_velocity", 1.0), law("alpha", 0.0)
        self.steep = law("beta", 0.0) / self.slip
        self.base, self.sine = data["base"], (data["top"] or {}).get("sine")
        if self.base is not None and "sine" in self.base:
            raise SystemExit("a sine of the base is not read here")
        if self.base is not None:
            self.base_times = self.base["dt"] * np.arange(len(self.base["acceleration"]))
        self.pattern()

    def top(self, t):
        """Displacement and velocity of the top beam."""
        if self.sine is None:
            return 0.0, 0.0
        omega, ramp = 2 * np.pi * self.sine["frequency"], self.sine["ramp"]
        rising = t < ramp
        factor, rate = (t / ramp, 1 / ramp) if rising else (1.0, 0.0)
        amplitude = self.sine["amplitude"]
        sine, cosine = np.sin(omega * t), np.cos(omega * t)
        return amplitude * factor * sine, amplitude * (factor * omega * cosine + rate * sine)

    def ground(self, t):
        return 0.0 if self.base is None else np.interp(t, self.base_times, self.base["acceleration"])

    def relative(self, t, y):
        u, v = self.top(t)
        z, w = np.append(y[: self.n], (0.0, u)), np.append(y[self.n :], (0.0, v))
        return z[self.a] - z[self.b], w[self.a] - w[self.b]

    def law(self, w):
        speed = np.abs(w)
        steep, decay = self.steep * speed, self.excess * np.exp(-speed / self.slip)
        level, angle = decay + self.dynamic, 2 / np.pi * np.arctan(steep)
        mu = np.sign(w) * (angle * level + self.alpha * speed**2)
        slope = 2 / np.pi * self.steep / (1 + steep**2) * level - angle * decay / self.slip
        return mu, slope + 2 * self.alpha * speed

    def rates(self, t, y):
        d, w = self.relative(t, y)
        mu, _ = self.law(w)
        smooth = np.where(self.one_sided & (d <= 0), 0.0, self.k) * d + self.c * w
        force = np.bincount(self.a, smooth + self.normal[0] * mu, self.n + 2)
        force -= np.bincount(self.b, smooth + self.normal[1] * mu, self.n + 2)
        return np.concatenate((y[self.n :], -force[: self.n] / self.mass - self.ground(t)))

    def pattern(self):
        n, inner = self.n, self.b < self.n
        a, b = self.a, self.b[inner]
        self.inner = inner
        pairs = [(a, a), (a[inner], b), (b, a[inner]), (b, b)]
        rows = np.concatenate([n + r for r, _ in pairs] * 2 + [np.arange(n)])
        columns = np.concatenate([c for _, c in pairs] + [n + c for _, c in pairs] + [n + np.arange(n)])
        self.rows, self.columns = rows, columns

    def entries(self, t, y):
        d, w = self.relative(t, y)
        _, slope = self.law(w)
        k = np.where(self.one_sided & (d <= 0), 0.0, self.k)
        values = []
        for part in ([k, k], [self.c + self.normal[0] * slope, self.c + self.normal[1] * slope]):
            in_a, in_b = part[0] / self.mass[self.a], part[1][self.inner] / self.mass[self.b[self.inner]]
            values += [-in_a, in_a[self.inner], in_b, -in_b]
        return np.concatenate(values + [np.ones(self.n)])

    def jacobian(self, t, y):
        size = (2 * self.n, 2 * self.n)
        return coo_matrix((self.entries(t, y), (self.rows, self.columns)), size).tocsc()

    def dense(self, t, y):
        matrix = np.zeros((2 * self.n, 2 * self.n))
        np.add.at(matrix, (self.rows, self.columns), self.entries(t, y))
        return matrix

    def top_force(self, t, y):
        """Force of the top beam on the wall, and its velocity."""
        d, w = self.relative(t, y)
        force = self.k * d + self.c * w + self.normal[0] * self.law(w)[0]
        return -force[self.b == self.n + 1].sum(), self.top(t)[1]


def main():
    if sys.argv[1:] == ["--version"]:
        print(f"SciPy {scipy.__version__}, NumPy {np.__version__}, Python {sys.version.split()[0]}")
        return
    method, path, rtol, atol, interval, out = sys.argv[1:]
    rtol, atol, interval = float(rtol), float(atol), float(interval)
    system = System(path)
    samples = interval * np.arange(1, int(np.floor(system.duration / interval * (1 + 1e-12) + 1e-9)) + 1)
    samples = np.minimum(samples, system.duration)
    longest = np.inf if system.base is None else system.base["dt"]
    start = time.perf_counter()
    # t_eval would keep the samples alone: the solver's own steps are wanted for the work.
    solution = solve_ivp(
        system.rates,
        (0.0, system.duration),
        np.zeros(2 * system.n),
        method=method,
        rtol=rtol,
        atol=atol,
        jac=system.dense if method == "LSODA" else system.jacobian,
        max_step=longest,
        dense_output=True,
    )
    seconds = time.perf_counter() - start
    if not solution.success:
        raise SystemExit(solution.message)
    force, velocity = np.array([system.top_force(t, y) for t, y in zip(solution.t, solution.y.T)]).T
    integral = lambda values: float(np.sum(0.5 * np.diff(solution.t) * (values[1:] + values[:-1])))
    histories = solution.sol(samples)[: system.n]
    histories.T.astype("<f8").tofile(out)
    print(json.dumps({
        "steps": len(solution.t) - 1,
        "rhs": int(solution.nfev),
        "jacobians": int(solution.njev),
        "factorisations": int(solution.nlu) if solution.nlu else None,
        "solve_seconds": seconds,
        "peak_relative_displacement": float(np.abs(histories).max()),
        "top_work": integral(force * velocity),
        "top_force_peak": float(np.abs(force).max()),
        "top_force_rms": float(np.sqrt(integral(force**2) / system.duration)),
    }))


if __name__ == "__main__":
    main()
