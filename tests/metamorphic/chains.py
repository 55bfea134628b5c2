"""What must hold between the verbs of a chain: tables, ranks, and inputs that change in between."""

import copy
import csv
import json
import os
import subprocess
import sys

import numpy as np

from drives import SAME, Chain, cylindrical, drive, micro_geometry, misalignment, same_chains
from lab import Broken, Unfit, alike, at_most, between, choice, near

KHBETA = 1.15  # of an aligned pair: the pinion's twist over up to half its diameter takes some hundredths, meshes of size tiny as much
EVEN = 0.1  # share: what wider teeth and bodies add in stiffness behind the ends of the narrower face; docs/validation/gears.md
END = 1.3  # times: what they add to the quarter of the face at an end, most where lines of contact lean
# Of the face, of the pair that END was measured with. What an end gains is taken to grow with its overhang: 0.147 has 1.33 times the load
# beside a helix angle of 23 degrees, with twice the counts 1.44.
OVERHANG = 0.125
PEAK = 1.4  # times: the same at one position; finer meshes have 1.34 for a helical pinion that is a quarter wider


def columns(path):
    """Columns of a table by their names, without units."""
    with open(path) as file:
        rows = list(csv.reader(file))
    return {name.split(" [")[0].strip(): np.array([float(row[i]) if row[i] else np.nan for row in rows[1:]])
            for i, name in enumerate(rows[0])}


PYTHON = """
import json, sys, numpy, elastogear
evaluation = elastogear.Evaluation(sys.argv[1])
print(json.dumps({path: numpy.asarray(evaluation[path]).tolist() for path in sys.argv[3:]}))
print(json.dumps(elastogear.Result(sys.argv[2]).pair("pinion:wheel").force.tolist()))
"""


def tables_files_and_python_say_the_same(lab):
    """Numbers of tables and of the JSON file are written with all digits: equal to the bit to those of the HDF5 file and in Python."""
    keys = drive(lab.random, friction=True)
    keys.update(analysis="sweep", sweep_positions=int(lab.random.integers(2, 5)))
    chain = Chain(lab, "one", keys, first=True)
    for path, value in chain.figures.items():
        if isinstance(value, (int, float)):
            near(f"JSON: {path}", value, chain.value(path), 0)
    table = columns(lab.path("one_evaluation_pinion_wheel_line_load.csv"))
    near("table: line load", list(table.values())[1], chain.value("line_load/mean"), 0)
    table = columns(lab.path("one_evaluation_pinion_wheel.csv"))
    near("table: roll angle", list(table.values())[0], chain.value("roll"), 0)
    near("table: transmission error", next(v for k, v in table.items() if "transmission error" in k), chain.transmission_error(), 0)
    module = os.path.join(os.path.dirname(lab.program), "..", "..", "python")
    if not os.path.isdir(module):
        return
    paths = ["transmission_error/loaded", "line_load/mean", "line_load/KHbeta", "force/value", "teeth/force"]
    done = subprocess.run([sys.executable, "-c", PYTHON, "one_evaluation.h5", "one.h5", *paths], capture_output=True, text=True,
                          cwd=lab.folder, env={**os.environ, "PYTHONPATH": module}, check=False)
    if done.returncode != 0:
        raise Broken(f"Python: {done.stderr[-500:]}")
    read, forces = [json.loads(line) for line in done.stdout.strip().splitlines()[-2:]]
    for path in paths:
        near(f"Python: {path}", read[path], chain.value(path), 0)
    near("Python: forces", forces, lab.read("one.h5", "contact/pinion:wheel/force"), 0)


def two_ranks_change_nothing(lab):
    """Ranks share the work of reduce; what they sum up in another order differs by rounding, modes by the solver's 1e-8 at most."""
    keys = cylindrical(lab.random, (1,))
    keys["roll"] = float(round(lab.random.uniform(-0.5, 0.5), 3))
    same_chains(Chain(lab, "one", keys, first=True), Chain(lab, "two", keys, ranks=2))


