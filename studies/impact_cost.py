#!/usr/bin/python3
"""CPU time of the impact example by the number of modes a body, beside the paper's.

    studies/impact_cost.py WORM.h5 WHEEL.h5 [--modes 100 500 1000 2000] [--elastogear PROGRAM] [-- OPTION ...]

The body files must hold at least as many modes as the largest number asked for; smaller ones are cut from them, in a
temporary folder. Further options go to `elastogear simulate`. Times are those of one process on one core, user and
system together, from start to end: reading the bodies and writing every step included.
"""
import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time

import h5py

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
from cut import cut

EXAMPLE = os.path.join(os.path.dirname(__file__), "..", "examples", "worm_gear", "impact.yaml")
PAPER = {100: 17, 500: 70, 1000: 339, 2000: 1374}  # s, 0.5 ms, modes of each body


def mode_count(path):
    with h5py.File(path) as file:
        return len(file["modes/frequency"])


def run(command):
    """CPU and wall-clock time of a command (s), and its output."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return cpu, time.monotonic() - start, done.stdout


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("worm")
    parser.add_argument("wheel")
    parser.add_argument("--modes", type=int, nargs="+", default=sorted(PAPER))
    parser.add_argument("--elastogear", default="elastogear", help="the program to run")
    parser.add_argument("options", nargs="*", help="of elastogear simulate, after --")
    return parser.parse_args()


def main():
    args = parse()
    most = min(mode_count(args.worm), mode_count(args.wheel))
    times = {}
    print("  modes   CPU time   wall time   paper   paper / CPU time")
    with tempfile.TemporaryDirectory() as folder:
        for n in args.modes:
            if n > most:
                sys.exit(f"the body files hold {most} modes, not {n}")
            files = {}
            for name, source in (("worm", args.worm), ("wheel", args.wheel)):
                files[name] = os.path.join(folder, name + ".h5")
                cut(source, files[name], n)
            command = [args.elastogear, "simulate", EXAMPLE, "-worm_file", files["worm"], "-wheel_file", files["wheel"],
                       "-output", os.path.join(folder, "impact.h5"), *args.options]
            times[n], wall, _ = run(command)
            paper = PAPER.get(n)
            print(f"{n:7d} {times[n]:8.2f} s {wall:9.2f} s" +
                  (f" {paper:5d} s {paper / times[n]:12.1f}" if paper else ""), flush=True)
    first, last = min(times), max(times)
    if first < last:
        print(f"growth from {first} to {last} modes: {times[last] / times[first]:.1f}")


if __name__ == "__main__":
    main()
