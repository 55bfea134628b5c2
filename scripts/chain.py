"""Runs the paper's examples from mesh to tables, for any size and any list of bases and mode numbers:

    scripts/example impact  --size tiny --modes 100
    scripts/example turn_in --size small --order 2 --worm-size paper --modes 200
    scripts/example turn_in --size small --bases modal --modes 100,500,1000,2000 --law penalty --stress-recovery average

Bodies are reduced once with the largest number of modes and cut for the smaller ones; bodies, results and tables that are
there already are kept (--anew NAME... makes the steps whose names begin so again). The reference, unless --reduced, are the
unreduced bodies: in the dynamic analysis for the impact, in a static one for turn_in and rolling (under the torque that the teeth carry at that
time: a run vibrates). At size tiny rolling contact with --law penalty slows down: the script says so and ends. Leaves in OUT (default
out/examples/SIZE, with the size of the worm's mesh and the order where they are given): the bodies; in OUT/EXAMPLE: results, stresses and the tables of `elastogear compare` (BASIS_MODES_against_full*.csv, .txt); in both what every step printed (log/), its CPU and wall time
and memory (steps.csv).
"""
import argparse
import csv
import multiprocessing
import os
import shutil
import sys

import h5py
import numpy as np

import results
from cut import cut
from steps import Steps

REPOSITORY = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
INPUT = os.path.join(REPOSITORY, "examples", "worm_gear")
BODIES = ("worm", "wheel")
END_OF_REBOUND = "0.35e-3"  # s: before the wheel has crossed the backlash and strikes the other flanks
# N: of the unloaded state, where surfaces just touch, no force is left against which an imbalance were small.
IN_BALANCE = ["-snes_atol", "1e-6"]
# Static equilibria without a factor: algebraic multigrid, in one step from the given state, without matrices of damping.
ITERATIVE = ["-elastic_pc_type", "gamg", "-ksp_rtol", "1e-3", "-static_steps", "1",
             *(word for body in BODIES for word in (f"-{body}_damping_beta", "0"))]
FIXED_STEPS = ["-ts_dt", "2e-6"]  # of rolling with a penalty, so that runs differ by their bodies alone
STATE_OF_ROLLING = "0.05"  # s: after one turn of the worm its state goes to the static analysis
# Flanks that touch, by what the names of their face sets begin with; stresses there are compared as well.
FLANKS = {"impact": {"worm": "thread_1_right", "wheel": "tooth_41_left"},
          "turn_in": {"worm": "thread_1_left", "wheel": "tooth_01_right"},
          "rolling": {"worm": "thread_1_left", "wheel": "tooth_39_right"}}
CUT = ("modal", "modal_residual")  # bases whose lowest modes are those of a smaller reduction
# Of bases that need to know what contact may load.
LOADED_BASES = ("modal_attachment", "craig_bampton", "krylov")
LOADED = {"worm": "thread_1_right,thread_2_right",  # of the impact
          "wheel": ",".join(f"tooth_{tooth}_{side}" for tooth in ("39", "40", "41", "01", "02") for side in ("left", "right"))}
STRESS_SETS = {body: ",".join(["root"] + sorted({FLANKS[example][body] for example in FLANKS})) for body in BODIES}


