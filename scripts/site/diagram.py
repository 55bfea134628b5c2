"""Extension of Sphinx: flow charts of the documents, which GitHub draws by mermaid, drawn by Graphviz."""
import re

from docutils import nodes
from sphinx.ext.graphviz import graphviz

NODE = re.compile(r"(\w+)(?:\[\(\"(.+?)\"\)\]|\[(.+?)\])?")
EDGE = re.compile(r"^\s*(.+?) --(?: \"(.+?)\" --)?> (.+?)\s*$")


def label(text):
    return text.replace("<br/>", "\\n")


def dot(chart):
    """Nodes `a[label]` and `a[("label")]`, joined by `-- "label" -->` or `-->`, several by `&`, as a graph of Graphviz."""
    shapes, edges = {}, []

    def names(text):
        for name, file, plain in (NODE.match(part.strip()).groups() for part in text.split("&")):
            if file or plain:
                shapes[name] = f'{name} [label="{label(file or plain)}"{", shape=cylinder" if file else ""}]'
            yield name

    for line in chart.split("\n"):
        edge = EDGE.match(line)
        if edge:
            sources, targets = list(names(edge[1])), list(names(edge[3]))
            edges += [f'{a} -> {b} [label="{label(edge[2] or "")}"]' for a in sources for b in targets]
    style = 'rankdir=LR; bgcolor=transparent; node [shape=box, style=filled, fillcolor=white, fontname="sans-serif", fontsize=12]; '
    return "digraph {" + style + 'edge [fontname="sans-serif", fontsize=11]; ' + "; ".join([*shapes.values(), *edges]) + "}"


def draw(app, doctree):
    for block in list(doctree.findall(nodes.literal_block)):
        if block.get("language") == "mermaid":
            node = graphviz()
            node["code"], node["options"], node["alt"] = dot(block.astext()), {}, "Flow chart"
            block.replace_self(node)


def setup(app):
    app.connect("doctree-read", draw)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
