"""Reads every include in src/ and include/ and reports what the layering forbids.

1. Includes go downwards: a module may include itself and modules of lower levels. Within one level, and between the two
   halves that meet only in `model` and its file, nothing may be included.
2. A header in src/ is private: only its own module includes it, and no public header does.
3. A header in include/ is public: another module, an example or a study includes it, directly or by another public header.
   The Python module is a second program: it uses the headers of `app`.
4. Units (a header with its source) include each other at most in twos: a larger ring is a knot.
5. Folders of a module include each other in one direction: no rings of folders. The public headers of a module are one folder.

Usage: check_includes.py REPOSITORY
"""
import os
import re
import sys

LEVEL = {
    "base": 1,
    "model": 2,
    "mesh": 3,
    "gear": 4, "io": 4, "body": 4, "life": 4,
    "fem": 5, "contact": 5, "evaluation": 5,
    "reduction": 6, "dynamics": 6, "recovery": 6,
    "drive": 7,
    "app": 8,
    "python": 9,
}
BUILDING = {"gear", "mesh", "fem", "reduction"}  # makes body files
RUNNING = {"body", "contact", "dynamics", "life", "recovery"}  # uses body files
ROOTS = ("src", "include/elastogear")
PROGRAMS = ("examples", "studies")  # use the library as programs outside the tree do
API = ["dynamics/generalized_alpha.h"]  # a TS type for programs of others
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<][^">]+)[">]', re.MULTILINE)


def allowed(source, target):
    """May module `source` include module `target`?"""
    if source == target:
        return True
    if source in ("app", "python"):
        return LEVEL[target] < LEVEL[source]
    halves = {source, target}
    if halves & BUILDING and halves & RUNNING:
        return False
    return LEVEL[target] < LEVEL[source]


def module_of(path):
    """Module of a path relative to the repository, or None for paths outside the modules."""
    for root in ROOTS:
        if path.startswith(root + "/") and "/" in path[len(root) + 1:]:
            return path[len(root) + 1:].split("/")[0]
    return None


def header_of(include, folder):
    """Path of the header that an include names, seen from a file in `folder`; None for those of other libraries."""
    quoted, include = include[0] == '"', include[1:]
    if include.startswith("elastogear/"):
        return "include/" + include
    if quoted and (include.startswith("..") or "/" not in include):
        return os.path.normpath(os.path.join(folder, include))
    return "src/" + include if include.split("/")[0] in LEVEL else None


def read_includes(path, repository):
    """Paths of the headers of ours that a file includes."""
    with open(os.path.join(repository, path), encoding="utf-8") as file:
        found = (header_of(include, os.path.dirname(path)) for include in INCLUDE.findall(file.read()))
    return [header for header in found if header and module_of(header)]


def source_files(repository):
    for root in ROOTS:
        for folder, _, names in os.walk(os.path.join(repository, root)):
            for name in sorted(names):
                if name.endswith((".h", ".cpp")):
                    yield os.path.relpath(os.path.join(folder, name), repository)


def forbidden_edges(includes):
    """Rules 1 and 2."""
    for path, headers in includes.items():
        source = module_of(path)
        for header in headers:
            target = module_of(header)
            private = header.startswith("src/")
            if source not in LEVEL or target not in LEVEL:
                yield f"{path}: the layering does not know {source} -> {target} ({header})"
            elif not allowed(source, target):
                yield f"{path}: {source} must not include {target} ({header})"
            elif private and source != target and (source, target) != ("python", "app"):
                yield f"{path}: {header} is private to module {target}"
            elif private and path.startswith("include/"):
                yield f"{path}: a public header must not include a private one ({header})"


def includes_of_programs(repository):
    for root in PROGRAMS:
        for folder, _, names in os.walk(os.path.join(repository, root)):
            for name in names:
                if name.endswith((".h", ".cpp")):
                    yield from read_includes(os.path.relpath(os.path.join(folder, name), repository), repository)


def needless_public_headers(includes, repository):
    """Rule 3."""
    wanted = {"include/elastogear/" + header for header in API} | set(includes_of_programs(repository))
    for path, headers in includes.items():
        wanted.update(header for header in headers if module_of(header) != module_of(path) and path.startswith("src/"))
    todo = list(wanted)
    while todo:
        more = [header for header in includes.get(todo.pop(), []) if header not in wanted]
        wanted.update(more)
        todo += more
    for path in includes:
        if path.startswith("include/") and path not in wanted:
            yield f"{path}: no other module, example or study includes it: move it to src/{module_of(path)}"


def unit_of(path):
    """Module and name that a header and its source have in common."""
    return module_of(path) + "/" + os.path.splitext(os.path.basename(path))[0]


def rings(edges):
    """Sets of nodes that reach each other, by Tarjan's algorithm."""
    index, low, stack, found = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for target in sorted(edges.get(node, ())):
            if target not in index:
                visit(target)
            if target in stack:
                low[node] = min(low[node], low[target])
        if low[node] == index[node]:
            found.append(sorted(stack[stack.index(node):]))
            del stack[stack.index(node):]

    for node in sorted(edges):
        if node not in index:
            visit(node)
    return found


def edges_between(includes, name_of):
    """Which nodes include which others, by the node that a path belongs to."""
    edges = {}
    for path, headers in includes.items():
        edges.setdefault(name_of(path), set()).update(name_of(header) for header in headers)
    return edges


def knots(includes):
    """Rule 4."""
    return ["a knot of includes: " + ", ".join(ring) for ring in rings(edges_between(includes, unit_of)) if len(ring) > 2]


def rings_of_folders(includes):
    """Rule 5."""
    return ["folders include each other: " + ", ".join(ring) for ring in rings(edges_between(includes, os.path.dirname))
            if len(ring) > 1]


def violations(repository):
    """One message for each breach of rules 1 and 2, empty when the layering holds."""
    return list(forbidden_edges({path: read_includes(path, repository) for path in source_files(repository)}))


def all_violations(repository):
    includes = {path: read_includes(path, repository) for path in source_files(repository)}
    return [*forbidden_edges(includes), *needless_public_headers(includes, repository), *knots(includes),
            *rings_of_folders(includes)]


if __name__ == "__main__":
    if len(sys.argv) != 2 or not os.path.isdir(os.path.join(sys.argv[1], "src")):
        sys.exit("usage: check_includes.py REPOSITORY (a folder that has src/)")
    problems = all_violations(sys.argv[1])
    print("\n".join(problems) if problems else "the include layering holds")
    sys.exit(1 if problems else 0)
