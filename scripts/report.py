#!/usr/bin/python3
"""One HTML page of a run that can be turned and played, without a network: question, answer and how sure it is, stresses on the
bodies, curves, tables, inputs, versions (docs/report.md).

  report.py drive.yaml       the input file of simulate and recover; its result file is there already
"""
import argparse
import base64
import hashlib
import json
import os
import subprocess
import sys
import tempfile

import numpy as np
import yaml

import results
from page import bundle, curves, evaluation, pack, texts

SCRIPTS = os.path.dirname(os.path.abspath(__file__))
PROGRAM = os.path.join(SCRIPTS, "..", "build", "release", "src", "app", "elastogear")
SOURCE = os.path.join(SCRIPTS, "page", "src")
MOST_BYTES = 15_000_000  # of the page
QUANTITIES = (("von_mises", "Von Mises stress"), ("rankine", "Largest principal stress"), ("contact_traction", "Contact pressure"),
              ("pattern", "Contact pattern, largest pressure of all times"), ("error_of_von_mises", "Estimated error by the reduction"),
              ("error_of_von_mises_by_mesh", "Estimated error by the mesh"),
              ("error_of_von_mises_by_steps", "Estimated error by the steps in time"))
SHOWN_QUANTILE, STANDS_OUT = 0.999, 3  # as in scripts/pictures.py: colours end there where a few nodes stand out
WARP_SHARE = 0.08  # of a body's size: the largest displacement that may be drawn


def read_keys(path):
    """All keys of an input file, with their values as text."""
    try:
        with open(path, encoding="utf-8") as file:
            keys = yaml.load(file, Loader=yaml.BaseLoader)
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        sys.exit(f"{path}: cannot be read: {error}")
    if not isinstance(keys, dict):
        sys.exit(f"{path}: holds no keys: expected an input file of elastogear simulate")
    return keys


def default_result(path, keys):
    """The result file that simulate writes with this input file."""
    own = keys.get("simulate") if isinstance(keys.get("simulate"), dict) else {}
    if "output" in own or "output" in keys:
        return own.get("output", keys.get("output"))
    return os.path.splitext(os.path.basename(path))[0] + "_result.h5"


