#!/usr/bin/python3
"""The cylinder on a block of NAFEMS (A. Konter, Advanced Finite Element Contact Benchmarks, FENET 2006, CB1) beside H. Hertz
and CalculiX on the same mesh:

    studies/cylinder_on_block.py --elastogear build/release/src/app/elastogear --calculix ccx --out FOLDER [--faces 8]

Plane strain, half of it by symmetry, one layer of hexahedra: a cylinder of R = 50 mm, E = 210 GPa, presses with 35 kN/mm on a
block of 200 mm x 200 mm, E = 70 GPa, nu = 0.3. Hertz: p_0 = 3585.37 MPa, half width a = 6.21 mm. The cylinder hangs on a
rigid pin of R_PIN about its centre, which slides down under the load, in both programs. --faces: of the block across the
patch; those of the cylinder are 0.8 times as long, so that the meshes do not match. --friction: its coefficient; nodes stick
up to it, and the load comes in LOAD_STEPS steps.
"""
import argparse
import os
import subprocess
import sys

import numpy as np

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
import figures
import results

R, R_PIN, SIZE, THICKNESS = 50e-3, 10e-3, 200e-3, 1e-3  # m
E_CYLINDER, E_BLOCK, NU = 210e9, 70e9, 0.3  # Pa
E_STAR = 1 / ((1 - NU**2) * (1 / E_CYLINDER + 1 / E_BLOCK))
FINE = 1.6  # half widths, along which faces are of equal length
GROWTH = 1.25
PUSHED = 0.6e-3 / 35e6  # m, before a load of 1 N/m acts in CalculiX
LOAD_STEPS = 40  # with friction


class Load:
    """On the half (N), Hertz's pressure (Pa) and half width (m) of a load in N/m."""

    def __init__(self, line_load):
        self.line_load = line_load
        self.force = line_load * THICKNESS / 2
        self.p_0 = np.sqrt(line_load * E_STAR / (np.pi * R))
        self.half_width = 2 * line_load / (np.pi * self.p_0)


def graded(h, length, fine):
    """Places from 0 to `length`: steps of h up to `fine`, then growing."""
    places = list(np.linspace(0, fine, int(np.ceil(fine / h)) + 1))
    steps = [h * GROWTH**(i + 1) for i in range(200)]
    n = int(np.searchsorted(np.cumsum(steps), length - fine)) + 1
    steps = np.array(steps[:n])
    return np.array(places + list(fine + np.cumsum(steps) * (length - fine) / steps.sum()))


def halved(places):
    """With the middles between them."""
    return np.insert(places, np.arange(1, len(places)), (places[1:] + places[:-1]) / 2)


class Mesh:
    """Hexahedra of 8 (order 1) or 20 nodes between points of a plane, at z = 0 and THICKNESS. x, y: points [i, j]; of order 2
    those of even i and j are corners, the others middles."""

    def __init__(self, x, y, order):
        i, j, k = np.meshgrid(*(np.arange(n) for n in (*x.shape, order + 1)), indexing="ij")
        used = ((i % order) + (j % order) + (k % order) <= 1).ravel(order="F")
        number = np.where(used, np.cumsum(used) - 1, -1).reshape(i.shape, order="F")
        self.X = np.stack([x[i, j], y[i, j], THICKNESS * k / order], axis=-1).reshape(-1, 3, order="F")[used]
        self.order = order
        corners = [(0, 0), (order, 0), (order, order), (0, order)]
        middles = [(1, 0), (order, 1), (1, order), (0, 1)] if order == 2 else []
        local = [(*c, z) for z in (0, order) for c in corners] + [(*m, z) for z in (0, order) for m in middles]
        local += [(*c, 1) for c in corners] if order == 2 else []
        firsts = [(a, b) for a in range(0, x.shape[0] - 1, order) for b in range(0, x.shape[1] - 1, order)]
        self.cells = [[number[a + di, b + dj, dk] for di, dj, dk in local] for a, b in firsts]
        self.top = [c for c, (_, b) in enumerate(firsts) if b == x.shape[1] - 1 - order]


def block(h, order, fine):
    x, y = graded(h, SIZE / 2, fine), -graded(h, SIZE, fine)[::-1]
    x, y = (halved(x), halved(y)) if order == 2 else (x, y)
    return Mesh(*np.meshgrid(x, y, indexing="ij"), order)


def cylinder(h, order, fine):
    """From the pin to the outside, from the bottom round to the side; the point of contact is the origin."""
    angle = graded(h / R, np.pi / 2, fine / R)[::-1]
    r = R - graded(h, R - R_PIN, fine)[::-1]
    angle, r = (halved(angle), halved(r)) if order == 2 else (angle, r)
    a, radius = np.meshgrid(angle, r, indexing="ij")
    return Mesh(radius * np.sin(a), R - radius * np.cos(a), order)


def nodes_where(mesh, condition):
    return np.flatnonzero(condition(mesh.X)) + 1


