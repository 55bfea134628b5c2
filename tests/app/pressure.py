#!/usr/bin/python3
"""Pressures on face sets beside closed forms: a bar in tension, bent, on a hinge and pushed through space, and a pipe under inner pressure (Lame),
held and free, of cells of every kind, in the default basis and in the full one.

    pressure.py PATH/TO/elastogear
"""
import itertools
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

ELASTOGEAR = os.path.abspath(sys.argv[1])
HEX = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
WEDGES = [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]]
TETS = []
for order in itertools.permutations(range(3)):  # from corner to corner along the three axes in each order
    steps = [np.zeros(3, int)]
    for axis in order:
        steps.append(steps[-1] + np.eye(3, dtype=int)[axis])
    tet = [int(np.flatnonzero((HEX == x).all(axis=1))[0]) for x in steps]
    if np.linalg.det(HEX[tet[1:]] - HEX[tet[0]]) < 0:
        tet[1], tet[2] = tet[2], tet[1]
    TETS.append(tet)
EDGES = {8: ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)),
         6: ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)),
         4: ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))}
SIDES = {8: ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
         6: ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
         4: ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))}
KINDS = {8: (8, [range(8)]), 20: (8, [range(8)]), 6: (6, WEDGES), 15: (6, WEDGES), 10: (4, TETS)}  # nodes: corners, cells of a cube
STEEL = ["-material_E", "210e9", "-material_rho", "7850"]
SIZE, BAR = np.array([0.1, 0.02, 0.02]), (8, 2, 2)  # m, cubes
INNER, OUTER = 0.02, 0.04  # m, radii of the pipe
SAME = 1e-6  # of what the mesh has exactly
LAME = {20: (5e-3, 5e-4, 5e-3), 15: (1e-2, 5e-4, 5e-3)}  # errors of the meshes, by nodes of a cell: hoop, widening, axial


def write_mesh(kind, cubes, place, nodes_at, faces_at):
    """mesh.inp, of cells of `kind` nodes. place: coordinates of a point of the unit cube; nodes_at, faces_at: sets, where a function of that
    point holds."""
    n, parts = KINDS[kind]
    number, cells = {}, []
    for at in np.ndindex(*cubes):
        for part in parts:
            corner = HEX[list(part)]
            all_nodes = corner if kind == n else np.vstack([corner, [(corner[a] + corner[b]) / 2 for a, b in EDGES[n]]])
            cells.append([number.setdefault(tuple(np.round(p, 9)), len(number) + 1) for p in (np.array(at) + all_nodes) / cubes])
    x = np.array(list(number))
    X = np.array([place(p) for p in x])
    _, first, same = np.unique(np.round(X, 9), axis=0, return_index=True, return_inverse=True)  # where a ring closes
    name = first[same.ravel()] + 1
    with open("mesh.inp", "w", encoding="utf-8") as file:
        file.write("*NODE\n" + "".join(f"{i + 1}, {X[i][0]:.12g}, {X[i][1]:.12g}, {X[i][2]:.12g}\n" for i in sorted(first)))
        file.write(f"*ELEMENT, TYPE=C3D{kind}, ELSET=ALL\n")
        for i, cell in enumerate(cells):
            words = list(map(str, [i + 1, *(name[k - 1] for k in cell)]))
            file.write(", ".join(words[:16]) + (",\n" + ", ".join(words[16:]) if len(words) > 16 else "") + "\n")
        for key, inside in nodes_at.items():
            file.write(f"*NSET, NSET={key}\n" + "".join(f"{i + 1},\n" for i in sorted(first) if inside(x[i])))
        for key, inside in faces_at.items():
            file.write(f"*SURFACE, NAME={key}, TYPE=ELEMENT\n")
            for i, cell in enumerate(cells):
                for j, side in enumerate(SIDES[n]):
                    if all(inside(x[cell[k] - 1]) for k in side):
                        file.write(f"{i + 1}, S{j + 1}\n")


