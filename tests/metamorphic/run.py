#!/usr/bin/python3
"""Metamorphic tests: random drives and systems times random options, and what must hold whatever they are.

  run.py [--program PATH/TO/elastogear] [--cases N] [--seed NUMBER|random] [--relation NAME ...] [--set ci|awaits|all] [--keep FOLDER]
  run.py --relation NAME --case NUMBER       repeats one case, and prints its input and commands

A case is a relation with a number, which everything random in it follows from. Relations stand in systems.py, drives.py, chains.py, bodies.py and contacts.py; RELATIONS
below lists them with how often they come, and AWAITS those that a known fault of the program breaks. ctest runs the others.
"""

import argparse
import concurrent.futures
import hashlib
import os
import shutil
import sys
import tempfile
import time
import traceback

import numpy as np

import bodies
import chains
import contacts
import drives
import systems
from lab import Broken, Lab, Unfit

RELATIONS = {  # and how many cases of a hundred, by what they cost
    systems.energy_is_not_made: 16,
    systems.fixed_steps_make_no_energy: 6,
    systems.output_times_change_nothing: 5,
    systems.a_rerun_and_a_resumed_run_change_nothing: 6,
    systems.units_of_a_system_change_nothing: 5,
    systems.a_turned_world_changes_nothing: 6,
    drives.a_mirrored_drive_is_the_same: 12,
    drives.units_of_a_drive_change_nothing: 8,
    drives.a_scaled_drive_is_the_same: 12,
    drives.a_stiffer_drive_is_the_same: 8,
    drives.a_rigid_gear_is_the_limit_of_a_stiff_one: 4,
    drives.a_drive_does_not_depend_on_load_steps: 6,
    chains.tables_files_and_python_say_the_same: 4,
    chains.two_ranks_change_nothing: 4,
    chains.line_loads_sum_to_the_normal_force: 6,
    chains.an_aligned_pair_is_loaded_evenly: 6,
    chains.loads_on_the_flanks_that_bear_are_enough: 4,
    chains.two_meshes_differ_by_less_than_their_errors: 4,
    chains.errors_of_a_run_cover_a_finer_mesh: 2,
    chains.a_result_belongs_to_its_input: 10,
    chains.an_own_mesh_is_that_of_the_data: 3,
    chains.the_life_of_a_finer_mesh_is_above_the_lower_life: 2,
    chains.an_idler_bends_both_ways: 1,
    bodies.a_sensor_is_where_the_field_is: 5,
    bodies.a_pressure_is_the_force_that_it_makes: 4,
    bodies.a_pulse_is_resolved_in_time: 3,
    bodies.a_sensor_on_a_flank_is_where_the_field_is: 5,
    bodies.the_static_response_to_loads_at_markers_is_whole: 5,
    bodies.a_spinning_bar_has_its_coriolis_forces: 4,
    bodies.a_cell_that_is_twice_there_is_named: 2,
    contacts.contact_that_starts_closed_is_that_of_a_small_gap: 4,
    contacts.bars_that_touch_are_pressed_along_their_axis: 3,
    contacts.bars_that_hit_do_not_chatter: 2,
}

AWAITS = {}  # relations that fail today, and the fault that breaks them: leave out here what is mended

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PROGRAM = os.path.join(ROOT, "build", "release", "src", "app", "elastogear")


def number_of(seed, relation, index):
    """The number of a case: it does not depend on which other relations run."""
    return int(hashlib.sha256(f"{seed} {relation.__name__} {index}".encode()).hexdigest()[:12], 16)


def run_case(program, relation, number, folder):
    """'held', 'unfit' or 'broken', with what to say."""
    lab = Lab(program, folder, np.random.default_rng(number))
    try:
        relation(lab)
        return "held", "", lab.log
    except Unfit as unfit:
        return "unfit", str(unfit), lab.log
    except Broken as broken:
        return "broken", str(broken), lab.log
    except Exception:  # a result that cannot be read is a failure of the case, with its place
        return "broken", traceback.format_exc(), lab.log


def report(relation, number, said, log):
    print(f"\nFAIL {relation.__name__}, case {number}: {said}")
    print("  " + "\n".join(log).replace("\n", "\n  "))
    print(f"repeat: {os.path.relpath(os.path.abspath(__file__))} --relation {relation.__name__} --case {number}", flush=True)


def chosen_cases(arguments):
    """Cases in the shares of RELATIONS, at least one of each."""
    relations = {"ci": [r for r in RELATIONS if r not in AWAITS], "awaits": list(AWAITS), "all": list(RELATIONS)}[arguments.set]
    if arguments.relation:
        relations = [r for r in RELATIONS if r.__name__ in arguments.relation]
        unknown = set(arguments.relation) - {r.__name__ for r in relations}
        if unknown:
            sys.exit(f"unknown: {', '.join(sorted(unknown))}; there are {', '.join(r.__name__ for r in RELATIONS)}")
    if arguments.case is not None:
        return [(relations[0], arguments.case)]
    seed = int.from_bytes(os.urandom(4), "little") if arguments.seed == "random" else int(arguments.seed)
    total = sum(RELATIONS[relation] for relation in relations)
    print(f"seed {seed}", flush=True)
    return [(relation, number_of(seed, relation, index)) for relation in relations
            for index in range(max(1, round(arguments.cases * RELATIONS[relation] / total)))]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=PROGRAM)
    parser.add_argument("--cases", type=int, default=100)
    parser.add_argument("--seed", default="1")
    parser.add_argument("--relation", action="append")
    parser.add_argument("--set", choices=("ci", "awaits", "all"), default="all")
    parser.add_argument("--case", type=int)
    parser.add_argument("--verbose", action="store_true", help="a line for each case")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep", help="folder in which cases that fail stay")
    arguments = parser.parse_args()
    cases = chosen_cases(arguments)
    program = os.path.abspath(arguments.program)
    counts = {relation: {"held": 0, "unfit": 0, "broken": 0, "seconds": 0.0} for relation, _ in cases}
    with tempfile.TemporaryDirectory() as work, concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:

        def work_on(case):
            start = time.monotonic()
            folder = os.path.join(work, f"{case[0].__name__}_{case[1]}")
            outcome = run_case(program, *case, folder)
            if outcome[0] == "broken" and arguments.keep:
                shutil.copytree(folder, os.path.join(arguments.keep, os.path.basename(folder)), dirs_exist_ok=True)
            shutil.rmtree(folder)
            return case, outcome, time.monotonic() - start

        for (relation, number), (kind, said, log), seconds in pool.map(work_on, cases):
            counts[relation][kind] += 1
            counts[relation]["seconds"] += seconds
            if arguments.verbose:
                print(f"{kind} {relation.__name__} {number} {seconds:.1f} s", flush=True)
            if kind == "broken" or arguments.case is not None:
                if kind == "broken":
                    report(relation, number, said, log)
                else:
                    print("\n".join(log), f"\n{kind} {said}")
    print()
    for relation, count in counts.items():
        awaits = f"   awaits: {AWAITS[relation]}" if relation in AWAITS else ""
        print(f"{relation.__name__:48} held {count['held']:4}, broken {count['broken']:4}, no drive {count['unfit']:3}, "
              f"{count['seconds']:7.1f} s{awaits}")
    return any(count["broken"] for count in counts.values())


if __name__ == "__main__":
    sys.exit(main())
