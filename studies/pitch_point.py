#!/usr/bin/python3
"""Pressure at the pitch point of the test gears C14 (examples/drives/spur_c14.yaml) beside H. Hertz's for two cylinders, 1347 MPa.

    studies/pitch_point.py --elastogear build/release/src/app/elastogear --out pitch_point [--faces 0.1 0.05]

Two ways: meshes of the drive file's sizes (--sizes), whose faces are wider than the patch of 0.40 mm; and one tooth of each gear on a
sector of its disc, meshed by Gmsh with --faces (mm) wide faces around the pitch point, in the place of the drive's bodies: the drive
file places them, and their flanks are the exact ones. Pressures are those of contact integrated over faces.
"""
import argparse
import os
import re
import subprocess

import numpy as np

from drive_runs import Drive, involute, results

HERE = os.path.dirname(os.path.abspath(__file__))
MODULE, ALPHA, WIDTH, TORQUE, E, NU, DISTANCE = 4.5e-3, np.radians(20), 14e-3, 200, 206e9, 0.3, 91.5e-3
TEETH, SHIFTS, TIPS = {"pinion": 16, "wheel": 24}, {"pinion": 0.1817, "wheel": 0.1715}, {"pinion": 82.635e-3, "wheel": 118.544e-3}
BACKLASH = 0.03 * MODULE
STRIP = 0.7e-3  # m, to either side of the pitch point, with fine faces
LAYERS = 8


def base_radius(gear):
    return MODULE * TEETH[gear] / 2 * np.cos(ALPHA)


WORKING = np.arccos(sum(base_radius(gear) for gear in TEETH) / DISTANCE)


def psi(gear, r):
    """Half the tooth thickness as an angle."""
    s = MODULE * (np.pi / 2 + 2 * SHIFTS[gear] * np.tan(ALPHA)) - BACKLASH / 2 / np.cos(ALPHA)
    return s / (MODULE * TEETH[gear]) + involute(ALPHA) - involute(np.arccos(base_radius(gear) / r))


def hertz():
    """Normal force, N; pressure, Pa; half width, m."""
    force = TORQUE / base_radius("pinion")
    curvature = sum(1 / (base_radius(gear) * np.tan(WORKING)) for gear in TEETH)
    modulus = E / (2 * (1 - NU**2))
    pressure = np.sqrt(force / WIDTH * modulus * curvature / np.pi)
    return force, pressure, 2 * force / WIDTH / (np.pi * pressure)


def sector(gear, number, h):
    """Text for Gmsh of a tooth on a sector of its disc; tooth 1 stands on +y."""
    z, r_a = TEETH[gear], TIPS[gear] / 2
    r_w, r_f = base_radius(gear) / np.cos(WORKING), MODULE * (z / 2 + SHIFTS[gear] - 1.25)
    pitch, inner = 2 * np.pi / z, 0.4 * r_f
    middle = np.pi / 2 + (number - 1) * pitch
    low, high = max(r_f + 0.3 * MODULE, base_radius(gear) * 1.0005), r_a
    points, curves = [], []

    def point(r, angle, size):
        points.append(f"Point({len(points) + 1}) = {{{r * np.cos(middle + angle):.15g}, {r * np.sin(middle + angle):.15g}, {-WIDTH / 2:g}, {size:g}}};")
        return len(points)

    def curve(kind, ids):
        curves.append(f"{kind}({len(curves) + 1}) = {{{', '.join(map(str, ids))}}};")
        return len(curves)

    coarse, rough = 2e-3, 0.6e-3

    def flank(side, radii, size):
        return [point(r, side * psi(gear, r), size) for r in radii]
    # A way along the flank is r dr / (r_b tan alpha) long; near the pitch point dr = sin(alpha) times it.
    edge = STRIP * np.sin(WORKING)
    cuts = [low, r_w - edge, r_w + edge, high]
    left, ends = [], None
    sizes = [rough, h, h, rough]
    corner = [point(r, psi(gear, r), s) for r, s in zip(cuts, sizes)]
    for k in range(3):
        inside = [point(r, psi(gear, r), h) for r in np.linspace(cuts[k], cuts[k + 1], 12)[1:-1]]
        left.append(curve("Spline", [corner[k], *inside, corner[k + 1]]))
    right = flank(-1, np.linspace(low, high, 15), coarse)
    center = point(0, 0, coarse)
    foot, foot_right = point(r_f, psi(gear, low), 1e-3), point(r_f, -psi(gear, low), coarse)
    ends = [point(r_f, side * 1.5 * pitch, coarse) for side in (1, -1)]
    bore = [point(inner, angle, coarse) for angle in (1.5 * pitch, 0, -1.5 * pitch)]
    loop = left + [curve("Circle", [corner[3], center, right[-1]]), curve("Spline", right[::-1]), curve("Line", [right[0], foot_right]),
                   curve("Circle", [foot_right, center, ends[1]]), curve("Line", [ends[1], bore[2]]),
                   curve("Circle", [bore[2], center, bore[1]]), curve("Circle", [bore[1], center, bore[0]]),
                   curve("Line", [bore[0], ends[0]]), curve("Circle", [ends[0], center, foot]), curve("Line", [foot, corner[0]])]
    held = [loop.index(c) for c in loop[8:10]]
    text = "\n".join(points + curves) + f"\nTransfinite Curve {{{left[1]}}} = {int(round(2 * STRIP / h)) + 1};\n"
    text += f"Curve Loop(1) = {{{', '.join(map(str, loop))}}};\nPlane Surface(1) = {{1}};\nRecombine Surface {{1}};\n"
    text += "Mesh.Algorithm = 6;\nMesh.RecombinationAlgorithm = 1;\n"
    text += f"out[] = Extrude {{0, 0, {WIDTH:g}}} {{ Surface{{1}}; Layers{{{LAYERS}}}; Recombine; }};\n"
    text += 'Physical Volume("gear") = {out[1]};\n'
    text += f'Physical Surface("bore") = {{{", ".join(f"out[{2 + i}]" for i in held)}}};\n'
    text += f'Physical Surface("tooth_{number:02d}_left") = {{out[3]}};\n'  # the strip is the second curve of the loop
    return text + "Mesh.ElementOrder = 1;\nMesh.MshFileVersion = 4.1;\n"