class Chain:
    """Steps of one example: each is a command with an output file, skipped when that is there. Planning, the chain only collects
    the steps that are to be made, {output: name}."""

    def __init__(self, options):
        self.planning, self.planned, self.steps = True, {}, None
        self.options = options
        meshes = "_".join([options.size] + ([f"worm_{options.worm_size}"] if options.worm_size else []) +
                          (["order_2"] if options.order == 2 else []))
        self.bodies = options.out or os.path.join(REPOSITORY, "out", "examples", meshes)
        self.folder = os.path.join(self.bodies, options.example)
        for folder in (self.bodies, self.folder):
            os.makedirs(os.path.join(folder, "log"), exist_ok=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def wanted(self, name, output):
        anew = any(name.startswith(start) for start in self.options.anew)
        interrupted = os.path.exists(output + ".partial")  # the program goes on from there
        return anew or interrupted or not os.path.exists(output)

    def step(self, name, output, command):
        """Runs `elastogear COMMAND` unless its output is there; log and figures stand beside the output."""
        self.run(name, output, [self.options.elastogear] + command)

    def run(self, name, output, command):
        """Runs a command unless its output is there; log and figures stand beside the output."""
        folder = os.path.dirname(output)
        log = os.path.join(folder, "log", name + ".txt")
        if self.wanted(name, output):
            if self.planning:
                self.planned[output] = name
                return
            figures = self.steps.run(name, command, log)
            with open(os.path.join(folder, "steps.csv"), "a", encoding="utf-8", newline="") as file:
                csv.writer(file).writerow([name, *(f"{value:.3f}" for value in figures)])


def body_file(chain, body, basis, modes):
    """Path of a body file, which is meshed, reduced or cut when it is not there."""
    def file(name):
        return os.path.join(chain.bodies, name)
    mesh = file(body + ".msh")
    size = chain.options.size
    if body == "worm" and chain.options.worm_size:
        size = chain.options.worm_size
    chain.step(f"mesh_{body}", mesh, ["mesh", f"{INPUT}/{body}.yaml", "-size", size, "-element_order", str(chain.options.order), "-mesh", mesh])
    most = max(chain.options.modes + [chain.options.most]) if basis in CUT else modes
    whole = file(f"{body}_full.h5" if basis == "full" else f"{body}_{basis}_{most}.h5")
    chain.step(f"reduce_{os.path.basename(whole)[:-3]}", whole,
               ["reduce", f"{INPUT}/{body}.yaml", "-mesh", mesh, "-basis", basis, "-modes", str(max(most, 1)), "-completeness",
                "false", "-store", "surface" if chain.options.fields is None else "all", "-stress_nodes", STRESS_SETS[body],
                "-stress_recovery", chain.options.stress_recovery, "-output", whole,
                *(["-loaded", LOADED[body]] if basis in LOADED_BASES else [])])
    part = file(f"{body}_{basis}_{modes}.h5")
    if basis in CUT and modes < most and chain.wanted(f"cut_{body}", part) and not chain.planning:
        # In a process of its own: what it takes would count as the memory of all later steps.
        cutting = multiprocessing.Process(target=cut, args=(whole, part + ".new", modes, modes == chain.options.fields))
        cutting.start()
        cutting.join()
        if cutting.exitcode != 0:
            sys.exit(f"{whole} could not be cut to {modes} modes")
        os.replace(part + ".new", part)
    return whole if basis == "full" else part


def body_options(chain, basis, modes):
    return [word for body in BODIES for word in (f"-{body}_file", body_file(chain, body, basis, modes))]


def simulate(chain, label, source, bodies, *options):
    """Result and stress file of one run."""
    result, stress = chain.path(label + ".h5"), chain.path(label + "_stress.h5")
    contact = ["-contact_law", chain.options.law]  # one for all bodies
    exact = ["-contact_surface", "exact", "-contact_two_pass", "false",  # as in a drive file
             *(word for body in BODIES for word in (f"-{body}_flanks", f"{INPUT}/{body}.yaml"))]
    if chain.options.law == "unilateral":
        contact += [*exact, "-contact_points", "stations" if chain.options.reduced else "minima"]  # which unreduced bodies have
    elif chain.options.order == 2:
        contact += exact
    elif source == "impact":  # that of the documents is of facets
        contact += ["-contact_surface", "facets"]
    chain.step("simulate_" + label, result,
               ["simulate", f"{INPUT}/{source}.yaml", *bodies, *contact, "-output", result, *options, *chain.options.simulate])
    sets = [word for body in BODIES for word in (f"-stress_{body}", evaluated(chain, body))]
    estimates = ["-error_estimate", "false"] if chain.options.iterative else []  # they take a factor, too
    chain.step("recover_" + label, stress,
               ["recover", "-result", result, "-output", stress, *bodies, *sets, *estimates, *recovery(chain, label)])
    return result, stress


def evaluated(chain, body):
    """Sets whose stresses are compared."""
    return "root" if chain.options.roots else "root," + FLANKS[chain.options.example][body]


def in_balance(chain):
    """Options of the static references."""
    return IN_BALANCE + (ITERATIVE if chain.options.iterative else [])


def recovery(chain, label):
    """Options of recover: fields where the reference is, as pictures need them; other bodies that were cut have none."""
    reference = label.startswith("full")
    if chain.options.fields is None or not (reference or label.endswith(f"_{chain.options.fields or max(chain.options.modes)}")):
        return []
    if chain.options.example == "impact":
        return ["-field_times", "0.2e-3", "-box_levels", "1,5,leaf"]  # near the largest force
    if chain.options.example == "rolling" and not reference:
        return ["-field_times", chain.options.state]
    if chain.planning:
        return []
    with h5py.File(chain.path(label + ".h5")) as file:
        return ["-field_times", repr(float(file["time"][-1]))]


def compare(chain, label, files, references, *options):
    """Tables of forces and motion and of stresses."""
    for kind, file, reference in zip(("result", "stress"), files, references):
        name = f"{label}_against_full_{kind}"
        chain.step("compare_" + name, chain.path(name + "_1.csv"),
                   ["compare", file, reference, "-output", chain.path(name), *options])
        if not chain.planning:
            shutil.copy(chain.path(f"log/compare_{name}.txt"), chain.path(name + ".txt"))


def impact(chain, variants):
    every = ["-output_every", str(chain.options.every)]
    reference = [] if chain.options.reduced else simulate(chain, "full", "impact", body_options(chain, "full", 0), *every)
    for basis, modes in variants:
        label = f"{basis}_{modes}"
        files = simulate(chain, label, "impact", body_options(chain, basis, modes), *every)
        if reference:
            compare(chain, label, files, reference, "-to", END_OF_REBOUND)


def turn_in(chain, variants):
    # Without a penalty equilibria are compared.
    way = ["-output_dt", "2e-5"] if chain.options.law == "penalty" else ["-analysis", "static", "-static_steps", "4"]
    reduced = {f"{b}_{n}": simulate(chain, f"{b}_{n}", "turn_in", body_options(chain, b, n), *way)
               for b, n in variants}
    if chain.options.reduced:
        return
    start = list(reduced.values())[-1][0]
    reference = simulate(chain, "full", "turn_in", body_options(chain, "full", 0), "-analysis", "static",
                         "-static_steps", "4", "-initial_file", start, *in_balance(chain))
    for label, files in reduced.items():
        compare(chain, label, files, reference, "-at", "last")


def require_rolling(result):
    with h5py.File(result) as file:
        stopped = results.standstill(file)
    if stopped:
        sys.exit(f"{result}: {stopped} (--size small). There is no state of rolling to compare")


def transmitted_torque(result, state):
    """N m, along the worm's axis: what the teeth of a rolling run carry at this time, its load less what turns the worm faster."""
    with h5py.File(result) as file:
        at = np.argmin(np.abs(file["time"][:] - float(state)))
        return -results.torque_on_worm(file)[at]


def rolling(chain, variants):
    full = [] if chain.options.reduced else body_options(chain, "full", 0)
    steps = FIXED_STEPS if chain.options.law == "penalty" else []  # without one those that the run chooses
    state = chain.options.state
    if state != STATE_OF_ROLLING:
        steps = [*steps, "-ts_max_time", f"{1.1 * float(state):.6g}"]
    for basis, modes in variants:
        label = f"{basis}_{modes}"
        files = simulate(chain, label, "rolling", body_options(chain, basis, modes), "-output_dt", "5e-5", *steps)
        if not chain.planning and not chain.options.stopped:
            require_rolling(files[0])
        if chain.options.reduced:
            continue
        reference = simulate(chain, "full_at_" + label, "rolling_static", full, "-initial_file", files[0],
                             "-initial_time", state,
                             "-worm_torque", "0" if chain.planning else repr(float(transmitted_torque(files[0], state))), *in_balance(chain))
        compare(chain, label, files, reference, "-at", state, "-reference_at", "last")


def parse(words=None):
    """Options of a chain; words: those of the command line, unless given."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("example", choices=("impact", "turn_in", "rolling"))
    parser.add_argument("--size", default="tiny", choices=("tiny", "small", "medium", "paper"))
    parser.add_argument("--worm-size", choices=("tiny", "small", "medium", "paper"), help="of the worm's mesh, where it is not that of the wheel's")
    parser.add_argument("--order", default=1, type=int, choices=(1, 2), help="of the hexahedra")
    parser.add_argument("--modes", default="100,500", type=lambda text: sorted(int(n) for n in text.split(",")))
    parser.add_argument("--bases", default="modal_residual", type=lambda text: text.split(","), help="of reduce, separated by commas")
    parser.add_argument("--every", default=5, type=int, help="impact: every n-th step is written")
    parser.add_argument("--most", default=0, type=int, help="modes of the bodies from which those of fewer modes are cut; default: the largest of --modes")
    parser.add_argument("--fields", nargs="?", const=0, type=int, metavar="MODES", help="also write fields for pictures, of the runs with so many modes (default: "
                        "most); bodies keep their modes at all nodes")
    parser.add_argument("--state", default=STATE_OF_ROLLING, help="s, rolling: the state for the static analysis; the run lasts a tenth longer (default: %(default)s)")
    parser.add_argument("--iterative", action="store_true", help="static references without a factor, no estimated errors (size paper)")
    parser.add_argument("--roots", action="store_true", help="stresses of the roots alone, not of flanks")
    parser.add_argument("--reduced", action="store_true", help="without the unreduced bodies, flanks at stations (size paper)")
    parser.add_argument("--stress-recovery", default="auto", choices=("auto", "average", "surface"), help="of reduce")
    parser.add_argument("--stopped", action="store_true", help="compare runs of rolling contact that have stopped, too")
    parser.add_argument("--anew", nargs="*", default=[], help="what the steps to be made again begin with")
    parser.add_argument("--simulate", default=[], type=str.split, help="further options of simulate, of all runs, as '-ts_dt 1e-6'")
    parser.add_argument("--out", help="folder of the bodies, with one folder for each example")
    parser.add_argument("--elastogear", default=os.path.join(REPOSITORY, "build/release/src/app/elastogear"))
    parser.add_argument("--law", default="unilateral", choices=("penalty", "unilateral"),
                        help="of contact, for all bodies; unilateral: on exact flanks, without a penalty")
    return parser.parse_args(words)


def run_example(chain):
    variants = [(basis, modes) for basis in chain.options.bases for modes in chain.options.modes]
    {"impact": impact, "turn_in": turn_in, "rolling": rolling}[chain.options.example](chain, variants)


def main():
    chain = Chain(parse())
    run_example(chain)
    chain.planning, chain.steps = False, Steps(len(chain.planned))
    run_example(chain)
