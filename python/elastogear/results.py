"""Result and stress files as arrays of numpy. The first index of a history is the time."""

from __future__ import annotations

import difflib
import json
import os
from typing import TYPE_CHECKING, Any, Iterator, KeysView, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _elastogear as _library

if TYPE_CHECKING:
    from .runs import Report

Path = Union[str, "os.PathLike[str]"]
Array = NDArray[Any]


def _stamp(path: str) -> tuple[int, ...]:
    """What tells a file from another one of its name; empty where there is none."""
    try:
        state = os.stat(path)
    except OSError:
        return ()
    return state.st_dev, state.st_ino, state.st_size, state.st_mtime_ns


def _sum(parts: list[Optional[Array]]) -> Optional[Array]:
    """Sum of the parts that there are; None where there is none."""
    known = [part for part in parts if part is not None]
    return np.sum(known, axis=0) if known else None


class _Histories:
    """Arrays of a file, read when they are asked for first."""

    def __init__(self, values: dict[str, Any]) -> None:
        self.__dict__.update(values)

    def __repr__(self) -> str:
        arrays = ", ".join(f"{name} {np.shape(value)}" for name, value in self.__dict__.items() if isinstance(value, np.ndarray))
        return f"<elastogear.{type(self).__name__}: {arrays}>"


class BodyHistory(_Histories):
    """Motion of one body over n_t times.

    position    (n_t, 3), m, origin of the body frame in the world
    rotation    (n_t, 3, 3), from the body frame to the world
    s, s_dot, s_ddot    (n_t, n_s), joint coordinates, rad or m, and their rates
    q, q_dot, q_ddot    (n_t, n_q), elastic coordinates and their rates
    q_error     (n_t, n_q), estimated error of q by the steps in time, or None
    """

    position: Array
    rotation: Array
    s: Array
    s_dot: Array
    s_ddot: Array
    q: Array
    q_dot: Array
    q_ddot: Array
    q_error: Optional[Array]


class PairHistory(_Histories):
    """Contact of one pair a:b over n_t times.

    force, torque     (n_t, 3), N, N m, on body b, in the world, about its origin
    count             (n_t,), active contacts
    penetration       (n_t,), m, largest
    area, pressure    (n_t,), m^2, Pa (largest)
    sliding_speed     (n_t,), m/s, largest
    friction_power, damping_power    (n_t,), W, taken
    group_force       (n_t, 3) each, N, on body b, by the name of a face set of a or b
    """

    force: Array
    torque: Array
    count: Array
    penetration: Array
    area: Array
    pressure: Array
    sliding_speed: Array
    friction_power: Array
    damping_power: Array
    group_force: dict[str, Array]


class SensorHistory(_Histories):
    """Motion of a marker in the world over n_t times.

    position, velocity, acceleration    (n_t, 3), m, m/s, m/s^2
    rotation                            (n_t, 3, 3), from the marker to the world
    angular_velocity                    (n_t, 3), rad/s
    """

    position: Array
    velocity: Array
    acceleration: Array
    rotation: Array
    angular_velocity: Array


