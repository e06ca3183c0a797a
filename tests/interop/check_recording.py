#!/usr/bin/env python3
"""Reads the cone's recording with Rerun's own Python reader and checks the values in it.

    check_recording.py RECORDING.rrd REPORT.json

REPORT.json is what `torquescope run scenes/cone.toml --json` printed for the same run. The expected
torques and accelerations are computed here, from the formulas of docs/physics.md.
"""
import json
import math
import sys

import numpy as np
import pyarrow as pa
from rerun.experimental import RrdReader

BODIES = ["free-A", "base-A", "apex-A", "free-B", "base-B", "apex-B"]
SECOND = 1_000_000_000


def read(path):
    """Entity -> list of (sim_time ns, step, {column: value}), static rows left out; and statics."""
    reader = RrdReader(path)
    recordings = reader.recordings()
    assert len(recordings) == 1, f"{len(recordings)} recordings in one file"
    rows, statics, timelines = {}, {}, set()
    for chunk in reader.stream(store=recordings[0]).to_chunks():
        batch = chunk.to_record_batch()
        names = batch.schema.names
        times = [n for n in names if n in ("sim_time", "step", "log_time", "log_tick")]
        if chunk.is_static:
            statics.setdefault(chunk.entity_path, set()).update(names)
            continue
        timelines.update(times)
        columns = {n: batch.column(names.index(n)) for n in names if "RowId" not in n}
        for i in range(batch.num_rows):
            row = {n: plain(c[i]) for n, c in columns.items()}
            rows.setdefault(chunk.entity_path, []).append(row)
    return rows, statics, timelines


def plain(scalar):
    return scalar.value if pa.types.is_temporal(scalar.type) else scalar.as_py()


def near(got, want, bound, what):
    got, want = np.asarray(got, float), np.asarray(want, float)
    worst = np.max(np.abs(got - want)) if got.size else 0.0
    assert got.shape == want.shape and worst <= bound, f"{what}: {got} is not {want} (off by {worst:g})"


def expected_blows():
    """Torque and angular acceleration of each reading at the blow, by lever arm and moments."""
    s = 10.0 / math.sqrt(2.0)
    a, b = np.array([-10.0, 0, 0]), np.array([-s, 0, s])
    base = np.diag([3 / 20 + 1 / 10, 3 / 10, 3 / 20 + 1 / 10])
    apex = np.diag([3 / 20 + 3 / 5, 3 / 10, 3 / 20 + 3 / 5])
    free = np.diag([3 / 80 * 5, 3 / 10, 3 / 80 * 5])
    quarter = np.array([0, 0.25, 0])
    cases = {
        "free-A": (np.array([0, 1, 0]) - quarter, a, free),
        "base-A": (np.array([0, 1, 0]), a, base),
        "apex-A": (np.array([0, 1, 0]), a, apex),
        "free-B": (np.array([1, 0, 0]) - quarter, b, free),
        "base-B": (np.array([1, 0, 0]), b, base),
        "apex-B": (np.array([1, 0, 0]), b, apex),
    }
    blows = {}
    for name, (arm, force, inertia) in cases.items():
        tau = np.cross(arm, force)
        blows[name] = (tau, np.linalg.solve(inertia, tau), inertia, arm, force)
    return blows


def check_body(name, rows, report):
    numbers = rows[f"/numbers/{name}"]
    at = lambda ns: [r for r in numbers if r["sim_time"] == ns]
    tau, alpha, inertia, arm, force = expected_blows()[name]
    (struck,) = at(0)
    near(struck["torque"], tau, 1e-12, f"{name} torque")
    near(struck["angular_acceleration"], alpha, 1e-12, f"{name} angular acceleration")
    near(np.reshape(struck["inertia"], (3, 3)), inertia, 1e-12, f"{name} inertia")
    near(struck["force"], force, 1e-12, f"{name} force")
    # Lever arm from the reference point: the pivot below or above the centre of mass, or that itself.
    up = {"free": 0.0, "base": -0.25, "apex": -0.75}[name[:4]]
    reference = np.asarray(struck["position"]) + np.array([0, up, 0])
    near(np.asarray(struck["force_point"]) - reference, arm, 1e-12, f"{name} point of the push")
    before, after = at(SECOND // 10)
    assert np.linalg.norm(before["torque"]) > 1 and np.linalg.norm(after["torque"]) == 0, f"{name}: blow's end"
    assert after["force"] == [] and len(before["force"]) == 3, f"{name}: pushes"

    for r in numbers:
        i, inverse = np.reshape(r["inertia"], (3, 3)), np.reshape(r["inverse_inertia"], (3, 3))
        near(i, i.T, 0.0, f"{name} inertia is symmetric")
        # Products of matrices with entries of size 1 to 6: a few roundings.
        near(i @ inverse, np.eye(3), 1e-14, f"{name} inverse")
        near(inverse @ r["torque"], r["angular_acceleration"], 1e-13, f"{name}: the tutorial's alpha")
        near(i @ r["angular_velocity"], r["angular_momentum"], 1e-14, f"{name} momentum")
        energy = 0.5 * np.dot(r["angular_velocity"], r["angular_momentum"])
        if name.startswith("free"):
            energy += 0.5 * np.dot(r["velocity"], r["velocity"])
        near(r["kinetic_energy"], [energy], 1e-14, f"{name} energy")
        near(np.linalg.norm(r["orientation"]), 1.0, 1e-15, f"{name} attitude")

    times = [r["sim_time"] for r in numbers]
    assert times == sorted(times) and len(times) == 1 + 60 + 1, f"{name}: {len(times)} derived rows"
    end = next(b for b in report["bodies"] if b["name"] == name)
    for column, key in [("position", "position"), ("orientation", "orientation"), ("velocity", "velocity"),
                        ("angular_velocity", "angular_velocity"), ("angular_momentum", "angular_momentum")]:
        assert numbers[-1][column] == end[key], f"{name}: the report's {key} is not the recording's"

    states = rows[f"/bodies/{name}"]
    assert [r["step"] for r in states] == list(range(1001)), f"{name}: the state at every step"
    pictured = {r["sim_time"]: r for r in states}
    for r in numbers:
        f32 = lambda v: [np.float32(x) for x in v]
        assert f32(pictured[r["sim_time"]]["Transform3D:translation"][0]) == f32(r["position"]), f"{name} picture"
        assert f32(pictured[r["sim_time"]]["Transform3D:quaternion"][0]) == f32(r["orientation"]), f"{name} picture"
        assert pictured[r["sim_time"]]["angular_velocity"] == r["angular_velocity"], f"{name} state"


def main():
    rows, statics, timelines = read(sys.argv[1])
    report = json.load(open(sys.argv[2]))
    assert timelines == {"sim_time", "step"}, f"timelines {timelines}"
    assert [b["name"] for b in report["bodies"]] == BODIES
    for name in BODIES:
        for quantity in ["force", "torque", "alpha", "omega", "momentum"]:
            assert f"/{quantity}/{name}" in rows, f"no picture of {quantity} of {name}"
        assert f"/bodies/{name}/shape" in statics and f"/inertia/{name}" in statics
        assert "0.3" in rows[f"/pages/{name}"][0]["TextDocument:text"][0], "the page shows the inertia"
        check_body(name, rows, report)
    log = [r["TextLog:text"][0] for r in rows["/events"]]
    assert len(log) == 12 and any("base-A begins: τ = (0, 0, 10) N·m; the body's α = (0, 0, 40) rad/s²" in line for line in log)
    print(f"{sys.argv[1]}: {sum(map(len, rows.values()))} rows read by rerun-sdk, values as expected")


main()
