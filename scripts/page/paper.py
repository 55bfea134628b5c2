"""The page of scripts/paper: each figure and table of the paper that is of its method, beside what the paper shows.

FUNCTIONS, below, says which function makes which of them; each takes the folder of results and returns HTML. paper.yaml has their
titles, the paper's numbers and the words beside them."""
import csv
import glob
import html
import io
import os

import numpy as np
import yaml
from PIL import Image

import report
import results
from page import example as runs

HERE = os.path.dirname(os.path.abspath(__file__))
MODES = 1000  # a body, of Tabs. 3 and 4 and Figs. 13 and 14
BODIES = ("worm", "wheel")
EXAMPLES = ("impact", "turn_in", "rolling")
PAPER_ORDER = [0, 1, 2, 3, 5, 4]  # of Tabs. 3 and 4: xx yy zz xy xz yz
AWAY = 2e-3  # m: spots at roots are farther from contacts
PANEL = (4.6, 3.1)  # inches, of one diagram
WIDTH = 1600  # pixels, of the widest picture


class Missing(Exception):
    """What a figure or table needs, and what is not in the folder."""


class Paper:
    """A folder of scripts/paper."""

    def __init__(self, folder, size=""):
        self.folder, self.size = folder, size
        with open(os.path.join(HERE, "paper.yaml"), encoding="utf-8") as file:
            self.values = yaml.safe_load(file)
        self.examples = {}

    def path(self, *names):
        path = os.path.join(self.folder, *names)
        if not os.path.isfile(path):
            raise Missing(os.path.relpath(path, self.folder))
        return path

    def example(self, name):
        if not runs.variants(os.path.join(self.folder, name)):
            raise Missing(f"results in {name}")
        if name not in self.examples:
            self.examples[name] = runs.Example(name, os.path.join(self.folder, name))
        return self.examples[name]

    def label(self, example):
        """The run of the tables: that with MODES modes, else that with most."""
        wanted = f"modal_{MODES}"
        return wanted if wanted in example.labels else example.labels[-1]

    def reference(self, example):
        """The unreduced run, or nothing where there is none."""
        label = example.reference(self.label(example))
        return label if os.path.isfile(example.path(label + "_stress.h5")) else None

    def leading(self, example):
        """The run by which nodes are chosen: the unreduced one, else that of the tables."""
        return self.reference(example) or self.label(example)

    def labels(self, example):
        """The unreduced run, if there is one, and the reduced ones."""
        return [label for label in (self.reference(example),) if label] + example.labels

    def body(self, body):
        """The body file with most modes, else the unreduced one."""
        paths = glob.glob(os.path.join(self.folder, f"{body}_modal_*.h5"))
        return max(paths, key=lambda path: int(path[:-3].rsplit("_", 1)[1])) if paths else self.path(f"{body}_full.h5")

    def spots(self, name):
        """(body, node) of the stress evaluation of an example: at the roots and on the flanks."""
        example = self.example(name)
        with example.stress(self.leading(example)) as file:
            sets = [(body, set_name) for body, set_name, _ in results.stress_sets(file)]
        return [(body, self.spot(example, body, set_name)) for body, set_name in sorted(sets, key=lambda entry: (entry[0] == "wheel", entry[1] != "root"))]

    def spot(self, example, body, set_name):
        """The node of a set with the largest von Mises stress of the reference; of a root away from all contacts."""
        label = self.leading(example)
        with example.stress(label) as file:
            group = file[body][set_name]
            steps = runs.peak_steps(example, file["time"][:])[label.startswith("full")]
            stress, X, nodes = group["von_mises"][steps].max(axis=0), group["X"][:], group["nodes"][:]
        if set_name == "root":
            contacts = touching(example, label, body, self.body(body))
            far = np.array([np.linalg.norm(contacts - x, axis=1).min() > AWAY for x in X]) if len(contacts) else np.ones(len(X), dtype=bool)
            stress = np.where(far, stress, 0) if far.any() else stress
        return int(nodes[stress.argmax()])


def touching(example, label, body, body_file):
    """Positions (n x 3, m, body frame) of the nodes that carry a contact force at any time."""
    with example.result(label) as file:
        nodes = np.unique(file[f"bodies/{body}/contact_forces/node"][:])
    with results.open_file(body_file, "body") as file:
        return file["surface/X"][:][nodes]


