#!/usr/bin/python3
"""Spin-up of a flexible beam by Kane's ramp: what floating frames with linear strains show of it, beside beam theory.

    studies/spin_up.py [--elastogear PROGRAM] [--calculix ccx] --out FOLDER

The beam of J. C. Simo and L. Vu-Quoc (J. Appl. Mech. 53 (1986) 855-863; EA = 2.8e7 N, EI = 1.4e4 N m^2, 1.2 kg/m, 10 m) is
meshed, reduced and brought from rest to 6 rad/s in 15 s (T. R. Kane, R. R. Ryan, A. K. Banerjee, J. Guid. Control Dyn. 10
(1987) 139-151), with the inertia levels linear and full. Draws the lag of the tip beside equation (3.22) of docs/theory,
with and without the stiffening by centrifugal forces, and prints the largest lag and the extension at full speed. With
--calculix it runs the beam once more as a finite-element body with large rotations (20 C3D20, steps of 20 ms) and adds its curve.
"""
import argparse
import os
import subprocess

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

L, EA, EI, M = 10.0, 2.8e7, 1.4e4, 1.2  # m, N, N m^2, kg/m
SPEED, RAMP, END, DT = 6.0, 15.0, 20.0, 0.01  # rad/s, s
CELLS, MODES = 40, 40
HEIGHT = np.sqrt(12 * EI / EA)  # in the plane of the motion, m
WIDTH = 1.5 * HEIGHT
ROOTS = (1.875104068711961, 4.694091132974175, 7.854757438237612)  # cos x cosh x = -1
CCX_CELLS, CCX_DT = 20, 0.02  # s
# Relative residual force and correction of a displacement, N for forces smaller than which no residual has to be: at the start
# the ramp moves the beam by less than rounding errors.
CCX_CONTROLS = (1e-4, 1e-3, 1, 1)
C3D20 = ((0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2), (1, 0, 0), (2, 1, 0), (1, 2, 0),
         (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2), (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1))  # halves of a cell
DRAWN = 1.0  # m, where a curve that diverges is cut
APART = 0.5  # s, dots of theory


def write_mesh(path):
    """A row of hexahedra along x, centred; node sets HELD (x = 0) and TIP (x = L), surface SIDE."""
    corners = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    with open(path, "w") as out:
        out.write("*NODE\n")
        for i in range(CELLS + 1):
            for k, (y, z) in enumerate(corners):
                out.write(f"{4 * i + k + 1}, {L * i / CELLS!r}, {y * HEIGHT / 2!r}, {z * WIDTH / 2!r}\n")
        out.write("*ELEMENT, TYPE=C3D8, ELSET=ALL\n")
        for i in range(CELLS):
            nodes = [4 * i + k + 1 for k in range(4)] + [4 * (i + 1) + k + 1 for k in range(4)]
            out.write(f"{i + 1}, " + ", ".join(map(str, nodes)) + "\n")
        for name, first in (("HELD", 1), ("TIP", 4 * CELLS + 1)):
            out.write(f"*NSET, NSET={name}\n" + "".join(f"{first + k}\n" for k in range(4)))
        out.write("*SURFACE, NAME=SIDE, TYPE=ELEMENT\n" + "".join(f"{i + 1}, S3\n" for i in range(CELLS)))