def listed(numbers):
    return "".join(f"{n},\n" for n in numbers)


def part(name, mesh, first_node, first_cell, held):
    """Nodes, elements, sets of held nodes and the surface that touches, in the words of Abaqus."""
    text = f"*NODE, NSET=N{name}\n"
    text += "".join(f"{first_node + i + 1}, {x[0]:.12e}, {x[1]:.12e}, {x[2]:.12e}\n" for i, x in enumerate(mesh.X))
    text += f"*ELEMENT, TYPE={'C3D8I' if mesh.order == 1 else 'C3D20'}, ELSET=E{name}\n"
    text += "".join(f"{first_cell + i + 1}, " + ", ".join(str(first_node + n + 1) for n in cell[:12]) +
                    (",\n" + ", ".join(str(first_node + n + 1) for n in cell[12:]) if cell[12:] else "") + "\n"
                    for i, cell in enumerate(mesh.cells))
    for key, nodes in held.items():
        text += f"*NSET, NSET={key}{name}\n" + listed(first_node + nodes)
    side = 5  # nodes 3, 4, 8, 7
    text += f"*SURFACE, NAME=TOUCH{name}, TYPE=ELEMENT\n" + "".join(f"{first_cell + c + 1}, S{side}\n" for c in mesh.top)
    return text


def sets(mesh, is_cylinder):
    distance = lambda X: np.hypot(X[:, 0], X[:, 1] - R)
    base = (lambda X: distance(X) < R_PIN * (1 + 1e-6)) if is_cylinder else (lambda X: X[:, 1] < -SIZE * (1 - 1e-6))
    return {"BASE": nodes_where(mesh, base), "SIDE": nodes_where(mesh, lambda X: X[:, 0] < 1e-9),
            "SLICE": nodes_where(mesh, lambda X: X[:, 0] < 1)}


def run(command, folder, log):
    with open(os.path.join(folder, log), "w", encoding="utf-8") as out:
        subprocess.run(command, cwd=folder, stdout=out, stderr=subprocess.STDOUT, check=True)


def elastogear(program, folder, parts, load, points, law, mu):
    """Displacement of the pin (m) and largest pressure (Pa)."""
    for name, E in (("cylinder", E_CYLINDER), ("block", E_BLOCK)):
        with open(os.path.join(folder, name + ".inp"), "w", encoding="utf-8") as file:
            file.write(parts[name])
        with open(os.path.join(folder, name + ".yaml"), "w", encoding="utf-8") as file:
            file.write(f"mesh: {name}.inp\nmaterial: {{E: {E:.15g}, nu: {NU}, rho: 7850}}\n"
                       f"restrain: [BASE{name}, 'SIDE{name}:x', 'SLICE{name}:z']\nsurface: [TOUCH{name}]\nmodes: 10\noutput: {name}.h5\n")
        if not os.path.exists(os.path.join(folder, name + ".h5")):
            run([program, "reduce", name + ".yaml"], folder, f"reduce_{name}.log")
    friction = f", friction: {mu:g}, friction_law: stick" if mu else ""
    with open(os.path.join(folder, "press.yaml"), "w", encoding="utf-8") as file:
        file.write("bodies: [cylinder, block]\nblock: {file: block.h5, joint: fixed}\n"
                   "cylinder: {file: cylinder.h5, joint: prismatic, axis: [0, -1, 0], force: %.15g}\n"
                   "contact: {pairs: [cylinder:block], law: %s, points: %s, surface: smooth, two_pass: false%s}\n"
                   "analysis: static\nstatic_steps: %d\nsimulate: {output: press.h5}\n"
                   % (load.force, law, points, friction, LOAD_STEPS if mu else 10))
    run([program, "simulate", "press.yaml"], folder, f"press_{points}_{law}.log")
    with results.open_file(os.path.join(folder, "press.h5"), "result") as file:
        return float(file["bodies/cylinder/rigid"][-1, 0]), float(file["contact/cylinder:block/pressure"][-1])


