"""Extension of Sphinx: docstrings, which are plain text with columns, as reStructuredText."""
import re

ROW = re.compile(r"^(\S.*?) {2,}(\S.*)$")
SPECIAL = re.compile(r"([*_|\\])")
CODE = re.compile(r"`([^`]+)`")


def escaped(text):
    """A text whose code stays code and whose other signs stand for themselves."""
    parts = CODE.split(text)
    return "".join(f"``{part}``" if i % 2 else SPECIAL.sub(r"\\\1", part) for i, part in enumerate(parts))


def rows(lines):
    """A paragraph in two columns as a list of definitions; the second may go on below."""
    out = []
    for line in lines:
        row = ROW.match(line)
        out += [f"``{row[1]}``", f"   {escaped(row[2])}"] if row else [f"   {escaped(line.strip())}"]
    return out


def restructured(lines):
    """The lines of a docstring; deeper paragraphs are code, those of two columns lists."""
    out, paragraph = [], []
    for line in [*lines, ""]:
        if line.strip():
            paragraph.append(line)
            continue
        if not paragraph:
            continue
        if all(line.startswith("    ") for line in paragraph):
            out += ["::", "", *paragraph, ""]
        elif ROW.match(paragraph[0]):
            out += [*rows(paragraph), ""]
        else:
            out += [*map(escaped, paragraph), ""]
        paragraph = []
    return out


def process(app, what, name, thing, options, lines):
    lines[:] = restructured(lines)


def setup(app):
    app.connect("autodoc-process-docstring", process)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
