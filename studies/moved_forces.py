#!/usr/bin/python3
"""Contact forces of one run at the same places on the mesh of another: what a mesh, and what the sharing of the load, has of a
difference between stresses on two meshes. The last state of TARGET gets the forces of SOURCE, and the elastic coordinates at rest
under them; `recover` then tells the stresses. Both are results at rest of the same drive, of bodies with residual flexibility that
do not move freely.

    studies/moved_forces.py TARGET.h5 SOURCE.h5 OUT.h5 [--body wheel]
    elastogear recover -result OUT.h5 -worm_file worm.h5 -wheel_file wheel.h5 -stress_wheel root -output OUT_stress.h5

Forces act at the foot points of the contacts, or at the slave's nodes where its side is that of a boundary, and are shared out to
the nodes of the nearest face that they press on, by its bilinear shape functions.
"""
import argparse
import os
import shutil
import sys

import h5py
import numpy as np

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
import results

NEAREST = 12  # faces that are tried
SIGNS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])  # of the corners of a face


def shares(uv):
    """Bilinear shape functions at (u, v)."""
    return np.prod(1 + SIGNS * uv, axis=1) / 4


def place_on(corners, x):
    """(u, v) of the point of a face that is nearest to x."""
    uv = np.zeros(2)
    for _ in range(20):
        slopes = SIGNS * (1 + SIGNS * uv)[:, ::-1] / 4
        uv += np.linalg.lstsq((slopes.T @ corners).T, x - shares(uv) @ corners, rcond=None)[0]
    return uv


def open_body(result, body):
    path = result[f"bodies/{body}"].attrs["file"]
    return results.open_file(path.decode() if isinstance(path, bytes) else path, "body")


def contacts(result, body):
    """Places and forces on a body in the last state, body frame."""
    names = [name for _, name in sorted((group.attrs["number"], name) for name, group in result["bodies"].items())]
    points = result[f"contact/{names[0]}:{names[1]}/points"]
    last = slice(*points["offset"][-2:])
    side, force = points["slave_side"][last], points["force"][last]
    second = result[f"bodies/{names[1]}"]
    with open_body(result, names[1]) as file:
        X, face = file["surface/X"][:], file["surface/face"][:]
    foot = np.array([shares(uv) @ X[face[f]] for uv, f in zip(np.column_stack([points["xi"][last], points["eta"][last]]),
                                                              np.where(side == 0, points["face"][last], 0))])
    local = np.where((side == 0)[:, None], foot, X[np.where(side == 0, 0, points["slave_node"][last])])
    world = local @ second["rotation"][-1].T + second["position"][-1]
    sign = np.where(side == names.index(body), 1, -1)
    state = result[f"bodies/{body}"]
    return (world - state["position"][-1]) @ state["rotation"][-1], sign[:, None] * force @ state["rotation"][-1]


def nodal_forces(surface, places, forces):
    """{node: force} of forces at places, body frame."""
    X, face = surface["X"][:], surface["face"][:]
    middle = X[face].mean(axis=1)
    normal = np.cross(X[face[:, 2]] - X[face[:, 0]], X[face[:, 3]] - X[face[:, 1]])
    found = {}
    for x, f in zip(places, forces):
        pressed = np.flatnonzero(normal @ f < 0)
        near = pressed[np.argsort(np.linalg.norm(middle[pressed] - x, axis=1))[:NEAREST]]
        at = [np.clip(place_on(X[face[i]], x), -1, 1) for i in near]
        best = min(range(len(near)), key=lambda i: np.linalg.norm(shares(at[i]) @ X[face[near[i]]] - x))
        for node, share in zip(face[near[best]], shares(at[best])):
            found[node] = found.get(node, 0) + share * f
    return found


def replace_rows(group, name, rows):
    attributes = dict(group[name].attrs)
    del group[name]
    group.create_dataset(name, data=rows).attrs.update(attributes)


def move(target, source, out, body):
    with results.open_file(source, "result") as result:
        x, f = contacts(result, body)
    shutil.copy(target, out)
    with h5py.File(out, "r+") as result:
        state = result[f"bodies/{body}"]
        with open_body(result, body) as file:
            found = nodal_forces(file["surface"], x, f)
            node = np.array(sorted(found))
            force = np.array([found[n] for n in node])
            q = np.einsum("nci,nc->i", file["surface/Phi"][node], force) / file["modes/eigenvalue"][:]
        known = state["contact_forces"]
        first = known["offset"][-2]
        print(f"sum of the forces on {body}: {known['force'][first:].sum(axis=0)} N, now {force.sum(axis=0)} N")
        replace_rows(known, "node", np.concatenate([known["node"][:first], node]))
        replace_rows(known, "force", np.concatenate([known["force"][:first], force]))
        known["offset"][-1] = first + len(node)
        state["q"][-1] = q


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("target")
    parser.add_argument("source")
    parser.add_argument("out")
    parser.add_argument("--body", default="wheel")
    options = parser.parse_args()
    move(options.target, options.source, options.out, options.body)


if __name__ == "__main__":
    main()
