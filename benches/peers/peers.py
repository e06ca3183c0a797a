#!/usr/bin/env python3
"""Torquescope, heyoka, MuJoCo and Rapier on the same problems, in turns in one run.

    python3 benches/peers/peers.py [--rounds N] [--venv DIR]

Makes a virtual environment of requirements.txt (in benches/target, unless DIR has one), builds the
benchmark and Rapier's package, and prints a table. Times are processor time of one thread, pinned to one
core where the system can do that; the shortest of all rounds counts. What heyoka compiles is not counted.
"""
import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
BENCH = HERE.parent


def environment(venv):
    """Runs this script again by the environment's Python, which it makes where there is none."""
    python = venv / "bin" / "python"
    if Path(sys.prefix).resolve() == venv.resolve():
        return
    if not python.exists():
        subprocess.check_call([sys.executable, "-m", "venv", venv])
        requirements = HERE / "requirements.txt"
        subprocess.check_call([python, "-m", "pip", "install", "-q", "-r", requirements])
    os.execv(python, [str(python), *sys.argv])


def built(manifest, name):
    """The path of a package's program, in its release build."""
    command = ["cargo", "build", "--release", "--locked", "--message-format=json", "--manifest-path", manifest]
    out = subprocess.run(command, stdout=subprocess.PIPE, check=True, text=True).stdout
    messages = [json.loads(line) for line in out.splitlines() if line.startswith("{")]
    return next(m["executable"] for m in messages if m.get("executable") and m["target"]["name"] == name)


# The problems of benches/src/problems.rs.
T = 100.0
FREE = dict(i=(1.0, 2.0, 3.0), rho=None, q=(0.0, 0.0, 0.0, 1.0), w=(0.1, 2.0, 0.1),
            end=(0.031691645443719078, -0.954876513149810834, -0.169401337276030943, 0.241887724312378339))
TOP = dict(i=(1.0, 1.6, 2.1), rho=(0.3, 0.2, 1.0), q=(0.1, 0.3, -0.2, 0.86**0.5), w=(0.5, -0.8, 2.0),
           end=(-0.05181218972839730950, -0.22901013552255662849, -0.96940912033280163464, -0.07152490642477261241))


def equations(hy, problem, factored):
    """State (q, m), m = I w in body axes. `factored`: in as few operations as were found to do."""
    x, y, z, w, a, b, c = hy.make_vars("x", "y", "z", "w", "a", "b", "c")
    i, rho = problem["i"], problem["rho"]
    p, q, r = a / i[0], b / i[1], c / i[2]
    torque = (0.0, 0.0, 0.0)
    if factored:
        free = (b * c * (1 / i[2] - 1 / i[1]), c * a * (1 / i[0] - 1 / i[2]), a * b * (1 / i[1] - 1 / i[0]))
        if rho:
            s, v, n = x * z - w * y, y * z + w * x, x * x + y * y
            torque = (2 * rho[2] * v - rho[1] * (1 - 2 * n), rho[0] * (1 - 2 * n) - 2 * rho[2] * s,
                      2 * rho[1] * s - 2 * rho[0] * v)
    else:
        free = (b * r - c * q, c * p - a * r, a * q - b * p)
        if rho:
            u = (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))
            torque = (u[1] * rho[2] - u[2] * rho[1], u[2] * rho[0] - u[0] * rho[2], u[0] * rho[1] - u[1] * rho[0])
    return [(x, 0.5 * (w * p + y * r - z * q)), (y, 0.5 * (w * q + z * p - x * r)),
            (z, 0.5 * (w * r + x * q - y * p)), (w, -0.5 * (x * p + y * q + z * r)),
            (a, free[0] + torque[0]), (b, free[1] + torque[1]), (c, free[2] + torque[2])]


class Heyoka:
    def __init__(self):
        import heyoka
        import numpy
        self.np = numpy
        self.integrators = {}
        for name, problem in (("free", FREE), ("top", TOP)):
            start = numpy.array([*problem["q"], *(i * w for i, w in zip(problem["i"], problem["w"]))])
            for tolerance in (1e-10, 1e-12, 1e-15):
                for factored in (True, False):
                    ta = heyoka.taylor_adaptive(equations(heyoka, problem, factored), start, tol=tolerance)
                    self.integrators[name, tolerance, factored] = (ta, start, problem["end"])

    def reset(self, ta, start):
        ta.state[:] = start
        ta.time = 0.0

    def run(self, repeats):
        """us of processor time and errors, the faster of the two forms counting."""
        times, errors = {}, {}
        grid = self.np.linspace(0.0, T, 1001)
        for (name, tolerance, _), (ta, start, end) in self.integrators.items():
            for what, go in (("end", lambda: ta.propagate_until(T)), ("1000 instants", lambda: ta.propagate_grid(grid))):
                key = (name, tolerance, what)
                for _ in range(repeats):
                    self.reset(ta, start)
                    begin = time.thread_time()
                    go()
                    took = 1e6 * (time.thread_time() - begin)
                    if took < times.get(key, float("inf")):
                        times[key] = took
                        errors[key] = self.error(ta.state[:4], end)
        return times, errors

    def error(self, q, end):
        q, end = q / self.np.linalg.norm(q), self.np.array(end)
        return 2 * min(self.np.linalg.norm(q - end), self.np.linalg.norm(q + end))


