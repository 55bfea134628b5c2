#!/usr/bin/python3
"""How far the von Mises stresses of runs are from a reference's at all nodes and common times of every set:

    studies/samples_off.py full_stress.h5 100=modes_100_stress.h5 200=modes_200_stress.h5 [--figure samples_off.svg]

Prints for each set the largest deviation over the set's largest stress, the mean one (root of squares over that of the
reference), and the share of the samples above 5 % of the largest stress that are off by more than 1 % of themselves. The words
before = are names; those of a figure are numbers of modes. --to: the last time.
"""
import argparse
import os
import sys

import numpy as np

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
import results

HIGH, OFF = 0.05, 0.01  # of the largest stress of a set; of a sample
SAME_TIME = 1e-6  # of the last time


def histories(path):
    """Times (s), and the von Mises stresses (times x nodes, Pa) of each set."""
    with results.open_file(path, "stress") as file:
        found = {f"{body} {name}": group["von_mises"][:] for body, name, group in results.stress_sets(file)}
        return file["time"][:], found


def common(time, other, last):
    """Rows of the times in both, up to the last one."""
    nearest = np.clip(np.searchsorted(other, time), 1, len(other) - 1)
    nearest -= time - other[nearest - 1] < other[nearest] - time
    rows = np.flatnonzero((np.abs(other[nearest] - time) < SAME_TIME * time[-1]) & (time < last + SAME_TIME * time[-1]))
    return rows, nearest[rows]


def deviations(path, reference, last):
    """{set: (largest, mean, share off)}, and the number of common times."""
    (time, stress), (reference_time, truth) = histories(path), histories(reference)
    rows, others = common(time, reference_time, last)
    found = {}
    for name in sorted(set(stress) & set(truth)):
        true = truth[name][others]
        difference, largest = np.abs(stress[name][rows] - true), true.max()
        high = true > HIGH * largest
        found[name] = (difference.max() / largest, np.sqrt(np.sum(difference**2) / np.sum(true**2)),
                       np.mean(difference[high] > OFF * true[high]))
    return found, len(rows)


def draw(runs, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from plots import COLOURS
    plt.rcParams["svg.fonttype"] = "none"
    figure, (samples, largest) = plt.subplots(1, 2, figsize=(9, 3.6), constrained_layout=True)
    modes = [int(name) for name in runs]
    for name, colour in zip(next(iter(runs.values())), COLOURS):
        samples.loglog(modes, [100 * run[name][2] for run in runs.values()], "s-", color=colour, markersize=4, label=name)
        largest.loglog(modes, [100 * run[name][0] for run in runs.values()], "s-", color=colour, markersize=4)
    for axes, bound, title in ((samples, 5, "samples off by more than 1 %, in %"), (largest, 1, "largest deviation, % of the largest stress")):
        axes.axhline(bound, color="0.6", linewidth=1)
        axes.set_xticks(modes, [str(n) for n in modes])
        axes.minorticks_off()
        axes.set_xlabel("modes a body")
        axes.set_title(title, fontsize=10)
    samples.legend(fontsize=8, frameon=False)
    figure.savefig(path, metadata={"Date": None} if path.endswith(".svg") else None)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("reference", help="stress file")
    parser.add_argument("runs", nargs="+", metavar="NAME=FILE")
    parser.add_argument("--to", type=float, default=np.inf, help="s")
    parser.add_argument("--figure")
    options = parser.parse_args()
    runs = {}
    for name, path in results.key_values(options.runs, "runs").items():
        runs[name], times = deviations(path, options.reference, options.to)
        print(f"{name}: {times} times")
        for place, (largest, mean, off) in runs[name].items():
            print(f"  {place:28s} largest {100 * largest:5.2f} %  mean {100 * mean:5.2f} %  samples off {100 * off:6.2f} %", flush=True)
    if options.figure:
        draw(runs, options.figure)


if __name__ == "__main__":
    main()
