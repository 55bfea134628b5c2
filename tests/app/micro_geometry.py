#!/usr/bin/env python3
"""Micro-geometry, misalignment and bearings of a spur drive, and misalignment of a worm drive. Rigid gears under a vanishing torque, against closed forms
and against profiles that are brought into touch in the plane, point by point; elastic gears, against a mesh
that was made with the modified flanks.

  micro_geometry.py PATH/TO/elastogear
"""

import os
import re
import subprocess
import sys
import tempfile

import h5py
import numpy as np

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts"))
from figures import figure

DRIVE = """drive: cylindrical
element_order: 1
module: 3 mm
face_width: 25 mm
pinion: {teeth: 17, profile_shift: 0.3}
wheel: {teeth: 43, profile_shift: 0.1}
torque: 300 N m
modes: 10
"""
M, ALPHA, WIDTH, BACKLASH = 3e-3, np.radians(20), 25e-3, 0.09e-3  # m, rad
TEETH, SHIFT = (17, 43), (0.3, 0.1)
UM = 1e-6
ALLOWED = 0.03 * UM  # of rigid gears at size tiny
KINK = 0.2 * UM  # what polynomials over a face leave of a kink
SAME = 0.01  # of elastic gears on either mesh


def inv(alpha):
    return np.tan(alpha) - alpha


ANGLES = np.linspace(0.2, 0.6, 400001)
ALPHA_W = np.interp(inv(ALPHA) + 2 * sum(SHIFT) * np.tan(ALPHA) / sum(TEETH), inv(ANGLES), ANGLES)
R = [M * z / 2 for z in TEETH]
R_B = [r * np.cos(ALPHA) for r in R]
R_A = [r + (1 + x) * M for r, x in zip(R, SHIFT)]
A = sum(R_B) / np.cos(ALPHA_W)
P_B = np.pi * M * np.cos(ALPHA)
TIP = [np.sqrt(r_a**2 - r_b**2) for r_a, r_b in zip(R_A, R_B)]  # lengths of roll
START = [A * np.sin(ALPHA_W) - TIP[1], A * np.sin(ALPHA_W) - TIP[0]]
RELIEF = [TIP[i] - START[i] - P_B for i in (0, 1)]


def no_relief(roll):
    return 0 * roll


class Profile:
    """Polar coordinates of the left flank of a tooth, from the middle of the tooth."""

    def __init__(self, gear, removed):
        roll = np.linspace(START[gear], TIP[gear], 20001)
        r_b = R_B[gear]
        alpha = np.arctan(roll / r_b)
        thickness = np.pi / 2 + 2 * SHIFT[gear] * np.tan(ALPHA) - BACKLASH / 2 / np.cos(ALPHA) / M
        psi = thickness / TEETH[gear] + inv(ALPHA) - inv(alpha)
        # the normal of an involute is tangent to its base circle, at the angle alpha from the circumference
        x = r_b / np.cos(alpha) * np.exp(1j * psi) - removed(roll) * 1j * np.exp(1j * (psi - alpha))
        order = np.argsort(abs(x))
        self.radius, self.angle = abs(x)[order], np.angle(x)[order]

    def place(self, centre, angle):
        return centre + self.radius * np.exp(1j * (self.angle + angle))


def touching_angle(own, centre, points, near_angle):
    """By how much more than near_angle the flank `own` must turn counter-clockwise to touch the first point."""
    x = (points - centre) * np.exp(-1j * near_angle)
    on = (abs(x) > own.radius[0]) & (abs(x) < own.radius[-1])
    return (np.angle(x[on]) - np.interp(abs(x[on]), own.radius, own.angle)).min() if on.any() else np.inf


