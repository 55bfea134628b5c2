"""What `elastogear evaluate` has read off a drive, as curves and a table of the page."""
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
NOTICEABLE = 0.01  # of the force: pairs of teeth that bear less are not drawn


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
        yield chart(f"{place}-{name}".replace(":", "-"), f"{title}, {name.replace(':', ' on ')}", group["roll"][:], f"{title.lower()} in {scaled}",
                    [{"name": label, "values": values * factor} for label, values in found.items()])


def shares(name, group):
    """Share of each pair of teeth in the normal force."""
    if "teeth/share" not in group:
        return
    share, tooth = group["teeth/share"][:], group["teeth/tooth"][:]
    curves = [{"name": f"teeth {a:.0f} and {b:.0f}", "values": 100 * share[:, i]} for i, (a, b) in enumerate(tooth) if share[:, i].max() > NOTICEABLE]
    if curves:
        yield chart(f"share-{name}".replace(":", "-"), f"Load sharing, {name.replace(':', ' on ')}", group["roll"][:], "share in %", curves)


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
        return made


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