def name_of(label):
    if label.startswith("full"):
        return "unreduced"
    basis, modes = label.rsplit("_", 1)
    return f"{modes} modes" + ("" if basis == "modal" else f", {basis}")


def picture(paper, name, caption):
    """A picture of scripts/pictures.py, smaller."""
    image = Image.open(paper.path("pictures", name + ".png")).convert("RGB")
    image.thumbnail((WIDTH, 4 * WIDTH))
    stream = io.BytesIO()
    image.save(stream, "WEBP", quality=82)
    return runs.image(stream.getvalue(), caption, "webp")


def diagrams(labels, panels):
    """One legend, and a diagram for each panel: (title, unit, [(time in ms, values)] of each label, in their order)."""
    styles = [runs.line_style(i if labels[0].startswith("full") else i + 1) for i in range(len(labels))]
    legend = "".join(f'<li><span style="border-color:{style["color"]}"></span>{html.escape(name_of(label))}</li>' for label, style in zip(labels, styles))
    shown = "".join(diagram(title, unit, curves, styles) for title, unit, curves in panels)
    return f'<ul class="curves">{legend}</ul><div class="panels">{shown}</div>'


def diagram(title, unit, curves, styles):
    figure, panel = runs.plt.subplots(figsize=PANEL)
    for (t, values), style in zip(curves, styles):
        panel.plot(t, values, **style)
    panel.set(xlabel="time in ms", ylabel=unit, title=title)
    return runs.picture(figure, f"{title} over the time")


# --- figures and tables, each a function of the folder that returns HTML


def tree_levels(paper):
    import pictures  # here, so that a list of the figures needs no VTK

    boxes = paper.path("impact", f"modal_{MODES}_worm_kdops.vtp")
    deepest = pictures.array(pictures.read(boxes).GetCellData(), "level", boxes).max()
    return picture(paper, "tree", f"K-DOPs around the worm's contact faces; the deepest leaves are on level {deepest}")


def overlaps(paper):
    return picture(paper, "overlaps", "Leaves of worm and wheel that overlap, whole and near")


def parts(paper):
    return picture(paper, "parts", "Worm and wheel with their mesh; restrained nodes in blue")


def model(paper):
    columns = []
    for body in BODIES:
        with results.open_file(paper.body(body), "body") as file:
            columns.append([file["mesh/X"].shape[0], file["mesh/cell_type"].shape[0], file["surface/face"].shape[0],
                            f"{file['material/0/E'][()].item() / 1e9:g} GPa", f"{file['material/0/nu'][()].item():g}", results.mode_count(file)])
    rows = [[name, *ours, *theirs] for (name, theirs), *ours in zip(paper.values["model"].items(), *columns)]
    return runs.table(["", "worm", "wheel", "worm, paper", "wheel, paper"], rows)


def setups(paper):
    return "".join(picture(paper, name, f"{letter}) {setup_caption(name)}") for letter, name in zip("abc", EXAMPLES))


def setup_caption(name):
    """What moves and loads each body, of the example's input file."""
    with open(os.path.join(runs.INPUT, name + ".yaml"), encoding="utf-8") as file:
        keys = yaml.safe_load(file)
    said = []
    for body in BODIES:
        what = [f"{abs(keys[body][key]):.4g} {unit}" for key, unit in (("torque", "N m"), ("omega0", "rad/s")) if key in keys[body]]
        said.append(f"{body} {'fixed' if keys[body]['joint'] == 'fixed' else ' and '.join(what)}")
    return f"{name.replace('_', '-')}: {', '.join(said)}"


def spots(paper):
    return picture(paper, "spots", "Nodes of stress evaluation")


def impact_forces(paper):
    example = paper.example("impact")
    labels, forces, speed = paper.labels(example), {}, []
    for label in labels:
        with example.result(label) as file:
            t, pair = file["time"][:] * 1e3, next(iter(file["contact"].values()))
            speed.append((t, file["bodies/wheel/rigid_velocity"][:, 0]))
            for area, force in results.group_forces(pair).items():
                forces.setdefault(area, []).append((t, force / 1e3))
    most = sorted(forces, key=lambda area: -max(force[t < runs.END_OF_REBOUND].max() for t, force in forces[area]))[:2]
    panels = [(f"force, {area.replace('_', ' ')}", "force in kN", forces[area]) for area in sorted(most)] + [("speed of the wheel", "speed in rad/s", speed)]
    return diagrams(labels, panels)