def recover(options, result, n_times, folder):
    """Stresses at all output times, and fields at no more than the times wanted; returns both files and the command."""
    stress, base = os.path.join(folder, "stress.h5"), os.path.join(folder, "fields")
    every = max(1, -(-(n_times - 1) // max(options.times - 1, 1)))
    command = [options.elastogear, "recover", options.input, "-result", result, "-output", stress]
    if not options.no_picture:
        command += ["-fields", base, "-field_times", "all", "-field_every", str(every)]
    print(f"recovering stresses{'' if options.no_picture else f', fields of every {every}. time'}", file=sys.stderr, flush=True)
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    except OSError as error:
        sys.exit(f"{options.elastogear}: cannot be run: {error}. Build it by scripts/build, or name it by --elastogear")
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} failed (--no-picture makes a page without the bodies):\n{done.stderr}")
    return stress, None if options.no_picture else base + ".pvd"


def evaluate(options, result, folder):
    """What elastogear evaluate reads off the run of a drive; None where it cannot."""
    path = os.path.join(folder, "evaluation.h5")
    done = subprocess.run([options.elastogear, "evaluate", options.input, "-result", result, "-output", path], stdin=subprocess.DEVNULL,
                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        print(f"without what evaluate reads off: {done.stderr.strip()}", file=sys.stderr)
    return path if done.returncode == 0 else None


def round_up(value):
    """The next 1, 2 or 5 times a power of ten."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(next(digit * power for digit in (1, 2, 5, 10) if digit * power >= value * (1 - 1e-9)))


def colour_end(case, surfaces, name):
    """A round number beyond the largest stress evaluated (of von Mises), else beyond the largest value, or where a few nodes stand
    out far beyond all but those."""
    most = np.concatenate([surface.fields[name].max(axis=0) for surface in surfaces if name in surface.fields])
    shown = float(np.quantile(most, SHOWN_QUANTILE))
    if name == "contact_traction" or most.max() <= STANDS_OUT * shown:
        shown = float(most.max())
    if name == "von_mises" and case.peaks:
        shown = max(peak.value for _, _, _, peak in case.peaks)
    if shown <= 0:
        return 1.0
    step = round_up(shown / 10)
    return step * float(np.ceil(shown / step))


def quantities(case, surfaces):
    """What the bodies can be coloured by, in MPa."""
    known = {name for surface in surfaces for name in surface.fields}
    shown = []
    for key, label in QUANTITIES:
        name = "contact_traction" if key == "pattern" else key
        if name in known and (key != "pattern" or len(surfaces[0].displacement) > 1):
            shown.append({"key": key, "label": label, "unit": "MPa", "factor": 1e-6, "end": colour_end(case, surfaces, name), "twoSides": key == "rankine"})
    return shown


def scales(surfaces):
    """Enlargements of the displacements to choose from: 0, 1, 2, 5, ..."""
    size = max(float(np.ptp(surface.X, axis=0).max()) for surface in surfaces)
    largest = max(float(np.linalg.norm(surface.displacement, axis=2).max()) for surface in surfaces)
    most = WARP_SHARE * size / largest if largest > 0 else 1
    steps = [digit * 10**power for power in range(7) for digit in (1, 2, 5)]
    return [0, 1] + [step for step in steps if 1 < step <= most]


def start_step(case, times):
    """The field time nearest to the largest evaluated stress."""
    if not case.peaks:
        return len(times) - 1
    peak = max((entry[3] for entry in case.peaks), key=lambda peak: peak.value)
    return int(np.abs(times - case.stress["time"][peak.step]).argmin())


def view_data(case, collection, room):
    """Everything that the picture needs. room: characters that it may take."""
    try:
        from page import fields  # here, so that a page without bodies needs no VTK
    except ModuleNotFoundError as error:
        sys.exit(f"report: the bodies in three dimensions need the Python package {error.name} (python3-vtk9); --no-picture leaves them out")
    times, surfaces = fields.read_surfaces(collection, case.result)
    return {"times": times.tolist(), "start": start_step(case, times), "x": case.axis.data(), "quantities": quantities(case, surfaces),
            "scales": scales(surfaces), "bodies": pack.pack(surfaces, room)}


def template(name):
    with open(os.path.join(SOURCE, name), encoding="utf-8") as file:
        return file.read()


def fill(text, parts):
    """Replaces each {{key}} once; what is filled in is not looked at again."""
    pieces = text.split("{{")
    return pieces[0] + "".join(str(parts[key]) + rest for key, rest in (piece.split("}}", 1) for piece in pieces[1:]))


def view_section(case, data):
    options = "".join(f'<option value="{texts.escape(q["key"])}">{texts.escape(q["label"])}</option>' for q in data["quantities"])
    names = "".join(f'<option value="{texts.escape(body["name"])}">{texts.escape(body["name"])}</option>' for body in data["bodies"])
    alt = texts.escape(f"{' and '.join(body['name'] for body in data['bodies'])} in three dimensions, coloured by stress.")
    return fill(template("view.html"), {"quantities": options, "bodies": names, "alt": alt, "scales": len(data["scales"]) - 1, "last": len(data["times"]) - 1,
                                        "start": data["start"], "still": "hidden" if len(data["times"]) < 2 else ""})


def charts_section(charts, axis):
    if not charts:
        return ""
    figures = "".join(f'<figure><figcaption>{texts.escape(chart["title"])}</figcaption><div class="chart" id="{chart["id"]}" role="img" '
                      f'aria-label="{texts.escape(describe(chart))}"></div></figure>' for chart in charts)
    return (f'<section aria-labelledby="charts-head"><h2 id="charts-head">Over the {axis.name}</h2><p class="note">A click on a curve shows its {axis.name} on the bodies.</p>'
            f'<div class="charts">{figures}</div></section>')


def describe(chart):
    """The curves in words."""
    said = [f"{curve['name']}: from {min(curve['values']):.4g} to {max(curve['values']):.4g}" for curve in chart["curves"] if not curve.get("band")]
    return f"{chart['title']}, {chart['yLabel']}. " + "; ".join(said)


def drawing(path):
    if not path or not os.path.isfile(path):
        return ""
    with open(path, "rb") as file:
        data = base64.b64encode(file.read()).decode()
    return f'<p><img class="drawing" src="data:image/svg+xml;base64,{data}" alt="Two sections of the gears in place, with their main numbers"></p>'


def script_data(data):
    """JSON that may stand inside of a script element."""
    return json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")


def write(path, text):
    temporary = path + ".tmp"
    with open(temporary, "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(temporary, path)
    print(f"{path}: {len(text.encode()) / 1e6:.2f} MB, open it in a browser")


def made_of(options, result, evaluated):
    """The mark at a page's end of all that the page shows."""
    total = hashlib.sha256()
    figures = os.path.splitext(evaluated)[0] + ".json"
    for path in (options.input, result, figures, options.elastogear):
        if os.path.isfile(path):
            with open(path, "rb") as file:
                total.update(hashlib.sha256(file.read()).digest())
    total.update(f"{options.times} {options.no_picture}".encode())
    return f"<!-- made of {total.hexdigest()} -->\n"


def ends_with(path, mark):
    if not os.path.isfile(path):
        return False
    with open(path, "rb") as file:
        file.seek(-min(len(mark), os.path.getsize(path)), os.SEEK_END)
        return file.read() == mark.encode()


def compose(case, collection, parts, out, evaluated=None, mark=""):
    """parts: of the template page.html, but for those that are made here. evaluated: an evaluation file. mark: at the page's end."""
    folder = bundle.ready()
    script, style = (bundle.read(os.path.join(folder, name)) for name in ("page.js", "page.css"))
    charts = curves.charts(case) + (evaluation.charts(evaluated, case.result.filename) if evaluated else [])
    data = {"charts": charts, "x": case.axis.data()}
    parts = {"title": texts.escape(case.title()), "results": texts.stress_table(case) + texts.contact_table(case)
             + (evaluation.table(evaluated, case.result.filename) if evaluated else ""), "view": "", "top": "top", **parts}
    room = MOST_BYTES - len(script) - len(style) - len(script_data(data)) - sum(map(len, parts.values()))
    if collection:
        data.update(view_data(case, collection, room - 300_000))
        parts.update({"view": view_section(case, data), "top": "top two-sides"})
    parts.update({"script": script.replace("</script", "<\\/script"), "style": style.replace("</style", "<\\/style"), "data": script_data(data),
                  "charts": charts_section(charts, case.axis)})
    write(out, fill(template("page.html"), parts) + mark)


def mesh_sizes(case, options):
    sizes = {}
    for body in case.bodies:
        path = options.get(body) or results.text(case.result["bodies"][body].attrs.get("file", ""))
        if path and os.path.isfile(path):
            results.require_body_of_run(case.result, body, path)
            with results.open_file(path, "body") as file:
                sizes[body] = f"{file['mesh/X'].shape[0]} nodes, {file['mesh/cell_type'].shape[0]} elements"
                modes, alone = results.mode_count(file), results.text(file["provenance"].attrs.get("option_modes", "")) == "0"
                sizes[body] += f", {modes} modes" if modes else ", static responses alone" if alone else ", unreduced"
    return sizes


def report_input(options):
    """Page of an input file's run."""
    keys = read_keys(options.input)
    path = options.result or default_result(options.input, keys)
    stem = os.path.splitext(os.path.basename(options.input))[0]
    out, evaluated = options.out or stem + "_report.html", options.evaluation or stem + "_evaluation.h5"
    mark = made_of(options, path, evaluated)
    if options.keep and ends_with(out, mark):
        return
    with results.open_file(path, "result") as result, tempfile.TemporaryDirectory(prefix="elastogear_report_") as folder:
        stress_path, collection = options.stress, None if options.no_picture else options.fields
        if not stress_path or not (collection or options.no_picture):
            made, fields_made = recover(options, path, len(result["time"]), folder)
            stress_path, collection = stress_path or made, collection or fields_made
        with results.open_file(stress_path, "stress") as stress:
            case = texts.Case(result, stress, keys)
            meshes = mesh_sizes(case, {})
            names = [options.input] + ([options.result] if options.result else [])
            commands = [f"elastogear {verb} {options.input}" for verb in (("reduce",) if "drive" in keys else ()) + ("simulate", "recover")]
            commands.append("scripts/report.py " + " ".join(names))
            source = f"<details><summary>{texts.escape(stem)}.yaml as it stands</summary><pre tabindex=\"0\">{texts.escape(bundle.read(options.input))}</pre></details>"
            if "drive" in keys and not os.path.isfile(evaluated):
                evaluated = evaluate(options, path, folder)
            if evaluated and os.path.isfile(evaluated):
                case.take(evaluation.root_peaks(evaluated, case), evaluation.pressure_cards(evaluated, path))
            shown = drawing(options.drawing or stem + ".svg")
            compose(case, collection, {"summary": texts.summary(case, meshes), "inputs": shown + texts.inputs_table(case, os.path.basename(options.input)) + source,
                                       "provenance": texts.provenance_table(case, [options.input, path], commands)},
                    out, evaluated if evaluated and os.path.isfile(evaluated) else None, mark)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("input", help="input file")
    parser.add_argument("--result", help="result file; default: the one that simulate writes with the input file")
    parser.add_argument("--stress", help="stress file of recover; without it and --fields recover is run")
    parser.add_argument("--fields", help="collection (.pvd) of recover's fields")
    parser.add_argument("--times", type=int, default=60, help="most times that are shown on the bodies (default: %(default)s)")
    parser.add_argument("--drawing", help="SVG file of elastogear mesh; default: INPUT.svg where it is")
    parser.add_argument("--evaluation", help="file of elastogear evaluate; default: INPUT_evaluation.h5 where it is")
    parser.add_argument("--no-picture", action="store_true", help="without the bodies in three dimensions")
    parser.add_argument("--keep", action="store_true", help="leave a page that is there of the same files")
    parser.add_argument("--elastogear", default=PROGRAM, help="program")
    parser.add_argument("--out", help="default: INPUT_report.html")
    options = parser.parse_args()
    if options.times < 1:
        parser.error(f"--times is {options.times}, must be at least 1")
    return options


def main():
    report_input(arguments())


if __name__ == "__main__":
    main()
