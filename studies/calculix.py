#!/usr/bin/python3
"""The static turn-in state once more by CalculiX (ccx), with its own contact, on the same meshes:

    studies/calculix.py WORM_full.h5 WHEEL_full.h5 full.h5 full_stress.h5 --out FOLDER

The worm stands where the static analysis full.h5 ended, undeformed, on a rigid body that turns about its axis under the
torque; the wheel's held nodes are held. Elements are C3D8I (incompatible modes) or, of bodies reduced with -element plain,
C3D8, which is the same as ours on all shapes. Contact has a pressure in proportion to the depth, --contact of faces (surface
to surface), or of the worm's nodes with the wheel's faces, as ours is with -contact_two_pass false; or our own contact forces
act on the nodes, and both bodies are held. Hexahedra of 20 nodes are C3D20. Writes turn_in.inp, runs `ccx turn_in`, reads
reaction forces, those of each pair of areas and nodal stresses, and prints them beside ours. turn_in.h5 is the result with
CalculiX's displacements in place of ours: `elastogear recover` makes stresses of them as it does of its own.
"""
import argparse
import os
import shutil
import subprocess
import sys

import h5py
import numpy as np

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
import results

# Corners of the sides S1..S6 of a hexahedron, in the numbering of Abaqus, and their midside nodes.
SIDES = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))
MIDSIDES = ((8, 9, 10, 11), (15, 14, 13, 12), (16, 12, 17, 8), (17, 13, 18, 9), (18, 14, 19, 10), (19, 15, 16, 11))
BODIES = ("worm", "wheel")
ELEMENTS = {"incompatible": "C3D8I", "plain": "C3D8"}
NODES = {0: 8, 1: 20}  # of a cell by its type
PER_LINE = 11
# Pa, of nodes far outside: CalculiX rounds the corner of the law of nodes over TENSION / stiffness (its manual asks for some
# thousandth of the largest pressure), without which its iterations jump to and fro.
TENSION = 4e6


