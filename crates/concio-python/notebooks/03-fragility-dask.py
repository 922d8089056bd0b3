# %% [markdown]
# # At which peak acceleration does a dry stone wall fall, and how do many machines find out?
#
# Half of such walls fall at 0.67 g, with a dispersion of 0.10 under records of one spectrum; stones move by 10 mm at 0.46 g. That
# takes 42 runs of six records. Here two processes of Dask make them. On a cluster the same call makes them on its nodes: only the line that
# starts the workers differs.

# %%
import tempfile

import matplotlib.pyplot as plt
import numpy as np
from distributed import Client, LocalCluster

import concio

# %% [markdown]
# ## The wall
#
# Ten dry stones of 0.4 m. Limit analysis says at which lasting acceleration it begins to move: λ g is the most, the estimate without dilation
# is nearer. A run ends when a stone has fallen.

# %%
wall = concio.Wall.from_str("""
model = "planar"
title = "ten stones"

[[panel]]
bond = "running"
courses = 4
bricks = 2
brick = { length = "400 mm", height = "400 mm", thickness = "300 mm", specific_weight = "20 kN/m3" }
mortar = { bed = 0, head = 0 }

[joint]
bed = { law = "rigid" }
head = { law = "rigid" }
friction = { law = "coulomb", static = 0.6, on = "all" }

[motion]
base = { synthetic = { seed = 1, pga = "0.5 g", duration = "4 s" } }
stop_at = { collapse = 0 }
""")
limit = wall.limit()
limit

# %% [markdown]
# ## The question
#
# An incremental dynamic analysis raises each record until the wall falls, then closes the gaps. Which run comes next depends on the last
# ones, so that the six records go side by side and the runs of one record follow each other.

# %%
motions = {f"record {seed}": {"synthetic": {"seed": seed, "pga": "0.5 g", "duration": "4 s"}} for seed in range(1, 7)}
ida = {
    "intensity": "pga",
    "damage": "peak_displacement",
    "limits": [{"name": "moves 10 mm", "value": "10 mm"}, {"name": "falls", "value": "200 mm"}],
    "collapse": "200 mm",
    "hunt": {"first": "0.4 g", "step": "0.2 g", "growth": "0.05 g", "most": "2 g", "runs": 7},
}
study = concio.Study(wall, motions=motions, ida=ida)

# %% [markdown]
# ## The runs
#
# `get_executor()` makes the workers look like those of `concurrent.futures`, which is all that a study asks for. Each task holds all that
# its runs need; workers need the package `concio` and no file.
#
# Workers start as new processes, which first import the program that started them. Without the line `if __name__ == "__main__":` a
# program would start workers that start workers. In a notebook it is always true and does no harm.

# %%
if __name__ == "__main__":
    folder = tempfile.TemporaryDirectory()
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster,
        Client(cluster) as client,
    ):
        rows = study.run(folder.name, executor=client.get_executor(), runs_per_task=1)
    assert rows.done and len(rows) == 42
    print(f"{len(rows)} runs, {np.count_nonzero(rows['collapsed'] == 'yes')} of them fell")

# %% [markdown]
# The same call again does nothing, and here needs no workers: every run is known by all that it depends on. After a crash the same call goes
# on. A run has the bits that it has alone.

# %%
if __name__ == "__main__":
    again = study.run(folder.name)
    assert again["id"].tolist() == rows["id"].tolist()

    row = rows.take(rows["collapsed"] == "no").nlargest(1, "peak_displacement")
    motion = motions[row["curve"][0]]["synthetic"] | {"pga": row["PGA"][0]}
    alone = wall.run(base={"synthetic": motion})
    # A study keeps fewer samples, and peaks are taken at samples too.
    assert np.isclose(alone.summary["peak_relative_displacement"], row["peak_displacement"][0], rtol=1e-3)

# %% [markdown]
# ## The fragility
#
# The tables of the study answer. The fit is a lognormal by maximum likelihood, each with its 95 % interval.

# %%
if __name__ == "__main__":
    fragility = rows.tables["fragility"]
    capacities = rows.tables["capacities"]
    for fit in fragility:
        print(
            f"{fit['limit']:12} median {fit['median'] / 9.81:.2f} g ({fit['median from'] / 9.81:.2f} … {fit['median to'] / 9.81:.2f}),"
            f" dispersion {fit['dispersion']:.2f} ({fit['dispersion from']:.2f} … {fit['dispersion to']:.2f}),"
            f" {fit['reached']:.0f} records"
        )

# %% [markdown]
# Is the fit right? With every capacity found, the likelihood is greatest at the mean and the standard deviation of their logarithms.
# Capacities that are known as intervals shift it a little. And no record may move the wall at less than limit analysis without dilation
# allows.

# %%
if __name__ == "__main__":
    for name, median, dispersion in zip(fragility["limit"], fragility["median"], fragility["dispersion"], strict=True):
        logarithms = np.log(capacities[name])
        assert np.isclose(np.exp(logarithms.mean()), median, rtol=0.02)
        assert np.isclose(logarithms.std(), dispersion, atol=0.03)
    assert limit.without_dilation is not None
    assert capacities["moves 10 mm"].min() > limit.without_dilation * 9.81

# %%
if __name__ == "__main__":
    curves = rows.tables["fragility_curves"]
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4), layout="constrained")
    for name in motions:
        curve = rows.take((rows["curve"] == name) & (rows["collapsed"] == "no"))
        left.plot(curve["PGA"] / 9.81, 1e3 * curve["peak_displacement"], "o-", markersize=3, label=name)
    left.set(xlabel="PGA [g]", ylabel="largest displacement of a stone [mm]", title="Until it falls")
    left.legend()
    for name in fragility["limit"]:
        curve = curves.take(curves["limit"] == name)
        right.plot(curve["PGA"] / 9.81, curve["probability"], label=name)
        right.fill_between(curve["PGA"] / 9.81, curve["low"], curve["high"], alpha=0.2)
    right.set(xlabel="PGA [g]", ylabel="probability", title="Fragility with 95 % bands")
    right.legend()
    folder.cleanup()

# %% [markdown]
# ## On a cluster with Slurm
#
# Install `dask-jobqueue` and start the workers by it: `SLURMCluster(cores=..., memory=..., walltime=...)` takes the place of
# `LocalCluster(...)`, and `cluster.scale(jobs=20)` asks for twenty jobs. The rest stays as it is. `--lifetime` among the worker options ends
# workers before their wall time does; a worker that is killed costs what it had under way, and its runs are made again. Rows are written
# where the study is called, so nodes need no common disk. PBS, Kubernetes and clouds have clusters of their own; `mpi4py.futures` and
# `ProcessPoolExecutor` fit too. Longer tasks, as of eight runs (`runs_per_task`), cost less to hand out.
#
# ## What could be wrong with this answer
#
# - *Six records of one spectrum.* The dispersion between recorded motions is 0.3 and more. Give `motions` records of files:
#   `concio.Record.read("quake.at2")`.
# - *The last centimetres are chaotic.* Which stone falls, and at which of two near intensities, may differ on another machine. The median hardly
#   does.
# - *The capacity lies between two runs.* Seven runs of a record leave a gap of some five to ten per cent.
# - *Rigid stones on rigid joints, in the wall's plane.* A wall of one leaf may fall outwards before: `wall.mechanisms()`.
# - *Friction is certain here.* Give the study a distribution for it, and the fragility has both scatters.
