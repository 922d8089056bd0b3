from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

from concio import InputError, Record, Wall


def test_a_dataset_holds_what_the_run_holds(wall: Wall) -> None:
    pytest.importorskip("xarray")
    run = wall.run()
    found = run.to_xarray()
    assert found.attrs["inputs_hash"] == run.inputs_hash and found.attrs["energy_residual"] == run.energy_residual
    for name, channel in run.channels.items():
        assert found[name].attrs["units"] == channel.unit
        np.testing.assert_array_equal(found[name].values, run[name])
    np.testing.assert_array_equal(found["time"].values, run.time)
    block = run.blocks["name"][2]
    np.testing.assert_array_equal(found["frame_displacement"].sel(body=block).values, run.frames["displacement"][:, 2])
    assert float(found["joint_slip"].max()) == run.joints["slip"].max()


def test_histories_as_a_table_of_pandas(planar: Wall) -> None:
    pytest.importorskip("pandas")
    run = planar.run()
    frame = run.to_frame()
    assert frame.attrs["units"]["top/force"] == "N" and list(frame.columns) == list(run)
    np.testing.assert_array_equal(frame["base/shear"].to_numpy(), run["base/shear"])
    assert run.joints.frame.nlargest(1, "slip")["name"].iloc[0] == run.joints.nlargest(1, "slip")["name"][0]


def test_figures(planar: Wall, quake: Record) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot

    run = planar.run()
    (line,) = run.plot.history("top/displacement").lines
    np.testing.assert_array_equal(line.get_ydata(), run["top/displacement"])
    (line,) = run.plot.hysteresis().lines
    np.testing.assert_array_equal(line.get_xdata(), run["top/displacement"])
    assert run.plot.energies().get_legend() is not None
    drawn = run.plot.deformed(t=0.0, scale=10)
    corners = np.array([np.asarray(patch.get_path().vertices)[:4] for patch in drawn.patches])
    np.testing.assert_allclose(corners, np.array([np.array(c) for c in planar.blocks["corners"]]), atol=1e-9)
    frame = int(np.argmax(np.abs(run.frames["displacement"]).max(axis=1)))
    assert run.plot.deformed().get_title().startswith(f"t = {run.frame_time[frame]:.4g} s")
    assert quake.plot.history().lines and quake.plot.spectrum().lines
    with pytest.raises(InputError, match="several units"):
        run.plot.history("top/displacement", "base/shear")
    with pytest.raises(InputError, match="no frames"):
        planar.replace({"output.frames": 0}).run().plot.deformed()
    pyplot.close("all")


def test_importing_concio_imports_numpy_alone() -> None:
    code = "import sys, concio; print(sorted({'pandas', 'xarray', 'matplotlib', 'tqdm', 'pint'} & set(sys.modules)))"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert told.stdout.strip() == "[]"


def test_a_package_that_is_missing_is_named(planar: Wall) -> None:
    code = (
        "import sys; sys.modules['pandas'] = None\n"
        "import concio\n"
        "try:\n    concio.Wall.example().blocks.frame\nexcept ModuleNotFoundError as error:\n    print(error)"
    )
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert told.stdout.strip() == 'this needs pandas: pip install "concio[frames]"'
