#!/usr/bin/python3
"""What truncation alone does to stresses: deviation of reduced bodies that carry the very contact forces of the unreduced ones,
by the number of modes, in the static state of the turn-in, beside the deviation under the forces of their own; a table and a
figure (equal forces: lines, forces of their own: dotted).

    scripts/example turn_in --size small --bases modal --law penalty --modes 100,500,1000,2000
    studies/same_forces.py out/examples/small [--modes 100 500 1000 2000] [--figure same_forces.svg]

At rest the elastic coordinates of the unreduced body give the forces on its nodes, f = K_r q, and those the coordinates of the
reduced one, q_i = phi_i . f / lambda_i (docs/theory, section 4).
"""
import argparse
import glob
import os
import re
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
import results
from plots import COLOURS

BODIES = ("worm", "wheel")
TICKS = (1, 2, 5, 10, 20, 50, 100)  # %
AWAY = 2e-3  # m, about the size of a tooth's section
NOTICEABLE = 0.01  # of the largest force on a node
MEASURES = results.COMPONENTS[:3] + ("von Mises",)  # normal stresses and the equivalent one


def product(matrix, x):
    """Product of a sparse matrix (group with indptr, indices, data; no row is empty) and a vector."""
    return np.add.reduceat(matrix["data"][:] * x[matrix["indices"][:]], matrix["indptr"][:-1])


def von_mises(stress):
    """n x 6 in Pa, order xx yy zz xy yz xz -> n in Pa."""
    xx, yy, zz, xy, yz, xz = stress.T
    return np.sqrt(((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2) / 2 + 3 * (xy**2 + yz**2 + xz**2))


def measures(stress):
    return np.column_stack([stress[:, :3], von_mises(stress)])


def reference(full, q):
    """Forces on all displacements (N, zero at held ones), and stresses at the evaluation nodes (n x 6, Pa)."""
    force = np.zeros(full["mesh/X"].size)
    force[full["reduced/free_dof"][:]] = product(full["reduced/K"], q)
    return force.reshape(-1, 3), product(full["stress/Psi"], q).reshape(-1, 6)


def coordinates(reduced, force):
    """Elastic coordinates at rest under forces on the surface nodes."""
    on_surface = force[reduced["surface/nodes"][:]]
    return np.einsum("nci,nc->i", reduced["surface/Phi"][:], on_surface) / reduced["modes/eigenvalue"][:]


def deviation(stress, exact):
    """In % of each measure, over all nodes (root sum of squares)."""
    return 100 * np.linalg.norm(stress - exact, axis=0) / np.linalg.norm(exact, axis=0)


def evaluated_sets(reduced, force):
    """{name: rows}: the root, its nodes away from loaded ones, and the flank that carries most."""
    sets, X = {name: rows[:] for name, rows in reduced["stress/sets"].items()}, reduced["stress/X"][:]
    nodes, magnitude = reduced["stress/nodes"][:], np.linalg.norm(force, axis=1)
    loaded = reduced["mesh/X"][:][magnitude > NOTICEABLE * magnitude.max()]
    distance = np.array([np.linalg.norm(loaded - X[row], axis=1).min() for row in sets["root"]])
    flank = max(sets.keys() - {"root"}, key=lambda name: magnitude[nodes[sets[name]]].sum(), default=None)
    return {"root": sets["root"], "root away from contact": sets["root"][distance > AWAY],
            **({flank: sets[flank]} if flank else {})}


def has_stresses(folder, body, name, modes):
    """Runs with --roots leave out the flanks."""
    with results.open_file(os.path.join(folder, "turn_in", f"modal_{modes}_stress.h5"), "stress") as file:
        return name in file[body]


def own_stresses(folder, body, name, modes):
    """Stresses (n x 6, Pa) of a set in the reduced runs, one for each number of modes, and the set's nodes."""
    found = []
    for n in modes:
        with results.open_file(os.path.join(folder, "turn_in", f"modal_{n}_stress.h5"), "stress") as file:
            nodes = file[f"{body}/{name}/nodes"][:]
            found.append(file[f"{body}/{name}/stress"][-1])
    return nodes, found


def body_deviations(folder, body, modes):
    """{set: (at equal forces, under own forces)} of one body, each an array of len(modes) x len(MEASURES)."""
    with results.open_file(os.path.join(folder, "turn_in", "full.h5"), "result") as file:
        q = file[f"bodies/{body}/q"][-1]
    with results.open_file(os.path.join(folder, f"{body}_full.h5"), "body") as full:
        force, stress = reference(full, q)
        exact = dict(zip(full["stress/nodes"][:], measures(stress)))
    found = {}
    with results.open_file(most_modes(folder, body), "body") as reduced:
        amplitude, nodes = coordinates(reduced, force), reduced["stress/nodes"][:]
        for name, rows in evaluated_sets(reduced, force).items():
            if not has_stresses(folder, body, name.split()[0], modes[0]):
                continue
            target, psi = np.array([exact[node] for node in nodes[rows]]), reduced["stress/Psi"][rows]
            equal = [deviation(measures(psi[:, :, :n] @ amplitude[:n]), target) for n in modes]
            known, own = own_stresses(folder, body, name.split()[0], modes)
            there = np.searchsorted(known, nodes[rows])  # sets are in ascending order
            found[name] = np.array(equal), np.array([deviation(measures(stress[there]), target) for stress in own])
    return found


def most_modes(folder, body):
    files = glob.glob(os.path.join(folder, f"{body}_modal_[0-9]*.h5"))
    return max(files, key=lambda path: int(re.search(r"_(\d+)\.h5$", path)[1]))


def print_table(found, modes):
    print("| set | modes | " + " | ".join(MEASURES) + " | " + " | ".join(MEASURES) + " |\n" + "|---" * (2 + 2 * len(MEASURES)) + "|")
    for name, both in found.items():
        for n, *rows in zip(modes, *both):
            print(f"| {name} | {n} | " + " | ".join(f"{value:.1f}" for value in np.concatenate(rows)) + " |")


def draw(found, modes, path):
    """One row of panels for each body."""
    figure, panels = plt.subplots(len(BODIES), len(found) // len(BODIES), figsize=(8.5, 5.6), sharex=True, sharey=True)
    for axes, (name, (equal, own)) in zip(panels.flat, found.items()):
        for measure, values, others, colour in zip(MEASURES, equal.T, own.T, COLOURS):
            axes.loglog(modes, values, marker="o", markersize=4, color=colour, label=measure)
            axes.loglog(modes, others, marker="o", markersize=4, color=colour, linestyle=":", fillstyle="none")
        axes.set_title(name, fontsize=10)
        axes.set_xticks(modes, [str(n) for n in modes])
        axes.set_yticks(TICKS, [str(tick) for tick in TICKS])
        axes.minorticks_off()
    figure.supxlabel("modes a body", fontsize=10)
    figure.supylabel("deviation in %", fontsize=10)
    panels[0][-1].legend(frameon=False, fontsize=9)
    figure.savefig(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--modes", type=int, nargs="+", default=[100, 500, 1000, 2000])
    parser.add_argument("--figure")
    options = parser.parse_args()
    found = {f"{body} {name.replace('_', ' ')}": both for body in BODIES
             for name, both in body_deviations(options.folder, body, options.modes).items()}
    print_table(found, options.modes)
    if options.figure:
        draw(found, options.modes, options.figure)


if __name__ == "__main__":
    main()
