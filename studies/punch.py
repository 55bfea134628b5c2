#!/usr/bin/python3
"""The punch with rounded edges of NAFEMS (Konter 2006, contact benchmark 2) with and without friction, beside an independent solution.

    studies/punch.py --elastogear build/release/src/app/elastogear --out FOLDER [--cells 6] [--size 4] [--axisymmetric 2 1 0.5]

A steel cylinder of 100 x 100 mm (diameter, height) whose lower edge is rounded by 10 mm is pressed on a cylinder of aluminium, 200 x 200 mm,
by 100 MPa on its upper end. The program has a quarter of both, hexahedra of 8 nodes. The other solution is axisymmetric: quadrilaterals of 8
nodes, pressures and tractions that are continuous along the contact, gaps that are closed in the mean, and Coulomb's law by active sets;
small displacements, the fillet's gap along the axis. Both tell by how much friction of 0.1 lowers what the load does. Needs python3-scipy.
"""
import argparse
import os
import subprocess

import h5py
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

R_PUNCH, H_PUNCH, R_FILLET, R_BASE, H_BASE = 50.0, 100.0, 10.0, 100.0, 200.0  # mm
FLAT = R_PUNCH - R_FILLET
E_PUNCH, E_BASE, NU, PRESSURE, FRICTION = 210e3, 70e3, 0.3, 100.0, 0.1  # N, mm
PLACES = {"axis": 0.0, "edge of the flat": FLAT}
GAUSS = [(-np.sqrt(0.6), 5 / 9), (0.0, 8 / 9), (np.sqrt(0.6), 5 / 9)]


# ---- grids of points, radius and height, (columns, rows)

def grids(size, coarser, midsides):
    """Of punch and base, and how many columns face each other. size: of the cells at the fillet, mm; coarser: factor elsewhere."""
    def steps(length, step):
        n = max(2, round(length / step))
        return np.linspace(0, 1, (2 if midsides else 1) * n + 1)
    up = np.pi / 4 * steps(R_FILLET * np.pi / 4, size)
    arc = lambda angle: np.stack([FLAT + R_FILLET * np.sin(angle), R_FILLET * (1 - np.cos(angle))], 1)
    flat = np.concatenate([30 * steps(30, coarser * size)[:-1], 30 + 10 * steps(10, size)])
    low = np.concatenate([np.stack([flat, 0 * flat], 1), arc(up[1:])])
    wall = R_FILLET + (H_PUNCH - R_FILLET) * steps(90, 2 * coarser * size)[1:] ** 1.5
    right = np.concatenate([arc(np.pi / 4 + up), np.stack([0 * wall + R_PUNCH, wall], 1)])
    height = H_PUNCH * (right[:, 1] - right[0, 1]) / (H_PUNCH - right[0, 1])
    left, high = np.stack([0 * height, height], 1), np.stack([R_PUNCH * low[:, 0] / low[-1, 0], 0 * low[:, 0] + H_PUNCH], 1)
    u, v = np.linspace(0, 1, len(low))[:, None, None], np.linspace(0, 1, len(right))[None, :, None]
    punch = ((1 - v) * low[:, None] + v * high[:, None] + (1 - u) * left[None] + u * right[None] - (1 - u) * (1 - v) * low[0]
             - u * v * high[-1] - u * (1 - v) * low[-1] - (1 - u) * v * high[0])
    out = low[-1, 0] + (R_BASE - low[-1, 0]) * steps(R_BASE - low[-1, 0], 2 * coarser * size)[1:] ** 1.3
    depth = -H_BASE * steps(H_BASE, 2 * coarser * size)[::-1] ** 1.8
    return punch, np.stack(np.meshgrid(np.concatenate([low[:, 0], out]), depth, indexing="ij"), 2), len(low)


# ---- the axisymmetric solution

