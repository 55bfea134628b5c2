#!/usr/bin/python3
"""Force and largest root stresses of an impact over time, by reduced bodies and by unreduced ones, with the estimated errors:

    studies/impact_history.py reduced.h5 reduced_stress.h5 full.h5 full_stress.h5 --figure impact_history.svg

Stresses are those of the node where the unreduced body has its largest one; the band is the estimated error of the reduction, the wider one
that of reduction, mesh and contact's resolution together. Sets without all estimates, as flanks, are left out. Prints both peaks, and of the
samples at nodes and times with a tenth of the largest stress or more the share whose error is below once and twice the estimate of the
reduction.
"""
import argparse
import os
import sys

import matplotlib
import numpy as np

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
import results

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HIGH = 0.1  # of the largest stress of a set
ESTIMATES = {"error", "mesh_error", "contact_error"}  # which flanks under contact do not have
MPA, MICRO = 1e-6, 1e6


def force(path):
    with results.open_file(path, "result") as file:
        (pair,) = file["contact"].values()
        return file["time"][:], np.linalg.norm(pair["force"][:], axis=1)


def stresses(path):
    """Times, and of each set the von Mises stress and the estimated errors of it (times x nodes, Pa)."""
    with results.open_file(path, "stress") as file:
        return file["time"][:], {f"{body} {name}": {n: group[n][:] for n in {"von_mises", "time_error"} | ESTIMATES if n in group} | {"nodes": group["nodes"][:]}
                                 for body, name, group in results.stress_sets(file)}


def compare(name, part, truth):
    """Node and time of the unreduced body's largest stress; prints what is there and how the estimate holds."""
    exact = truth["von_mises"]
    time, node = np.unravel_index(exact.argmax(), exact.shape)
    high = exact > HIGH * exact.max()
    error, estimate = abs(part["von_mises"] - exact)[high], part["error"][high]
    peak = part["von_mises"].max()
    there = [part[n][time, node] * MPA for n in ("von_mises", "error", "mesh_error", "contact_error")]
    print(f"{name}: largest {peak * MPA:.1f} and unreduced {exact.max() * MPA:.1f} MPa ({100 * (peak / exact.max() - 1):+.2f} %)")
    print(f"  at node {part['nodes'][node]} then {there[0]:.1f} MPa, estimates of reduction, mesh, contact {there[1]:.2f} {there[2]:.1f} {there[3]:.1f}")
    print(f"  {high.sum()} samples: error below the estimate {100 * np.mean(error < estimate):.1f} %, below twice {100 * np.mean(error < 2 * estimate):.1f} %,"
          f" estimate over error {np.median(estimate / error):.2f} in the median; root of squares off by "
          f"{100 * np.linalg.norm(part['von_mises'] - exact) / np.linalg.norm(exact):.3f} %")
    return node


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs=4, help="result and stress of the reduced run, of the unreduced one")
    parser.add_argument("--figure")
    options = parser.parse_args()
    forces = [force(options.files[k]) for k in (0, 2)]
    (time, parts), (full_time, truths) = (stresses(options.files[k]) for k in (1, 3))
    assert np.allclose(time[:len(full_time)], full_time) or np.allclose(time, full_time[:len(time)]), "other times"
    n = min(len(time), len(full_time))
    parts, truths = ({s: {k: v[:n] if v.ndim == 2 else v for k, v in of.items()} for s, of in found.items()} for found in (parts, truths))
    m = min(len(forces[0][0]), len(forces[1][0]))
    (t, F), (_, F_full) = ((a[:m], b[:m]) for a, b in forces)
    print(f"force: peak {F.max():.1f} N at {t[F.argmax()] * MICRO:.0f} us, unreduced {F_full.max():.1f} N at {t[F_full.argmax()] * MICRO:.0f} us"
          f" ({100 * (F.max() / F_full.max() - 1):+.2f} %), over time {100 * np.linalg.norm(F - F_full) / np.linalg.norm(F_full):.2f} % off")
    nodes = {name: compare(name, parts[name], truths[name]) for name in truths if ESTIMATES <= parts[name].keys()}
    if not options.figure:
        return
    figure, axes = plt.subplots(1, 1 + len(nodes), figsize=(4 * (1 + len(nodes)), 3.2), layout="constrained")
    axes[0].plot(t * MICRO, F_full / 1e3, "k", lw=2.5, alpha=0.35, label="unreduced")
    axes[0].plot(t * MICRO, F / 1e3, "C0", lw=1, label="reduced")
    axes[0].set(xlabel="time, µs", ylabel="contact force, kN")
    axes[0].legend(frameon=False)
    for axis, (name, node) in zip(axes[1:], nodes.items()):
        part = {k: v[:, node] * MPA for k, v in parts[name].items() if v.ndim == 2}
        together = part["error"] + part["mesh_error"] + part["contact_error"] + part.get("time_error", 0)
        s, at = part["von_mises"], time[:n] * MICRO
        axis.fill_between(at, s - together, s + together, color="C0", alpha=0.15, lw=0, label="estimated error, all")
        axis.fill_between(at, s - part["error"], s + part["error"], color="C0", alpha=0.4, lw=0, label="of the reduction")
        axis.plot(at, truths[name]["von_mises"][:, node] * MPA, "k", lw=2.5, alpha=0.35)
        axis.plot(at, s, "C0", lw=1)
        axis.set(xlabel="time, µs", ylabel=f"{name} node {parts[name]['nodes'][node]}, MPa", ylim=(0, None))
        axis.legend(frameon=False, loc="upper left")
    figure.savefig(options.figure)


if __name__ == "__main__":
    main()
