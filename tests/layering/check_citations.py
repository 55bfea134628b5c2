"""Reads what comments cite of docs/ and reports citations that lead nowhere, numbers that two equations have, and equations that no
code cites.

An equation is cited as `Eq` with a dot and a number that stands in a \\tag of docs/theory, several as `Eqs`, a
range by "to"; a section by its page (docs/theory for all chapters) and its number, or by its name where the page has no numbers.
Usage: check_citations.py REPOSITORY
"""
import pathlib
import re
import sys

NOT_IMPLEMENTED = ["3.5", "3.22", "6.16", "6.22", "9.1"]  # derivation
CODE = ("src", "include")  # equations must be cited here, and may be elsewhere
TAG = re.compile(r"\\tag\{([^}]+)\}")
HEADING = re.compile(r"^#+ (.+)$", re.MULTILINE)
LINE_BREAK = re.compile(r"\s*\n\s*(?:///?<?|#)?\s*")
EQUATIONS = re.compile(r"\bEqs?\.((?: ?(?:,|to|and)? ?\(\d+\.\d+[a-z]?\))*)")
SECTIONS = re.compile(r"\b((?:\w+/)?\w+\.md|docs/theory), sections? ([\w.]*\w)(?: and ([\w.]*\w))?")


def read(*path):  # empty when there is no such file
    path = pathlib.Path(*path)
    return path.read_text(encoding="utf-8") if path.exists() else ""


def theory(repository):  # the text of all chapters
    return "\n".join(read(path) for path in sorted(pathlib.Path(repository, "docs/theory").glob("*.md")))


def tags_of(text):  # the numbers of equations, ascending
    return sorted(TAG.findall(text), key=lambda tag: [int(part) for part in re.findall(r"\d+", tag)] + [tag])


def source_files(repository):
    for root in CODE + ("tests", "scripts", "studies"):
        for path in sorted(pathlib.Path(repository, root).rglob("*")):
            if path.suffix in (".h", ".cpp", ".py", ".sh"):
                yield path.relative_to(repository).as_posix()


def cited(numbers, tags):  # the equations of one citation, ranges in full
    found = []
    for is_end, number in re.findall(r"(to )?\(([^)]+)\)", numbers):
        is_range = is_end and found[-1] in tags and number in tags
        found += tags[tags.index(found[-1]) + 1:tags.index(number) + 1] if is_range else [number]
    return found


def violations(repository):
    """One message per citation that leads nowhere and per equation that is not cited as it should be."""
    equations_text = theory(repository)
    tags, found, in_code = tags_of(equations_text), [], set()
    for path in source_files(repository):
        text = LINE_BREAK.sub(" ", read(repository, path))
        for equations in (cited(numbers, tags) for numbers in EQUATIONS.findall(text)):
            in_code.update(equations if path.startswith(CODE) else [])
            found += [f"{path}: docs/theory has no equation ({e})" for e in equations or ["?"] if e not in tags]
        for page, *sections in SECTIONS.findall(text):
            place = page if page == "docs/theory" else f"docs/{page.removeprefix('docs/')}"
            headings = HEADING.findall(equations_text if page == "docs/theory" else read(repository, place))
            found += [f"{path}: {place} has no section {s}" for s in sections
                      if s and not any(re.match(re.escape(s) + r"\b(?!\.)", heading) for heading in headings)]
    found += [f"docs/theory numbers two equations ({t})" for t in sorted(set(tags)) if tags.count(t) > 1]
    found += [f"no code cites equation ({t})" for t in tags if t not in in_code and t not in NOT_IMPLEMENTED]
    return found + [f"equation ({t}) of NOT_IMPLEMENTED is cited" for t in NOT_IMPLEMENTED if t in in_code]


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: check_citations.py REPOSITORY")
    sys.exit("\n".join(violations(sys.argv[1])) or print("all citations lead somewhere"))
