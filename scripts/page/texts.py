"""What the page says in words and tables, from a result and a stress file: question, answer, trust, inputs, provenance."""
import html
import json
import math
import os
import re
import time

import numpy as np

import results

LIGHTS = {"good": ("●", "trusted"), "fair": ("▲", "within 5 %"), "bad": ("■", "not to be trusted")}
SHORTEST = 0.4  # of a unit: shorter runs are told in the next smaller one
UNITS = {"": 1, "nm": 1e-9, "um": 1e-6, "µm": 1e-6, "mm": 1e-3, "cm": 1e-2, "m": 1, "deg": math.pi / 180, "rad": 1, "us": 1e-6, "µs": 1e-6, "ms": 1e-3,
         "s": 1, "N": 1, "kN": 1e3, "Nmm": 1e-3, "Nm": 1, "kNm": 1e3, "MPa": 1e6, "GPa": 1e9, "rad/s": 1, "rpm": math.pi / 30, "1/min": math.pi / 30}
IMBALANCE = (0.01, 0.05)  # of the energy: up to these the balance is good, fair


def escape(text):
    return html.escape(str(text))


def table(head, rows, caption, classes="sortable"):
    """rows: lists of text, or of (text, number to sort by)."""
    def cell(value, tag):
        text, number = value if isinstance(value, tuple) else (value, None)
        mark = f' data-value="{number:.9g}"' if number is not None else ""
        return f"<{tag}{mark}>{text if isinstance(text, Html) else escape(text)}</{tag}>"
    lines = "".join("<tr>" + "".join(cell(value, "td") for value in row) + "</tr>" for row in rows)
    heads = "".join(f'<th scope="col">{escape(name)}</th>' for name in head)
    return (f'<div class="scroll" tabindex="0" role="group" aria-label="{escape(caption)}"><table class="{classes}"><caption>{escape(caption)}'
            f"</caption><thead><tr>{heads}</tr></thead><tbody>{lines}</tbody></table></div>")


class Html(str):
    """Text that is HTML already."""


def light(kind, words=None):
    sign, meaning = LIGHTS[kind]
    return Html(f'<span class="light {kind}"><span aria-hidden="true">{sign}</span> {escape(words or meaning)}</span>')


def trust(value, error):
    """The light of a value with its estimated error (None: not estimated)."""
    if error is None or not math.isfinite(error) or error > results.TRUSTED * abs(value):
        return "bad"
    return "good" if error <= results.WELL_TRUSTED * abs(value) else "fair"


def trust_mesh(peak, error):
    """The light of a peak by its estimated error of the mesh, of the contact's resolution or of the steps in time."""
    if error is None or error > results.TRUSTED_MESH * peak.value:
        return "bad"
    return "good" if error <= results.WELL_TRUSTED_MESH * peak.value else "fair"


def trust_all(peak):
    """The worst light of reduction, mesh, contact and steps, as far as their errors are estimated; that of the reduction always."""
    others = [trust_mesh(peak, error) for error in (peak.mesh_error, peak.contact_error, peak.time_error) if error is not None]
    return worst([trust(peak.value, peak.error), *others])


def light_of(peak):
    """The light of a largest stress; a fair one says how far it may be off in all."""
    kind = trust_all(peak)
    if kind != "fair" or peak.whole_error is None:
        return light(kind)
    return light(kind, f"within {math.ceil(100 * peak.whole_error / max(peak.value, 1e-300))} %")


def worst(kinds):
    return max(kinds, key=list(LIGHTS).index, default="bad")


def mega(pascal, digits=4):
    return f"{pascal / 1e6:.{digits}g}"


def plus_minus(value, error):
    """"282.8 ± 1.9" in MPa: the last digit of both is that of two digits of the error."""
    if error is None or error <= 0:
        return f"{value / 1e6:.4g}"
    decimals = max(0, min(4, 1 - math.floor(math.log10(error / 1e6))))
    return f"{value / 1e6:.{decimals}f} ± {error / 1e6:.{decimals}f}"


def options_of(file):
    """{option: value} in force in the run that wrote a file."""
    return {key.removeprefix("option_"): results.text(value) for key, value in file["provenance"].attrs.items() if key.startswith("option_")}


class Axis:
    """What the times of a result are: name, label, unit, factor into the unit."""

    def __init__(self, analysis, last, under_load=False):
        if analysis == "sweep":
            self.name, self.unit, self.factor = "roll angle", "pitches", 1.0
        elif analysis == "static" and not under_load:
            self.name, self.unit, self.factor = "load factor", "", 1.0
        else:
            self.name = "time"
            units = (("s", 1.0), ("ms", 1e3), ("µs", 1e6))
            self.unit, self.factor = next((entry for entry in units if last * entry[1] >= SHORTEST), units[-1])
        self.label = f"{self.name} in {self.unit}" if self.unit else self.name

    def at(self, value):
        return f"{value * self.factor:.4g} {self.unit}" if self.unit else f"{self.name} {value:.4g}"

    def cell(self, value):
        """For a table's column that has the axis' name."""
        return f"{value * self.factor:.4g} {self.unit}".strip(), float(value)

    def data(self):
        return {"name": self.name, "label": self.label, "unit": self.unit, "factor": self.factor}


