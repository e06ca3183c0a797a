#!/usr/bin/env python3
"""Reference attitudes of the free rigid body in 60 digits, for tests of the closed form.

    free_body.py > free_body.csv

Method: Legendre's form (Jacobi's elliptic functions and the incomplete integral of the third kind),
which shares nothing with the theta series under test. Every tenth case short enough is checked here
against a Taylor integration of the equations of motion in 60 digits as well.

Inputs are the exact values of the f64 numbers printed (as hexadecimal floats).
"""
import random
import sys

from mpmath import mp, mpf, atan2, ellipf, ellipfun, ellipk, ellippi, cos, floor, matrix, sin, sqrt, asin, pi

mp.dps = 60


def quat_mul(p, q):
    (a, b, c, d), (e, f, g, h) = p, q  # x, y, z, w
    return (d * e + a * h + b * g - c * f, d * f - a * g + b * h + c * e, d * g + a * f - b * e + c * h,
            d * h - a * e - b * f - c * g)


def conj(q):
    return (-q[0], -q[1], -q[2], q[3])


def norm(q):
    n = sqrt(sum(x * x for x in q))
    return tuple(x / n for x in q)


def legendre(I, w, t):
    """q(t) from the identity, principal axes -> world, and omega(t) in principal axes."""
    order = sorted(range(3), key=lambda k: I[k])
    lo, mid, hi = order
    e2 = (I[hi] - I[mid]) * I[hi] * w[hi] ** 2 - (I[mid] - I[lo]) * I[lo] * w[lo] ** 2
    if e2 == 0:
        raise ValueError("separatrix")
    if e2 < 0:
        order = [hi, mid, lo]
    s = -1 if e2 < 0 else 1
    # New axes: row k of P picks old axis order[k] with a sign; det P = 1.
    signs = [1 if w[order[0]] >= 0 else -1, 1, 1 if w[order[2]] >= 0 else -1]
    parity = 1 if order in ([0, 1, 2], [1, 2, 0], [2, 0, 1]) else -1
    signs[1] = parity * signs[0] * signs[2]
    J = [I[k] for k in order]
    m = [signs[k] * I[order[k]] * w[order[k]] for k in range(3)]
    a = [1 / j for j in J]
    A, B, C = abs(a[0] - a[1]), abs(a[1] - a[2]), abs(a[0] - a[2])
    D1, D3 = C * m[0] ** 2 + B * m[1] ** 2, A * m[1] ** 2 + C * m[2] ** 2
    G = sqrt(sum(x * x for x in m))
    lam = sqrt(B * D3)
    kk = A * D1 / (B * D3)
    # sn u0 = sigma m2/sqrt(D1/B), cn u0 = m1/sqrt(D1/C) >= 0
    am0 = atan2(s * m[1] / sqrt(D1 / B), m[0] / sqrt(D1 / C))
    u0 = ellipf(am0, kk)
    K = ellipk(kk)
    n_char = -A / B

    def at(tt):
        u = lam * tt + u0
        n = floor((u + K) / (2 * K))
        ur = u - 2 * K * n
        sn, cn, dn = (ellipfun(f, ur, m=kk) for f in ("sn", "cn", "dn"))
        amr = atan2(sn, cn)
        odd = int(n) % 2
        flip = -1 if odd else 1
        mm = (sqrt(D1 / C) * cn * flip, s * sqrt(D1 / B) * sn * flip, sqrt(D3 / C) * dn)
        phi = G * a[2] * tt + s * (G * C / lam) * (2 * n * ellippi(n_char, pi / 2, kk) + ellippi(n_char, amr, kk))
        psi = atan2(mm[0], mm[1])
        theta = mp.acos(mm[2] / G)
        c, d = cos(theta / 2), sin(theta / 2)
        w_, z_ = c * cos((phi + psi) / 2), c * sin((phi + psi) / 2)
        x_, y_ = d * cos((phi - psi) / 2), d * sin((phi - psi) / 2)
        return (x_, y_, z_, w_), mm

    q0, _ = at(mpf(0))
    qt, mt = at(t)
    rel = quat_mul(conj(q0), qt)  # new axes at t -> new axes at 0
    # Back to the old axes: v_old = P^T v_new; conjugation by the rotation P.
    P = matrix(3, 3)
    for k in range(3):
        P[k, order[k]] = signs[k]
    x, y, z = (P.T * matrix([rel[0], rel[1], rel[2]]))
    wt = P.T * matrix([mt[k] / J[k] for k in range(3)])
    return (x, y, z, rel[3]), tuple(wt)


