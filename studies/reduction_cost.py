#!/usr/bin/python3
"""Processor time and memory of whole reductions of a wheel by its size and the number of ranks, and what larger ones take.
Run: studies/reduction_cost.py --elastogear build/release/src/app/elastogear --out reduction_cost examples/worm_gear/wheel.yaml
     studies/reduction_cost.py [--dofs 10e6] [--ranks 21]          what benchmarks/reductions.csv says

Each reduction is that of the file with --modes, residual flexibility and all its flanks. docs/performance.md, "A model of
the cost", holds the formulas."""
import argparse
import csv
import os
import re
import resource
import subprocess
import sys

import numpy as np

TABLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "benchmarks", "reductions.csv")
FIGURES = ("time", "memory")  # s and GB of the rank that takes most
# By name: options of `mesh`. Counts of the last are twice those of size paper.
WHEELS = {size: ["-size", size] for size in ("small", "medium", "paper")}
WHEELS["large"] = ["-size", "paper"] + [f"-wheel_count_{name}={count}" for name, count in (
    ("tooth", 20), ("space", 8), ("flank", 26), ("fillet", 12), ("rim", 18), ("ring", 12), ("web", 28), ("hub", 12),
    ("web_layers", 16), ("face_layers", 8), ("hub_layers", 6))]


def report_rank(command):
    """Runs a rank's program and tells its processor time and its memory."""
    done = subprocess.run(command, check=False)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"rank used {used.ru_utime:.3f} s {used.ru_maxrss * 1024 / 1e9:.4f} GB", flush=True)
    sys.exit(done.returncode)


def measure(args, name, ranks):
    mesh, body = (os.path.join(args.out, f"{name}.{kind}") for kind in ("msh", "h5"))
    if not os.path.exists(mesh):
        options = [part for option in WHEELS[name] for part in option.split("=")]
        subprocess.run([args.elastogear, "mesh", args.wheel, "-mesh", mesh, *options], check=True, stdout=subprocess.DEVNULL)
    command = ["mpirun", "--oversubscribe", "-n", str(ranks), sys.executable, os.path.abspath(__file__), "--rank",
               args.elastogear, "reduce", args.wheel, "-mesh", mesh, "-modes", str(args.modes), "-store", "surface",
               "-completeness", "false", "-output", body]
    text = subprocess.run(command, check=True, capture_output=True, text=True,
                          env={**os.environ, "OPENBLAS_NUM_THREADS": "1"}).stdout
    used = np.array(re.findall(r"rank used (\S+) s (\S+) GB", text), float)
    n = int(re.search(r"free (\d+)", text).group(1))
    row = {"wheel": name, "ranks": ranks, "n": n, "time": used[:, 0].max(), "memory": used[:, 1].max()}
    print(row, flush=True)
    return row


def read(path):
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return [{key: value if key == "wheel" else float(value) for key, value in row.items()} for row in rows]


def fit(rows, name):
    """A function of n and p: a n^e (s + (1 - s) / p), a and e from the two largest wheels on one rank, s from all on more."""
    one = sorted((row for row in rows if row["ranks"] == 1), key=lambda row: row["n"])
    largest = one[-2:]
    exponent, logarithm = np.polyfit(np.log([row["n"] for row in largest]), np.log([row[name] for row in largest]), 1)
    alone = {row["wheel"]: row[name] for row in one}
    shares = [(row[name] / alone[row["wheel"]] - 1 / row["ranks"]) / (1 - 1 / row["ranks"])
              for row in rows if row["ranks"] > 1 and row["wheel"] in alone]
    s = float(np.clip(np.mean(shares), 0, 1))
    return (lambda n, p: np.exp(logarithm) * n**exponent * (s + (1 - s) / p)), exponent, s


def check(rows):
    """What the smaller wheels on one and two ranks say of each of the others."""
    largest = max(row["n"] for row in rows)
    known = [row for row in rows if row["n"] < largest and row["ranks"] <= 2]
    models = {name: fit(known, name)[0] for name in FIGURES}
    print(f"{'':10} {'n':>9} {'ranks':>5} {'time':>9} {'said':>9} {'memory':>8} {'said':>8}")
    for row in rows:
        said = {name: model(row["n"], row["ranks"]) for name, model in models.items()}
        print(f"{row['wheel']:10} {row['n']:9.0f} {row['ranks']:5.0f} {row['time']:7.1f} s {said['time']:7.1f} s"
              f" {row['memory']:5.2f} GB {said['memory']:5.2f} GB{'' if row in known else '  not used'}")


def main():
    if sys.argv[1:2] == ["--rank"]:
        report_rank(sys.argv[2:])
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("wheel", nargs="?", help="measure: a wheel's file")
    parser.add_argument("--elastogear", default="elastogear")
    parser.add_argument("--out", default="reduction_cost", help="folder of meshes and of reductions.csv")
    parser.add_argument("--wheels", default="small,medium,paper", help="measure: of small, medium, paper, large")
    parser.add_argument("--on", default="1,2,4", help="measure: numbers of ranks")
    parser.add_argument("--modes", type=int, default=200)
    parser.add_argument("--dofs", type=float, default=10e6, help="free displacements of the larger wheel")
    parser.add_argument("--ranks", type=int, default=21)
    parser.add_argument("--table", default=TABLE, help="measurements (CSV)")
    args = parser.parse_args()
    if args.wheel:
        os.makedirs(args.out, exist_ok=True)
        args.table = os.path.join(args.out, "reductions.csv")
        rows = [measure(args, name, int(ranks)) for name in args.wheels.split(",") for ranks in args.on.split(",")]
        with open(args.table, "w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, rows[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    rows = read(args.table)
    check(rows)
    for name, unit in zip(FIGURES, ("s", "GB")):
        model, exponent, s = fit(rows, name)
        print(f"{name}: grows as n^{exponent:.2f}, of which every rank has {100 * s:.0f} %; {args.dofs:.3g} free displacements "
              f"on {args.ranks} ranks: {model(args.dofs, args.ranks):.3g} {unit}")


if __name__ == "__main__":
    main()
