#!/usr/bin/python3
"""The impact example from mesh to stress histories, as a user with two cores would run it:

    studies/impact_chain.py --size paper --modes 200

Meshes both bodies, reduces one after the other on two ranks, simulates 0.5 ms and recovers the stresses at all roots. Prints CPU and
wall-clock time and memory of every step, then of all; of a reduction the memory of its largest rank (all ranks: times their number). Everything
is made anew in OUT (default out/chain/SIZE), with what every step printed beside it.
"""
import argparse
import os
import sys

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
from steps import Steps

REPOSITORY = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
INPUT = os.path.join(REPOSITORY, "examples", "worm_gear")
BODIES = ("worm", "wheel")
RANKS = 2  # of a reduction
LOADED = {"worm": ["-loaded", "thread_1_right,thread_2_right"],  # the flanks that this impact touches
          "wheel": []}  # all: one tooth's answers serve every tooth


def step(options, steps, name, ranks, command):
    """CPU time (s), wall-clock time (s), memory (MB; of all ranks, each as the largest) of one command, printed."""
    launcher = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    cpu, wall, memory = steps.run(name, [*launcher, options.elastogear, *command], os.path.join(options.out, name.replace(" ", "_") + ".txt"))
    return cpu, wall, ranks * memory


def chain(options):
    """The steps: name, ranks, command."""
    def path(name):
        return os.path.join(options.out, name)

    def yaml(name):
        return os.path.join(INPUT, name + ".yaml")
    files = [word for body in BODIES for word in (f"-{body}_file", path(body + ".h5"))]
    for body in BODIES:
        yield f"mesh {body}", 1, ["mesh", yaml(body), "-size", options.size, "-mesh", path(body + ".msh")]
    for body in BODIES:
        yield f"reduce {body}", RANKS, ["reduce", yaml(body), "-mesh", path(body + ".msh"), "-basis", "modal_residual",
                                        "-modes", options.modes, "-store", "surface", "-completeness", "false",
                                        "-output", path(body + ".h5"), *LOADED[body]]
    yield "simulate", 1, ["simulate", yaml("impact"), *files, "-output", path("impact.h5")]
    yield "recover", 1, ["recover", "-result", path("impact.h5"), "-output", path("impact_stress.h5"), *files,
                         "-stress_worm", "root", "-stress_wheel", "root"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="tiny", choices=("tiny", "small", "medium", "paper"))
    parser.add_argument("--modes", default="200", help="of either body")
    parser.add_argument("--out")
    parser.add_argument("--elastogear", default=os.path.join(REPOSITORY, "build/release/src/app/elastogear"))
    options = parser.parse_args()
    options.out = options.out or os.path.join(REPOSITORY, "out", "chain", options.size)
    os.makedirs(options.out, exist_ok=True)
    plan = list(chain(options))
    steps = Steps(len(plan))
    figures = [step(options, steps, *what) for what in plan]
    print("{:<34} {:9.1f} s CPU {:9.1f} s wall {:8.0f} MB".format(
        "all", sum(f[0] for f in figures), sum(f[1] for f in figures), max(f[2] for f in figures)))


if __name__ == "__main__":
    main()
