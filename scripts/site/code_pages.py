"""Extension of Sphinx: pages of the sources that others lead to, with numbered lines, and links from their citations."""
import html
import re

from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import get_lexer_for_filename
from pygments.lexers.special import TextLexer
from pygments.util import ClassNotFound

import links
from citations import ROOT, cited_lines, places, source_files

HIDDEN = {"__pycache__", "node_modules"}
LINE = re.compile(r'<span id="line-(\d+)">')


def line_of(path, name):
    """The first line of a file that holds a name and is no comment, else the first that holds it."""
    lines = (ROOT / path).read_text(encoding="utf-8").split("\n")
    holding = [i + 1 for i, line in enumerate(lines) if re.search(rf"\b{re.escape(name)}\b", line)]
    defining = [i for i in holding if re.search(rf"^[\w ].*\b{re.escape(name)}\b *[({{=]", lines[i - 1]) and not lines[i - 1].rstrip().endswith(";")]
    return next(iter(defining or holding), 1)


def address(app, place):
    """Page and anchor of PATH, PATH:NAME or PATH:LINE, which is marked as wanted."""
    path, _, name = place.partition(":")
    path = path.rstrip("/")
    if not (ROOT / path).exists():
        raise FileNotFoundError(f"{path}: a page leads there")
    return f"code/{path}", f"line-{name if name.isdigit() else line_of(path, name)}" if name else ""


def files_of(folder):
    return sorted(path for path in (ROOT / folder).rglob("*") if path.is_file() and not HIDDEN & set(path.parts) and path.suffix not in (".png", ".pyc"))


def wanted(app):
    """Paths of all files and folders that have a page: public headers, what cites equations, and what the documents lead to."""
    found = {path for path in source_files() if path.startswith("include/")} | {path for cited in places().values() for path, _, _ in cited}
    for page in app.env.all_docs:
        source = app.env.doc2path(page)
        with open(source, encoding="utf-8") as file:
            found.update(place.split(":")[0].rstrip("/") for place in re.findall(r"\(code:([^)\s]+)\)|<code:([^>]+)>", file.read()) for place in place if place)
    for folder in [path for path in found if (ROOT / path).is_dir()]:
        found.update(path.relative_to(ROOT).as_posix() for path in files_of(folder))
    return sorted(found)


def with_links(app, name, path, text, marked):
    """Highlighted lines, whose numbers of equations lead to the theory."""
    at = cited_lines(text) if path.endswith((".h", ".cpp")) else {}
    lines = marked.split("\n")
    for index, line in enumerate(lines):
        number = LINE.search(line)
        for equation in at.get(int(number[1]) - 1, ()) if number else ():
            if equation not in links.EQUATIONS:
                continue
            chapter = app.builder.get_relative_uri(name, links.EQUATIONS[equation])
            line = line.replace(f"({equation})", f'<a href="{chapter}#{links.equation_id(equation)}">({equation})</a>')
        lines[index] = line
    return "\n".join(lines)


def listing(app, name, path):
    rows = [file.relative_to(ROOT / path).as_posix() for file in files_of(path)]
    return "<ul>" + "".join(f'<li><a href="{app.builder.get_relative_uri(name, f"code/{path}/{row}")}">{html.escape(row)}</a></li>' for row in rows) + "</ul>"


def source(app, name, path):
    text = (ROOT / path).read_text(encoding="utf-8")
    try:
        lexer = get_lexer_for_filename(path if not path.endswith(".h") else "header.hpp")
    except ClassNotFound:
        lexer = TextLexer()
    marked = highlight(text, lexer, HtmlFormatter(linenos="inline", linespans="line", anchorlinenos=True, lineanchors="line", cssclass="highlight"))
    api = f"api/cpp/{path[len('include/elastogear/'):-2]}" if path.startswith("include/elastogear/") else None
    above = f'<p><a href="{app.builder.get_relative_uri(name, api)}">Interface</a></p>' if api else ""
    return above + with_links(app, name, path, text, marked)


def collect(app):
    for path in wanted(app):
        name = f"code/{path}"
        body = listing(app, name, path) if (ROOT / path).is_dir() else source(app, name, path)
        yield name, {"title": path, "body": f"<h1>{html.escape(path)}</h1>\n{body}"}, "code.html"


def setup(app):
    app.connect("html-collect-pages", collect)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
