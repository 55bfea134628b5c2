#!/usr/bin/python3
"""Load sharing and mesh stiffness of a spur pair beside CalculiX (ccx), with its own contact, on the same meshes:

    studies/spur_pair_calculix.py --elastogear build/release/src/app/elastogear --mesh build/release/studies/spur_pair_mesh --out FOLDER

Test gears C14 (examples/drives/spur_c14.yaml), whole width, no deviations, some teeth of each on a part of its disc, with fine
flanks by spur_pair_mesh; bore and cuts of each are a rigid hub. elastogear finds the equilibrium under --torque with the wheel's hub
held, on the exact flanks. In CalculiX the pinion's hub is turned by the angle that elastogear found, from where exact rigid flanks
touch; its moment over the torque is the ratio of the secant stiffnesses, and the forces on the pairs of areas are the shares of the
teeth. The facets leave gaps that the exact flanks have not: they drop out of the stiffness between two --torques. Both have the same linear hexahedra (-element plain, C3D8). CalculiX has large displacements, and contact of
faces with faces on the facets of the mesh; --penalty is its stiffness in moduli of elasticity per face of the flank.
"""
import argparse
import os
import subprocess

import numpy as np

from calculix import listed
from drive_runs import Refused, results
import figures

NAMES = ("pinion", "wheel")
E, NU = 206e9, 0.3
NEAR = 0.3e-3  # m, between nodes of flanks that may touch
PROFILE = 2.25 * 4.5e-3  # m, about the length of a flank
DRIVE = """drive: cylindrical
element_order: 1
module: 4.5 mm
centre_distance: 91.5 mm
face_width: 14 mm
pinion: {teeth: 16, profile_shift: 0.1817, tip_diameter: 82.635 mm}
wheel: {teeth: 24, profile_shift: 0.1715, tip_diameter: 118.544 mm}
"""


class Mesh:
    """Nodes, hexahedra and sets of what spur_pair_mesh writes, all numbers from 0."""

    def __init__(self, path):
        self.X, self.cells, self.nodes, self.sides = [], [], {}, {}
        kind, name, element = "", "", {}
        with open(path, encoding="utf-8") as file:
            for line in file:
                words = [word.strip() for word in line.strip().split(",")]
                if line.startswith("**"):
                    continue
                if line.startswith("*"):
                    kind = words[0].upper()
                    keys = dict(word.split("=") for word in words[1:] if "=" in word)
                    name = keys.get("NSET", keys.get("NAME", ""))
                    continue
                if kind == "*NODE":
                    self.X.append([float(word) for word in words[1:4]])
                elif kind == "*ELEMENT":
                    element[int(words[0])] = len(self.cells)
                    self.cells.append([int(word) - 1 for word in words[1:9]])
                elif kind == "*NSET":
                    self.nodes.setdefault(name, []).extend(int(word) - 1 for word in words if word)
                elif kind == "*SURFACE":
                    self.sides.setdefault(name, []).append((element[int(words[0])], int(words[1][1:])))
        self.X, self.cells = np.array(self.X), np.array(self.cells)

    def flank_nodes(self, name):
        corners = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))
        return np.unique([self.cells[cell][list(corners[side - 1])] for cell, side in self.sides[name]])