def error_of_touch(removed, roll):
    """Of the pinion that touches the held wheel, m along the line of action; the wheel stands where it touches
    when neither is modified. Tooth k of the pinion, counted counter-clockwise from the line of centres, meets
    tooth -k of the wheel."""
    exact = [Profile(gear, no_relief) for gear in (0, 1)]
    modified = [Profile(gear, removed[gear]) for gear in (0, 1)]
    pitch = [2 * np.pi / z for z in TEETH]
    at = [(roll * pitch[0] + k * pitch[0], np.pi - k * pitch[1]) for k in (-2, -1, 0, 1)]
    wheel = min(touching_angle(exact[1], A, exact[0].place(0, a_1), a_2) for a_1, a_2 in at)
    return R_B[0] * min(
        touching_angle(modified[0], 0, modified[1].place(A, wheel + a_2), a_1) for a_1, a_2 in at)


class Drive:
    def __init__(self, elastogear):
        self.elastogear = elastogear

    def run(self, *arguments):
        done = subprocess.run([self.elastogear, *arguments], capture_output=True, text=True)
        assert done.returncode == 0, f"{arguments}: {done.stdout[-800:]}{done.stderr}"
        return done.stdout

    def transmission_error(self, roll, *options):
        """Of the pinion along the line of action, m."""
        self.run("simulate", "drive.yaml", "-roll", str(roll), "-output", "result.h5", *options)
        with h5py.File("result.h5") as file:
            angle = file["bodies/pinion/rigid"][-1, 0]
        return (angle - 2 * np.pi * roll / TEETH[0] + np.pi / 2) * R_B[0]

    def rigid_error(self, roll, *options):
        return self.transmission_error(roll, "-torque", "1 N m", "-pinion_rigid", "true", "-wheel_rigid", "true",
                                       "-static_steps", "1", *options)


def near(what, value, expected, allowed):
    print(f"{what}: {value / UM:.3f} um, expected {expected / UM:.3f}")
    assert abs(value - expected) <= allowed, what


def opened(a):
    """What a centre distance of a opens the flanks by, along the line of action."""
    return sum(R_B) * (inv(np.arccos(sum(R_B) / a)) - inv(ALPHA_W))


def crowned(crowning, skew):
    """Transmission error of teeth crowned along their width whose partners are askew by so many degrees, m."""
    return -(np.radians(skew) * np.cos(ALPHA_W) * WIDTH)**2 / (16 * crowning)


def check_misalignment(drive):
    slope = np.radians(0.05)
    reach = slope * WIDTH / 2
    for options, expected in (
        (("-wheel_skew", "0.05 deg"), -reach * np.cos(ALPHA_W)),
        (("-wheel_skew", "-0.05"), -reach * np.cos(ALPHA_W)),
        (("-wheel_inclination", "0.05"), -reach * np.sin(ALPHA_W)),
        (("-wheel_radial_offset", "50 um"), opened(A + 50 * UM)),
        (("-pinion_lead_crowning", "10 um", "-wheel_skew", "0.05"), crowned(10 * UM, 0.05)),
        (("-pinion_lead_crowning", "2 um", "-wheel_skew", "0.005"), crowned(2 * UM, 0.005)),
        (("-pinion_left_helix_slope", "10 um", "-wheel_left_helix_slope", "-10 um"), 0),
        (("-pinion_right_profile_slope", "10 um"), 0),
        (("-pinion_pitch_deviation", "1,10 um"), -10 * UM * np.cos(ALPHA)),
        (("-pinion_pitch_deviation", "2,-10 um"), 0),
    ):
        error = drive.rigid_error(0.1, *options)
        print(f"{' '.join(options)}: {error / UM:.3f} um, expected {expected / UM:.3f}")
        figure("rigid pairs with deviations", "transmission error", error - expected, ALLOWED, "µm")


def tip_relief(gear, amount):
    def removed(roll):  # a parabola within 1/20 of the length around its beginning
        way = (roll - TIP[gear] + RELIEF[gear]) / RELIEF[gear]
        return amount * np.where(np.abs(way) < 0.05, (way + 0.05)**2 / 0.2, np.clip(way, 0, None))

    return removed