def histories(paper, example, body, node):
    """[(time in ms, n_t x 6 in MPa)] of all runs at a node."""
    found = []
    for label in paper.labels(example):
        with example.stress(label) as file:
            found.append((file["time"][:] * 1e3, results.chosen_node(file, body, node).tensor / 1e6))
    return found


def root_stresses(body):
    def figure(paper):
        example = paper.example("impact")
        node = paper.spot(example, body, "root")
        found = histories(paper, example, body, node)
        panels = [(f"{'normal' if i < 3 else 'shear'} stress {component}", "stress in MPa", [(t, tensor[:, i]) for t, tensor in found])
                  for i, component in enumerate(results.COMPONENTS)]
        return f"<p>Node {node} of the {body}.</p>" + diagrams(paper.labels(example), panels)
    return figure


def flank_stresses(paper):
    example = paper.example("impact")
    nodes = paper.spots("impact")[1::2]
    panels = [(f"{body} node {node}", "normal stress xx in MPa", [(t, tensor[:, 0]) for t, tensor in histories(paper, example, body, node)])
              for body, node in nodes]
    return diagrams(paper.labels(example), panels)


def times(paper):
    steps, theirs = paper.example("impact").steps(), paper.values["integration"]
    known = {"full": steps.get("simulate_full"), **{n: steps.get(f"simulate_modal_{n}") for n in theirs if n != "full"}}
    whole = known["full"][0] if known["full"] else None
    reduction = [figures[0] for name, figures in steps.items() if name.startswith("reduce_") and "modal" in name]
    rows = [["preprocessing, both bodies", f"{sum(reduction):.1f}" if reduction else "-", "", f"{paper.values['preprocessing']}", ""]]
    for n, figures in known.items():
        factor = f"{whole / figures[0]:.0f}" if whole and figures and n != "full" else ""
        rows.append(["unreduced" if n == "full" else f"{n} modes", f"{figures[0]:.1f}" if figures else "-", factor, f"{theirs[n]}",
                     "" if n == "full" else f"{theirs['full'] / theirs[n]:.0f}"])
    return runs.table(["", "CPU time in s", "times as fast", "paper, s", "times as fast, paper"], rows)


def deviations(example, run, reference, body, node):
    """Of all measures in percent, at a node."""
    steps = runs.peak_steps(example, run["time"][:])
    found = [results.chosen_node(file, body, node) for file in (run, reference)]
    ours, theirs = (np.array([*node.tensor[step][-1][PAPER_ORDER], node.von_mises[step][-1], node.rankine[step][-1]]) for node, step in zip(found, steps))
    return 100 * np.abs(ours - theirs) / np.abs(theirs)


def deviation_table(name):
    def table(paper):
        example = paper.example(name)
        label, reference = paper.label(example), paper.reference(example)
        if not reference:
            raise Missing("the unreduced run")
        rows, marked = [], []
        with example.stress(label) as run, example.stress(reference) as unreduced:
            for body in BODIES:
                node = paper.spot(example, body, "root")
                rows.append([f"{body} root node {node}, {name_of(label)}", *(f"{value:.2f}" for value in deviations(example, run, unreduced, body, node))])
                for number, known in paper.values["deviations"][name].get(body, {}).items():
                    marked.append(len(rows))
                    rows.append([f"paper, {body} node {number}, {MODES} modes", *(f"{value:.2f}" for value in known)])
        return f"<p>In percent of each component of the unreduced bodies{state_of(example, label)}.</p>" + runs.table(["", *runs.MEASURES], rows, marked)
    return table


def state_of(example, label):
    """The time of a rolling state."""
    if example.name != "rolling":
        return ""
    with example.stress(label) as file:
        return f", in the state at {1e3 * runs.rolling_state(file['time'][:]):.3g} ms"


