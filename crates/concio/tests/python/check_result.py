"""Checks a result file of Concio with the readers that its users have: h5py, NumPy and VTK.

    python check_result.py result.h5 [--csv DIR] [--npz FILE] [--vtkhdf FILE]

Needs h5py, numpy and vtk; with blake3 the digest of a large file takes no time. Ends with status 1 at the first mismatch.
"""

import argparse
import csv
import json
import pathlib

import h5py
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOHDF import vtkHDFReader

try:
    from blake3 import blake3 as native
except ImportError:
    native = None

BLOCK_ENVELOPES = {"displacement": "m", "velocity": "m/s", "acceleration": "m/s2"}
JOINT_ENVELOPES = BLOCK_ENVELOPES | {
    "slip": "m",
    "opening": "m",
    "closing": "m",
    "force": "N",
    "dissipation": "J",
    "impulse": "N s",
    "impacts": "1",
}
ENERGIES = ["input_base", "input_top", "initial", "kinetic", "elastic", "damping", "friction", "bond", "device", "impact", "nonreciprocal"]
TOTALS = {
    "peak_relative_displacement": "m",
    "peak_slip_velocity": "m/s",
    "peak_friction_force": "N",
    "base_shear_peak": "N",
    "base_shear_time": "s",
    "base_shear_displacement": "m",
    "top_force_peak": "N",
    "top_force_square": "N2 s",
    "minimum_gap": "m",
    "contact_residual": "m/s",
    "peak_input": "J",
    "peak_work": "J",
    "peak_residual": "J",
    "time_reached": "s",
}
COUNTERS = ["steps", "rejected", "failed", "iterations", "factorisations", "events", "located", "impacts", "unsolved", "moving"]
BLOCK_COLUMNS = {"x0": "m", "x1": "m", "y0": "m", "y1": "m", "thickness": "m", "specific_weight": "N/m3", "mass": "kg"}
PANEL_COLUMNS = {
    "reference_length": "m",
    "reference_height": "m",
    "reference_mass": "kg",
    "bed_mortar": "m",
    "head_mortar": "m",
    "connection": "m",
}
BOND_COLUMNS = {
    "strength": "N", "stiffness": "N/m", "residual_stiffness": "1", "energy": "J", "decay": "m", "damage": "1",
    "crack": "1", "crack_start": "1", "spent": "J", "cracked": "s", "broken": "s",
}
TIE_COLUMNS = {"force": "N", "stretch": "m", "yielded": "s"}
DRIFT_COLUMNS = {"height": "m", "peak": "m", "time": "s", "residual": "m", "swing": "m"}
JOINT_COLUMNS = {
    "weight": "1",
    "overlap": "m",
    "x0": "m",
    "y0": "m",
    "x1": "m",
    "y1": "m",
    "stiffness": "N/m",
    "normal_stiffness": "N/m",
    "damping": "N s/m",
    "normal_force_a": "N",
    "normal_force_b": "N",
    "restitution": "1",
    "friction_static": "1",
    "friction_dynamic": "1",
    "friction_slip_velocity": "m/s",
    "friction_beta": "1",
    "friction_alpha": "s2/m2",
}
STOP_REASONS = {"completed", "interrupted", "step-too-short", "not-finite"}
G = 9.81


def require(condition, message):
    if not condition:
        raise SystemExit(f"mismatch: {message}")


def equal(a, b, message):
    a, b = np.asarray(a), np.asarray(b)
    require(a.shape == b.shape, f"{message}: shape {a.shape} against {b.shape}")
    floating = np.issubdtype(a.dtype, np.floating)
    require(np.array_equal(a, b, equal_nan=floating), f"{message}: values differ")


