#!/usr/bin/python3
"""Makes the meshes of this folder, and bars of other sizes for tests:

    meshes/make.py bar NX NY NZ DX DY DZ    > bar.inp     hexahedra, sizes in m
    meshes/make.py roller R A N             > roller.inp  slice of a roller of radius R, N cells over the half width A of
                                                          a line contact at its top, in m
    meshes/make.py tetrahedra N             > bar.msh     cubes of 10 mm, each of six tetrahedra, in mm
    meshes/make.py all                                    every file of this folder anew
"""
import itertools
import math
import os
import sys

CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
GROWTH, FINE, REACH, THICKNESS = 1.6, 1.2, 50, 1e-3  # of the roller: from cell to cell, half widths of fine cells and of all, m
GROUPS = ((2, "left"), (2, "right"), (2, "top"), (3, "body"))  # physical groups of the tetrahedra


def inp(n, position, sets, is_top):
    """n[0] x n[1] x n[2] hexahedra as .inp: nodes (i, j, k) at position(i, j, k), node sets by name, each of the nodes for which
    its function is true, and the surface TOP of the cells (i, j) at the largest k for which is_top(i) is true."""
    def node(i, j, k):
        return 1 + k + (n[2] + 1) * (j + (n[1] + 1) * i)
    nodes = list(itertools.product(*(range(m + 1) for m in n)))
    lines = ["*NODE"] + [", ".join([str(node(*at))] + [f"{x:.9g}" for x in position(*at)]) for at in nodes]
    cells = list(itertools.product(*(range(m) for m in n)))
    lines.append("*ELEMENT, TYPE=C3D8, ELSET=ALL")
    for e, cell in enumerate(cells, 1):
        lines.append(", ".join(str(x) for x in [e] + [node(*(cell[a] + c[a] for a in range(3))) for c in CORNERS]))
    for name, holds in sets.items():
        lines += [f"*NSET, NSET={name}"] + [str(node(*at)) for at in nodes if holds(*at)]
    lines.append("*SURFACE, NAME=TOP, TYPE=ELEMENT")
    lines += [f"{e}, S2" for e, cell in enumerate(cells, 1) if cell[2] == n[2] - 1 and is_top(cell[0])]
    return "\n".join(lines) + "\n"


def bar(n, d):
    """n[0] x n[1] x n[2] hexahedra of the sizes d: node sets FIX (x = 0) and END, surface TOP at the largest z."""
    sets = {"FIX": lambda i, j, k: i == 0, "END": lambda i, j, k: i == n[0]}
    return inp(n, lambda *at: (d[a] * at[a] for a in range(3)), sets, lambda i: True)


def graded(h, fine, end):
    """From 0: cells of size h up to `fine`, then each larger by GROWTH up to `end`."""
    x = [0.0]
    while x[-1] < end:
        h *= GROWTH if x[-1] > fine - h / 2 else 1
        x.append(end if end - x[-1] < 1.5 * h else x[-1] + h)
    return x


def roller(radius, a, n):
    """Slice of a roller, THICKNESS along y, its crown at the origin, 2 REACH a wide and REACH a deep, in m; n cells over a.
    Node sets BASE, SLICE (all nodes) and AXIS (x = 0), surface TOP about the crown."""
    half, z = graded(a / n, FINE * a, REACH * a), graded(a / n, FINE * a, REACH * a)
    x = [-s for s in half[:0:-1]] + half

    def position(i, j, k):
        depth, crown = z[-1 - k], math.sqrt(radius**2 - x[i]**2) - radius
        return x[i], (j - 0.5) * THICKNESS, crown * (1 - depth / z[-1]) - depth
    sets = {"BASE": lambda i, j, k: k == 0, "SLICE": lambda i, j, k: True, "AXIS": lambda i, j, k: x[i] == 0}
    return inp((len(x) - 1, 1, len(z) - 1), position, sets, lambda i: max(abs(x[i]), abs(x[i + 1])) < FINE * a + 1.5 * a / n)


def tetrahedra(n):
    """n cubes of 10 mm along x, each of six tetrahedra, as MSH 4.1 in mm: physical surfaces left (x = 0), right and top."""
    def node(i, at):
        return 1 + at[2] + 2 * (at[1] + 2 * (i + at[0]))
    sides, cells = ([], [], []), []
    for i in range(n):
        for order in ((0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (1, 0, 2), (2, 1, 0)):
            path = [[int(axis in order[:m]) for axis in range(3)] for m in range(4)]  # from corner 000 to 111
            t = [node(i, at) for at in path]
            even = order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
            cells.append(t if even else [t[0], t[2], t[1], t[3]])
            if i == 0 and order[2] == 0:
                sides[0].append(t[:3])
            if i == n - 1 and order[0] == 0:
                sides[1].append(t[1:])
            if order[0] == 2:
                sides[2].append(t[1:])
    return msh(n, sides, cells)


def msh(n, sides, cells):
    nodes = [f"{10 * i} {10 * j} {10 * k}" for i in range(n + 1) for j in range(2) for k in range(2)]
    lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(GROUPS))]
    lines += [f'{dim} {tag} "{name}"' for tag, (dim, name) in enumerate(GROUPS, 1)] + ["$EndPhysicalNames"]
    lines += ["$Entities", "0 0 3 1"] + [f"{g} 0 0 0 1 1 1 1 {g} 0" for g in (1, 2, 3)] + ["1 0 0 0 1 1 1 1 4 0", "$EndEntities"]
    lines += ["$Nodes", f"1 {len(nodes)} 1 {len(nodes)}", f"3 1 0 {len(nodes)}"] + [str(m + 1) for m in range(len(nodes))] + nodes
    blocks = [(2, g, 2, side) for g, side in enumerate(sides, 1)] + [(3, 1, 4, cells)]
    total = sum(len(block[3]) for block in blocks)
    lines += ["$EndNodes", "$Elements", f"4 {total} 1 {total}"]
    numbers = itertools.count(1)
    for dim, tag, kind, cells_of_block in blocks:
        lines.append(f"{dim} {tag} {kind} {len(cells_of_block)}")
        lines += [" ".join(str(x) for x in [next(numbers), *cell]) for cell in cells_of_block]
    return "\n".join(lines + ["$EndElements"]) + "\n"


def main():
    word, *numbers = sys.argv[1:] or ["help"]
    if word == "bar" and len(numbers) == 6:
        print(bar([int(x) for x in numbers[:3]], [float(x) for x in numbers[3:]]), end="")
    elif word == "roller" and len(numbers) == 3:
        print(roller(float(numbers[0]), float(numbers[1]), int(numbers[2])), end="")
    elif word == "tetrahedra" and len(numbers) == 1:
        print(tetrahedra(int(numbers[0])), end="")
    elif word == "all":
        folder = os.path.dirname(os.path.abspath(__file__))
        files = {"bar.inp": bar((20, 2, 2), (0.05, 0.025, 0.025)), "beam.inp": bar((40, 1, 1), (0.25, 0.0774596669, 0.1161895)),
                 "roller.inp": roller(10e-3, 86.7e-6, 5), "bar.msh": tetrahedra(8)}
        for name, text in files.items():
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
