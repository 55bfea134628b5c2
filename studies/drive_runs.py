"""Runs of a drive file for studies: bodies are reduced once, then the drive stands at roll angles."""
import os
import subprocess
import sys

import numpy as np

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
import results


class Refused(Exception):
    """A run of the program that ended with an error; its text."""


def involute(angle):
    return np.tan(angle) - angle


class Position:
    """What a result holds at full load. SI units; moments about the axes of the gears.

    start, angle: of the first gear, where exact rigid flanks touch, and at full load; turned: R, of the held one;
    torque: of contact on the held one; energy: all that is stored; points: the contacts; force: the size of each one's."""

    def __init__(self, path, torque):
        with results.open_file(path, "result") as file:
            if not file.attrs["complete"]:
                raise Refused(f"{path}: the run did not reach its end")
            (self.pair_name, pair), = file["contact"].items()
            self.first, self.second = self.pair_name.split(":")
            first, second = (file[f"bodies/{body}"] for body in (self.first, self.second))
            self.load = torque
            self.start = float(file["provenance"].attrs[f"option_{self.first}_angle0"])
            self.angle = first["rigid"][-1, 0]
            self.turned = second["rotation"][-1]
            self.axis = self.turned @ np.array([0.0, 0, 1])
            moment = pair["torque"][-1] - np.cross(second["position"][-1], pair["force"][-1])
            self.torque = moment @ self.axis
            self.stored = {name: file[f"energy/{name}"][-1] for name in ("elastic", "contact")}
            self.energy = sum(self.stored.values())
            self.work = file["energy/work"][-1]
            points = pair["points"]
            rows = slice(points["offset"][-2], points["offset"][-1])
            self.points = {name: points[name][rows] for name in points if name != "offset"}
            self.pressure = pair["pressure"][-1]
            self.force = np.linalg.norm(self.points["force"], axis=1)

    def turned_since(self, other):
        """Angle of the held gear about its axis since another position, rad."""
        R = self.turned @ other.turned.T
        sine = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / 2
        return np.arctan2(sine @ self.axis, (np.trace(R) - 1) / 2)


class Drive:
    def __init__(self, program, path, folder, more=()):
        """more: options of both verbs, beside the file's."""
        self.program, self.path, self.folder = os.path.abspath(program), os.path.abspath(path), os.path.abspath(folder)
        self.more = list(more)
        os.makedirs(self.folder, exist_ok=True)
        self.output = os.path.join(self.folder, "position.out")

    def run(self, verb, *options):
        """What the program writes; throws Refused with its error."""
        command = [self.program, verb, self.path, *self.more, *map(str, options)]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            lines = [line for line in done.stderr.splitlines() if "error" in line.lower()] or done.stderr.splitlines()[-1:]
            raise Refused(" ".join(lines) or f"exit code {done.returncode}")
        return done.stdout

    def reduce(self, *options):
        """Once: a folder that has bodies keeps them."""
        if not any(name.endswith(".h5") for name in os.listdir(self.folder)):
            self.run("reduce", *options)

    def at(self, roll, *options, points="minima"):
        """The drive at rest at a roll angle, in pitches of the first gear; points: of contact."""
        self.run("simulate", "-roll", repr(float(roll)), "-output", self.output, "-contact_points", points, *options)
        with results.open_file(self.output, "result") as file:
            torque = [float(f["joint_force"][-1, 0]) for f in file["bodies"].values() if f["joint_force"].shape[1]]
        return Position(self.output, torque[0])
