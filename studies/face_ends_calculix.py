#!/usr/bin/python3
"""Load over the face of a spur pair whose pinion is wider than its wheel, beside CalculiX (ccx), with its own contact and meshes:

    studies/face_ends_calculix.py --elastogear build/release/src/app/elastogear --mesh build/release/studies/spur_pair_mesh --out face_ends

Test gears C14 (examples/drives/spur_c14.yaml) at a roll angle where one pair of teeth is loaded. elastogear takes its default contact and
elements of size tiny. CalculiX has some teeth of each gear by spur_pair_mesh, the wheel's flank cut into its layers, each of which is a
slave of its own on the pinion's flank: the force on each is printed. Loads are over their mean.
"""
import argparse
import os

import numpy as np

from drive_runs import results
import figures
from spur_pair_calculix import DRIVE, E, NAMES, PROFILE, Elastogear, Mesh, pairs_of, run, write_deck

WIDTH, LAYERS = 14e-3, 16  # m, of the wheel


def layers_of(mesh, flank):
    """Sides of cells of a flank, layer by layer along the axis."""
    middle = np.array([mesh.X[mesh.cells[cell]][:, 2].mean() for cell, _ in mesh.sides[flank]])
    number = np.floor((middle + WIDTH / 2) / WIDTH * LAYERS).astype(int)
    return [[side for side, k in zip(mesh.sides[flank], number) if k == layer] for layer in range(LAYERS)]


def read_forces(path):
    """N, of each slave by its name in small letters."""
    found, slave = {}, None
    with open(path, encoding="ascii") as file:
        for line in file:
            words = line.replace(",", " ").lower().split()
            if "slave" in words:
                slave, heading = words[words.index("slave") + 2], line
            elif "total surface force" in line:
                heading = line
            elif words and slave and "total surface force" in heading and slave not in found:
                found[slave] = float(np.linalg.norm([float(word) for word in words[:3]]))
    return found


def by_calculix(options, folder, state, wider):
    run([os.path.abspath(options.mesh), ".", options.flank, 8, LAYERS, 3, LAYERS + wider, WIDTH * (LAYERS + wider) / LAYERS], folder, "mesh.log")
    meshes = {name: Mesh(os.path.join(folder, name + ".inp")) for name in NAMES}
    X = {name: meshes[name].X @ state.R[name].T + state.r[name] for name in NAMES}
    (a, b), = pairs_of(meshes, X)
    areas = [(f"w_{layer}", "wheel", sides, "p_flank", "pinion", meshes["pinion"].sides[a]) for layer, sides in enumerate(layers_of(meshes["wheel"], b))]
    job = f"ccx_{options.flank}"
    if not os.path.exists(os.path.join(folder, job + ".done")):
        write_deck(os.path.join(folder, job + ".inp"), meshes, X, state, areas, 20 * E * options.flank / PROFILE, "C3D8I")
        run(["ccx", job], folder, job + ".log")
        open(os.path.join(folder, job + ".done"), "w", encoding="ascii").close()
    force = read_forces(os.path.join(folder, job + ".dat"))
    return np.array([force[f"w_{layer}"] for layer in range(LAYERS)])


def by_elastogear(options, folder, wider):
    program = os.path.abspath(options.elastogear)
    with open(os.path.join(folder, "drive.yaml"), "w", encoding="utf-8") as file:
        file.write(DRIVE.replace("element_order: 1", "element_order: 2\nsize: tiny\nmodes: 0\nanalysis: static\nstatic_steps: 1")
                   .replace("pinion: {", f"pinion: {{face_width: {1e3 * WIDTH * (LAYERS + wider) / LAYERS:.9g} mm, "))
    if not os.path.exists(os.path.join(folder, "pinion.h5")):
        run([program, "reduce", "drive.yaml"], folder, "reduce.log")
    state = Elastogear(program, folder, options.roll, options.torque, "exact", "stations")
    name = f"roll_{options.roll:g}_{options.torque:g}_exact_stations.h5"
    with results.open_file(os.path.join(folder, name), "result") as file:
        points = file["contact/pinion:wheel/points"]
        return state, np.linalg.norm(points["force"][points["offset"][-2]:points["offset"][-1]], axis=1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--mesh", required=True, help="the program spur_pair_mesh")
    parser.add_argument("--out", required=True)
    parser.add_argument("--torque", type=float, default=200, help="N m on the pinion")
    parser.add_argument("--roll", type=float, default=0.8)
    parser.add_argument("--flank", type=int, default=48, help="rows of faces up a flank")
    parser.add_argument("--wider", type=int, nargs="+", default=[0, 2], help="by how many sixteenths of the wheel's width")
    options = parser.parse_args()
    for wider in options.wider:
        folder = os.path.join(options.out, f"{wider}_{options.flank}")
        os.makedirs(folder, exist_ok=True)
        state, ours = by_elastogear(options, folder, wider)
        theirs = by_calculix(options, folder, state, wider)
        print(f"pinion wider by {100 * wider / LAYERS:g} %, sums {ours.sum():.0f} and {theirs.sum():.0f} N; strip: these, CalculiX, over their means")
        for k, (one, other) in enumerate(zip(ours / ours.mean(), theirs / theirs.mean())):
            print(f"| {k + 1} | {one:.3f} | {other:.3f} | {100 * (one / other - 1):+.1f} % |", flush=True)
            figures.figure(f"load over the face, pinion wider by {100 * wider / LAYERS:g} %", "load of a strip", one / other - 1, unit="%")


if __name__ == "__main__":
    main()
