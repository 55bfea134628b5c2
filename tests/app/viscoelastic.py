#!/usr/bin/python3
"""A bar of a steel half and a polymer half, whose shear and bulk moduli relax apart, from mesh to stress:

    tests/app/viscoelastic.py ELASTOGEAR SCRIPTS

Reduced and unreduced bodies beside the exact solution of the unreduced equations with internal variables, by the
eigenvectors of their first-order form; temperature, states of rest, fields, and a run that goes on from a checkpoint.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import h5py
import numpy as np
from vtk import vtkXMLUnstructuredGridReader
from vtk.util.numpy_support import vtk_to_numpy

ELASTOGEAR = os.path.abspath(sys.argv[1])
sys.path.append(os.path.abspath(sys.argv[2]))
import results

MATERIALS = pathlib.Path(__file__).resolve().parent.parent.parent / "examples" / "materials"
E, NU, RHO = 3e9, 0.38, 1200  # instantaneous
G_I, K_I, TAU = (0.3, 0.3), (0.1, 0), (2e-3, 5e-2)  # at 40 degC; at 60 degC half of these times by the shift below
E_A = 8.31446261815324 * np.log(2) / (1 / 313.15 - 1 / 333.15)  # J/mol
FORCE, RISE = 10.0, 4e-3  # N, s
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])


def mesh(path, n=(6, 1, 1), size=(0.06, 0.01, 0.01)):
    """Hexahedra; node sets FIX (x = 0), END, POLYMER (in the middle of that half); element sets HUB (steel) and RIM."""
    nodes, cells = {}, []
    for i, j, k in np.ndindex(*n):
        x = (np.array([i, j, k]) + CORNERS) / n * size
        cells.append([nodes.setdefault(tuple(np.round(p, 9)), len(nodes) + 1) for p in x])
    X = np.array(list(nodes))
    with open(path, "w", encoding="utf-8") as file:
        file.write("*NODE\n" + "".join(f"{i + 1}, {x[0]:.9g}, {x[1]:.9g}, {x[2]:.9g}\n" for i, x in enumerate(X)))
        for name, part in (("HUB", range(n[0] // 2)), ("RIM", range(n[0] // 2, n[0]))):
            file.write(f"*ELEMENT, TYPE=C3D8, ELSET={name}\n")
            file.write("".join(f"{c + 1}, " + ", ".join(map(str, cells[c])) + "\n" for c in part))
        for name, at in (("FIX", 0), ("END", size[0]), ("POLYMER", size[0] * 2 / 3)):
            file.write(f"*NSET, NSET={name}\n" + "".join(f"{i + 1},\n" for i in np.flatnonzero(abs(X[:, 0] - at) < 1e-9)))


def run(*arguments, ends_early=False):
    done = subprocess.run([ELASTOGEAR, *map(str, arguments)], capture_output=True, text=True, check=False)
    if (done.returncode != 0) != ends_early:
        sys.exit(f"{' '.join(map(str, arguments))}: {done.stdout}{done.stderr}")
    return done.stdout


def numbers(values):
    return ",".join(f"{value:.17g}" for value in values)


def reduce(path, *more):
    polymer = ["-material_RIM_" + key for key in ("E", "nu", "rho", "prony_tau", "prony_g", "prony_k", "activation_energy",
                                                  "temperature_reference", "temperature")]
    values = [E, NU, RHO, numbers(2 * np.array(TAU)), numbers(G_I), numbers(K_I), f"{E_A:.17g}", "40degC", "60degC"]
    run("reduce", "-mesh", "bar.inp", "-material_HUB_E", "210e9", "-material_HUB_nu", 0.3, "-material_HUB_rho", 7850,
        *[word for pair in zip(polymer, values) for word in pair], "-restrain", "FIX", "-markers", "END", "-stress_nodes",
        "POLYMER", "-output", path, *more)


def simulate(body, output, *more, **how):
    run("simulate", "-bodies", "bar", "-bar_file", body, "-loads", "pull", "-pull_marker", "bar.END", "-pull_force",
        f"0,{FORCE},{FORCE}", "-pull_signal", f"ramp,1,{RISE}", "-sensors_tip", "bar.END", "-output", output, *more, **how)


def sparse(group):
    rows, columns = group.attrs["shape"]
    dense = np.zeros((rows, columns))
    indptr, indices, data = group["indptr"][:], group["indices"][:], group["data"][:]
    for row in range(rows):
        dense[row, indices[indptr[row]:indptr[row + 1]]] = data[indptr[row]:indptr[row + 1]]
    return dense


class Unreduced:
    """M u'' + K u - sum_p K_p sum_i g_pi z_i = h f(t), z_i' = (u - z_i)/tau_i, f growing linearly and then constant."""

    def __init__(self, path):
        with h5py.File(path) as file:
            M, K = sparse(file["reduced/M"]), sparse(file["reduced/K"])
            parts = [file["relaxing"][p] for p in sorted(file["relaxing"])]
            self.K_p, self.g = [sparse(p["K"]) for p in parts], [p["g"][:] for p in parts]
            self.tau = parts[0]["tau"][:]
            self.moduli = [results.text(p.attrs["moduli"]) for p in parts]
            marker = sparse(file["markers/END/Phi"])[:3]
            self.Psi = sparse(file["stress/Psi"])
            self.relaxing_nodes = [set(p["stress_nodes"][:]) for p in parts]
        self.K, self.marker, self.n = K, marker, len(K)
        n, n_z = self.n, len(self.tau)
        self.A = np.zeros((n * (2 + n_z), n * (2 + n_z)))
        inverse = np.linalg.inv(M)
        self.A[:n, n:2 * n] = np.eye(n)
        self.A[n:2 * n, :n] = -inverse @ K
        for i, tau in enumerate(self.tau):
            at = slice(n * (2 + i), n * (3 + i))
            self.A[n:2 * n, at] = inverse @ sum(g[i] * K_p for g, K_p in zip(self.g, self.K_p))
            self.A[at, :n] = np.eye(n) / tau
            self.A[at, at] = -np.eye(n) / tau
        self.b = np.zeros(len(self.A))
        self.b[n:2 * n] = inverse @ marker.T @ [0, FORCE, FORCE]
        self.values, self.vectors = np.linalg.eig(self.A)
        self.inverse = np.linalg.inv(self.vectors)

    def states(self, times, rise):
        """Exact states under f(t) = min(t/rise, 1): the ramp's solution less the same one begun at `rise`."""
        def ramp(t):  # x' = A x + b t/rise from rest: exp(A t) integrated twice
            if t <= 0:
                return np.zeros(len(self.A))
            s = self.values
            twice = np.where(abs(s * t) < 1e-6, t * t / 2, (np.expm1(s * t) - s * t) / s ** 2)
            return np.real(self.vectors @ (twice * (self.inverse @ self.b))) / rise
        return [ramp(t) - ramp(t - rise) for t in times]

    def stress(self, state):
        """Of each evaluation node, 6 numbers."""
        n = self.n
        u, z = state[:n], [state[n * (2 + i):n * (3 + i)] for i in range(len(self.tau))]
        sigma = (self.Psi @ u).reshape(-1, 6)
        for moduli, g, nodes in zip(self.moduli, self.g, self.relaxing_nodes):
            lost = (self.Psi @ sum(gi * zi for gi, zi in zip(g, z))).reshape(-1, 6)
            mean = np.zeros_like(lost)
            mean[:, :3] = lost[:, :3].mean(axis=1, keepdims=True)
            part = {"both": lost, "bulk": mean, "shear": lost - mean}[moduli]
            for node in nodes:
                sigma[node] -= part[node]
        return sigma


