from __future__ import annotations

import copy
import os
import pickle
import signal
import threading
from collections.abc import Callable

import numpy as np
import pytest
from conftest import SHEAR

from concio import InputError, Record, Simulation, Wall


def test_steps_are_those_of_the_run(wall: Wall) -> None:
    """Taken in pieces, the motion has the bits of the run."""
    run = wall.run()
    simulation = Simulation(wall)
    places = []
    while simulation.stop_reason is None:
        simulation.advance()
        places.append(simulation.displacements)
    assert simulation.stop_reason == run.stop_reason and simulation.time == run.time_reached
    for name in ("input", "kinetic", "elastic", "damping", "friction"):
        assert simulation.energy[name] == run.energy[name]
    if wall.model == "planar":
        # Its envelopes are the peaks that one sees on the way; those of shear walls know what is between two steps.
        peaks = np.abs(np.array(places)[:, : len(wall.blocks), 0]).max(axis=0)
        np.testing.assert_array_equal(peaks, run.blocks["peak_displacement"])
    pieces = Simulation(wall)
    while pieces.stop_reason is None:
        pieces.advance(to=pieces.time + 0.02)
    np.testing.assert_array_equal(pieces.displacements, simulation.displacements)
    assert pieces.energy == simulation.energy
    # Beyond the end nothing moves.
    pieces.advance(steps=3)
    assert pieces.time == run.time_reached


def test_a_state_goes_on_with_the_same_bits(wall: Wall, quake: Record) -> None:
    simulation = Simulation(wall, base=quake)
    simulation.advance(to=0.2)
    state = simulation.save()
    ends = []
    for other in (simulation, simulation, Simulation(wall, base=quake)):
        other.restore(state)
        assert other.time == pytest.approx(0.2, abs=0.02)
        other.advance(to=np.finfo(float).max)
        assert other.stop_reason == "completed"
        ends.append(other.displacements)
    np.testing.assert_array_equal(ends[0], ends[1])
    np.testing.assert_array_equal(ends[0], ends[2])


def test_places_of_a_wall_at_rest(planar: Wall) -> None:
    simulation = Simulation(planar, base="none", duration=0.1)
    blocks = planar.blocks
    np.testing.assert_allclose(simulation.places[:, 0], blocks["x"])
    np.testing.assert_allclose(simulation.places[:, 1], blocks["y"])
    simulation.advance(to=0.05)
    np.testing.assert_allclose(
        simulation.places, np.column_stack([blocks["x"], blocks["y"], 0 * blocks["y"]]), atol=1e-9
    )
    assert simulation.velocities.shape == (len(blocks),)
    assert "t = 0.05 s of 0.1 s" in repr(simulation)


def test_what_is_no_state(planar: Wall) -> None:
    simulation = Simulation(planar)
    simulation.advance(to=0.1)
    before = simulation.displacements
    for state in (b"", b"nothing", Simulation(Wall.from_str(SHEAR)).save()):
        with pytest.raises(InputError, match="no state"):
            simulation.restore(state)
    np.testing.assert_array_equal(simulation.displacements, before)
    simulation.advance(steps=1)
    with pytest.raises(InputError):
        simulation.advance(to=float("nan"))
    with pytest.raises(InputError):
        simulation.advance(steps=-1)


def test_ctrl_c_leaves_the_steps_that_were_taken(planar: Wall) -> None:
    simulation = Simulation(planar, duration="3000 s")
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        simulation.advance(to=3000)
    timer.join()
    assert 0 < simulation.time < 3000
    simulation.advance()


def test_a_spring_pulls_a_block_as_the_forces_of_a_wall_file_do(planar: Wall) -> None:
    wall = planar.replace({"motion": {"duration": "0.2 s"}, "solver.step": "1 ms"})
    simulation = wall.simulation()
    block = str(wall.blocks["name"][-1])
    number = len(wall.blocks) - 1
    forces = []
    while simulation.stop_reason is None:
        forces.append(1e6 * (0.05 * simulation.time - float(simulation.displacements[number, 0])))
        simulation.push(block, x=forces[-1])
        simulation.advance()
    assert simulation.displacements[number, 0] > 1e-4
    run = wall.replace({"force": [{"block": block, "x": forces, "every": "1 ms"}]}).simulation()
    run.advance(to=1.0)
    assert np.array_equal(run.displacements, simulation.displacements)
    assert run.energy == simulation.energy


def test_what_cannot_be_pushed_is_told(planar: Wall, shear: Wall) -> None:
    with pytest.raises(InputError, match="no block 'nothing'"):
        planar.simulation().push("nothing", x=1.0)
    with pytest.raises(InputError, match="finite"):
        planar.simulation().push(0, x=float("nan"))
    with pytest.raises(InputError, match="planar"):
        shear.simulation().push(0, x=1.0)


def test_times_and_forces_may_be_texts(planar: Wall) -> None:
    by_text, by_number = planar.simulation(), planar.simulation()
    by_text.push(0, x="0.1 kN")
    by_text.advance(to="50 ms")
    by_number.push(np.int64(0), x=100.0)  # type: ignore[arg-type]
    by_number.advance(to=0.05)
    np.testing.assert_array_equal(by_text.displacements, by_number.displacements)


@pytest.mark.parametrize(
    ("ask", "key"),
    [
        (lambda s: s.advance(to="0.2"), "to"),
        (lambda s: s.advance(to="0.2 kg"), "to"),
        (lambda s: s.advance(to=True), "to"),
        (lambda s: s.advance(to=0.1, steps=3), "steps"),
        (lambda s: s.advance(steps=1.5), "steps"),
        (lambda s: s.advance(steps=True), "steps"),
        (lambda s: s.push(True, x=1.0), "block"),
        (lambda s: s.push(0.5, x=1.0), "block"),
        (lambda s: s.push(None, x=1.0), "block"),
        (lambda s: s.push(0, x="1"), "x"),
        (lambda s: s.push(0, y="1 m"), "y"),
        (lambda s: s.push(0, x=None), "x"),
        (lambda s: s.restore(None), "state"),
        (lambda s: s.restore("text"), "state"),
    ],
)
def test_what_a_simulation_is_not_asked(planar: Wall, ask: Callable[[Simulation], object], key: str) -> None:
    simulation = planar.simulation()
    with pytest.raises(InputError) as caught:
        ask(simulation)
    assert caught.value.key == key and caught.value.allowed
    assert simulation.time == 0.0


def test_a_simulation_is_not_copied(planar: Wall) -> None:
    simulation = planar.simulation()
    for again in (copy.copy, copy.deepcopy, pickle.dumps):
        with pytest.raises(TypeError, match=r"save\(\).*restore\(\)"):
            again(simulation)


def test_damaged_states_are_refused(wall: Wall) -> None:
    simulation = wall.simulation()
    simulation.advance(to=0.1)
    state = simulation.save()
    before = simulation.displacements
    for place in np.linspace(0, len(state) - 1, 23).astype(int):
        damaged = bytearray(state)
        damaged[place] ^= 1
        with pytest.raises(InputError, match="damaged"):
            simulation.restore(bytes(damaged))
    with pytest.raises(InputError, match="damaged"):
        simulation.restore(state[:-1])
    np.testing.assert_array_equal(simulation.displacements, before)
    simulation.restore(memoryview(state))  # type: ignore[arg-type]
    np.testing.assert_array_equal(simulation.displacements, before)
