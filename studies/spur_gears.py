#!/usr/bin/python3
"""Two spur gears (z = 18 and 27, m = 4 mm, b = 10 mm, alpha = 20 deg) meshed by Gmsh, at rest under 100 N m at angles over one
pitch, with the program's default settings:

    studies/spur_gears.py --elastogear build/release/src/app/elastogear --out spur_gears

The normals of all contacts of involutes touch the base circle: without friction the sum of the normal forces is T / r_b =
2956.0 N at every angle. Six teeth of each gear, on a rim that is held at its bore; flanks are splines through points of the
involutes, their fillets circles. --elements: hex8, hex20 or tet10; what follows `--` goes to elastogear simulate.
"""
import argparse
import os
import subprocess
import sys
import time

import numpy as np

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
import figures
import results

MODULE, WIDTH, ALPHA = 4e-3, 10e-3, np.radians(20)
TEETH = {"pinion": 18, "wheel": 27}
DISTANCE = MODULE * sum(TEETH.values()) / 2
BACKLASH = 50e-6  # m, normal
FILLET, DEDENDUM, RIM = 0.3 * MODULE, 1.25 * MODULE, 2.5 * MODULE
COUNT = 6  # teeth of each mesh, an even number
TORQUE = 100  # N m
FLANK_POINTS = 21


def involute(angle):
    return np.tan(angle) - angle


def base_radius(z):
    return MODULE * z / 2 * np.cos(ALPHA)


class Outline:
    """Points and curves of one gear in the words of Gmsh; the middle of its teeth lies along x."""

    def __init__(self):
        self.text, self.n_points, self.n_curves = "", 0, 0

    def point(self, r, angle, h):
        self.n_points += 1
        self.text += f"Point({self.n_points}) = {{{r * np.cos(angle):.15g}, {r * np.sin(angle):.15g}, 0, {h:.6g}}};\n"
        return self.n_points

    def curve(self, kind, points):
        self.n_curves += 1
        self.text += f"{kind}({self.n_curves}) = {{{', '.join(map(str, points))}}};\n"
        return self.n_curves


def outline(z, h):
    """The text for Gmsh, the outline's curves in order, and the flanks among them: (curve, tooth, side)."""
    o = Outline()
    r_b, r_f, r_a, bore = base_radius(z), MODULE * z / 2 - DEDENDUM, MODULE * (z / 2 + 1), MODULE * z / 2 - DEDENDUM - RIM
    half = np.pi / (2 * z) + involute(ALPHA) - BACKLASH / (4 * r_b)  # of a tooth at the base circle
    r_c = r_f + FILLET
    turn = np.arcsin(FILLET / r_c)  # from a flank to the middle of its fillet
    center, curves, flanks = o.point(0, 0, h), [], []
    coarse, fine = 8 * h, h

    def flank(middle, side):
        """From the root to the tip: end of the root's arc, points of the curves, and the curves."""
        at = middle + side * half
        root, fillet = o.point(r_f, at + side * turn, fine), o.point(r_c, at + side * turn, fine)
        foot = o.point(r_c * np.cos(turn), at, fine)
        radii = np.linspace(1, r_a / r_b, FLANK_POINTS)
        points = [o.point(r_b * q, at - side * involute(np.arccos(1 / q)), fine) for q in radii]
        return root, points[-1], [("Circle", [root, fillet, foot]), ("Line", [foot, points[0]]), ("Spline", points)]

    def draw(parts, backwards):
        made = [o.curve(kind, points[::-1] if backwards else points) for kind, points in (parts[::-1] if backwards else parts)]
        curves.extend(made)
        return made[0] if backwards else made[-1]

    ends = np.array([-COUNT / 2, COUNT / 2]) * 2 * np.pi / z
    inner = [o.point(bore, a, coarse) for a in (ends[0], 0, ends[1])]
    last = first = o.point(r_f, ends[0], fine)
    for tooth in range(COUNT):
        middle = (tooth - (COUNT - 1) / 2) * 2 * np.pi / z
        root, tip, parts = flank(middle, -1)
        curves.append(o.curve("Circle", [last, center, root]))
        flanks.append((draw(parts, False), tooth, "right"))
        last, other_tip, parts = flank(middle, 1)
        curves.append(o.curve("Circle", [tip, center, other_tip]))
        flanks.append((draw(parts, True), tooth, "left"))
    end = o.point(r_f, ends[1], fine)
    curves.append(o.curve("Circle", [last, center, end]))
    curves.append(o.curve("Line", [end, inner[2]]))
    bores = [o.curve("Circle", [inner[2], center, inner[1]]), o.curve("Circle", [inner[1], center, inner[0]])]
    curves += bores + [o.curve("Line", [inner[0], first])]
    return o.text, curves, flanks, bores


