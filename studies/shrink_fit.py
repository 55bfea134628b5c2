#!/usr/bin/python3
"""Order of convergence of contact on a curved interface whose meshes do not match: two shrink-fitted rings in plane strain
beside G. Lame, one layer of hexahedra with 8 or 20 nodes:

    studies/shrink_fit.py --elastogear build/release/src/app/elastogear --out FOLDER [--points faces nodes] [--basis modal_residual full]

Radii 20, 30 and 45 mm, steel on steel, 50 um of interference (contact_offset). The inner ring has 3/4 as many cells round as the
outer one. Printed: error of the pressure in the mean and at the worst of all slave nodes, and of the elastic energy.
"""
import argparse
import os
import subprocess
import sys

import numpy as np

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
import results

BORE, JOINT, OUTSIDE, THICKNESS = 20e-3, 30e-3, 45e-3, 2e-3  # m
E, NU, INTERFERENCE = 210e9, 0.3, 50e-6  # Pa, -, m
E_PLANE = E / (1 - NU**2)


def lame():
    """Pressure (Pa) and elastic energy (J)."""
    p = INTERFERENCE * E_PLANE / JOINT / ((OUTSIDE**2 + JOINT**2) / (OUTSIDE**2 - JOINT**2) + (JOINT**2 + BORE**2) / (JOINT**2 - BORE**2))
    return p, 0.5 * p * INTERFERENCE * 2 * np.pi * JOINT * THICKNESS


# Places of a hexahedron's nodes in halves of a cell: round, outwards, along the axis.
CORNERS = [(0, 0, 0), (0, 2, 0), (2, 2, 0), (2, 0, 0), (0, 0, 2), (0, 2, 2), (2, 2, 2), (2, 0, 2)]
SIDES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
MIDDLES = [tuple((a + b) // 2 for a, b in zip(CORNERS[i], CORNERS[j])) for i, j in SIDES]


def ring(inside, outside, n_round, n_out, quadratic, touching):
    """The text of an Abaqus file; touching: the side of the cells, and their row outwards, that touch."""
    places = CORNERS + MIDDLES if quadratic else CORNERS
    node, cells = {}, []
    for i in range(n_round):
        for j in range(n_out):
            cells.append([node.setdefault(((2 * i + a) % (2 * n_round), 2 * j + b, c), len(node) + 1) for a, b, c in places])
    text = "*NODE\n"
    for (i, j, k), number in node.items():
        angle, r = np.pi * i / n_round, inside + (outside - inside) * j / (2 * n_out)
        text += f"{number}, {r * np.cos(angle):.15e}, {r * np.sin(angle):.15e}, {THICKNESS * k / 2:.15e}\n"
    text += f"*ELEMENT, TYPE={'C3D20' if quadratic else 'C3D8I'}, ELSET=ALL\n"
    for number, cell in enumerate(cells, 1):
        line = ", ".join(map(str, cell))
        text += f"{number}, " + (", ".join(map(str, cell[:15])) + ",\n" + ", ".join(map(str, cell[15:])) if quadratic else line) + "\n"
    for name, chosen in (("ALONG_X", lambda at: at[0] % n_round == 0), ("ALONG_Y", lambda at: at[0] % n_round == n_round // 2),
                         ("SLICE", lambda at: True)):
        text += f"*NSET, NSET={name}\n" + "".join(f"{number},\n" for at, number in node.items() if chosen(at))
    side, row = touching
    text += "*SURFACE, NAME=TOUCH, TYPE=ELEMENT\n" + "".join(
        f"{i * n_out + (row if row >= 0 else n_out - 1) + 1}, {side}\n" for i in range(n_round))
    return text


def run(command, folder, log):
    with open(os.path.join(folder, log), "w", encoding="utf-8") as out:
        subprocess.run(command, cwd=folder, stdout=out, stderr=subprocess.STDOUT, check=True)


def errors(program, folder, n, elements, points, basis):
    """Of the pressure: mean and largest; of the energy; relative."""
    quadratic = elements == "hex20"
    for name, text in (("inner", ring(BORE, JOINT, 3 * n // 4, n // 16, quadratic, ("S4", -1))),
                       ("outer", ring(JOINT, OUTSIDE, n, n // 16, quadratic, ("S6", 0)))):
        with open(os.path.join(folder, name + ".inp"), "w", encoding="utf-8") as file:
            file.write(text)
        with open(os.path.join(folder, name + ".yaml"), "w", encoding="utf-8") as file:
            file.write(f"mesh: {name}.inp\nmaterial: {{E: {E:.15g}, nu: {NU}, rho: 7850}}\n"
                       f"restrain: ['ALONG_X:y', 'ALONG_Y:x', 'SLICE:z']\nsurface: [TOUCH]\nmodes: 5\nbasis: {basis}\noutput: {name}.h5\n")
        run([program, "reduce", name + ".yaml"], folder, f"reduce_{name}.log")
    with open(os.path.join(folder, "fit.yaml"), "w", encoding="utf-8") as file:
        file.write("bodies: [outer, inner]\ninner: {file: inner.h5, joint: fixed}\nouter: {file: outer.h5, joint: fixed}\n"
                   f"contact: {{pairs: ['outer:inner'], law: unilateral, points: {points}, offset: -{INTERFERENCE}}}\n"
                   "analysis: static\nstatic_steps: 1\nsimulate: {output: fit.h5}\n")
    run([program, "simulate", "fit.yaml"], folder, "fit.log")
    with results.open_file(os.path.join(folder, "fit.h5"), "result") as file:
        at = file["contact/outer:inner/points"]
        pressure = at["pressure"][at["offset"][-2]:]
        energy = sum(file[f"energy/{part}"][-1] for part in ("elastic", "residual") if f"energy/{part}" in file)
    p, stored = lame()
    return np.sqrt(np.mean((pressure / p - 1)**2)), np.max(np.abs(pressure / p - 1)), abs(energy / stored - 1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--elements", nargs="+", default=["hex8", "hex20"])
    parser.add_argument("--points", nargs="+", default=["faces", "nodes"])
    parser.add_argument("--basis", nargs="+", default=["modal_residual"])
    parser.add_argument("--cells", type=int, nargs="+", default=[32, 64, 128, 256], help="of the outer ring, round; multiples of 32")
    options = parser.parse_args()
    print(f"pressure {lame()[0] / 1e6:.3f} MPa")
    os.makedirs(options.out, exist_ok=True)
    for basis in options.basis:
        for elements in options.elements:
            for points in options.points:
                before = None
                for n in options.cells:
                    now = np.array(errors(os.path.abspath(options.elastogear), options.out, n, elements, points, basis))
                    order = "" if before is None else "  orders " + " ".join(f"{o:5.2f}" for o in np.log2(before / now))
                    print(f"{basis} {elements:6s} {points:6s} {n:4d} cells: pressure {now[0]:.2e}, worst {now[1]:.2e}, energy {now[2]:.2e}{order}",
                          flush=True)
                    before = now


if __name__ == "__main__":
    main()