def line_loads_sum_to_the_normal_force(lab):
    """Stations of the line load have all forces of all pairs of teeth, Eq. (10.7): with the widths that they stand for they sum to the
    pairs' normal forces at each position, but for rounding."""
    keys = drive(lab.random)
    keys.update(analysis="sweep", sweep_positions=int(lab.random.integers(2, 5)))
    chain = Chain(lab, "one", keys, first=True)
    alike("line load over the face", chain.value("line_load/value") @ chain.value("line_load/width"), chain.value("teeth/force").sum(axis=1), 1e-6)


def an_aligned_pair_is_loaded_evenly(lab):
    """Without modifications and misalignment KHbeta is near 1, and faces that are wider than the mate's or offset along the axis within
    it change loads of strips by what they stiffen the ends: a few hundredths, but for a quarter of the face at each end."""
    keys = cylindrical(lab.random)
    if keys["wheel"].get("internal"):
        raise Unfit("an internal pair")
    keys.update(analysis="sweep", sweep_positions=16, face_width=float(f"{keys['module'] * lab.random.uniform(4, 8):.3g}"))
    other = copy.deepcopy(keys)
    width = keys["face_width"]
    more = float(round(lab.random.uniform(1.02, 1.25), 3))
    other["pinion"]["face_width"] = float(f"{more * width:.4g}")
    offset = 0.0
    if lab.random.random() < 0.5:
        offset = other["wheel"]["axial_offset"] = float(f"{lab.random.uniform(-0.4, 0.4) * (more - 1) * width:.3g}")
    even = Chain(lab, "even", keys, first=True)
    at_most("KHbeta of equal widths", even.figures["line_load/KHbeta"], KHBETA)
    wide = Chain(lab, "wide", other)
    load, expected = (chain.value("line_load/mean") / chain.value("line_load/mean").mean() for chain in (wide, even))
    alike("loads of strips behind the ends, unequal widths", load[4:-4], expected[4:-4], EVEN)
    for end in (0, 1, 2, 3, -4, -3, -2, -1):
        overhang = (more - 1) / 2 + (-offset if end < 0 else offset) / width
        at_most("load at an end, unequal over equal widths", load[end] / expected[end], 1 + (END - 1) * max(1, overhang / OVERHANG))
        at_most("load at an end, equal over unequal widths", expected[end] / load[end], 1 + EVEN)
    at_most("Hertz pressure, unequal over equal widths", wide.figures["pressure/hertz_peak"] / even.figures["pressure/hertz_peak"], PEAK**0.5)


def an_own_mesh_is_that_of_the_data(lab):
    """The program's own mesh of a gear, given back to it as a file, is that gear: contact, stresses and wear are the same."""
    keys = drive(lab.random)
    body = choice(lab.random, "pinion", "wheel")
    keys.update(analysis="sweep", sweep_positions=3, wear={"coefficient": "1e-9 mm^3/(N m)", "revolutions": 1e4})
    one = Chain(lab, "one", keys, first=True)
    lab.run("mesh", "one.yaml", f"-{body}_mesh_output", f"own.{choice(lab.random, 'inp', 'msh')}")
    keys[body]["mesh"] = next(name for name in os.listdir(lab.folder) if name.startswith("own."))
    two = Chain(lab, "two", keys)
    same_chains(one, two)
    worn = []
    for chain in (one, two):
        lab.run("wear", f"{chain.name}.yaml", "-output", f"{chain.name}_wear.h5")
        with open(lab.path(f"{chain.name}_wear.json")) as file:
            worn.append([[gear["largest_depth_m"], gear["worn_mass_kg"]] for gear in json.load(file)["gears"]])
    for i, what in enumerate(("worn depth", "worn mass")):
        alike(what, *(np.array(gears)[:, i] for gears in worn), SAME)