def shape(x, y):
    """Functions and derivatives of a quadrilateral of 8 nodes, corners first."""
    N, d = np.zeros(8), np.zeros((8, 2))
    for a, (s, t) in enumerate([(-1, -1), (1, -1), (1, 1), (-1, 1)]):
        N[a] = (1 + s * x) * (1 + t * y) * (s * x + t * y - 1) / 4
        d[a] = s * (1 + t * y) * (2 * s * x + t * y) / 4, t * (1 + s * x) * (s * x + 2 * t * y) / 4
    for a, (s, t) in enumerate([(0, -1), (1, 0), (0, 1), (-1, 0)], 4):
        N[a] = (1 - x * x) * (1 + t * y) / 2 if s == 0 else (1 - y * y) * (1 + s * x) / 2
        d[a] = (-x * (1 + t * y), (1 - x * x) * t / 2) if s == 0 else ((1 - y * y) * s / 2, -y * (1 + s * x))
    return N, d


def edge(points):
    """Weights 2 pi r dr and functions of an edge of 3 nodes at the points of Gauss."""
    for x, w in GAUSS:
        N, d = np.array([x * (x - 1) / 2, 1 - x * x, x * (x + 1) / 2]), np.array([x - 0.5, -2 * x, x + 0.5])
        yield 2 * np.pi * (N @ points) * (d @ points) * w, N


class Solid:
    """A grid with midside nodes, with compliances of the nodes of one edge to forces along the axis and along the radius."""

    def __init__(self, grid, E, row, n, held, hanging=False):
        I, J = grid.shape[:2]
        self.number = np.full((I, J), -1)
        real = [(i, j) for i in range(I) for j in range(J) if not (i % 2 and j % 2)]
        for k, place in enumerate(real):
            self.number[place] = k
        self.X = np.array([grid[place] for place in real])
        K = self.stiffness(E)
        fixed = [2 * k for k in self.number[0] if k >= 0] + held(self.number) + ([2 * self.number[0, -1] + 1] if hanging else [])
        self.free = np.setdiff1d(np.arange(K.shape[0]), fixed)
        self.solver = splu(K[self.free][:, self.free].tocsc())
        nodes = self.number[:n, row]
        self.dof = np.stack([2 * nodes + 1, 2 * nodes], 1).ravel()
        unit = np.zeros((K.shape[0], len(self.dof)))
        unit[self.dof, np.arange(len(self.dof))] = 1
        self.U = self.solve(unit)

    def solve(self, forces):
        U = np.zeros_like(forces)
        U[self.free] = self.solver.solve(forces[self.free])
        return U

    def stiffness(self, E):
        n = self.number
        cells = np.array([[n[i, j], n[i + 2, j], n[i + 2, j + 2], n[i, j + 2], n[i + 1, j], n[i + 2, j + 1], n[i + 1, j + 2], n[i, j + 1]]
                          for i in range(0, n.shape[0] - 1, 2) for j in range(0, n.shape[1] - 1, 2)])
        D = np.full((4, 4), NU)
        D[np.diag_indices(3)], D[3], D[:, 3], D[3, 3] = 1 - NU, 0, 0, (1 - 2 * NU) / 2
        K, X = np.zeros((len(cells), 16, 16)), self.X[cells]
        for x, v in GAUSS:
            for y, w in GAUSS:
                N, d = shape(x, y)
                J = np.einsum("ai,eaj->eij", d, X)
                g, r = np.einsum("eij,aj->eai", np.linalg.inv(J), d), X[:, :, 0] @ N
                B = np.zeros((len(cells), 4, 16))
                B[:, 0, 0::2], B[:, 1, 1::2], B[:, 2, 0::2] = g[:, :, 0], g[:, :, 1], N / r[:, None]
                B[:, 3, 0::2], B[:, 3, 1::2] = g[:, :, 1], g[:, :, 0]
                K += np.einsum("eki,kl,elj,e->eij", B, D, B, 2 * np.pi * r * np.linalg.det(J) * v * w)
        dof = np.stack([2 * cells, 2 * cells + 1], 2).reshape(len(cells), 16)
        rows, columns = np.repeat(dof, 16, 1).ravel(), np.tile(dof, (1, 16)).ravel()
        return coo_matrix((E / ((1 + NU) * (1 - 2 * NU)) * K.ravel(), (rows, columns)), shape=(2 * len(self.X),) * 2).tocsc()


