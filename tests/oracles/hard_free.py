#!/usr/bin/env python3
"""Free bodies that are hard to step (tests/hard_cases), and where they truly are at the end, in 60 digits or more.

    hard_free.py [--check] > hard_free.csv

Each is a body of principal moments I that starts from the identity with the angular velocity w, without a
torque but for a damping at the rate c, and is to be stepped by h until t. Method: Legendre's form (free_body.py),
in 700 digits beside the separatrix; for bodies with two equal moments two turns, for those with three one; on
the separatrix a Taylor integration. `--check` compares every case that is short enough with a Taylor integration.
Damped bodies are the undamped ones at (1 - exp(-c t))/c.

Inputs are the exact values of the f64 numbers printed (as hexadecimal floats).
"""
import sys
from math import nextafter, inf

from mpmath import cos, exp, expm1, mp, mpf, sin, sqrt

from free_body import legendre, quat_mul
from free_damped import taylor as damped_taylor

mp.dps = 60


def ulps(x, n):
    for _ in range(n):
        x = nextafter(x, inf)
    return x


def turn(v):
    """The rotation by a rotation vector."""
    a = sqrt(sum(x * x for x in v))
    s = sin(a / 2) / a if a else mpf(0)
    return (v[0] * s, v[1] * s, v[2] * s, cos(a / 2))


def symmetric(I, w, t):
    """Two equal moments: q = exp(t L/I1) exp(t (1 - I3/I1) w3 e3)."""
    k = next(k for k in range(3) if I[(k + 1) % 3] == I[(k + 2) % 3])
    across = I[(k + 1) % 3]
    slip = [mpf(0)] * 3
    slip[k] = (1 - I[k] / across) * w[k] * t
    q = quat_mul(turn([i * x * t / across for i, x in zip(I, w)]), turn(slip))
    r = quat_mul(quat_mul(turn([-x for x in slip]), (*w, mpf(0))), turn(slip))
    return q, r[:3]


def taylor(I, w, t):
    return damped_taylor(I, w, mpf(0), t)


def motion(I, w, t):
    if len(set(I)) < 3:
        return symmetric(I, w, t)
    if sum(x != 0 for x in w) < 2:
        return turn([x * t for x in w]), w
    lo, mid, hi = sorted(range(3), key=lambda k: I[k])
    if (I[hi] - I[mid]) * I[hi] * w[hi] ** 2 == (I[mid] - I[lo]) * I[lo] * w[lo] ** 2:
        return taylor(I, w, t)
    return legendre(I, w, t)


H, T = 0.01, 10.0
GENERIC = (1.0, 2.0, 2.5)
SPIN = (0.6, 0.64, 0.48)


