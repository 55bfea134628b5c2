#!/usr/bin/python3
"""Contact at stations of exact flanks, the default of drives:

    tests/app/stations.py ELASTOGEAR EXAMPLES SCRIPTS

Every position of a pitch is found at loads over four orders of magnitude. Pressures are H. Hertz's of each station's own force, with the curvatures
of the involutes. Conjugate flanks without load transmit exactly. The load over an even face is even. A run in time closes its energies, friction takes what
the torques lose, and two ways to one state end in one force. What lacks for stations is named.
"""
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

ELASTOGEAR = os.path.abspath(sys.argv[1])
PAIR = """drive: cylindrical
module: 3 mm
face_width: 25 mm
pinion: {teeth: 17, profile_shift: 0.3}
wheel: {teeth: 43, profile_shift: 0.1}
torque: 300 N m
size: tiny
element_order: 1
modes: 5
"""
E_STAR = 206e9 / (2 * (1 - 0.3**2))  # Pa, of both gears
MODULE, TEETH, ALPHA = 3e-3, np.array([17, 43]), np.radians(20)
BASE = MODULE * TEETH * np.cos(ALPHA) / 2  # m
CENTRES = 91.1471e-3  # m, as the program prints it


def run(*arguments, fails=False):
    done = subprocess.run([ELASTOGEAR, *arguments], capture_output=True, text=True, check=False)
    assert (done.returncode != 0) == fails, done.stdout + done.stderr
    return done.stdout + done.stderr


def sweep(output, *more, positions=8):
    said = run("simulate", "pair.yaml", "-verbose", "-analysis", "sweep", "-sweep_positions", str(positions), "-output", output, *more)
    assert f"{positions} of {positions}" in said, said
    return said


def evaluation(result, *more):
    run("evaluate", "pair.yaml", "-result", result, "-output", "evaluation.h5", "-root_stress", "false", *more)
    file = h5py.File("evaluation.h5")
    return file[f"cases/{os.path.splitext(result)[0]}/pinion:wheel"]


def normal_forces(result):
    """Their sums, N, position by position."""
    with h5py.File(result) as file:
        points = file["contact/worm:wheel/points"]
        normal = np.linalg.norm(points["force"][:], axis=1)
        return np.array([normal[a:b].sum() for a, b in zip(points["offset"][:-1], points["offset"][1:])])


def check_worm(flank, form, hand):
    """A worm touches its helical wheel at one point of each pair of teeth, and hobbed wheels along lines over their
    face: normal forces of involutes are those of the base cylinder, at any load, conjugate flanks transmit exactly, and
    a run in time keeps its energy."""
    name, positions = f"{flank} {form} {hand}", "4" if form == "helical" else "3"
    with open("worm.yaml", "w") as file:
        file.write("drive: worm\nsize: tiny\nelement_order: 1\nmodule: 2 mm\npressure_angle: 15 deg\ncentre_distance: 50 mm\n"
                   f"hand: {hand}\nworm: {{starts: 2, flank: {flank}}}\nwheel: {{teeth: 41, bore: 24 mm, form: {form}}}\n"
                   "torque: 4 N m\nmodes: 5\n")
    run("reduce", "worm.yaml")
    alpha, gamma = np.radians(15), np.radians(15.620493)
    arm = 2e-3 / np.sin(gamma) * np.cos(np.arctan(np.tan(alpha) / np.sin(gamma)))  # m, base radius of two starts
    arm *= np.sqrt(1 - (np.cos(gamma) * np.cos(alpha))**2)
    for torque in (0.004, 4, 20) if form == "helical" else (0.004, 4):
        said = run("simulate", "worm.yaml", "-verbose", "-analysis", "sweep", "-sweep_positions", positions, "-torque", f"{torque} N m",
                   "-output", "worm_sweep.h5")
        assert f"{positions} of {positions}" in said and "at stations of exact flanks" in said, said
        if flank == "ZI":
            off = np.abs(normal_forces("worm_sweep.h5") * arm / torque - 1).max()
            print(f"worm {name}, {torque} N m: sums of normal forces {off:.2e} off those of the base cylinder")
            if torque < 20:  # then forces on edges of tips turn away from the flanks
                assert off < (1e-4 if torque < 1 else 3e-3)
        if torque == 0.004:
            run("evaluate", "worm.yaml", "-torque", f"{torque} N m", "-result", "worm_sweep.h5", "-output", "worm_evaluation.h5",
                "-root_stress", "false")
            with h5py.File("worm_evaluation.h5") as file:
                error = np.ptp(file["cases/worm_sweep/worm:wheel/transmission_error/loaded"][:])
            print(f"worm {name}: transmission error {error * 1e6:.4f} um peak to peak")
            assert error < 0.1e-6
    run("simulate", "worm.yaml", "-analysis", "dynamic", "-ts_max_time", "1e-4", "-speed", "100 rad/s", "-output", "worm_time.h5")
    with h5py.File("worm_time.h5") as file:
        balance = np.abs(file["energy/balance"][:]).max()
    print(f"worm {name}, in time: {balance:.2e} J of {4 * 100 * 1e-4:.2e} J that pass")
    assert balance < 1e-4 * 4 * 100 * 1e-4


