#!/usr/bin/python3
"""The impact example from mesh to stress histories, as a user with two cores would run it:

    scripts/impact_chain.py --size paper --modes 200

Meshes and reduces both bodies at the same time, one core each, simulates 0.5 ms and recovers the stresses at all roots. Prints
CPU and wall-clock time and memory of every step, then of all: the two reductions count as one step, with the sum of their memory.
Everything is made anew in OUT (default out/chain/SIZE), with what every step printed beside it.
"""
import argparse
import os
import subprocess
import sys
import time

REPOSITORY = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
INPUT = os.path.join(REPOSITORY, "examples", "worm_gear")
BODIES = ("worm", "wheel")
LOADED = {"worm": ["-loaded", "thread_1_right,thread_2_right"],  # the flanks that this impact touches
          "wheel": []}  # all: one tooth's answers serve every tooth


def wait(name, process, log, start):
    """CPU time (s), wall-clock time (s), largest memory (MB) of a process, printed."""
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        with open(log, encoding="utf-8") as file:
            sys.exit(f"{name} failed:\n{file.read()[-2000:]}")
    figures = usage.ru_utime + usage.ru_stime, time.monotonic() - start, usage.ru_maxrss / 1024
    print("{:<18} {:9.1f} s CPU {:9.1f} s wall {:8.0f} MB".format(name, *figures), flush=True)
    return figures


def together(options, commands):
    """Runs commands at the same time, {name: arguments}; CPU time, wall-clock time, sum of their memory."""
    start, processes = time.monotonic(), {}
    for name, command in commands.items():
        log = os.path.join(options.out, name + ".txt")
        with open(log, "w", encoding="utf-8") as file:
            processes[name] = log, subprocess.Popen([options.elastogear, *command], stdout=file, stderr=subprocess.STDOUT,
                                                    env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
    figures = [wait(name, process, log, start) for name, (log, process) in processes.items()]
    return sum(f[0] for f in figures), max(f[1] for f in figures), sum(f[2] for f in figures)


def chain(options):
    """The steps, one after the other."""
    def path(name):
        return os.path.join(options.out, name)

    def yaml(name):
        return os.path.join(INPUT, name + ".yaml")
    files = [word for body in BODIES for word in (f"-{body}_file", path(body + ".h5"))]
    yield {f"mesh {body}": ["mesh", yaml(body), "-size", options.size, "-mesh", path(body + ".msh")] for body in BODIES}
    yield {f"reduce {body}": ["reduce", yaml(body), "-mesh", path(body + ".msh"), "-basis", "modal_residual", "-modes", options.modes,
                              "-store", "surface", "-completeness", "false", "-output", path(body + ".h5"), *LOADED[body]]
           for body in BODIES}
    yield {"simulate": ["simulate", yaml("impact"), *files, "-output", path("impact.h5")]}
    yield {"recover": ["recover", "-result", path("impact.h5"), "-output", path("impact_stress.h5"), *files,
                       "-stress_worm", "root", "-stress_wheel", "root"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="tiny", choices=("tiny", "small", "medium", "paper"))
    parser.add_argument("--modes", default="200", help="of either body")
    parser.add_argument("--out")
    parser.add_argument("--elastogear", default=os.path.join(REPOSITORY, "build/release/src/app/elastogear"))
    options = parser.parse_args()
    options.out = options.out or os.path.join(REPOSITORY, "out", "chain", options.size)
    os.makedirs(options.out, exist_ok=True)
    figures = [together(options, commands) for commands in chain(options)]
    print("{:<18} {:9.1f} s CPU {:9.1f} s wall {:8.0f} MB".format(
        "all", sum(f[0] for f in figures), sum(f[1] for f in figures), max(f[2] for f in figures)))


if __name__ == "__main__":
    main()
