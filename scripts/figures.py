#!/usr/bin/python3
"""The figures of the table "Cases" in docs/validation/README.md, from what tests and studies state.

    scripts/figures.py build/release/tests/figures [LOG ...]        writes values and bounds into the table
    scripts/figures.py --check build/release/tests/figures          says which rows of the table do not agree

Tests and studies state a figure in a line that begins with FIGURE, by figure() below or by tests/figures.h, which hold the bound that they
state. Of a test that ctest starts these lines are in the file of its name in build/*/tests/figures; a LOG is what a study printed. A row
takes the figures of its case and its quantities, between which a semicolon stands; of several of one name the one nearest to the bound.
"""
import argparse
import dataclasses
import os
import re
import sys

TABLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "docs", "validation", "README.md")
SCALE = {"": 1, "%": 100, "m": 1, "µm": 1e6}  # of a number in the table over the value that is stated
DIFFERENT = 1.5  # times the value of the table is another value
SMALL = 0.25  # of the bound: room for roundoff of another processor, an assumption that was not measured
ROUNDOFF = 1e-5  # bounds without a unit of at most that are those of roundoff, or of the tolerance of an iteration
SKIPPED = 77  # exit status, for ctest
OWN_FILE = os.environ.get("ELASTOGEAR_FIGURES")  # of a test that ctest starts
if OWN_FILE:
    open(OWN_FILE, "w", encoding="utf-8").close()


def figure(case, quantity, value, bound=None, unit="", above=False):
    """States a figure and holds it: |value| < bound or, above, value > bound. Values are in SI units; `unit` is that of the table."""
    line = f"FIGURE {case} | {quantity} | {value:.9g} | {'' if bound is None else ('> ' if above else '< ') + format(bound, '.9g')} | {unit}"
    print(line, flush=True)
    if OWN_FILE:
        with open(OWN_FILE, "a", encoding="utf-8") as file:
            print(line, file=file)
    if bound is not None:
        assert value > bound if above else abs(value) < bound, line


@dataclasses.dataclass(frozen=True)
class Figure:
    value: float
    relation: str  # "<", ">" or "" without a bound
    bound: float | None
    unit: str

    def text(self):
        return with_unit(self.value, self.unit, 2)

    def bound_text(self):
        return ("above " if self.relation == ">" else "") + with_unit(self.bound, self.unit, 6) if self.relation else ""

    def agrees_with(self, text):
        """Whether the table's text is this figure, but for what differs between machines."""
        number = re.search(r"[-+]?\d+(\.\d+)?(e[-+]?\d+)?", text)
        if self.relation == "<" and not self.unit and self.bound <= ROUNDOFF:
            return number is not None
        if number is None or (self.unit and not text.endswith(" " + self.unit)):
            return False
        stated = float(number[0]) / SCALE[self.unit]
        largest = max(abs(stated), abs(self.value))
        return abs(stated - self.value) <= (1 - 1 / DIFFERENT) * largest + SMALL * (self.bound if self.relation else 0)


def with_unit(value, unit, digits):
    value *= SCALE[unit]
    text = f"{value:.{digits}g}" if value == 0 or abs(value) >= (1e-3 if unit else 1e-2) else f"{value:.{digits - 1}e}"
    mantissa, e, exponent = text.partition("e")
    if e:
        text = f"{float(mantissa):g}e{int(exponent)}"
    return f"{text} {unit}".strip()


def worse(a, b):
    """Of two figures of one name the one that is nearer to the bound, which both have."""
    if (a.relation, a.bound, a.unit) != (b.relation, b.bound, b.unit):
        sys.exit(f"error: {a} and {b} have one name")
    return min(a, b, key=lambda f: f.value if f.relation == ">" else -abs(f.value))


