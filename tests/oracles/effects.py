#!/usr/bin/env python3
"""Bodies under the effects, in 40 digits: Gragg's midpoint rule extrapolated (Bulirsch & Stoer; Hairer, Norsett &
Wanner, Solving ODEs I, II.9), twice with other steps and columns, which must agree to 1e-22 (they do to 5e-25).

One body: m = 1.3 kg, principal moments (0.6, 0.8, 1.0) kg m2 about its centre of mass, body axes = principal axes,
identity start, angular momentum (1.8, 0.4, -0.9), gyroscopic. Everything world but for what says body.

    spring          k = 4, rest 0.5, anchor (0.2, 1.0, -0.1), at the body's point (0.3, -0.2, 0.4)
    spring_damped   the same with 0.3 N s/m along the line
    motor           0.7 sin(2 pi 0.35 t + 0.4) about (1, 2, -1) of the body
    hold            to one radian about (1, 1, 0): 3 N m/rad, 0.5 N m s/rad
    drag            0.2 and 0.1 of the velocity, 0.15 and 0.05 of the angular velocity
    orbit           mu = 4 at the origin, force and torque, potential to second order

Writes effects.csv: case, t, x (3), v (3), q (x, y, z, w), omega (3, world).
"""

from mpmath import mp, mpf, sqrt, sin, acos, matrix
import os

mp.dps = 40
M = mpf("1.3")
I = [mpf("0.6"), mpf("0.8"), mpf("1.0")]
L = [mpf("1.8"), mpf("0.4"), mpf("-0.9")]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def scale(a, s):
    return [x * s for x in a]


def add(*vs):
    return [sum(c) for c in zip(*vs)]


def norm(a):
    return sqrt(dot(a, a))


def rows(q):
    """The rotation matrix, body to world, of an attitude of any length."""
    x, y, z, w = q
    n = dot(q, q)
    return [
        [(w * w + x * x - y * y - z * z) / n, 2 * (x * y - w * z) / n, 2 * (x * z + w * y) / n],
        [2 * (x * y + w * z) / n, (w * w - x * x + y * y - z * z) / n, 2 * (y * z - w * x) / n],
        [2 * (x * z - w * y) / n, 2 * (y * z + w * x) / n, (w * w - x * x - y * y + z * z) / n],
    ]


def to_world(r, v):
    return [dot(row, v) for row in r]


def to_body(r, v):
    return [sum(r[i][k] * v[i] for i in range(3)) for k in range(3)]


def product(a, b):
    """Of quaternions x, y, z, w."""
    u = add(scale(b[:3], a[3]), scale(a[:3], b[3]), cross(a[:3], b[:3]))
    return u + [a[3] * b[3] - dot(a[:3], b[:3])]


# Each: force (world), torque (body axes) from t, x, v, R, q, omega (body).


def spring(damping):
    k, rest = mpf(4), mpf("0.5")
    anchor = [mpf("0.2"), mpf(1), mpf("-0.1")]
    point = [mpf("0.3"), mpf("-0.2"), mpf("0.4")]

    def act(t, x, v, r, q, omega):
        arm = to_world(r, point)
        d = add(x, arm, scale(anchor, -1))
        speed = add(v, to_world(r, cross(omega, point)))
        length = norm(d)
        u = scale(d, 1 / length)
        force = scale(u, -(k * (length - rest) + damping * dot(speed, u)))
        return force, cross(point, to_body(r, force))

    return act


def motor(t, x, v, r, q, omega):
    axis = scale([mpf(1), mpf(2), mpf(-1)], 1 / sqrt(mpf(6)))
    return [mpf(0)] * 3, scale(axis, mpf("0.7") * sin(2 * mp.pi * mpf("0.35") * t + mpf("0.4")))


def hold(t, x, v, r, q, omega):
    half = mpf("0.5")
    target = scale([1 / sqrt(mpf(2)), 1 / sqrt(mpf(2)), mpf(0)], sin(half)) + [mp.cos(half)]
    q = scale(q, 1 / norm(q))
    error = product(q, scale(target[:3], -1) + [target[3]])
    if error[3] < 0:
        error = scale(error, -1)
    angle = 2 * acos(error[3])
    theta = scale(error[:3], angle / norm(error[:3]))
    return [mpf(0)] * 3, add(scale(to_body(r, theta), -3), scale(omega, mpf("-0.5")))