class Result:
    """A result file, which is read as far as it is asked for.

    When another run has written the file anew, asking for more is an error.

    time         (n_t,), s; of an equilibrium the load factor, of a sweep the roll angle in pitches
    time_axis    name and unit of the time: ("time", "s"), ("load factor", "1"), ("roll angle", "pitches")
    bodies, pairs, bushings, sensors    their names
    complete     did the run reach its end?
    provenance   options in force, versions
    path         of the file
    report       what the run said, or None
    inputs       of a sweep of several cases: its row of cases.csv, by heading
    """

    def __init__(self, path: Path, report: Optional["Report"] = None,
                 inputs: Optional[dict[str, str]] = None) -> None:
        self.path = os.path.abspath(os.fspath(path))
        self.report = report
        self.inputs = inputs or {}
        self._stamp = _stamp(self.path)
        header = _library.read_result_header(self.path)
        self.time: Array = header["time"]
        self.time_axis: tuple[str, str] = header["time_axis"]
        self.bodies: list[str] = [body[0] for body in header["bodies"]]
        self.pairs: list[str] = header["pairs"]
        self.bushings: list[str] = header["bushings"]
        self.sensors: list[str] = header["sensors"]
        self.complete: bool = header["complete"]
        self.provenance: dict[str, str] = header["provenance"]

    def _file(self) -> str:
        if os.path.exists(self.path) and _stamp(self.path) != self._stamp:
            raise _library.Error(f"{self.path}: has been written anew since this result was made; give each run "
                                 "an output of its own, output='first.h5', or read it by Result()")
        return self.path

    def body(self, name: str) -> BodyHistory:
        """Motion of a body."""
        return BodyHistory(_library.read_body_history(self._file(), name))

    def pair(self, name: str) -> PairHistory:
        """Contact of a pair, 'a:b'."""
        return PairHistory(_library.read_pair_history(self._file(), name))

    def sensor(self, name: str) -> SensorHistory:
        """Motion of a sensor."""
        return SensorHistory(_library.read_sensor_history(self._file(), name))

    def contacts(self, pair: str) -> list[Array]:
        """Active contacts of a pair at each time: slave_side, slave_node, face, xi, eta, gap (m), force (N), ..."""
        return _library.read_contacts(self._file(), pair)

    @property
    def energies(self) -> dict[str, Array]:
        """(n_t,) each, J: kinetic, elastic, contact, bushing, dissipated, work and balance."""
        return _library.read_energies(self._file())

    def plot(self, pair: Optional[str] = None, axes: Any = None) -> Any:
        """Draws the contact force of a pair (default: the first one) over the time; returns the axes."""
        from . import plots
        return plots.contact_force(self, pair, axes)

    def __repr__(self) -> str:
        return f"<elastogear.Result {self.path}: {len(self.time)} times>"


class StressSet:
    """Stresses at the n nodes of a set over n_t times, body frame.

    body, set     names
    node          (n,), numbers in the mesh
    X             (n, 3), m, undeformed; empty in older files
    stress        (n_t, n, 6), Pa, xx yy zz xy yz xz
    von_mises     (n_t, n), Pa
    rankine       (n_t, n), Pa, largest principal stress
    error         (n_t, n), Pa, estimated error of von_mises against the unreduced body, or None
    peak_error    (n_t,), Pa, of the largest von Mises stress of the set, or None
    mesh_error    (n_t, n), Pa, estimated error of von_mises by the mesh, or None
    contact_error    (n_t, n), Pa, estimated error of von_mises by the contact's resolution, or None
    time_error    (n_t, n), Pa, estimated error of von_mises by the steps in time, or None

    total_error         (n_t, n), Pa, sum of the estimated errors of von_mises by all causes, or None
    total_peak_error    (n_t,), Pa, the same of the largest von Mises stress of the set, or None
    """

    body: str
    set: str
    node: Array
    X: Array
    stress: Array
    von_mises: Array
    rankine: Array
    error: Optional[Array]
    peak_error: Optional[Array]
    mesh_error: Optional[Array]
    contact_error: Optional[Array]
    time_error: Optional[Array]

    def __init__(self, values: dict[str, Any]) -> None:
        self.__dict__.update(values)

    @property
    def total_error(self) -> Optional[Array]:
        """Sum of the estimated errors of von_mises by all causes, (n_t, n), Pa; None where none is estimated."""
        return _sum([self.error, self.mesh_error, self.contact_error, self.time_error])

    @property
    def total_peak_error(self) -> Optional[Array]:
        """Sum of the estimated errors of the largest von Mises stress by all causes, (n_t,), Pa; None where none is
        estimated."""
        steps, peaks = np.arange(len(self.von_mises)), self.von_mises.argmax(axis=1)
        at_peaks = [None if each is None else each[steps, peaks]
                    for each in (self.mesh_error, self.contact_error, self.time_error)]
        return _sum([self.peak_error, *at_peaks])

    def __repr__(self) -> str:
        return f"<elastogear.StressSet {self.body} {self.set}: {len(self.node)} nodes>"


class Stress:
    """A stress file.

    time         (n_t,), as of the result
    time_axis    name and unit of the time, as of the result
    sets         list of StressSet; one of them by stress["pinion", "root"]
    provenance   options in force, versions
    path         of the file
    report       what the run said, or None
    """

    def __init__(self, path: Path, report: Optional["Report"] = None) -> None:
        self.path = os.path.abspath(os.fspath(path))
        self.report = report
        values = _library.read_stress(self.path)
        self.time: Array = values["time"]
        self.time_axis: tuple[str, str] = values["time_axis"]
        self.sets = [StressSet(each) for each in values["sets"]]
        self.provenance: dict[str, str] = values["provenance"]

    def __getitem__(self, key: tuple[str, str]) -> StressSet:
        for each in self.sets:
            if (each.body, each.set) == key:
                return each
        known = ", ".join(f"{each.body} {each.set}" for each in self.sets)
        raise KeyError(f"there are no stresses of {key}; there are: {known}")

    def plot(self, axes: Any = None) -> Any:
        """Draws the largest von Mises stress of each set over the time; returns the axes."""
        from . import plots
        return plots.peak_stress(self, axes)

    def __repr__(self) -> str:
        return f"<elastogear.Stress {self.path}: {len(self.sets)} sets, {len(self.time)} times>"


