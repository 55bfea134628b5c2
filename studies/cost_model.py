#!/usr/bin/python3
"""Time and memory that a reduction takes, on paper: fitted to kernels measured on one and two ranks.
Run: studies/cost_model.py [--dofs 10e6] [--modes 2000] [--ranks 64] [--sectors 41] [--kernels benchmarks/kernels.csv]

docs/performance.md, "A model of the cost", holds the formulas. The kernels are those of benchmark_eigenmodes -kernels."""
import argparse
import csv
import os

import numpy as np

KERNELS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "benchmarks", "kernels.csv")
BLOCKS = (8, 16, 32)
COLUMNS_PER_MODE, FIRST_BLOCKS = 1.7, 24     # of a Krylov basis (docs/theory, section 2.2)
WINDOWS = (60, 100, 150, 200, 250, 300, 400, 500, 600)
WORKSPACE, ROOM = 1.3, 1.3                   # of the factor, of the basis
DOUBLE, GIGABYTE = 8, 1e9
LARGEST_BASIS, SMALL_BASIS = 1.5, 1e8         # entries: over those of the factor; always allowed
PRODUCT_RATE = 27e9                          # flops/s of one core with the basis: worm_small, 500 modes in 34.6 s
COUNTS = 3                                   # factorisations of a harmonic to count its modes
SECTOR = 3.9                                 # measured over modelled time of the paper's wheel by 41 sectors
GRAPH_BYTES_PER_DOF = 81 * 4                 # of the sparsity of 27 neighbours, that rank 0 orders


def read_kernels(path):
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return [{key: value if key == "body" else float(value) for key, value in row.items()} for row in rows]


def serial_share(rows, time):
    """Share s of a kernel that does not speed up, t(p) = t(1) (s + (1 - s) / p), from bodies run on 1 and 2 ranks."""
    shares = []
    for one in (row for row in rows if row["ranks"] == 1):
        for two in (row for row in rows if row["ranks"] == 2 and row["body"] == one["body"]):
            shares.append(2 * time(two) / time(one) - 1)
    return float(np.clip(np.mean(shares), 0, 1))


def power_law(rows, name):
    """Exponent and coefficient of a n^p through bodies of one shape and growing size."""
    n, values = ([row[key] for row in rows] for key in ("n", name))
    exponent, logarithm = np.polyfit(np.log(n), np.log(values), 1)
    return lambda n: np.exp(logarithm) * n**exponent


class Model:
    """Coefficients, each the mean over the bodies run on one rank. Fill grows as that of the wheels."""

    def __init__(self, rows):
        one = [row for row in rows if row["ranks"] == 1]
        wheels = [row for row in one if row["body"].startswith("wheel")]
        self.entries, self.flops = power_law(wheels, "entries"), power_law(wheels, "flops")
        self.assembly_1 = np.mean([row["assembly"] / row["n"] for row in one])
        self.factor_rate = np.mean([row["flops"] / row["factorisation"] for row in one])
        per_block = np.array([[row[f"solve{b}"] / row["entries"] for b in BLOCKS] for row in one]).mean(axis=0)
        self.solve_column, self.solve_block = np.polyfit(BLOCKS, per_block, 1)  # s per entry
        self.serial = {name: serial_share(rows, time) for name, time in (
            ("assembly", lambda row: row["assembly"]),
            ("factorisation", lambda row: row["factorisation"]),
            ("solve", lambda row: row["solve16"]))}

    def on_ranks(self, name, time, ranks):
        s = self.serial[name]
        return time * (s + (1 - s) / ranks)

    def problem(self, n, modes, ranks):
        """Seconds and bytes a rank for the lowest modes of one eigenproblem, with the window that is quickest among
        those whose basis is small beside the factor."""
        choices = [self.windows(n, modes, ranks, window, block) for window in WINDOWS for block in BLOCKS]
        most = DOUBLE * max(LARGEST_BASIS * self.entries(n), SMALL_BASIS)
        fitting = [c for c in choices if c["basis"] <= most] or choices[:1]
        return min(fitting, key=lambda c: c["time"])

    def windows(self, n, modes, ranks, window, block):
        n_windows = max(1, round(modes / window))
        size = modes / n_windows
        columns = COLUMNS_PER_MODE * size + FIRST_BLOCKS * block
        solves = columns / block * self.entries(n) * (self.solve_block + self.solve_column * block)
        parts = {
            "factorisation": self.on_ranks("factorisation", self.flops(n) / self.factor_rate, ranks),
            "solves": self.on_ranks("solve", solves, ranks),
            "products": (2 * n * columns**2 + 4 * n * columns * size) / PRODUCT_RATE / ranks}
        basis = ROOM * DOUBLE * n * columns
        memory = (WORKSPACE * DOUBLE * self.entries(n) + basis) / ranks
        first = memory + DOUBLE * n * block + GRAPH_BYTES_PER_DOF * n
        return {"time": n_windows * sum(parts.values()), "memory": memory, "first": first, "window": size,
                "block": block, "basis": basis,
                "parts": {name: n_windows * time for name, time in parts.items()}}


def general(model, args):
    result = model.problem(args.dofs, args.modes, args.ranks)
    return {**result, "way": f"windows of {result['window']:.0f} modes, blocks of {result['block']}"}


def cyclic(model, args):
    """Harmonics on groups of ranks: each a real problem of two sectors' size, modes in pairs."""
    harmonics = args.sectors // 2 + 1
    groups = min(args.ranks, harmonics)
    per_group = -(-harmonics // groups)
    result = model.problem(2 * args.dofs / args.sectors, 2 * args.modes / args.sectors, args.ranks / groups)
    parts = {name: SECTOR * per_group * time for name, time in result["parts"].items()}
    parts["factorisation"] *= 1 + COUNTS
    return {**result, "time": sum(parts.values()), "parts": parts,
            "way": f"{harmonics} harmonics on {groups} groups of {args.ranks / groups:.2g} ranks"}


def lines(title, result):
    parts = ", ".join(f"{name} {time:.0f} s" for name, time in result["parts"].items())
    return [f"{title}: {result['way']}",
            f"  eigenmodes {result['time']:.0f} s ({parts})",
            f"  memory {result['memory'] / GIGABYTE:.2f} GB a rank, rank 0 {result['first'] / GIGABYTE:.2f} GB"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--dofs", type=float, default=10e6, help="free displacements of the body")
    parser.add_argument("--modes", type=float, default=2000)
    parser.add_argument("--ranks", type=int, default=64)
    parser.add_argument("--sectors", type=int, default=41, help="1: the body does not repeat")
    parser.add_argument("--kernels", default=KERNELS, help="measurements (CSV)")
    args = parser.parse_args()
    model = Model(read_kernels(args.kernels))
    assembly = model.on_ranks("assembly", model.assembly_1 * args.dofs, args.ranks)
    print(f"{args.dofs:.3g} free displacements, {args.modes:.0f} modes, {args.ranks} ranks: assembly {assembly:.1f} s")
    print("\n".join(lines("whole body", general(model, args))))
    if args.sectors > 1:
        print("\n".join(lines(f"{args.sectors} sectors", cyclic(model, args))))


if __name__ == "__main__":
    main()
