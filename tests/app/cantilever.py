#!/usr/bin/python3
"""A slender cantilever that creeps under a force at its end and relaxes while its end is held, from mesh to result:

    tests/app/cantilever.py ELASTOGEAR SCRIPTS

Beside the beam of S. Timoshenko by the correspondence principle: E and G of the elastic deflection become those of the Laplace
transform. With one series for shear and bulk both creep by it; where shear alone relaxes, bending does by 1/E = 1/(9 K) + 1/(3 G) and
shear by 1/G. Cross-sections are free to bulge, at the clamp, too, as those of a beam are.
"""
import os
import subprocess
import sys
import tempfile

import numpy as np

ELASTOGEAR = os.path.abspath(sys.argv[1])
sys.path.append(os.path.abspath(sys.argv[2]))
import results

E, NU, RHO = 3e9, 0.38, 1200
G, K = E / (2 * (1 + NU)), E / (3 * (1 - 2 * NU))  # Pa
G_I, TAU = np.array([0.3, 0.2, 0.1]), np.array([1e-3, 1, 1e3])  # -, s
SIZE, CELLS = (0.3, 0.01, 0.01), (30, 1, 1)  # m
FORCE, WAY, SPRING, END = 1.0, 1e-3, 1e5, 1e5  # N, m, N/m of the spring that holds the end, s
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
NODES = np.vstack([CORNERS, [(CORNERS[a] + CORNERS[b]) / 2 for a, b in EDGES]])
KINDS = {"shear and bulk": ["-material_prony"], "shear alone": ["-material_prony_g"]}


def mesh(path, n, size):
    """Hexahedra of 20 nodes; node sets FIX at x = 0, of it FIX_Y and FIX_Z on its axes, and END."""
    nodes, cells = {}, []
    for i, j, k in np.ndindex(*n):
        x = (np.array([i, j, k]) + NODES) / n * size
        cells.append([nodes.setdefault(tuple(np.round(p, 9)), len(nodes) + 1) for p in x])
    X = np.array(list(nodes))
    with open(path, "w", encoding="utf-8") as file:
        file.write("*NODE\n" + "".join(f"{i + 1}, {x[0]:.9g}, {x[1]:.9g}, {x[2]:.9g}\n" for i, x in enumerate(X)))
        file.write("*ELEMENT, TYPE=C3D20, ELSET=ALL\n" + "".join(f"{c + 1}, " + ", ".join(map(str, cell)) + "\n" for c, cell in enumerate(cells)))
        clamp, middle = abs(X[:, 0]) < 1e-9, [abs(X[:, d] - size[d] / 2) < 1e-9 for d in range(3)]
        sets = {"FIX": clamp, "FIX_Y": clamp & middle[1], "FIX_Z": clamp & middle[2], "END": abs(X[:, 0] - size[0]) < 1e-9}
        for name, chosen in sets.items():
            file.write(f"*NSET, NSET={name}\n" + "".join(f"{i + 1},\n" for i in np.flatnonzero(chosen)))


def run(*arguments):
    done = subprocess.run([ELASTOGEAR, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, arguments))}: {done.stdout}{done.stderr}")


def creep(g, t):
    """What grows to from 1 by relative moduli g: the inverse transform of 1 / (s (1 - sum_i g_i / (1 + tau_i s)))."""
    values, vectors = np.linalg.eig((np.outer(np.ones(len(g)), g) - np.eye(len(g))) / TAU[:, None])
    share = np.linalg.solve(vectors, 1 / TAU)
    eta = vectors @ (np.expm1(np.outer(values, t)) / values[:, None] * share[:, None])
    return np.real(1 + g @ eta)


def compliances(kind):
    """Those parts of the beam's compliance that keep as they are and that creep with 1/G, m/N; elastic."""
    length, width, height = SIZE
    bending = length**3 / (3 * width * height**3 / 12)
    kappa = 10 * (1 + NU) / (12 + 11 * NU)  # G. R. Cowper, J. Appl. Mech. 33 (1966) 335-340
    shear = length / (kappa * width * height)
    if kind == "shear and bulk":
        return 0, bending / E + shear / G
    return bending / (9 * K), bending / (3 * G) + shear / G


def simulate(output, *more):
    run("simulate", "-bar_file", "bar.h5", "-sensors_tip", "bar.END", "-analysis", "static", "-static_steps", 2, "-time_under_load", END,
        "-output", output, *more)
    with results.open_file(output, "result") as file:
        position = file["sensors/tip/position"][:]
        return file["time"][:], position[:, 1]


def deflection():
    """Of the end under a force."""
    t, y = simulate("force.h5", "-bodies", "bar", "-loads", "pull", "-pull_marker", "bar.END", "-pull_force", f"0,{FORCE},0")
    return t, y - SIZE[1] / 2


def holding_force():
    """While the end is held by a spring on a sled that has moved by WAY."""
    t, y = simulate("held.h5", "-bodies", "bar,sled", "-sled_file", "sled.h5", "-sled_position", f"{SIZE[0] - 0.01},0,0", "-sled_joint", "prismatic",
                    "-sled_axis", "0,1,0",
                    "-sled_translation_motion", f"speed,{WAY}", "-ts_max_time", 1, "-bushings", "hold", "-hold_markers", "bar.END,sled.END",
                    "-hold_stiffness", f"0,{SPRING},0")
    return t, SPRING * (WAY - (y - SIZE[1] / 2))


def check(what, values, exact, bound):
    error = abs(values - exact).max() / abs(exact).max()
    print(f"{what}: {error:.2e}")
    if not error < bound:
        sys.exit(f"{what}: {error:.3e}, must be below {bound:.0e}")


def compare(kind, basis):
    series = [word for key in KINDS[kind] for word in (key, ",".join(map(str, G_I)))]
    run("reduce", "-mesh", "bar.inp", "-material_E", E, "-material_nu", NU, "-material_rho", RHO, "-material_prony_tau",
        ",".join(map(str, TAU)), *series, "-restrain", "FIX:x,FIX_Y:y,FIX_Z:z", "-markers", "END", "-basis", *basis, "-output", "bar.h5")
    stays, creeps = compliances(kind)
    t, y = deflection()
    assert t[0] == 0 and t[-1] == END
    check(f"{kind}, {basis[0]}: creep", y, FORCE * (stays + creeps * creep(G_I, t)), 1e-3)
    t, force = holding_force()
    keeps = stays + 1 / SPRING
    m = keeps / (keeps + creeps)
    check(f"{kind}, {basis[0]}: relaxation", force, WAY / (keeps + creeps) * (1 - (1 - m) * creep(m * G_I, t)) / m, 1e-3)
    print(f"deflection {y[0]:.4e} to {y[-1]:.4e} m, force {force[0]:.4f} to {force[-1]:.4f} N")


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        mesh("bar.inp", CELLS, SIZE)
        mesh("sled.inp", (1, 1, 1), (0.01, 0.01, 0.01))
        run("reduce", "-mesh", "sled.inp", "-material_E", 1e6 * E, "-material_nu", NU, "-material_rho", RHO, "-restrain", "FIX", "-markers", "END",
            "-basis", "full", "-output", "sled.h5")
        for kind in KINDS:
            compare(kind, ["full"])
        compare("shear and bulk", ["modal", "-modes", 20])


if __name__ == "__main__":
    main()