def stress_pictures(paper):
    return picture(paper, "turn_in_unreduced", "Unreduced") + picture(paper, "turn_in_reduced", f"{MODES} modes")


def rolling_run(paper):
    example = paper.example("rolling")
    label = paper.label(example)
    node = paper.spot(example, "worm", "root")
    with example.result(label) as file, example.stress(label) as stress:
        t, pair = file["time"][:] * 1e3, next(iter(file["contact"].values()))
        speeds = [(f"speed of the {body}", "speed in rad/s", [(t, file[f"bodies/{body}/rigid_velocity"][:, 0])]) for body in BODIES]
        history = results.chosen_node(stress, "worm", node)
        panels = [("contact force", "force in kN", [(t, results.total_force(pair) / 1e3)]), *speeds,
                  (f"worm node {node}", "von Mises stress in MPa", [(stress["time"][:] * 1e3, history.von_mises / 1e6)])]
        doubt = results.standstill(file)
    turns = f"<p>{html.escape(doubt[0].upper() + doubt[1:])}.</p>" if doubt else ""
    return turns + diagrams([label], panels)


FUNCTIONS = {"Fig. 3": tree_levels, "Fig. 4": overlaps, "Fig. 6": parts, "Tab. 1": model, "Fig. 7": setups, "Fig. 8": spots, "Fig. 9": impact_forces,
             "Fig. 10": root_stresses("worm"), "Fig. 11": root_stresses("wheel"), "Fig. 12": flank_stresses, "Tab. 2": times,
             "Tab. 3": deviation_table("turn_in"), "Fig. 13": stress_pictures, "Tab. 4": deviation_table("rolling"), "Fig. 14": rolling_run}


# --- the page


def titles():
    return [(part["name"], part["title"]) for part in Paper("").values["parts"]]


def section(paper, part):
    try:
        shown = FUNCTIONS[part["name"]](paper)
    except Missing as missing:
        shown = f"<p>Not computed: {html.escape(str(missing))} is not there.</p>"
    return (f'<section id="{anchor(part)}"><h2>{html.escape(part["name"])}: {html.escape(part["title"])}</h2>{shown}'
            f'<dl><dt>The paper</dt><dd>{html.escape(part["paper"])}</dd><dt>Why ours differs</dt><dd>{html.escape(part["why"])}</dd></dl></section>')


def anchor(part):
    return part["name"].lower().replace(". ", "-")


def cpu_time(folder):
    """s, of all steps."""
    total = 0.0
    for path in glob.glob(os.path.join(folder, "steps.csv")) + glob.glob(os.path.join(folder, "*", "steps.csv")):
        with open(path, encoding="utf-8", newline="") as file:
            total += sum(float(row[1]) for row in csv.reader(file))
    return total


def summary(paper):
    try:
        example = paper.example("turn_in")
        with example.result(paper.label(example)) as file:
            version = results.text(file["provenance"].attrs["program_version"]) + ", revision " + results.text(file["provenance"].attrs["git_hash"])[:12]
    except Missing:
        version = "unknown"
    return (f"<p>C. Pfister, J. Pfister, L. Kazaz, P. Eberhard, <em>Stress calculation in worm gears using elastic multibody models</em>. The settings are the "
            "paper's: eigenmodes alone, 100, 500, 1000 and 2000 of them a body, contact by a penalty between nodes and faces. The gears are those of a reference "
            "drive of the same kind, since the paper's are not public. The reference in all figures are unreduced bodies in the same program, where the paper "
            f"took a commercial finite-element program.</p><p>Version {html.escape(version)}. All steps took {cpu_time(paper.folder) / 60:.1f} min of CPU time.</p>")


def write(folder, size):
    paper = Paper(folder, size)
    known = paper.values["parts"]
    shown = []
    for part in known:
        print(f"{part['name']}: {part['title']}", flush=True)
        shown.append(section(paper, part))
    links = "".join(f'<li><a href="#{anchor(part)}">{part["name"]}: {html.escape(part["title"])}</a></li>' for part in known)
    page = report.fill(report.template("paper.html"), {"size": size, "summary": summary(paper), "list": links, "parts": "".join(shown)})
    os.makedirs(folder, exist_ok=True)
    report.write(os.path.join(folder, "paper.html"), page)