def two_meshes_differ_by_less_than_their_errors(lab):
    """Hexahedra of 8 and of 20 nodes approximate the same stress at the roots: they differ by less than their estimated errors by the
    mesh, the reduction and the contact's resolution together."""
    keys = cylindrical(lab.random, (1,))
    keys["roll"] = float(round(lab.random.uniform(-0.5, 0.5), 3))
    chains = [Chain(lab, "one", keys, first=True), Chain(lab, "two", {**keys, "element_order": 2})]
    for body in ("pinion", "wheel"):
        path = f"root/{body}/largest_tension"
        stress = [chain.figures[path] for chain in chains]
        errors = sum(chain.figures.get(f"{path}{kind}", 0) for chain in chains for kind in ("_error", "_mesh_error", "_contact_error", "_time_error"))
        at_most(f"tension at the roots of {body}, {stress[0] / 1e6:.1f} and {stress[1] / 1e6:.1f} MPa: difference over estimate",
                abs(stress[0] - stress[1]) / errors, 1)


def loaded_sides(chain):
    """Of each gear, the sides of its flanks that carry load."""
    sides = []
    for of in "ab":
        name, force = chain.lab.read(f"{chain.name}.h5", *(f"contact/{chain.pair}/groups/{of}/{key}" for key in ("name", "force")))
        sides.append({group.decode().rsplit("_", 1)[-1] for group, f in zip(name, np.moveaxis(force, 0, 1)) if abs(f).max() > 0})
    return dict(zip(chain.gears, sides))


def loads_on_the_flanks_that_bear_are_enough(lab):
    """Bodies with static responses to loads on the side that bears, as those that `run` makes, have the figures of whole ones. On bodies of
    the other side nothing bears, and simulate says so."""
    keys = drive(lab.random, friction=True)
    one = Chain(lab, "one", keys, first=True)
    sides = loaded_sides(one)
    if any(len(side) != 1 for side in sides.values()):
        raise Unfit("both flanks bear")
    side = {gear: side.pop() for gear, side in sides.items()}
    same_chains(one, Chain(lab, "two", {**keys, **{gear: {**keys[gear], "loaded": side[gear]} for gear in side}}))
    gear = choice(lab.random, *side)
    other = {"left": "right", "right": "left"}[side[gear]]
    three = Chain(lab, "three", {**keys, gear: {**keys[gear], "loaded": other}}, verbs=("reduce",))
    done = three.verb("simulate")
    if done.returncode != 1 or "-loaded" not in done.stderr:
        raise Broken(f"simulate with loads on the other side: exit code {done.returncode}, {done.stderr.strip()[-300:]}")


def figures_of_run(lab, name, *options):
    """What `run` makes of a drive, and `wear` of its result, by paths: those of wear are wear/<gear>/<name without unit>."""
    done = lab.call("run", f"{name}.yaml", "-report", "none", *options)
    if done.returncode == 1 and (name == "one" and "written" not in done.stdout or "no equilibrium found" in done.stderr):
        raise Unfit(f"run: {done.stderr.strip()[-200:]}")
    if done.returncode != 0:
        raise Broken(f"run ends with exit code {done.returncode}: {done.stderr.strip()[-400:]}")
    lab.run("wear", f"{name}.yaml")
    figures = lab.summary(f"{name}_evaluation.json")
    with open(lab.path(f"{name}_wear.json")) as file:
        for of in json.load(file)["gears"]:
            figures.update({f"wear/{of['gear']}/{key.rsplit('_', 1)[0]}": value for key, value in of.items() if isinstance(value, float)})
    return figures


def errors_of_a_run_cover_a_finer_mesh(lab):
    """Figures of a mesh that `run` has chosen differ from those of a finer one by less than their estimated errors: all but one of
    twenty, which the Grid Convergence Index is for, here all but one of ten of each drive, and none by more than three times."""
    keys = cylindrical(lab.random)
    for of_verbs in ("modes", "element_order"):
        del keys[of_verbs]
    width = float(f"{keys['module'] * lab.random.uniform(3, 5):.3g}")
    keys.update(torque=float(f"{keys['torque'] * width / keys['face_width']:.3g}"), face_width=width, sweep_positions=8,
                wear={"coefficient": "1e-9 mm^3/(N m)", "revolutions": 1e4})
    micro_geometry(lab.random, keys)
    misalignment(lab.random, keys)
    for name in ("one", "two"):
        lab.write(f"{name}.yaml", {**keys, **{gear: {**keys[gear], "file": f"{name}_{gear}.h5"} for gear in ("pinion", "wheel")}})
    chosen, fine = figures_of_run(lab, "one", "-accuracy", "60 %"), figures_of_run(lab, "two", "-refinement", "2.5", "-modes", "0")
    ratio = {path: abs(chosen[path] - fine[path]) / max(error, 1e-300) for path, error in
             ((path, chosen.get(f"{path}_mesh_error", 0) + max(0, chosen.get(f"{path}_error", 0))) for path in chosen if path in fine)
             if error > 0}
    lab.log.append("  difference over estimate: " + ", ".join(f"{path} {value:.2f}" for path, value in ratio.items()))
    worst = sorted(ratio, key=ratio.get)
    at_most(f"difference over estimate, {worst[-1]}", ratio[worst[-1]], 3)
    few = len(worst) - 1 - len(worst) // 10
    at_most(f"difference over estimate, {worst[few]}", ratio[worst[few]], 1)


