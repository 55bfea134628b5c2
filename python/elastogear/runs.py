"""Runs of the program's verbs, and simulations that are advanced step by step."""

from __future__ import annotations

import copy
import csv
import json
import os
import warnings
from typing import Any, Callable, Dict, Iterator, Mapping, Optional, Union

from . import _elastogear as _library
from .results import Evaluation, Life, Result, Stress

Source = Union[str, "os.PathLike[str]", Mapping[str, Any]]
Progress = Callable[[str, float], object]
Force = Callable[..., Any]


class Warning(UserWarning):
    """An input that can be computed with but is hardly meant, or a result that is not to be trusted."""


class Quantity(float):
    """A number in SI units that knows its unit.

    unit      "m", "rad"; "1" for none
    """

    unit: str

    def __new__(cls, value: float, unit: str = "1") -> "Quantity":
        quantity = super().__new__(cls, value)
        quantity.unit = unit
        return quantity

    def __reduce__(self) -> tuple[type["Quantity"], tuple[float, str]]:  # copies and pickles keep the unit
        return Quantity, (float(self), self.unit)

    def __str__(self) -> str:
        return f"{float(self):.6g}" + ("" if self.unit == "1" else f" {self.unit}")

    __repr__ = __str__


class Count(int):
    """A whole number of the design, as that of teeth, without a unit."""

    @property
    def unit(self) -> str:
        """Unit of a number without one."""
        return "1"


class Facts(Dict[str, Union[Quantity, Count, str]]):
    """Numbers of a part by their names, with blanks or underscores: `facts["tip diameter"]`, `facts["tip_diameter"]`."""

    def __missing__(self, name: str) -> Union[Quantity, Count, str]:
        plain = name.replace("_", " ")
        if plain in self:
            return self[plain]
        raise KeyError(f"{name}: there is no such fact; there are: {', '.join(self)}")


def _fact(name: str, value: Union[float, str], unit: str) -> Union[Quantity, Count, str]:
    if isinstance(value, str):
        return value
    return Count(value) if name == "teeth" else Quantity(value, unit)


class Report:
    """Everything that a verb has said.

    items     list of (name, text), as the program prints them
    files     files and folders that were written, absolute paths
    """

    def __init__(self, items: list[tuple[str, str]]) -> None:
        self.items = items
        self.files = [os.path.abspath(text) for name, text in items if name == "written" and os.path.exists(text)]

    def __getitem__(self, name: str) -> str:
        """The first text of this name."""
        for item, text in self.items:
            if item == name:
                return text
        raise KeyError(name)

    def __str__(self) -> str:
        return "\n".join(f"  {name:30} {text}" for name, text in self.items)

    def __repr__(self) -> str:
        return f"<elastogear.Report of {len(self.items)} items>"


def _plain(value: Any) -> Any:
    """Arrays, paths and results as what YAML knows; keys without a value are left out."""
    if isinstance(value, Mapping):
        return {key: _plain(part) for key, part in value.items() if part is not None}
    if isinstance(value, (list, tuple)):
        return [_plain(part) for part in value]
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if hasattr(value, "tolist"):  # of numpy
        return value.tolist()
    if isinstance(value, (_library.Body, Evaluation, Life, Result, Stress)):
        return value.path
    return value


def _with_variants(options: Mapping[str, Any]) -> Mapping[str, Any]:
    """Variants that are a dict of their keys as the list of their names, with a section of keys for each."""
    variants = options.get("variants")
    if not isinstance(variants, Mapping):
        return options
    return {**options, "variants": list(variants),
            **{f"variant_{name}": dict(keys or {}) for name, keys in variants.items()}}


def _flat(options: Mapping[str, Any], section: str = "") -> dict[str, Any]:
    """Keys of sections joined with them, {"contact": {"friction": 0.1}} as {"contact_friction": 0.1}."""
    flat: dict[str, Any] = {}
    options = options if section else _with_variants(options)
    for key, value in options.items():
        if isinstance(value, Mapping):
            flat.update(_flat(value, f"{section}{key}_"))
        else:
            flat[f"{section}{key}"] = value
    return flat


