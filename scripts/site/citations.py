"""Where the code cites equations of docs/theory, and what is declared there."""
import functools
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/layering"))
from check_citations import CODE, EQUATIONS, cited, tags_of, theory  # noqa: E402  (found through the line above)

TAGS = tags_of(theory(ROOT))
MARGIN = re.compile(r"\n[ \t]*(?:///?<?|#)?[ \t]*")  # the end of a line of a comment, and the margin of the next
CITATION = re.compile(EQUATIONS.pattern.replace(" ?", r"\s*"))
NUMBER = re.compile(r"\(([\d.]+[a-z]?)\)")
COMMENT = re.compile(r"\s*//")
TYPE = re.compile(r"\b(?:struct|class|enum class|enum|using)\s+(\w+)")
CALL = re.compile(r"([\w:~]*\boperator\S+|[\w:~]+)\s*\(")
VARIABLE = re.compile(r"(\w+)\s*(?:=|;|\{|\[)")
NO_FUNCTION = {"if", "for", "while", "switch", "return", "sizeof", "decltype", "requires", "alignas", "static_assert"}


def source_files():
    """Paths of all sources, from the top of the repository."""
    for folder in CODE:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                yield path.relative_to(ROOT).as_posix()


def citations(text):
    """(index of the line, number of the equation) of each number that is cited; ends of ranges stand for all between."""
    flat = MARGIN.sub(lambda margin: " " * len(margin[0]), text)
    for citation in CITATION.finditer(flat):
        known = set()
        for number in NUMBER.finditer(citation[1]):
            line = text.count("\n", 0, citation.start(1) + number.start())
            passage = re.sub(r"\s+", " ", citation[1][:number.end()])
            for equation in cited(passage, TAGS):
                if equation not in known:
                    known.add(equation)
                    yield line, equation


def declared_name(code):
    """The name that a declaration or definition introduces, None where it is none."""
    head = re.split(r"[;{]", re.sub(r"template\s*<[^>]*>", "", code))[0]
    of_type = TYPE.search(head)
    if of_type:
        return of_type[1]
    for call in CALL.finditer(head):
        if call[1] not in NO_FUNCTION:
            return call[1]
    of_variable = VARIABLE.search(code)
    return of_variable[1] if of_variable else None


def enclosing(lines, at):
    """Index of the line at whose left margin the definition around line `at` begins, None outside of any."""
    for index in range(at, -1, -1):
        if re.match(r"[A-Za-z]", lines[index]):
            return None if lines[index].startswith("namespace") else index
        if lines[index].startswith("}"):
            return None
    return None


def declaration(lines, at):
    """(name, index of its line) of what the comment in line `at` is about; no name for comments on a whole file."""
    code = at
    while code < len(lines) and COMMENT.match(lines[code]):
        code += 1
    if code == len(lines) or not lines[code].strip() or lines[code].startswith("#"):
        return None, at
    outer = enclosing(lines, code)
    in_function = outer is not None and outer != code and not TYPE.search(lines[outer])
    line = outer if in_function else code
    return declared_name(" ".join(lines[line:line + 6])), line


@functools.cache
def places():
    """By equation: (file, name or None, index of the line) of what cites it, each file and name once."""
    found = {tag: {} for tag in TAGS}
    for path in source_files():
        text = (ROOT / path).read_text(encoding="utf-8")
        lines = text.split("\n")
        for line, equation in citations(text):
            if equation in found:
                name, start = declaration(lines, line)
                found[equation].setdefault((path, name), start)
    return {tag: [(path, name, line) for (path, name), line in places.items()] for tag, places in found.items()}


def cited_lines(text):
    """By index of a line: the equations that are named in it as parts of a citation."""
    flat, found = MARGIN.sub(lambda margin: " " * len(margin[0]), text), {}
    for citation in CITATION.finditer(flat):
        for number in NUMBER.finditer(citation[1]):
            found.setdefault(text.count("\n", 0, citation.start(1) + number.start()), set()).add(number[1])
    return found