class Mujoco:
    def __init__(self):
        import mujoco
        self.mujoco = mujoco
        self.one, self.many = self.model("RK4", 1), self.model("Euler", 1000)

    def model(self, integrator, bodies):
        body = '<body pos="%d 0 0"><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="1 2 3"/></body>'
        text = '<mujoco><option timestep="0.01" gravity="0 0 0" integrator="%s"/><worldbody>%s</worldbody></mujoco>'
        return self.mujoco.MjModel.from_xml_string(text % (integrator, "".join(body % k for k in range(bodies))))

    def time(self, model, steps):
        data = self.mujoco.MjData(model)
        for k in range(model.nbody - 1):
            data.qvel[6 * k + 3:6 * k + 6] = (0.1, 2.0, 0.1)
        self.mujoco.mj_step(model, data)
        begin = time.thread_time()
        self.mujoco.mj_step(model, data, nstep=steps)
        return 1e9 * (time.thread_time() - begin) / (steps * (model.nbody - 1))

    def run(self, repeats):
        one = min(self.time(self.one, 1000) for _ in range(repeats))
        many = min(self.time(self.many, 20) for _ in range(repeats))
        return {"one": one, "many": many}


def keep_least(best, new):
    for key, value in new.items():
        best[key] = min(value, best.get(key, float("inf")))


def bench(program, sections, repeats):
    """Rows of the Rust benchmark: the value and the note of each."""
    out = subprocess.check_output([program, "--json", "--repeats", str(repeats), *sections], text=True)
    rows = {}
    for section in json.loads(out)["sections"]:
        for row in section["rows"]:
            rows[section["name"], row["name"]] = (row["value"], row["note"])
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--venv", type=Path, default=BENCH / "target" / "peers")
    options = parser.parse_args()
    environment(options.venv)
    ours = built(BENCH / "Cargo.toml", "torquescope-bench")
    rapier = built(HERE / "rapier" / "Cargo.toml", "rapier-peer")
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})

    heyoka, mujoco = Heyoka(), Mujoco()
    mine, notes, theirs, errors, engines = {}, {}, {}, {}, {"mujoco": {}, "rapier": {}}
    for turn in range(options.rounds):
        # Ten thousand bodies by every method take long: first and last round only.
        many = ["methods"] if turn in (0, options.rounds - 1) else []
        for key, (value, note) in bench(ours, ["precision", "weights", *many], 2).items():
            keep_least(mine, {key: value})
            notes[key] = note
        times, error = heyoka.run(5)
        keep_least(theirs, times)
        errors.update(error)
        keep_least(engines["mujoco"], mujoco.run(3))
        keep_least(engines["rapier"], json.loads(subprocess.check_output([rapier], text=True)))
        print(f"round {turn + 1} of {options.rounds}, load {os.getloadavg()[0]:.1f}", file=sys.stderr)

    print(f"T = {T:g} s, us; heyoka / torquescope, and errors in rad")
    rows = []
    for tolerance in (1e-10, 1e-12, 1e-15):
        for what, goal in (("end", 150), ("1000 instants", 4)):
            name = f"free, formula, {what}"
            rows.append(("free", tolerance, what, name, f"goal {goal} or more" if tolerance == 1e-12 else ""))
    for tolerance, goal in ((1e-10, "goal 1.25 or more"), (1e-12, ""), (1e-15, "goal 1.67 or more")):
        text = f"{tolerance:.0e}".replace("e-0", "e-")
        for method in ("taylor", "dop853"):
            for what in ("end", "1000 instants"):
                wanted = goal if method == "taylor" and what == "end" else ""
                rows.append(("top", tolerance, what, f"top, {method} {text}, {what}", wanted))
    for problem, tolerance, what, name, goal in rows:
        key = (problem, tolerance, what)
        value = mine["precision", name]
        ratio = theirs[key] / value
        print(f"  {problem:5}{tolerance:7.0e} {what:14} heyoka {theirs[key]:8.1f} (error {errors[key]:.1e})"
              f"   {name:34} {value:8.2f} ({notes['precision', name]})   {ratio:7.2f} x  {goal}")

    print("\nFree bodies with the gyroscopic term, ns a body-step: whole engine / the same scheme here")
    for engine, scheme, one, many in (("rapier", "rapier", 1, 10_000), ("mujoco", "mujoco-rk4", 1, None)):
        value = mine["weights", scheme]
        theirs_one = engines[engine]["one"]
        print(f"  one body         {engine:8} {theirs_one:9.1f}   {scheme:14} {value:8.1f}   {theirs_one / value:7.2f} x")
        if many:
            value = mine["methods", f"{scheme}, free, gyroscopic"]
            theirs_many = engines[engine]["many"]
            print(f"  {many} bodies     {engine:8} {theirs_many:9.1f}   {scheme:14} {value:8.1f}   {theirs_many / value:7.2f} x")
    value = mine["methods", "semi-implicit, free, gyroscopic"]
    theirs_many = engines["mujoco"]["many"]
    print(f"  1000 bodies      mujoco   {theirs_many:9.1f}   semi-implicit  {value:8.1f}   {theirs_many / value:7.2f} x  (Euler there)")


if __name__ == "__main__":
    main()