def run(program, *words):
    done = subprocess.run([program, *words], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{program} {' '.join(words)}\n{done.stdout}{done.stderr}")


def reduce(program, folder):
    mesh, body = (os.path.join(folder, name) for name in ("beam.inp", "beam.h5"))
    write_mesh(mesh)
    section = HEIGHT * WIDTH
    run(program, "reduce", "-mesh", mesh, "-output", body, "-material_E", repr(EA / section), "-material_nu", "0",
        "-material_rho", repr(M / section), "-restrain", "HELD", "-surface", "SIDE", "-markers", "TIP", "-modes",
        str(MODES), "-invariants", "full", "-completeness", "false", "-symmetry", "none")
    return body


def simulated(program, folder, body, level):
    """Times, and the tip's way in the turning frame (m): along the beam and against the motion."""
    result = os.path.join(folder, f"spin_up_{level}.h5")
    options = ["-bodies", "beam", "-beam_file", body, "-beam_joint", "revolute", "-beam_axis", "0,0,1",
               "-beam_rotation_motion", f"spin_up,{SPEED},{RAMP}", "-inertia", level, "-sensors_tip", "beam.TIP",
               "-ts_dt", str(DT), "-ts_max_time", str(END if level == "linear" else 0.6 * END), "-output", result]
    if level == "full":  # ends where the beam is bent too far
        subprocess.run([program, "simulate", *options], capture_output=True, check=False)
    else:
        run(program, "simulate", *options)
    with h5py.File(result) as file:
        R = file["bodies/beam/rotation"][:]
        tip = np.einsum("tji,tj->ti", R, file["sensors/tip/position"][:])
        return file["time"][:], tip[:, 0] - L, -tip[:, 1]


def ramp(t):
    """Angular velocity and acceleration of the prescribed motion `spin_up`."""
    if t >= RAMP:
        return SPEED, 0.0
    a = 2 * np.pi / RAMP
    return SPEED * (t / RAMP - np.sin(a * t) / (2 * np.pi)), SPEED / RAMP * (1 - np.cos(a * t))


def angle(t):
    """Integral of the angular velocity; t: array."""
    a = 2 * np.pi / RAMP
    return np.where(t < RAMP, SPEED * (t**2 / 2 + (np.cos(a * t) - 1) / a**2) / RAMP, SPEED * (t - RAMP / 2))


def turning_beam():
    """Nodes (m) and cells, from 0, of a row of C3D20 along x."""
    scale = np.array((L / CCX_CELLS, HEIGHT, WIDTH)) / 2
    number, cells = {}, []
    for cell in range(CCX_CELLS):
        places = [(2 * cell + i, j, k) for i, j, k in C3D20]
        cells.append([number.setdefault(place, len(number)) for place in places])
    return (np.array(list(number)) - (0, 1, 1)) * scale, cells


def write_turning_deck(path):
    """The nodes at x = 0 are led along their circles, as tables; TIP are those at x = L."""
    X, cells = turning_beam()
    times = np.arange(round(END / CCX_DT) + 1) * CCX_DT
    c, s = np.cos(angle(times)), np.sin(angle(times))
    boundary = ""
    with open(path, "w", encoding="ascii") as out:
        out.write("*NODE\n" + "".join(f"{i + 1}, {x[0]:.12e}, {x[1]:.12e}, {x[2]:.12e}\n" for i, x in enumerate(X)))
        out.write("*ELEMENT, TYPE=C3D20, ELSET=ALL\n")
        for i, nodes in enumerate(cells):
            words = [str(node + 1) for node in nodes]
            out.write(f"{i + 1}, " + ", ".join(words[:10]) + ",\n" + ", ".join(words[10:]) + "\n")
        section = HEIGHT * WIDTH
        out.write(f"*MATERIAL, NAME=M\n*ELASTIC\n{EA / section:.9g}, 0.\n*DENSITY\n{M / section:.9g}\n"
                  "*SOLID SECTION, ELSET=ALL, MATERIAL=M\n*NSET, NSET=TIP\n")
        out.write("".join(f"{i + 1},\n" for i in np.flatnonzero(X[:, 0] > L * (1 - 1e-9))))
        for i in np.flatnonzero(X[:, 0] == 0):
            for axis, way in ((1, -s * X[i, 1]), (2, (c - 1) * X[i, 1])):
                out.write(f"*AMPLITUDE, NAME=N{i + 1}A{axis}\n")
                out.writelines(f"{t:.6f}, {u:.10e}\n" for t, u in zip(times, way))  # ccx reads 20 characters of a number
                boundary += f"*BOUNDARY, AMPLITUDE=N{i + 1}A{axis}\n{i + 1}, {axis}, {axis}, 1.\n"
            boundary += f"*BOUNDARY\n{i + 1}, 3, 3\n"
        out.write(f"*STEP, NLGEOM, INC={10 * len(times)}\n*DYNAMIC, DIRECT\n{CCX_DT}, {END}\n*CONTROLS, PARAMETERS=FIELD\n"
                  + ", ".join(map(str, CCX_CONTROLS)) + f"\n{boundary}*NODE PRINT, NSET=TIP\nU\n*END STEP\n")


def by_calculix(program, folder):
    """Times, and the tip's way in the turning frame (m): along the beam and against the motion; large rotations."""
    write_turning_deck(os.path.join(folder, "turning.inp"))
    with open(os.path.join(folder, "turning.log"), "w", encoding="utf-8") as log:
        subprocess.run([program, "turning"], cwd=folder, stdout=log, stderr=subprocess.STDOUT, check=True)
    times, rows = [], []
    with open(os.path.join(folder, "turning.dat"), encoding="ascii") as file:
        for line in file:
            words = line.split()
            if "time" in words:
                times.append(float(words[-1]))
                rows.append([])
            elif words:
                rows[-1].append([float(word) for word in words[1:3]])
    t = np.array(times)
    tip = np.array([np.mean(row, axis=0) for row in rows]) + (L, 0)
    c, s = np.cos(angle(t)), np.sin(angle(t))
    return t, c * tip[:, 0] + s * tip[:, 1] - L, s * tip[:, 0] - c * tip[:, 1]


def modes():
    """Bending modes of the cantilever with unit modal mass: frequency, value at the tip, integrals of docs/theory, (3.22)."""
    x = (np.arange(4000) + 0.5) / 4000 * L
    dx = L / 4000
    k = np.array(ROOTS)[:, None]
    sigma = (np.cosh(k) + np.cos(k)) / (np.sinh(k) + np.sin(k))
    s = k * x / L
    phi = (np.cosh(s) - np.cos(s) - sigma * (np.sinh(s) - np.sin(s))) / np.sqrt(M * L)
    slope = k / L * (np.sinh(s) + np.sin(s) - sigma * (np.cosh(s) - np.cos(s))) / np.sqrt(M * L)
    tip = 2 * np.array([1, -1, 1]) / np.sqrt(M * L)
    stiffening = M * dx * (slope * (L**2 - x**2) / 2) @ slope.T
    return (k[:, 0] / L)**2 * np.sqrt(EI / M), tip, M * dx * (phi @ x), stiffening


def theory(stiffness, end):
    """Times and lag of the tip (m) by (3.22) with s = stiffness; Runge and Kutta's method."""
    omega, tip, c, _ = modes()
    n = len(omega)

    def rate(t, y):
        w, w_dot = ramp(t)
        return np.concatenate((y[n:], -omega**2 * y[:n] - w**2 * stiffness @ y[:n] - w_dot * c))

    h, y, times, lag = 1e-3, np.zeros(2 * n), [0.0], [0.0]
    for step in range(round(end / h)):
        t = step * h
        k_1 = rate(t, y)
        k_2 = rate(t + h / 2, y + h / 2 * k_1)
        k_3 = rate(t + h / 2, y + h / 2 * k_2)
        k_4 = rate(t + h, y + h * k_3)
        y = y + h / 6 * (k_1 + 2 * k_2 + 2 * k_3 + k_4)
        times.append(t + h)
        lag.append(-tip @ y[:n])
    return np.array(times), np.array(lag)


def draw(curves, path):
    plt.rcParams.update({"figure.dpi": 150, "figure.constrained_layout.use": True, "axes.grid": True, "grid.alpha": 0.3})
    figure, axes = plt.subplots(figsize=(7, 4))
    for label, style, (time, lag) in curves:
        shown = lag < DRAWN
        every = int(APART / (time[1] - time[0])) if "o" in style else 1
        axes.plot(time[shown], lag[shown], style, markevery=every, markersize=4, label=label)
    axes.set(xlabel="time in s", ylabel="lag of the tip in m")
    axes.legend()
    figure.savefig(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", default="elastogear", help="the program to run")
    parser.add_argument("--calculix", metavar="PROGRAM", help="runs CalculiX (ccx) as well")
    parser.add_argument("--out", required=True, help="folder for mesh, body, results and the plot")
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    body = reduce(args.elastogear, args.out)
    time, extension, lag = simulated(args.elastogear, args.out, body, "linear")
    full_time, _, full_lag = simulated(args.elastogear, args.out, body, "full")
    stiffening = modes()[3] - np.eye(len(ROOTS))
    stiffened, unstiffened = theory(stiffening, END), theory(np.zeros_like(stiffening), END)
    softened = theory(-np.eye(len(ROOTS)), 0.6 * END)
    curves = [("level linear", "C0-", (time, lag)), ("(3.22) without stiffening", "C0o", unstiffened),
              ("level full", "C1-", (full_time, full_lag)), ("(3.22) with inertia only", "C1o", softened),
              ("(3.22) with stiffening", "C2-o", stiffened)]
    if args.calculix:
        ccx_time, ccx_extension, ccx_lag = by_calculix(args.calculix, args.out)
        curves.append(("CalculiX, large rotations", "k--", (ccx_time, ccx_lag)))
        apart = np.abs(np.interp(ccx_time, *stiffened) - ccx_lag)
        print(f"CalculiX: largest lag {ccx_lag.max():.4f} m at {ccx_time[ccx_lag.argmax()]:.2f} s, extension at {SPEED} rad/s "
              f"{ccx_extension[ccx_time > RAMP + 1].mean():.4e} m; (3.22) with stiffening is nowhere farther off than {apart.max():.4f} m")
    draw(curves, os.path.join(args.out, "spin_up.png"))
    rest = extension[time > RAMP + 1].mean()
    print(f"largest lag: level linear {lag.max():.4f} m, (3.22) without stiffening {unstiffened[1].max():.4f} m, "
          f"with it {stiffened[1].max():.4f} m")
    print(f"extension at {SPEED} rad/s: {rest:.4e} m, rho w^2 L^3 / 3 E = {M * SPEED**2 * L**3 / 3 / EA:.4e} m")


if __name__ == "__main__":
    main()