def run(verb, *words):
    done = subprocess.run([ELASTOGEAR, verb, *map(str, words)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{verb} {words}: {done.stdout}{done.stderr}"


def reduce(nu, *words):
    run("reduce", "-mesh", "mesh.inp", *STEEL, "-material_nu", nu, *words, "-output", "body.h5")


def simulate(pressure, *words):
    run("simulate", "-bodies", "body", "-body_file", "body.h5", "-loads", "p", "-p_marker", "body.PRESSED", "-p_pressure", pressure,
        *words, "-output", "p.h5")
    with h5py.File("p.h5") as file:
        return {name: file[name][:] for name in ("time", "bodies/body/rigid", "sensors/tip/position", "sensors/node/position")
                if name in file}


def stress(nodes):
    """Components xx, yy, zz, xy, yz, zx at the nodes of a set, Pa."""
    run("recover", "-result", "p.h5", "-output", "stress.h5", "-stress_body", nodes)
    with h5py.File("stress.h5") as file:
        return file[f"body/{nodes}/stress"][-1].reshape(-1, 6)


def bar(kind, face, **more):
    write_mesh(kind, BAR, lambda p: p * SIZE,
               {"FIX": lambda p: p[0] < 1e-9, "END": lambda p: p[0] > 1 - 1e-9, **more}, {"PRESSED": face})


def at_end(p):
    return p[0] > 1 - 1e-9


def on_top(p):
    return p[2] > 1 - 1e-9


def pull(kind):
    """-100 MPa on the end is 100 MPa at every node, whatever the basis and however the body is turned."""
    bar(kind, at_end, ALL=lambda p: True)
    for basis in (["-modes", "8"], ["-basis", "full"])[: 2 if kind == 20 else 1]:
        reduce(0, "-restrain", "FIX", "-stress_nodes", "ALL,END", "-markers", "PRESSED", *basis)
        found = simulate("-100 MPa", "-body_rotation", "0.5,-0.8,1.1", "-analysis", "static", "-sensors_tip", "body.PRESSED")
        all_nodes = stress("ALL")
        assert np.abs(all_nodes - 100e6 * np.eye(6)[0]).max() < SAME * 100e6, (kind, basis, all_nodes)
        tip = found["sensors/tip/position"]
        assert abs(np.linalg.norm(tip[-1] - tip[0]) / (100e6 * SIZE[0] / 210e9) - 1) < SAME, tip
    print(f"{kind} nodes a cell: the bar in tension has {np.abs(all_nodes[:, 0] / 100e6 - 1).max():.1e} beside 100 MPa", flush=True)


def bend():
    """w l^4 / (8 E I) and the shear 0.6 w l^2 / (G A): a slender beam's within a few percent; the default basis has what the full one has."""
    bar(20, on_top)
    down = {}
    for name, basis in {"few": ["-modes", 8], "full": ["-basis", "full"]}.items():
        reduce(0.3, "-restrain", "FIX", "-markers", "PRESSED,END", *basis)
        end = simulate("1e6", "-analysis", "static", "-sensors_tip", "body.END")["sensors/tip/position"]
        down[name] = end[-1] - end[0]
    assert np.abs(down["few"] - down["full"]).max() < SAME * abs(down["full"][2]), down
    w, inertia = 1e6 * SIZE[1], SIZE[1] ** 4 / 12
    beam = w * SIZE[0] ** 4 / (8 * 210e9 * inertia) + 0.6 * w * SIZE[0] ** 2 / (210e9 / 2.6 * SIZE[1] ** 2)
    assert abs(-down["full"][2] / beam - 1) < 0.05, (down, beam)


def turn():
    """In time: a bar on a hinge feels the moment of its pressure at any angle."""
    bar(8, on_top)
    reduce(0.3, "-restrain", "FIX", "-markers", "PRESSED", "-modes", 8)
    found = simulate("1e3", "-body_joint", "revolute", "-body_axis", "0,1,0", "-body_angle0", "0.3", "-ts_max_time", "0.01")
    s, t = found["bodies/body/rigid"].ravel(), found["time"].ravel()
    inertia = 7850 * SIZE.prod() * (SIZE[0] ** 2 + SIZE[2] ** 2) / 3
    turned = 0.3 + 1e3 * SIZE[0] * SIZE[1] * SIZE[0] / 2 / inertia * t**2 / 2
    assert np.abs(s - turned).max() < 2e-3 * (turned[-1] - 0.3), (s, turned)


def push():
    """In time: a free bar is accelerated along its axis by p A / m, and its stress falls from the pressure at one end to nothing."""
    bar(20, at_end)
    reduce(0, "-restrain", "none", "-markers", "PRESSED", "-modes", 8, "-stress_nodes", "FIX,END")
    found = simulate("1 MPa", "-body_joint", "prismatic", "-body_axis", "1,0,0", "-p_signal", "ramp,1,5e-4", "-ts_max_time", "2e-3")
    s, t = found["bodies/body/rigid"].ravel(), found["time"].ravel()
    a, ramp = -1e6 / (7850 * SIZE[0]), 5e-4
    moved = np.where(t < ramp, a * t**3 / ramp / 6, a * (t**2 / 2 - ramp * t / 2 + ramp**2 / 6))
    assert np.abs(s - s[0] - moved).max() < 2e-3 * abs(moved[-1]), (s, moved)
    assert np.abs(stress("END")[:, 0] / -1e6 - 1).max() < 0.02, stress("END")
    assert np.abs(stress("FIX")[:, 0]).max() < 0.02e6, stress("FIX")


def pipe(kind, radial, held):
    """Lame's pipe with free ends, whole and free in space, or a quarter that its planes of symmetry hold. Returns the largest errors of
    hoop stress at the bore, of its widening and of the axial stress, relative to the closed forms."""
    turned = np.pi / 2 if held else 2 * np.pi

    def place(p):
        r, angle = INNER + p[0] * (OUTER - INNER), p[1] * turned
        return np.array([r * np.cos(angle), r * np.sin(angle), 0.005 * p[2]])

    write_mesh(kind, (radial, radial if held else 4 * radial, 1), place,
               {"A": lambda p: p[1] < 1e-9, "B": lambda p: p[1] > 1 - 1e-9, "LOW": lambda p: p[2] < 1e-9,
                "BORE": lambda p: p[0] < 1e-9, "NODE": lambda p: (p < 1e-9).all()}, {"PRESSED": lambda p: p[0] < 1e-9})
    reduce(0.3, "-restrain", "A:y,B:x,LOW:z" if held else "none", "-stress_nodes", "BORE", "-markers", "PRESSED,NODE", "-modes", 8)
    p, a, b = 100e6, INNER**2, OUTER**2
    node = simulate("100 MPa", "-analysis", "static", "-sensors_node", "body.NODE")["sensors/node/position"]
    s = stress("BORE")
    hoop = p * (a + b) / (b - a)
    widening = p * INNER / 210e9 * ((a + b) / (b - a) + 0.3)
    errors = np.array([np.abs((s[:, :3].sum(axis=1) + p) / hoop - 1).max(),  # the trace has hoop, radial -p and axial 0
                       abs((node[-1, 0] - node[0, 0]) / widening - 1), np.abs(s[:, 2]).max() / hoop])
    print(f"{kind} nodes a cell, {radial} over the wall, {'held' if held else 'free'}: hoop stress, widening, axial stress off by {errors}", flush=True)
    assert (errors < LAME[kind]).all(), errors
    return errors


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for kind in KINDS:
            pull(kind)
        bend()
        turn()
        push()
        coarse = pipe(20, 4, held=True)
        fine = pipe(20, 8, held=True)
        assert (fine < coarse / 6).all(), (coarse, fine)
        pipe(20, 4, held=False)
        pipe(15, 8, held=True)
        os.chdir("/")


if __name__ == "__main__":
    main()
