"""Extension of Sphinx: what texts say of documents, sections, equations and code becomes links.

- `Eq` with a dot and a number leads to the equation in docs/theory; so does a bare (n.m) in the documents, where it is the
  number of an equation. A number that no equation has is a warning.
- docs/PAGE.md, docs/theory and "section n.m" lead to the page and its section.
- Links to code:PATH and code:PATH:NAME lead to the pages of sources (code_pages.py).
"""
import re

from docutils import nodes
from sphinx import addnodes
from sphinx.util import logging

from citations import CITATION, NUMBER, ROOT, TAGS
from check_citations import TAG  # found through citations

THEORY = "docs/theory/"
SECTION = re.compile(r"^#+ (\d+(?:\.\d+)?) ", re.MULTILINE)
CHAPTERS = {f"{THEORY}{path.stem}": path.read_text(encoding="utf-8") for path in sorted((ROOT / THEORY).glob("*.md"))}
SECTIONS = {number: page for page, text in CHAPTERS.items() for number in SECTION.findall(text)}  # by number: its page
EQUATIONS = {number: page for page, text in CHAPTERS.items() for number in TAG.findall(text)}
BARE = re.compile(r"\((\d+\.\d+[a-z]?)\)")
PAGE = re.compile(r"\bdocs/(?:((?:\w+/)?\w+)\.md|theory)\b(?!/)")
IN_SECTION = re.compile(r"\bsections?\s+((?:\d+(?:\.\d+)?(?:,\s+|\s+and\s+|\s+to\s+)?)+)(?![\d.]*\d)")
NO_LINKS = (nodes.literal, nodes.literal_block, nodes.reference, nodes.title, nodes.raw, nodes.comment, nodes.math,
            nodes.math_block, addnodes.desc_signature, addnodes.pending_xref, addnodes.toctree)
NO_EQUATIONS = "docs/examples"  # has factors of time in brackets, which look like numbers of equations
log = logging.getLogger(__name__)


def equation_id(number):
    return "eq-" + number.replace(".", "-")


def section_id(number):
    return "section-" + number.replace(".", "-")


def after_other_page(text, at):
    """Does a section belong to a page other than the theory, which is named before it?"""
    page = re.search(r"(\w+)\.md,\s*$", text[:at])
    return page is not None


def found_in(text, docname, of_theory, warn):
    """(start, end, page, anchor) of all that becomes a link; of_theory: sections are those of the theory."""
    found = {}
    for citation in CITATION.finditer(text):
        for number in NUMBER.finditer(citation[1]):
            if number[1] not in TAGS:
                warn(f"docs/theory has no equation ({number[1]})")
                continue
            start = citation.start(1) + number.start()
            found[start] = (start, start + len(number[0]), EQUATIONS[number[1]], equation_id(number[1]))
    if docname.startswith("docs/") and docname != NO_EQUATIONS:
        for number in BARE.finditer(text):
            if number[1] in TAGS:
                found[number.start()] = (*number.span(), EQUATIONS[number[1]], equation_id(number[1]))
    for page in PAGE.finditer(text):
        if (ROOT / page[0]).exists():
            found[page.start()] = (*page.span(), f"docs/{page[1]}" if page[1] else f"{THEORY}README", "")
    for section in IN_SECTION.finditer(text):
        if of_theory and not after_other_page(text, section.start()):
            for number in re.finditer(r"\d+(?:\.\d+)?", section[1]):
                start = section.start(1) + number.start()
                if number[0] in SECTIONS:
                    found[start] = (start, start + len(number[0]), SECTIONS[number[0]], section_id(number[0]))
    return [found[start] for start in sorted(found)]


def link(text, page, anchor):
    node = nodes.reference("", text, internal=True, refuri="")
    node["elastogear"] = (page, anchor)
    return node


def follows_theory(text):
    """Does a text follow a link to the theory: "[theory](theory/README.md), sections 4.3 and 4.4"?"""
    siblings = text.parent.children
    before = siblings[siblings.index(text) - 1] if siblings.index(text) > 0 else None
    return before is not None and before.astext() == "theory"


def add_links(app, doctree):
    docname = app.env.docname
    of_code = docname.startswith("api/")
    for text in list(doctree.findall(nodes.Text)):
        parents, parent = [], text.parent
        while parent is not None:
            parents.append(parent)
            parent = parent.parent
        if any(isinstance(parent, NO_LINKS) for parent in parents):
            continue
        content = text.astext()
        of_theory = of_code or docname.startswith(THEORY) or follows_theory(text)
        parts, at = [], 0
        for start, end, page, anchor in found_in(content, docname, of_theory, lambda m, t=text: log.warning(m, location=t.parent)):
            parts += [nodes.Text(content[at:start]), link(content[start:end], page, anchor)]
            at = end
        if parts:
            text.parent.replace(text, [*parts, nodes.Text(content[at:])])
    for reference in doctree.findall(nodes.reference):
        if reference.get("refuri", "").startswith("code:"):
            reference["elastogear"] = (reference["refuri"], "")
            reference["internal"] = True


def add_section_ids(app, doctree):
    if app.env.docname.startswith(THEORY):
        for section in doctree.findall(nodes.section):
            number = re.match(r"(\d+(?:\.\d+)?) ", section.next_node(nodes.title).astext())
            if number:
                section["ids"].append(section_id(number[1]))


def resolve(app, doctree, docname):
    from code_pages import address
    for reference in doctree.findall(nodes.reference):
        if "elastogear" in reference:
            page, anchor = reference["elastogear"]
            if page.startswith("code:"):
                page, anchor = address(app, page[len("code:"):])
            reference["refuri"] = app.builder.get_relative_uri(docname, page) + (f"#{anchor}" if anchor else "")


def setup(app):
    app.connect("doctree-read", add_section_ids)
    app.connect("doctree-read", add_links)
    app.connect("doctree-resolved", resolve)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
