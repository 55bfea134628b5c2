"""Runs the program for one case: its folder, what was run in it, and what must hold."""

import json
import os
import subprocess

import h5py
import numpy as np
import yaml

ENVIRONMENT = {
    "MALLOC_PERTURB_": "165", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_pml": "ob1",
    "OPENBLAS_NUM_THREADS": "1"
}
ALONE = {"OMPI_MCA_ess_singleton_isolated": "1"}  # a program that mpirun does not start waits for no daemon
LIMIT = 900  # s, ends a run that hangs


class Broken(Exception):
    """What must hold does not."""


class Unfit(Exception):
    """The random case is none: a design that cannot be, which the program says."""


class Lab:
    """A folder for one case. The program refuses designs that cannot run; the first verb of a case may do so."""

    def __init__(self, program, folder, random):
        self.program, self.folder, self.random = program, folder, random
        self.log = []
        os.makedirs(folder, exist_ok=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, keys):
        """Writes an input file of these keys."""
        text = yaml.safe_dump(keys, default_flow_style=None, sort_keys=False, width=110)
        with open(self.path(name), "w") as file:
            file.write(text)
        self.log.append(f"# {name}\n{text.rstrip()}")

    def call(self, *arguments, ranks=1):
        """Runs a verb; returns the finished process, whatever its exit code."""
        command = [self.program, *[str(argument) for argument in arguments]]
        environment = {**os.environ, **ENVIRONMENT}
        if ranks > 1:
            command = ["mpirun", "-n", str(ranks), "--oversubscribe", *command]
        else:
            environment.update(ALONE, OMPI_MCA_orte_tmpdir_base=self.path("mpi"))
        self.log.append("$ " + " ".join(command))
        try:
            done = subprocess.run(command, capture_output=True, text=True, cwd=self.folder, env=environment,
                                  timeout=LIMIT, check=False)
        except subprocess.TimeoutExpired:
            raise Broken(f"'{' '.join(command[-12:])}' takes more than {LIMIT} s") from None
        self.log.append(f"  exit code {done.returncode}")
        return done

    def run(self, *arguments, ranks=1):
        """Runs a verb that must succeed."""
        done = self.call(*arguments, ranks=ranks)
        if done.returncode != 0:
            raise Broken(f"{arguments[0]} ends with exit code {done.returncode}: {done.stderr.strip()[-600:]}")
        return done.stdout

    def read(self, name, *paths):
        with h5py.File(self.path(name)) as file:
            values = [file[path][()] for path in paths]
        return values[0] if len(paths) == 1 else values

    def summary(self, name="drive_evaluation.json"):
        """Single numbers of the first case and pair of evaluate, by their paths."""
        with open(self.path(name)) as file:
            pair = next(iter(json.load(file)["cases"][0]["pairs"].values()))
        found = {}

        def collect(node, path):
            if "value" in node and not isinstance(node["value"], dict):
                found[path] = node["value"]
                return
            for key, below in node.items():
                if isinstance(below, dict):
                    collect(below, f"{path}/{key}" if path else key)

        collect(pair, "")
        return found


def near(what, value, expected, allowed):
    """Holds all numbers within `allowed`, an absolute deviation."""
    value, expected = np.asarray(value, dtype=float), np.asarray(expected, dtype=float)
    if value.shape != expected.shape:
        raise Broken(f"{what}: the shapes {value.shape} and {expected.shape} differ")
    off = np.abs(value - expected).max() if value.size else 0.0
    if not off <= allowed:
        at = np.unravel_index(np.abs(value - expected).argmax(), value.shape) if value.shape else ()
        raise Broken(f"{what}: {value[at]:.9g} for {expected[at]:.9g}, off by {off:.3g}, allowed {allowed:.3g}")


def alike(what, value, expected, share):
    """Holds all numbers within a share of the largest one."""
    near(what, value, expected, share * np.abs(np.asarray(expected, dtype=float)).max())


def at_most(what, value, limit):
    if not value <= limit:
        raise Broken(f"{what}: {value:.6g}, at most {limit:.6g}")


def between(random, low, high, digits=3):
    """A random number whose logarithm is even, rounded so that the input can be read."""
    return float(f"{np.exp(random.uniform(np.log(low), np.log(high))):.{digits - 1}e}")


def choice(random, *of):
    return of[int(random.integers(len(of)))]
