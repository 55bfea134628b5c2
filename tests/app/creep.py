#!/usr/bin/python3
"""A steel punch on a block of a steel and a polymer half, reduced with residual flexibility beside the full basis:

    tests/app/creep.py ELASTOGEAR SCRIPTS [FIGURES]

Pressed in and held, and under a force, over ten decades of time; in motion while a force grows, while it is pressed in, and while a
steel ring rolls over a longer block; an impact in 200 modes; a run that begins with what the block remembers of an hour under load. Relative moduli of shear and bulk together, apart in two series and of shear alone, two polymers, and a
block all of polymer; plain elements and incompatible ones.
"""
import dataclasses
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

ELASTOGEAR = os.path.abspath(sys.argv[1])
sys.path.append(os.path.abspath(sys.argv[2]))
import results
from figures import figure

TAU = (1e-5, 1e-2, 10, 1e4)  # s
ALIKE = {"prony": "0.15,0.15,0.15,0.15"}
SERIES = {"alike": ALIKE, "both": ALIKE, "shear": {"prony_g": "0.15,0.15,0.15,0.15"}, "two": ALIKE, "other": {"prony": "0.3,0.05,0.05,0.2"},
          "apart": {"prony_g": "0.15,0.15,0.15,0.15", "prony_k": "0.05,0.15,0.15,0.05"}}
HUBS = {"alike": "alike", "two": "other"}  # the block's other half, where it is not of steel
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
SIDES = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))
STEEL = {"E": 210e9, "nu": 0.3, "rho": 7850}
POLYMER = {"E": 3e9, "nu": 0.38, "rho": 1200}


def mesh(path, n, low, high, touching):
    """Hexahedra; cells below and above the middle are HUB and RIM, the face set TOUCH is at z = touching, nodes FAR are opposite."""
    nodes, cells, upper = {}, [], []
    low, high = np.array(low), np.array(high)
    for i, j, k in np.ndindex(*n):
        x = low + (np.array([i, j, k]) + CORNERS) / n * (high - low)
        cells.append([nodes.setdefault(tuple(np.round(p, 9)), len(nodes) + 1) for p in x])
        upper.append(2 * k >= n[2])
    X = np.array(list(nodes))
    with open(path, "w", encoding="utf-8") as file:
        file.write("*NODE\n" + "".join(f"{i + 1}, {x[0]:.12g}, {x[1]:.12g}, {x[2]:.12g}\n" for i, x in enumerate(X)))
        for name, part in (("HUB", False), ("RIM", True)):
            file.write(f"*ELEMENT, TYPE=C3D8, ELSET={name}\n")
            file.write("".join(f"{c + 1}, " + ", ".join(map(str, cells[c])) + "\n" for c in range(len(cells)) if upper[c] == part))
        sets = {"FAR": abs(X[:, 2] - (low[2] + high[2] - touching)) < 1e-9, "NEAR": abs(X[:, 2] - touching) < 1e-9,
                "INSIDE": abs(X[:, 2] - (low[2] + (high[2] - low[2]) / 4)) < 1e-9}
        for name, chosen in sets.items():
            file.write(f"*NSET, NSET={name}\n" + "".join(f"{i + 1},\n" for i in np.flatnonzero(chosen)))
        file.write("*SURFACE, NAME=TOUCH, TYPE=ELEMENT\n")
        for c, cell in enumerate(cells):
            for s, side in enumerate(SIDES):
                if all(abs(X[cell[a] - 1, 2] - touching) < 1e-9 for a in side):
                    file.write(f"{c + 1}, S{s + 1}\n")


RADIUS, BORE, AROUND = 0.02, 0.014, 72  # m, m, of the ring and its cells


def ring_mesh(path, width, across):
    """A ring about the y axis, one cell thick; the face set TOUCH is outside, nodes FAR are inside."""
    def node(i, outside, k):
        return 1 + 2 * (across + 1) * (i % AROUND) + (across + 1) * outside + k

    cells = [(i, k) for i in range(AROUND) for k in range(across)]
    with open(path, "w", encoding="utf-8") as file:
        file.write("*NODE\n")
        for i, outside, k in np.ndindex(AROUND, 2, across + 1):
            angle, r = 2 * np.pi * i / AROUND, RADIUS if outside else BORE
            file.write(f"{node(i, outside, k)}, {r * np.sin(angle):.12g}, {width * k / across:.12g}, {-r * np.cos(angle):.12g}\n")
        file.write("*ELEMENT, TYPE=C3D8, ELSET=HUB\n")
        for c, (i, k) in enumerate(cells):
            corners = [node(i + a, outside, k + b) for outside in (1, 0) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
            file.write(f"{c + 1}, " + ", ".join(map(str, corners)) + "\n")
        file.write("*NSET, NSET=FAR\n" + "".join(f"{node(i, 0, k)},\n" for i in range(AROUND) for k in range(across + 1)))
        file.write("*SURFACE, NAME=TOUCH, TYPE=ELEMENT\n" + "".join(f"{c + 1}, S1\n" for c in range(len(cells))))


def run(*arguments):
    done = subprocess.run([ELASTOGEAR, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, arguments))}: {done.stdout}{done.stderr}")
    return done.stdout