class Case:
    """One run: its files, open, and what was asked."""

    def __init__(self, result, stress, drive):
        self.result, self.stress, self.drive = result, stress, drive or {}
        self.options = options_of(result)
        self.analysis = self.options.get("analysis", "dynamic")
        self.time = result["time"][:]
        self.axis = Axis(self.analysis, float(self.time[-1]), self.options.get("time_under_load", "0") not in ("", "0"))
        self.bodies = sorted(result["bodies"], key=lambda name: int(result["bodies"][name].attrs["number"]))
        self.peaks = [(body, name, group, results.Peak(group)) for body, name, group in results.stress_sets(stress)] if stress else []
        self.pressures = []

    def take(self, peaks, pressures):
        """Of a drive: the largest tension of each root in place of its von Mises stress, and flank pressures (pair, Pa, words)."""
        self.peaks, self.pressures = peaks, list(pressures)

    def kind(self):
        return {"worm": "worm drive", "cylindrical": "gear drive"}.get(self.drive.get("drive"), "")

    def teeth(self, body):
        section = self.drive.get(body)
        section = section if isinstance(section, dict) else {}
        return section.get("teeth") or (section.get("starts", "1") if body == "worm" and self.kind() == "worm drive" else None)

    def title(self):
        if not self.kind():
            return os.path.splitext(os.path.basename(self.result.filename))[0].replace("_", " ").capitalize() + f": {' and '.join(self.bodies)}"
        numbers = [self.teeth(body) for body in self.bodies]
        return self.kind().capitalize() + (" " + " : ".join(numbers) if all(numbers) else "")


def motion_of(case, body):
    """"held", or how a body may move and starts."""
    state = case.result["bodies"][body]
    speed = state["rigid_velocity"]
    if speed.shape[1] == 0:
        return "held"
    if case.analysis != "dynamic":
        return "free to turn"
    first = float(speed[0, 0])
    return f"{'starting at' if first else 'free, from rest'}{f' {abs(first):.4g} {results.speed_unit(state)}' if first else ''}"


def question(case):
    """What was asked, a sentence."""
    torque = case.options.get("torque", case.drive.get("torque", "0"))
    if re.fullmatch(r"[-+\d.e]+", torque.strip()):
        torque = torque.strip() + " N m"
    torque = torque.replace(" ", "\u00a0")
    if case.kind():
        if case.analysis == "sweep":
            return f"What stresses do the teeth of this {case.kind()} have as it rolls under {torque}?"
        if case.analysis == "static":
            return f"What stresses do the teeth of this {case.kind()} have at rest under {torque} on the {case.bodies[0]}?"
    moving = ", ".join(f"{body} ({motion_of(case, body)})" for body in case.bodies)
    if case.analysis == "dynamic":
        return f"What stresses arise within {case.axis.at(case.time[-1])} in {moving}, with each other in contact?"
    return f"What stresses arise at rest in {moving}?"


def balance(case):
    """Largest imbalance of energy as a share of what was there or came in; None where nothing moves."""
    energy = case.result["energy"]
    if case.analysis != "dynamic":
        return None
    whole = sum(abs(float(energy[name][0])) for name in ("kinetic", "elastic", "contact")) + float(np.abs(energy["work"][:]).max())
    return float(np.abs(energy["balance"][:]).max()) / whole if whole > 0 else None


def of_size(body, meshes):
    return f" ({meshes[body]})" if body in meshes else ""


