#!/usr/bin/python3
"""Shares of the tasks of scripts/sweep.slurm, with an srun that writes down its words."""
import os
import subprocess
import tempfile
import unittest

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts", "sweep.slurm")
NAMED = "variant,wheel_skew\na,0.01 deg\nb,0.02 deg\nc,0.03 deg\nd,0.04 deg\ne,0.05 deg\n"
NAMELESS = "wheel_skew\n0.01 deg\n0.02 deg\n0.03 deg\n"


class Tasks(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        with open(os.path.join(self.folder, "srun"), "w", encoding="utf-8") as file:
            file.write("#!/bin/sh\necho \"$SLURM_MPI_TYPE $*\"\n")
        os.chmod(os.path.join(self.folder, "srun"), 0o755)

    def task(self, table, number, count, first=1, *options):
        """The words of srun, and the table of the task's share, None where it has none."""
        with open(os.path.join(self.folder, "variants.csv"), "w", encoding="utf-8") as file:
            file.write(table)
        environment = {"PATH": self.folder + ":" + os.environ["PATH"], "SLURM_ARRAY_TASK_ID": str(number),
                       "SLURM_ARRAY_TASK_MIN": str(first), "SLURM_ARRAY_TASK_COUNT": str(count)}
        done = subprocess.run(["bash", SCRIPT, "drive.yaml", "variants.csv", *options], cwd=self.folder, env=environment,
                              capture_output=True, text=True, check=True)
        share = os.path.join(self.folder, f"sweep_{number}.csv")
        if not os.path.exists(share):
            return done.stdout, None
        with open(share, encoding="utf-8") as file:
            return done.stdout, file.read()

    def test_shares_make_up_the_table(self):
        shares = [self.task(NAMED, task, 2)[1].splitlines() for task in (1, 2)]
        self.assertEqual([share[0] for share in shares], ["variant,wheel_skew"] * 2)
        self.assertEqual(sorted(shares[0][1:] + shares[1][1:]), NAMED.splitlines()[1:])
        self.assertEqual([line[0] for line in shares[0][1:]], ["a", "c", "e"])

    def test_nameless_variants_are_called_by_their_lines(self):
        self.assertEqual(self.task(NAMELESS, 6, 2, 5)[1], "variant,wheel_skew\n2,0.02 deg\n")

    def test_a_task_without_a_share_does_nothing(self):
        self.assertEqual(self.task(NAMELESS, 4, 4), ("", None))

    def test_each_task_sweeps_into_its_own_folder(self):
        words, _ = self.task(NAMED, 2, 2, 1, "-sweep_positions", "16")
        self.assertEqual(words, "pmix elastogear simulate drive.yaml -analysis sweep -variants sweep_2.csv -output sweep_2.h5 -sweep_positions 16\n")


if __name__ == "__main__":
    unittest.main()