def touching(drive):
    """Numbers of the teeth that carry most, by name of the gear."""
    with results.open_file(drive.output, "result") as file:
        groups = file["contact/pinion:wheel/groups"]
        found = {}
        for gear, side in (("pinion", "a"), ("wheel", "b")):
            forces = np.linalg.norm(groups[f"{side}/force"][-1], axis=1)
            found[gear] = int(re.search(r"_(\d+)_left", results.text(groups[f"{side}/name"][forces.argmax()])).group(1))
        return found


def run(command, folder):
    subprocess.run(command, cwd=folder, check=True, capture_output=True)


def local_bodies(program, folder, numbers, h):
    os.makedirs(folder, exist_ok=True)
    files = []
    for gear, number in numbers.items():
        with open(os.path.join(folder, gear + ".geo"), "w", encoding="utf-8") as file:
            file.write(sector(gear, number, h))
        with open(os.path.join(folder, gear + ".yaml"), "w", encoding="utf-8") as file:
            file.write(f"mesh: {gear}.msh\nmaterial: {{E: {E}, nu: {NU}, rho: 7850}}\nrestrain: [bore]\nsurface: [tooth_{number:02d}_left]\n"
                       f"modes: 10\nstore: surface\noutput: {gear}.h5\n")
        run(["gmsh", "-3", gear + ".geo", "-o", gear + ".msh"], folder)
        run([os.path.abspath(program), "reduce", gear + ".yaml"], folder)
        files += [f"-{gear}_file", os.path.abspath(os.path.join(folder, gear + ".h5"))]
    return files


def print_pressure(name, state, p_H):
    pressure = state.points["pressure"]
    print(f"{name}: largest pressure {1e-6 * pressure.max():.1f} MPa, {100 * (pressure.max() / p_H - 1):+.1f} %; sum of forces {state.force.sum():.1f} N", flush=True)


def print_rows(drive, state, body_file, p_H):
    """Largest pressure in each plane across the face width, and the share of the load per width."""
    slave = results.open_file(body_file, "body")
    X = slave["surface/X"][:]
    z = X[state.points["slave_node"], 2].round(9)
    layer = WIDTH / LAYERS
    for plane in np.unique(z):
        on = z == plane
        wide = layer if abs(plane) < WIDTH / 2 - 1e-6 else layer / 2
        line = state.force[on].sum() / wide / (state.force.sum() / WIDTH)
        peak = state.points["pressure"][on].max()
        print(f"    z = {1e3 * plane:+7.3f} mm: {1e-6 * peak:7.1f} MPa, {100 * (peak / p_H - 1):+6.1f} %; load {line:.3f} of the mean; "
              f"Hertz under it {100 * (peak / (p_H * np.sqrt(line)) - 1):+.1f} %", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--sizes", nargs="*", default=["small", "medium"])
    parser.add_argument("--faces", nargs="*", type=float, default=[0.1, 0.05], help="mm")
    options = parser.parse_args()
    force, p_H, half = hertz()
    print(f"H. Hertz: {force:.1f} N, {1e-6 * p_H:.1f} MPa, half width {1e3 * half:.4f} mm", flush=True)
    roll = 1 - psi("pinion", base_radius("pinion") / np.cos(WORKING)) * TEETH["pinion"] / (2 * np.pi)
    path = os.path.join(HERE, "..", "examples", "drives", "spur_c14.yaml")
    for size in options.sizes:
        drive = Drive(options.elastogear, path, os.path.join(options.out, size), ["-size", size])
        drive.reduce()
        for points in ("minima", "faces"):
            print_pressure(f"{size}, {points}", drive.at(roll, "-contact_points", points), p_H)
    numbers = touching(drive)
    for h in options.faces:
        folder = os.path.join(options.out, f"faces_{h:g}")
        files = local_bodies(options.elastogear, folder, numbers, 1e-3 * h)
        state = drive.at(roll, *files, "-contact_points", "faces")
        print_pressure(f"faces of {h:g} mm", state, p_H)
        print_rows(drive, state, files[1], p_H)


if __name__ == "__main__":
    main()