def cases():
    """name, h, t, I, w, c."""
    w = (1.5, 0.8, -0.6)
    yield "rod-1e-3", H, T, (1e-3, 1, 1.0005), w, 0
    yield "rod-1e-6", H, T, (1e-6, 1, 1 + 5e-7), w, 0
    yield "rod-1e-12", H, T, (1e-12, 1, 1 + 5e-13), w, 0
    yield "needle-1e-12", H, T, (1e-12, 1, 1), w, 0
    yield "ratio-1e12", H, T, (1e12, 1, 1e12), w, 0
    yield "plate", H, T, (1, 2, 3), w, 0
    yield "plate-rounded", H, T, (0.1, 0.2, 0.1 + 0.2), w, 0
    yield "strip", H, T, (1e-6, 1, 1 + 1e-6), w, 0
    yield "sphere", H, T, (1, 1, 1), w, 0
    yield "sphere-1-ulp", H, T, (1, ulps(1.0, 1), ulps(1.0, 2)), w, 0
    yield "sphere-10-ulp", H, T, (1, ulps(1.0, 10), ulps(1.0, 20)), w, 0
    yield "round", H, T, (1, 1, 1.5), w, 0
    yield "round-1-ulp", H, T, (1, ulps(1.0, 1), 1.5), w, 0
    yield "round-10-ulp", H, T, (1, ulps(1.0, 10), 1.5), w, 0

    # (I3 - I2) I3 w3^2 = (I2 - I1) I1 w1^2 in exact numbers.
    flat = (1, 2, 2.25)
    yield "on-separatrix", H, T, flat, (0.75, 1, 1), 0
    yield "separatrix-1-ulp-inside", H, T, flat, (0.75, 1, ulps(1.0, 1)), 0
    yield "separatrix-1-ulp-outside", H, T, flat, (ulps(0.75, 1), 1, 1), 0
    yield "separatrix-1e-300-inside", 0.05, 1500.0, flat, (0, 2, 1e-300), 0
    yield "separatrix-1e-300-outside", 0.05, 1500.0, flat, (1e-300, 2, 0), 0
    yield "middle-axis-1e-9", H, 60.0, flat, (1e-9, 2, 1e-9), 0

    for wh, n in ((1e-12, 1000), (1e-8, 1000), (1e-4, 1000), (1e-2, 1000), (0.1, 1000), (1.0, 1000), (10.0, 100),
                  (100.0, 30), (1e4, 3)):
        yield f"spin-{wh:g}", H, n * H, GENERIC, tuple(x * wh / H for x in SPIN), 0
    yield "still", H, T, GENERIC, (0, 0, 0), 0
    yield "denormal", H, T, GENERIC, (5e-324, 1e-310, -3e-320), 0

    for name, m in (("mass-1e-30", 1e-30), ("mass-1e30", 1e30)):
        yield name, H, T, tuple(i * m for i in GENERIC), w, 0
    yield "nanometre", 1e-9, 1e-6, (1e-42, 2e-42, 2.5e-42), tuple(1e7 * x for x in w), 0
    yield "planet", 100.0, 1e5, (8.00e37, 8.01e37, 8.03e37), (1e-6, -2e-6, 7.292e-5), 0
    yield "moments-1e-149", H, T, tuple(i * 1e-149 for i in GENERIC), w, 0
    yield "moments-1e149", H, T, tuple(i * 1e149 for i in GENERIC), w, 0
    # 1 kg, I = (1, 2, 2.5), held a kilometre from its centre of mass.
    yield "pivot-kilometre", H, T, (1.0 + 1e6, 2.0, 2.5 + 1e6), (0.3, 0.5, -0.4), 0

    for ch in (0.0, 1e-3, 0.1, 1.0, 3.0, 1e3, 1e6):
        yield f"damping-{ch:g}", H, T, GENERIC, w, ch / H

    # What is run towards 1e9 steps, and where the closed form must be then.
    for n in (1e3, 1e4, 1e5, 1e9):
        yield f"steps-{n:.0e}".replace("e+0", "e"), H, n * H, GENERIC, w, 0
    yield "seconds-1e9", 1e6, 1e9, GENERIC, w, 0


def main():
    print("name,h,t,I1,I2,I3,w1,w2,w3,c,qx,qy,qz,qw,w1_t,w2_t,w3_t")
    for name, h, t, I, w, c in cases():
        numbers = [float(x) for x in (h, t, *I, *w, c)]
        h, t, c = (mpf(numbers[k]) for k in (0, 1, 8))
        I, w = [mpf(x) for x in numbers[2:5]], [mpf(x) for x in numbers[5:8]]
        with mp.workdps(700 if "1e-300" in name or name == "denormal" else mp.dps):
            s, left = (-expm1(-c * t) / c, exp(-c * t)) if c else (t, mpf(1))
            q, wt = motion(I, w, s)
        size = sqrt(sum(x * x for x in w))
        if "--check" in sys.argv and s * size < 30 and 0 < size and name != "denormal":
            q2, _ = taylor(I, w, s)
            off = min(max(abs(a - b * sign) for a, b in zip(q, q2)) for sign in (1, -1))
            assert off < mpf(10) ** -38, (name, off)
            print(f"{name}: two oracles agree to {mp.nstr(off, 2)}", file=sys.stderr)
        print(",".join([name] + [x.hex() for x in numbers] + [mp.nstr(x, 25) for x in (*q, *(x * left for x in wt))]))


if __name__ == "__main__":
    main()