def axisymmetric(size, friction, steps=20):
    """Displacements along the axis of the base's nodes at PLACES, mm."""
    low, high, n = grids(size, 2, True)
    punch = Solid(low, E_PUNCH, 0, n, lambda number: [], hanging=True)
    base = Solid(high, E_BASE, -1, n, lambda number: [d for k in number[:, 0] if k >= 0 for d in (2 * k, 2 * k + 1)])
    force = np.zeros((2 * len(punch.X), 1))
    for i in range(0, n - 1, 2):
        nodes = punch.number[i:i + 3, -1]
        for w, N in edge(punch.X[nodes, 0]):
            force[2 * nodes + 1, 0] -= PRESSURE * w * N
    load, G = punch.solve(force)[punch.dof, 0], punch.U[punch.dof] + base.U[base.dof]
    r, gap, M = low[:, 0, 0], low[:, 0, 1], np.zeros((n, n))
    for i in range(0, n - 1, 2):
        for w, N in edge(r[i:i + 3]):
            M[i:i + 3, i:i + 3] += w * np.outer(N, N)
    # Unknown: pressures, tractions, and how far the punch has come.
    along = np.hstack([G[0::2, 0::2] @ M, G[0::2, 1::2] @ M, np.ones((n, 1))])
    across = np.hstack([G[1::2, 0::2] @ M, G[1::2, 1::2] @ M, np.zeros((n, 1))])
    closed, sliding, kept, x = r <= FLAT, np.zeros(n), np.zeros(n), None
    for factor in np.arange(1, steps + 1) / steps:
        sliding[:] = 0  # all sticks until it proves to slide
        for _ in range(200):
            A, y = np.eye(2 * n + 1), np.zeros(2 * n + 1)
            A[:n][closed], y[:n][closed] = (M @ along)[closed], (M @ (-gap - factor * load[0::2]))[closed]
            for i in np.flatnonzero(closed) if friction else ():
                if sliding[i]:
                    A[n + i, i] = -friction * sliding[i]
                else:
                    A[n + i], y[n + i] = M[i] @ across, M[i] @ (kept - factor * load[1::2])
            A[2 * n, :n], A[2 * n, 2 * n], y[2 * n] = M.sum(0), 0, -factor * force.sum()
            x = np.linalg.solve(A, y)
            p, q = x[:n], x[n:2 * n]
            gaps, way = M @ (along @ x + factor * load[0::2] + gap), M @ (across @ x + factor * load[1::2] - kept)
            now_closed = np.where(closed, p > -1e-9 * PRESSURE, gaps < -1e-12)
            begins = closed & (sliding == 0) & (np.abs(q) > friction * np.abs(p) * (1 + 1e-9) + 1e-12)
            now_sliding = np.where(begins, np.sign(q), np.where(way * sliding > 1e-15, 0, sliding)) if friction else sliding
            if (now_closed == closed).all() and (now_sliding == sliding).all():
                break
            closed, sliding = now_closed, now_sliding
        else:
            raise SystemExit(f"no states of contact at load factor {factor}")
        kept = across @ x + factor * load[1::2]
    forces = np.stack([M @ x[:n], M @ x[n:2 * n]], 1).ravel()
    moved = -(base.U @ forces)[base.dof][0::2]
    return [moved[np.argmin(np.abs(r - place))] for place in PLACES.values()]


# ---- the program

