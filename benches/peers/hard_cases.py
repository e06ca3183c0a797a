#!/usr/bin/env python3
"""The hard cases of tests/hard_cases by Rapier, MuJoCo and Bullet, each as it steps by default, and MuJoCo's RK4.

    python3 benches/peers/hard_cases.py [--venv DIR]        writes benches/peers/hard_cases.csv

Every row: case, engine, and `off` with the attitude's error at the end (rad), `lost` with the time (s) at which the engine had
no finite state (Bullet: attitude) or gave the motion up, `refused` with the engine's words, or `dropped` where it goes on as if nothing had been. The truth of free bodies is that of
tests/oracles/hard_free.csv, of the others a closed form. What an engine has no means for is left out.
"""
import argparse
import csv
import math
import subprocess
from pathlib import Path

from peers import BENCH, HERE, built, environment

H = 0.01
MASSES = {"mass-1e-30": 1e-30, "mass-1e30": 1e30, "nanometre": 1e-24, "planet": 5.97e24}


def problem(name, h, steps, I, w, truth, mass=1.0, c=0.0, torque=0.0, impulse=0.0, arm=0.0, gravity=0.0, angle=0.0):
    return dict(name=name, h=h, steps=int(steps), I=I, w=w, truth=truth, mass=mass, c=c, torque=torque, impulse=impulse,
                arm=arm, gravity=gravity, angle=angle)


def about_z(angle):
    return (0.0, 0.0, math.sin(angle / 2), math.cos(angle / 2))


def pendulum(omega_h, steps):
    """1 kg on an arm of 1 m, I = 1.5 about the pivot, let go at half a radian: sin(θ/2) = k sn(K - Ω t)."""
    from mpmath import asin, ellipfun, ellipk, mpf, sin
    omega, angle = omega_h / H, 0.5
    k = sin(mpf(angle) / 2)
    theta = 2 * asin(k * ellipfun("sn", ellipk(k * k) - omega * steps * H, m=k * k))
    return problem(f"pendulum-{omega_h:g}", H, steps, (0.5, 0.5, 0.5), (0.0,) * 3, about_z(float(theta)), arm=-1.0,
                   gravity=1.5 * omega * omega, angle=angle)


def problems():
    path = HERE.parent.parent / "tests" / "oracles" / "hard_free.csv"
    for row in csv.DictReader(path.open()):
        name = row["name"]
        if name.startswith(("steps-", "seconds-")):
            continue
        h, t, c = (float.fromhex(row[k]) for k in ("h", "t", "c"))
        I, w = ([float.fromhex(row[f"{x}{k}"]) for k in (1, 2, 3)] for x in "Iw")
        truth = [float(row["q" + x]) for x in "xyzw"]
        arm = 0.0
        if name == "pivot-kilometre":
            I, arm = [1.0, 2.0, 2.5], 1000.0
        yield problem(name, h, round(t / h), I, w, truth, mass=MASSES.get(name, 1.0), c=c, arm=arm)
    for omega_h, steps in ((0.01, 1000), (0.1, 1000), (1.0, 1000), (1.9, 1000), (2.1, 1000), (10.0, 100), (1000.0, 5)):
        yield pendulum(omega_h, steps)
    body = (1.0, 2.0, 2.5)
    for name, a, steps in (("torque-1e-2", 1e-2, 100), ("torque-1", 1.0, 100), ("torque-1e4", 1e4, 3)):
        alpha, t = a / H**2, steps * H
        yield problem(name, H, steps, body, (0.0, 0.0, 1e-3), about_z(1e-3 * t + 0.5 * alpha * t * t), torque=2.5 * alpha)
    yield problem("impulse-1e308", H, 100, body, (0.0,) * 3, (0.0, 0.0, 0.0, 1.0), impulse=1e308)


def error(q, truth):
    """The angle between two attitudes, rad."""
    x, y, z, w = q
    a, b, c, d = (-truth[0], -truth[1], -truth[2], truth[3])
    u = (d * x + a * w + b * z - c * y, d * y - a * z + b * w + c * x, d * z + a * y - b * x + c * w)
    return 2 * math.atan2(math.hypot(*u), abs(d * w - a * x - b * y - c * z))


def rapier(all_problems):
    program = built(HERE / "rapier" / "Cargo.toml", "rapier-peer")
    keys = ("c", "torque", "impulse", "arm", "gravity", "angle")
    lines = [" ".join(map(repr, (p["h"], p["steps"], p["mass"], *map(float, p["I"]), *map(float, p["w"]), *(p[k] for k in keys))))
             for p in all_problems]
    text = "".join(f"{p['name']} {line}\n" for p, line in zip(all_problems, lines))
    out = subprocess.run([program, "cases"], input=text, stdout=subprocess.PIPE, text=True).stdout
    answers = {line.split()[0]: line.split()[1:] for line in out.splitlines()}
    for p in all_problems:
        answer = answers.get(p["name"])
        if answer is None:
            yield p["name"], "refused", "the program ends without an answer"
        elif answer[0] == "off":
            yield p["name"], "off", error([float(x) for x in answer[1:]], p["truth"])
        else:
            yield p["name"], "lost", float(answer[1])