def _is_of(key: str, section: str) -> bool:
    return key == section or key.startswith(section + "_")


def _yaml(options: Mapping[str, Any]) -> str:
    """JSON, which YAML reads, one key a line."""
    if not options:
        return ""
    try:
        return json.dumps(_plain(options), ensure_ascii=False, indent=0)
    except (TypeError, ValueError) as error:
        raise _library.Error(f"options must be numbers, texts, lists and dicts of these: {error}") from None


def _warn(items: list[tuple[str, str]], depth: int) -> None:
    for name, text in items:
        if name == "warning":
            warnings.warn(text, Warning, stacklevel=depth + 1)


class System:
    """An input of the program: a YAML file, or a dict with the same keys.

    source    path, or dict; its keys may be nested, {"contact": {"friction": 0.1}}
    name      stem of the files that are written, where the options do not name them (default: that of the
              file, or "drive")
    options   further keys, which win

    Every option that `elastogear VERB -help` lists can be given to the methods, too, and wins.
    """

    def __init__(self, source: Source, *, name: Optional[str] = None, **options: Any) -> None:
        self._files: list[str] = []
        self._text = ""
        self._name = name or "drive"
        self._options = _flat(options)
        self._last = ""  # result of the last simulate or sweep
        if isinstance(source, Mapping):
            self._text = _yaml(_with_variants(source))
        elif name is not None:
            raise _library.Error("a name is for a dict; that of a file is its own")
        else:
            self._files = [os.fspath(source)]

    def _given(self, options: Mapping[str, Any]) -> _library.Given:
        return _library.Given(self._files, self._text, self._name, _yaml({**self._options, **_flat(options)}))

    def _run(self, verb: str, options: Mapping[str, Any], progress: Optional[Progress] = None) -> Report:
        report = Report(_library.run_verb(verb, self._given(options), progress))
        _warn(report.items, 3)
        return report

    def mesh(self, **options: Any) -> Report:
        """Writes the meshes of a drive, or of a worm or its wheel, as `elastogear mesh` does."""
        return self._run("mesh", options)

    def reduce(self, *, progress: Optional[Progress] = None, **options: Any) -> Report:
        """Reduces a mesh, or all gears of a drive, to body files, as `elastogear reduce` does.

        Under mpirun, with mpi4py or without, all ranks must call it and work together; the report of the first
        rank is the one that holds.
        progress(stage, fraction) is called now and then.
        """
        return self._run("reduce", options, progress)

    def simulate(self, *, forces: Optional[Mapping[str, Force]] = None,
                 on_step: Optional[Callable[["Simulation"], object]] = None,
                 progress: Optional[Progress] = None, **options: Any) -> Result:
        """Computes an equilibrium or a motion and writes its result, as `elastogear simulate` does.

        forces     see `simulation`; of motions alone
        on_step    called with the simulation after each step; of motions alone
        """
        if forces is None and on_step is None:
            report = self._run("simulate", options, progress)
            self._last = path = next(file for file in report.files if not file.endswith(".csv"))
            if os.path.isdir(path):
                raise _library.Error(f"{path}: holds several cases; Drive.sweep returns them all")
            return Result(path, report)
        output = options.pop("output", None) or self._name_of_result()
        with self.simulation(output=output, forces=forces, **options) as simulation:
            while simulation.step():
                if on_step is not None:
                    on_step(simulation)
                if progress is not None:
                    progress("simulate", simulation.state.time)
        self._last = os.path.abspath(output)
        return Result(self._last, None)

    def _name_of_result(self) -> str:
        stem = os.path.splitext(os.path.basename(self._files[0]))[0] if self._files else self._name
        return stem + "_result.h5"

    def recover(self, *, progress: Optional[Progress] = None, **options: Any) -> Stress:
        """Recovers the stresses of the last result, as `elastogear recover` does."""
        report = self._run("recover", options, progress)
        return Stress(report.files[0], report)

    def simulation(self, *, output: Union[str, "os.PathLike[str]", None] = None,
                   forces: Optional[Mapping[str, Force]] = None, **options: Any) -> "Simulation":
        """A motion that is advanced step by step, by ts_dt (s) or steps that it chooses; needs ts_max_time
        (s). Of drives the analysis is dynamic where none is given.

        output    result file to write; None: none is written
        forces    functions by what they act on:
                  "worm" (or "worm.rotation", "worm.translation" of a body with both): f(t, s, s_dot) -> N m
                  about, or N along, the axis of the body's joint, of time (s), coordinate (rad or m) and rate;
                  the name of a load (option loads): f(t, marker) -> (force, torque), three components each, N
                  and N m, where marker has position (m), rotation, velocity (m/s), angular_velocity (rad/s).
                  They are called any number of times in a step, in any order, and must depend on nothing but
                  their arguments and what changes between steps.
        """
        return Simulation(self._given(options), forces or {}, os.fspath(output) if output is not None else "")


