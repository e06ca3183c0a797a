#!/usr/bin/env python3
"""Digits of the functions in src/math, by mpmath in 60 digits.

    special.py > special.csv

Columns: function, up to four arguments (exact f64 values, shortest form), the value as an f64 and
the rest as an f64, so that a double-double can be compared. Functions dd_* take two double-doubles,
each as an f64 and the rest; k'^2 = 1 - k^2 is the argument of K, sn, cn, dn.
"""
import random

from mpmath import (agm, ellipfun, ellipk, ellippi, elliprc, elliprd, elliprf, elliprj, exp, expm1, mp, mpf,
                    sech, sin, sqrt, tanh)

mp.dps = 60
rng = random.Random(20261125)
u = rng.uniform


def row(name, arguments, value):
    hi = float(value)
    lo = float(value - mpf(hi)) if abs(hi) < 1e300 else 0.0
    fields = [repr(float(x)) for x in arguments] + [""] * (4 - len(arguments))
    print(",".join([name] + fields + [repr(hi), repr(lo)]))


def wide(span):
    return 10 ** u(-span, span)


def real(name, function, arguments):
    row(name, arguments, mp.re(function(*[mpf(x) for x in arguments])))


def carlson():
    for k in range(40):
        x, y, z, p = [wide(1 if k < 20 else 8) for _ in range(4)]
        if k % 5 == 0:
            x = 0.0
        if k % 7 == 0:
            p = z * 10 ** u(-12, -6)
        real("rf", elliprf, [x, y, z])
        real("rc", elliprc, [x, y])
        real("rd", elliprd, [x, y, z])
        real("rj", elliprj, [x, y, z, p])
    for k in range(20):
        x, y = wide(2), wide(2)
        real("rc", elliprc, [x, -y])
        near = 1 + (-1) ** k * 10 ** u(-15, -1)
        real("rc", elliprc, [x, x * near])
        real("rj_principal", elliprj, [x, y, wide(1), -wide(1)])


def jacobi():
    for k in range(60):
        kc2 = [u(0, 1), 10 ** u(-16, 0), 10 ** u(-300, -16), 1 - 10 ** u(-15, -1), 1.0, 0.0][k % 6]
        t = u(-40, 40) if k % 4 == 0 else u(-4, 4)
        if k % 10 == 9:
            t = 10 ** u(-20, -3)
        # k^2 = 1 - k'^2 takes as many digits as k'^2 is small.
        with mp.workdps(360 if 0 < kc2 < 1e-50 else 80):
            m = 1 - mpf(kc2)
            if kc2 == 0:
                values = dict(sn=tanh(mpf(t)), cn=sech(mpf(t)), dn=sech(mpf(t)))
            else:
                values = {f: ellipfun(f, mpf(t), m=m) for f in ("sn", "cn", "dn")}
                row("k", [kc2], ellipk(m))
            for f in values:
                row(f, [t, kc2], values[f])
    for k in range(30):
        n = [u(-3, 0.9), -wide(6), 1 - 10 ** u(-6, 0)][k % 3]
        phi, k2 = u(0.01, 1.57), u(0, 1)
        row("pi", [n, phi, k2], ellippi(mpf(n), mpf(phi), mpf(k2)))


def double_double():
    def number():
        hi = u(-3, 3) * 10 ** rng.randint(-8, 8)
        lo = hi * u(-1, 1) * 2.0 ** -54
        return (hi, lo), mpf(hi) + mpf(lo)

    for k in range(40):
        (a, x), (b, y) = number(), number()
        if k % 4 == 0:  # nearly equal: a difference that cancels
            (b, y) = ((a[0], -a[1] * 0.37), mpf(a[0]) - mpf(a[1] * 0.37))
        row("dd_add", a + b, x + y)
        row("dd_sub", a + b, x - y)
        row("dd_mul", a + b, x * y)
        row("dd_div", a + b, x / y)
        row("dd_sqrt", (abs(a[0]), abs(a[1])), sqrt(mpf(abs(a[0])) + mpf(abs(a[1]))))
    for k in range(40):
        hi = u(-1, 1) * 10 ** u(-12, 2.8)
        lo = hi * u(-1, 1) * 2.0 ** -54
        x = mpf(hi) + mpf(lo)
        row("dd_expm1", (hi, lo), expm1(x))
        if abs(hi) < 600:
            row("dd_exp", (hi, lo), exp(x))
        row("dd_sin", (hi, lo), sin(x))


def means():
    for k in range(30):
        x, y = wide(3 if k < 15 else 150), wide(3)
        row("agm", [x, y], agm(mpf(x), mpf(y)))
    row("agm", [1.0, 1.0], mpf(1))


print("function,x1,x2,x3,x4,hi,lo")
carlson()
jacobi()
double_double()
means()