def material(name, constants, series=None):
    words = [f"-material_{name}_{key}={value}" for key, value in constants.items()]
    if series:
        words += [f"-material_{name}_prony_tau={','.join(map(str, TAU))}"]
        words += [f"-material_{name}_{key}={values}" for key, values in series.items()]
    return [word for pair in words for word in pair.split("=", 1)]


def reduce(case, basis, block="block", body="punch"):
    """Files of block and punch, or of the longer block and the ring."""
    kind, modes, element, states = case
    hub = material("HUB", POLYMER, SERIES[HUBS[kind]]) if kind in HUBS else material("HUB", STEEL)
    common = ["-element", element, "-restrain", "FAR", "-surface", "TOUCH"]
    names = [f"{block}_{kind}_{basis}_{modes}_{element}_{states}.h5", f"{body}_{modes}_{element}.h5"]
    if basis == "full":
        names = [f"{block}_{kind}_full_{element}.h5", f"{body}_full_{element}.h5"]
    loaded = ["-loaded", "TOUCH"] if basis in ("modal_attachment", "craig_bampton") else []
    series = SERIES[kind]
    if not os.path.exists(names[0]):
        run("reduce", "-mesh", f"{block}.inp", *hub, *material("RIM", POLYMER, series), "-stress_nodes", "NEAR,INSIDE", *common,
            "-basis", basis, *loaded, "-modes", modes, "-relaxed_states", states, "-output", names[0])
    if not os.path.exists(names[1]):
        rim = material("RIM", STEEL) if body == "punch" else []
        run("reduce", "-mesh", f"{body}.inp", *material("HUB", STEEL), *rim, *common, "-basis",
            "full" if basis == "full" else "modal_residual", "-modes", min(modes, 50), "-output", names[1])
    return names


def simulate(files, output, *more):
    run("simulate", "-bodies", "block,punch", "-block_file", files[0], "-punch_file", files[1], "-block_joint", "fixed",
        "-punch_joint", "prismatic", "-punch_axis", "0,0,-1", "-contact_pairs", "block:punch", "-contact_two_pass", "true",
        "-contact_depth", "1e-3", "-output", output, *more)
    with results.open_file(output, "result") as file:
        contact = file["contact/block:punch"]
        return {"time": file["time"][:], "s": file["bodies/punch/rigid"][:][:, 0],
                "force": np.linalg.norm(contact["force"][:], axis=1), "balance": abs(file["energy/balance"][:]).max(),
                "relaxation": file["energy/relaxation"][-1]}


RECOVERED = []  # von Mises stresses and their estimated errors, of the full basis and of a reduced one in turn


def stresses(result, name):
    run("recover", "-result", result, "-stress_block", "NEAR,INSIDE", "-output", name)
    with h5py.File(name) as file:
        sets = {where: file[f"block/{where}"] for where in ("NEAR", "INSIDE")}
        RECOVERED.append([(of["von_mises"][:], of["error"][:]) for of in sets.values() if "error" in of])
        return {where: of["stress"][:] for where, of in sets.items()}


def estimates(full, reduced):
    """True error of the von Mises stress of two recoveries and its estimate, of all values, over the largest of the set."""
    rows = [np.array([abs(found - exact).ravel(), error.ravel()]) / exact.max() for (exact, _), (found, error) in zip(full, reduced)]
    return np.hstack(rows)


def off(values, reference):
    return abs(values - reference).max() / abs(reference).max()


def check(what, value, bound):
    print(f"{what}: {value:.2e}")
    if not value < bound:
        sys.exit(f"{what}: {value:.3e}, must be below {bound:.0e}")


LOADS = {"under a force": ["-punch_force", 2000], "held": ["-punch_translation_motion", "speed,4e-6", "-ts_max_time", 1]}


