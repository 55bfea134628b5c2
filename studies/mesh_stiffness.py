#!/usr/bin/python3
"""Stiffness of the teeth of example 1 of ISO/TR 6336-30 by elastic bodies: m_n = 8 mm, z = 17/103, b = 100 mm, beta = 15.8 deg,
x = 0.145/0, a = 500 mm, E = 206 GPa, 9 kN m on the pinion.

    studies/mesh_stiffness.py --elastogear build/release/src/app/elastogear --out mesh_stiffness [--size tiny] [--bore 0.4]

Of positions over a pitch, with delta the way by which the pinion is ahead of rigid gears, along the transverse line of action (its
angle times its base radius), and F_bt = T_1 / r_b1:
    c_gamma   mean of F_bt / (b delta)
    c'        largest F_i / (b delta) of one pair of teeth, F_i its part of F_bt
The discs are held at their bores, --bore times the root diameter: delta has their torsion between bore and root in it,
T / (4 pi G b) (1/r_i^2 - 1/r_f^2), which the stiffness of teeth has not. It is printed and taken off in the second line of results.
"""
import argparse
import os

import numpy as np

from drive_runs import Drive, Refused, results

MODULE, HELIX, WIDTH, TEETH, SHIFTS, DISTANCE = 8e-3, np.radians(15.8), 0.1, (17, 103), (0.145, 0), 0.5
E, NU, DEDENDUM, ALPHA = 206e9, 0.3, 1.4, np.radians(20)
STANDARD = {"c'": 12.37, "c_gamma": 17.47}  # N/(mm um); FACTOR is what it takes off the stiffness of theory
FACTOR = 0.8


def root_radius(gear):
    return MODULE * (TEETH[gear] / (2 * np.cos(HELIX)) + SHIFTS[gear] - DEDENDUM)


def base_radii():
    alpha_t = np.arctan(np.tan(ALPHA) / np.cos(HELIX))
    return [MODULE * z / (2 * np.cos(HELIX)) * np.cos(alpha_t) for z in TEETH]


def drive_text(torque, bore):
    gears = [f"{name}: {{teeth: {z}, profile_shift: {x}, bore: {2e3 * bore * root_radius(i):.6g} mm}}\n"
             for i, (name, z, x) in enumerate(zip(("pinion", "wheel"), TEETH, SHIFTS))]
    return (f"drive: cylindrical\nmodule: 8 mm\nhelix_angle: 15.8 deg\nrack: D\nface_width: 100 mm\ncentre_distance: 500 mm\n"
            f"{''.join(gears)}material: {{E: {E}, nu: {NU}, rho: 7850}}\nmodes: 10\ntorque: {torque} N m\n")


def torsion(torque, bore):
    """Of both discs, m along the line of action."""
    G, sum_ = E / (2 * (1 + NU)), 0
    for gear, r_b in enumerate(base_radii()):
        r_f = root_radius(gear)
        r_i = bore * r_f
        force = torque / base_radii()[0]
        sum_ += force * r_b**2 / (4 * np.pi * G * WIDTH) * (1 / r_i**2 - 1 / r_f**2)
    return sum_


def shares(drive, state):
    """Normal force of each tooth of the pinion, N."""
    with results.open_file(drive.output, "result") as file:
        return np.linalg.norm(file[f"contact/{state.pair_name}/groups/a/force"][-1], axis=1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--size", default="tiny")
    parser.add_argument("--bore", type=float, default=0.4, help="of the root diameters")
    parser.add_argument("--torque", type=float, default=9000, help="N m")
    parser.add_argument("--positions", type=int, default=16)
    parser.add_argument("--points", choices=("minima", "stations"), default="minima", help="of contact")
    options = parser.parse_args()
    folder = os.path.join(options.out, f"{options.size}_{options.bore:g}")
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, "drive.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(drive_text(options.torque, options.bore))
    drive = Drive(options.elastogear, path, folder, ["-size", options.size])
    drive.reduce()
    r_b, beta_b = base_radii()[0], np.arcsin(np.sin(HELIX) * np.cos(ALPHA))
    load, twist = options.torque / r_b, torsion(options.torque, options.bore)
    ways, largest = [], []
    for roll in np.arange(options.positions) / options.positions:
        try:
            state = drive.at(roll, points=options.points)
        except Refused as why:
            print(f"roll {roll:.4f}: left out: {why}", flush=True)
            continue
        forces = shares(drive, state) * np.cos(beta_b)
        ways.append((state.angle - state.start) * r_b)
        largest.append(forces.max())
        print(f"roll {roll:.4f}: delta {1e6 * ways[-1]:.3f} um; teeth carry {np.sort(forces[forces > 0])[::-1].round(0)} of {load:.0f} N", flush=True)
    ways, largest = np.array(ways), np.array(largest)
    print(f"F_bt/b = {1e-3 * load / WIDTH:.0f} N/mm; delta {1e6 * ways.mean():.2f} um, {1e6 * np.ptp(ways):.2f} um peak to peak; torsion of the discs {1e6 * twist:.2f} um")
    for name, way in (("as it is", ways), ("without torsion", ways - twist)):
        found = {"c'": (largest / WIDTH / way).max() * 1e-9, "c_gamma": (load / WIDTH / way).mean() * 1e-9}
        print(f"{options.size}, bore {options.bore:g}, {name}: " + "; ".join(
            f"{key} = {value:.2f} N/(mm um), {value / STANDARD[key]:.3f} of the standard's (1 to {1 / FACTOR:g})" for key, value in found.items()))


if __name__ == "__main__":
    main()
