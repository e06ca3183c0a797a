#!/usr/bin/env python3
"""Reference attitudes of a heavy asymmetric top in 50 digits, for tests of the methods.

    asymmetric_top.py > asymmetric_top.csv

Method: a Taylor series of order 60 of the equations of motion in principal axes, by the product rule,
in steps of 1/10 s; run a second time in steps of 1/15 s, and the two must agree to 1e-40. Energy, the
momentum about the vertical and |q| must stay to 1e-40 as well.

    q' = 1/2 q (omega, 0)    I omega' = (I omega) x omega + u x rho    u = R^T e_z

I = (1, 1.6, 2.1) about the pivot, rho = (0.3, 0.2, 1) (weight times lever), gravity along -z. The
inputs are these decimals, not the f64 numbers nearest to them: at t = 100 the difference is some 1e-15.
"""
from mpmath import fdot, mp, mpf, sqrt

mp.dps = 60
I = [mpf(1), mpf("1.6"), mpf("2.1")]
RHO = [mpf("0.3"), mpf("0.2"), mpf(1)]
Q0 = [mpf("0.1"), mpf("0.3"), mpf("-0.2"), sqrt(mpf("0.86"))]
W0 = [mpf("0.5"), mpf("-0.8"), mpf(2)]
ORDER = 60


def vertical(q):
    """R^T e_z."""
    x, y, z, w = q
    return [2 * (x * z - w * y), 2 * (y * z + w * x), w * w + z * z - x * x - y * y]


def step(q, w, h):
    """Coefficients of q, omega and u, each from those before it; then the sums at h."""
    q = [[c] for c in q]
    w = [[c] for c in w]
    u = [[c] for c in vertical([c[0] for c in q])]
    cauchy = lambda a, b, n: fdot(zip(a, reversed(b[:n + 1])))
    for n in range(ORDER):
        x, y, z, s = q
        rates = [
            cauchy(s, w[0], n) + cauchy(y, w[2], n) - cauchy(z, w[1], n),
            cauchy(s, w[1], n) + cauchy(z, w[0], n) - cauchy(x, w[2], n),
            cauchy(s, w[2], n) + cauchy(x, w[1], n) - cauchy(y, w[0], n),
            -cauchy(x, w[0], n) - cauchy(y, w[1], n) - cauchy(z, w[2], n),
        ]
        turns, heights = [], []
        for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            torque = u[j][n] * RHO[k] - u[k][n] * RHO[j]
            turns.append(((I[j] - I[k]) * cauchy(w[j], w[k], n) + torque) / I[i])
            heights.append(cauchy(u[j], w[k], n) - cauchy(u[k], w[j], n))
        for c, rate in zip(q, rates):
            c.append(rate / 2 / (n + 1))
        for c, rate in zip(w, turns):
            c.append(rate / (n + 1))
        for c, rate in zip(u, heights):
            c.append(rate / (n + 1))
    at = lambda c: sum(x * h**n for n, x in enumerate(c))
    return [at(c) for c in q], [at(c) for c in w]


def constants(q, w):
    u = vertical(q)
    energy = sum(i * x * x for i, x in zip(I, w)) / 2 + sum(a * b for a, b in zip(RHO, u))
    return energy, sum(i * x * a for i, x, a in zip(I, w, u)), sum(c * c for c in q)


def run(t, n):
    q, w = Q0, W0
    for _ in range(n):
        q, w = step(q, w, mpf(t) / n)
    for before, after in zip(constants(Q0, W0), constants(q, w)):
        assert abs(before - after) < mpf(10) ** -40
    return q, w


if __name__ == "__main__":
    print("t,qx,qy,qz,qw,wx,wy,wz")
    for t in (10, 100):
        one, two = run(t, 10 * t), run(t, 15 * t)
        for a, b in zip(one[0] + one[1], two[0] + two[1]):
            assert abs(a - b) < mpf(10) ** -38, a - b
        print(f"{t}," + ",".join(mp.nstr(c, 40) for c in two[0] + two[1]))
