#!/usr/bin/python3
"""Hertz's line contact of dissimilar half-planes with friction: largest pressure over H. Hertz's, and the part that sticks.

    studies/half_planes.py --beta 0.142857 --friction 0.1

beta is Dundurs' constant. A parabola of unit curvature is pressed into the plane, in equal steps of the half width; tractions
are constant over CELLS cells, E* and Hertz's half width are 1. K. L. Johnson, Contact Mechanics, (2.25): with the pressure p and the traction q on
the more compliant body, outward > 0,

    u_z = -2 / (pi E*) [int p ln|x - s| ds - pi beta int_0^x q ds],
    u_x = -2 / (pi E*) [int q ln|x - s| ds + pi beta int_0^x p ds],

|q| <= mu p, and u_x stays what it was where a cell sticks.
"""
import argparse

import numpy as np

CELLS = 115  # of which 100 are in contact without friction
SPAN = 1.15  # half widths of Hertz


def dundurs(E_1, E_2, nu):
    """beta of plane strain, > 0 where body 2 is the more compliant one; one Poisson's ratio."""
    return 0.5 * (1 - 2 * nu) / (1 - nu) * (E_1 - E_2) / (E_1 + E_2)


def influence(beta):
    """u_z of p, u_z of q, u_x of q and u_x of p at the middles x of the cells; p is even, q odd. E* = 1."""
    h = SPAN / CELLS
    x = (np.arange(CELLS) + 0.5) * h

    def log_integral(d):
        def primitive(t):
            return t * np.log(np.abs(t)) - t
        return primitive(d + h / 2) - primitive(d - h / 2)
    same, mirrored = log_integral(x[:, None] - x), log_integral(x[:, None] + x)
    to_x = h * (np.tril(np.ones((CELLS, CELLS)), -1) + np.eye(CELLS) / 2)
    k = -2 / np.pi
    return x, h, k * (same + mirrored), -k * np.pi * beta * to_x, k * (same - mirrored), k * np.pi * beta * to_x


def pressures(zz, gap, force, touched, h):
    """p >= 0 with the given force (on both halves) that leaves no negative gap; `gap` is that of p = 0."""
    for _ in range(CELLS):
        i = np.flatnonzero(touched)
        A = np.zeros((len(i) + 1, len(i) + 1))
        A[:-1, :-1], A[:-1, -1], A[-1, :-1] = zz[np.ix_(i, i)], -1, 2 * h
        solution = np.linalg.solve(A, np.r_[-gap[i], force])
        p = np.zeros(CELLS)
        p[i] = solution[:-1]
        left = gap + zz @ p - solution[-1]
        now = np.where(touched, p > 0, left < -1e-14)
        if (now == touched).all():
            return p, touched
        touched = now
    raise RuntimeError("no set of touched cells was found")


def tractions(xx, way, limit, touched):
    """q, and which cells stick; `way` is the change of u_x in this step without q."""
    sliding, sign = np.zeros(CELLS, bool), np.zeros(CELLS)
    for _ in range(CELLS):
        i = np.flatnonzero(touched & ~sliding)
        q = np.where(sliding, limit * sign, 0)
        q[i] = np.linalg.solve(xx[np.ix_(i, i)], (-way - xx @ q)[i])
        over = touched & ~sliding & (np.abs(q) > limit * (1 + 1e-12))
        sign[over] = np.sign(q[over])
        back = sliding & ((way + xx @ q) * sign > 1e-13)
        if not over.any() and not back.any():
            return q, touched & ~sliding
        sliding = (sliding | over) & ~back
    raise RuntimeError("no set of sticking cells was found")


def press(beta, mu, stiffness=np.inf, steps=100):
    """Largest pressure over Hertz's, and the half width that sticks over Hertz's; a penalty between the bodies has the stiffness."""
    x, h, zz, zq, xx, xp = influence(beta)
    zz = zz + np.eye(CELLS) / stiffness
    p, q, u_x, stick = np.zeros(CELLS), np.zeros(CELLS), np.zeros(CELLS), np.zeros(CELLS, bool)
    for step in range(1, steps + 1):
        touched = x < step / steps
        for _ in range(60):
            before = p
            p, touched = pressures(zz, x**2 / 2 + zq @ q, np.pi / 4 * (step / steps)**2, touched, h)
            q, stick = tractions(xx, xp @ p - u_x, mu * p, touched)
            if np.abs(p - before).max() < 1e-12 * p.max():
                break
        u_x = xx @ q + xp @ p
    return (9 * p[0] - p[1]) / 8 / 0.5, np.sum(stick) * h


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--beta", type=float, required=True)
    parser.add_argument("--friction", type=float, nargs="+", required=True)
    parser.add_argument("--stiffness", type=float, default=np.inf, help="of a penalty between the bodies, E* over the half width")
    options = parser.parse_args()
    for mu in options.friction:
        pressure, stick = press(options.beta, mu, options.stiffness)
        print(f"friction {mu:g}: pressure {100 * (pressure - 1):+.2f} % of Hertz's, {100 * stick:.0f} % of his half width sticks")


if __name__ == "__main__":
    main()
