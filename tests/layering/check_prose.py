"""Reads the documents and reports words of a private vocabulary, sentences that are too long, and lines that are too wide. Of the
program's sources it reads the texts in quotation marks, for the words, and the comments, for some of them; of Python all strings.

A sentence counts code, formulas, links and references to literature as few words, as one reads them. Tables, code and
headings are no prose. Usage: check_prose.py REPOSITORY [PAGE ...], where pages are shown with all their long sentences.
"""
import ast
import pathlib
import re
import statistics
import sys

PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/*.md", "docs/*/*.md", "examples/README.md", "studies/README.md")
MEDIAN, LONGEST, WIDTH = 20, 40, 120  # words, words, characters
IN_COMMENTS = {  # what is not said, and the field's word
    r"looks? at the surfaces": "contact detection",
    r"come into touch|came into touch": "new contacts",
    r"com(e|es|ing) and go(es|ing)?\b|to and fro": "chattering of the active set",
    r"points? of least gap": "local minimum-gap points",
    r"states? of rest\b": "static equilibria",
    r"open (ends?|sides?)\b": "free boundary, side of the boundary",
    r"deep within each other|deep in each other": "penetrate",
    r"flank approach|local approach": "local contact compliance",
    r"bod(y|ies) that repeats?|repeating bod(y|ies)": "cyclically symmetric bodies",
    r"\bbod(y|ies) that relax(es)?\b(?! in one)|relaxing bod(y|ies)": "viscoelastic bodies",
    r"contacts go that pull|that would be entered": "active-set update",
    r"softer contact": "a smaller `contact_stiffness`",
}
SAY = IN_COMMENTS | {  # the same, of documents and messages
    r"(a|another|more|fewer|each|less|two) looks?\b(?! at (the )?(page|picture|table|file))": "contact detection",
    r"forces (do not )?turn at once": "rotation of contact forces: coupled, frozen",
    r"\bbears?\b|\bpairs bearing\b": "is loaded, active, carries",
    r"\bown approach of\b": "local contact compliance",
    r"what is left\b(?! out)": "residual",
    r"(is|are|was|were) told\b(?! apart)|tells? of\b": "is reported",
    r"read off a drive": "results of a drive",
    r"\b(in|within) (a )?windows?\b|windows? of (modes|the s)": "interval of the spectrum",
    r"part by part": "nested dissection",
    r"come together": "converge",
}
SOURCES = ("src/**/*.cpp", "src/**/*.h", "include/**/*.h")
SCRIPTS = ("scripts/page/*.py", "python/elastogear/*.py")
LITERAL = re.compile(r'"(?:[^"\\\n]|\\.)*"(?:\s*"(?:[^"\\\n]|\\.)*")*')  # with those that follow, which are one text
REFERENCE = re.compile(r"\([^()]*\((?:18|19|20)\d\d\)[^()]*\)")
ABBREVIATION = re.compile(r"(?:(?<!\d )\b[A-Z]|\b(?:Eqs?|Fig|Figs|Tab|No|vol|pp|ed|et al|e\.g|i\.e|cf|Int|Numer|Meth|Eng|Engng|Comput|Appl|Mech|Soc|Chem|Am))\.$")
FORMULA = re.compile(r"\n*\$\$(.*?)\$\$\n*", re.DOTALL)


def is_prose(line):
    return not line.startswith(("    ", "|", "#", "<"))


def formula(match):  # goes on with its sentence, unless a full stop ends it
    return " term.\n\n" if re.sub(r"\\tag\{[^}]*\}", "", match[1]).rstrip(" ,").endswith(".") else " term "


def paragraphs(text):
    """Paragraphs and items of prose, each on one line."""
    text = FORMULA.sub(formula, re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL))
    text = "\n".join(line if is_prose(line) else "" for line in text.split("\n"))
    parts = re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )", text)
    return [part for part in (re.sub(r"^\s*(?:[-*]|\d+\.) ", "", " ".join(part.split())) for part in parts) if part]


def plain(paragraph):
    """What is read of a paragraph: names of links, one word for a formula, code or a reference."""
    for pattern, word in ((r"!?\[([^\]]*)\]\([^)]*\)", r"\1"), (r"`[^`]*`", "term"), (r"\$[^$]*\$", "term"), (REFERENCE, "term"), (r"[*_]", "")):
        paragraph = re.sub(pattern, word, paragraph)
    return paragraph


