#!/usr/bin/python3
"""Efficiency of the steering worm, worm and wheel driving, beside rigid kinematics and closed forms.

    studies/worm_efficiency.py --elastogear build/release/src/app/elastogear --out worm_efficiency [--size small]

Flanks of an involute worm and an involute helical wheel touch in points on one straight line with the direction n of their common
normal, through the pitch point (crossed helical gears). At a point x of it with the velocities v_1, v_2 of rigid gears the force on
the wheel is N (+-n + mu v/|v|), v = v_1 - v_2, and its powers on both gears are f.v_1 and f.v_2: their ratio is the efficiency of
the point, at the pitch point tan(gamma)/tan(gamma + rho') with the worm driving, tan(gamma - rho')/tan(gamma) with the wheel driving,
rho' = atan(mu/cos(alpha_n)). Over a pitch the powers are integrated under a constant torque on the worm. How pairs of teeth share
the load rigid gears leave open: once they are loaded equally, as far as the tips reach, once as in the sweep, at the points where rigid
pairs would be.

Of elastic gears: the efficiency of `evaluate`, and the ratio of the moments of contact on both gears at the two positions between
which a pair of teeth passes the pitch point, linearly between them; other pairs are loaded on both sides of it then. Of rigid ones in the
same contact: the ratio of the moments of the pair that is nearest to the pitch point alone.
"""
import argparse
import os
import subprocess
import sys

import h5py
import numpy as np

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
import figures

MODULE, ALPHA, STARTS, TEETH, DISTANCE = 2e-3, np.radians(15), 2, 41, 50e-3
RIGID = ("-worm_rigid", "true", "-wheel_rigid", "true", "-contact_law", "unilateral")
BACKLASH = 0.03 * MODULE  # normal, half of it off the teeth of each gear
EXAMPLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "drives", "steering_worm.yaml")


def lead_angle():
    """Both pitch radii add up to the centre distance."""
    low, high = np.radians(5), np.radians(30)
    for _ in range(60):
        middle = (low + high) / 2
        radii = MODULE / 2 * (STARTS / np.sin(middle) + TEETH / np.cos(middle))
        low, high = (middle, high) if radii > DISTANCE else (low, middle)
    return low


class Path:
    """The line of contact in a frame at the worm's axis: x along the worm, y along the wheel's axis, z to the wheel."""

    def __init__(self):
        self.gamma = lead_angle()
        self.r = MODULE / 2 * np.array([STARTS / np.sin(self.gamma), TEETH / np.cos(self.gamma)])
        across = np.array([np.cos(self.gamma), -np.sin(self.gamma), 0])  # of the teeth, in the pitch plane
        self.n = np.cos(ALPHA) * across + np.sin(ALPHA) * np.array([0, 0, 1])
        self.axis = np.array([[1.0, 0, 0], [0, 1.0, 0]])
        self.origin = np.array([[0.0, 0, 0], [0, 0, self.r.sum()]])

    def velocities(self, s):
        """Of both gears at P + s n, the worm at 1 rad/s, n x 3 each."""
        x = np.array([0, 0, self.r[0]]) + np.outer(s, self.n)
        v = [np.cross(self.axis[g], x - self.origin[g]) for g in (0, 1)]
        v[1] = v[1] * (v[0] @ self.n)[0] / (v[1] @ self.n)[0]
        return v

    def ends(self, tip):
        """Where the line leaves the tip cylinders, m along n; tip: both radii."""
        s = np.linspace(-0.05, 0.05, 200001)
        x = np.array([0, 0, self.r[0]]) + np.outer(s, self.n)
        radius = [np.linalg.norm(np.cross(self.axis[g], x - self.origin[g]), axis=1) for g in (0, 1)]
        inside = s[(radius[0] <= tip[0]) & (radius[1] <= tip[1])]
        return inside[0], inside[-1]

    def powers(self, s, mu, worm_drives):
        """Per normal force, of the worm and on the wheel: W/N at 1 rad/s of the worm."""
        v_1, v_2 = self.velocities(s)
        slip = v_1 - v_2
        assert np.abs(slip @ self.n).max() < 1e-12  # flanks neither part nor enter
        push = np.sign(v_2 @ self.n)[:, None] * self.n * (1 if worm_drives else -1)
        f = push + mu * slip / np.linalg.norm(slip, axis=1)[:, None]
        return np.sum(f * v_1, axis=1), np.sum(f * v_2, axis=1)

    def efficiency(self, s, mu, worm_drives):
        p_1, p_2 = self.powers(np.atleast_1d(s), mu, worm_drives)
        return p_2 / p_1 if worm_drives else p_1 / p_2

    def over_pitch(self, tip, mu, worm_drives, n=2000):
        """Mean output over mean input, contact ratio."""
        begin, end = self.ends(tip)
        pitch = np.pi * MODULE * np.cos(ALPHA)  # normal base pitch
        ratio, bearing = [], []
        for first in begin + pitch * (np.arange(n) + 0.5) / n:
            p_1, p_2 = self.powers(np.arange(first, end, pitch), mu, worm_drives)
            ratio.append(p_2.sum() / p_1.sum())  # at a constant torque on the worm
            bearing.append(p_1.size)
        mean = np.mean(ratio)
        return mean if worm_drives else 1 / mean, np.mean(bearing)


    def with_shares(self, places, shares, ends, mu, worm_drives):
        """Mean output over mean input of positions, each with its pairs at places (m) that carry shares; n_t x n both."""
        ratio = []
        for s, share in zip(places, shares):
            p_1, p_2 = self.powers(np.clip(s, *ends), mu, worm_drives)
            ratio.append((share * p_2).sum() / (share * p_1).sum())
        mean = np.mean(ratio)
        return mean if worm_drives else 1 / mean