def mujoco(all_problems, integrator):
    import mujoco
    import numpy
    for p in all_problems:
        if p["c"]:
            continue  # its damping is a torque that does not know the inertia
        q = about_z(p["angle"])
        numbers = lambda v: " ".join(repr(float(x)) for x in v)
        joint = '<joint type="ball" pos="0 0 0"/>' if p["arm"] else "<freejoint/>"
        text = (f'<mujoco><compiler balanceinertia="false"/><option timestep="{p["h"]!r}" gravity="0 {-p["gravity"]!r} 0" '
                f'integrator="{integrator}"/><worldbody><body quat="{numbers([q[3], *q[:3]])}">{joint}'
                f'<inertial pos="0 {p["arm"]!r} 0" mass="{p["mass"]!r}" diaginertia="{numbers(p["I"])}"/></body></worldbody></mujoco>')
        try:
            model = mujoco.MjModel.from_xml_string(text)
        except Exception as why:
            yield p["name"], "refused", " ".join(str(why).split())
            continue
        data = mujoco.MjData(model)
        at, turn = (0, 0) if p["arm"] else (3, 3)
        data.qvel[turn:turn + 3] = p["w"]
        lost = None
        for k in range(p["steps"]):
            if p["torque"]:
                data.xfrc_applied[1, 3:] = (0, 0, p["torque"])
            if k == 5 and p["impulse"]:
                data.qvel[2] += p["impulse"] / p["mass"]
                data.qvel[turn + 1] -= p["impulse"] / p["I"][1]
            mujoco.mj_step(model, data)
            # It sets a motion that has become bad back to its start, and counts that.
            bad = sum(int(data.warning[w].number) for w in (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL,
                                                          mujoco.mjtWarning.mjWARN_BADQACC))
            if bad or not numpy.all(numpy.isfinite(data.qpos)):
                lost = (k + 1) * p["h"]
                break
        w, x, y, z = data.qpos[at:at + 4]
        if p["arm"]:  # a ball joint counts from the start, here a turn about z
            c, s = q[3], q[2]
            w, x, y, z = c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w
        yield (p["name"], "lost", lost) if lost else (p["name"], "off", error((x, y, z, w), p["truth"]))


def bullet(all_problems):
    import pybullet as b
    b.connect(b.DIRECT)
    for p in all_problems:
        if p["arm"]:
            continue  # through Python its rigid bodies take no constraint to a point of the world
        b.resetSimulation()
        b.setGravity(0, 0, 0)
        b.setPhysicsEngineParameter(numSubSteps=0, fixedTimeStep=p["h"])
        b.setTimeStep(p["h"])
        shape = b.createCollisionShape(b.GEOM_SPHERE, radius=0.5)
        body = b.createMultiBody(baseMass=p["mass"], baseCollisionShapeIndex=shape, basePosition=(0, 0, 0),
                                 useMaximalCoordinates=1)
        # Its damping is the part of a velocity lost a second.
        lost_a_second = -math.expm1(-p["c"])
        b.changeDynamics(body, -1, localInertiaDiagonal=[float(x) for x in p["I"]], linearDamping=0, angularDamping=lost_a_second,
                         activationState=b.ACTIVATION_STATE_DISABLE_SLEEPING)
        b.stepSimulation()  # at rest; only a step renews the world inertia
        b.resetBaseVelocity(body, (0, 0, 0), [float(x) for x in p["w"]])
        lost = None
        for k in range(p["steps"]):
            if p["torque"]:
                b.applyExternalTorque(body, -1, (0, 0, p["torque"]), b.WORLD_FRAME)
            if k == 5 and p["impulse"]:
                b.resetBaseVelocity(body, (0, 0, p["impulse"] / p["mass"]), (0, -p["impulse"] / p["I"][1], 0))
            b.stepSimulation()
            # Its place is no number from the first step on, in every case: only how it turns counts.
            q, w = b.getBasePositionAndOrientation(body)[1], b.getBaseVelocity(body)[1]
            if not all(map(math.isfinite, (*q, *w))):
                lost = (k + 1) * p["h"]
                break
        yield (p["name"], "lost", lost) if lost else (p["name"], "off", error(q, p["truth"]))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--venv", type=Path, default=BENCH / "target" / "peers")
    options = parser.parse_args()
    environment(options.venv)
    everything = list(problems())
    engines = (("rapier", rapier(everything)), ("mujoco", mujoco(everything, "Euler")), ("mujoco-rk4", mujoco(everything, "RK4")),
               ("bullet", bullet(everything)))
    with (HERE / "hard_cases.csv").open("w") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(("case", "engine", "outcome", "value"))
        for engine, answers in engines:
            for name, outcome, value in answers:
                # No attitude is right after a blow beyond all numbers: one that is left has not had it.
                if name.startswith("impulse") and outcome == "off":
                    outcome, value = "dropped", ""
                rows.writerow((name, engine, outcome, value if isinstance(value, str) else f"{value:.3g}"))


if __name__ == "__main__":
    main()
