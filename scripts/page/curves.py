"""Curves of the page, over the times of the result file, as scripts/page/src/charts.js draws them."""
import numpy as np

import results

MOST_POINTS = 1500  # of a curve: of longer ones the lowest and highest of each span are kept
NOTICEABLE = 0.02  # of the largest: weaker contact areas are not drawn
MOST_AREAS = 4
ENERGIES = {"kinetic": "kinetic", "elastic": "elastic", "contact": "contact", "dissipated": "dissipated", "work": "work of loads"}
SI_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"))


def readable(largest, unit):
    """Factor and unit name in which a quantity with this largest magnitude reads well."""
    return next(((1 / size, prefix + unit) for size, prefix in SI_PREFIXES if largest >= size), (1.0, unit))


def rows_kept(curves):
    n = len(curves[0]["values"])
    if n <= MOST_POINTS:
        return np.arange(n)
    spans = np.array_split(np.arange(n), MOST_POINTS // (2 * len(curves)))
    rows = {0, n - 1}
    for curve in curves:
        for span in spans:
            part = curve["values"][span]
            rows.update((int(span[part.argmin()]), int(span[part.argmax()])))
    return np.array(sorted(rows))


def chart(name, title, time, unit, curves, bands=()):
    """Chart of [{"name", "values"}] in the unit."""
    rows = rows_kept(curves)
    packed = [{**curve, "values": [float(f"{value:.6g}") for value in curve["values"][rows]]} for curve in curves]
    return {"id": f"chart-{name}", "title": title, "x": [float(f"{t:.9g}") for t in time[rows]], "yLabel": unit, "curves": packed,
            "bands": [list(pair) for pair in bands]}


def contact_forces(case):
    for number, (name, pair) in enumerate(case.result["contact"].items()):
        total, slave = results.total_force(pair), name.split(":")[-1]
        if total.max() <= 0:
            continue
        factor, unit = readable(total.max(), "N")
        areas = sorted(((force, label) for label, force in results.group_forces(pair).items() if force.max() > NOTICEABLE * total.max()),
                       key=lambda entry: -entry[0].max())[:MOST_AREAS]
        curves = [{"name": "all", "values": total * factor, "black": True}]
        curves += [{"name": f"{slave} {label.replace('_', ' ')}", "values": force * factor} for force, label in areas]
        yield chart(f"force-{number}", f"Contact force, {name.replace(':', ' on ')}", case.time, f"force in {unit}", curves)


def whole_error(group):
    """Estimated error of a set's largest stress over time, Pa: of the reduction, and of mesh, contact and steps at its node where
    they are known."""
    error, at = group["peak_error"][:], group["von_mises"][:].argmax(axis=1)[:, None]
    for name in ("mesh_error", "contact_error", "time_error"):
        if name in group:
            error = error + np.take_along_axis(group[name][:], at, axis=1)[:, 0]
    return error


def stresses(case):
    """Largest von Mises stress of each set, with the band of its estimated error."""
    curves, bands = [], []
    peaks = [entry for entry in case.peaks if not hasattr(entry[3], "place")]  # evaluate has the others
    for body, name, group, _ in peaks:
        values = group["von_mises"][:].max(axis=1) / 1e6
        curves.append({"name": f"{body} {name.replace('_', ' ')}", "values": values})
    for i, (_, _, group, _) in enumerate(peaks):
        if "peak_error" not in group:
            continue
        error = whole_error(group) / 1e6
        bands.append((len(curves), len(curves) + 1))
        curves += [{"name": "", "values": curves[i]["values"] + error, "band": True},
                   {"name": "", "values": np.maximum(curves[i]["values"] - error, 0), "band": True}]
    if curves:
        yield chart("stress", "Largest von Mises stress of each node set; shaded: its estimated error", case.stress["time"][:], "stress in MPa", curves, bands)


def joints(case, dataset, name, title, units):
    """One chart for each kind of joint coordinate. units: of turning and of sliding ones."""
    for joint, unit in units.items():
        curves = []
        for body in case.bodies:
            state = case.result["bodies"][body]
            values = state[dataset][:]
            if values.shape[1] != 1 or (results.text(state.attrs.get("joint", "revolute")) == "prismatic") != (joint == "prismatic"):
                continue
            if np.abs(values).max() > 0:
                curves.append({"name": body, "values": values[:, 0]})
        if curves:
            factor, scaled = readable(max(np.abs(curve["values"]).max() for curve in curves), unit)
            for curve in curves:
                curve["values"] = curve["values"] * factor
            yield chart(f"{name}-{joint}", title[joint], case.time, f"{title['of']} in {scaled}", curves)


def torques(case):
    return joints(case, "joint_force", "torque", {"revolute": "Joint torque", "prismatic": "Joint force", "of": "torque"},
                  {"revolute": "N m", "prismatic": "N"})


def speeds(case):
    return joints(case, "rigid_velocity", "speed", {"revolute": "Speed of rotation", "prismatic": "Speed", "of": "speed"},
                  {"revolute": "rad/s", "prismatic": "m/s"})


def energies(case):
    energy = case.result["energy"]
    values = {label: energy[name][:] for name, label in ENERGIES.items() if np.abs(energy[name][:]).max() > 0}
    if not values:
        return
    factor, unit = readable(max(np.abs(value).max() for value in values.values()), "J")
    yield chart("energy", "Energies", case.time, f"energy in {unit}", [{"name": label, "values": value * factor} for label, value in values.items()])


def charts(case):
    """All charts that a run has something to show in; none of a single time."""
    if len(case.time) < 2:
        return []
    made = [*contact_forces(case), *stresses(case), *torques(case)]
    return made + ([*speeds(case), *energies(case)] if case.analysis == "dynamic" else [])
