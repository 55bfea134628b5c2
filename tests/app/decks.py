#!/usr/bin/env python3
"""Input files as other programs write them give the frequencies of CalculiX, with a warning of all that is lost, or are refused with
the remedy.

    decks.py PATH/TO/elastogear [PATH/TO/ccx]

With ccx, the figures in deck_cases.py are compared with those of CalculiX itself."""
import os
import re
import subprocess
import sys
import tempfile

import h5py
import numpy as np

from deck_cases import DECKS

ROUNDOFF, PRINTED = 1e-9, 2e-6  # relative


def write_files(deck, name):
    for path, text in {**deck.files, deck.file: deck.text}.items():
        if os.path.dirname(path):
            os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path if path != deck.file else name, "w", encoding=deck.encoding, newline="") as file:
            file.write(text)


def reduce(program, deck):
    write_files(deck, deck.file)
    words = f"reduce -mesh {deck.file} -unit mm -element plain -basis modal -modes 4 -completeness false -output body.h5"
    return subprocess.run([program, *words.split(), *deck.options.split()], capture_output=True, text=True, check=False)


def wrong_warnings(deck, text):
    lost = re.findall(r"lost of the mesh file: (.*)", text)
    missing = [words for words in deck.warns if not any(re.search(words, line) for line in lost)]
    return [f"no warning of '{words}'" for words in missing] + [f"'{line}' is no loss" for line in lost
                                                                if not any(re.search(words, line) for words in deck.warns)]


def wrong_frequencies(deck, all_found):
    with h5py.File("body.h5") as file:
        found = all_found[deck.name] = file["modes/frequency"][:len(deck.frequencies)]
    close = np.allclose(found, deck.frequencies, rtol=deck.tolerance, atol=0)
    equal = not deck.equals or np.allclose(found, all_found[deck.equals], rtol=ROUNDOFF, atol=0)
    return ([] if close else [f"{found} Hz for {deck.frequencies}"]) + ([] if equal else [f"{found} Hz are not those of '{deck.equals}'"])


def faults(program, deck, all_found):
    done = reduce(program, deck)
    if deck.error:
        return [] if done.returncode and re.search(f"error: .*{deck.error}", done.stderr) else [f"expected '{deck.error}', got {done.stderr}"]
    if done.returncode:
        return [done.stderr]
    return wrong_warnings(deck, done.stdout) + wrong_frequencies(deck, all_found)


def calculix_frequencies(ccx, deck):
    write_files(deck, "ccx.inp")
    if deck.same_as:
        with open("ccx.inp", "w", encoding="utf-8") as file:
            file.write(deck.same_as)
    subprocess.run([ccx, "-i", "ccx"], capture_output=True, check=False)
    with open("ccx.dat", encoding="utf-8") as file:
        table = file.read().split("P A R T I C I P A T I O N")[0]
    os.remove("ccx.dat")
    rows = [line.split() for line in table.splitlines()]
    return [float(row[3]) for row in rows if len(row) == 5 and row[0].isdigit()][:len(deck.frequencies)]


def main():
    program = os.path.abspath(sys.argv[1])
    bad, all_found = 0, {}
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        for deck in DECKS:
            found = faults(program, deck, all_found)
            if len(sys.argv) > 2 and deck.frequencies:
                figures = calculix_frequencies(sys.argv[2], deck)
                if not np.allclose(figures, deck.frequencies, rtol=PRINTED, atol=0):
                    found.append(f"CalculiX: {figures}")
            bad += bool(found)
            for fault in found:
                print(f"FAIL: {deck.name}: {fault}")
    print(f"{len(DECKS)} decks, {bad} wrong")
    return bad > 0


if __name__ == "__main__":
    sys.exit(main())