def taylor(I, w, t, order=60):
    """The same by Taylor series of dw = I^-1 (I w x w), dq = q (w, 0)/2."""
    q, w = (mpf(0), mpf(0), mpf(0), mpf(1)), list(w)
    left = mpf(t)
    size = sqrt(sum(x * x for x in w)) + mpf(10) ** -40
    h0 = mpf(1) / (4 * size)
    g = [(I[1] - I[2]) / I[0], (I[2] - I[0]) / I[1], (I[0] - I[1]) / I[2]]
    while left > 0:
        h = min(h0, left)
        W = [[x] for x in w]
        Q = [[x] for x in q]
        for n in range(order):
            conv = lambda a, b: sum(a[k] * b[n - k] for k in range(n + 1))
            dw = [g[0] * conv(W[1], W[2]), g[1] * conv(W[2], W[0]), g[2] * conv(W[0], W[1])]
            X, Y, Z, S = Q
            dq = [conv(S, W[0]) + conv(Y, W[2]) - conv(Z, W[1]), conv(S, W[1]) + conv(Z, W[0]) - conv(X, W[2]),
                  conv(S, W[2]) + conv(X, W[1]) - conv(Y, W[0]), -conv(X, W[0]) - conv(Y, W[1]) - conv(Z, W[2])]
            for k in range(3):
                W[k].append(dw[k] / (n + 1))
            for k in range(4):
                Q[k].append(dq[k] / 2 / (n + 1))
        ev = lambda c: sum(x * h ** k for k, x in enumerate(c))
        w, q = [ev(c) for c in W], norm([ev(c) for c in Q])
        left -= h
    return q, tuple(w)


def cases():
    rng = random.Random(20261124)
    u = rng.uniform
    for k in range(30):
        yield "generic", [u(0.3, 3), u(0.3, 3), u(0.3, 3)], [u(-3, 3) for _ in range(3)], 10 ** u(-2, 2)
    for k in range(12):
        yield "long", [u(0.3, 3), u(0.3, 3), u(0.3, 3)], [u(-3, 3) for _ in range(3)], 10 ** u(4, 9)
    for k in range(6):
        yield "negative", [u(0.3, 3), u(0.3, 3), u(0.3, 3)], [u(-3, 3) for _ in range(3)], -(10 ** u(-1, 5))
    for k in range(12):
        j = u(0.5, 2)
        yield "near-equal", [j, j * (1 + 10 ** u(-16, -2)), u(0.5, 2)], [u(-3, 3) for _ in range(3)], 10 ** u(0, 4)
    for k in range(10):
        e = 10 ** u(-14, -2)
        yield "near-intermediate", [1, 2, 3], [e * u(-1, 1), u(1, 3), e * u(-1, 1)], 10 ** u(0, 2)
    for k in range(8):
        w3 = u(0.5, 2)
        w1 = w3 * 3 ** 0.5 * (1 + u(-1, 1) * 10 ** u(-15, -3))  # (I3-I2)I3 w3^2 = (I2-I1)I1 w1^2 for 1, 2, 3
        yield "near-separatrix", [1, 2, 3], [w1, u(-2, 2), w3], 10 ** u(0, 2)
    for k in range(8):
        e = 10 ** u(-12, -1)
        yield "near-axis", [u(0.5, 1), u(1.1, 2), u(2.1, 3)], [e * u(-1, 1), e * u(-1, 1), u(1, 4)], 10 ** u(0, 4)
    for k in range(8):
        e = 10 ** u(-8, -1)
        yield "rod", [e, 1, 1 + e * u(0.1, 0.9)], [u(-3, 3) for _ in range(3)], 10 ** u(-1, 2)
    for k in range(8):
        s, v = 10 ** u(-40, 40), 10 ** u(-6, 6)
        yield "scaled", [s * u(1, 2), s * u(1, 2), s * u(1, 2)], [v * u(-1, 1) for _ in range(3)], 10 ** u(0, 3) / v
    for k in range(8):
        # Beside the middle axis by 1e-140 to 1e-300: it flips once lambda t passes 300 to 700.
        e, f = 10 ** u(-300, -140), 10 ** u(-300, -140)
        yield "beside-separatrix", [1, u(1.5, 2.5), 3], [e * (-1) ** k, u(1, 2), f], 10 ** u(2.7, 4) * (-1) ** (k // 2)


def main():
    print("kind,I1,I2,I3,w1,w2,w3,t,qx,qy,qz,qw,w1_t,w2_t,w3_t")
    for n, (kind, I, w, t) in enumerate(cases()):
        I, w, t = [float(x) for x in I], [float(x) for x in w], float(t)
        with mp.workdps(700 if kind == "beside-separatrix" else mp.dps):
            q, wt = legendre([mpf(x) for x in I], [mpf(x) for x in w], mpf(t))
        if n % 10 == 0 and 0 < t < 50 and kind != "scaled":
            q2, w2 = taylor([mpf(x) for x in I], [mpf(x) for x in w], t)
            off = min(max(abs(a - s * b) for a, b in zip(q, q2)) for s in (1, -1))
            assert off < mpf(10) ** -45, (kind, off)
            print(f"{kind} {t}: two oracles agree to {mp.nstr(off, 2)}", file=sys.stderr)
        print(",".join([kind] + [x.hex() for x in I + w + [t]] + [mp.nstr(x, 25) for x in (*q, *wt)]))


if __name__ == "__main__":
    main()