def profile_crowning(gear, amount):
    return lambda roll: amount * (2 * (roll - START[gear]) / (TIP[gear] - START[gear]) - 1)**2


def check_profiles(drive):
    for options, removed in (
        (("-pinion_tip_relief", "20 um", "-wheel_tip_relief", "10 um"),
         [tip_relief(0, 20 * UM), tip_relief(1, 10 * UM)]),
        (("-pinion_profile_crowning", "10 um"), [profile_crowning(0, 10 * UM), no_relief]),
    ):
        for roll in np.linspace(0, 1, 8, endpoint=False):
            near(f"{' '.join(options)}, roll {roll}", drive.rigid_error(roll, *options),
                 error_of_touch(removed, roll), ALLOWED + KINK)


def move_flanks(source, target, gear, removed):
    """Writes the mesh with its left and right flanks displaced along their normals."""
    step = 2 * np.pi / TEETH[gear]
    exact = Profile(gear, no_relief)
    count = 0

    def moved(match):
        nonlocal count
        number, *x = match[0].split(",")
        x, y, z = (float(value) for value in x)
        radius, angle = np.hypot(x, y), np.arctan2(y, x)
        tooth = np.pi / 2 + step * np.round((angle - np.pi / 2) / step)
        roll = np.sqrt(max(0, radius**2 - R_B[gear]**2))
        half = np.interp(radius, exact.radius, exact.angle)
        side = np.sign(angle - tooth)
        if roll < START[gear] or abs(abs(angle - tooth) - half) * radius > 1e-8: return match[0]
        count += 1
        normal = 1j * side * np.exp(1j * (angle - side * np.arctan(roll / R_B[gear])))
        at = x + 1j * y - removed(roll, z) * normal
        return f"{number}, {at.real:.16e}, {at.imag:.16e}, {z:.16e}"

    with open(source) as file:
        head, nodes, rest = re.split(r"(?<=\n)(?=\*NODE|\*ELEMENT)", file.read(), maxsplit=2)
    with open(target, "w") as file:
        file.write(head + re.sub(r"^\d.*$", moved, nodes, flags=re.M) + rest)
    assert count >= 2 * 3 * TEETH[gear], f"{count} nodes were moved"


def check_light_load(drive):
    """Elastic flanks that are crowned and askew touch where rigid ones do, between the nodes, and hardly give way."""
    options = ("-torque", "0.1 N m", "-pinion_lead_crowning", "10 um", "-wheel_skew", "0.025")
    between = 0.07 * UM  # stations, of which 16 share the face, where the crown touches at one place alone
    near("elastic, crowned and askew", drive.transmission_error(0.1, *options), crowned(10 * UM, 0.025), ALLOWED + between)


def check_elastic(drive):
    """Tip relief and lead crowning as deviations on the exact mesh, and in the mesh."""
    options = ("-pinion_tip_relief", "20 um", "-pinion_lead_crowning", "10 um")
    relief = tip_relief(0, 20 * UM)
    drive.run("mesh", "drive.yaml", "-pinion_mesh_output", "pinion.inp")
    move_flanks("pinion.inp", "moved.inp", 0, lambda roll, z: relief(roll) + 10 * UM * (2 * z / WIDTH)**2)
    drive.run("reduce", "-mesh", "moved.inp", "-output", "moved.h5", "-surface", "flanks", "-stress_nodes", "root",
              "-restrain", "bore", "-modes", "10", "-material_E", "210e9", "-material_nu", "0.3", "-material_rho",
              "7850")
    exact = drive.transmission_error(0.1)
    for roll in (0.1, 0.3, 0.7):
        on_exact = drive.transmission_error(roll, *options)
        on_moved = drive.transmission_error(roll, "-pinion_file", "moved.h5", *options)
        near(f"elastic, roll {roll}", on_exact, on_moved, SAME * abs(on_moved))
    assert abs(drive.transmission_error(0.1, *options) - exact) > UM, "the modifications have no effect"


