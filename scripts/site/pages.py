"""The sources of the site: the documents of the repository, and one page for each header and each part of the Python module."""
import json
import os
import pathlib
import re
import shutil

from citations import ROOT
from headers import Interface, escaped

LINK = re.compile(r"\]\(([^)\s]+)\)")
PLACE = re.compile(r"`((?:src|include|tests|scripts|studies|examples)/[\w./]+):([\w:~]+)`")
MODULE_ROW = re.compile(r"^\| `(\w+)` \| \d \| [\w ]+ \| (.+) \|$", re.MULTILINE)
PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/*.md", "docs/*/*.md", "*/README.md", "examples/*/README.md")
USING = ("tutorial", "drives", "systems", "examples", "evaluation", "life", "polymers", "python", "report", "file_format")
KNOWING = ("theory/README", "notation", "bases", "validation/README", "performance", "architecture")
PYTHON = {
    "Drives and simulations": ["elastogear.Drive", "elastogear.System", "elastogear.Simulation", "elastogear.Report", "elastogear.Quantity",
                               "elastogear.Count", "elastogear.Facts"],
    "States of a simulation": ["elastogear.State", *(f"elastogear._elastogear.{part}State" for part in ("Body", "Pair", "Bushing", "Load", "Sensor"))],
    "Results": ["elastogear.Result", *(f"elastogear.results.{part}History" for part in ("Body", "Pair", "Sensor")),
                "elastogear.Stress", "elastogear.StressSet", "elastogear.Evaluation", "elastogear.Life"],
    "Meshes and bodies": ["elastogear.Mesh", "elastogear.read_mesh", "elastogear.Body"],
    "Options and files": ["elastogear.option_table", "elastogear.describe", "elastogear.von_mises"],
    "Errors and warnings": ["elastogear.Error", "elastogear.Warning"],
}


def documents():
    """Paths of all pages in Markdown, from the top of the repository."""
    return sorted({path.relative_to(ROOT).as_posix() for pattern in PAGES for path in ROOT.glob(pattern)})


def target_of(link, page, pages):
    """A link of a page, as the site knows it: `code:PATH` for what is no page."""
    file, _, anchor = link.partition("#")
    if not file or re.match(r"[a-z]+:", link) or file.endswith((".svg", ".png")):
        return link
    path = os.path.normpath(os.path.join(os.path.dirname(page), file))
    if f"{path}/README.md" in pages:
        return f"{file.rstrip('/')}/README.md"
    return link if path in pages else f"code:{path}"


def staged(page, text, pages):
    """The text of a page with its links and places as the site knows them, and words for which there is a lexer."""
    lines = []
    for line in text.split("\n"):
        if not line.startswith("    "):
            line = LINK.sub(lambda link: f"]({target_of(link[1], page, pages)})", line)
            line = PLACE.sub(lambda place: f"[{place[0]}](code:{place[1]}:{place[2].split('::')[-1]})", line)
        lines.append(line)
    return "\n".join(lines)


def toctree(title, entries, more=""):
    return f"```{{toctree}}\n:caption: {title}\n:hidden:\n{more}\n" + "\n".join(entries) + "\n```\n"


def contents(pages):
    others = [page[:-3] for page in pages if not page.startswith("docs/") and page not in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
    return "\n".join([toctree("Use", [f"docs/{name}" for name in USING]), toctree("Background", [f"docs/{name}" for name in KNOWING]),
                      toctree("Interface", ["api/python", "api/cpp"]), toctree("Project", [*others, "CONTRIBUTING", "CHANGELOG"])])


def with_toctree(page, text, pages):
    """A page with the pages below it in the sidebar: all of the site, or the chapters of a document."""
    if page == "README.md":
        return f"{text}\n{contents(pages)}"
    if re.fullmatch(r"docs/\w+/README\.md", page):
        return f"{text}\n" + toctree("Chapters", list(dict.fromkeys(re.findall(r"\]\((\w+)\.md\)", text))))
    return text


def write(folder, name, text):
    path = pathlib.Path(folder, name)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def heading(text, mark="="):
    return f"{text}\n{mark * len(text)}\n\n"


def plain(cell):
    """A cell of a table in Markdown as reStructuredText, without what it says in brackets."""
    return re.sub(r"`([^`]+)`", r"``\1``", re.sub(r" \(\[.*?\)\)", "", cell))


def lead(header):
    """The comment on a whole header, in reStructuredText."""
    lines = (ROOT / "include" / header).read_text(encoding="utf-8").split("\n")[1:]
    number = next(i for i, line in enumerate(lines) if not line.startswith("//"))
    return escaped(" ".join(line[2:].strip() for line in lines[:number]))


def write_headers(folder, interface):
    """api/cpp, a page for each module, and one for each public header, which the sidebar leaves out: it stands on every page."""
    modules = MODULE_ROW.findall((ROOT / "docs/architecture.md").read_text(encoding="utf-8"))
    rows = []
    for module, meaning in modules:
        headers = sorted(path.name for path in (ROOT / "include/elastogear" / module).glob("*.h"))
        if not headers:
            continue
        rows.append(f":doc:`cpp/{module}`\n  {plain(meaning)}\n")
        table = "\n".join(f":doc:`{module}/{name[:-2]}`\n  {lead(f'elastogear/{module}/{name}') or '...'}\n" for name in headers)
        write(folder, f"api/cpp/{module}.rst", f"{heading(module)}Namespace ``elastogear{'' if module == 'base' else '::' + module}``: {plain(meaning)}.\n\n"
              f"{table}\n")
        for name in headers:
            header = f"elastogear/{module}/{name}"
            write(folder, f"api/cpp/{module}/{name[:-2]}.rst",
                  f":orphan:\n\n{heading(f'{module}/{name}')}{lead(header)}\n\n.. code-block:: cpp\n\n   #include \"{header}\"\n\n"
                  f"`Source <code:include/{header}>`__\n\n{interface.page(header)}")
    entries = "\n".join(f"   cpp/{module}" for module, _ in modules if (ROOT / "include/elastogear" / module).exists())
    write(folder, "api/cpp.rst", f"{heading('C++')}The public headers, by module; :doc:`/docs/architecture` says what may include what and how a\n"
          f"program uses the installed library.\n\n" + "\n".join(rows) + f"\n.. toctree::\n   :hidden:\n\n{entries}\n")


def write_python(folder):
    """api/python: all that `import elastogear` gives, and its plots."""
    text = heading("Python") + ":doc:`/docs/python` introduces the module and tells of its errors, interrupts, threads and ranks.\n\n"
    for title, names in PYTHON.items():
        text += heading(title, "-")
        for name in names:
            last = name.split(".")[-1]
            kind = "autofunction" if last[0].islower() else "autoexception" if last in ("Error", "Warning") else "autoclass"
            text += f".. {kind}:: {name}\n\n"
    text += heading("Plots", "-") + ".. automodule:: elastogear.plots\n   :members:\n"
    write(folder, "api/python.rst", text)


def stage(folder, xml):
    """Writes all sources of the site below a folder that is new; xml: what Doxygen has read."""
    pages = documents()
    for page in pages:
        text = staged(page, (ROOT / page).read_text(encoding="utf-8"), pages)
        write(folder, "index.md" if page == "README.md" else page, with_toctree(page, text, pages))
    for picture in [*ROOT.glob("docs/*.svg"), *ROOT.glob("docs/*.png")]:
        shutil.copy(picture, pathlib.Path(folder, "docs"))
    interface = Interface(xml)
    write_headers(folder, interface)
    write(folder, "declarations.json", json.dumps(interface.declarations))
    write_python(folder)