class Part:
    """One body in the world: nodes, hexahedra, held nodes and the faces that may touch (element, side; from 1)."""

    def __init__(self, path, state, areas, offset):
        with results.open_file(path, "body") as file:
            self.X = file["mesh/X"][:] @ state["R"].T + state["r"]
            kinds = np.unique(file["mesh/cell_type"][:])
            if len(kinds) > 1 or kinds[0] not in NODES:
                sys.exit(f"{path}: this script knows bodies of hexahedra of 8 or of 20 nodes only")
            self.cells = file["mesh/cell_nodes"][:].reshape(-1, NODES[kinds[0]])
            self.averages = "stress/loaded" not in file
            self.element = "C3D20" if kinds[0] == 1 else ELEMENTS[results.text(file.attrs["element"])]
            self.free_dof = file["reduced/free_dof"][:]
            free, directions = np.unique(self.free_dof // 3, return_counts=True)
            if (directions != 3).any():
                sys.exit(f"{path}: some nodes are held in single directions, this script knows nodes that are held wholly only")
            self.held = np.setdiff1d(np.arange(len(self.X)), free)
            self.material = [float(file["material/0/" + name][()]) for name in ("E", "nu")]
            self.faces = {area: element_sides(self.cells, file["mesh/face_sets/" + area][:]) for area in areas}
            names = [results.text(name) for name in file["surface/group_name"][:]]
            touching = np.isin(file["surface/group"][:], [names.index(area) for area in areas])
            self.stiffness = float(file["surface/c_f"][:][touching].mean())  # Pa/m
        self.offset = offset  # of node numbers
        self.axis = state["R"][:, 2]


    def centres(self, area):
        return np.array([self.X[self.cells[cell, list(SIDES[side])]].mean(axis=0) for cell, side in self.faces[area]])


def mates(worm, wheel, pairs):
    """The worm's faces by pair of areas: each goes to the wheel's area that is nearest to it.

    CalculiX takes nodes that lie beside a master surface for nodes behind its faces, prolonged."""
    faces = {}
    for area in {areas[0] for areas in pairs}:
        teeth = [areas[1] for areas in pairs if areas[0] == area]
        distance = [np.linalg.norm(worm.centres(area)[:, None] - wheel.centres(tooth)[None], axis=2).min(axis=1) for tooth in teeth]
        for face, nearest in zip(worm.faces[area], np.argmin(distance, axis=0)):
            faces.setdefault((area, teeth[nearest]), []).append(face)
    return faces


def element_sides(cells, faces):
    """Sides of cells that are faces, or are made up of faces where cells are of second order."""
    on_faces = np.zeros(cells.max() + 1, dtype=bool)
    on_faces[np.ravel(faces)] = True
    sides = []
    for side, corners in enumerate(SIDES):
        local = corners + (MIDSIDES[side] if cells.shape[1] == 20 else ())
        for cell in np.flatnonzero(on_faces[cells[:, corners]].all(axis=1)):
            if np.isin(faces, cells[cell, local]).all(axis=1).any():
                sides.append((int(cell), side))
    return sides


def last_states(path):
    """Position and rotation of each body at the end of a result file."""
    with results.open_file(path, "result") as file:
        return {body: {"r": file[f"bodies/{body}/position"][-1], "R": file[f"bodies/{body}/rotation"][-1]}
                for body in BODIES}


def contact_points(file):
    """Contacts at the end of a result file: side of the slave (0: worm), its node, face, force on the node (N, world)."""
    points = file["contact/worm:wheel/points"]
    last = slice(*points["offset"][-2:])
    return zip(*(points[name][last] for name in ("slave_side", "slave_node", "face", "force")))


class Surface:
    """Contact surface of a body file: nodes of the mesh, faces, name of each face's area."""

    def __init__(self, path):
        with results.open_file(path, "body") as file:
            names = [results.text(name) for name in file["surface/group_name"][:]]
            self.node, self.face = file["surface/nodes"][:], file["surface/face"][:]
            self.area = [names[i] for i in file["surface/group"][:]]
        self.area_of_node = {node: area for face, area in zip(self.face, self.area) for node in face}


def contact_loads(result, surfaces):
    """Our contact forces at the end: {node of the mesh: N} of each body, and {(worm's area, wheel's): N on the wheel}."""
    loads, pairs = [], {}
    with results.open_file(result, "result") as file:
        for body, surface in zip(BODIES, surfaces):
            nodes, forces = results.nodal_forces(file, body, -1)
            loads.append(dict(zip(surface.node[nodes], forces)))
        for side, slave, face, force in contact_points(file):
            areas = (surfaces[side].area_of_node[slave], surfaces[1 - side].area[face])
            key = areas if side == 0 else areas[::-1]
            pairs[key] = pairs.get(key, 0) + (force if side == 1 else -force)
    return loads, pairs


def listed(numbers):
    """Numbers as lines of a set."""
    numbers = [str(n) for n in numbers]
    return "".join(", ".join(numbers[i:i + PER_LINE]) + ",\n" for i in range(0, len(numbers), PER_LINE))


def write_part(file, name, part, first_cell):
    file.write(f"*NODE, NSET=N{name}\n")
    for i, x in enumerate(part.X):
        file.write(f"{part.offset + i + 1}, {x[0]:.12e}, {x[1]:.12e}, {x[2]:.12e}\n")
    file.write(f"*ELEMENT, TYPE={part.element}, ELSET=E{name}\n")
    for i, cell in enumerate(part.cells):
        words = [str(first_cell + i)] + [str(part.offset + node + 1) for node in cell]
        file.write(", ".join(words[:PER_LINE]) + "".join(",\n" + ", ".join(words[at:at + PER_LINE]) for at in range(PER_LINE, len(words), PER_LINE)) + "\n")
    file.write(f"*MATERIAL, NAME=M{name}\n*ELASTIC\n{part.material[0]:.9g}, {part.material[1]:.9g}\n")
    file.write(f"*SOLID SECTION, ELSET=E{name}, MATERIAL=M{name}\n")
    file.write(f"*NSET, NSET=HELD{name}\n" + listed(part.offset + part.held + 1))


def write_surface(file, name, faces, first_cell):
    file.write(f"*SURFACE, NAME={name}, TYPE=ELEMENT\n")
    file.writelines(f"{first_cell + cell}, S{side + 1}\n" for cell, side in faces)


def surface_names(areas):
    """Slave and master of a pair of areas."""
    return "_".join(areas), areas[1]


def write_contact(file, worm, wheel, pairs, options):
    """The worm's held nodes turn as a rigid body about the world's x, its areas are the slaves; the node that turns it."""
    reference, turning = (wheel.offset + len(wheel.X) + i for i in (1, 2))
    stiffness = options.stiffness or 1 / (1 / worm.stiffness + 1 / wheel.stiffness)
    kind, tension = {"faces": ("SURFACE TO SURFACE", ""), "nodes": ("NODE TO SURFACE", f", {TENSION:g}")}[options.contact]
    for areas, faces in mates(worm, wheel, pairs).items():
        write_surface(file, surface_names(areas)[0], faces, 1)
    for area, faces in wheel.faces.items():
        write_surface(file, area, faces, 1 + len(worm.cells))
    for node in (reference, turning):
        file.write("*NODE\n{}, {:.12e}, {:.12e}, {:.12e}\n".format(node, *worm.X[worm.held].mean(axis=0)))
    file.write(f"*RIGID BODY, NSET=HELDworm, REF NODE={reference}, ROT NODE={turning}\n"
               "*SURFACE INTERACTION, NAME=CONTACT\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n"
               f"{stiffness:.9g}{tension}\n")
    for areas in pairs:
        file.write(f"*CONTACT PAIR, INTERACTION=CONTACT, TYPE={kind}\n" + ", ".join(surface_names(areas)) + "\n")
    file.write(f"*BOUNDARY\n{reference}, 1, 3\n{turning}, 2, 3\n*NSET, NSET=TURN\n{turning}\n")
    return turning


def write_forces(file, parts, loads):
    for part, load in zip(parts, loads):
        file.writelines(f"{part.offset + node + 1}, {i + 1}, {f:.12g}\n" for node, force in load.items() for i, f in enumerate(force))


def write_turning(file, parts, loads, pairs, options):
    """Our forces at our angle first, then contact under the torque: from that deformation the iterations find the contacts."""
    worm, wheel = parts
    turning = write_contact(file, worm, wheel, pairs, options)
    change = {word: "".join(f"*MODEL CHANGE, TYPE=CONTACT PAIR, {word}\n" + ", ".join(surface_names(areas)) + "\n" for areas in pairs)
              for word in ("REMOVE", "ADD")}
    file.write(f"*BOUNDARY\nHELDwheel, 1, 3\n*STEP\n*STATIC\n{change['REMOVE']}*BOUNDARY\n{turning}, 1, 1\n*CLOAD\n")
    write_forces(file, parts, loads)
    file.write(f"*END STEP\n*STEP, INC=200\n*STATIC\n{options.increment:g}, 1.\n{change['ADD']}*BOUNDARY, OP=NEW\nHELDwheel, 1, 3\n{turning - 1}, 1, 3\n{turning}, 2, 3\n"
               f"*CLOAD, OP=NEW\n{turning}, 1, {options.torque * np.sign(worm.axis[0]):.9g}\n"
               "*NODE PRINT, NSET=HELDwheel, TOTALS=ONLY, FREQUENCY=1000\nRF\n"
               "*NODE PRINT, NSET=TURN, FREQUENCY=1000\nU\n*NODE FILE, FREQUENCY=1000\nU\n*EL FILE, FREQUENCY=1000\nS\n")
    if options.contact == "faces":  # of nodes ccx 2.20 crashes at this card
        file.writelines(f"*CONTACT PRINT, SLAVE={a}, MASTER={b}, FREQUENCY=1000\nCF\n" for a, b in map(surface_names, pairs))
    file.write("*END STEP\n")


def write_deck(path, parts, loads, pairs, options):
    """Bodies, and contact under the torque or our contact forces, with both bodies held."""
    worm, wheel = parts
    if abs(abs(worm.axis[0]) - 1) > 1e-9:
        sys.exit("the worm's axis must be the world's x axis")
    with open(path, "w", encoding="utf-8") as file:
        write_part(file, "worm", worm, 1)
        write_part(file, "wheel", wheel, 1 + len(worm.cells))
        if options.contact != "forces":
            return write_turning(file, parts, loads, pairs, options)
        file.write("*BOUNDARY\nHELDworm, 1, 3\nHELDwheel, 1, 3\n*STEP\n*STATIC\n*CLOAD\n")
        write_forces(file, parts, loads)
        file.write("*NODE PRINT, NSET=HELDwheel, TOTALS=ONLY\nRF\n*NODE FILE\nU\n*EL FILE\nS\n*END STEP\n")


def read_field(path, name, n_components):
    """Nodal values of the last state in a .frd file: {node: components}."""
    values, reading = {}, False
    with open(path, encoding="ascii", errors="replace") as file:
        for line in file:
            if line.startswith(" -4"):
                reading = line.split()[1] == name
            elif line.startswith(" -3"):
                reading = False
            elif reading and line.startswith(" -1"):
                values[int(line[3:13])] = [float(line[13 + 12 * i:25 + 12 * i]) for i in range(n_components)]
    return values


def read_stress(path):
    """Nodal von Mises stress of the last state in a .frd file: {node: Pa}."""
    return {node: np.sqrt(((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2) / 2 + 3 * (xy**2 + yz**2 + zx**2))
            for node, (xx, yy, zz, xy, yz, zx) in read_field(path, "STRESS", 6).items()}


def write_displaced(path, result, job, parts, turn):
    """The result file `result` with CalculiX's displacements at its end, those of the worm without the angle by which it turned."""
    displacement = read_field(job + ".frd", "DISP", 3)
    shutil.copy(result, path)
    with h5py.File(path, "r+") as file:
        for body, part in zip(BODIES, parts):
            state = file["bodies/" + body]
            u = np.array([displacement[part.offset + node + 1] for node in range(len(part.X))])
            if body == "worm":
                u -= np.cross([turn or 0, 0, 0], part.X - state["position"][-1])
            state["q"][-1] = (u @ state["rotation"][-1]).ravel()[part.free_dof]


def read_prints(path):
    """What a .dat file prints: total reaction on the wheel (N), turn of the worm (rad), force on each pair (N), where they are."""
    values, pairs, heading = {}, {}, ""
    with open(path, encoding="ascii") as file:
        for line in file:
            try:
                row = [float(word) for word in line.split()]
            except ValueError:
                heading = line
                words = line.replace(",", " ").lower().split()
                if "slave" in words:
                    pair = tuple(words[words.index(side) + 2] for side in ("slave", "master"))
                continue
            if row and "total force" in heading:
                values["reaction"] = np.array(row)
            elif row and "displacements" in heading:
                values["turn"] = row[1]
            elif row and "total surface force" in heading:
                pairs[pair] = np.array(row[:3])
    return values["reaction"], values.get("turn"), pairs


def compare_stress(row, name, group, values):
    """Rows for one body: its most highly stressed node, the largest of all, both tables over all nodes."""
    ours = group["von_mises"][-1]
    peak = int(ours.argmax())
    row(f"{name} root node {group['nodes'][peak]}, MPa", ours[peak] / 1e6, values[peak] / 1e6)
    row(f"{name} root, largest, MPa", ours.max() / 1e6, values.max() / 1e6)
    row(f"{name} root, mean, MPa", ours.mean() / 1e6, values.mean() / 1e6)
    print(f"{name} root, all nodes: {100 * np.linalg.norm(values - ours) / np.linalg.norm(ours):.2f} % (root sum of squares)")


def compare(options, worm, wheel, pairs, job):
    theirs = read_stress(job + ".frd")
    reaction, turn, pairs_there = read_prints(job + ".dat")
    print(f"{'':<40}{'elastogear':>14}{'CalculiX':>14}{'deviation':>12}")

    def row(name, a, b):
        print(f"{name:<40}{a:>14.6g}{b:>14.6g}{100 * (b / a - 1):>10.2f} %")
    row("contact force, N", np.linalg.norm(sum(pairs.values())), np.linalg.norm(reaction))
    for areas, force in pairs.items():
        if surface_names(areas) in pairs_there:
            row(" - ".join(areas) + ", N", np.linalg.norm(force), np.linalg.norm(pairs_there[surface_names(areas)]))
        else:
            print(f"{' - '.join(areas) + ', N':<40}{np.linalg.norm(force):>14.6g}")
    if turn is not None:
        print(f"turn of the worm from our equilibrium: {turn:.3e} rad")
    if not (worm.averages and wheel.averages):
        print("stresses of the bodies come from free surfaces, CalculiX's are means: recover those of its displacements from turn_in.h5")
        return
    with results.open_file(options.stress, "stress") as file:
        for body, part in (("worm", worm), ("wheel", wheel)):
            group = file[body]["root"]
            compare_stress(row, body, group, np.array([theirs[part.offset + int(node) + 1] for node in group["nodes"][:]]))


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("worm", help="body files in the full basis")
    parser.add_argument("wheel")
    parser.add_argument("result", help="of the static analysis")
    parser.add_argument("stress", help="recovered from it")
    parser.add_argument("--torque", type=float, default=4, help="N m")
    parser.add_argument("--stiffness", type=float, default=0,
                        help="Pa/m, of the contact pressure over the depth; default: as ours, both sides in series")
    parser.add_argument("--contact", default="faces", choices=("faces", "nodes", "forces"))
    parser.add_argument("--increment", type=float, default=1, help="first share of the torque")
    parser.add_argument("--out", default=".", help="folder of the deck")
    parser.add_argument("--read-only", action="store_true", help="the results of ccx are there already")
    return parser.parse_args()


def main():
    options = parse()
    os.makedirs(options.out, exist_ok=True)
    states = last_states(options.result)
    loads, pairs = contact_loads(options.result, [Surface(options.worm), Surface(options.wheel)])
    worm = Part(options.worm, states["worm"], sorted({areas[0] for areas in pairs}), 0)
    wheel = Part(options.wheel, states["wheel"], sorted({areas[1] for areas in pairs}), len(worm.X))
    job = os.path.join(options.out, "turn_in")
    if not options.read_only:
        write_deck(job + ".inp", (worm, wheel), loads, pairs, options)
        with open(job + ".log", "w", encoding="utf-8") as log:
            subprocess.run(["ccx", "turn_in"], cwd=options.out, stdout=log, stderr=subprocess.STDOUT, check=True)
    compare(options, worm, wheel, pairs, job)
    write_displaced(job + ".h5", options.result, job, (worm, wheel), read_prints(job + ".dat")[1])


if __name__ == "__main__":
    main()