def calculix(program, folder, parts, load, held, offset, mu, stiffness):
    """Displacement of the pin, m, and largest contact pressure, Pa; face-to-face contact with a penalty (Pa/m)."""
    with open(os.path.join(folder, "cb1.inp"), "w", encoding="utf-8") as file:
        file.write(parts["block"] + parts["cylinder_after_block"])
        for name, E in (("cylinder", E_CYLINDER), ("block", E_BLOCK)):
            file.write(f"*MATERIAL, NAME=M{name}\n*ELASTIC\n{E:.15g}, {NU}\n*SOLID SECTION, ELSET=E{name}, MATERIAL=M{name}\n")
        pin = held["BASE"] + offset
        friction = f"*FRICTION\n{mu:g}, {stiffness:.9g}\n" if mu else ""
        file.write("*SURFACE INTERACTION, NAME=CONTACT\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n"
                   f"{stiffness:.9g}\n{friction}*CONTACT PAIR, INTERACTION=CONTACT, TYPE=SURFACE TO SURFACE\n"
                   "TOUCHcylinder, TOUCHblock\n")
        file.write("*EQUATION\n" + "".join(f"2\n{n}, 2, 1., {pin[0]}, 2, -1.\n" for n in pin[1:]))
        held_nodes = "BASEblock, 1, 3\nBASEcylinder, 1, 1\nBASEcylinder, 3, 3\n" + "".join(
            f"SIDE{name}, 1, 1\nSLICE{name}, 3, 3\n" for name in ("cylinder", "block"))
        # Pushed into contact first: without it nothing holds the cylinder.
        file.write(f"*NSET, NSET=PIN\n{pin[0]},\n*STEP, INC=200\n*STATIC\n0.1, 1.\n*BOUNDARY\n{held_nodes}{pin[0]}, 2, 2, {-PUSHED * load.line_load}\n*END STEP\n"
                   f"*STEP, INC=200\n*STATIC\n0.2, 1.\n*BOUNDARY, OP=NEW\n{held_nodes}*CLOAD\n{pin[0]}, 2, {-load.force:.12e}\n"
                   "*NODE PRINT, NSET=PIN, FREQUENCY=1000\nU\n*CONTACT FILE, FREQUENCY=1000\nCDIS, CSTR\n*END STEP\n")
    run([program, "cb1"], folder, "ccx.log")
    with open(os.path.join(folder, "cb1.dat"), encoding="ascii") as file:
        rows = [line.split() for line in file if len(line.split()) == 4 and line.split()[0].isdigit()]
    return -float(rows[-1][2]), largest_pressure(os.path.join(folder, "cb1.frd"))


def largest_pressure(path):
    """The largest of the fourth component of CONTACT in the last state of a .frd file."""
    largest, reading = 0.0, False
    with open(path, encoding="ascii", errors="replace") as file:
        for line in file:
            if line.startswith(" -4"):
                reading = line.split()[1] == "CONTACT"
                largest = 0.0 if reading else largest
            elif line.startswith(" -3"):
                reading = False
            elif reading and line.startswith(" -1"):
                largest = max(largest, float(line[13 + 36:25 + 36]))
    return largest


def rows(options, program, folder, load, h):
    """Contact, displacement of the pin (m) and largest pressure (Pa), with faces of h on the block."""
    fine = FINE * load.half_width
    meshes = {"block": block(h, options.order, fine), "cylinder": cylinder(0.8 * h, options.order, fine)}
    held = {name: sets(mesh, name == "cylinder") for name, mesh in meshes.items()}
    parts = {name: part(name, mesh, 0, 0, held[name]) for name, mesh in meshes.items()}
    offset = len(meshes["block"].X)
    parts["cylinder_after_block"] = part("cylinder", meshes["cylinder"], offset, len(meshes["block"].cells), held["cylinder"])
    for points in options.points:
        for law in options.laws:
            yield f"{points}, {law}", *elastogear(program, folder, parts, load, points, law, options.friction)
    for factor in options.stiffness:
        yield f"CalculiX, {factor:g} E/a", *calculix(options.calculix, folder, parts, load, held["cylinder"], offset, options.friction,
                                                     factor * E_BLOCK / load.half_width)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--calculix", default="ccx")
    parser.add_argument("--out", required=True)
    parser.add_argument("--friction", type=float, default=0)
    parser.add_argument("--load", type=float, default=35, help="kN/mm")
    parser.add_argument("--points", nargs="*", default=["nodes", "faces"])
    parser.add_argument("--laws", nargs="+", default=["penalty", "unilateral"])
    parser.add_argument("--order", type=int, choices=(1, 2), default=1, help="of the cells: 8 or 20 nodes")
    parser.add_argument("--stiffness", type=float, nargs="*", default=[50], help="of CalculiX's penalty, E of the block over the half width")
    parser.add_argument("--faces", type=float, nargs="+", default=[4, 8, 16])
    options = parser.parse_args()
    program = os.path.abspath(options.elastogear)
    load = Load(1e6 * options.load)
    print(f"Hertz: {load.p_0 / 1e6:.2f} MPa, half width {1e3 * load.half_width:.3f} mm")
    print("faces  contact                pressure [MPa]  of Hertz    pin [mm]")
    for faces in options.faces:
        folder = os.path.join(options.out, f"{faces:g}")
        os.makedirs(folder, exist_ok=True)
        for name, pin, pressure in rows(options, program, folder, load, 2 * load.half_width / faces):
            print(f"{faces:5g}  {name:20s}  {pressure / 1e6:14.1f}  {100 * (pressure / load.p_0 - 1):+7.2f} %  {1e3 * pin:10.5f}", flush=True)
            figures.figure(f"cylinder on a block, {name}", f"peak pressure, {faces:g} faces", pressure / load.p_0 - 1, unit="%")


if __name__ == "__main__":
    main()