def blake3(data):
    """The digest in hexadecimal digits, after section 2 of the specification of BLAKE3 (2021), at some 100 kB/s."""
    iv = [0x6A09E667, 0xBB67AE85, 0x3C6EF372, 0xA54FF53A, 0x510E527F, 0x9B05688C, 0x1F83D9AB, 0x5BE0CD19]
    order = [2, 6, 3, 10, 7, 0, 4, 13, 1, 11, 12, 5, 9, 14, 15, 8]
    chunk_start, chunk_end, parent, root, mask = 1, 2, 4, 8, 0xFFFFFFFF

    def compress(chaining, block, counter, flags):
        m = np.frombuffer(block.ljust(64, b"\0"), "<u4").tolist()
        v = chaining + iv[:4] + [counter & mask, counter >> 32, len(block), flags]

        def mix(a, b, c, d, x, y):
            for add, turns in ((x, (16, 12)), (y, (8, 7))):
                v[a] = (v[a] + v[b] + add) & mask
                v[d] ^= v[a]
                v[d] = (v[d] >> turns[0] | v[d] << 32 - turns[0]) & mask
                v[c] = (v[c] + v[d]) & mask
                v[b] ^= v[c]
                v[b] = (v[b] >> turns[1] | v[b] << 32 - turns[1]) & mask

        for _ in range(7):
            for k in range(4):
                mix(k, 4 + k, 8 + k, 12 + k, m[2 * k], m[2 * k + 1])
            for k in range(4):
                mix(k, 4 + (k + 1) % 4, 8 + (k + 2) % 4, 12 + (k + 3) % 4, m[8 + 2 * k], m[9 + 2 * k])
            m = [m[k] for k in order]
        return [v[k] ^ v[k + 8] for k in range(8)]

    def of_chunk(number, chunk, top):
        chaining = iv
        starts = range(0, max(len(chunk), 1), 64)
        for start in starts:
            last = start == starts[-1]
            flags = chunk_start * (start == 0) | chunk_end * last | root * (last and top)
            chaining = compress(chaining, chunk[start : start + 64], number, flags)
        return chaining

    def of_tree(first, data, top):
        if len(data) <= 1024:
            return of_chunk(first, data, top)
        left = 1 << ((len(data) - 1) // 1024).bit_length() - 1
        sides = of_tree(first, data[: 1024 * left], False) + of_tree(first + left, data[1024 * left :], False)
        return compress(iv, np.array(sides, "<u4").tobytes(), 0, parent | root * top)

    return np.array(of_tree(0, data, True), "<u4").tobytes().hex()


def check_digest(path):
    data = pathlib.Path(path).read_bytes()
    before, line = data[:-73], data[-73:]
    digest = native(before).hexdigest() if native else blake3(before)
    require(line == f"\nBLAKE3 {digest}\n".encode(), "the digest at the end is not that of the file")


class Result:
    """A result file, every dataset of which must be asked for."""

    def __init__(self, path):
        self.file = h5py.File(path, "r")
        self.asked = set()

    def array(self, name, shape, kind, unit):
        require(name in self.file, f"{name} is missing")
        self.asked.add(name)
        dataset = self.file[name]
        require(dataset.shape == shape, f"{name}: shape {dataset.shape}, expected {shape}")
        require(dataset.dtype == np.dtype(kind), f"{name}: type {dataset.dtype}, expected {kind}")
        require(dataset.attrs["unit"] == unit, f"{name}: unit {dataset.attrs['unit']!r}, expected {unit!r}")
        require(isinstance(dataset.attrs["description"], str), f"{name}: no description")
        return dataset[()]

    def texts(self, name, length=None):
        require(name in self.file, f"{name} is missing")
        self.asked.add(name)
        texts = self.file[name].asstr()[()]
        require(length is None or texts.shape == (length,), f"{name}: {texts.shape} texts, expected {length}")
        return list(texts)

    def check_nothing_left(self):
        found = set()
        self.file.visititems(lambda name, item: found.add(name) if isinstance(item, h5py.Dataset) else None)
        require(found == self.asked, f"datasets not documented or not there: {sorted(found ^ self.asked)}")


def check_head(result):
    attributes = result.file.attrs
    require(attributes["format"] == "concio-result", "attribute format")
    require(attributes["schema_version"] == 11, "attribute schema_version")
    require(attributes["stop_reason"] in STOP_REASONS, f"stop_reason {attributes['stop_reason']!r}")
    for name in ["version", "model", "inputs_hash"]:
        require(isinstance(attributes[name], str) and attributes[name], f"attribute {name}")
    require(result.array("schema_version", (), "u4", "1") == 11, "schema_version")
    (case,) = result.texts("case", 1)
    require(isinstance(json.loads(case), dict), "case is no JSON object")


def area_and_centre(corners):
    """Of a polygon with its corners counterclockwise; about its first corner, so that no digits are lost far from the origin."""
    x, y = (corners - corners[0]).T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    area = cross.sum() / 2
    first = [((v + np.roll(v, -1)) * cross).sum() / (6 * area) for v in (x, y)]
    return area, corners[0] + first


def check_wall(result):
    names = result.texts("wall/blocks/name")
    n = len(names)
    require(len(set(names)) == n, "names of blocks repeat")
    panels = result.texts("wall/panels/name")
    panel = result.array("wall/blocks/panel", (n,), "i8", "1")
    course = result.array("wall/blocks/course", (n,), "i8", "1")
    courses = result.array("wall/panels/courses", (len(panels),), "i8", "1")
    require(((panel >= 0) & (panel < len(panels))).all(), "panel out of range")
    require(((course >= 0) & (course < courses[panel])).all(), "course out of range")
    blocks = {key: result.array(f"wall/blocks/{key}", (n,), "f8", unit) for key, unit in BLOCK_COLUMNS.items()}
    start = result.array("wall/blocks/corner_start", (n + 1,), "i8", "1")
    require(start[0] == 0 and (np.diff(start) >= 3).all(), "corner_start")
    corners = np.split(result.array("wall/blocks/corners", (start[-1], 2), "f8", "m"), start[1:-1])
    require((result.array("wall/blocks/span", (n,), "i8", "1") >= 1).all(), "span")
    areas, centres = zip(*map(area_and_centre, corners))
    weight = areas * blocks["thickness"] * blocks["specific_weight"]
    require(np.allclose(blocks["mass"], weight / G, rtol=1e-12), "mass is not γ A B / g")
    for edge, axis, side in [("x0", 0, np.min), ("x1", 0, np.max), ("y0", 1, np.min), ("y1", 1, np.max)]:
        found = [side(c[:, axis]) for c in corners]
        require(np.allclose(found, blocks[edge], rtol=1e-12, atol=1e-12), f"corners do not agree with {edge}")
    for key, unit in PANEL_COLUMNS.items():
        result.array(f"wall/panels/{key}", (len(panels),), "f8", unit)
    return names, blocks | {"panel": panel, "course": course}, (corners, np.array(centres))


def check_joints(result, blocks):
    names = result.texts("wall/joints/name")
    n = len(names)
    kinds = result.texts("wall/joints/kind", n)
    a = result.array("wall/joints/a", (n,), "i8", "1")
    b = result.array("wall/joints/b", (n,), "i8", "1")
    require(((a >= 0) & (a < blocks)).all() and ((b >= -2) & (b < blocks)).all(), "joints out of range")
    for kind, other in zip(kinds, b):
        require(kind in {"bed", "head", "connection"} if other >= 0 else kind == {-1: "base", -2: "top"}[other], kind)
    laws = result.texts("wall/joints/law", n)
    require(set(laws) <= {"elastic", "no-tension", "rigid", "none"}, f"laws {set(laws)}")
    devices = result.texts("wall/joints/device", n)
    require(set(devices) <= {"viscous", "elastic", "friction-damper", "bouc-wen", "re-centring", "none"}, f"devices {set(devices)}")
    rubs = result.array("wall/joints/friction", (n,), "u1", "1")
    friction_laws = result.texts("wall/joints/friction_law", n)
    require(set(friction_laws) <= {"stribeck", "stribeck-stick", "coulomb", "none"}, f"friction laws {set(friction_laws)}")
    columns = {key: result.array(f"wall/joints/{key}", (n,), "f8", unit) for key, unit in JOINT_COLUMNS.items()}
    require(not columns["friction_static"][rubs == 0].any(), "a joint that does not rub has a coefficient")
    return names, columns


def check_history(result):
    file = result.file
    interval = result.array("layout/interval", (), "f8", "s")
    samples = int(result.array("layout/samples", (), "u8", "1"))
    result.array("layout/frame_every", (), "u8", "1")
    time = result.array("history/time", file["history/time"].shape, "f8", "s")
    require(time.ndim == 1 and len(time) <= samples, "more samples than the layout has")
    require(np.allclose(time, interval * np.arange(len(time)), rtol=1e-12), "samples are not at k times the interval")
    names = result.texts("layout/channels")
    paths = result.texts("layout/paths", len(names))
    units = [file[f"history/{path}"].attrs["unit"] for path in paths]
    values = [result.array(f"history/{p}", time.shape, "f8", u) for p, u in zip(paths, units)]
    return time, [f"{name} [{unit}]" if unit != "1" else name for name, unit in zip(names, units)], values


def check_frames(result, unknowns, joints):
    frames = result.file["frames/time"].shape[0]
    time = result.array("frames/time", (frames,), "f8", "s")
    require((np.diff(time) > 0).all(), "times of frames do not rise")
    displacement = result.array("frames/displacement", (frames, unknowns), "f8", "m")
    velocity = result.array("frames/velocity", (frames, unknowns), "f8", "m/s")
    result.array("frames/acceleration", (frames, unknowns), "f8", "m/s2")
    held = int(result.array("layout/held", (), "u8", "1"))
    if held:
        result.array("frames/friction", (frames, held), "f8", "N")
    turned = int(result.array("layout/turned", (), "u8", "1"))
    touching = int(result.array("layout/touching", (), "u8", "1"))
    planar = result.file.attrs["model"] == "planar"
    require(turned == (unknowns if planar else 0), f"{turned} rotations for {unknowns} unknowns")
    require(touching == (joints if planar else 0), f"{touching} slips for {joints} joints")
    vertical = rotation = np.zeros((frames, unknowns))
    if turned:
        vertical = result.array("frames/vertical", (frames, turned), "f8", "m")
        rotation = result.array("frames/rotation", (frames, turned), "f8", "rad")
    if touching:
        result.array("frames/slip", (frames, touching), "f8", "m")
        opening = result.array("frames/opening", (frames, touching), "f8", "m")
        require((opening >= 0).all(), "an opening is negative")
        result.array("frames/pressure", (frames, touching), "f8", "N")
    if "bonds" in result.file:
        check_bonds(result, frames)
    if "ties" in result.file:
        check_ties(result)
    if "collapse" in result.file:
        check_collapse(result)
    if "events" in result.file:
        check_events(result)
    return time, (displacement, vertical, rotation), velocity


def check_events(result):
    events = result.array("events/time", result.file["events/time"].shape, "f8", "s")
    require(len(events) > 0 and (np.diff(events) >= 0).all(), "events are not in the order of time")
    joints = result.array("events/joint", events.shape, "i8", "1")
    require((joints >= 0).all(), "events/joint")
    require(set(result.texts("events/kind", len(events))) <= {"impact", "crack", "break", "crush", "collapse"}, "events/kind")
    result.array("events/value", events.shape, "f8", "SI")


def check_bonds(result, frames):
    n = result.file["bonds/joint"].shape[0]
    joints = result.array("bonds/joint", (n,), "i8", "1")
    require((np.diff(joints) > 0).all(), "bonds are not in the order of the joints")
    columns = {key: result.array(f"bonds/{key}", (n,), "f8", unit) for key, unit in BOND_COLUMNS.items()}
    damage = result.array("frames/damage", (frames, n), "f8", "1")
    require(((damage >= 0) & (damage <= 1)).all(), "damage is not between 0 and 1")
    require((columns["cracked"] <= columns["broken"]).all(), "a bond was broken before it cracked")


def check_ties(result):
    n = result.file["ties/from"].shape[0]
    ends = zip(result.texts("ties/from", n), result.texts("ties/to", n))
    require(all(a != b for a, b in ends), "a tie is fixed to one block twice")
    columns = {key: result.array(f"ties/{key}", (n,), "f8", unit) for key, unit in TIE_COLUMNS.items()}
    require((np.isfinite(columns["yielded"]) == (columns["stretch"] > 0)).all(), "when a tie yielded")


def check_drift(result, panels):
    tops = result.texts("drift/top")
    n = len(tops)
    require(n > 0 and len(set(tops)) == n and set(tops) <= {*panels, "beam"}, f"tops {tops}")
    columns = {key: result.array(f"drift/{key}", (n,), "f8", unit) for key, unit in DRIFT_COLUMNS.items()}
    end = result.file["totals/time_reached"][()]
    require((columns["height"] > 0).all() and (columns["time"] <= end).all(), "height or time of a drift")
    require((np.isfinite(columns["residual"]) == np.isfinite(columns["swing"])).all(), "a residual without its swing")
    return tops, columns


def check_collapse(result):
    time = result.array("collapse/time", (), "f8", "s")
    require(0 <= time <= result.file["totals/time_reached"][()], "collapse/time")
    block = result.array("collapse/block", (), "i8", "1")
    require(0 <= block < len(result.file["wall/blocks/name"]), "collapse/block")
    require(result.array("collapse/displacement", (), "f8", "m") >= 0, "collapse/displacement")
    require(result.array("collapse/turned", (), "u1", "1") in (0, 1), "collapse/turned")
    # Of walls in the plane alone.
    if "collapse/before" in result.file:
        require(result.array("collapse/before/residual", (), "f8", "1") >= 0, "collapse/before/residual")
        steps, *parts = [result.array(f"collapse/before/{name}", (), "u8", "1") for name in ("steps", "unsolved", "moving")]
        require(all(part <= steps for part in parts), "collapse/before")
        require(steps <= result.file["counters/steps"][()], "collapse/before/steps")


def check_sums(result, unknowns, joints):
    blocks = {k: result.array(f"envelope/block/{k}", (unknowns,), "f8", u) for k, u in BLOCK_ENVELOPES.items()}
    joints = {k: result.array(f"envelope/joint/{k}", (joints,), "f8", u) for k, u in JOINT_ENVELOPES.items()}
    units = {"energy": dict.fromkeys(ENERGIES, "J"), "totals": TOTALS, "counters": dict.fromkeys(COUNTERS, "1")}
    for group, numbers in units.items():
        for name, unit in numbers.items():
            value = result.array(f"{group}/{name}", (), "u8" if group == "counters" else "f8", unit)
            if name != "time_reached":
                equal(result.file[group].attrs[name], value, f"attribute {name} of {group}")
    equal(result.file.attrs["time_reached"], result.file["totals/time_reached"][()], "attribute time_reached")
    return blocks, joints


def check_vtkhdf_tree(result):
    """Notes the datasets of the group; their content is checked through VTK itself."""
    group = result.file["VTKHDF"]
    require(group.attrs["Type"] == b"UnstructuredGrid", "Type of VTKHDF")
    equal(group.attrs["Version"], [2, 0], "Version of VTKHDF")
    names = []
    group.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
    result.asked.update(f"VTKHDF/{name}" for name in names)


def corners_moved(outlines, shift, rise, rotation):
    """Displacement of the corners of blocks that turn about their centres by matrices of rotation."""
    moved = []
    for corners, centre, x, y, angle in zip(*outlines, shift, rise, rotation):
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        arm = corners - centre
        moved.append(np.column_stack([arm @ turn.T - arm + [x, y], np.zeros(len(arm))]))
    return np.concatenate(moved)


def check_vtk(path, blocks, outlines, envelopes, time, motion, velocity):
    """Compares what vtkHDFReader makes of the file, step by step, with the datasets."""
    planar = motion[2].any()
    n = len(blocks["x0"])
    reader = vtkHDFReader()
    require(reader.CanReadFile(str(path)), f"VTK refuses {path}")
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    information = reader.GetOutputInformation(0)
    steps = information.Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS()) or ()
    equal(np.array(steps, dtype=float), time, f"{path}: times of the steps")
    require(reader.GetNumberOfSteps() == max(len(time), 1), f"{path}: {reader.GetNumberOfSteps()} steps")
    counts = np.array([len(c) for c in outlines[0]])
    flat = np.concatenate(outlines[0])
    corners = np.column_stack([flat, np.zeros(len(flat))])
    # All steps of a short run; of a long one as many, the first and last among them.
    for step in np.unique(np.linspace(0, max(len(time) - 1, 0), 200).astype(int)):
        if len(time):
            reader.UpdateTimeStep(time[step])
        else:
            reader.Update()
        grid = reader.GetOutputDataObject(0)
        where = f"{path}: step {step}"
        require(grid.GetNumberOfPoints() == len(corners) and grid.GetNumberOfCells() == n, f"{where}: size of the grid")
        if step == 0:
            kinds = [grid.GetCellType(k) for k in range(n)]
            equal(kinds, np.where(counts == 4, 9, 7), f"{where}: kinds of cells")
            equal([grid.GetCell(k).GetNumberOfPoints() for k in range(n)], counts, f"{where}: points of cells")
        equal(vtk_to_numpy(grid.GetPoints().GetData()), corners, f"{where}: points")
        equal(vtk_to_numpy(grid.GetCells().GetConnectivityArray()), np.arange(len(corners)), f"{where}: connectivity")
        cell = {key: vtk_to_numpy(grid.GetCellData().GetArray(key)) for key in vtk_names(grid.GetCellData())}
        for key in ["mass", "course", "panel"]:
            equal(cell[key], blocks[key].astype(float), f"{where}: {key}")
        for key, values in envelopes.items():
            equal(cell[f"peak_{key}"], values[:n], f"{where}: peak_{key}")
        if len(time):
            shift, rise, rotation = (rows[step, :n] for rows in motion)
            moved = corners_moved(outlines, shift, rise, rotation)
            point = vtk_to_numpy(grid.GetPointData().GetArray("displacement"))
            if planar:
                # Turning is computed in other ways on the two sides; 32-bit floats are what is stored.
                require(np.allclose(point, moved, rtol=2e-7, atol=1e-9), f"{where}: displacement")
                equal(cell["rotation"], rotation.astype(np.float32), f"{where}: rotation")
            else:
                equal(point, moved.astype(np.float32), f"{where}: displacement")
            speed = np.zeros((n, 3), dtype=np.float32)
            speed[:, 0] = velocity[step, :n]
            equal(cell["velocity"], speed, f"{where}: velocity")


