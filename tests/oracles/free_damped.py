#!/usr/bin/env python3
"""Reference motions of a damped free body, I dw/dt = (I w) x w - c I w, in 50 digits.

    free_damped.py > free_damped.csv

Method: a Taylor integration of the equations of motion as they stand; it knows nothing of the change
of time under test. Where the phases are too long for it (kind "long"), Legendre's form of the
undamped motion at s = (1 - exp(-c t))/c instead; every fifth short case is checked against that too.

Inputs are the exact values of the f64 numbers printed (as hexadecimal floats).
"""
import random
import sys

from mpmath import exp, expm1, fdot, mp, mpf, sqrt

from free_body import legendre, norm

mp.dps = 50


def taylor(I, w, c, t, order=56):
    """q(t) from the identity and w(t); t of either sign."""
    q, w = (mpf(0), mpf(0), mpf(0), mpf(1)), list(w)
    left = abs(t)
    way = 1 if t > 0 else -1
    g = [(I[1] - I[2]) / I[0], (I[2] - I[0]) / I[1], (I[0] - I[1]) / I[2]]
    stiff = 1 + max(abs(x) for x in g)
    while left > 0:
        h = min(1 / (4 * (stiff * sqrt(sum(x * x for x in w)) + abs(c))), left)
        W, Q = [[x] for x in w], [[x] for x in q]
        for n in range(order):
            conv = lambda a, b: fdot(a[:n + 1], b[n::-1])
            dw = [g[j] * conv(W[(j + 1) % 3], W[(j + 2) % 3]) - c * W[j][n] for j in range(3)]
            X, Y, Z, S = Q
            dq = [conv(S, W[0]) + conv(Y, W[2]) - conv(Z, W[1]), conv(S, W[1]) + conv(Z, W[0]) - conv(X, W[2]),
                  conv(S, W[2]) + conv(X, W[1]) - conv(Y, W[0]), -conv(X, W[0]) - conv(Y, W[1]) - conv(Z, W[2])]
            for k in range(3):
                W[k].append(dw[k] / (n + 1))
            for k in range(4):
                Q[k].append(dq[k] / 2 / (n + 1))
        at = lambda a: sum(x * (way * h) ** k for k, x in enumerate(a))
        w, q = [at(a) for a in W], norm([at(a) for a in Q])
        left -= h
    return q, tuple(w)


def changed_time(I, w, c, t):
    s = -expm1(-c * t) / c if c else t
    q, w = legendre(I, w, s)
    return q, tuple(x * exp(-c * t) for x in w)


def cases():
    rng = random.Random(20261126)
    u = rng.uniform
    body = lambda: [u(0.5, 3), u(0.5, 3), u(0.5, 3)]
    spin = lambda: [u(-2, 2) for _ in range(3)]
    for k in range(12):
        yield "generic", body(), spin(), 10 ** u(-2, 1), 10 ** u(-1, 1)
    for k in range(4):
        yield "backwards", body(), spin(), u(0.05, 0.5), -u(0.5, 5)
    for k in range(3):
        yield "driven", body(), spin(), -u(0.05, 0.3), u(1, 6)
    for k in range(3):
        yield "undamped", body(), spin(), 0, u(-5, 5)
    for k in range(4):
        yield "barely", body(), spin(), 10 ** u(-300, -8), u(1, 10)
    for k in range(3):
        yield "stopped", body(), spin(), u(1, 5), u(10, 20)
    for k in range(3):
        e = 10 ** u(-10, -3)
        yield "near-intermediate", [1, 2, 3], [e * u(-1, 1), u(1, 3), e * u(-1, 1)], u(0.05, 0.2), u(5, 20)
    for k in range(12):
        c = 10 ** u(-9, -3)
        yield "long", body(), spin(), c, u(0.2, 3) / c * (-1) ** k


def main():
    print("kind,I1,I2,I3,w1,w2,w3,c,t,qx,qy,qz,qw,w1_t,w2_t,w3_t")
    for n, (kind, I, w, c, t) in enumerate(cases()):
        I, w, c, t = [float(x) for x in I], [float(x) for x in w], float(c), float(t)
        exact = [mpf(x) for x in I], [mpf(x) for x in w], mpf(c), mpf(t)
        q, wt = changed_time(*exact) if kind == "long" else taylor(*exact)
        if n % 5 == 0 and kind != "long":
            q2, _ = changed_time(*exact)
            off = min(max(abs(a - s * b) for a, b in zip(q, q2)) for s in (1, -1))
            assert off < mpf(10) ** -38, (kind, off)
            print(f"{kind} c = {c}, t = {t}: the change of time is right to {mp.nstr(off, 2)}", file=sys.stderr)
        print(",".join([kind] + [x.hex() for x in I + w + [c, t]] + [mp.nstr(x, 25) for x in (*q, *wt)]))


if __name__ == "__main__":
    main()
