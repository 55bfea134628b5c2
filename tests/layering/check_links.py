"""Checks the documents of a repository: every relative link leads to a file, every anchor to a heading (by GitHub's rules), and
every place `file:name` to a file of the repository that holds the name. Usage: check_links.py REPOSITORY
"""
import glob
import os
import re
import sys

LINK = re.compile(r"\]\(([^)\s]+)\)")
PAGES = ("*.md", "docs/*.md", "docs/*/*.md", "*/README.md", "examples/*/README.md", ".github/*.md", ".github/*/*.md")
PLACE = re.compile(r"`((?:src|include|tests|scripts|studies|examples)/[\w./]+):([\w:~]+)`")
HEADING = re.compile(r"^#{1,6}\s+(.*?)\s*#*$")


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def anchors(text):
    """Anchors of all headings outside of code."""
    found, code = [], False
    for line in text.splitlines():
        code ^= line.startswith("```")
        heading = HEADING.match(line)
        if heading and not code:
            words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1]).lower()
            anchor = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
            before = sum(name == anchor or re.fullmatch(re.escape(anchor) + r"-\d+", name) is not None for name in found)
            found.append(f"{anchor}-{before}" if before else anchor)
    return set(found)


def dead_links(path):
    """What the links of a page lead to that is not there."""
    dead = []
    for target in LINK.findall(re.sub(r"^    .*$", "", read(path), flags=re.MULTILINE)):
        file, _, anchor = target.partition("#")
        goal = os.path.normpath(os.path.join(os.path.dirname(path), file)) if file else path
        if re.match(r"[a-z]+:", target):
            continue
        if not os.path.exists(goal) or (anchor and anchor not in anchors(read(goal))):
            dead.append(target)
    return dead


def dead_places(path, repository):
    """Places in the code that a page names and that are not there: the last part of a name must stand in the file."""
    dead = []
    for file, name in PLACE.findall(read(path)):
        goal = os.path.join(repository, file)
        if not os.path.exists(goal) or not re.search(rf"\b{re.escape(name.split('::')[-1])}\b", read(goal)):
            dead.append(f"{file}:{name}")
    return dead


def check(repository):
    """All complaints about the pages of a repository."""
    pages = sorted(page for place in PAGES for page in glob.glob(os.path.join(repository, place)))
    return [f"{os.path.relpath(page, repository)}: there is no {what}"
            for page in pages for what in dead_links(page) + dead_places(page, repository)]


if __name__ == "__main__":
    complaints = check(sys.argv[1])
    print("\n".join(complaints) or "all links and places hold")
    sys.exit(bool(complaints))
