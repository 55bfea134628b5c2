#!/usr/bin/python3
"""A spur pair swept in speed through its resonance, up and down, beside an oscillator of one degree of freedom.

    studies/resonance.py --elastogear build/release/src/app/elastogear --out resonance [--figure docs/resonance.svg]

Test gears C14 of the FZG, elastic, with residual flexibility. A motor turns the pinion at a prescribed speed; the wheel carries a
flywheel and the load, and a viscous coupling to a brake that turns at its mean speed. The oscillator is

    m x'' + d x' + c(u) max(x, 0) = T_2 / r_b2,    m = (J_wheel + J_flywheel) / r_b2^2,

x the way by which the wheel lags (-TE), u the roll angle by the prescribed motion, c the secant stiffness that `evaluate` finds in a
sweep, d the damping of the coupling over r_b2^2. scipy's DOP853 integrates it. Ranges of TE within each pitch are compared, against
the mesh frequency of that pitch. Modes of the gears have 2 % of damping, the oscillator none beside the coupling.
"""
import argparse
import os
import subprocess
import sys

import h5py
import matplotlib
import numpy as np
from scipy.integrate import solve_ivp

matplotlib.use("Agg")
import matplotlib.pyplot as plt

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
import figures

TEETH, WIDTH, DISTANCE, TORQUE = (16, 24), 14e-3, 91.5e-3, 200.0  # m, N m on the pinion
SETTLING, WINDOW = 30, 5  # pitches
FLYWHEEL, STIFF = 4.5e-3, 1e8  # kg m^2, N m/rad: of the rigid couplings of flywheel and motor
GEARS = """drive: cylindrical
element_order: 1
size: tiny
module: 4.5 mm
centre_distance: 91.5 mm
face_width: 14 mm
pinion: {teeth: 16, profile_shift: 0.1817, tip_diameter: 82.635 mm, damping_ratio: 0.02}
wheel: {teeth: 24, profile_shift: 0.1715, tip_diameter: 118.544 mm, damping_ratio: 0.02}
material: {E: 206 GPa, nu: 0.3, rho: 7850}
torque: 200 N m
modes: 20
"""


def shaft(name, x, inertia, motion):
    return f"{name}: {{mass: 1, inertia: [{inertia / 2}, {inertia / 2}, {inertia}, 0, 0, 0], joint: revolute, position: [{x}, 0, 0], {motion}}}\n"


def coupling(name, ends, stiffness, damping):
    return (f"{name}: {{markers: [{ends}], stiffness: [0, 0, 0], rotational_stiffness: [0, 0, {stiffness}], "
            f"rotational_damping: [0, 0, {damping}]}}\n")


class Ramp:
    """Mesh frequency (Hz) that changes evenly from one value to another over a number of pitches, and the roll angle in pitches."""

    def __init__(self, frequencies, pitches):
        self.start, self.end = frequencies
        self.time = pitches / (sum(frequencies) / 2)

    def frequency(self, t):
        return self.start + (self.end - self.start) * t / self.time

    def roll(self, t):
        return self.start * t + (self.end - self.start) * t**2 / (2 * self.time)


def dynamic_text(ramp, name, damping, dt):
    """The drive file of a ramp, and the tables of its motions beside it."""
    t = np.linspace(0, 1.001 * ramp.time, 401)
    for body, z in (("motor", TEETH[0]), ("brake", -TEETH[1])):
        np.savetxt(f"{name}_{body}.csv", np.stack([t, 2 * np.pi * ramp.roll(t) / z], axis=1), delimiter=",", fmt="%.17g")
    speed = 2 * np.pi * ramp.start / TEETH[0]
    return (GEARS.replace("pinion: {", "pinion: {torque: 0, ")
            + "bodies: [pinion, wheel, motor, flywheel, brake]\nbushings: [drive_shaft, wheel_shaft, fluid]\n"
            + shaft("motor", 0, 1e-3, f"rotation_motion: [table, {name}_motor.csv]")
            + shaft("flywheel", DISTANCE, FLYWHEEL, f"omega0: {-speed * TEETH[0] / TEETH[1]:.17g}")
            + shaft("brake", DISTANCE, 1e-3, f"rotation_motion: [table, {name}_brake.csv]")
            + coupling("drive_shaft", "motor.frame, pinion.frame", STIFF, 1)
            + coupling("wheel_shaft", "flywheel.frame, wheel.frame", STIFF, 1)
            + coupling("fluid", "brake.frame, flywheel.frame", 0, damping)
            + f"analysis: dynamic\nspeed: {speed:.17g}\nts_dt: {dt}\nts_max_time: {ramp.time}\n"
            "ts_alpha_radius: 0.8\noutput_every: 2\n")


