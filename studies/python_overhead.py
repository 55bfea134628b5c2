"""The cost of stepping from Python beside the steps of `simulate` in C++: processor time of equal motions, in turns.

    PYTHONPATH=build/release/python OPENBLAS_NUM_THREADS=1 python3 studies/python_overhead.py [SIZE] [MODES] [STEPS]

A pair of spur gears under torque, from rest. Bodies are read once for each run; the time is that of the steps alone.
"""
import os
import sys
import tempfile
import time
import warnings

import elastogear as eg

REPEATS = 5
DT = 1e-6  # s


def steps_alone(simulation, advance):
    start = time.process_time()
    advance(simulation)
    used = time.process_time() - start
    summary = simulation.summary()
    simulation.close()
    return used, summary


def all_steps(simulation):
    while simulation.step():
        pass


def with_states(simulation):
    for state in simulation:
        state.body("pinion").s_dot, state.body("wheel").q, state.pair("pinion:wheel").contacts


def main():
    size, modes, n = (sys.argv[1:] + ["small", "200", "200"][len(sys.argv) - 1:])[:3]
    warnings.simplefilter("ignore")
    os.chdir(tempfile.mkdtemp())
    drive = eg.Drive({"drive": "cylindrical", "module": "3 mm", "face_width": "25 mm", "torque": "300 N m",
                      "pinion": {"teeth": 17, "profile_shift": 0.3}, "wheel": {"teeth": 43, "profile_shift": 0.1},
                      "size": size, "modes": int(modes), "basis": "modal"})
    drive.reduce()
    motion = {"ts_dt": DT, "ts_max_time": int(n) * DT}
    times = {"simulate": [], "steps": [], "steps and states": []}
    for _ in range(REPEATS):
        for name, advance in [("simulate", lambda s: s.run()), ("steps", all_steps),
                              ("steps and states", with_states)]:
            used, summary = steps_alone(drive.simulation(**motion), advance)
            times[name].append(used)
    least = {name: min(each) for name, each in times.items()}
    print(f"{summary['steps']} steps, {summary['newton_iterations']} iterations of Newton, {modes} modes a body")
    for name, used in least.items():
        print(f"{name:18} {1e3 * used / summary['steps']:8.4f} ms a step, {100 * (used / least['simulate'] - 1):+.2f} %")


main()
