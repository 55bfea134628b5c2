#!/usr/bin/python3
"""Some teeth of a wheel that `elastogear mesh` wrote, with their part of the disc, as a mesh of their own:

    elastogear mesh examples/worm_gear/wheel.yaml -size small -element_order 2 -mesh wheel.inp
    studies/cut_wheel.py wheel.inp cut.inp --beside 4

Tooth 1 and those beside it stay; sets lose what is cut off, and "cut" has the nodes where the rest was. Cells follow each other
tooth by tooth in such meshes.
"""
import argparse

import numpy as np


def read(path):
    """Blocks of an .inp file: heading line, list of lines."""
    blocks = []
    with open(path, encoding="ascii") as file:
        for line in file:
            if line.startswith("**"):
                continue
            if line.startswith("*"):
                blocks.append((line.strip(), []))
            else:
                blocks[-1][1].append(line.strip())
    return blocks


def numbers(lines):
    return [int(word) for line in lines for word in line.split(",") if word.strip()]


def write_lines(file, heading, words):
    file.write(heading + "\n" + "".join(", ".join(map(str, words[i:i + 8])) + ",\n" for i in range(0, len(words), 8)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("cut")
    parser.add_argument("--beside", type=int, default=4, help="teeth that stay on either side of tooth 1")
    parser.add_argument("--teeth", type=int, default=41, help="of the wheel")
    options = parser.parse_args()
    blocks = read(options.mesh)
    with open(options.cut, "w", encoding="ascii") as file:
        for heading, lines in blocks:
            kind = heading.split(",")[0]
            if kind == "*NODE":
                nodes = lines
            elif kind == "*ELEMENT":
                words = numbers(lines)
                cells = np.array(words).reshape(-1, 1 + (20 if "C3D20" in heading else 8))
                tooth = np.arange(len(cells)) * options.teeth // len(cells)
                stays = (tooth <= options.beside) | (tooth >= options.teeth - options.beside)
                kept = set(cells[stays, 1:].ravel().tolist())
                of_cells = set(cells[stays, 0].tolist())
                file.write("*NODE\n" + "".join(line + "\n" for line in nodes if int(line.split(",")[0]) in kept) + heading + "\n")
                for cell in cells[stays]:
                    file.write(", ".join(map(str, cell[:11])) + (",\n" + ", ".join(map(str, cell[11:])) if len(cell) > 11 else "") + "\n")
                write_lines(file, "*NSET, NSET=cut", sorted(kept & set(cells[~stays, 1:].ravel().tolist())))
            elif kind == "*SURFACE":
                sides = [line for line in lines if int(line.split(",")[0]) in of_cells]
                if sides:
                    file.write(heading + "\n" + "".join(side + "\n" for side in sides))
            else:
                left = [number for number in numbers(lines) if number in (kept if kind == "*NSET" else of_cells)]
                if left:
                    write_lines(file, heading, left)


if __name__ == "__main__":
    main()