def read(path):
    """Figures that a file states, by case and quantity."""
    figures = {}
    with open(path, encoding="utf-8", errors="replace") as file:
        for line in file:
            if "FIGURE " not in line or line.count("|") != 4:
                continue
            case, quantity, value, bound, unit = (part.strip() for part in line.split("FIGURE ", 1)[1].split("|"))
            relation, _, bound = bound.partition(" ")
            found = Figure(float(value), relation, float(bound) if relation else None, unit)
            figures[case, quantity] = worse(figures[case, quantity], found) if (case, quantity) in figures else found
    return figures


def read_all(paths):
    """Figures by case and quantity, and the names of the tests that ran."""
    figures, tests = {}, set()
    for path in paths:
        if os.path.isdir(path):
            tests |= set(os.listdir(path))
        for file in sorted(os.path.join(path, name) for name in os.listdir(path)) if os.path.isdir(path) else [path]:
            for name, found in read(file).items():
                figures[name] = worse(figures[name], found) if name in figures else found
    return figures, tests


class Row:
    """A line of the table: case, reference, quantity, value, bound, command."""

    def __init__(self, line):
        self.cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        self.case = re.sub(r"\[(.*?)\]\(.*?\)", r"\1", self.cells[0])
        self.names = [(self.case, quantity) for quantity in self.cells[2].split("; ")]
        self.tests = re.findall(r"`([\w.]+)`", self.cells[5]) if self.cells[5].startswith("test") else []

    def line(self):
        return "|" + "|".join(f" {cell} " if cell else " " for cell in self.cells) + "|\n"

    def take(self, figures):
        of = [figures[name] for name in self.names]
        bounds = [f.bound_text() for f in of]
        self.cells[3] = "; ".join(f.text() for f in of)
        self.cells[4] = "; ".join(bounds if len(set(bounds)) > 1 else bounds[:1])

    def complaints(self, figures, ran):
        """What of this row is not what was found. Rows of tests that have not run cannot be told."""
        missing = [quantity for case, quantity in self.names if (case, quantity) not in figures]
        if missing:
            if self.tests and set(self.tests) <= ran:
                yield f"{', '.join(self.tests)} did not state: {'; '.join(missing)}"
            return
        found = Row(self.line())
        found.take(figures)
        if found.cells[4] != self.cells[4]:
            yield f"the bound is '{found.cells[4]}', not '{self.cells[4]}'"
        values = self.cells[3].split("; ")
        if len(values) != len(self.names) or not all(figures[name].agrees_with(v) for name, v in zip(self.names, values)):
            yield f"found '{found.cells[3]}', not '{self.cells[3]}'"


def is_row(line):
    return line.startswith("| ") and line.count("|") == 7 and not line.startswith(("| case ", "| **"))


def check(table, figures, ran):
    n, failed = 0, False
    for line in table:
        if not is_row(line):
            continue
        row = Row(line)
        n += all(name in figures for name in row.names)
        for complaint in row.complaints(figures, ran):
            print(f"{row.case}: {complaint}")
            failed = True
    print(f"{n} rows of the table have figures")
    if failed:
        print("scripts/figures.py writes the table, after the tests have run")
    return 1 if failed else 0 if n else SKIPPED


def write(path, table, figures):
    for i, line in enumerate(table):
        if not is_row(line):
            continue
        row = Row(line)
        if all(name in figures for name in row.names):
            row.take(figures)
            table[i] = row.line()
            if table[i] != line:
                print(f"was {line}now {table[i]}")
        elif row.tests:
            print(f"not written, since {', '.join(row.tests)} did not state it: {row.case}")
    with open(path, "w", encoding="utf-8") as file:
        file.writelines(table)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="compare and write nothing")
    parser.add_argument("--table", default=TABLE, help="the page")
    parser.add_argument("paths", nargs="+", help="folders of build/*/tests/figures, and logs")
    options = parser.parse_args()
    with open(options.table, encoding="utf-8") as file:
        table = file.readlines()
    figures, ran = read_all(options.paths)
    if options.check:
        sys.exit(check(table, figures, ran))
    write(options.table, table, figures)


if __name__ == "__main__":
    main()