@dataclasses.dataclass(frozen=True)
class Case:
    """A block: its materials, modes, elements and states of relaxation with static responses."""
    kind: str
    modes: int = 20
    element: str = "incompatible"
    states: str = "auto"

    def __iter__(self):
        return iter((self.kind, self.modes, self.element, self.states))


def errors_of(found, sigma, keys):
    errors = {key: off(found["modal_residual"][key], found["full"][key]) for key in keys}
    return errors | {f"stress {where}": off(sigma["modal_residual"][where], sigma["full"][where]) for where in ("NEAR", "INSIDE")}


def errors_at_rest(case, load):
    """Of displacement, force and stresses over ten decades of time, each over its largest value."""
    found, sigma = {}, {}
    for basis in ("full", "modal_residual"):
        output = f"rest_{basis}.h5"
        found[basis] = simulate(reduce(case, basis), output, *LOADS[load], "-analysis", "static", "-static_steps", 2,
                                "-time_under_load", 1e6, "-contact_stiffness", 1e14)
        sigma[basis] = stresses(output, "stress.h5")
    assert found["full"]["time"][0] == 0 and found["full"]["time"][-1] == 1e6
    change = found["full"]["force" if load == "held" else "s"]
    assert not 0.8 < change[-1] / change[0] < 1.2, change
    return errors_of(found, sigma, ("s", "force"))


CASES = {"alike": "punch on polymer", "both": "punch on polymer and steel, one ratio", "two": "punch on two polymers",
         "shear": "punch on polymer and steel, shear alone relaxes", "apart": "punch on polymer and steel, shear and bulk apart"}
NAMES = {"s": "displacement", "force": "force", "stress NEAR": "stress", "stress INSIDE": "stress"}


def compare_rest(case, bound):
    """Over ten decades: displacement, force and stresses."""
    for load in LOADS:
        for what, error in errors_at_rest(case, load).items():
            print(f"{case.kind}, {case.modes} modes, {case.element}, {load}: {what}")
            figure(CASES[case.kind], NAMES[what], error, bound)


def errors_on_ramp(case, load, rise):
    """While a force grows a hundredfold within `rise` (s), and twice as long after; or while the punch is pressed in, faster and faster."""
    with open("ramp.csv", "w", encoding="utf-8") as file:
        file.write(f"time,force\n0,20\n{rise},2000\n{3 * rise},2000\n")
    found, sigma = {}, {}
    for basis in ("full", "modal_residual"):
        names, how = reduce(case, basis), ["-punch_translation_motion", f"spin_up,{8e-6 / rise},{rise}", "-ts_max_time", rise]
        if load == "under a force":
            simulate(names, "before.h5", "-punch_force", 20, "-analysis", "static", "-static_steps", 2, "-time_under_load", 1e-9,
                     "-contact_stiffness", 1e14)
            how = ["-punch_force", "table,ramp.csv", "-initial_file", "before.h5", "-ts_max_time", 3 * rise]
        found[basis] = simulate(names, "ramp.h5", *how, "-ts_dt", rise / 100, "-output_dt", rise / 100, "-ts_alpha_radius", 0,
                                "-contact_stiffness", 1e14)
        sigma[basis] = stresses("ramp.h5", "stress.h5")
    assert found["full"]["force"][-1] > 10 * found["full"]["force"][2], found["full"]["force"]
    return errors_of(found, sigma, ("s", "force"))


def roll(files, output, duration):
    """The block passes below the ring, which turns with it, and rises by 0.1 mm."""
    way, rise = 0.016, 1e-4
    run("simulate", "-bodies", "block,ring", "-block_file", files[0], "-ring_file", files[1], "-block_joint", "prismatic", "-block_axis",
        f"{-way},0,{rise}", "-block_translation_motion", f"speed,{np.hypot(way, rise) / duration}", "-ring_joint", "revolute", "-ring_axis",
        "0,1,0", "-ring_position", f"0.008,0,{RADIUS + 5e-6}", "-ring_rotation_motion", f"speed,{way / RADIUS / duration}", "-contact_pairs",
        "block:ring", "-contact_two_pass", "true", "-contact_depth", "1e-3", "-contact_stiffness", "1e13", "-ts_dt", duration / 200,
        "-output_dt", duration / 200, "-ts_max_time", duration, "-ts_alpha_radius", 0, "-output", output)
    with results.open_file(output, "result") as file:
        return {"force": file["contact/block:ring/force"][:], "relaxation": file["energy/relaxation"][-1]}


