"""The table of figures in docs/validation/README.md, and what scripts/figures.py makes of it."""
import contextlib
import io
import os
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
SCRIPT = os.path.join(REPOSITORY, "scripts", "figures.py")
sys.path.insert(0, os.path.dirname(SCRIPT))
import figures
from figures import Figure, with_unit

TABLE = """# Page

| case | reference | quantity | value | bound | command |
|---|---|---|---|---|---|
| **[Part](page.md)** | | | | | |
| [two blocks](page.md#two) | all modes | force; peak | 1.1 %; 0.49 % | 2 %; 1 % | test `blocks` |
| top | conservation | momentum | 1e-14 | 1e-12 | test `top` |
| a study | Hertz | pressure | +1.6 % | | `studies/hertz.py` |
"""
BLOCKS = """FIGURE two blocks | force | 0.0112 | < 0.02 | %
FIGURE two blocks | peak | 0.001 | < 0.01 | %
FIGURE two blocks | peak | -0.0049 | < 0.01 | %
"""


class Figures(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.table = self.write("README.md", TABLE)
        os.mkdir(os.path.join(self.folder, "figures"))

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def run_script(self, *words, **environment):
        return subprocess.run([sys.executable, "-B", SCRIPT, "--table", self.table, *words, os.path.join(self.folder, "figures")],
                              capture_output=True, text=True, check=False, env={**os.environ, **environment})

    def check(self, **files):
        for name, text in files.items():
            self.write(f"figures/{name}", text)
        return self.run_script("--check")

    def test_a_table_that_states_what_was_found_is_right(self):
        done = self.check(blocks=BLOCKS.replace("-0.0049", "0.0049"))
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("1 rows", done.stdout)

    def test_another_bound_value_or_sign_is_found(self):
        for old, new, complaint in (("< 0.02", "< 0.03", "the bound is '3 %; 1 %'"), ("0.0112", "0.0004", "found '0.04 %;"),
                                    ("0.0112", "-0.0112", "found '-1.1 %;"), ("| -0.0049", "| -0.0049", "found '1.1 %; -0.49 %'")):
            done = self.check(blocks=BLOCKS.replace(old, new))
            self.assertEqual(done.returncode, 1, complaint)
            self.assertIn(f"two blocks: {complaint}", done.stdout)

    def test_a_test_that_ran_without_its_figure_is_found(self):
        done = self.check(blocks="FIGURE two blocks | force | 0.0112 | < 0.02 | %\n")
        self.assertEqual(done.returncode, 1)
        self.assertIn("blocks did not state: peak", done.stdout)

    def test_roundoff_needs_only_hold_its_bound(self):
        done = self.check(top="FIGURE top | momentum | 4e-13 | < 1e-12 | \n")
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertEqual(self.check(top="FIGURE top | momentum | 4e-13 | < 1e-11 | \n").returncode, 1)

    def test_without_figures_nothing_is_checked(self):
        self.assertEqual(self.check().returncode, figures.SKIPPED)

    def test_figures_are_written_into_their_rows_alone(self):
        self.write("figures/blocks", BLOCKS)
        log = self.write("log", "some text\nFIGURE a study | pressure | 0.0213 |  | %\nFIGURE a study | pressure | -0.02 |  | %\n")
        self.assertEqual(self.run_script(log).returncode, 0)
        with open(self.table, encoding="utf-8") as file:
            written = file.read()
        self.assertEqual(written, TABLE.replace("0.49 % |", "-0.49 % |").replace("+1.6 %", "2.1 %"))

    def test_one_name_with_two_bounds_is_refused(self):
        done = self.check(blocks=BLOCKS + "FIGURE two blocks | peak | 0.001 | < 0.02 | %\n")
        self.assertIn("have one name", done.stderr)

    def test_numbers_are_short(self):
        for value, unit, digits, text in ((0.00412, "%", 2, "0.41 %"), (1.2e-14, "", 2, "1.2e-14"), (1e-4, "", 6, "1e-4"), (0, "", 2, "0"),
                                          (-2.4e-8, "µm", 2, "-0.024 µm"), (0.0199999, "%", 6, "1.99999 %"), (9.99e-5, "", 2, "1e-4")):
            self.assertEqual(with_unit(value, unit, digits), text)
        self.assertEqual(Figure(3.14, ">", 2.8, "").bound_text(), "above 2.8")

    def test_what_is_stated_is_held_and_written_to_the_file_of_the_test(self):
        path = os.path.join(self.folder, "figures", "own")
        code = "from figures import figure; figure('a', 'b', 1.5, 2, '%'); figure('a', 'c', 1, 2, above=True)"
        done = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True, check=False,
                              cwd=os.path.dirname(SCRIPT), env={**os.environ, "ELASTOGEAR_FIGURES": path})
        self.assertIn("AssertionError: FIGURE a | c | 1 | > 2 |", done.stderr)
        self.assertEqual(figures.read(path)["a", "b"], Figure(1.5, "<", 2, "%"))

    def test_every_row_of_a_test_can_be_read(self):
        with open(figures.TABLE, encoding="utf-8") as file:
            rows = [figures.Row(line) for line in file if figures.is_row(line)]
        self.assertGreater(len(rows), 50)
        names = [name for row in rows for name in row.names]
        self.assertEqual(len(names), len(set(names)))
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(figures.check([row.line() for row in rows], {}, set()), figures.SKIPPED)


if __name__ == "__main__":
    unittest.main()