def drag(t, x, v, r, q, omega):
    force = scale(v, -(mpf("0.2") + mpf("0.1") * norm(v)))
    return force, scale(omega, -(mpf("0.15") + mpf("0.05") * norm(omega)))


def orbit(t, x, v, r, q, omega):
    """By the gradient of the potential in moments, written out in coordinates of the body."""
    mu = mpf(4)
    b = to_body(r, x)
    s = norm(b)
    ib = [i * c for i, c in zip(I, b)]
    trace, about = sum(I), dot(b, ib)
    # V = -mu m/s - mu/2 (tr I/s^3 - 3 b.I b/s^5)
    grad = [
        mu * M * c / s**3 - mu / 2 * (-3 * trace * c / s**5 - 6 * ic / s**5 + 15 * about * c / s**7)
        for c, ic in zip(b, ib)
    ]
    return to_world(r, scale(grad, -1)), scale(cross(b, ib), 3 * mu / s**5)


CASES = {
    "spring": (spring(mpf(0)), [0, 0, 0], ["0.1", 0, "0.2"]),
    "spring_damped": (spring(mpf("0.3")), [0, 0, 0], ["0.1", 0, "0.2"]),
    "motor": (motor, [0, 0, 0], [0, 0, 0]),
    "hold": (hold, [0, 0, 0], [0, 0, 0]),
    "drag": (drag, ["0.3", 0, 0], [2, "-0.5", 1]),
    "orbit": (orbit, [2, 0, 0], [0, "1.4", "0.1"]),
}


def right_side(act):
    def f(t, y):
        x, v, q, omega = y[:3], y[3:6], y[6:10], y[10:]
        r = rows(q)
        force, torque = act(t, x, v, r, q, omega)
        spin = product(q, scale(omega, mpf(1) / 2) + [mpf(0)])
        moment = [i * w for i, w in zip(I, omega)]
        turn = add(torque, scale(cross(omega, moment), -1))
        return v + scale(force, 1 / M) + spin + [a / i for a, i in zip(turn, I)]

    return f


def midpoint(f, t, y, h, n):
    step = h / n
    before, now = y, add(y, scale(f(t, y), step))
    for k in range(1, n):
        before, now = now, add(before, scale(f(t + k * step, now), 2 * step))
    return scale(add(before, now, scale(f(t + h, now), step)), mpf(1) / 2)


def extrapolated(f, t, y, h, columns):
    table = []
    for j in range(columns):
        row = [midpoint(f, t, y, h, 2 * (j + 1))]
        for k in range(1, j + 1):
            ratio = (mpf(j + 1) / (j + 1 - k)) ** 2
            row.append([a + (a - b) / (ratio - 1) for a, b in zip(row[k - 1], table[-1][k - 1])])
        table.append(row)
    return table[-1][-1]


def solve(f, y, end, steps, columns):
    h = end / steps
    for k in range(steps):
        y = extrapolated(f, k * h, y, h, columns)
    return y


def main():
    end = mpf(3)
    lines = ["case,t,x,y,z,vx,vy,vz,qx,qy,qz,qw,wx,wy,wz"]
    for name, (act, x, v) in CASES.items():
        f = right_side(act)
        start = [mpf(c) for c in x + v] + [mpf(0)] * 3 + [mpf(1)] + [l / i for l, i in zip(L, I)]
        y = solve(f, start, end, 30, 14)
        other = solve(f, start, end, 45, 13)
        apart = max(abs(a - b) for a, b in zip(y, other))
        print(name, mp.nstr(apart, 3), flush=True)
        assert apart < mpf(10) ** -22, name
        q = scale(y[6:10], 1 / norm(y[6:10]))
        omega = to_world(rows(q), y[10:])
        numbers = [end] + y[:6] + q + omega
        lines.append(",".join([name] + [mp.nstr(c, 20) for c in numbers]))
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "effects.csv"), "w") as out:
        out.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
