#!/usr/bin/python3
"""The load over the face of aligned spur gears by meshes, widths and offsets, as the tables of docs/validation/gears.md:

    studies/even_pair.py --elastogear build/release/src/app/elastogear --out even_pair meshes widths

meshes: README's pair on hexahedra of 8 and 20 nodes and on tetrahedra of 10 nodes, which are the 20-node hexahedra of size tiny cut in
six; 16 positions of a pitch. widths: a pair of 17 and 23 teeth with equal and unequal widths, an offset and bearings. Lines are printed
as tables; what is there already is read again.
"""
import argparse
import os
import subprocess
import sys

import h5py
import numpy as np
import yaml

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
import figures

STEEL = {"E": 210e9, "nu": 0.3, "rho": 7850}
MODULE, ALPHA = 3e-3, np.radians(20)
README = {"drive": "cylindrical", "module": "3 mm", "face_width": "25 mm", "pinion": {"teeth": 17, "profile_shift": 0.3},
          "wheel": {"teeth": 43, "profile_shift": 0.1}, "torque": "300 N m", "material": STEEL}
NARROW = {"drive": "cylindrical", "module": "3 mm", "face_width": "20 mm", "pinion": {"teeth": 17}, "wheel": {"teeth": 23}, "torque": "80 N m",
          "material": STEEL}
EDGE = 0.02  # of the path: there edges of tips touch, too
CORNERS = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]])
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]  # nodes 9 to 20 of Abaqus
FACES = [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
TET_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]  # nodes 5 to 10


def read_inp(path):
    """Nodes, m, and 20-node hexahedra."""
    head, blocks = None, {}
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("*"):
                head = line.strip() if line.startswith(("*NODE", "*ELEMENT")) else None
            elif head:
                blocks.setdefault(head, []).append(line.strip().rstrip(","))
    nodes = np.array(",".join(next(v for k, v in blocks.items() if k.startswith("*NODE"))).split(","), float).reshape(-1, 4)
    cells = np.array(",".join(next(v for k, v in blocks.items() if k.startswith("*ELEMENT"))).split(","), int).reshape(-1, 21)
    assert (nodes[:, 0] == np.arange(1, len(nodes) + 1)).all()
    return nodes[:, 1:], cells[:, 1:] - 1


def shape(x):
    """Of the 20-node hexahedron at x."""
    corner = np.prod(1 + CORNERS * x, axis=1) / 8 * (CORNERS @ x - 2)
    middle = np.array([CORNERS[a] + CORNERS[b] for a, b in EDGES]) / 2
    return np.concatenate([corner, np.prod(np.where(middle == 0, 1 - x**2, 1 + middle * x), axis=1) / 4])


def tetrahedra(X, cells):
    """Six of each hexahedron, from its corner of the smallest number, so that neighbours agree; nodes on diagonals by the hexahedron's
    shape functions."""
    new, points, found = {}, list(X), []
    for cell in cells:
        middles = {frozenset((cell[a], cell[b])): cell[8 + i] for i, (a, b) in enumerate(EDGES)}
        first = int(np.argmin(cell[:8]))

        def between(a, b):
            key = frozenset((cell[a], cell[b]))
            if key in middles:
                return middles[key]
            if key not in new:
                new[key] = len(points)
                points.append(shape((CORNERS[a] + CORNERS[b]) / 2) @ X[cell])
            return new[key]

        for face in FACES:
            if first in face:
                continue
            at = int(np.argmin(cell[list(face)]))
            a, b, c, d = face[at:] + face[:at]
            for tet in ((a, b, c, first), (a, c, d, first)):
                x = X[cell[list(tet)]]
                if np.linalg.det(x[1:] - x[0]) < 0:
                    tet = (tet[1], tet[0], *tet[2:])
                found.append([*cell[list(tet)], *(between(tet[i], tet[j]) for i, j in TET_EDGES)])
    return np.array(points), np.array(found)