def write_quarter(path, grid, cells, upper_is_loaded, n):
    """Turns the grid by 90 degrees; hexahedra at the axis repeat nodes, which makes wedges of them."""
    I, J = grid.shape[:2]
    number, points = {}, []
    for i, j, k in np.ndindex(I, J, cells + 1):
        angle = np.pi / 2 * k / cells
        if i == 0 and k:
            number[i, j, k] = number[i, j, 0]
            continue
        points.append((grid[i, j, 0] * np.cos(angle), grid[i, j, 0] * np.sin(angle), grid[i, j, 1]))
        number[i, j, k] = len(points)
    lines = ["*NODE"] + [f"{a}, {x:.12g}, {y:.12g}, {z:.12g}" for a, (x, y, z) in enumerate(points, 1)]
    sets = {"Y0": [number[i, j, 0] for i, j in np.ndindex(I, J)], "X0": [number[i, j, cells] for i, j in np.ndindex(I, J)],
            "FOOT": [number[i, 0, k] for i, k in np.ndindex(I, cells + 1)], "HEAD": [number[0, J - 1, 0]]}
    contact = 0 if upper_is_loaded else J - 1
    for name, place in zip(("AXIS", "EDGE"), PLACES.values()):
        sets[name] = [number[int(np.argmin(np.abs(grid[:, contact, 0] - place))), contact, k] for k in range(cells + 1)]
    surfaces = {"CONTACT": [], "TOP": []}
    lines.append("*ELEMENT, TYPE=C3D8, ELSET=ALL")
    for e, (i, j, k) in enumerate(np.ndindex(I - 1, J - 1, cells), 1):
        lower = [number[a, j, b] for a, b in ((i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1))]
        upper = [number[a, j + 1, b] for a, b in ((i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1))]
        lines.append(", ".join(map(str, [e, *lower, *upper])))
        if upper_is_loaded and j == 0 or not upper_is_loaded and j == J - 2 and i < n + 1:
            surfaces["CONTACT"].append(f"{e}, S{1 if upper_is_loaded else 2}")
        if upper_is_loaded and j == J - 2:
            surfaces["TOP"].append(f"{e}, S2")
    for name, faces in surfaces.items():
        lines += [f"*SURFACE, NAME={name}, TYPE=ELEMENT", *faces] if faces else []
    for name, nodes in sets.items():
        lines += [f"*NSET, NSET={name}", *map(str, sorted(set(nodes)))]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


def by_program(program, folder, size, cells):
    """Displacements along the axis at PLACES of the base, mm, without and with friction."""
    def run(words):
        done = subprocess.run([program, *words.split()], cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode:
            raise SystemExit(done.stdout + done.stderr)
    punch, base, n = grids(size, 1.5, False)
    write_quarter(os.path.join(folder, "punch.inp"), punch, cells, True, n)
    write_quarter(os.path.join(folder, "base.inp"), base, cells, False, n)
    common = "-unit mm -surface CONTACT -modes 20 -basis modal_residual -completeness false -stress_nodes AXIS"
    for body, E, held, markers in (("punch", E_PUNCH, "X0:x,Y0:y,HEAD:z", "TOP"), ("base", E_BASE, "X0:x,Y0:y,FOOT", "AXIS,EDGE")):
        run(f"reduce -mesh {body}.inp -material_E {E * 1e6} -material_nu {NU} -material_rho 7850 -restrain {held} -markers {markers} "
            f"{common} -output {body}.h5")
    force = PRESSURE * cells / 2 * np.sin(np.pi / 2 / cells) * R_PUNCH ** 2  # of the polygon
    found = []
    for friction in (0, FRICTION):
        run("simulate -bodies base,punch -base_file base.h5 -punch_file punch.h5 -base_joint fixed -punch_joint prismatic -punch_axis 0,0,1 "
            "-contact_pairs base:punch -contact_slave second -contact_surface facets -contact_points nodes -contact_law penalty "
            f"-contact_offset -1e-7 -contact_friction {friction} -contact_friction_law {'stick' if friction else 'regularised'} -loads press "
            f"-press_marker punch.TOP -press_force 0,0,{-force} -analysis static -static_steps 10 -sensors_axis base.AXIS "
            "-sensors_edge base.EDGE -output pressed.h5")
        with h5py.File(os.path.join(folder, "pressed.h5")) as file:
            found.append([1e3 * file[f"sensors/{name}/position"][-1, 2] for name in ("axis", "edge")])
    return found


def report(title, without, with_friction):
    texts = [f"{place} {u:.5f} and {v:.5f} mm, {100 * (v / u - 1):+.2f} %" for place, u, v in zip(PLACES, without, with_friction)]
    print(f"{title}: " + "; ".join(texts), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--cells", type=int, default=6, help="of the quarter, around the axis")
    parser.add_argument("--size", type=float, default=4, help="of the program's cells at the fillet, mm")
    parser.add_argument("--axisymmetric", type=float, nargs="*", default=[2, 1, 0.5], help="sizes of cells at the fillet, mm")
    given = parser.parse_args()
    os.makedirs(given.out, exist_ok=True)
    for size in given.axisymmetric:
        report(f"axisymmetric, {size} mm", axisymmetric(size, 0), axisymmetric(size, FRICTION))
    report(f"the program, {given.size} mm", *by_program(os.path.abspath(given.elastogear), given.out, given.size, given.cells))


if __name__ == "__main__":
    main()
