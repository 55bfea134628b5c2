"""Checks the pages that scripts/site/make.py has made: check_site.py FOLDER/html REPOSITORY

- Every link leads to a page and a place on it; nothing comes from a network.
- Every equation of docs/theory can be led to, and says which code computes it, unless it is of a derivation.
- Every citation of an equation in a public header is a link on the header's page.
- All that `import elastogear` gives is on the page of the Python module.
"""
import html
import os
import re
import sys
from pathlib import Path
from urllib.parse import unquote

REFERENCE = re.compile(r'<(?!/)(\w+)[^>]*?\s(?:href|src)="([^"]*)"')
ANCHOR = re.compile(r'\s(?:id|name)="([^"]+)"')
EQUATION = re.compile(r'<div class="[^"]*equation[^"]*" id="(eq-[\w-]+)">(.*?)</div>\s*(<p class="computed-by">)?', re.DOTALL)
BREADTH = 20  # messages


class Pages:
    def __init__(self, root):
        self.root = Path(root)
        self.text = {path.relative_to(root).as_posix(): path.read_text(encoding="utf-8") for path in self.root.rglob("*.html")
                     if "_static" not in path.parts}
        self.anchors = {name: set(map(html.unescape, ANCHOR.findall(text))) for name, text in self.text.items()}

    def dead(self):
        """Links that lead nowhere or to a network, each once."""
        for page, text in self.text.items():
            for element, link in set(REFERENCE.findall(text)):
                file, _, anchor = unquote(html.unescape(link)).partition("#")
                if re.match(r"https?:|//", file):
                    if element != "a":
                        yield f"{page}: takes {link} from a network"
                    continue
                if re.match(r"[a-z]+:", file):
                    yield from [] if file.startswith(("data:", "mailto:")) else [f"{page}: {link}"]
                    continue
                goal = os.path.normpath(os.path.join(os.path.dirname(page), file.partition("?")[0])) if file else page
                if goal in self.anchors:
                    if anchor and anchor not in self.anchors[goal]:
                        yield f"{page}: {link} has no such place"
                elif not (self.root / goal).exists():
                    yield f"{page}: {link} is not there"


def equations(pages, tags, exempt):
    """What is wrong with the numbered equations of the theory."""
    chapters = "".join(text for page, text in pages.text.items() if page.startswith("docs/theory/"))
    found = {place: bool(code) for place, _, code in EQUATION.findall(chapters)}
    for tag in tags:
        code = found.get("eq-" + tag.replace(".", "-"))
        if code is None:
            yield f"docs/theory: equation ({tag}) has no place"
        elif code == (tag in exempt):
            yield f"docs/theory: equation ({tag}) {'names code' if code else 'names no code'}"


def citations(pages, repository, cited_lines):
    """Equations that a public header cites without a link on its page."""
    for header in sorted((repository / "include/elastogear").rglob("*.h")):
        name = header.relative_to(repository / "include/elastogear").with_suffix(".html").as_posix()
        text = pages.text.get(f"api/cpp/{name}")
        if text is None:
            yield f"api/cpp/{name}: there is no such page"
            continue
        numbers = set().union(*cited_lines(header.read_text(encoding="utf-8")).values())
        yield from (f"api/cpp/{name}: no link to equation ({number})" for number in sorted(numbers)
                    if f".html#eq-{number.replace('.', '-')}\"" not in text)


def module(pages):
    import elastogear
    for name in elastogear.__all__:
        if not name.startswith("__") and name != "git_hash" and f"elastogear.{name}" not in pages.anchors["api/python.html"]:
            yield f"api/python.html: elastogear.{name} is missing"


def main(folder, repository):
    sys.path[:0] = [str(repository / "scripts/site"), str(repository / "tests/layering")]
    from check_citations import NOT_IMPLEMENTED
    from citations import TAGS, cited_lines
    pages = Pages(folder)
    wrong = [*pages.dead(), *equations(pages, TAGS, NOT_IMPLEMENTED), *citations(pages, repository, cited_lines), *module(pages)]
    print("\n".join(wrong[:BREADTH]) or f"all links of {len(pages.text)} pages hold")
    return min(len(wrong), 1)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), Path(sys.argv[2])))