def run(program, *words):
    done = subprocess.run([program, *map(str, words)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: {done.stderr[-2000:]}")
    return done.stdout


def only_case(path):
    """The group of the only pair of the only case of an evaluation file."""
    (case,) = h5py.File(path, "r")["cases"].values()
    return case["pinion:wheel"]


def found_stiffness(program):
    """Secant stiffness over a pitch (roll angles, N/m), base radius of the wheel, its inertia about its axis."""
    with open("static.yaml", "w", encoding="utf-8") as file:
        file.write(GEARS)
    if not os.path.exists("static_evaluation.h5"):
        run(program, "reduce", "static.yaml")
        run(program, "simulate", "static.yaml", "-analysis", "sweep", "-sweep_positions", 64, "-contact_points", "minima")
        run(program, "evaluate", "static.yaml", "-root_stress", "false")
    found = only_case("static_evaluation.h5")
    with h5py.File("wheel.h5", "r") as file:
        inertia = file["rigid/inertia"][2, 2]
    return found["roll"][:], found["stiffness/secant"][:], found["transmission_error/radius"][()], inertia


class Oscillator:
    def __init__(self, roll, stiffness, radius, inertia, damping):
        self.roll, self.stiffness = np.append(roll, 1), np.append(stiffness, stiffness[0])
        self.mass, self.damping, self.load = inertia / radius**2, damping / radius**2, TORQUE * TEETH[1] / TEETH[0] / radius

    def frequency(self):
        return np.sqrt(self.stiffness[:-1].mean() / self.mass) / (2 * np.pi)

    def history(self, ramp, dt):
        """Times, and lag x (m)."""
        def rate(t, y):
            c = np.interp(ramp.roll(t) % 1, self.roll, self.stiffness)
            return [y[1], (self.load - self.damping * y[1] - c * max(y[0], 0)) / self.mass]
        t = np.arange(0, ramp.time, dt)
        found = solve_ivp(rate, (0, t[-1]), [0, 0], method="DOP853", t_eval=t, rtol=1e-7, atol=1e-12, max_step=1 / (20 * max(ramp.start, ramp.end)))
        return t, found.y[0]


def ranges(ramp, t, x):
    """Of each whole pitch: mesh frequency (Hz), largest less smallest x."""
    pitch = np.floor(ramp.roll(t)).astype(int)
    ends = np.flatnonzero(np.diff(pitch)) + 1
    parts = list(zip(ends[:-1], ends[1:]))
    return (np.array([ramp.frequency(t[a:b].mean()) for a, b in parts]), np.array([np.ptp(x[a:b + 1]) for a, b in parts]),
            np.array([x[a:b + 1].min() for a, b in parts]))


def elastic_history(program, ramp, name, damping, dt):
    with open(f"{name}.yaml", "w", encoding="utf-8") as file:
        file.write(dynamic_text(ramp, name, damping, dt))
    if not os.path.exists(f"{name}_evaluation.h5"):
        run(program, "simulate", f"{name}.yaml", "-contact_points", "minima")
        run(program, "evaluate", f"{name}.yaml", "-root_stress", "false")
    found = only_case(f"{name}_evaluation.h5")
    return found["time"][:], -found["transmission_error/loaded"][:]


def peak(frequency, span):
    """Mesh frequency and value of the largest range; the first pitches, in which the load sets in, are left out."""
    settled = slice(SETTLING, None)
    i = np.argmax(span[settled])
    return frequency[settled][i], span[settled][i]


def jump(frequency, span):
    """Where the range changes most from the mean of WINDOW pitches to that of the next: mesh frequency, and both means."""
    means = np.convolve(span, np.ones(WINDOW) / WINDOW, mode="valid")
    change = np.abs(means[WINDOW:] - means[:-WINDOW])
    i = SETTLING + np.argmax(change[SETTLING:])
    return frequency[i + WINDOW], means[i], means[i + WINDOW]


def report(name, natural, sides):
    for who, (frequency, span, least) in sides.items():
        at, value = peak(frequency, span)
        where, before, after = jump(frequency, span)
        lost = frequency[(least < 0) & (np.arange(least.size) >= SETTLING)]
        print(f"{name}, {who}: peak {1e6 * value:.1f} um at {at:.0f} Hz ({at / natural:.4f}); jump at {where:.0f} Hz ({where / natural:.4f}), "
              f"{1e6 * before:.1f} to {1e6 * after:.1f} um; contact is lost from {lost.min():.0f} to {lost.max():.0f} Hz", flush=True)
    (a, b), (c, d) = (([f(*sides[who][:2])[0] for who in ("elastic", "oscillator")]) for f in (peak, jump))
    print(f"{name}: speed of the peak {100 * (a / b - 1):+.2f} %, of the jump {100 * (c / d - 1):+.2f} %, "
          f"peak {100 * (peak(*sides['elastic'][:2])[1] / peak(*sides['oscillator'][:2])[1] - 1):+.1f} %", flush=True)
    figures.figure("resonance of C14", f"speed of the jump {name}", c / d - 1, unit="%")


def draw(path, natural, found):
    figure, axes = plt.subplots(figsize=(7, 4))
    for name, color in (("up", "tab:blue"), ("down", "tab:red")):
        for who, style in (("oscillator", "--"), ("elastic", "-")):
            frequency, span, _ = found[name][who]
            axes.plot(frequency[SETTLING:] / natural, 1e6 * span[SETTLING:], style, color=color, linewidth=1.2 if who == "elastic" else 1,
                      label=f"{who}, speed {name}")
    axes.set_xlabel(f"mesh frequency over {natural:.0f} Hz")
    axes.set_ylabel("transmission error, peak to peak (µm)")
    axes.set_ylim(bottom=0)
    axes.legend()
    axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None} if path.endswith(".svg") else None)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--figure")
    parser.add_argument("--ratio", type=float, default=0.05, help="damping ratio of the coupling to the brake")
    parser.add_argument("--dt", type=float, default=1.5e-5, help="s")
    options = parser.parse_args()
    program, figure = os.path.abspath(options.elastogear), options.figure and os.path.abspath(options.figure)
    os.makedirs(options.out, exist_ok=True)
    os.chdir(options.out)
    roll, stiffness, radius, inertia = found_stiffness(program)
    oscillator = Oscillator(roll, stiffness, radius, inertia + FLYWHEEL, 0)
    natural = oscillator.frequency()
    damping = 2 * options.ratio * oscillator.mass * 2 * np.pi * natural * radius**2
    oscillator.damping = damping / radius**2
    print(f"stiffness {1e-6 * stiffness.min():.1f} to {1e-6 * stiffness.max():.1f} N/um, mean {1e-6 * stiffness.mean():.2f}; inertia of the wheel "
          f"{inertia:.4e}, of the flywheel {FLYWHEEL} kg m^2; mass {oscillator.mass:.4f} kg, {natural:.1f} Hz; damping {damping:.4f} N m s")
    found = {}
    for name, ramp in (("up", Ramp((0.86 * natural, 1.03 * natural), 220)), ("down", Ramp((1.03 * natural, 0.83 * natural), 260))):
        elastic = ranges(ramp, *elastic_history(program, ramp, name, damping, options.dt))
        found[name] = {"elastic": elastic, "oscillator": ranges(ramp, *oscillator.history(ramp, 2 * options.dt))}
        report(name, natural, found[name])
    if figure:
        draw(figure, natural, found)


if __name__ == "__main__":
    main()