def sentences(text):
    found = []
    for paragraph in paragraphs(text):
        parts = re.split(r"(?<=[.!?])\)?\s+", plain(paragraph))
        whole = ""
        for part in parts:
            whole = f"{whole} {part}".strip()
            if not ABBREVIATION.search(whole):
                found.append(whole)
                whole = ""
        found += [whole] if whole else []
    return [sentence for sentence in found if length(sentence) > 1]


def length(sentence):
    return len([word for word in sentence.split() if re.search(r"\w", word)])


def words(text):  # what is said in other words than the field's
    prose = plain(" ".join([*paragraphs(text), *re.findall(r"^[|#].*", text, re.MULTILINE)]))
    return [f'"{found[0]}": say {better}' for pattern, better in SAY.items() for found in re.finditer(pattern, prose, re.IGNORECASE)]


def in_texts(said):
    return [f'"{found[0]}" in {text[:60]} ...: say {better}' for text in said for pattern, better in SAY.items()
            for found in re.finditer(pattern, text, re.IGNORECASE)]


def messages(source):
    """What the texts of a source say in other words than the field's."""
    code = re.sub(r"^\s*(//|#include).*", "", source, flags=re.MULTILINE)
    return in_texts([re.sub(r'"\s*"', "", match[0]) for match in LITERAL.finditer(code)])


def strings(script):
    """What the strings of a Python script say in other words than the field's."""
    return in_texts([" ".join(node.value.split()) for node in ast.walk(ast.parse(script))
                     if isinstance(node, ast.Constant) and isinstance(node.value, str)])


def comments(source):
    """What the comments of a source say in other words than the field's."""
    blocks = re.findall(r"(?:^[^\n\"]*?//[^\n]*\n)+", source, re.MULTILINE)
    said = [" ".join(" ".join(re.findall(r"//[/<!]*(.*)", block)).split()) for block in blocks]
    return [f'"{found[0]}" in a comment, {text[:60]} ...: say {better}' for text in said for pattern, better in IN_COMMENTS.items()
            for found in re.finditer(pattern, text, re.IGNORECASE)]


def wide(text):
    text = re.sub(r"^```.*?^```|\$\$.*?\$\$", "", text, flags=re.MULTILINE | re.DOTALL)
    return [line for line in text.split("\n") if len(re.sub(r"`[^`]*`", "", line)) > WIDTH and is_prose(line) and "](" not in line]


def violations(text):
    """What is wrong with a page."""
    lengths = [length(sentence) for sentence in sentences(text)]
    found = words(text) + [f"a line of {len(line)} characters: {line[:60]} ..." for line in wide(text)]
    found += [f"a sentence of {length(sentence)} words: {sentence[:60]} ..." for sentence in sentences(text) if length(sentence) > LONGEST]
    if lengths and statistics.median(lengths) >= MEDIAN:
        found.append(f"sentences of {statistics.median(lengths):g} words in the median, must be below {MEDIAN}")
    return found


def check(repository):
    pages = [path for pattern in PAGES for path in sorted(pathlib.Path(repository).glob(pattern))]
    found = [(path, complaint) for path in pages for complaint in violations(path.read_text(encoding="utf-8"))]
    sources = [path for pattern in SOURCES for path in sorted(pathlib.Path(repository).glob(pattern))]
    found += [(path, complaint) for path in sources for of in (messages, comments)
              for complaint in of(path.read_text(encoding="utf-8"))]
    scripts = [path for pattern in SCRIPTS for path in sorted(pathlib.Path(repository).glob(pattern))]
    found += [(path, complaint) for path in scripts for complaint in strings(path.read_text(encoding="utf-8"))]
    return [f"{path.relative_to(repository)}: {complaint}" for path, complaint in found]


def show(path):  # a page's sentences of more than the median that is asked for
    text = pathlib.Path(path).read_text(encoding="utf-8")
    lengths = [length(sentence) for sentence in sentences(text)]
    print(f"{path}: {len(lengths)} sentences, {statistics.median(lengths):g} words in the median")
    print("\n".join(f"  {length(sentence)}: {sentence}" for sentence in sentences(text) if length(sentence) >= MEDIAN))
    print("\n".join(f"  {complaint}" for complaint in violations(text)))


if __name__ == "__main__":
    for page in sys.argv[2:]:
        show(page)
    if len(sys.argv) == 2:
        complaints = check(sys.argv[1])
        print("\n".join(complaints) or "documents and messages hold to words, sentences and lines")
        sys.exit(bool(complaints))