def errors_of_rolling(case, duration):
    """Of the contact force, a vector, and of stresses, over 16 mm within `duration` (s)."""
    found, sigma = {}, {}
    for basis in ("full", "modal_residual"):
        found[basis] = roll(reduce(case, basis, "long", "ring"), "rolling.h5", duration)
        sigma[basis] = stresses("rolling.h5", "stress.h5")
    assert found["full"]["relaxation"] > 0
    return errors_of(found, sigma, ("force",))


def compare_motion(case, bound):
    """Ramps over eight decades, and rolling."""
    for load in LOADS:
        for rise in (1e-4, 1e4):
            for what, error in errors_on_ramp(case, load, rise).items():
                check(f"{case.kind}, {case.modes} modes, ramp {load} within {rise:g} s: {what}", error, bound)
    for duration in (1, 10, 1e4):
        for what, error in errors_of_rolling(case, duration).items():
            check(f"{case.kind}, {case.modes} modes, rolling for {duration:g} s: {what}", error, bound)


def check_estimates(bound):
    """Of all recoveries so far: the share of values whose true error is above twice the estimate."""
    true, estimate = np.hstack([estimates(*RECOVERED[i : i + 2]) for i in range(0, len(RECOVERED), 2)])
    check(f"{true.size} stresses, true error up to {true.max():.1e}, above twice its estimate", np.mean(true > 2 * estimate), bound)
    assert np.median(estimate) < 1e-2, np.median(estimate)


def compare_memory(case, bound):
    """The block is loaded for an hour, then all but a fortieth of the load is taken off within 0.5 ms: what is left of its print."""
    with open("load.csv", "w", encoding="utf-8") as file:
        file.write("time,force\n0,2000\n1e-4,2000\n6e-4,50\n1,50\n")
    found = {}
    for basis in ("full", "modal_residual"):
        names = reduce(case, basis)
        simulate(names, "hour.h5", *LOADS["under a force"], "-analysis", "static", "-static_steps", 2, "-time_under_load", 3600,
                 "-contact_stiffness", 1e14)
        more = ["-ts_dt", 5e-6, "-ts_max_time", 1.5e-3, "-ts_alpha_radius", 0.5, "-contact_stiffness", 1e14]
        found[basis] = simulate(names, "after.h5", "-punch_force", "table,load.csv", "-initial_file", "hour.h5", *more)
    full, reduced = found["full"]["s"], found["modal_residual"]["s"]
    check(f"{case.kind}, motion after an hour under load", off(reduced, full), bound)
    print(f"print: {reduced[0]:.3e} m under load, {reduced[-1]:.3e} m left")
    assert 0.3 * reduced[0] < reduced[-1] < 0.9 * reduced[0]


def errors_of_impact(case, basis="modal_residual"):
    """The punch hits the block at 0.5 m/s: until it has left."""
    found, sigma = {}, {}
    for name, of in (("full", "full"), ("modal_residual", basis)):
        found[name] = simulate(reduce(case, of), "impact.h5", "-punch_velocity0", 0.5, "-ts_dt", 1e-6, "-ts_max_time", 4e-4,
                               "-ts_alpha_radius", 0.5, "-contact_stiffness", 1e13)
        sigma[name] = stresses("impact.h5", "stress.h5")
    assert found["full"]["force"][-1] == 0, found["full"]["force"]
    return errors_of(found, sigma, ("s", "force"))


def compare_impact(case, bound):
    for what, error in errors_of_impact(case).items():
        check(f"{case.kind}, {case.modes} modes, impact: {what}", error, bound)


def meshes():
    mesh("block.inp", (4, 4, 4), (0, 0, -0.01), (0.02, 0.02, 0), 0)
    mesh("punch.inp", (2, 2, 2), (0.004, 0.006, 0), (0.014, 0.016, 0.01), 0)
    mesh("long.inp", (16, 3, 4), (0, 0, -0.01), (0.032, 0.009, 0), 0)
    ring_mesh("ring.inp", 0.009, 2)


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        meshes()
        compare_rest(Case("alike", element="plain"), 1e-6)
        for kind in ("both", "shear", "apart", "two"):
            for element in ("plain", "incompatible"):
                compare_rest(Case(kind, element=element), 1e-2)
        compare_motion(Case("shear", 100), 1e-2)
        check_estimates(5e-2)
        compare_memory(Case("both"), 1e-2)
        compare_impact(Case("both", 200), 1e-2)


if __name__ == "__main__":
    main()