def von_mises(s):
    normal = ((s[..., 0] - s[..., 1]) ** 2 + (s[..., 1] - s[..., 2]) ** 2 + (s[..., 2] - s[..., 0]) ** 2) / 2
    return np.sqrt(normal + 3 * (s[..., 3:] ** 2).sum(axis=-1))


def largest_error(values, exact):
    return abs(values - exact).max() / abs(exact).max()


def check(what, value, bound):
    print(f"{what}: {value:.2e}")
    if not value < bound:
        sys.exit(f"{what}: {value:.3e}, must be below {bound:.0e}")


def tip(file):
    position = file["sensors/tip/position"][:]
    return position - position[0]


def compare_motion(basis, bound, exact, bound_of_stress):
    """Displacement and stress of a run with a body of this basis beside the exact ones."""
    name = basis.split()[0]
    reduce(f"{name}.h5", "-basis", *basis.split()[1:])
    simulate(f"{name}.h5", f"{name}_run.h5", "-ts_dt", 5e-6, "-ts_max_time", 0.04, "-output_dt", 1e-3)
    run("recover", "-result", f"{name}_run.h5", "-stress_bar", "POLYMER", "-output", f"{name}_stress.h5", "-field_times", 0.04)
    with results.open_file(f"{name}_run.h5", "result") as file:
        times = file["time"][:]
        states = exact.states(times, RISE)
        check(f"{name}: displacement", largest_error(tip(file), np.array([exact.marker @ s[:exact.n] for s in states])), bound)
        relaxed, lost = file["energy/relaxation"][-1], file["energy/dissipated"][-1]
        assert relaxed == lost > 0
        check(f"{name}: balance of energy over what is lost", abs(file["energy/balance"][:]).max() / lost, 1e-9)
    with h5py.File(f"{name}_stress.h5") as file:
        stress = file["bar/POLYMER/stress"][:]
    known = np.array([exact.stress(s) for s in states])
    check(f"{name}: stress", largest_error(stress, known), bound_of_stress)
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(f"{name}_run_bar.vtu")
    reader.Update()
    with h5py.File(f"{name}.h5") as file:
        nodes = file["stress/nodes"][:]
    field = vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("von_mises [Pa]"))[nodes]
    check(f"{name}: field beside the history", largest_error(field, von_mises(stress[-1])), 1e-6)


