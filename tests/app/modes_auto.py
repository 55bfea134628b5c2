#!/usr/bin/python3
"""The modes that `modes: auto` takes for loads that rise in a stated time (docs/theory, Eq. (6.20b)):

    tests/app/modes_auto.py ELASTOGEAR MESHES

A clamped bar under a force on each node of its upper face, which rises as half a cosine: displacements there in closed form, by all
modes of the mesh, and by those of `auto` with the static response of the others. They may differ by mode_error of that response, and do
where modes are left out that `auto` takes.
"""
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

ELASTOGEAR, MESHES = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
RISE_TIME, MODE_ERROR, ALL_MODES = 1e-4, 0.05, 540  # s; -
OMEGA = np.pi / RISE_TIME
TIMES = np.linspace(0, 5 * RISE_TIME, 2001)
SINGLE = 1e-6  # of the static response, which is stored in single precision


def reduce(*modes):
    """Eigenfrequencies in rad/s, modal displacements (directions at nodes x modes), static response of each direction to its own force."""
    arguments = ["-mesh", os.path.join(MESHES, "bar.inp"), "-material_E", "2e11", "-material_nu", "0.3", "-material_rho", "7850", "-restrain", "FIX",
                 "-surface", "TOP", "-basis", "modal_residual", "-output", "bar.h5"]
    subprocess.run([ELASTOGEAR, "reduce", *arguments, *modes], check=True, stdout=subprocess.DEVNULL)
    with h5py.File("bar.h5") as file:
        Phi = file["surface/Phi"][:]
        return np.sqrt(file["modes/eigenvalue"][:]), Phi.reshape(-1, Phi.shape[2]), np.diag(file["flexibility/F"][:]).astype(float)


def load():
    return np.where(TIMES < RISE_TIME, (1 - np.cos(OMEGA * TIMES)) / 2, 1)


def amplitudes(omega):
    """Of undamped modes under that load, each over its static response (modes x times)."""
    ratio = OMEGA**2 / (omega[:, None]**2 - OMEGA**2)
    rising = load() + ratio / 2 * (np.cos(omega[:, None] * TIMES) - np.cos(OMEGA * TIMES))
    after = 1 + ratio / 2 * (np.cos(omega[:, None] * TIMES) + np.cos(omega[:, None] * (TIMES - RISE_TIME)))
    return np.where(TIMES < RISE_TIME, rising, after)


def error(omega, Phi, F, exact):
    """Largest difference from the exact displacement, over what may be."""
    shares = Phi**2 / omega**2
    R = np.maximum(F - shares.sum(axis=1), 0)
    x = shares @ amplitudes(omega) + R[:, None] * load()
    loaded = F > 0
    return (abs(x - exact).max(axis=1)[loaded] / (MODE_ERROR * R + SINGLE * F)[loaded]).max()


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        omega, Phi, F = reduce("-modes", "auto", "-rise_time", str(RISE_TIME), "-mode_error", str(MODE_ERROR))
        all_omega, all_Phi, _ = reduce("-modes", str(ALL_MODES))
    highest = OMEGA * np.sqrt(1 + 1 / MODE_ERROR)
    n = np.count_nonzero(all_omega < highest)
    exact = (all_Phi**2 / all_omega**2) @ amplitudes(all_omega)
    with_auto, with_half = error(omega, Phi, F, exact), error(omega[:n // 2], Phi[:, :n // 2], F, exact)
    print(f"{len(omega)} of {len(all_omega)} modes; error {with_auto:.3f} of what may be, with half as many modes {with_half:.2f}")
    assert len(all_omega) == ALL_MODES and len(omega) == n, n
    assert 0.1 < with_auto <= 1 < with_half


if __name__ == "__main__":
    main()
