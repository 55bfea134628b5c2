"""Reads every include in src/ and include/ and reports edges between modules that the layering forbids.

Includes go downwards: a module may include itself and modules of lower levels. Within one level, and between the two
halves that meet only in `model` and its file, nothing may be included. Usage: check_includes.py REPOSITORY
"""
import os
import re
import sys

LEVEL = {
    "base": 1,
    "model": 2,
    "mesh": 3,
    "gear": 4, "io": 4, "body": 4,
    "fem": 5, "contact": 5,
    "reduction": 6, "dynamics": 6, "recovery": 6,
    "app": 7,
}
BUILDING = {"gear", "mesh", "fem", "reduction"}  # makes body files
RUNNING = {"body", "contact", "dynamics", "recovery"}  # uses body files
ROOTS = ("src", "include/elastogear")
INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)


def allowed(source, target):
    """May module `source` include module `target`?"""
    if source == target or source == "app":
        return True
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


def included_module(include, folder):
    """Module that an include names, seen from a file in `folder`; None for system and third-party headers."""
    if include.startswith("elastogear/"):
        return module_of("include/" + include)
    if include.startswith(".."):
        return module_of(os.path.normpath(os.path.join(folder, include)))
    return include.split("/")[0] if include.split("/")[0] in LEVEL else None  # src/ is an include path of the programs


def source_files(repository):
    for root in ROOTS:
        for folder, _, names in os.walk(os.path.join(repository, root)):
            for name in sorted(names):
                if name.endswith((".h", ".cpp")):
                    yield os.path.relpath(os.path.join(folder, name), repository)


def violations(repository):
    """One message per forbidden include or unknown module, empty when the layering holds."""
    found = []
    for path in source_files(repository):
        source = module_of(path)
        with open(os.path.join(repository, path), encoding="utf-8") as file:
            includes = INCLUDE.findall(file.read())
        targets = {include: included_module(include, os.path.dirname(path)) for include in includes}
        for include, target in targets.items():
            if target is None:
                continue
            if source not in LEVEL or target not in LEVEL:
                found.append(f"{path}: '{include}': the layering does not know {source} -> {target}")
            elif not allowed(source, target):
                found.append(f"{path}: '{include}': {source} must not include {target}")
    return found


if __name__ == "__main__":
    if len(sys.argv) != 2 or not os.path.isdir(os.path.join(sys.argv[1], "src")):
        sys.exit("usage: check_includes.py REPOSITORY (a folder that has src/)")
    problems = violations(sys.argv[1])
    print("\n".join(problems) if problems else "the include layering holds")
    sys.exit(1 if problems else 0)