def compare_rest(exact):
    """Equilibria at time 0+ and after all relaxation."""
    load = exact.marker.T @ [0, FORCE, FORCE]
    relaxed = exact.K - sum(g.sum() * K_p for g, K_p in zip(exact.g, exact.K_p))
    for moduli, K in (("instantaneous", exact.K), ("long_term", relaxed)):
        simulate("full.h5", f"{moduli}.h5", "-analysis", "static", "-static_steps", 2, "-moduli", moduli)
        with results.open_file(f"{moduli}.h5", "result") as file:
            check(f"{moduli}: displacement", largest_error(tip(file)[-1], exact.marker @ np.linalg.solve(K, load)), 1e-6)
    simulate("full.h5", "default.h5", "-analysis", "static", "-static_steps", 2)
    with h5py.File("default.h5") as a, h5py.File("instantaneous.h5") as b:
        assert (a["bodies/bar/q"][:] == b["bodies/bar/q"][:]).all()


def compare_resumed():
    """A run that ends at its largest number of steps goes on to the same result."""
    times = ["-ts_dt", 1e-4, "-ts_max_time", 0.02]
    simulate("modal.h5", "whole.h5", *times)
    simulate("modal.h5", "resumed.h5", *times, "-ts_max_steps", 77, ends_early=True)
    simulate("modal.h5", "resumed.h5", *times, "-resume", "auto")
    with h5py.File("whole.h5") as a, h5py.File("resumed.h5") as b:
        for name in ("bodies/bar/q", "bodies/bar/q_relaxed", "energy/relaxation", "energy/balance"):
            assert (a[name][:] == b[name][:]).all(), name


def check_ready_materials():
    """Fits of the curves of examples/materials deviate as docs/polymers.md says."""
    for name, (mean, most) in {"pa66_conditioned": (0.7, 2), "pom_copolymer": (0.5, 1.2), "polyisobutylene": (3.5, 9.5)}.items():
        text = run("reduce", "-mesh", "bar.inp", "-material_nu", 0.39, "-material_rho", 1140, "-material_master_curve",
                   os.path.join(MATERIALS, name + ".csv"), "-restrain", "FIX", "-stress_nodes", "POLYMER", "-basis", "modal", "-modes", 2,
                   "-output", "ready.h5")
        deviations = re.search(r"deviation ([\d.]+) % \(root mean square\), at most ([\d.]+) %", text)
        assert float(deviations[1]) < mean and float(deviations[2]) < most, f"{name}: {deviations[0]}"


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        mesh("bar.inp")
        reduce("full.h5", "-basis", "full")
        exact = Unreduced("full.h5")
        check("times at 60 degC", largest_error(exact.tau, np.array(TAU)), 1e-12)
        assert exact.moduli == ["shear", "bulk"]
        compare_motion("full full", 1e-3, exact, 2e-3)
        compare_motion("modal modal -modes 40", 2e-3, exact, 4e-3)
        compare_rest(exact)
        compare_resumed()
        check_ready_materials()
        shown = run("info", "full.h5")
        for words in ("viscoelastic", "arrhenius", "333.15 K"):
            assert words in shown, words


main()
