"""What other programs make of the same numbers: SALib, SciPy, eqsig, pycma.

Reads a question from standard input as JSON, `{"what": name, ...}`, and writes the answer as JSON.
"""

import json
import sys

import numpy as np


def sobol(values, factors):
    """Shares by SALib of runs in the order A, B, A_1 ... A_k; its intervals are half widths."""
    from SALib.analyze import sobol as peer

    a, b, *mixed = np.array(values).reshape(factors + 2, -1)
    problem = {"num_vars": factors, "names": [str(f) for f in range(factors)], "bounds": [[0, 1]] * factors}
    found = peer.analyze(problem, np.column_stack([a, *mixed, b]).ravel(), calc_second_order=False, seed=1)
    middle = np.mean([a, b])
    first = [float(peer.first_order(a - middle, m - middle, b - middle)) for m in mixed]
    return {
        "first": first,
        "total": found["ST"].tolist(),
        "half_first": found["S1_conf"].tolist(),
        "half_total": found["ST_conf"].tolist(),
    }


def morris(shares, values, levels):
    """Effects by SALib of trajectories on a grid."""
    from SALib.analyze import morris as peer

    x = np.array(shares)
    k = x.shape[1]
    problem = {"num_vars": k, "names": [str(f) for f in range(k)], "bounds": [[0, 1]] * k}
    found = peer.analyze(problem, x, np.array(values), num_levels=levels)
    return {name: np.array(found[name]).tolist() for name in ["mu", "mu_star", "sigma"]}


def ranks(shares, values):
    """Standardised rank regression by SciPy and NumPy."""
    from scipy.stats import rankdata, zscore

    x = zscore(np.apply_along_axis(rankdata, 0, np.array(shares)))
    y = zscore(rankdata(values))
    b = np.linalg.lstsq(x, y, rcond=None)[0]
    return {"coefficients": b.tolist(), "explained": float(1 - np.var(y - x @ b) / np.var(y))}


def fragility(capacities, between, above, stripes, fall):
    """The lognormal of the largest likelihood, and where its profiles have fallen by `fall`, by SciPy."""
    from scipy.optimize import brentq, minimize, minimize_scalar
    from scipy.stats import norm

    capacities, between, above = np.log(capacities), np.log(between).reshape(-1, 2), np.log(above)
    stripes = np.array(stripes, float).reshape(-1, 3)

    def loss(middle, spread):
        beta = np.exp(spread)
        z = (np.log(stripes[:, 0]) - middle) / beta
        sums = [
            norm.logpdf(capacities, middle, beta).sum(),
            np.log(np.diff(norm.cdf((between - middle) / beta), axis=1)).sum(),
            norm.logsf(above, middle, beta).sum(),
            (stripes[:, 1] * norm.logcdf(z) + (stripes[:, 2] - stripes[:, 1]) * norm.logsf(z)).sum(),
        ]
        return -sum(sums)

    start = [0.0, np.log(0.4)]
    best = minimize(lambda p: loss(*p), start, method="Nelder-Mead", options={"xatol": 1e-10, "fatol": 1e-13, "maxiter": 4000})
    (middle, spread), least = best.x, best.fun

    def ends(profile, at):
        return [brentq(lambda v: profile(v) - least - fall, at, at + sign * 3.0, xtol=1e-10) for sign in (-1, 1)]

    def over(f, around):
        return minimize_scalar(f, bounds=(around - 4, around + 4), method="bounded", options={"xatol": 1e-9}).fun

    medians = ends(lambda m: over(lambda s: loss(m, s), spread), middle)
    spreads = ends(lambda s: over(lambda m: loss(m, s), middle), spread)
    return {
        "median": float(np.exp(middle)),
        "dispersion": float(np.exp(spread)),
        "medians": np.exp(medians).tolist(),
        "dispersions": np.exp(spreads).tolist(),
    }


def spectra(dt, acceleration, damping, periods):
    """Peaks at the samples by eqsig, and an own recurrence of Nigam and Jennings at a twentieth of the step that goes on after the motion."""
    import eqsig
    from scipy.linalg import expm
    from scipy.signal import lfilter

    a = np.array(acceleration)
    signal = eqsig.AccSignal(a, dt)
    # eqsig leaves what is shorter than some steps to its own grid: the periods asked for are longer.
    signal.generate_response_spectrum(response_times=np.array(periods), xi=damping)
    fine, h = 20, dt / 20
    times = np.arange((len(a) - 1) * fine + 1) * h
    own = []
    for period in periods:
        rest = np.zeros(int(np.ceil(1.5 * period / h)))
        ground = np.concatenate([np.interp(times, np.arange(len(a)) * dt, a), rest])
        w = 2 * np.pi / period
        # State and a ground acceleration that goes on by a straight line.
        whole = np.zeros((4, 4))
        whole[:2, :2] = [[0, 1], [-w * w, -2 * damping * w]]
        whole[1, 2] = -1
        whole[2, 3] = 1
        step = expm(whole * h)
        m, now, slope = step[:2, :2], step[:2, 2], step[:2, 3]
        push = np.outer(ground[:-1], now) + np.outer(np.diff(ground) / h, slope)
        # u of the next step by the two before it: the recurrence of a matrix of two rows.
        forcing = push[1:, 0] - m[1, 1] * push[:-1, 0] + m[0, 1] * push[:-1, 1]
        forcing = np.concatenate([[push[0, 0]], forcing])
        u = lfilter([1.0], [1.0, -np.trace(m), np.linalg.det(m)], forcing)
        own.append(float(np.abs(u).max()))
    arias = np.pi / (2 * 9.80665) * np.trapezoid(a * a, dx=dt)
    significant = eqsig.im.calc_sig_dur(signal, start=0.05, end=0.95)
    return {"eqsig": signal.s_d.tolist(), "own": own, "arias": float(arias), "significant": float(significant)}


FUNCTIONS = {
    "ellipsoid": lambda x: float(sum(10 ** (6 * i / (len(x) - 1)) * v * v for i, v in enumerate(x))),
    "rosenbrock": lambda x: float(sum(100 * (b - a * a) ** 2 + (1 - a) ** 2 for a, b in zip(x, x[1:]))),
}


def strategy(function, start, sigma, population, repeats, goal):
    """How many evaluations pycma takes to a goal, without the weights below 0 that the program leaves out."""
    import cma

    counts = []
    for seed in range(1, repeats + 1):
        options = {"popsize": population, "seed": seed, "CMA_active": False, "verbose": -9, "ftarget": goal, "maxfevals": 1e5}
        found = cma.CMAEvolutionStrategy(start, sigma, options).optimize(FUNCTIONS[function])
        counts.append(found.result.evaluations)
    return {"evaluations": counts}


question = json.load(sys.stdin)
answer = globals()[question.pop("what")](**question)
json.dump(answer, sys.stdout)
