#!/usr/bin/python3
"""Lines of contact of two helical gears: in the plane of action those of each pair of teeth are inclined by the base helix angle,
sin(beta_b) = sin(beta) cos(alpha_n), and their tangents at all points are the same.

    studies/contact_lines.py --elastogear build/release/src/app/elastogear --out contact_lines [--size small]

Points of contact are those of the result on the faces of the undeformed mesh, so that they are off by what faces are flat and by the
deflection. A line is fitted to the points of every pair of teeth that has at least four of them, over at least --length of the face
width.
"""
import argparse
import os

import h5py
import numpy as np

from drive_runs import Drive, Refused

HERE = os.path.dirname(os.path.abspath(__file__))
# examples/drives/helical.yaml
MODULE, HELIX, WIDTH, TEETH, ALPHA = 2e-3, np.radians(20), 16e-3, (19, 52), np.radians(20)


def face_point(X, xi, eta):
    """Point of a face with corners X (4 x 3) at coordinates -1 .. 1."""
    return np.array([(1 - xi) * (1 - eta), (1 + xi) * (1 - eta), (1 + xi) * (1 + eta), (1 - xi) * (1 + eta)]) / 4 @ X


def points_in_world(drive, state):
    """Of each contact: its place on the master's face, m, the face's group, and its force, N."""
    places, groups = [], []
    with h5py.File(os.path.join(drive.folder, "pinion.h5")) as pinion, h5py.File(os.path.join(drive.folder, "wheel.h5")) as wheel, \
            h5py.File(drive.output) as result:
        for side, face, xi, eta in zip(*(state.points[name] for name in ("slave_side", "face", "xi", "eta"))):
            name, body = (("wheel", wheel), ("pinion", pinion))[side]
            surface, motion = body["surface"], result[f"bodies/{name}"]
            x = face_point(surface["X"][:][surface["face"][face]], xi, eta)
            places.append(motion["position"][-1] + motion["rotation"][-1] @ x)
            groups.append((name, int(surface["group"][face])))
    return np.array(places), groups


def plane_of_action(distance):
    """Foot of the tangent on the pinion's base circle, its direction and the normal of the plane; drive side, wheel at +x."""
    alpha_t = np.arctan(np.tan(ALPHA) / np.cos(HELIX))
    r_b = [MODULE * z / (2 * np.cos(HELIX)) * np.cos(alpha_t) for z in TEETH]
    working = np.arccos(sum(r_b) / distance)
    out = np.array([np.cos(working), -np.sin(working), 0])
    return r_b[0] * out, np.array([np.sin(working), np.cos(working), 0]), out


def lines(drive, state, length):
    """Angle of each line, deg, and distances of its points from the plane of action, m."""
    places, groups = points_in_world(drive, state)
    with h5py.File(drive.output) as result:
        distance = np.linalg.norm(result["bodies/wheel/position"][-1])
    foot, along, out = plane_of_action(distance)
    found = []
    for group in set(groups):
        x = places[[g == group for g in groups]] - foot
        if len(x) < 4 or np.ptp(x[:, 2]) < length * WIDTH:
            continue
        slope = np.polyfit(x[:, 2], x @ along, 1)[0]
        found.append((np.degrees(np.arctan(slope)), len(x), np.abs(x @ out).max()))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--size", default="small")
    parser.add_argument("--positions", type=int, default=10)
    parser.add_argument("--length", type=float, default=0.4)
    options = parser.parse_args()
    drive = Drive(options.elastogear, os.path.join(HERE, "..", "examples", "drives", "helical.yaml"), options.out,
                  ["-size", options.size])
    drive.reduce()
    theory = np.degrees(np.arcsin(np.sin(HELIX) * np.cos(ALPHA)))
    rows = []
    for roll in np.arange(options.positions) / options.positions:
        try:
            state = drive.at(roll)
        except Refused as why:
            print(f"roll {roll:.4f}: left out: {why}", flush=True)
            continue
        for angle, count, off in lines(drive, state, options.length):
            rows.append((abs(angle), off))
            print(f"roll {roll:.4f}: {count:3d} points, {angle:+8.3f} deg, within {1e6 * off:.1f} um of the plane of action", flush=True)
    angles, off = np.array(rows).T
    print(f"base helix angle {theory:.3f} deg; {len(angles)} lines: mean {angles.mean():.3f}, {angles.min():.3f} to {angles.max():.3f} deg; "
          f"points within {1e6 * off.max():.1f} um of the plane of action")


if __name__ == "__main__":
    main()
