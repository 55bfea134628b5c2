"""What `elastogear evaluate` has found of a drive, as curves and a table of the page."""
import os

import h5py
import numpy as np

import results
from page import texts
from page.curves import chart, readable

CURVES = (  # place, title, {dataset: name}, unit
    ("transmission_error", "Transmission error", {"loaded": "loaded", "unloaded": "unloaded"}, "m"),
    ("stiffness", "Mesh stiffness", {"secant": "secant", "tangent": "tangent"}, "N/m"),
    ("pressure", "Largest contact pressure", {"largest": "pressure"}, "Pa"),
)
PREFIXED = ("m", "N", "N/m", "Pa", "W")
NOTICEABLE = 0.01  # of the force: pairs of teeth that carry less are not drawn


def group_of(file, result):
    """The case of a result file."""
    cases = list(file["cases"].values())
    own = [case for case in cases if os.path.basename(results.text(case["result"][()].ravel()[0])) == os.path.basename(result)]
    return own[0] if own else cases[0] if len(cases) == 1 else None


def pairs_of(case_group):
    return {name: group for name, group in case_group.items() if isinstance(group, h5py.Group) and "roll" in group}


def of_group(name, group, place, title, curves, unit):
    found = {label: group[f"{place}/{dataset}"][:] for dataset, label in curves.items() if f"{place}/{dataset}" in group}
    found = {label: values for label, values in found.items() if np.isfinite(values).all() and np.abs(values).max() > 0}
    if found:
        factor, scaled = readable(max(np.abs(values).max() for values in found.values()), unit)
        yield chart(f"{place}-{name}".replace(":", "-"), f"{title}, {name.replace(':', ' on ')}", group["roll"][:], f"{title.lower().removeprefix('largest ')} in {scaled}",
                    [{"name": label, "values": values * factor} for label, values in found.items()])


def shares(name, group):
    """Share of each pair of teeth in the normal force."""
    if "teeth/share" not in group:
        return
    share, tooth = group["teeth/share"][:], group["teeth/tooth"][:]
    curves = [{"name": f"teeth {a:.0f} and {b:.0f}", "values": 100 * share[:, i]} for i, (a, b) in enumerate(tooth) if share[:, i].max() > NOTICEABLE]
    if curves:
        yield chart(f"share-{name}".replace(":", "-"), f"Load sharing, {name.replace(':', ' on ')}", group["roll"][:], "share in %", curves)


def tensions(name, group):
    """Largest tension at the roots of both gears."""
    gears = [gear for gear in group.get("root", {}) if f"root/{gear}/tension" in group]
    if gears:
        yield chart(f"tension-{name}".replace(":", "-"), f"Largest tension at the roots, {name.replace(':', ' on ')}", group["roll"][:], "tension in MPa",
                    [{"name": gear, "values": group[f"root/{gear}/tension"][:].max(axis=1) / 1e6} for gear in gears])


def bearings(case):
    """Loads and deflections of all bearings over the roll angle."""
    groups, made = dict(case.get("bearings", {})), []
    rolls = [pair["roll"][:] for pair in pairs_of(case).values()]
    for kind, title, unit in (("load", "load", "N"), ("deflection", "deflection", "m")):
        curves = [(f"{name.replace('_', ' ')}, {way}", group[f"{way}_{kind}"][:]) for name, group in groups.items() for way in ("radial", "axial") if f"{way}_{kind}" in group]
        most = max((np.abs(values).max() for _, values in curves), default=0)
        if most > 0 and len(rolls[0]) > 1:
            factor, scaled = readable(most, unit)
            made.append(chart(f"bearing-{kind}", f"Bearings, {title}", rolls[0], f"{title} in {scaled}",
                              [{"name": name, "values": values * factor} for name, values in curves if np.abs(values).max() > NOTICEABLE * most]))
    return made


def charts(path, result):
    with results.open_file(path, "evaluation") as file:
        case = group_of(file, result)
        if case is None:
            return []
        made = []
        for name, group in pairs_of(case).items():
            if len(group["roll"]) > 1:
                for entry in CURVES:
                    made += of_group(name, group, *entry)
                made += shares(name, group)
                made += tensions(name, group)
        return made + bearings(case)


