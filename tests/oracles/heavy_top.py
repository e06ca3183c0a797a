#!/usr/bin/env python3
"""Reference motions of a heavy top on a pivot, I dw/dt = (I w) x w + u x r, dq/dt = q (w, 0)/2.

    heavy_top.py > heavy_top.csv

u = R^T e_z is the upward vertical in principal axes, r = m g times the centre of mass. Method: a Taylor
integration in 40 digits, which knows of no elliptic function; every eighth case is run again with half
the step, and the script checks itself against a Kovalevskaya top quoted elsewhere. q0 is normalised
exactly before use. Printed: the exact inputs as hexadecimal floats, then q(t) (x, y, z, w) and w(t) in
25 digits.
"""
import random
import sys

from mpmath import fdot, mp, mpf, sqrt

mp.dps = 40


def taylor(I, r, q, w, t, order=44, finer=1):
    size = sqrt(sum(x * x for x in q))
    q = [x / size for x in q]
    X, Y, Z, S = q
    u = [2 * (X * Z - S * Y), 2 * (Y * Z + S * X), S * S + Z * Z - X * X - Y * Y]
    w = list(w)
    left, way = abs(t), (1 if t > 0 else -1)
    a = [(I[(j + 1) % 3] - I[(j + 2) % 3]) / I[j] for j in range(3)]
    g = [x / y for x in (r[0], r[1], r[2]) for y in I]  # g[3k + j] = r_k / I_j
    pull = sqrt(sum(x * x for x in r) / min(I))
    while left > 0:
        h = min(1 / (finer * 4 * (sqrt(sum(x * x for x in w)) + pull)), left)
        W, Q, U = [[x] for x in w], [[x] for x in q], [[x] for x in u]
        for n in range(order):
            conv = lambda p, s: fdot(p[:n + 1], s[n::-1])
            X, Y, Z, S = Q
            dw, du = [], []
            for j in range(3):
                k, l = (j + 1) % 3, (j + 2) % 3
                dw.append(a[j] * conv(W[k], W[l]) + U[k][n] * g[3 * l + j] - U[l][n] * g[3 * k + j])
                du.append(conv(U[k], W[l]) - conv(U[l], W[k]))
            dq = [conv(S, W[0]) + conv(Y, W[2]) - conv(Z, W[1]), conv(S, W[1]) + conv(Z, W[0]) - conv(X, W[2]),
                  conv(S, W[2]) + conv(X, W[1]) - conv(Y, W[0]), -conv(X, W[0]) - conv(Y, W[1]) - conv(Z, W[2])]
            for k in range(3):
                W[k].append(dw[k] / (n + 1))
                U[k].append(du[k] / (n + 1))
            for k in range(4):
                Q[k].append(dq[k] / 2 / (n + 1))
        at = lambda c: sum(x * (way * h) ** k for k, x in enumerate(c))
        w, q, u = [at(c) for c in W], [at(c) for c in Q], [at(c) for c in U]
        left -= h
    return q, w


def itself():
    rows = [  # I, r, q0, w, t, L or q to 20 digits
        ([2, 2, 1], [1, 0, 0], ["0.1", "0.2", "0.3", "0.9"], ["0.5", "-0.4", "1.2"], 10, "L",
         ["0.027482343162850168", "-2.09033484587424998", "0.12044962861528909"])]
    for I, r, q, w, t, what, digits in rows:
        got = taylor(*[[mpf(x) for x in v] for v in (I, r, q, w)], mpf(t))[1]
        off = max(abs(i * x - mpf(d)) for i, x, d in zip(I, got, digits))
        assert off < mpf(10) ** -16, off
        print(f"a Kovalevskaya top quoted elsewhere: {mp.nstr(off, 2)}", file=sys.stderr)