def duty_cycle(keys):
    """Keys of a life under the torque of a drive; that of the coast side is negative."""
    torque = keys["torque"] * {"drive": 1, "coast": -1}[keys["side"]]
    return {"duty_cycle": [torque, 1e6], "mean_stress": "none", "sn": {"knee_stress": 1e6, "knee_cycles": 1e18, "slope": 5}}


def lives(lab, name):
    """Life and damage of each gear at the stress, and the life at the stress and its estimated error: cycles of the duty cycle."""
    with open(lab.path(f"{name}_life.json")) as file:
        sets = json.load(file)["sets"]
    return {of["body"]: (of["life"]["duty_cycles"], of["damage"], (of.get("life_with_error") or {}).get("duty_cycles", np.inf)) for of in sets}


def the_life_of_a_finer_mesh_is_above_the_lower_life(lab):
    """`life` says what the estimated errors of stresses make of it: elements of second order, whose stresses are those of the first
    order within their errors, have no shorter life."""
    keys = cylindrical(lab.random, (1,))
    keys.update(analysis="sweep", sweep_positions=12, speed="100 rad/s", life=duty_cycle(keys))
    chains = [Chain(lab, "one", keys, first=True), Chain(lab, "two", {**keys, "element_order": 2})]
    for chain in chains:
        lab.run("life", f"{chain.name}.yaml", "-files", f"{chain.name}.h5", "-output", f"{chain.name}_life.h5")
    coarse, fine = (lives(lab, chain.name) for chain in chains)
    for body, (life, _, lower) in coarse.items():
        at_most(f"lower life of {body} over the life of a finer mesh", lower / fine[body][0], 1)
        at_most(f"lower life of {body} over its life", lower / life, 0.99)


def an_idler_bends_both_ways(lab):
    """A planet between a sun of its number of teeth and a ring is bent by both: its range of stress and its damage are those of twice
    the amplitude of the sun's, at nearly its tension."""
    module, teeth = between(lab.random, 1e-3, 6e-3, 2), int(lab.random.integers(17, 22))
    keys = {"drive": "cylindrical", "module": module, "face_width": float(f"{module * lab.random.uniform(3, 6):.3g}"), "gears": ["sun", "planet", "ring"],
            "sun": {"teeth": teeth}, "planet": {"teeth": teeth, "mate": "sun"}, "element_order": choice(lab.random, 1, 2), "modes": 3,
            "ring": {"teeth": 3 * teeth, "internal": True, "mate": "planet", "rigid": True}, "analysis": "sweep", "sweep_positions": 16,
            "side": choice(lab.random, "drive", "coast"), "speed": "100 rad/s"}
    keys["torque"] = float(f"{lab.random.uniform(0.3, 1) * 3e8 * module**2 * keys['face_width']:.3g}")
    lab.write("idler.yaml", {**keys, "life": duty_cycle(keys)})
    for verb in ("reduce", "simulate", "evaluate", "life"):
        lab.run(verb, "idler.yaml")
    with open(lab.path("idler_evaluation.json")) as file:
        pairs = json.load(file)["cases"][0]["pairs"]
    sun, planet = pairs["sun:planet"]["root"]["sun"], pairs["planet:ring"]["root"]["planet"]
    alike("tension of the planet", planet["largest_tension"]["value"], sun["largest_tension"]["value"], 0.15)
    at_most("range of the sun over that of the planet", sun["range"]["value"] / planet["range"]["value"], 0.7)
    damage = {body: found[1] for body, found in lives(lab, "idler").items()}
    at_most("damage of the sun over that of the planet", damage["sun"] / damage["planet"], 0.7**5)


