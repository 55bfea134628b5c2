#!/usr/bin/python3
"""The cost of stepping from Python beside the steps of `simulate` in C++: processor time of equal motions, in turns.

    PYTHONPATH=build/release/python OPENBLAS_NUM_THREADS=1 studies/python_overhead.py [SIZE] [MODES] [STEPS]

First a rigid body that spins, whose steps cost next to nothing, so that the cost of Python is seen by itself; then a
pair of spur gears under torque, from rest. The time is that of the steps alone, the least of several runs in random
order.
"""
import os
import random
import sys
import tempfile
import time
import warnings

import elastogear as eg

SPUR = {"drive": "cylindrical", "module": "3 mm", "face_width": "25 mm", "torque": "300 N m", "basis": "modal",
        "pinion": {"teeth": 17, "profile_shift": 0.3}, "wheel": {"teeth": 43, "profile_shift": 0.1},
        "contact_points": "nodes"}
SPINNER = {"bodies": ["a", "b"], **{name: {"mass": 1, "inertia": [1, 1, 1, 0, 0, 0], "joint": "revolute", "omega0": 1}
                                    for name in "ab"}}


def in_c(simulation):
    simulation.run()


def steps(simulation):
    while simulation.step():
        pass


def steps_and_states(simulation):
    for state in simulation:
        state.body(BODIES[0]).s_dot, state.body(BODIES[1]).q, state.energies


def measure(system, n, dt, repeats):
    """Processor time of a step, s, by the way of stepping."""
    times = {in_c: [], steps: [], steps_and_states: []}
    for _ in range(repeats):
        for way, each in random.sample(list(times.items()), len(times)):
            simulation = system.simulation(ts_dt=dt, ts_max_time=n * dt)
            start = time.process_time()
            way(simulation)
            each.append((time.process_time() - start) / n)
            simulation.close()
    return {way: min(each) for way, each in times.items()}


def main():
    size, modes, n = (sys.argv[1:] + ["small", "200", "200"][len(sys.argv) - 1:])[:3]
    warnings.simplefilter("ignore")
    os.chdir(tempfile.mkdtemp())
    BODIES[:] = ["a", "b"]
    alone = measure(eg.System(SPINNER, output="none.h5"), 10000, 1e-4, 7)
    BODIES[:] = ["pinion", "wheel"]
    drive = eg.Drive({**SPUR, "size": size, "modes": int(modes)})
    drive.reduce()
    of_drive = measure(drive, int(n), 1e-6, 9)
    for way in [steps, steps_and_states]:
        cost = alone[way] - alone[in_c]
        print(f"{way.__name__}: {1e6 * cost:.2f} us a step by itself, {100 * cost / of_drive[in_c]:.3f} % of a step of "
              f"the drive, {1e3 * of_drive[in_c]:.3f} ms; measured there {100 * (of_drive[way] / of_drive[in_c] - 1):+.2f} %")


BODIES = []
main()