class Pair:
    def __init__(self, options, name, keys, **more):
        self.program, self.name = os.path.abspath(options.elastogear), name
        self.folder = os.path.join(os.path.abspath(options.out), name.replace(" ", "_").replace("/", "_").replace(",", ""))
        os.makedirs(self.folder, exist_ok=True)
        self.keys = {**keys, "modes": 0, "analysis": "sweep", "sweep_positions": 16, **more}

    def run(self, *words):
        with open(os.path.join(self.folder, "pair.yaml"), "w", encoding="utf-8") as file:
            yaml.safe_dump(self.keys, file, sort_keys=False)
        done = subprocess.run([self.program, *words], cwd=self.folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise SystemExit(f"{self.name}, {words}: {done.stderr}")

    def cut_into_tetrahedra(self):
        self.keys["element_order"] = 2
        for gear in ("pinion", "wheel"):
            self.run("mesh", "pair.yaml", f"-{gear}_mesh_output", f"{gear}.inp")
        for gear in ("pinion", "wheel"):
            X, cells = tetrahedra(*read_inp(os.path.join(self.folder, f"{gear}.inp")))
            with open(os.path.join(self.folder, f"{gear}_tet.inp"), "w", encoding="utf-8") as file:
                file.write("*NODE\n" + "".join(f"{i + 1}, {x:.15g}, {y:.15g}, {z:.15g}\n" for i, (x, y, z) in enumerate(X)))
                file.write("*ELEMENT, TYPE=C3D10, ELSET=ALL\n" + "".join(f"{i + 1}, " + ", ".join(map(str, cell + 1)) + "\n" for i, cell in enumerate(cells)))
            self.keys[gear] = {**self.keys[gear], "mesh": f"{gear}_tet.inp", "unit": "m"}

    def solve(self):
        if not os.path.exists(os.path.join(self.folder, "pair_evaluation.h5")):
            for verb in ("reduce", "simulate", "evaluate"):
                self.run(verb, "pair.yaml")
        return self.figures()

    def pressures_off(self):
        """Of each strip that carries a fifth of the largest line load or more, beside H. Hertz's of its load on cylinders with the radii
        of the involutes where the line of action stands, between the ends of the path."""
        teeth = np.array([self.keys[gear]["teeth"] for gear in ("pinion", "wheel")])
        shift = np.array([self.keys[gear].get("profile_shift", 0) for gear in ("pinion", "wheel")])
        base, tip = MODULE * teeth * np.cos(ALPHA) / 2, MODULE * (teeth / 2 + shift + 1)
        with h5py.File(os.path.join(self.folder, "pair_evaluation.h5")) as file:
            of = next(iter(file["cases"].values()))["pinion:wheel"]
            width, place, pairs = of["line_load/width"][:], of["teeth/place"][:], of["teeth/force"][:]
            begins = of["teeth/path_begins"][()]
        with h5py.File(os.path.join(self.folder, "pair_result.h5")) as file:
            points = file["contact/pinion:wheel/points"]
            offset, force, pressure = points["offset"][:], np.linalg.norm(points["force"][:], axis=1), points["pressure"][:]
            centres = np.linalg.norm(file["bodies/wheel/position"][0] - file["bodies/pinion/position"][0])
        path = np.sqrt(centres**2 - base.sum()**2)
        start = path - np.sqrt(tip[1]**2 - base[1]**2)  # where the wheel's tip begins to touch, from the pinion's base circle
        off = []
        for k in range(len(offset) - 1):
            sums = force[offset[k]:offset[k + 1]].reshape(-1, len(width)).sum(axis=1)
            for pair, total in enumerate(sums):
                first = start + (place[k, np.abs(pairs[k] - total).argmin()] - begins) * np.pi * MODULE * np.cos(ALPHA)
                at = slice(offset[k] + pair * len(width), offset[k] + (pair + 1) * len(width))
                load = force[at] / width
                modulus = STEEL["E"] / (2 * (1 - STEEL["nu"]**2))
                end = np.sqrt(tip[0]**2 - base[0]**2)
                if EDGE < (first - start) / (end - start) < 1 - EDGE:
                    hertz = np.sqrt(load * modulus * path / (np.pi * first * (path - first)))
                    off.append((pressure[at] / hertz - 1)[load > 0.2 * (force / np.resize(width, force.shape)).max()])
        return np.abs(np.concatenate(off))

    def figures(self):
        with h5py.File(os.path.join(self.folder, "pair_evaluation.h5")) as file:
            of = next(iter(file["cases"].values()))["pinion:wheel"]
            load, pattern = of["line_load/mean"][:], of["pattern/wheel_left/pressure"] if "pattern/wheel_left" in of else of["pattern/wheel_right/pressure"]
            error = of["transmission_error/loaded"][:]
            found = {"KHbeta": of["line_load/KHbeta"][()], "least": load.min() / load.mean(), "ends": max(load[0], load[-1]) / load.mean(),
                     "neighbours": np.abs(np.diff(load[1:-1])).max() / load.mean(), "load": load / load.mean(),
                     "hertz": of["pressure/hertz_peak"][()] / 1e6, "pattern": np.nanmax(pattern[:]) / 1e6, "mean": np.abs(error.mean()) * 1e6,
                     "p2p": np.ptp(error) * 1e6, "stiffness": of["stiffness/secant_mean"][()] / 1e6 if "stiffness/secant_mean" in of else np.nan}  # offset gears have none
        found["hertz off"] = self.pressures_off()
        return found


def row(name, found, even=None):
    share = [100 * (found[key] / even[key] - 1) for key in ("hertz", "mean", "stiffness")] if even else []
    print(f"| {name} | {found['KHbeta']:.3f} | {found['least']:.3f} | {found['ends']:.3f} | {100 * found['neighbours']:.1f} % | {found['hertz']:.0f} | {found['pattern']:.0f} "
          f"| {100 * np.median(found['hertz off']):.2f}, {100 * found['hertz off'].max():.1f} % | {found['mean']:.2f} | {found['p2p']:.2f} | {found['stiffness']:.0f} |"
          + "".join(f" {x:+.1f} %" for x in share), flush=True)


HEADING = ("| pair | KHbeta | least strip | end strips | neighbours | Hertz, MPa | pattern, MPa | pressure beside Hertz's of each strip (median, largest) "
           "| TE mean, um | peak to peak, um | stiffness, N/um | Hertz, TE, stiffness beside the first")


def meshes(options):
    print(HEADING)
    first = None
    for name, more in (("hex20 small", {"size": "small", "element_order": 2}), ("hex20 tiny", {"size": "tiny", "element_order": 2}),
                       ("hex8 small", {"size": "small", "element_order": 1}), ("hex8 tiny", {"size": "tiny", "element_order": 1}), ("tet10", {"size": "tiny"})):
        pair = Pair(options, name, {**README, **more})
        if name == "tet10":
            pair.cut_into_tetrahedra()
        found = pair.solve()
        first = first or found
        off = np.abs(found["load"] / first["load"] - 1)[1:-1].max() if len(found["load"]) == len(first["load"]) else np.nan
        row(name, found, first)
        for quantity, key in (("transmission error", "mean"), ("stiffness", "stiffness")):
            figures.figure(f"stations, {name}", quantity, found[key] / first[key] - 1, unit="%")
        print(f"    strips but the outermost beside those of the first: {100 * off:.1f} %")


def widths(options):
    print(HEADING)
    for order in (2, 1):
        even = None
        mesh = {"size": "tiny", "element_order": order}
        for name, gears, more in (("20/20", {}, {}), ("20.5/20", {"pinion": {"face_width": "20.5 mm"}}, {}), ("22/20", {"pinion": {"face_width": "22 mm"}}, {}),
                                  ("24/20", {"pinion": {"face_width": "24 mm"}}, {}), ("offset 1 mm", {"wheel": {"axial_offset": "1 mm"}}, {}),
                                  ("bearings", {gear: {"bearing_radial": "200 N/um"} for gear in ("pinion", "wheel")}, {})):
            keys = {**NARROW, **mesh, **{gear: {**NARROW[gear], **gears.get(gear, {})} for gear in ("pinion", "wheel")}}
            found = Pair(options, f"{name} order {order}", keys, **more).solve()
            even = even or found
            row(f"{name}, order {order}", found, even)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True)
    parts = {part.__name__: part for part in (meshes, widths)}
    parser.add_argument("parts", nargs="+", choices=parts)
    options = parser.parse_args()
    for part in options.parts:
        parts[part](options)


if __name__ == "__main__":
    main()
