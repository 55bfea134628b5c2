"""The plots and the summary, run on a small result whose values are known."""
import contextlib
import io
import os
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock

import h5py
import numpy as np

SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts")
sys.path.insert(0, SCRIPTS)
import steps  # noqa: E402  (found through the line above)

TIME = np.linspace(0, 2e-4, 5)
PULSE = np.array([0.0, 1.0, 2.0, 1.0, 0.0])


def write_result(path):
    """A wheel that rebounds: peak force 500 N = (300, 400), all through one contact area, at 100 µs."""
    force = PULSE[:, None] / 2 * np.array([300.0, 400.0, 0.0])
    with h5py.File(path, "w") as file:
        file.attrs["format"] = "elastogear result"
        file["time"] = TIME
        file["bodies/worm/rigid_velocity"] = np.zeros((5, 0))
        file["bodies/worm"].attrs["joint"] = "fixed"
        file["bodies/wheel/rigid_velocity"] = np.array([[20.0], [10.0], [0.0], [-10.0], [-19.0]])
        file["bodies/wheel"].attrs["joint"] = "revolute"
        pair = file.create_group("contact/worm:wheel")
        pair["force"], pair["count"], pair["penetration"] = force, (2 * PULSE).astype(int), 1e-6 * PULSE
        pair["groups/b/force"] = np.stack([force, np.zeros_like(force)], axis=1)
        pair["groups/b/name"] = np.array([b"tooth_00_left", b"tooth_00_right"])
        for name, values in (("kinetic", 4 - PULSE), ("elastic", 0.75 * PULSE), ("contact", 0.25 * PULSE),
                             ("dissipated", 0 * PULSE), ("work", 0 * PULSE), ("balance", 0.01 * PULSE)):
            file["energy/" + name] = values


def write_stress(path):
    """Two nodes of the worm in pure shear; node 17 carries the larger one: sqrt(3) 100 MPa by von Mises."""
    shear = PULSE[:, None] / 2 * np.array([[60e6, 100e6]])
    with h5py.File(path, "w") as file:
        file.attrs["format"] = "elastogear stress"
        file["time"] = TIME
        group = file.create_group("worm/root")
        group["nodes"] = [4, 17]
        group["stress"] = np.stack([0 * shear, 0 * shear, 0 * shear, shear, 0 * shear, 0 * shear], axis=2)
        group["von_mises"], group["rankine"] = np.sqrt(3) * shear, shear


def write_body(path):
    with h5py.File(path, "w") as file:
        file.attrs["format"] = "elastogear body"
        file["modes/frequency"], file["rigid/mass"] = [1e4, 2e4], 0.08
        file["mesh/X"], file["mesh/cell_type"] = np.zeros((12, 3)), [0, 0]
        file["surface/face"], file["stress/nodes"] = np.zeros((6, 4), int), [4, 17]


class CostModel(unittest.TestCase):
    def eigenmodes(self, *options):
        """Seconds for the whole body and by sectors."""
        command = [sys.executable, os.path.join(SCRIPTS, "..", "studies", "cost_model.py"), *options]
        text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        return [float(line.split()[1]) for line in text.splitlines() if line.strip().startswith("eigenmodes")]

    def test_more_ranks_and_fewer_modes_take_less_time(self):
        reference = self.eigenmodes("--dofs", "1e6", "--modes", "1000", "--ranks", "2")
        for options in (("--modes", "1000", "--ranks", "8"), ("--modes", "200", "--ranks", "2")):
            for less, more in zip(self.eigenmodes("--dofs", "1e6", *options), reference):
                self.assertLess(less, more)

    def test_the_worm_of_the_paper_takes_about_what_was_measured(self):
        measured = 820  # s, docs/performance.md
        self.assertLess(abs(self.eigenmodes("--dofs", "349398", "--ranks", "1", "--sectors", "1")[0] / measured - 1), 0.5)