def checks(case, meshes):
    """Rows (light, what, figure) of all that can be told of how sure the answer is."""
    rows = []
    for body, name, _, peak in case.peaks:
        share = f"off by an estimated {100 * peak.error / max(peak.value, 1e-300):.2g} %" if peak.error is not None else "error not estimated"
        kind = trust(peak.value, peak.error)
        rows.append((kind, f"{LIGHTS[kind][1].capitalize()}", f"{body} {name.replace('_', ' ')}, {share}"))
    off = balance(case)
    if off is not None:
        kind = "good" if off <= IMBALANCE[0] else "fair" if off <= IMBALANCE[1] else "bad"
        rows.append((kind, "Energy", f"balance off by at most {100 * off:.2g} %"))
    if not case.result.attrs.get("complete", 1):
        rows.append(("bad", "Stopped", "the run did not reach its end"))
    for body, name, _, peak in case.peaks:
        if peak.mesh_error is not None:
            light_of_mesh = trust_mesh(peak, peak.mesh_error)
            doubt = ", too coarse for this stress" if light_of_mesh == "bad" else ""
            share = f"off by an estimated {100 * peak.mesh_error / max(peak.value, 1e-300):.2g} %{doubt}"
            rows.append((light_of_mesh, "Mesh", f"{body} {name.replace('_', ' ')}, {share}{of_size(body, meshes)}"))
        if peak.contact_error is not None:
            light_of_contact = trust_mesh(peak, peak.contact_error)
            doubt = ", the stress beside a contact" if light_of_contact == "bad" else ""
            share = f"off by an estimated {100 * peak.contact_error / max(peak.value, 1e-300):.2g} %{doubt}"
            rows.append((light_of_contact, "Contact", f"{body} {name.replace('_', ' ')}, {share}"))
        if peak.time_error is not None:
            light_of_steps = trust_mesh(peak, peak.time_error)
            doubt = ", too long for this stress" if light_of_steps == "bad" else ""
            share = f"off by an estimated {100 * peak.time_error / max(peak.value, 1e-300):.2g} %{doubt}"
            rows.append((light_of_steps, "Steps in time", f"{body} {name.replace('_', ' ')}, {share}"))
    known = {body for body, _, _, peak in case.peaks if peak.mesh_error is not None}
    others = "; ".join(f"{body}: {size}" for body, size in meshes.items() if body not in known)
    if others:
        rows.append(("fair", "Mesh", f"its error is not estimated, repeat with a finer one ({others})"))
    return rows


def cards(case):
    """The answer: the largest stress of each set, and the largest contact force."""
    for body, name, group, peak in sorted(case.peaks, key=lambda entry: -entry[3].value):
        node = int(group["nodes"][peak.row])
        place = getattr(peak, "place", f"node {node}") + (f", {case.axis.at(case.time[peak.step])}" if len(case.time) > 1 else "")
        visit = escape(json.dumps({"body": body, "node": node, "time": float(case.time[peak.step])}))
        yield (f'<li class="card"><h3>{escape(body)}, {escape(name.replace("_", " "))}</h3>'
               f'<p class="figure">{plus_minus(peak.value, peak.error if peak.whole_error is None else peak.whole_error)} <span class="unit">MPa</span></p><p>{peak.what}, {light_of(peak)}</p>'
               f'<p class="where">{escape(place)} <button type="button" data-visit="{visit}">Show</button></p></li>')
    for name, pressure, error, words in case.pressures:
        yield (f'<li class="card"><h3>Flanks, {escape(name.replace(":", " on "))}</h3><p class="figure">{plus_minus(pressure, error)} <span class="unit">MPa</span></p>'
               f'<p>{escape(words)}</p></li>')
    for name, pair in case.result["contact"].items():
        force = results.total_force(pair)
        step = int(force.argmax())
        pressure = float(pair["pressure"][:].max()) if "pressure" in pair and not case.pressures else 0
        more = f"contact pressure up to {mega(pressure)} MPa" if pressure > 0 else ""
        yield (f'<li class="card"><h3>Contact {escape(name.replace(":", " on "))}</h3><p class="figure">{force[step]:.{max(0, 3 - math.floor(math.log10(max(force[step], 1e-3))))}f} <span class="unit">N</span></p>'
               f'<p>largest contact force</p><p>{more}</p><p class="where">{escape(case.axis.at(case.time[step])) if len(case.time) > 1 else ""}</p></li>')


def error_note(case):
    """What stands after ±."""
    if any(getattr(peak, "by_coarser_meshes", False) for _, _, _, peak in case.peaks):
        return ("After ± stands the estimated error of the reduction, against unreduced bodies on the same mesh, and that of the mesh, by what has changed "
                "from coarser meshes to this one, together; the table has each. It does not cover the law of contact.")
    if any(peak.whole_error is not None for _, _, _, peak in case.peaks):
        return ("After ± stands the estimated error of the reduction, against unreduced bodies on the same mesh, that of the mesh, the difference between "
                "two recoveries of the stress, that of the contact's resolution, the stress of forces spread over the next nodes, and that of the steps in time, "
                "together; the table has each. It does not cover the law of contact.")
    return ("After ± stands the estimated error of the reduction, against unreduced bodies on the same mesh. It covers neither the mesh nor the law of "
            "contact.")