def check_all_positions():
    for torque in ("0.03 N m", "3 N m", "300 N m", "1500 N m"):
        said = sweep("load.h5", "-torque", torque)
        assert "at stations of exact flanks" in said, said
    sweep("load.h5", "-torque", "0.01 N m")
    error = evaluation("load.h5")["transmission_error/loaded"][:]
    print(f"transmission error at 0.01 N m: {np.abs(error).max() * 1e6:.4f} um")
    assert np.abs(error).max() < 0.1e-6


def check_pressure():
    """Of stations between the ends of the path, where no edge touches."""
    sweep("pressure.h5")
    with h5py.File("pressure.h5") as file:
        points = file["contact/pinion:wheel/points"]
        force, pressure = np.linalg.norm(points["force"][:], axis=1), points["pressure"][:]
    line = 25e-3 / 16
    alpha_w = np.arccos(BASE.sum() / CENTRES)
    path = CENTRES * np.sin(alpha_w)
    # p^2 = w E* / (pi R): R of each station by its pressure lies between those at the ends of the path
    radius = force / line * E_STAR / (np.pi * pressure**2)
    tip = BASE * np.sqrt((np.array([58.8e-3, 135.6e-3]) / 2 / BASE)**2 - 1)
    first = np.linspace(path - tip[1], tip[0], 200)
    allowed = first * (path - first) / path
    inside = radius > 0.5 * allowed.min()
    print(f"radii by pressures {radius[inside].min() * 1e3:.3f} to {radius[inside].max() * 1e3:.3f} mm, "
          f"of the path {allowed.min() * 1e3:.3f} to {allowed.max() * 1e3:.3f} mm; {inside.mean():.0%} of stations are on flanks")
    assert inside.mean() > 0.6
    assert radius[inside].max() < 1.01 * allowed.max() and radius[inside].min() > 0.97 * allowed.min()


def check_even_load():
    even = evaluation("pressure.h5")["line_load/KHbeta"][()]
    print(f"KHbeta of equal widths: {even:.3f}")
    assert even < 1.05


def check_friction():
    sweep("rubbing.h5", "-contact_friction", "0.05", "-contact_friction_speed", "1 mm/s")
    said = run("evaluate", "pair.yaml", "-contact_friction", "0.05", "-contact_friction_speed", "1 mm/s", "-result", "rubbing.h5", "-output",
               "rubbing_evaluation.h5", "-root_stress", "false")
    with h5py.File("rubbing_evaluation.h5") as file:
        losses = file["cases/rubbing/pinion:wheel/losses"]
        taken, lost = losses["friction_loss"][()], 1 - losses["efficiency"][()]
    print(f"friction takes {taken:.4%}, the torques lose {lost:.4%}")
    assert abs(taken / lost - 1) < 0.03, said


def check_motion():
    moving = ["pair.yaml", "-analysis", "dynamic", "-speed", "100 rad/s", "-ts_max_time", "1e-4"]
    run("simulate", *moving, "-output", "moving.h5")
    with h5py.File("moving.h5") as file:
        energy = file["energy"]
        balance, stored = np.abs(energy["balance"][:]).max(), energy["elastic"][0] + energy["contact"][0]
    print(f"balance {balance:.3g} J of {stored:.3g} J stored in the gears")
    assert balance < 1e-4 * stored


def check_one_state():
    """Of the same roll angle and torque, after other angles or at once."""
    sweep("pitch.h5", positions=4)
    run("simulate", "pair.yaml", "-roll", "0.5", "-output", "once.h5")
    with h5py.File("pitch.h5") as pitch, h5py.File("once.h5") as once:
        there = pitch["contact/pinion:wheel/force"][2]
        here = once["contact/pinion:wheel/force"][-1]
    print("one state two ways:", np.linalg.norm(there - here) / np.linalg.norm(here))
    assert np.linalg.norm(there - here) < 1e-6 * np.linalg.norm(here)


def check_helical():
    """Lines of contact end within strips: the transmission error of a small load has no steps of one strip, 3 % of it, and a run
    in time keeps its energy."""
    with open("pair.yaml", "w", encoding="utf-8") as file:
        file.write("drive: cylindrical\nmodule: 2 mm\nhelix_angle: 20 deg\nface_width: 16 mm\nelement_order: 1\nmodes: 2\n"
                   "pinion: {teeth: 19, profile_shift: 0.2}\nwheel: {teeth: 52, bore: 30 mm}\ntorque: 6.5 N m\n")
    run("reduce", "pair.yaml")
    sweep("helical.h5", positions=32)
    error = evaluation("helical.h5")["transmission_error/loaded"][:]
    beside = np.array([np.roll(error, shift) for shift in (-2, -1, 1, 2)])
    out = np.maximum(error - beside.max(axis=0), beside.min(axis=0) - error).max() / np.ptp(error)
    print(f"transmission error of the helical pair {error.mean() * 1e6:.3f} um, out of its neighbours by {out:.3f} of its range")
    assert out < 0.1
    check_motion()


def check_what_lacks():
    said = run("simulate", "pair.yaml", "-verbose", "-contact_surface", "smooth")
    assert "no exact flanks of gear data" in said, said


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    with open("pair.yaml", "w", encoding="utf-8") as text:
        text.write(PAIR)
    run("reduce", "pair.yaml")
    check_all_positions()
    check_pressure()
    check_even_load()
    check_friction()
    check_motion()
    check_one_state()
    check_what_lacks()
    check_helical()
    for drive in (("ZI", "helical", "right"), ("ZI", "throated", "left"), ("ZA", "cylindrical", "right")):
        check_worm(*drive)  # its wheel takes the place of the pair's