class ReductionCost(unittest.TestCase):
    def figures(self, *options):
        """Seconds and GB of the rank that takes most."""
        command = [sys.executable, os.path.join(SCRIPTS, "..", "studies", "reduction_cost.py"), *options]
        text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        return [float(line.split()[-2]) for line in text.splitlines() if line.startswith(("time:", "memory:"))]

    def test_says_what_was_measured_of_the_largest_wheel(self):
        time, memory = self.figures("--dofs", "12192498", "--ranks", "1")
        self.assertLess(abs(time / 1806.35 - 1), 0.01)  # s and GB, benchmarks/reductions.csv
        self.assertLess(abs(memory / 17.52 - 1), 0.01)

    def test_more_ranks_take_less_and_larger_wheels_more(self):
        reference = self.figures("--dofs", "3e6", "--ranks", "2")
        for less, more in ((self.figures("--dofs", "3e6", "--ranks", "8"), reference),
                           (reference, self.figures("--dofs", "6e6", "--ranks", "2"))):
            self.assertTrue(all(a < b for a, b in zip(less, more)))


class Progress(unittest.TestCase):
    """Steps of a chain tell how far they are, whatever the time they take."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.log = os.path.join(self.folder.name, "log.txt")
        self.out = io.StringIO()

    def run_step(self, code):
        with contextlib.redirect_stdout(self.out), unittest.mock.patch.object(steps, "ELSEWHERE", 0):
            return steps.Steps(3).run("reduce", [sys.executable, "-c", code], self.log)

    def test_a_line_holds_step_and_progress(self):
        go_on = os.path.join(self.folder.name, "go_on")
        threading.Thread(target=self.when_shown, args=("eigenmodes 45 % remaining 12 s", go_on)).start()
        self.run_step("import os, time; print('eigenmodes            45 %  remaining 12 s', flush=True)\n"
                      f"while not os.path.exists({go_on!r}): time.sleep(0.01)")
        lines = self.out.getvalue().splitlines()
        self.assertIn("1/3 reduce: eigenmodes 45 % remaining 12 s", lines)
        self.assertRegex(lines[-1], r"1/3 reduce +[0-9.]+ s CPU +[0-9.]+ s wall +[0-9]+ MB")
        self.assertLessEqual(max(map(len, lines)), 80)

    def when_shown(self, words, path):
        while words not in self.out.getvalue():
            time.sleep(0.01)
        with open(path, "w", encoding="utf-8"):
            pass

    def test_a_step_that_fails_shows_what_it_printed(self):
        with self.assertRaises(SystemExit) as failure:
            self.run_step("import sys; print('error: no such mesh'); sys.exit(3)")
        self.assertIn("error: no such mesh", str(failure.exception.code))


class Scripts(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        write_result(self.path("result.h5"))
        write_stress(self.path("stress.h5"))
        write_body(self.path("worm.h5"))

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def run_script(self, name, *arguments):
        return subprocess.run([sys.executable, os.path.join(SCRIPTS, name), *arguments], capture_output=True,
                              encoding="utf-8", cwd=self.folder.name, env={**os.environ, "PYTHONIOENCODING": "utf-8"})

    def assert_fails(self, run, *words):
        self.assertNotEqual(run.returncode, 0)
        for word in words:
            self.assertIn(word, run.stderr)

    def test_summary_holds_the_known_values(self):
        run = self.run_script("summary.py", "result.h5", "stress.h5", "--body-file", "worm=worm.h5")
        self.assertEqual(run.returncode, 0, run.stderr)
        for words in ("worm: 12 nodes, 2 elements, 6 contact faces", "0.08 kg, 2 modes, 10 to 20 kHz",
                      "peak force 500 N at 100 µs, at most 4 nodes",
                      "speed 20 rad/s at the start, -19 rad/s at the end", "von Mises 173.2 MPa at node 17",
                      "(0.5 % of the initial energy)"):
            self.assertIn(words, run.stdout)

    def test_speeds_of_a_cylindrical_joint_have_both_units(self):
        with h5py.File(self.path("result.h5"), "r+") as file:
            del file["bodies/wheel/rigid_velocity"]
            file["bodies/wheel/rigid_velocity"] = np.array([[20, 0.5]] * 5)
            file["bodies/wheel"].attrs["joint"] = "cylindrical"
        run = self.run_script("summary.py", "result.h5", "stress.h5", "--body-file", "worm=worm.h5")
        self.assertIn("wheel: speed 20 rad/s at the start, 20 rad/s at the end", run.stdout)
        self.assertIn("wheel: speed 0.5 m/s at the start, 0.5 m/s at the end", run.stdout)

    def summary_with_error(self, share):
        """Of a stress file with an estimated error, a share of the peak."""
        with h5py.File(self.path("stress.h5"), "r+") as file:
            group = file["worm/root"]
            group["error"] = share * group["von_mises"][:]
            group["peak_error"] = group["error"][:].max(axis=1)
            group["mesh_error"] = 0.2 * group["von_mises"][:]
        return self.run_script("summary.py", "result.h5", "stress.h5", "--body-file", "worm=worm.h5").stdout

    def test_a_stress_has_its_estimated_error_beside_it(self):
        text = self.summary_with_error(0.01)
        self.assertIn("estimated error of the reduction 1.73 MPa (1 %)", text)
        self.assertIn("estimated error of the mesh 34.6 MPa (20 %): too coarse a mesh for this stress", text)
        self.assertNotIn("not to be trusted", text)

    def test_a_stress_with_a_large_estimated_error_is_not_to_be_trusted(self):
        self.assertIn("estimated error of the reduction 10.4 MPa (6 %): not to be trusted", self.summary_with_error(0.06))

    def test_a_stress_without_an_estimate_is_not_to_be_trusted(self):
        run = self.run_script("summary.py", "result.h5", "stress.h5", "--body-file", "worm=worm.h5")
        self.assertIn("error not estimated: not to be trusted", run.stdout)

    def turned(self, path, turns):
        """Lets the wheel ask for two turns and make others, at five equal times."""
        with h5py.File(path, "r+") as file:
            speed = 2 * 2 * np.pi / (TIME[-1] - TIME[0])
            file["bodies/wheel/rigid_velocity"][...] = np.full((5, 1), speed)
            file["bodies/wheel/rigid"] = 2 * np.pi * np.reshape(turns, (5, 1))

    def test_a_drive_that_turns_back_does_not_roll(self):
        self.turned(self.path("result.h5"), [0, 0.15, 0.2, 0.1, 0.05])
        run = self.run_script("summary.py", "result.h5", "stress.h5", "--body-file", "worm=worm.h5")
        self.assertIn("the wheel does not roll: it made 0.05 of the 2.00 turns that its initial speed asks for, at most 0.20", run.stdout)

    def test_a_drive_that_rolls_is_left_alone(self):
        self.turned(self.path("result.h5"), [0, 0.5, 1, 1.5, 1.98])
        run = self.run_script("summary.py", "result.h5", "stress.h5", "--body-file", "worm=worm.h5")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertNotIn("does not roll", run.stdout)

    def test_every_plot_is_drawn(self):
        run = self.run_script("plots.py", "result.h5", "stress.h5", "--body-file", "worm=worm.h5", "--out", "plots")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(sorted(os.listdir(self.path("plots"))),
                         ["contact_force_worm_wheel.png", "energy.png", "speed_wheel.png", "stress_worm.png"])

    def test_a_missing_file_is_named(self):
        self.assert_fails(self.run_script("plots.py", "nothing.h5", "stress.h5"), "nothing.h5")

    def test_a_file_of_another_kind_is_refused(self):
        self.assert_fails(self.run_script("plots.py", "stress.h5", "stress.h5"), "stress.h5", "elastogear result")

    def test_a_node_without_stress_is_refused(self):
        self.assert_fails(self.run_script("plots.py", "result.h5", "stress.h5", "--node", "worm=5"), "worm", "5")


if __name__ == "__main__":
    unittest.main()