def vtk_names(data):
    return [data.GetArrayName(k) for k in range(data.GetNumberOfArrays())]


def check_npz(path, file):
    """Every array has the values of the dataset of its name."""
    with np.load(path) as archive:
        for name in archive.files:
            array = archive[name]
            if name in ["version", "model", "inputs_hash", "stop_reason"]:
                require(array[0].decode() == file.attrs[name], f"npz: {name}")
            elif array.dtype.kind == "S":
                equal(np.array([t.decode() for t in array]), np.array(file[name].asstr()[()]), f"npz: {name}")
            else:
                equal(array, file[name][()], f"npz: {name}")
        tops = ["case", "wall", "history", "frames", "bonds", "drift", "ties", "collapse", "events", "envelope", "energy", "totals", "counters"]
        wanted = []
        file.visititems(lambda name, item: wanted.append(name) if isinstance(item, h5py.Dataset) else None)
        wanted = {w for w in wanted if any(w == top or w.startswith(top + "/") for top in tops)}
        missing = wanted - set(archive.files)
        require(not missing, f"npz: {sorted(missing)} missing")


def check_csv_corners(folder, names, corners, file):
    rectangles = all(len(c) == 4 and len(set(c[:, 0])) == 2 and len(set(c[:, 1])) == 2 for c in corners)
    require((folder / "corners.csv").exists() != rectangles, "csv: corners")
    if rectangles:
        return
    with open(folder / "corners.csv", newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    found = np.array([[float(row["x [m]"]), float(row["y [m]"])] for row in rows])
    equal(found, file["wall/blocks/corners"][()], "csv: corners")
    require([row["block"] for row in rows] == [n for n, c in zip(names, corners) for _ in c], "csv: blocks of corners")


def check_csv_events(folder, file, joints):
    if "events" not in file:
        require(not (folder / "events.csv").exists(), "csv: events of a run without any")
        return
    with open(folder / "events.csv", newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    equal(np.array([float(row["time [s]"]) for row in rows]), file["events/time"][()], "csv: events, time")
    equal(np.array([float(row["value"]) for row in rows]), file["events/value"][()], "csv: events, value")
    require([row["kind"] for row in rows] == list(file["events/kind"].asstr()), "csv: events, kind")
    require([row["joint"] for row in rows] == [joints[k] for k in file["events/joint"]], "csv: events, joint")
    units = {"impact": "N s", "crack": "m", "break": "m", "crush": "m", "collapse": "m"}
    require(all(row["unit"] == units[row["kind"]] for row in rows), "csv: events, unit")


def check_csv_drift(folder, tops, columns):
    with open(folder / "drift.csv", newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    require([row["top"] for row in rows] == tops, "csv: tops")
    for key, values in columns.items():
        equal(np.array([float(row[f"{key} [{DRIFT_COLUMNS[key]}]"]) for row in rows]), values, f"csv: drift, {key}")


def check_csv(folder, time, heads, values, names, envelopes):
    with open(folder / "histories.csv", newline="", encoding="utf-8") as stream:
        rows = list(csv.reader(stream))
    require(rows[0] == ["time [s]", *heads], "csv: header of histories")
    table = np.array(rows[1:], dtype=float).reshape(len(rows) - 1, len(rows[0]))
    equal(table[:, 0], time, "csv: time")
    for k, column in enumerate(values):
        equal(table[:, k + 1], column, f"csv: {heads[k]}")
    for what in ["block", "joint"]:
        with open(folder / f"{what}_envelopes.csv", newline="", encoding="utf-8") as stream:
            rows = list(csv.reader(stream))
        columns = {"block": BLOCK_ENVELOPES, "joint": JOINT_ENVELOPES}[what]
        header = [what, *(k if u == "1" else f"{k} [{u}]" for k, u in columns.items())]
        require(rows[0] == header, f"csv: header of {what} envelopes")
        require([r[0] for r in rows[1:]][: len(names[what])] == names[what], f"csv: names of {what} envelopes")
        for k, key in enumerate(columns):
            equal(np.array([float(r[k + 1]) for r in rows[1:]]), envelopes[what][key], f"csv: {what} {key}")
    for table, name in [("blocks", "block"), ("joints", "joint")]:
        with open(folder / f"{table}.csv", newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        require([row["name"] for row in rows] == names[name], f"csv: names of {table}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("result", type=pathlib.Path)
    parser.add_argument("--csv", type=pathlib.Path, help="folder of the CSV export of the same run")
    parser.add_argument("--npz", type=pathlib.Path, help="NPZ export of the same run")
    parser.add_argument("--vtkhdf", type=pathlib.Path, help="VTKHDF export of the same run")
    arguments = parser.parse_args()

    check_digest(arguments.result)
    result = Result(arguments.result)
    check_head(result)
    block_names, blocks, outlines = check_wall(result)
    joint_names, _ = check_joints(result, len(block_names))
    unknowns = int(result.array("layout/unknowns", (), "u8", "1"))
    require(len(block_names) <= unknowns <= len(block_names) + 1, "unknowns are neither the blocks nor one more")
    time, heads, values = check_history(result)
    frames = check_frames(result, unknowns, len(joint_names))
    drifts = check_drift(result, result.texts("wall/panels/name"))
    block_envelopes, joint_envelopes = check_sums(result, unknowns, len(joint_names))
    check_vtkhdf_tree(result)
    result.check_nothing_left()

    for path in filter(None, [arguments.result, arguments.vtkhdf]):
        check_vtk(path, blocks, outlines, block_envelopes, *frames)
    if arguments.npz:
        check_npz(arguments.npz, result.file)
    if arguments.csv:
        names = {"block": block_names, "joint": joint_names}
        envelopes = {"block": block_envelopes, "joint": joint_envelopes}
        check_csv(arguments.csv, time, heads, values, names, envelopes)
        check_csv_events(arguments.csv, result.file, joint_names)
        check_csv_drift(arguments.csv, *drifts)
        check_csv_corners(arguments.csv, block_names, outlines[0], result.file)
    print(
        f"{arguments.result}: {len(block_names)} blocks, {len(joint_names)} joints, {len(time)} samples of "
        f"{len(values)} channels, {len(frames[0])} frames: h5py and VTK agree"
    )


if __name__ == "__main__":
    main()