def check_bearings(drive):
    """Under 300 N m each bearing gives way by the normal force over its stiffness, along the line of action. That moves the contact over
    the faces, on which contact at stations depends by some hundredths of a micrometre: it is at minimum-gap points."""
    of_mesh = ["-contact_points", "minima"]
    stiff = drive.transmission_error(0.1, *of_mesh)
    force = 300 / R_B[0]
    drive.run("simulate", "drive.yaml", "-roll", "0.1", "-output", "result.h5", "-pinion_bearing_radial",
              "1000 N/um", "-wheel_bearing_radial", "500 N/um", *of_mesh)
    with h5py.File("result.h5") as file:
        pinion = file["bodies/pinion/rigid"][-1]
    near("bearings, transmission error", pinion[5] * R_B[0] - stiff, force / 1e9 + force / 0.5e9, 0.001 * stiff)
    near("bearings, along the line of action", -pinion[1] / np.cos(ALPHA_W), force / 1e9, 0.001 * stiff)
    assert abs(pinion[0] / pinion[1] - np.tan(ALPHA_W)) < 0.002, "the pinion's axis leaves the line of action"
    # One bearing twice as far from the teeth as the other and half as stiff: both give way alike.
    with open("bearings.csv", "w") as file:
        file.write("# designation, radial, axial, tilt\n6306, 1e9, 1e8, 0\n6206, 4e8, 1e8, 0\n")
    with open("two_bearings.yaml", "w") as file:
        file.write(DRIVE.replace("shift: 0.3", "shift: 0.3, bearings: [near, far]") + """bearing_catalogue: bearings.csv
near: {at: 20 mm, radial: 800 N/um}
far: {at: -40 mm, catalogue: 6206}
""")
    drive.run("simulate", "two_bearings.yaml", "-roll", "0.1", "-output", "result.h5", *of_mesh)
    with h5py.File("result.h5") as file:
        pinion = file["bodies/pinion/rigid"][-1]
    near("two bearings, along the line of action", -pinion[1] / np.cos(ALPHA_W), force / 1.2e9, 0.001 * stiff)


WORM = """drive: worm
element_order: 1
module: 2 mm
centre_distance: 50 mm
pressure_angle: 15
worm: {starts: 2}
wheel: {teeth: 41}
torque: 1 N m
modes: 1
"""


def check_worm(drive):
    """Crossed involute helicoids stay conjugate, wherever their axes are; a wheel that is moved along its axis is turned as on a
    screw, so that its flanks stay where they are."""
    with open("worm.yaml", "w") as file:
        file.write(WORM)
    drive.run("reduce", "worm.yaml")
    for options, expected in ((("-wheel_radial_offset", "50 um"), None), (("-wheel_skew", "0.05"), None),
                              (("-wheel_axial_offset", "0.3 mm"), 0), (("-worm_axial_offset", "2 mm"), None)):
        errors = []
        for roll in (0, 0.3, 0.6, 0.9):
            drive.run("simulate", "worm.yaml", "-roll", str(roll), "-worm_rigid", "true", "-wheel_rigid", "true",
                      "-contact_law", "unilateral", "-static_steps", "1", "-output", "result.h5", *options)
            with h5py.File("result.h5") as file:
                errors.append((file["bodies/worm/rigid"][-1, 0] - np.pi * roll) / 20.5 * 82.029e-3 / 2)
        near(f"worm drive, {' '.join(options)}, peak to peak", np.ptp(errors), 0, ALLOWED)
        if expected is not None: near(f"worm drive, {' '.join(options)}, mean", np.mean(errors), expected, ALLOWED)


if __name__ == "__main__":
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        with open("drive.yaml", "w") as file:
            file.write(DRIVE)
        d = Drive(program)
        d.run("reduce", "drive.yaml")
        check_misalignment(d)
        check_profiles(d)
        check_light_load(d)
        check_elastic(d)
        check_bearings(d)
        check_worm(d)
