#!/usr/bin/python3
"""Mesh stiffness of a worm drive with the flanks' local approach by H. Hertz in place of that of the mesh:

    studies/local_approach.py drive_convergence/drive_tiny drive_convergence/drive_small_2

Each folder holds a sweep of examples/drives/steering_worm.yaml as studies/drive_convergence.py leaves it: body files with
residual flexibility, result and evaluation. Of each pair of teeth with the force F, f its nodal forces on one body, K^-1 the
static response and s the forces spread over the nodes of the faces around (docs/theory.md, (4.13)), the mesh's approach below
the faces is (f' K^-1 f - s' K^-1 s) / F. In its place comes that of H. Hertz, half for each of two bodies of one material, less
that of the half-space under s. Forces kept, their virtual work over the force on the pitch circle is the change of the
transmission error.
"""
import argparse
import os

import h5py
import numpy as np
from scipy.special import ellipk

E, NU = 210e9, 0.3
PLANE = E / (1 - NU**2)
LEAST = 20.0  # N: pairs of teeth with less are left out


def rotation(axis, angle):
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


class Body:
    """Static response of the nodes of a body's flanks."""

    def __init__(self, path):
        self.path, self.rows = path, {}
        with h5py.File(path) as file:
            self.X, faces, self.group_of_face = file["surface/X"][:], file["surface/face"][:], file["surface/group"][:]
            self.orbit, self.turns = file["flexibility/surface/orbit"][:], file["flexibility/surface/turns"][:]
            self.axis = file["flexibility/axis"][:]
            self.column = {node: i for i, node in enumerate(file["flexibility/node"][:])}
        self.n_turns = self.turns.max() + 1
        self.node = {(o, t): i for i, (o, t) in enumerate(zip(self.orbit, self.turns))}
        self.area, self.group = np.zeros(len(self.X)), np.zeros(len(self.X), int)
        self.around = [set() for _ in self.X]
        for face, group in zip(faces, self.group_of_face):
            corners = list(dict.fromkeys(face))
            P = self.X[corners]
            area = sum(np.linalg.norm(np.cross(P[i] - P[0], P[i + 1] - P[0])) / 2 for i in range(1, len(P) - 1))
            for node in corners:
                self.area[node] += area / len(corners)
                self.group[node] = group
                self.around[node].update(corners)

    def rows_of(self, orbit):
        if orbit not in self.rows:
            with h5py.File(self.path) as file:
                self.rows[orbit] = file["flexibility/F"][3 * orbit:3 * orbit + 3].astype(float)
        return self.rows[orbit]

    def approach(self, nodes, forces):
        """f' K^-1 f / |sum f|, m."""
        work = 0
        for a, f in zip(nodes, forces):
            turn = rotation(self.axis, 2 * np.pi * self.turns[a] / self.n_turns)
            rows = self.rows_of(self.orbit[a])
            for b, g in zip(nodes, forces):
                at = self.column[self.node[self.orbit[b], (self.turns[b] - self.turns[a]) % self.n_turns]]
                work += f @ turn @ rows[:, 3 * at:3 * at + 3] @ turn.T @ g
        return work / np.linalg.norm(np.sum(forces, axis=0))

    def half_space(self, nodes, forces):
        """The same of a half-space under the normal parts of forces, each an even pressure on the node's share of the surface."""
        total = np.linalg.norm(np.sum(forces, axis=0))
        f = forces @ (np.sum(forces, axis=0) / total)
        distance = np.linalg.norm(self.X[nodes][:, None] - self.X[nodes][None], axis=2)
        np.fill_diagonal(distance, 3 * np.pi / 16 * np.sqrt(self.area[nodes] / np.pi))  # mean displacement of a loaded circle
        return f @ (1 / (np.pi * PLANE * distance)) @ f / total

    def spread(self, nodes, forces):
        result = {}
        for j, f in zip(nodes, forces):
            around = sorted(self.around[j])
            d = self.X[around] - self.X[j]
            plane = np.linalg.svd(d - d.mean(axis=0), full_matrices=False)[2][:2]
            C = np.vstack([np.ones(len(around)), plane @ d.T])
            for k, w in zip(around, C.T @ np.linalg.lstsq(C @ C.T, np.array([1.0, 0, 0]), rcond=None)[0]):
                result[k] = result.get(k, 0) + w * f
        return list(result), np.array(list(result.values()))


def hertz_constant(of):
    """c of the approach c F^(2/3) of two bodies, by the pair of teeth with the largest pressure."""
    p, b = of["pressure/hertz_peak"][()], of["pressure/hertz_half_width"][()]
    F = of["teeth/force"][np.argmax(of["pressure/hertz"][:])].max()
    a = 3 * F / (2 * np.pi * p * b)
    return 2 * p * b * ellipk(1 - (b / a)**2) / PLANE / F**(2 / 3)


def stiffness(folder):
    bodies = {name: Body(os.path.join(folder, name + ".h5")) for name in ("worm", "wheel")}
    before, after = [], []
    with h5py.File(os.path.join(folder, "steering_worm_result.h5")) as result, \
            h5py.File(os.path.join(folder, "steering_worm_evaluation.h5")) as evaluation:
        of = evaluation["cases/steering_worm_result/worm:wheel"]
        c = hertz_constant(of)
        way = np.abs(of["transmission_error/loaded"][:] - of["transmission_error/unloaded"][:])
        for t, k in enumerate(of["stiffness/secant"][:]):
            work = 0
            for name, body in bodies.items():
                at = result[f"bodies/{name}/contact_forces"]
                rows = slice(at["offset"][t], at["offset"][t + 1])
                nodes, forces = at["node"][rows], at["force"][rows]
                for group in np.unique(body.group[nodes]):
                    of_pair = body.group[nodes] == group
                    n, f = nodes[of_pair], forces[of_pair]
                    F = np.linalg.norm(f.sum(axis=0))
                    if F < LEAST:
                        continue
                    m, s = body.spread(n, f)
                    work += F * (c * F**(2 / 3) / 2 - body.half_space(m, s) - body.approach(n, f) + body.approach(m, s))
            before.append(k)
            after.append(k * way[t] / (way[t] + work / (k * way[t])))
    return np.mean(before), np.mean(after), c


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+")
    for folder in parser.parse_args().folders:
        before, after, c = stiffness(folder)
        approach = c * 1000**(2 / 3) * 1e6
        print(f"{os.path.basename(folder)}: {before / 1e6:.1f} N/um, with an approach of {approach:.1f} um at 1 kN "
              f"{after / 1e6:.1f}")


if __name__ == "__main__":
    main()
