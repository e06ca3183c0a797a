#!/usr/bin/env python3
"""Coefficients of src/math/turns.rs, and digits to test it by, from mpmath.

    python3 tests/oracles/turns.py

Chebyshev interpolants in 50 digits; prints them with what they are off by, and writes turns.csv: x, sin 2πx
and cos 2πx for x in turns, and e^{-x}, each as an f64 and the rest.
"""
import random
from pathlib import Path

from mpmath import chebyfit, cos, exp, log, mp, mpf, nstr, pi, sin, sqrt

mp.dps = 50


def polynomials():
    z = mpf(1) / 64
    small = mpf(10) ** -20
    fits = {
        # Of the sine the error is times z and by 2π, of the cosine times z².
        "SINE": (lambda x: (sin(2 * pi * sqrt(x)) / sqrt(x) - 2 * pi) / x if x > small else -((2 * pi) ** 3) / 6,
                 [0, z], 6, z / (2 * pi)),
        "COSINE": (lambda x: ((cos(2 * pi * sqrt(x)) - 1) / x + 2 * pi**2) / x if x > small else (2 * pi) ** 4 / 24,
                   [0, z], 6, z**2),
        "FALL": (lambda x: (exp(-x) - 1 + x) / x**2 if abs(x) > mpf(10) ** -15 else mpf(1) / 2 - x / 6,
                 [-log(2) / 2 * 1.001, log(2) / 2 * 1.001], 10, (log(2) / 2) ** 2),
    }
    for name, (function, interval, terms, size) in fits.items():
        coefficients, error = chebyfit(function, interval, terms, error=True)
        print(name, "off by", nstr(error * size, 3))
        for c in reversed(coefficients):
            print("   ", repr(float(c)))


def parts(value):
    high = float(value)
    return [repr(high), repr(float(value - mpf(high)))]


def digits():
    draw = random.Random(20261124)
    turns = [draw.uniform(-0.5, 0.5) for _ in range(400)] + [draw.uniform(-1e6, 1e6) for _ in range(50)]
    turns += [k / 8 + d for k in range(-6, 7) for d in (0.0, 1e-3, -1e-9)] + [1e-300, 3e-9]
    falls = [draw.uniform(0.0, 3.0) for _ in range(200)] + [draw.uniform(0.0, 708.0) for _ in range(200)] + [0.0, 1e-20]
    rows = ["function,x,hi,lo"]
    for x in turns:
        angle = 2 * pi * mpf(x)
        for name, value in (("sin", sin(angle)), ("cos", cos(angle))):
            # Whole quarters exactly, which π in 50 digits does not give.
            value = mpf(round(value)) if (4 * x).is_integer() else value
            rows.append(",".join([name, repr(x), *parts(value)]))
    for x in falls:
        rows.append(",".join(["exp", repr(x), *parts(exp(-mpf(x)))]))
    Path(__file__).with_suffix(".csv").write_text("\n".join(rows) + "\n")


polynomials()
digits()
