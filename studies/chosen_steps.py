#!/usr/bin/python3
"""What steps that a run chooses make of energy and of stress, as the tables of docs/validation/dynamics.md:

    studies/chosen_steps.py --elastogear build/release/src/app/elastogear --out chosen_steps systems oscillators bar after flight rolling

systems: a mass on a stiff spring, a rigid rotor on stiff bearings, a double pendulum with a stiff hinge; energy made, and the drift of
the pendulum beside smaller steps. oscillators: 72 runs of 1000 periods. bar: stress at and beside the held end under a pulse, beside
fixed steps. after: the same pulse after a load that was a hundred times as large. flight: a free bar that hits a held one, the example
of docs/systems.md. rolling: ten turns of a pair without friction.
"""
import argparse
import os
import re
import subprocess
import sys

import h5py
import numpy as np
import yaml

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
sys.path.append(os.path.join(ROOT, "scripts"))
import figures

INERTIA = [1e-3, 1e-3, 1e-3, 0, 0, 0]


class Program:
    def __init__(self, options):
        self.path, self.folder = os.path.abspath(options.elastogear), os.path.abspath(options.out)
        os.makedirs(self.folder, exist_ok=True)

    def run(self, verb, name, keys, *words):
        """What the program prints; the input stays as NAME.yaml."""
        with open(os.path.join(self.folder, name + ".yaml"), "w", encoding="utf-8") as file:
            yaml.safe_dump(keys, file, sort_keys=False)
        done = subprocess.run([self.path, verb, name + ".yaml", *map(str, words)], cwd=self.folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise SystemExit(f"{verb} {name}: exit code {done.returncode}: {done.stderr}")
        return done.stdout + done.stderr

    def simulate(self, name, keys, *words):
        return self.run("simulate", name, {**keys, "output": name + ".h5"}, *words)

    def read(self, name, *paths):
        with h5py.File(os.path.join(self.folder, name + ".h5")) as file:
            return [file[path][:] for path in paths]


def number(text, pattern):
    found = re.search(pattern + r"\s*([-+.e0-9]+)", text)
    return float(found.group(1)) if found else np.nan


def steps_of(text):
    return int(number(text, r"time steps"))


def energy(program, name):
    kinetic, elastic, bushing, balance = program.read(name, *(f"energy/{kind}" for kind in ("kinetic", "elastic", "bushing", "balance")))
    return kinetic + elastic + bushing, balance


def mass_on_spring(speed, stiffness=1e8):
    return {"bodies": ["a"], "a": {"mass": 1.0, "inertia": INERTIA, "joint": "prismatic", "axis": [0, 0, 1], "velocity0": float(speed)},
            "bushings": ["j"], "j": {"markers": ["ground", "a.frame"], "stiffness": [stiffness] * 3}}


def rotor():
    return {"bodies": ["rotor"], "bushings": ["left", "right"],
            "rotor": {"mass": 2.0, "inertia": [1e-3, 1e-3, 8e-4, 0, 0, 0], "joint": "free", "velocity0": [0.05, 0, 0], "omega0": [0.5, 0, 300],
                      "points": ["left", 0, 0, -0.05, "right", 0, 0, 0.05]},
            **{name: {"markers": ["ground", f"rotor.{name}"], "stiffness": [1e8] * 3} for name in ("left", "right")}}


def double_pendulum():
    length, angle = 0.3, 1.2
    rod = {"mass": 1.0, "inertia": [length**2 / 12, 1e-3, length**2 / 12, 0, 0, 0]}
    x, y = length * np.sin(angle), -length * np.cos(angle) - length / 2
    return {"bodies": ["upper", "lower"], "gravity": [0, -9.81, 0], "bushings": ["hinge"],
            "upper": {**rod, "joint": "revolute", "axis": [0, 0, 1], "point": [0, length / 2, 0], "position": [0, -length / 2, 0],
                      "angle0": angle, "points": ["end", 0, -length / 2, 0]},
            "lower": {**rod, "joint": "free", "position": [float(x), float(y), 0], "points": ["top", 0, length / 2, 0]},
            "hinge": {"markers": ["upper.end", "lower.top"], "stiffness": [1e6] * 3}}


def systems(program):
    print("| system | end, s | steps | energy made, at most | lost at the end |")
    for name, keys, end in (("spring", {**mass_on_spring(0.1), "gravity": [0, 0, -9.81]}, 0.5), ("rotor", rotor(), 2.0),
                            ("pendulum", double_pendulum(), 3.0)):
        text = program.simulate(name, keys, "-ts_max_time", end)
        stored, balance = energy(program, name)
        print(f"| {name} | {end:g} | {steps_of(text)} | {balance.max():.2e} J | {-balance[-1]:.2e} of {stored.max():.3g} J |", flush=True)
    program.simulate("exact", double_pendulum(), "-ts_max_time", 3.0, "-ts_dt", 2e-5, "-ts_alpha_radius", 1, "-output_dt", 0.1)
    program.simulate("coarser", double_pendulum(), "-ts_max_time", 3.0, "-ts_dt", 4e-5, "-ts_alpha_radius", 1, "-output_dt", 0.1)
    program.simulate("pendulum", double_pendulum(), "-ts_max_time", 3.0, "-output_dt", 0.1)
    (exact, time), (coarser,), (found,) = (program.read("exact", "bodies/lower/position", "time"),
                                          program.read("coarser", "bodies/lower/position"), program.read("pendulum", "bodies/lower/position"))
    for name, path in (("steps of 40 us", coarser), ("the default", found)):
        off = np.linalg.norm(path - exact, axis=1)
        print(f"lower rod, {name} beside steps of 20 us: off by {1e3 * off[time <= 1.001].max():.3g} mm within 1 s, {1e3 * off.max():.3g} mm within 3 s")


def oscillators(program):
    """Amplitude sqrt(2 E / k) before and after 1000 periods, beside what local errors add up to."""
    tolerance, stiffness, omega = 1e-6, 1e8, 1e4
    period = 2 * np.pi / omega
    print("| rho_inf | amplitude, tolerances | output | steps | gained | lost | lost over local error times steps |")
    for radius in (0, 0.3, 0.5, 0.8, 0.95, 1):
        for times in (1, 10, 100, 1e3, 1e4, 1e5):
            for output in (0, 0.74):
                amplitude = times * tolerance
                words = ["-ts_max_time", 1000 * period, "-step_tolerance", tolerance, "-ts_dt", period / 1e3, "-ts_alpha_radius", radius]
                text = program.simulate("oscillator", mass_on_spring(amplitude * omega, stiffness), *words,
                                        *(["-output_dt", output * period] if output else []))
                stored, _ = energy(program, "oscillator")
                size = np.sqrt(2 * stored / stiffness)
                steps = steps_of(text)
                lost = amplitude - size[-1]
                print(f"| {radius:g} | {times:g} | {output:g} | {steps} | {size.max() / amplitude - 1:.1e} | {100 * lost / amplitude:.3g} % "
                      f"| {lost / (steps * tolerance):.2e} |", flush=True)


def make_bar(program, damping=0):
    mesh = subprocess.run([os.path.join(ROOT, "meshes", "make.py"), "bar", "25", "2", "2", "0.02", "0.01", "0.01"], capture_output=True,
                          text=True, check=True)
    lines = mesh.stdout.rstrip().splitlines()
    nodes = [line.split(",") for line in lines if re.match(r"\s*\d+\s*(,\s*[-+.eE0-9]+\s*){3}$", line)]
    along = np.array([[float(x) for x in node[1:]] for node in nodes])
    axis = np.ptp(along, axis=0).argmax()
    beside = [node[0].strip() for node, x in zip(nodes, along) if abs(x[axis] - along[:, axis].min() - 0.02) < 1e-6]
    with open(os.path.join(program.folder, "bar.inp"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines + ["*NSET, NSET=BESIDE"] + [", ".join(beside[i:i + 8]) for i in range(0, len(beside), 8)]) + "\n")
    program.run("reduce", "bar", {
        "mesh": "bar.inp", "material": {"E": 210e9, "nu": 0.3, "rho": 7850}, "restrain": ["FIX"], "surface": ["TOP"], "markers": ["END"],
        "stress_nodes": ["FIX", "BESIDE"], "basis": "modal", "modes": 20, "damping_alpha": damping, "damping_beta": 0, "output": "bar.h5"})


def table(program, name, *pulses):
    """A signal of half-sines: (start, length, size)."""
    with open(os.path.join(program.folder, name), "w", encoding="utf-8") as file:
        print("time,factor\n0,0" if pulses[0][0] > 0 else "time,factor", file=file)
        for start, length, size in pulses:
            for t in np.linspace(0, 1, 401):
                print(f"{start + t * length:.12g},{size * max(0, np.sin(np.pi * t)):.12g}", file=file)
        print("1,0", file=file)


def bar_stress(program, signal, end, *words):
    """Steps, times, and by set von Mises stress and its estimated error in time, Pa."""
    keys = {"bodies": ["bar"], "bar": {"file": "bar.h5", "joint": "fixed"}, "loads": ["tip"],
            "tip": {"marker": "bar.END", "force": [0, 0, -1000], "signal": ["table", signal]}, "ts_max_time": end, "output_dt": 2e-5}
    text = program.simulate("run", keys, *words)
    program.run("recover", "recover", {"result": "run.h5", "stress": {"bar": ["FIX", "BESIDE"]}, "mode_acceleration": False, "output": "stress.h5"})
    found = {}
    for place in ("FIX", "BESIDE"):
        stress, = program.read("stress", f"bar/{place}/von_mises")
        with h5py.File(os.path.join(program.folder, "stress.h5")) as file:
            group = file[f"bar/{place}"]
            found[place] = stress, group["time_error"][:] if "time_error" in group else np.zeros_like(stress)
    return steps_of(text), program.read("run", "time")[0], found


def beside(name, steps, found, exact, late=slice(None)):
    for place, (stress, estimate) in found.items():
        right, stress, estimate = exact[place][0][late], stress[late], estimate[late]
        at = np.unravel_index(stress.argmax(), stress.shape)
        largest = right.max()
        print(f"| {name} | {place} | {steps} | {largest / 1e6:.2f} MPa | {100 * (stress.max() / largest - 1):+.2f} % | {100 * abs(stress - right)[at] / largest:.2f} % "
              f"| {100 * estimate[at] / largest:.2f} % | {100 * np.linalg.norm(stress - right) / np.linalg.norm(right):.1f} % "
              f"| {np.linalg.norm(estimate) / np.linalg.norm(stress - right):.2f} |", flush=True)


HEADING = "| steps | place | number | largest | found | off there | estimate there | history | estimate over error |"
REFERENCE = ("-ts_dt", 2.5e-7, "-ts_alpha_radius", 1)


def bar(program):
    make_bar(program)
    table(program, "pulse.csv", (0, 2e-4, 1))
    print(HEADING)
    exact = bar_stress(program, "pulse.csv", 1e-2, *REFERENCE)[2]
    for name, words in (("default", ()), ("step_error 3e-5", ("-step_error", 3e-5)), ("1e-4", ("-step_error", 1e-4)), ("3e-4", ("-step_error", 3e-4))):
        steps, _, found = bar_stress(program, "pulse.csv", 1e-2, *words)
        beside(name, steps, found, exact)


def after(program):
    make_bar(program, 400)
    table(program, "later.csv", (1e-3, 4e-2, 5), (0.1, 2e-4, 0.05))
    print(HEADING)
    _, time, exact = bar_stress(program, "later.csv", 0.11, *REFERENCE)
    steps, _, found = bar_stress(program, "later.csv", 0.11)
    beside("default, after a large load", steps, found, exact, time >= 0.1)


def flight(program):
    bar = {"mesh": os.path.abspath(os.path.join(ROOT, "meshes", "bar.inp")), "material": {"E": 210e9, "nu": 0.3, "rho": 7850}, "surface": "TOP",
           "modes": 10}
    for name, restrain in (("held", "FIX"), ("block", "none")):
        program.run("reduce", name, {**bar, "restrain": restrain, "output": name + ".h5"})
    for name, gap, words in (("chosen steps", 1e-4, ()), ("fixed steps", 1e-4, ("-ts_dt", 2e-6)), ("penalty", 1e-4, ("-contact_law", "penalty")),
                             ("rigid", 1e-4, ("-block_rigid", "true")), ("flight of 0.15 mm", 1.5e-4, ()), ("flight of 0.6 mm", 6e-4, ())):
        block = {"file": "block.h5", "joint": "free", "position": [0.5, 0.025, 0.075 + gap], "rotation": [np.pi, 0, 0], "velocity0": [0, 0, -1]}
        keys = {"bodies": ["held", "block"], "held": {"file": "held.h5"}, "block": block, "gravity": [0, 0, -9.81],
                "contact": {"pairs": ["block:held"]}}
        text = program.simulate("flight", keys, "-ts_max_time", 2e-4 + gap, *words)
        start, off = number(text, "energy at the start"), number(text, "largest error of the balance")
        print(f"{name}: {steps_of(text)} steps, largest force {number(text, 'peak force'):.5g} N, energy {start:.5g} J, off by at most {off:.3g} J")
        if name == "chosen steps":
            figures.figure("impact after a flight", "balance of energy", off / start, unit="%")


def rolling(program):
    keys = {"drive": "cylindrical", "analysis": "dynamic", "module": "3 mm", "face_width": "20 mm", "size": "tiny", "element_order": 1, "modes": 6,
            "pinion": {"teeth": 17}, "wheel": {"teeth": 23}, "torque": "80 N m", "speed": "3000 rpm"}
    program.run("reduce", "rolling", keys)
    text = program.run("simulate", "rolling", keys, "-ts_max_time", 0.2, "-output_dt", 1e-3)
    print(text)
    balance, = program.read("rolling_result", "energy/balance")
    through = 80 * 2 * np.pi * 10
    print(f"balance {balance[-1]:.3g} J, from {balance.min():.3g} to {balance.max():.3g} J, beside {through:.0f} J that pass through the mesh: {abs(balance).max() / through:.1e}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True)
    parts = {part.__name__: part for part in (systems, oscillators, bar, after, flight, rolling)}
    parser.add_argument("parts", nargs="+", choices=parts)
    options = parser.parse_args()
    for part in options.parts:
        parts[part](Program(options))


if __name__ == "__main__":
    main()
