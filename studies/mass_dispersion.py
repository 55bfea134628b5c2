#!/usr/bin/python3
"""What the mass of incompatible hexahedra (docs/theory, section 1.1) makes of the speed of plane waves:

    studies/mass_dispersion.py

On an infinite lattice of cubes of the size h a wave of the number k has the squared frequency omega^2 (1 + c k^2 h^2 / 12). Prints c of both
transverse waves and of the longitudinal one by direction, then that of the bending wave of a strip one cell thick, for the masses compatible
and condensed and for both with half of the difference of their row sums from the nodes' own mass added.
"""
import itertools

import numpy as np
from scipy.linalg import eigh

NU = 0.3
KH = 0.05
CORNERS = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]], float)


def shape(xi):
    return np.prod(1 + CORNERS * xi, axis=1) / 8


def shape_derivatives(xi):
    f = 1 + CORNERS * xi
    return np.array([CORNERS[:, i] * f[:, i - 1] * f[:, i - 2] / 8 for i in range(3)])


def strains(gradients):
    B = np.zeros((6, 3 * gradients.shape[1]))
    for a, (x, y, z) in enumerate(gradients.T):
        B[:, 3 * a : 3 * a + 3] = [[x, 0, 0], [0, y, 0], [0, 0, z], [y, x, 0], [0, z, y], [z, 0, x]]
    return B


def element(h, nu):
    """Stiffness and the masses by name of a box of the edges h, E = rho = 1."""
    lame, shear = nu / ((1 + nu) * (1 - 2 * nu)), 1 / (2 * (1 + nu))
    H = np.diag([2 * shear] * 3 + [shear] * 3)
    H[:3, :3] += lame
    det = np.prod(h) / 8
    K, M = np.zeros((33, 33)), np.zeros((11, 11))
    for point in itertools.product((-(3**-0.5), 3**-0.5), repeat=3):
        B = strains(np.hstack([shape_derivatives(np.array(point)), np.diag(-2 * np.array(point))]) / (h / 2)[:, None])
        K += det * B.T @ H @ B
    x, w = np.polynomial.legendre.leggauss(3)
    for i, j, k in itertools.product(range(3), repeat=3):
        point = x[[i, j, k]]
        f = np.r_[shape(point), 1 - point**2]
        M += det * w[i] * w[j] * w[k] * np.outer(f, f)
    T = -np.linalg.solve(K[24:, 24:], K[24:, :24])
    all_of_nodes = np.vstack([np.eye(24), T])
    compatible = np.kron(M[:8, :8], np.eye(3))
    condensed = all_of_nodes.T @ np.kron(M, np.eye(3)) @ all_of_nodes
    half = np.kron(np.diag(M[:8, :8].sum(axis=1)) - M[:8, :8], np.eye(3)) / 2
    stiffness = K[:24, :24] + K[:24, 24:] @ T
    return stiffness, {"compatible": compatible, "condensed": condensed, "compatible + half": compatible + half, "condensed + half": condensed + half}


def plane_wave(K, M, h, direction):
    direction = np.array(direction) / np.linalg.norm(direction)
    phases = np.kron(np.exp(1j * KH / h.max() * (CORNERS * h / 2) @ direction)[:, None], np.eye(3))
    squared = eigh(phases.conj().T @ K @ phases, phases.conj().T @ M @ phases, eigvals_only=True)
    shear = 1 / (2 * (1 + NU))
    exact = np.array([shear, shear, NU / ((1 + NU) * (1 - 2 * NU)) + 2 * shear]) * (KH / h.max()) ** 2
    return 12 / KH**2 * (squared / exact - 1)


def bending_wave(K, M, h):
    """Of a strip along x that is thin along z, without lateral contraction."""
    kh = 0.2
    P = np.zeros((24, 12), complex)
    for a, corner in enumerate(CORNERS):
        b = 2 * int(corner[1] > 0) + int(corner[2] > 0)
        P[3 * a : 3 * a + 3, 3 * b : 3 * b + 3] = np.exp(0.5j * kh * corner[0]) * np.eye(3)
    lowest = eigh(P.conj().T @ K @ P, P.conj().T @ M @ P, eigvals_only=True)[0]
    return 12 / kh**2 * (lowest / ((kh / h[0]) ** 4 * h[2] ** 2 / 12) - 1)


def main():
    cube, strip = np.ones(3), np.array([1, 0.05, 0.01])
    K, masses = element(cube, NU)
    K_strip, masses_strip = element(strip, 0)
    print("| mass | " + " | ".join(map(str, ("[1 0 0]", "[1 1 0]", "[1 1 1]", "[2 1 0]", "bending"))) + " |")
    for name, M in masses.items():
        waves = [plane_wave(K, M, cube, direction) for direction in ([1, 0, 0], [1, 1, 0], [1, 1, 1], [2, 1, 0])]
        print(f"| {name} | " + " | ".join(", ".join(f"{c:+.2f}" for c in wave) for wave in waves) + f" | {bending_wave(K_strip, masses_strip[name], strip):+.2f} |")


if __name__ == "__main__":
    main()