def summary(case, meshes):
    """Question, answer and how sure it is."""
    rows = checks(case, meshes)
    overall = worst([kind for kind, _, _ in rows]) if case.peaks else "bad"
    listed = "".join(f"<li>{light(kind, what)}: {escape(figure)}</li>" for kind, what, figure in rows)
    missing = "" if case.peaks else f"<p>{light('bad', 'No stresses were evaluated')}</p>"
    return (f'<section aria-labelledby="asked" class="summary"><p id="asked" class="asked">{escape(question(case))}</p>'
            f'<ul class="cards">{"".join(cards(case))}</ul>'
            f'<div class="verdict {overall}"><h2>How sure</h2>{missing}<ul class="checks">{listed}</ul>'
            f'<p class="note">{error_note(case)}</p></div></section>')


def stress_table(case):
    rows = []
    for body, name, group, peak in case.peaks:
        tension = group["rankine"][:]
        errors = [(mega(error, 2) if error is not None else "–", error or 0) for error in (peak.error, peak.mesh_error, peak.contact_error, peak.time_error, peak.whole_error)]
        rows.append([body, name.replace("_", " "), (mega(peak.value), peak.value), *errors, light(trust_all(peak)), str(int(group["nodes"][peak.row])),
                     case.axis.cell(case.time[peak.step]), (mega(float(tension.max())), float(tension.max())), peak.what])
    return table(["body", "node set", "stress in MPa", "± of the reduction", "± of the mesh", "± of the contact", "± of the steps", "± of all in MPa", "", "node", case.axis.name, "largest principal in MPa", "stress is"], rows, "Largest stresses")


def contact_table(case):
    rows = []
    for pair_name, pair in case.result["contact"].items():
        for side, body in (("a", pair_name.split(":")[0]), ("b", pair_name.split(":")[-1])):
            group = pair[f"groups/{side}"]
            forces = results.group_forces(pair, side)
            for i, (name, force) in enumerate(forces.items()):
                if force.max() > 0:
                    step = int(force.argmax())
                    most = float(group["pressure"][:, i].max()) if "pressure" in group else 0.0
                    rows.append([body, name.replace("_", " "), (f"{force[step]:.4g}", float(force[step])), case.axis.cell(case.time[step]),
                                 (mega(most), most)])
    return table(["body", "area of contact", "largest force in N", case.axis.name, "largest pressure in MPa"], rows, "Areas of contact") if rows else ""


def flat(tree, prefix=""):
    for key, value in tree.items():
        name = f"{prefix}{key}"
        if isinstance(value, dict):
            yield from flat(value, name + ".")
        else:
            yield name, ", ".join(map(str, value)) if isinstance(value, list) else value


def number_of(text):
    """A number with a unit or without in SI units, None where a text is none."""
    found = re.fullmatch(r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)(?: *([^\d\s.].*))?", text.strip())
    factor = UNITS.get((found[2] or "").replace(" ", "")) if found else None
    return float(found[1]) * factor if factor else None


def in_force(case, key, value):
    """The value of a key, and that of the run where the command line had another one."""
    used = case.options.get(key, value)
    asked, taken = number_of(value), number_of(used)
    units = (1, UNITS["deg"]) if value.endswith("deg") else (1,)  # angles of designs stay in degrees
    same = None not in (asked, taken) and any(math.isclose(asked, taken * unit, rel_tol=1e-9) for unit in units)
    if same or value.replace(" ", "") == used.replace(" ", ""):
        return value
    return f"{used if taken is None else f'{taken:.6g}'} in this run, {value} in the file"


def inputs_table(case, source):
    """source: name of the input file whose keys case.drive holds."""
    given = [[key, in_force(case, key, value)] for key, value in flat(case.drive)]
    every = [[key, value] for key, value in sorted(case.options.items())]
    text = table(["key", "value"], given, f"Given in {source}") if given else ""
    return text + (f"<details><summary>All {len(every)} options of simulate in force</summary>"
                   f'{table(["option", "value"], every, "Options in force; numbers without a unit are in SI units")}</details>')


def bytes_of(path):
    size = os.path.getsize(path)
    return f"{size / 1e6:.1f} MB" if size >= 1e6 else f"{size / 1e3:.1f} kB"


def provenance_table(case, files, commands):
    known = {key: results.text(value).strip() for key, value in case.result["provenance"].attrs.items() if not key.startswith("option_")}
    rows = [["elastogear", f"{known.get('program_version', '?')}, revision {known.get('git_hash', '?')}"],
            ["PETSc", known.get("petsc_version", "?").removeprefix("Petsc Release Version ")],
            ["SLEPc", known.get("slepc_version", "?").removeprefix("SLEPc Release Version ")]]
    rows += [[f"body {key.removeprefix('identity_')}", f"identity {value}"] for key, value in known.items() if key.startswith("identity_")]
    rows += [["command", command] for command in commands]
    rows += [[os.path.basename(path), f"{bytes_of(path)}, {time.strftime('%Y-%m-%d %H:%M', time.localtime(os.path.getmtime(path)))}"]
             for path in files]
    return table(["", ""], rows, "Versions, commands and files", "plain")
