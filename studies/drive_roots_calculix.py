#!/usr/bin/python3
"""Largest von Mises stress at the root of a gear of the reference worm drive by CalculiX (ccx), on the mesh and with the nodal
forces of drive_roots:

    studies/drive_roots_calculix.py --study build/release/studies/drive_roots --body wheel --mesh smallx2:2 --out FOLDER

Hexahedra of 20 nodes are C3D20, those of 8 nodes C3D8I. CalculiX's stresses at nodes are those of its integration points,
extrapolated and averaged, as elastogear's means are, of C3D20 from 27 points where elastogear takes 8 of hex20.
"""
import argparse
import os
import subprocess

from calculix import read_stress


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--study", required=True)
    parser.add_argument("--body", choices=("worm", "wheel"), required=True)
    parser.add_argument("--mesh", required=True)
    parser.add_argument("--out", required=True)
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    deck = f"{args.body}_{args.mesh}".replace(":", "_")
    subprocess.run([os.path.abspath(args.study), args.body, args.mesh, "deck", deck + ".inp"], cwd=args.out, check=True)
    with open(os.path.join(args.out, deck + ".log"), "w", encoding="utf-8") as log:
        subprocess.run(["ccx", deck], cwd=args.out, stdout=log, check=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
    found = read_stress(os.path.join(args.out, deck + ".frd"))
    with open(os.path.join(args.out, deck + ".inp"), encoding="utf-8") as file:
        averaged, recovered = (float(word) for word in file.readline().split(":")[1].split())
    largest = max(found.values())
    print(f"{args.body} {args.mesh}: von Mises {1e-6 * averaged:.2f} MPa averaged, {1e-6 * recovered:.2f} MPa recovered, "
          f"{1e-6 * largest:.2f} MPa by CalculiX, averaged")


if __name__ == "__main__":
    main()