def run(command, folder, log):
    with open(os.path.join(folder, log), "w", encoding="utf-8") as out:
        done = subprocess.run([*map(str, command)], cwd=folder, stdout=out, stderr=subprocess.STDOUT, check=False,
                              env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"})
    if done.returncode != 0:
        with open(os.path.join(folder, log), encoding="utf-8", errors="replace") as out:
            raise Refused(f"{command[0]}: {out.read()[-400:]}")


def turn(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


class Elastogear:
    """Equilibrium at one roll angle: start and end of the pinion's angle, places of both, forces by pair of areas."""

    def __init__(self, program, folder, roll, torque, surface, points="minima"):
        name = f"roll_{roll:g}_{torque:g}_{surface}_{points}"
        output = name + ".h5"
        if not os.path.exists(os.path.join(folder, output)):
            run([program, "simulate", "drive.yaml", "-roll", repr(roll), "-torque", repr(torque), "-contact_surface", surface, "-contact_points", points,
                 "-output", output], folder, name + ".log")
        with results.open_file(os.path.join(folder, output), "result") as file:
            self.start = float(file["provenance"].attrs["option_pinion_angle0"])
            self.turned = file["bodies/pinion/rigid"][-1, 0] - self.start
            self.r = {name: file[f"bodies/{name}/position"][-1] for name in NAMES}
            self.R = {"pinion": turn(self.start), "wheel": file["bodies/wheel/rotation"][-1]}
            pair = file["contact/pinion:wheel"]
            group = pair["groups/a"]
            force = np.linalg.norm(group["force"][-1], axis=1)
            self.force = {results.text(name): f for name, f in zip(group["name"][:], force) if f > 0}


def pairs_of(meshes, X):
    """Flanks of both gears that are near enough to touch."""
    found = []
    for a in [name for name in meshes["pinion"].sides if name.endswith("_left") and name != "left"]:
        for b in [name for name in meshes["wheel"].sides if name.endswith("_left") and name != "left"]:
            one, other = X["pinion"][meshes["pinion"].flank_nodes(a)], X["wheel"][meshes["wheel"].flank_nodes(b)]
            if min(np.linalg.norm(other - x, axis=1).min() for x in one) < NEAR:
                found.append((a, b))
    return found


def areas_of(meshes, pairs):
    """Slave and master of each pair of flanks: names, and sides of cells of the pinion and of the wheel."""
    return [(f"p_{a}", "pinion", meshes["pinion"].sides[a], f"w_{b}", "wheel", meshes["wheel"].sides[b]) for a, b in pairs]


def write_deck(path, meshes, X, state, areas, stiffness, element="C3D8"):
    """areas: slave's name, gear and sides, master's name, gear and sides."""
    offset, first = {"pinion": 0, "wheel": len(X["pinion"])}, {"pinion": 1, "wheel": 1 + len(meshes["pinion"].cells)}
    with open(path, "w", encoding="utf-8") as file:
        for name in NAMES:
            file.write(f"*NODE, NSET=N{name}\n")
            file.writelines(f"{offset[name] + i + 1}, {x[0]:.12e}, {x[1]:.12e}, {x[2]:.12e}\n" for i, x in enumerate(X[name]))
            file.write(f"*ELEMENT, TYPE={element}, ELSET=E{name}\n")
            file.writelines(f"{first[name] + i}, " + ", ".join(str(offset[name] + n + 1) for n in cell) + "\n"
                            for i, cell in enumerate(meshes[name].cells))
            file.write(f"*MATERIAL, NAME=M{name}\n*ELASTIC\n{E:.9g}, {NU}\n*SOLID SECTION, ELSET=E{name}, MATERIAL=M{name}\n")
            file.write(f"*NSET, NSET=HUB{name}\n" + listed(offset[name] + np.array(meshes[name].nodes["hub"]) + 1))
        surfaces = {name: (gear, sides) for area in areas for name, gear, sides in (area[:3], area[3:])}
        for name, (gear, sides) in surfaces.items():
            file.write(f"*SURFACE, NAME={name}, TYPE=ELEMENT\n")
            file.writelines(f"{first[gear] + cell}, S{side}\n" for cell, side in sides)
        file.write(f"*SURFACE INTERACTION, NAME=CONTACT\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{stiffness:.9g}\n")
        for slave, _, _, master, _, _ in areas:
            file.write(f"*CONTACT PAIR, INTERACTION=CONTACT, TYPE=SURFACE TO SURFACE\n{slave}, {master}\n")
        file.write("*STEP, NLGEOM, INC=200\n*STATIC\n0.5, 1.\n*BOUNDARY\nHUBwheel, 1, 3\n")
        R = turn(state.turned)
        for n in meshes["pinion"].nodes["hub"]:
            arm = X["pinion"][n] - state.r["pinion"]
            file.writelines(f"{n + 1}, {i + 1}, {i + 1}, {u:.12e}\n" for i, u in enumerate(R @ arm - arm))
        file.write("*NODE PRINT, NSET=HUBpinion, FREQUENCY=1000\nRF\n")
        file.writelines(f"*CONTACT PRINT, SLAVE={slave}, MASTER={master}, FREQUENCY=1000\nCF\n" for slave, _, _, master, _, _ in areas)
        file.write("*END STEP\n")


def read_prints(path, arms):
    """Moment about z of the reactions (N m), and force on each pair (N)."""
    moment, pairs, heading, pair = 0.0, {}, "", None
    with open(path, encoding="ascii") as file:
        for line in file:
            try:
                row = [float(word) for word in line.split()]
            except ValueError:
                heading, words = line, line.replace(",", " ").lower().split()
                if "slave" in words:
                    pair = words[words.index("slave") + 2]
                continue
            if row and "forces (fx,fy,fz)" in heading and "total" not in heading:
                moment += np.cross(arms[int(row[0]) - 1], row[1:4])[2]
            elif row and "total surface force" in heading:
                pairs[pair] = float(np.linalg.norm(row[:3]))
    return moment, pairs


def calculix(folder, meshes, state, name, stiffness):
    X = {name: meshes[name].X @ state.R[name].T + state.r[name] for name in NAMES}
    job = f"ccx_{name}_{stiffness:.3g}"
    pairs = pairs_of(meshes, X)
    if not os.path.exists(os.path.join(folder, job + ".frd.done")):
        write_deck(os.path.join(folder, job + ".inp"), meshes, X, state, areas_of(meshes, pairs), stiffness)
        run(["ccx", job], folder, job + ".log")
        open(os.path.join(folder, job + ".frd.done"), "w", encoding="ascii").close()
    return read_prints(os.path.join(folder, job + ".dat"), X["pinion"] @ turn(state.turned).T - state.r["pinion"])


def prepare(options, folder):
    with open(os.path.join(folder, "drive.yaml"), "w", encoding="utf-8") as file:
        file.write(DRIVE)
    run([os.path.abspath(options.mesh), ".", options.flank, options.tooth, options.layers, options.teeth], folder, "mesh.log")
    meshes = {name: Mesh(os.path.join(folder, name + ".inp")) for name in NAMES}
    for name, mesh in meshes.items():
        flanks = ",".join(sorted(flank for flank in mesh.sides if flank.startswith("tooth_") and flank.endswith("_left")))
        if not os.path.exists(os.path.join(folder, name + ".h5")):
            run([os.path.abspath(options.elastogear), "reduce", "-mesh", name + ".inp", "-material_E", E, "-material_nu", NU, "-material_rho", 7850,
                 "-restrain", "hub", "-element", "plain", "-surface", flanks, "-stress_nodes", "root", "-modes", 20, "-output", name + ".h5"], folder,
                f"reduce_{name}.log")
        print(f"{name}: {len(mesh.X)} nodes, {len(mesh.cells)} cells")
    return meshes


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--mesh", required=True, help="the program spur_pair_mesh")
    parser.add_argument("--out", required=True)
    parser.add_argument("--torques", type=float, nargs=2, default=[200, 400], help="N m on the pinion")
    parser.add_argument("--rolls", type=float, nargs="+", default=[0.1, 0.3, 0.5, 0.7, 0.9])
    parser.add_argument("--flank", type=int, default=48, help="rows of faces up a flank")
    parser.add_argument("--tooth", type=int, default=8, help="columns across a tooth")
    parser.add_argument("--layers", type=int, default=2, help="across the face")
    parser.add_argument("--teeth", type=int, default=3, help="of each gear")
    parser.add_argument("--surface", default="exact", choices=("exact", "smooth", "facets"), help="of elastogear's contact")
    parser.add_argument("--penalty", type=float, nargs="+", default=[20])
    options = parser.parse_args()
    folder = os.path.join(options.out, f"{options.flank}_{options.tooth}_{options.layers}")
    os.makedirs(folder, exist_ok=True)
    meshes = prepare(options, folder)
    for roll in options.rolls:
        for penalty in options.penalty:
            look(options, folder, meshes, roll, penalty)


def look(options, folder, meshes, roll, penalty):
    """Prints shares and stiffnesses at one roll angle."""
    moments = []
    for torque in options.torques:
        state = Elastogear(os.path.abspath(options.elastogear), folder, roll, torque, options.surface)
        moment, pairs = calculix(folder, meshes, state, f"{roll:g}_{torque:g}", penalty * E * options.flank / PROFILE)
        moments.append(moment)
        total = sum(state.force.values())
        ours = {name: f / total for name, f in state.force.items() if f > 1e-6 * total}
        theirs = {name: pairs.get("p_" + name, 0) / sum(pairs.values()) for name in ours}
        print(f"roll {roll:g}, penalty {penalty:g}, {torque:g} N m: turned {1e3 * state.turned:.5f} mrad, CalculiX {moment:.3f} N m "
              f"({100 * (moment / torque - 1):+.2f} %), sum of forces {total:.1f} N, CalculiX {sum(pairs.values()):.1f} N; shares, CalculiX less "
              "these: " + ", ".join(f"{name} {100 * ours[name]:.2f} % ({100 * (theirs[name] - ours[name]):+.2f} %)" for name in ours), flush=True)
        figures.figure(f"spur pair, {torque:g} N m", "load share", max(abs(theirs[name] - ours[name]) for name in ours), unit="%")
        figures.figure(f"spur pair, {torque:g} N m", "secant stiffness", moment / torque - 1, unit="%")
    ratio = (moments[1] - moments[0]) / (options.torques[1] - options.torques[0])
    print(f"roll {roll:g}, penalty {penalty:g}: stiffness between both torques, CalculiX {100 * (ratio - 1):+.2f} %", flush=True)


if __name__ == "__main__":
    main()