_CAUSES = ("_mesh_error", "_contact_error", "_error", "_time_error")  # ends of the names of estimated errors


class Evaluation:
    """Results of a drive (docs/evaluation.md).

        evaluation["transmission_error/peak_to_peak"]      a number, an array or a list of words
        evaluation.unit("transmission_error/peak_to_peak")
        evaluation.error("transmission_error/peak_to_peak")

    A path is that of the file, "CASE/PAIR/transmission_error/mean", or its end where that is of one figure alone.
    An evaluation is a mapping of paths: `for path in evaluation`, `path in evaluation`, `len(evaluation)`.

    provenance, path, report    as of Result
    """

    def __init__(self, path: Path, report: Optional["Report"] = None) -> None:
        self.path = os.path.abspath(os.fspath(path))
        self.report = report
        values = _library.read_evaluation(self.path)
        self._items: dict[str, tuple[Any, str, str]] = values["items"]
        self.provenance: dict[str, str] = values["provenance"]

    @property
    def paths(self) -> list[str]:
        """All figures."""
        return list(self._items)

    def _find(self, path: str) -> tuple[Any, str, str]:
        if path in self._items:
            return self._items[path]
        found = [each for each in self._items if each.endswith("/" + path)]
        if len(found) == 1:
            return self._items[found[0]]
        if found:
            raise KeyError(f"{path}: may be " + " or ".join(found))
        below = [each for each in self._items if f"/{path.rstrip('/')}/" in f"/{each}"]
        if below:
            raise KeyError(f"{path}: is no figure; below it are {', '.join(below)}")
        ends = {each.split("/", depth)[-1]: each for depth in range(3) for each in self._items}
        near = list(dict.fromkeys(ends[end] for end in difflib.get_close_matches(path, ends, n=3)))
        raise KeyError(f"{path}: is none of the figures in paths" + (f"; near it are {', '.join(near)}" if near else ""))

    def find(self, word: str) -> list[str]:
        """Paths that have a word in them, `evaluation.find("tension")`."""
        return [path for path in self._items if word in path]

    def keys(self) -> KeysView[str]:
        """All figures."""
        return self._items.keys()

    def __iter__(self) -> Iterator[str]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)

    def __contains__(self, path: object) -> bool:
        try:
            self._find(str(path))
        except KeyError:
            return False
        return True

    def __getitem__(self, path: str) -> Any:
        return self._find(path)[0]

    def unit(self, path: str) -> str:
        """Unit of a figure; "1" for none."""
        return self._find(path)[1]

    def meaning(self, path: str) -> str:
        """One line on a figure."""
        return self._find(path)[2]

    def error(self, path: str) -> Union[float, Array, None]:
        """Sum of the estimated errors of a figure by all causes, in its unit and of its shape; None where none is
        estimated."""
        whole = next(each for each, item in self._items.items() if item is self._find(path))
        parts = [self._items[whole + cause][0] for cause in _CAUSES if whole + cause in self._items]
        if not parts:
            return None
        total = sum(np.asarray(part) for part in parts)
        return total if np.ndim(total) else float(total)

    def __repr__(self) -> str:
        return f"<elastogear.Evaluation {self.path}: {len(self._items)} figures>"


class Life:
    """Fatigue damage and life of a drive's gears (docs/life.md).

    summary         the contents of the JSON file: for each set the most damaged node, its damage and life, and both with the
                    estimated error of the stress (damage_with_error, life_with_error; None: not estimated)
    path, report    as of Result
    """

    def __init__(self, path: Path, report: Optional["Report"] = None) -> None:
        self.path = os.path.abspath(os.fspath(path))
        self.report = report
        with open(os.path.splitext(self.path)[0] + ".json", encoding="utf-8") as file:
            self.summary: dict[str, Any] = json.load(file)

    def __repr__(self) -> str:
        return f"<elastogear.Life {self.path}>"