def times(path, by):
    def change(keys):
        own = keys
        for name in path[:-1]:
            own = own[name]
        own[path[-1]] = float(f"{own[path[-1]] * by:.6g}")

    return path[-1], change


def given(path, value):
    def change(keys):
        own = keys
        for name in path[:-1]:
            own = own.setdefault(name, {})
        own[path[-1]] = value(keys) if callable(value) else value

    return path[-1], change


CHANGES = [  # the last part of a key, and what changes it: of bodies, of places, of the contact, of the run
    times(["face_width"], 1.2), times(["module"], 1.1), given(["size"], "small"), given(["element_order"], 2),
    given(["material", "E"], 70e9), given(["material", "nu"], 0.2), given(["pinion", "bore"], lambda keys: 6 * keys["module"]),
    given(["modes"], 12), given(["pinion", "profile_shift"], 0.35), given(["wheel", "profile_shift"], -0.1),
    given(["pinion", "teeth"], 21), given(["wheel", "teeth"], 31), given(["pressure_angle"], 22.0), given(["rack"], "C"),
    given(["helix_angle"], 5.0), given(["backlash"], lambda keys: 0.05 * keys["module"]),
    given(["wheel", "rim_diameter"], lambda keys: 14 * keys["module"]), given(["pinion", "face_width"], lambda k: 1.1 * k["face_width"]),
    given(["restrain_nodes"], [7]), given(["element"], "plain"),
    given(["centre_distance"], lambda k: (k["pinion"]["teeth"] + k["wheel"]["teeth"] + 1.0) * k["module"] / 2),
    given(["wheel", "radial_offset"], lambda k: 0.02 * k["module"]), given(["wheel", "skew"], 0.05), given(["wheel", "inclination"], 0.05),
    given(["pinion", "lead_crowning"], lambda k: 4e-3 * k["module"]), given(["pinion", "tip_relief"], lambda k: 8e-3 * k["module"]),
    given(["pinion", "bearing_radial"], lambda k: 2e11 * k["module"]), given(["contact", "friction"], 0.1),
    given(["contact", "approach"], "mesh"), given(["contact", "points"], "nodes"), given(["pinion", "rigid"], True),
    times(["torque"], 1.5), given(["side"], lambda k: {"drive": "coast", "coast": "drive"}[k["side"]]), given(["roll"], 0.3),
    given(["sweep_positions"], 3), given(["sweep_pitches"], 2)
]


def a_result_belongs_to_its_input(lab):
    """A key that changes after reduce, or after simulate: the next verb refuses and names it, or it makes what a chain made anew makes.
    There is no third way."""
    keys = cylindrical(lab.random, (1,))
    if keys["wheel"].get("internal"):
        raise Unfit("an internal pair")
    keys.update(roll=0.1, analysis="sweep", sweep_positions=2)
    name, change = CHANGES[int(lab.random.integers(len(CHANGES)))]
    after = choice(lab.random, "reduce", "simulate")
    changed = copy.deepcopy(keys)
    change(changed)
    anew = Chain(lab, "anew", changed, first=True, strict=False)
    chain = Chain(lab, "chain", keys, first=True, verbs=("reduce", after))
    chain.write(changed)
    for verb in ("simulate", "evaluate")[("reduce", "simulate").index(after):]:
        done = chain.verb(verb)
        if done.returncode == 1 and name in done.stderr:
            return
        if done.returncode != 0:
            raise Broken(f"{verb} after {after} with another {name} does not name it: {done.stderr.strip()[-300:]}")
    chain.read()
    try:
        same_chains(anew, chain)
    except Broken as broken:
        raise Broken(f"{name} changed after {after}, exit code 0: {broken}") from None
