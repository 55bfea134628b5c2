#!/usr/bin/python3
"""The static turn-in state once more by CalculiX (ccx), with its own contact, on the same meshes:

    scripts/calculix.py WORM_full.h5 WHEEL_full.h5 full.h5 full_stress.h5 --out FOLDER

The worm stands where the static analysis full.h5 ended, undeformed, on a rigid body that turns about its axis under the
torque; the wheel's held nodes are held. Elements are C3D8I (incompatible modes, as ours), contact has a pressure in
proportion to the depth. Writes turn_in.inp, runs `ccx turn_in`, reads reaction forces and nodal stresses
and prints them beside ours.
"""
import argparse
import os
import subprocess
import sys

import h5py
import numpy as np

import results

# Corners of the sides S1..S6 of an 8-node hexahedron, in the numbering of Abaqus.
SIDES = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))
BODIES = ("worm", "wheel")
PER_LINE = 8
TENSION = {"node": ", 1.", "surface": ""}  # Pa at large clearance, which ccx asks for in contact of nodes


class Part:
    """One body in the world: nodes, hexahedra, held nodes and the faces that may touch (element, side; from 1)."""

    def __init__(self, path, state, areas, offset):
        with results.open_file(path, "body") as file:
            self.X = file["mesh/X"][:] @ state["R"].T + state["r"]
            self.cells = file["mesh/cell_nodes"][:].reshape(-1, 8)
            free = np.unique(file["reduced/free_dof"][:] // 3)
            self.held = np.setdiff1d(np.arange(len(self.X)), free)
            self.material = [float(file["material/0/" + name][()]) for name in ("E", "nu")]
            faces = np.vstack([file["mesh/face_sets/" + area][:] for area in areas])
            names = [results.text(name) for name in file["surface/group_name"][:]]
            touching = np.isin(file["surface/group"][:], [names.index(area) for area in areas])
            self.stiffness = float(file["surface/c_f"][:][touching].mean())  # Pa/m
        self.faces = element_sides(self.cells, faces)
        self.offset = offset  # of node numbers
        self.axis = state["R"][:, 2]


def element_sides(cells, faces):
    wanted = {tuple(sorted(face)) for face in faces}
    return [(cell, side) for side, corners in enumerate(SIDES)
            for cell, nodes in enumerate(np.sort(cells[:, corners], axis=1)) if tuple(nodes) in wanted]


def last_states(path):
    """Position and rotation of each body at the end of a result file."""
    with results.open_file(path, "result") as file:
        return {body: {"r": file[f"bodies/{body}/position"][-1], "R": file[f"bodies/{body}/rotation"][-1]}
                for body in BODIES}


def touching_areas(path):
    """Names of the areas of contact that carry force at the end, worm's and wheel's, and the whole force (N, world)."""
    with results.open_file(path, "result") as file:
        pair = file["contact/worm:wheel"]
        areas = []
        for side in ("a", "b"):
            force = np.linalg.norm(pair[f"groups/{side}/force"][-1], axis=1)
            areas.append([results.text(name) for name, f in zip(pair[f"groups/{side}/name"][:], force) if f > 0])
        return areas, pair["force"][-1]


def listed(numbers):
    """Numbers as lines of a set."""
    numbers = [str(n) for n in numbers]
    return "".join(", ".join(numbers[i:i + PER_LINE]) + ",\n" for i in range(0, len(numbers), PER_LINE))


def write_part(file, name, part, first_cell):
    file.write(f"*NODE, NSET=N{name}\n")
    for i, x in enumerate(part.X):
        file.write(f"{part.offset + i + 1}, {x[0]:.12e}, {x[1]:.12e}, {x[2]:.12e}\n")
    file.write(f"*ELEMENT, TYPE=C3D8I, ELSET=E{name}\n")
    for i, cell in enumerate(part.cells):
        file.write(f"{first_cell + i}, " + ", ".join(str(part.offset + node + 1) for node in cell) + "\n")
    file.write(f"*MATERIAL, NAME=M{name}\n*ELASTIC\n{part.material[0]:.9g}, {part.material[1]:.9g}\n")
    file.write(f"*SOLID SECTION, ELSET=E{name}, MATERIAL=M{name}\n")
    file.write(f"*NSET, NSET=HELD{name}\n" + listed(part.offset + part.held + 1))
    file.write(f"*SURFACE, NAME=S{name}, TYPE=ELEMENT\n")
    file.writelines(f"{first_cell + cell}, S{side + 1}\n" for cell, side in part.faces)


def write_deck(path, worm, wheel, options):
    """The axis of the worm is the world's x: the rotation node's first degree of freedom turns it."""
    if abs(abs(worm.axis[0]) - 1) > 1e-9:
        sys.exit("the worm's axis must be the world's x axis")
    reference, turning = wheel.offset + len(wheel.X) + 1, wheel.offset + len(wheel.X) + 2
    stiffness = options.stiffness or 1 / (1 / worm.stiffness + 1 / wheel.stiffness)
    centre = worm.X[worm.held].mean(axis=0)
    with open(path, "w", encoding="utf-8") as file:
        write_part(file, "worm", worm, 1)
        write_part(file, "wheel", wheel, 1 + len(worm.cells))
        for node in (reference, turning):
            file.write("*NODE\n{}, {:.12e}, {:.12e}, {:.12e}\n".format(node, *centre))
        file.write(f"*RIGID BODY, NSET=HELDworm, REF NODE={reference}, ROT NODE={turning}\n")
        file.write("*SURFACE INTERACTION, NAME=CONTACT\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n"
                   f"{stiffness:.9g}{TENSION[options.contact]}\n"
                   f"*CONTACT PAIR, INTERACTION=CONTACT, TYPE={options.contact.upper()} TO SURFACE\nSworm, Swheel\n")
        file.write(f"*BOUNDARY\nHELDwheel, 1, 3\n{reference}, 1, 3\n{turning}, 2, 3\n")
        file.write(f"*STEP, INC=200\n*STATIC\n{options.increment:g}, 1.\n*CLOAD\n{turning}, 1, "
                   f"{options.torque * np.sign(worm.axis[0]):.9g}\n")
        file.write(f"*NODE PRINT, NSET=HELDwheel, TOTALS=ONLY, FREQUENCY=1000\nRF\n*NSET, NSET=TURN\n{turning}\n"
                   "*NODE PRINT, NSET=TURN, FREQUENCY=1000\nU\n*EL FILE, FREQUENCY=1000\nS\n*END STEP\n")


def read_stress(path):
    """Nodal von Mises stress of the last state in a .frd file: {node: Pa}."""
    stress, reading = {}, False
    with open(path, encoding="ascii", errors="replace") as file:
        for line in file:
            if line.startswith(" -4"):
                reading = line.split()[1] == "STRESS"
            elif line.startswith(" -3"):
                reading = False
            elif reading and line.startswith(" -1"):
                xx, yy, zz, xy, yz, zx = (float(line[13 + 12 * i:25 + 12 * i]) for i in range(6))
                stress[int(line[3:13])] = np.sqrt(((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2) / 2
                                                  + 3 * (xy**2 + yz**2 + zx**2))
    return stress


def read_prints(path):
    """Total reaction force on the wheel (N) and turn of the worm (rad) from a .dat file."""
    rows = []
    with open(path, encoding="ascii") as file:
        for line in file:
            words = line.split()
            try:
                rows.append([float(word) for word in words])
            except ValueError:
                continue
    rows = [row for row in rows if len(row) in (3, 4)]
    force = [row for row in rows if len(row) == 3][-1]
    return np.array(force), [row for row in rows if len(row) == 4][-1][1]


def compare(options, worm, wheel, force, job):
    ours, theirs = {}, read_stress(job + ".frd")
    reaction, turn = read_prints(job + ".dat")
    print(f"{'':<34}{'elastogear':>14}{'CalculiX':>14}{'deviation':>12}")

    def row(name, a, b):
        print(f"{name:<34}{a:>14.6g}{b:>14.6g}{100 * (b / a - 1):>10.2f} %")
    row("contact force, N", np.linalg.norm(force), np.linalg.norm(reaction))
    print(f"turn of the worm from our equilibrium: {turn:.3e} rad")
    with results.open_file(options.stress, "stress") as file:
        for body, part in (("worm", worm), ("wheel", wheel)):
            group = file[body]["root"]
            ours = group["von_mises"][-1]
            values = np.array([theirs[part.offset + int(node) + 1] for node in group["nodes"][:]])
            peak = int(ours.argmax())
            row(f"{body} root node {group['nodes'][peak]}, MPa", ours[peak] / 1e6, values[peak] / 1e6)
            row(f"{body} root, largest, MPa", ours.max() / 1e6, values.max() / 1e6)
            print(f"{body} root, all nodes: {100 * np.linalg.norm(values - ours) / np.linalg.norm(ours):.2f} % (root sum of squares)")


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("worm", help="body files in the full basis")
    parser.add_argument("wheel")
    parser.add_argument("result", help="of the static analysis")
    parser.add_argument("stress", help="recovered from it")
    parser.add_argument("--torque", type=float, default=4, help="N m")
    parser.add_argument("--stiffness", type=float, default=0,
                        help="Pa/m, of the contact pressure over the depth; default: as ours, both sides in series")
    parser.add_argument("--contact", choices=("surface", "node"), default="surface",
                        help="of faces, or of the worm's nodes as ours in one pass")
    parser.add_argument("--increment", type=float, default=0.25, help="first share of the load")
    parser.add_argument("--out", default=".", help="folder of the deck")
    parser.add_argument("--read-only", action="store_true", help="the results of ccx are there already")
    return parser.parse_args()


def main():
    options = parse()
    os.makedirs(options.out, exist_ok=True)
    states = last_states(options.result)
    areas, force = touching_areas(options.result)
    worm = Part(options.worm, states["worm"], areas[0], 0)
    wheel = Part(options.wheel, states["wheel"], areas[1], len(worm.X))
    job = os.path.join(options.out, "turn_in")
    if not options.read_only:
        write_deck(job + ".inp", worm, wheel, options)
        with open(job + ".log", "w", encoding="utf-8") as log:
            subprocess.run(["ccx", "turn_in"], cwd=options.out, stdout=log, stderr=subprocess.STDOUT, check=True)
    compare(options, worm, wheel, force, job)


if __name__ == "__main__":
    main()
