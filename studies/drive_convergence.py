#!/usr/bin/python3
"""What the meshes of `mesh` by size and order make of the reference worm drive:

    studies/drive_convergence.py --elastogear build/release/src/app/elastogear --out drive_convergence drive tiny small medium tiny:2 small:2 medium:2
    studies/drive_convergence.py --elastogear build/release/src/app/elastogear --out drive_convergence frequencies worm small tiny:2 small:2 paper:2
    studies/drive_convergence.py --elastogear build/release/src/app/elastogear --out drive_convergence frequencies wheel small:2 small:2:web=5,hub=4

drive: examples/drives/steering_worm.yaml, 10 modes a body and residual flexibility, at rest under its torque at 32 roll angles:
mesh stiffness, operating contact ratio, largest pressure by H. Hertz and its mean over the roll angle, largest tension at the roots
(mean over the roll angle), and CPU time of the reduction; with --points stations, by the bodies of an earlier run, with flanks at stations.
frequencies: the first 20 of worm or wheel, held as in examples/worm_gear, beside those of the last mesh, one by one with --each;
--element-mass as of `reduce`. web=5 is the count -wheel_count_web 5 of the wheel (-worm_count_... of the worm).
What is there already is read again.
"""
import argparse
import os
import re
import resource
import subprocess

import h5py
import numpy as np

EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples")
MODES = 20


def run(options, folder, *arguments):
    """CPU time in s."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(os.path.join(folder, arguments[0] + ".log"), "w", encoding="utf-8") as log:
        subprocess.run([os.path.abspath(options.elastogear), *arguments], cwd=folder, stdout=log, stderr=subprocess.STDOUT, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def mesh_options(word, body=""):
    """SIZE[:ORDER[:COUNT=N,...]], the counts those of the body."""
    size, order, counts = (word.split(":") + ["", ""])[:3]
    options = ["-size", size, "-element_order", order or "1"]
    for count in filter(None, counts.split(",")):
        name, _, number = count.partition("=")
        options += [f"-{body}_count_{name}", number]
    return options


def folder_name(word):
    return re.sub(r"\W", "_", word)


def nodes_of(path):
    with h5py.File(path) as file:
        return file["mesh/X"].shape[0]


def drive(options):
    print("| mesh | nodes | reduction, s | stiffness, N/um | contact ratio | Hertz, MPa | in the mean | tension at roots of worm, wheel, MPa |")
    for mesh in options.meshes:
        folder = os.path.join(options.out, "drive_" + folder_name(mesh))
        arguments = [os.path.abspath(os.path.join(EXAMPLES, "drives", "steering_worm.yaml")), *mesh_options(mesh), "-modes", "10"]
        if options.points != "minima":
            reduced, folder = os.path.abspath(folder), folder + "_" + options.points
            for body in ("worm.h5", "wheel.h5"):
                os.makedirs(folder, exist_ok=True)
                if not os.path.exists(os.path.join(folder, body)):
                    os.symlink(os.path.join(reduced, body), os.path.join(folder, body))
        os.makedirs(folder, exist_ok=True)
        seconds = np.nan
        if not os.path.exists(os.path.join(folder, "wheel.h5")):
            seconds = run(options, folder, "reduce", *arguments)
        if not os.path.exists(os.path.join(folder, "steering_worm_evaluation.h5")):
            run(options, folder, "simulate", *arguments, "-analysis", "sweep", "-contact_points", options.points)
            run(options, folder, "evaluate", *arguments)
        nodes = [nodes_of(os.path.join(folder, body + ".h5")) for body in ("worm", "wheel")]
        with h5py.File(os.path.join(folder, "steering_worm_evaluation.h5")) as file:
            of = file["cases/steering_worm_result/worm:wheel"]
            tension = [of[f"root/{body}/tension"][:].max(axis=1).mean() / 1e6 for body in ("worm", "wheel")]
            print(f"| {mesh} | {nodes[0]} + {nodes[1]} | {seconds:.0f} | {of['stiffness/secant'][:].mean() / 1e6:.1f} "
                  f"| {of['teeth/contact_ratio'][()]:.2f} | {of['pressure/hertz_peak'][()] / 1e6:.0f} "
                  f"| {of['pressure/hertz'][:].mean() / 1e6:.0f} | {tension[0]:.0f}, {tension[1]:.0f} |")


def frequencies(options):
    body, found = options.meshes[0], {}
    for mesh in options.meshes[1:]:
        folder = os.path.join(options.out, f"{body}_{folder_name(mesh)}" + ("" if options.element_mass == "compatible" else "_" + options.element_mass))
        os.makedirs(folder, exist_ok=True)
        path = os.path.join(folder, body + ".h5")
        if not os.path.exists(path):
            source = os.path.abspath(os.path.join(EXAMPLES, "worm_gear", body + ".yaml"))
            run(options, folder, "mesh", source, *mesh_options(mesh, body))
            run(options, folder, "reduce", source, "-basis", "modal", "-modes", str(MODES), "-surface", "", "-stress_nodes", "", "-store", "surface",
                "-completeness", "false", "-element_mass", options.element_mass)
        with h5py.File(path) as file:
            found[mesh] = file["modes/frequency"][:MODES], nodes_of(path)
    right = found[options.meshes[-1]][0]
    print(f"first {MODES} frequencies of the {body}, {right[0]:.0f} to {right[-1]:.0f} Hz, beside {options.meshes[-1]}")
    for mesh, (frequency, nodes) in found.items():
        error = 100 * (frequency / right - 1)
        each = " " + " ".join(f"{e:+.2f}" for e in error) if options.each else ""
        print(f"| {mesh} | {nodes} nodes | {error.min():+.2f} to {error.max():+.2f} % |{each}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--points", choices=("minima", "stations"), default="minima", help="of contact, by the bodies of an earlier run")
    parser.add_argument("--element-mass", choices=("compatible", "condensed"), default="compatible", help="of hexahedra of 8 nodes, for frequencies")
    parser.add_argument("--each", action="store_true", help="print the error of each frequency")
    parser.add_argument("what", choices=("drive", "frequencies"))
    parser.add_argument("meshes", nargs="+", help="SIZE[:ORDER]; of frequencies SIZE[:ORDER[:COUNT=N,...]], the body before them")
    options = parser.parse_args()
    {"drive": drive, "frequencies": frequencies}[options.what](options)


if __name__ == "__main__":
    main()