class RootPeak:
    """Largest tension at the roots of a gear, as results.Peak: value and estimated errors of von Mises stress there (Pa; None: not
    estimated), row of its node in the stress file's set, step of the output."""

    what = "largest tension at the roots"

    def __init__(self, pair, gear, nodes, times):
        root = pair[f"root/{gear}"]

        def number(name):
            return float(root["largest_tension" + name][()]) if "largest_tension" + name in root else None

        self.value, self.error, self.mesh_error = number(""), number("_error"), number("_mesh_error")
        self.contact_error, self.time_error = number("_contact_error"), number("_time_error")
        self.by_coarser_meshes = "range_mesh_error" in root
        known = self.error is not None and self.mesh_error is not None
        self.whole_error = self.error + self.mesh_error + (self.contact_error or 0) + (self.time_error or 0) if known else None
        at = int(np.abs(pair["roll"][:] - number("_roll")).argmin())
        time = float(pair["time"][at]) if "time" in pair else number("_roll") if len(pair["roll"]) > 1 else float(times[-1])
        self.step = int(np.abs(times - time).argmin())
        self.row = int(np.flatnonzero(nodes == int(number("_node")))[0])
        side = results.text(root["side"][()].ravel()[0])
        self.place = f"tooth {number('_tooth'):.0f}, {side} flank's root, diameter {1e3 * number('_diameter'):.1f} mm, z {1e3 * number('_z') + 0:.1f} mm"


def root_peaks(path, case):
    """case.peaks with the largest tension of gears in place of the largest von Mises stress of their roots."""
    with results.open_file(path, "evaluation") as file:
        group = group_of(file, case.result.filename)
        found = {}
        for name, pair in (pairs_of(group) if group is not None else {}).items():
            for gear in name.split(":"):
                nodes = next((stress["nodes"][:] for body, of_set, stress, _ in case.peaks if (body, of_set) == (gear, "root")), None)
                if nodes is None or f"root/{gear}/largest_tension_diameter" not in pair:
                    continue
                peak = RootPeak(pair, gear, nodes, case.stress["time"][:])
                if gear not in found or peak.value > found[gear].value:
                    found[gear] = peak
    return [(body, name, stress, found[body] if name == "root" and body in found else peak) for body, name, stress, peak in case.peaks]


def pressure_cards(path, result):
    """Figure, estimated error (Pa; None: not estimated) and words of the largest flank pressure of each pair."""
    with results.open_file(path, "evaluation") as file:
        group = group_of(file, result)
        for name, pair in (pairs_of(group) if group is not None else {}).items():
            if "pressure/hertz_peak" in pair:
                error = float(pair["pressure/hertz_peak_mesh_error"][()]) if "pressure/hertz_peak_mesh_error" in pair else None
                yield name, float(pair["pressure/hertz_peak"][()]), error, f"largest flank pressure by H. Hertz, at {float(pair['pressure/hertz_peak_roll'][()]):.3g} pitches"
            elif "pressure/peak" in pair:
                yield name, float(pair["pressure/peak"][()]), None, "largest pressure in the mean over faces of the mesh"


def in_words(value, unit):
    """A figure with its unit; those of some units with a prefix."""
    factor, unit = readable(abs(value), unit) if unit in PREFIXED else (1, unit)
    return f"{value * factor:.5g} {'' if unit == '1' else unit}".strip()


def in_order(name):
    """worm:wheel/root/largest_tension -> worm on wheel, root, largest tension"""
    return name.replace(":", " on ").replace("/", ", ").replace("_", " ")


def table(path, result):
    """All single numbers of the case."""
    rows = []

    def add(name, item):
        if isinstance(item, h5py.Dataset) and item.shape in ((), (1,)) and item.dtype.kind in "fi":
            value, unit = float(item[()].ravel()[0]) if item.shape else float(item[()]), results.text(item.attrs.get("unit", "1"))
            rows.append([in_order(name), (in_words(value, unit), value), results.text(item.attrs.get("meaning", ""))])

    with results.open_file(path, "evaluation") as file:
        case = group_of(file, result)
        if case is not None:
            case.visititems(add)
    return texts.table(["figure", "value", "meaning"], rows, "Read off by elastogear evaluate") if rows else ""