def cases():
    rng = random.Random(20261128)
    u = rng.uniform
    attitude = lambda: [u(-1, 1) for _ in range(4)]
    spin = lambda: [u(-2, 2) for _ in range(3)]

    def lagrange(arm=None):
        i = u(0.5, 2)
        return [i, i, u(0.3, 1.9) * i], [0, 0, u(0.3, 3) if arm is None else arm]

    for k in range(12):
        yield ("generic", *lagrange(), attitude(), spin(), u(0.5, 8))
    for k in range(3):
        yield ("backwards", *lagrange(), attitude(), spin(), -u(1, 8))
    for k in range(3):
        yield ("hung-from-above", *lagrange(-u(0.3, 3)), attitude(), spin(), u(1, 8))
    for k in range(2):
        yield ("weightless", *lagrange(0), attitude(), spin(), u(1, 8))
    for k in range(3):
        yield ("fast", *lagrange(), attitude(), [u(-1, 1), u(-1, 1), u(15, 25)], u(1, 4))
    for k in range(3):  # released at rest but for its spin: cusps
        yield ("cusps", *lagrange(), attitude(), [0, 0, u(3, 6)], u(1, 8))
    for k in range(3):  # no spin, no momentum about the vertical: a plane pendulum, through both poles or one
        yield ("plane", *lagrange(), [u(-1, 1), 0, 0, u(-1, 1)], [[0.5, 6, -0.3][k], 0, 0], u(2, 6))
    for k in range(2):  # spherical pendulum
        yield ("spinless", *lagrange(), attitude(), [u(-2, 2), u(-2, 2), 0], u(2, 8))
    # Through the upper and through the lower pole, starting there or before.
    yield ("upper-pole", *lagrange(), [0, 0, u(-1, 1), 1], [1, -0.5, u(-2, 2)], u(2, 5))
    yield ("upper-pole", *lagrange(), [0, 0, 0, 1], [0.3, 0.2, 6], u(2, 5))
    yield ("lower-pole", *lagrange(), [1, 0.5, 0, 0], [1, -0.5, u(-2, 2)], u(2, 5))
    yield ("lower-pole", *lagrange(), [1, 0, 0, 0], [0.3, 0.2, 2], -u(2, 5))
    yield ("near-lower-pole", *lagrange(), [1, 0.5, 1e-9, 0], [1, -0.5, 1.5], u(2, 5))
    yield ("near-upper-pole", *lagrange(), [1e-9, 0, 0.3, 1], [1, -0.5, 1.5], u(2, 5))
    yield ("near-upper-pole", *lagrange(), [1e-12, 1e-13, 0.3, 1], [1e-6, 0, 1], u(2, 5))
    yield ("sleeping", *lagrange(), [0, 0, 0.3, 1], [0, 0, 4], u(2, 5))
    yield ("steady", [1, 1, 0.5], [0, 0, 1], [0, 0.5, 0, 0.8660254037844386], [-1.7320508075688772, 0, 5], u(2, 5))
    for k in range(6):
        i, arm = u(0.5, 2), [u(-2, 2), u(-2, 2), 0]
        yield "kovalevskaya", [2 * i, 2 * i, i], arm, attitude(), spin(), u(1, 8)


def main():
    itself()
    print("kind,I1,I2,I3,r1,r2,r3,qx0,qy0,qz0,qw0,w1,w2,w3,t,qx,qy,qz,qw,w1_t,w2_t,w3_t")
    for n, (kind, *vectors, t) in enumerate(cases()):
        vectors, t = [[float(x) for x in v] for v in vectors], float(t)
        exact = [[mpf(x) for x in v] for v in vectors]
        q, w = taylor(*exact, mpf(t))
        if n % 8 == 0:
            q2, w2 = taylor(*exact, mpf(t), finer=2)
            off = max(abs(a - b) for a, b in zip(q + w, q2 + w2))
            assert off < mpf(10) ** -26, (kind, off)
            print(f"{kind} {t}: half the step differs by {mp.nstr(off, 2)}", file=sys.stderr)
        print(",".join([kind] + [x.hex() for v in vectors for x in v] + [t.hex()] + [mp.nstr(x, 25) for x in q + w]),
              flush=True)


if __name__ == "__main__":
    main()
