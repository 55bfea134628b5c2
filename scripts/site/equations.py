"""Extension of Sphinx: numbered equations of docs/theory can be led to, and say which code computes them."""
import json
import re
from pathlib import Path

from docutils import nodes

import links
from citations import places
from check_citations import TAG  # found through citations

LEADING = re.compile(r"[\w:~]*::")


class Declarations:
    """Where the pages of headers show what is declared: by file, (line, name, anchor)."""

    def __init__(self, path):
        self.by_file = json.loads(Path(path).read_text(encoding="utf-8"))

    def anchor(self, path, name, line):
        """Of the declaration of a name in some lines from a line (its index) on, None where there is none."""
        header = path.replace("include/", "", 1)
        near = [(abs(at - line - 1), anchor) for at, other, anchor in self.by_file.get(header, []) if other == name]
        return min(near)[1] if near and min(near)[0] <= 6 else None


def page_of(path):
    return "api/cpp/" + path.replace("include/elastogear/", "", 1)[:-2]


def reference(declarations, path, name, line):
    """A link to what cites an equation: on the page of its header, or in the source."""
    shown = LEADING.sub("", name) if name else path.split("/")[-1]
    anchor = declarations.anchor(path, name, line) if name else ""
    node = nodes.reference("", "", nodes.literal("", shown), internal=True, refuri="")
    node["elastogear"] = (page_of(path), anchor) if path.startswith("include/") and anchor is not None else (f"code:{path}:{line + 1}", "")
    return node


def code_of(declarations, cited_at):
    """A line that lists what cites an equation, by file."""
    files = {}
    for path, name, line in cited_at:
        files.setdefault(path, []).append((name, line))
    line = nodes.paragraph(classes=["computed-by"])
    for path, entries in files.items():
        line += nodes.Text("; " if len(line) else "Code: ")
        for index, (name, at) in enumerate(entries):
            line += [nodes.Text(", ")] if index else []
            line += reference(declarations, path, name, at)
        line += nodes.Text(f" in {re.sub('^(include/elastogear|src)/', '', path)}")
    return line


def number_equations(app, doctree):
    cited = places() if app.env.docname.startswith(links.THEORY) else {}
    declarations = Declarations(Path(app.srcdir, "declarations.json")) if cited else None
    for equation in list(doctree.findall(nodes.math_block)):
        tag, text = TAG.search(equation.astext()), equation.astext().strip()
        equation["nowrap"] = True
        equation.children = [nodes.Text(f"\\[{text}\\]")]
        if tag:
            equation["ids"].append(links.equation_id(tag[1]))
            equation["classes"].append("equation")
        if tag and cited.get(tag[1]):
            equation.parent.insert(equation.parent.index(equation) + 1, code_of(declarations, cited[tag[1]]))


def setup(app):
    app.connect("doctree-read", number_equations)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
