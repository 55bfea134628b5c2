#!/usr/bin/python3
"""First frequency of a block, held at one end, by cells of every kind as its material becomes incompressible: the table of docs/theory,
section 1.1. locking.py --elastogear PATH --out FOLDER"""
import argparse
import os
import random
import subprocess

import h5py

SIZE = (0.04, 0.02, 0.02)  # m
CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
OF_HEXAHEDRON = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
OF_TETRAHEDRON = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
WHOLE = (tuple(range(8)),)
SIX_TETRAHEDRA = ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6))
TWO_WEDGES = ((0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7))
CELLS = {"hex8": ("C3D8", WHOLE, ()), "hex20": ("C3D20", WHOLE, OF_HEXAHEDRON), "wedge6": ("C3D6", TWO_WEDGES, ()),
         "tet4": ("C3D4", SIX_TETRAHEDRA, ()), "tet10": ("C3D10", SIX_TETRAHEDRA, OF_TETRAHEDRON)}
KINDS = (("hex8", "bbar"), ("hex8", "incompatible"), ("hex8", "plain"), ("hex20", None), ("tet10", None), ("tet4", None), ("wedge6", None))


def positions(n, moved):
    """Of the corners of 2n x n x n bricks, those inside moved at random by up to `moved` edges in each direction."""
    draw, counts = random.Random(3), (2 * n, n, n)
    places = {}
    for i in range(2 * n + 1):
        for j in range(n + 1):
            for k in range(n + 1):
                steps = [moved * draw.uniform(-1, 1) if 0 < at < most else 0 for at, most in zip((i, j, k), counts)]
                places[i, j, k] = [(at + step) * size / most for at, step, size, most in zip((i, j, k), steps, SIZE, counts)]
    return places


def write_mesh(path, kind, n, moved):
    element, parts, edges = CELLS[kind]
    places, numbers, X, cells = positions(n, moved), {}, [], []

    def node(*corners):
        """The number of a corner, or of the node in the middle of two."""
        if corners not in numbers:
            numbers[corners] = len(numbers) + 1
            X.append([sum(values) / len(corners) for values in zip(*(places[corner] for corner in corners))])
        return numbers[corners]

    for i in range(2 * n):
        for j in range(n):
            for k in range(n):
                brick = [(i + a, j + b, k + c) for a, b, c in CORNERS]
                for part in parts:
                    corners = [brick[c] for c in part]
                    cells.append([node(c) for c in corners] + [node(*sorted((corners[a], corners[b]))) for a, b in edges])
    with open(path, "w", encoding="utf-8") as file:
        file.write("*NODE\n" + "".join(f"{i + 1}, {x:.12g}, {y:.12g}, {z:.12g}\n" for i, (x, y, z) in enumerate(X)))
        file.write(f"*ELEMENT, TYPE={element}, ELSET=ALL\n")
        for i, nodes in enumerate(cells):
            words = [str(word) for word in (i + 1, *nodes)]
            file.write(", ".join(words[:15]) + (",\n" + ", ".join(words[15:]) if len(words) > 15 else "") + "\n")
        file.write("*NSET, NSET=END\n" + "\n".join(str(i + 1) for i, (x, _, _) in enumerate(X) if x == 0) + "\n")


def first_frequency(options, mesh, nu, element):
    body = os.path.join(options.out, "block.h5")
    command = [options.elastogear, "reduce", "-mesh", mesh, "-material_E", "10e6", "-material_nu", str(nu), "-material_rho", "1000", "-restrain", "END",
               "-basis", "modal", "-modes", "2", "-output", body] + (["-element", element] if element else [])
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with h5py.File(body) as file:
        return file["modes/frequency"][0]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True)
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    mesh = os.path.join(options.out, "block.inp")
    print("nu      " + "".join(f"{element or kind:>22}" for kind, element in KINDS) + "   (bricks / moved nodes)")
    for nu in (0.3, 0.45, 0.49, 0.499, 0.4999):
        write_mesh(mesh, "hex20", 6, 0)
        reference = first_frequency(options, mesh, nu, None)
        row = ""
        for kind, element in KINDS:
            errors = []
            for moved in (0, 0.2):
                write_mesh(mesh, kind, 4, moved)
                errors.append(100 * (first_frequency(options, mesh, nu, element) / reference - 1))
            row += f"{errors[0]:>11.2f} /{errors[1]:>7.2f} %"
        print(f"{nu:<8}{row}", flush=True)


if __name__ == "__main__":
    main()