def geometry(z, elements, faces, layers):
    """The text of a Gmsh file: the outline, extruded to the gear's width."""
    h = 2.4 * MODULE / faces
    text, curves, flanks, bores = outline(z, h)
    quadrilaterals = elements.startswith("hex")
    for curve, _, _ in flanks:
        text += f"Transfinite Curve {{{curve}}} = {faces + 1};\n"
    text += f"Curve Loop(1) = {{{', '.join(map(str, curves))}}};\nPlane Surface(1) = {{1}};\n"
    recombine = "Recombine;" if quadrilaterals else ""
    if quadrilaterals:
        text += "Recombine Surface {1};\nMesh.Algorithm = 6;\nMesh.RecombinationAlgorithm = 1;\n"
    # Extruded surfaces come in the order of the loop's curves behind the top and the volume.
    text += f"out[] = Extrude {{0, 0, {WIDTH:g}}} {{ Surface{{1}}; Layers{{{layers}}}; {recombine} }};\n"
    side = {curve: f"out[{2 + i}]" for i, curve in enumerate(curves)}
    text += 'Physical Volume("gear") = {out[1]};\n'
    text += f'Physical Surface("bore") = {{{", ".join(side[b] for b in bores)}}};\n'
    for curve, tooth, name in flanks:
        text += f'Physical Surface("tooth_{tooth}_{name}") = {{{side[curve]}}};\n'
    text += f"Mesh.ElementOrder = {1 if elements == 'hex8' else 2};\nMesh.SecondOrderIncomplete = {int(elements == 'hex20')};\n"
    return text + "Mesh.MshFileVersion = 4.1;\n"


def run(command, folder, log):
    with open(os.path.join(folder, log), "a", encoding="utf-8") as out:
        subprocess.run(command, cwd=folder, stdout=out, stderr=subprocess.STDOUT, check=True)


def reduce(program, folder, elements, faces, layers):
    for name, z in TEETH.items():
        with open(os.path.join(folder, name + ".geo"), "w", encoding="utf-8") as file:
            file.write(geometry(z, elements, faces, layers))
        # A torque along +z presses the pinion's left flanks on the wheel's, which is turned by pi, on its left ones.
        touching = ", ".join(f"tooth_{tooth}_left" for tooth in range(COUNT))
        with open(os.path.join(folder, name + ".yaml"), "w", encoding="utf-8") as file:
            file.write(f"mesh: {name}.msh\nmaterial: {{E: 210e9, nu: 0.3, rho: 7850}}\nrestrain: [bore]\nsurface: [{touching}]\n"
                       f"modes: 20\noutput: {name}.h5\n")
        if not os.path.exists(os.path.join(folder, name + ".h5")):
            run(["gmsh", "-3", name + ".geo", "-o", name + ".msh"], folder, "mesh.log")
            run([program, "reduce", name + ".yaml"], folder, f"reduce_{name}.log")


def equilibrium(program, folder, angle, more):
    """Sum of normal forces (N), angle by which the pinion is ahead of rigid gears in contact (rad), and time (s)."""
    ratio = TEETH["pinion"] / TEETH["wheel"]
    shift = np.pi / TEETH["pinion"]  # turns a tooth of the pinion into the space that the wheel has there
    with open(os.path.join(folder, "drive.yaml"), "w", encoding="utf-8") as file:
        file.write("bodies: [pinion, wheel]\n"
                   f"pinion: {{file: pinion.h5, joint: revolute, axis: [0, 0, 1], angle0: {angle + shift:.15g}, torque: {TORQUE}}}\n"
                   f"wheel: {{file: wheel.h5, joint: fixed, position: [{DISTANCE:.15g}, 0, 0],\n"
                   f"        rotation: [0, 0, {np.pi - angle * ratio:.15g}]}}\n"
                   "contact: {pairs: [pinion:wheel]}\nanalysis: static\nsimulate: {output: drive.h5}\n")
    start = time.monotonic()
    run([program, "simulate", "drive.yaml", *more], folder, "simulate.log")
    seconds = time.monotonic() - start
    with results.open_file(os.path.join(folder, "drive.h5"), "result") as file:
        points = file["contact/pinion:wheel/points"]
        force = np.linalg.norm(points["force"][points["offset"][-2]:], axis=1).sum()
        play = BACKLASH / 2 / base_radius(TEETH["pinion"])
        return force, file["bodies/pinion/rigid"][-1, 0] - angle - shift - play, seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--elements", nargs="+", default=["hex8", "hex20", "tet10"])
    parser.add_argument("--faces", type=int, default=16, help="along a flank")
    parser.add_argument("--layers", type=int, default=4, help="across the width")
    parser.add_argument("--angles", type=int, default=10, help="over a pitch")
    options, more = parser.parse_known_args()
    more = [word for word in more if word != "--"]
    program, r_b = os.path.abspath(options.elastogear), base_radius(TEETH["pinion"])
    print(f"sum of normal forces: {TORQUE / r_b:.1f} N")
    for elements in options.elements:
        folder = os.path.join(options.out, f"{elements}_{options.faces}")
        os.makedirs(folder, exist_ok=True)
        reduce(program, folder, elements, options.faces, options.layers)
        angles = np.arange(options.angles) / options.angles * 2 * np.pi / TEETH["pinion"]
        rows = np.array([equilibrium(program, folder, angle, more) for angle in angles])
        for angle, (force, error, seconds) in zip(angles, rows):
            print(f"{elements:6s} {np.degrees(angle):8.3f} deg  {force:9.2f} N  {1e6 * r_b * error:9.3f} um  {seconds:5.1f} s", flush=True)
        print(f"{elements:6s} mean {rows[:, 0].mean():9.2f} N, {100 * (rows[:, 0].mean() * r_b / TORQUE - 1):+.3f} %; transmission error "
              f"{1e6 * r_b * rows[:, 1].mean():.3f} um, {1e6 * r_b * np.ptp(rows[:, 1]):.3f} um peak to peak; at most {rows[:, 2].max():.1f} s", flush=True)
        figures.figure("two spur gears of another mesher", "sum of normal forces", rows[:, 0].mean() * r_b / TORQUE - 1, unit="%")


if __name__ == "__main__":
    main()