class Drive(System):
    """A gear drive: a drive file (docs/drives.md), or a dict with the same keys.

    facts     numbers of the design, {"pinion": {"tip diameter": 0.0647, ...}, "pinion:wheel": {...}}: each a
              Quantity, those of teeth a Count; flank forms are texts

    str(drive) is a table of the facts.
    """

    facts: dict[str, Facts]

    def __init__(self, source: Source, *, name: Optional[str] = None, **options: Any) -> None:
        super().__init__(source, name=name, **options)
        self._derive()

    def _derive(self) -> None:
        self.facts = {
            part: Facts({name: _fact(name, value, unit) for name, value, unit in facts})
            for part, facts in _library.drive_facts(self._given({})).items()}

    def replace(self, *, name: Optional[str] = None, **options: Any) -> "Drive":
        """A drive of the same source with other options, which win: `drive.replace(wheel={"profile_shift": 0.2})`.
        One that is None, or a section that is, is again that of the source.

        name    stem of its files in place of that of a dict
        """
        other = copy.copy(self)
        new = _flat(options)
        gone = [key for key, value in new.items() if value is None]
        other._options = {key: value for key, value in {**self._options, **new}.items()
                          if not any(_is_of(key, of) and self._gear_of(key) == self._gear_of(of) for of in gone)}
        if name is not None:
            if self._files:
                raise _library.Error("a name is for a dict; that of a file is its own")
            other._name = name
        other._derive()
        return other

    def _gear_of(self, key: str) -> str:
        """The gear that an option is of: of wheel and wheel_2 the latter has wheel_2_teeth."""
        return max((gear for gear in self.facts if _is_of(key, gear)), key=len, default="")

    def differences(self, other: "Drive") -> dict[str, dict[str, tuple[Any, Any]]]:
        """Facts that are others than those of another drive, by part and name: both values; None: it has none."""
        found: dict[str, dict[str, tuple[Any, Any]]] = {}
        for part in {**self.facts, **other.facts}:
            mine, its = self.facts.get(part, Facts()), other.facts.get(part, Facts())
            for name in {**mine, **its}:
                if mine.get(name) != its.get(name):
                    found.setdefault(part, {})[name] = (mine.get(name), its.get(name))
        return found

    def __str__(self) -> str:
        return "\n".join(line for part, facts in self.facts.items()
                         for line in [part, *(f"  {name:26} {value}" for name, value in facts.items())])

    def meshes(self, **options: Any) -> dict[str, _library.Mesh]:
        """The meshes of all gears, by name; nothing is written."""
        return _library.drive_meshes(self._given(options))

    def sweep(self, *, progress: Optional[Progress] = None, **options: Any) -> list[Result]:
        """Equilibria at many roll angles, as `elastogear simulate -analysis sweep` finds them: one result for each
        torque and variant, whose time is the roll angle in pitches and whose `inputs` tell the case. Variants may be
        a dict of their keys, `variants={"nominal": {}, "tilted": {"wheel": {"skew": "0.02 deg"}}}`.

        Under mpirun all ranks must call it, and share the work.
        """
        report = self._run("simulate", {"analysis": "sweep", **options}, progress)
        self._last = path = report.files[0]
        if not os.path.isdir(path):
            return [Result(path, report)]
        with open(os.path.join(path, "cases.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        return [Result(os.path.join(path, row["file"]), report, row) for row in rows if row["file"]]

    def run(self, *, progress: Optional[Progress] = None, **options: Any) -> Evaluation:
        """Makes bodies, a sweep over a pitch and what is read off it, as far as they are not there, as
        `elastogear run` does: on meshes that are refined until the stresses at the roots have the `accuracy` asked.

        Under mpirun all ranks must call it, and share the work.
        """
        report = self._run("run", options, progress)
        self._last = ""  # it writes the one that evaluate reads where none is named
        return Evaluation([file for file in report.files if file.endswith(".h5")][-1], report)

    def evaluate(self, *, progress: Optional[Progress] = None, **options: Any) -> Evaluation:
        """Reads off what `elastogear evaluate` does: from the result of this drive's last simulate() or sweep(), or
        from that of the option `result`.
        """
        if self._last and "result" not in {**self._options, **_flat(options)}:
            options["result"] = self._last
        report = self._run("evaluate", options, progress)
        return Evaluation(report.files[0], report)

    def life(self, *, progress: Optional[Progress] = None, **options: Any) -> Life:
        """Fatigue damage over a duty cycle from the last sweep, as `elastogear life` finds it."""
        report = self._run("life", options, progress)
        return Life(next(file for file in report.files if file.endswith(".h5")), report)

    def wear(self, *, progress: Optional[Progress] = None, **options: Any) -> Report:
        """Wears the flanks by Archard's law, as `elastogear wear` does."""
        return self._run("wear", options, progress)

    def __repr__(self) -> str:
        return f"<elastogear.Drive of {', '.join(name for name in self.facts if ':' not in name)}>"


class Simulation:
    """A motion that is advanced step by step. Made by `System.simulation`.

        with drive.simulation(ts_dt=1e-6, ts_max_time=1e-3) as simulation:
            for state in simulation:
                print(state.time, state.body("worm").s_dot)

    An interrupt (Ctrl-C) or an error ends it; what was observed until then is in the output.
    """

    def __init__(self, given: _library.Given, forces: Mapping[str, Force], output: str) -> None:
        self._run = _library.SteppedRun(given, dict(forces), output)
        _warn(self._run.take_items(), 4)

    @property
    def state(self) -> _library.State:
        """The last state; its arrays are views that stay as they are when the simulation goes on."""
        return self._run.state

    @property
    def ended(self) -> bool:
        """Is there no step to take any more?"""
        return self._run.ended

    def step(self) -> bool:
        """Takes one step; False when the end was reached before."""
        taken = self._run.step()
        _warn(self._run.take_items(), 2)
        return taken

    def run(self) -> dict[str, Any]:
        """Takes all steps that are left; see `summary`."""
        self._run.run()
        _warn(self._run.take_items(), 2)
        return self.summary()

    def summary(self) -> dict[str, Any]:
        """Ends the simulation; counts of steps and iterations, energies (J) and times (s)."""
        return self._run.finish()

    def close(self) -> None:
        """Ends the simulation and frees its memory; states that were taken from it stay."""
        self._run.close()

    def __iter__(self) -> Iterator[_library.State]:
        """The states at the ends of the steps that are left."""
        while self.step():
            yield self.state

    def __enter__(self) -> "Simulation":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