def formula(gamma, mu, worm_drives):
    rho = np.arctan(mu / np.cos(ALPHA))
    return np.tan(gamma) / np.tan(gamma + rho) if worm_drives else np.tan(gamma - rho) / np.tan(gamma)


def run(program, folder, *words):
    done = subprocess.run([os.path.abspath(program), *map(str, words)], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{folder}: {' '.join(map(str, words))}: {done.stderr[-2000:]}")


def nearest_pair(path, pair, worm_drives):
    """Of the pair of teeth nearest to the pitch point: its place (m), and its efficiency by the moments of its force on both gears."""
    with h5py.File(path, "r") as file:
        group = file["contact/worm:wheel/groups/b"]
        force, torque = (group[kind][:].reshape(-1, TEETH, 2, 3).sum(axis=2) for kind in ("force", "torque"))
        origin = [file[f"bodies/{body}/position"][:] for body in ("worm", "wheel")]
        axis = [file[f"bodies/{body}/rotation"][:] @ np.array([0.0, 0, 1]) for body in ("worm", "wheel")]
    places = np.where(pair["teeth/share"][:] > 0.01, rigid_places(pair, worm_drives), np.inf)
    step, column = np.unravel_index(np.argmin(np.abs(places)), places.shape)
    tooth = int(pair["teeth/tooth"][column, 1]) - 1
    f, m = force[step, tooth], torque[step, tooth]
    moment = [abs((m - np.cross(origin[g][step], f)) @ axis[g][step]) for g in (0, 1)]
    eta = moment[1] * STARTS / (moment[0] * TEETH)
    return places[step, column], eta if worm_drives else 1 / eta


def rigid_places(pair, worm_drives):
    """Places of the pairs of teeth on the line, m from the pitch point and > 0 towards the wheel, were they rigid. They move by a normal
    base pitch with each pitch, from the root of the driving gear to its tip. The driven flank of the wheel, the trailing one, passes the
    pitch point half a tooth's thickness behind its centre; the driving one as far before it."""
    sense = 1 if worm_drives else -1
    half_tooth = 0.25 - BACKLASH / (4 * np.pi * MODULE * np.cos(ALPHA))
    return sense * np.pi * MODULE * np.cos(ALPHA) * (pair["teeth/place"][:] - sense * half_tooth)


def sweep(options, folder, common, name, mu, side, more):
    """Result and evaluation of a sweep, unless they are there."""
    if os.path.exists(os.path.join(folder, name + "_evaluation.h5")):
        return
    run(options.elastogear, folder, "simulate", *common, "-analysis", "sweep", "-sweep_positions", options.positions, "-contact_friction", mu,
        "-side", side, "-output", name + ".h5", "-contact_points", "minima", *more)
    run(options.elastogear, folder, "evaluate", *common, "-side", side, "-result", name + ".h5", "-output", name + "_evaluation.h5",
        "-root_stress", "false")


def passing(pair, places, worm_drives):
    """Efficiency by the moments on both gears where a pair of teeth passes the pitch point; a sweep over one pitch has one such place."""
    ratio = np.abs(pair["torque/second"][:] / pair["torque/first"][:]) * STARTS / TEETH
    for column in places.T:
        change = np.flatnonzero(column[:-1] * column[1:] <= 0)
        if change.size:
            i = change[0]
            share = column[i] / (column[i] - column[i + 1])
            at = (1 - share) * ratio[i] + share * ratio[i + 1]
            return at if worm_drives else 1 / at
    sys.exit("no pair of teeth passes the pitch point between two positions: sweep more of them")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--size", default="small")
    parser.add_argument("--positions", type=int, default=32)
    parser.add_argument("--tip", type=float, nargs=2, default=(18.8553, 89.1447), help="tip diameters of worm and wheel, mm, as mesh prints them")
    options = parser.parse_args()
    folder = os.path.join(options.out, options.size)
    os.makedirs(folder, exist_ok=True)
    drive = os.path.abspath(EXAMPLE)
    line, tip = Path(), np.array(options.tip) / 2e3
    print(f"lead angle {np.degrees(line.gamma):.3f} deg, line of contact {1e3 * line.ends(tip)[0]:.3f} to {1e3 * line.ends(tip)[1]:.3f} mm")
    common = [drive, "-size", options.size]
    if not os.path.exists(os.path.join(folder, "wheel.h5")):
        run(options.elastogear, folder, "reduce", *common)
    for mu in (0.02, 0.05, 0.1):
        for side, worm_drives in (("drive", True), ("coast", False)):
            name = f"{side}_{mu}"
            for kind, more in (("", ()), ("rigid_", RIGID)):
                sweep(options, folder, common, kind + name, mu, side, more)
            with h5py.File(os.path.join(folder, f"rigid_{name}_evaluation.h5"), "r") as file:
                near = nearest_pair(os.path.join(folder, f"rigid_{name}.h5"), file[f"cases/rigid_{name}/worm:wheel"], worm_drives)
            with h5py.File(os.path.join(folder, name + "_evaluation.h5"), "r") as file:
                pair = file[f"cases/{name}/worm:wheel"]
                found, ratio = pair["losses/efficiency"][()], pair["teeth/contact_ratio"][()]
                places = rigid_places(pair, worm_drives)
                at_pitch_point = passing(pair, places, worm_drives)
                shared = line.with_shares(places, pair["teeth/share"][:], line.ends(tip), mu, worm_drives)
            rigid, contact_ratio = line.over_pitch(tip, mu, worm_drives)
            exact = formula(line.gamma, mu, worm_drives)
            assert abs(line.efficiency(0, mu, worm_drives)[0] - exact) < 1e-12
            print(f"mu {mu}, {'worm' if worm_drives else 'wheel'} drives: formula {exact:.5f}; rigid, pair {1e3 * near[0]:+.2f} mm from the pitch "
                  f"point {near[1]:.5f}, {100 * (near[1] / exact - 1):+.3f} %; elastic, pair at the pitch point {at_pitch_point:.5f}, "
                  f"{100 * (at_pitch_point / exact - 1):+.3f} %; over a pitch {found:.5f}, rigid with the shares found "
                  f"{shared:.5f}, {100 * (found / shared - 1):+.3f} %, with equal ones {rigid:.5f}, {100 * (found / rigid - 1):+.3f} %; "
                  f"contact ratio {ratio:.2f}, rigid {contact_ratio:.2f}", flush=True)
            figures.figure("efficiency of a worm drive", "efficiency over a pitch", found / shared - 1, unit="%")


if __name__ == "__main__":
    main()
