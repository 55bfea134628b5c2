"""Pages of the public headers: what Doxygen has read, in the order of the headers, as reStructuredText for Sphinx's C++ domain."""
import re
import xml.etree.ElementTree
from pathlib import Path

KINDS = {"function": "function", "variable": "var", "typedef": "type", "enum": "enum-class"}
SPECIAL = re.compile(r"([*_|`\\])")


def escaped(text):
    return SPECIAL.sub(r"\\\1", text or "")


def inline(element):
    """Text of a paragraph."""
    parts = [escaped(element.text)]
    for child in element:
        if child.tag == "computeroutput":
            parts.append(f"\\ ``{''.join(child.itertext())}``\\ ")
        elif child.tag == "blockquote":  # a comment that begins with >
            parts.append("> " + " ".join(inline(para) for para in child))
        elif child.tag == "emphasis":
            parts.append(f"\\ *{''.join(child.itertext())}*\\ ")
        elif child.tag not in ("itemizedlist", "orderedlist"):
            parts.append(inline(child))
        parts.append(escaped(child.tail))
    return " ".join("".join(parts).split())


def lines_of(description):
    """Lines of all paragraphs and lists of a description."""
    lines = []
    for para in description.iterfind("para") if description is not None else ():
        lines += [inline(para), ""]
        for group in para:
            if group.tag in ("itemizedlist", "orderedlist"):
                mark = "- " if group.tag == "itemizedlist" else "#. "
                lines += [mark + " ".join(inline(part) for part in item) for item in group] + [""]
    return lines


def described(element):
    return lines_of(element.find("briefdescription")) + lines_of(element.find("detaileddescription"))


def template(element):
    parameters = element.find("templateparamlist")
    if parameters is None:
        return ""
    parts = []
    for parameter in parameters:
        kind, name = "".join(parameter.find("type").itertext()), parameter.findtext("declname") or ""
        text = kind.replace("(*)", f"(*{name})") if "(*)" in kind else f"{kind} {name}".strip()
        default = parameter.find("defval")
        parts.append(text + (f" = {''.join(default.itertext())}" if default is not None else ""))
    return f"template<{', '.join(parts)}> "


def signature(member):
    """Declaration of a member without the scope that it is shown in."""
    name, kind = member.findtext("name"), member.get("kind")
    if kind == "enum":
        return name
    initializer = " ".join("".join(member.find("initializer").itertext()).split()) if member.find("initializer") is not None else ""
    if kind == "typedef":
        return f"{template(member)}{name} = {''.join(member.find('type').itertext())}{member.findtext('argsstring') or ''}"
    text = re.sub(r"(?:\w+(?:\s*<[^<>]*>)?::)+" + re.escape(name), lambda _: name, member.findtext("definition"))
    if kind == "variable":  # a pointer to a function has its arguments in the definition
        return template(member) + text + (f" {initializer}" if len(initializer) < 60 else "")
    return template(member) + text + (member.findtext("argsstring") or "")


def values(enum):
    """What an enumeration may be: a list where values are described, else a line."""
    entries = [(value.findtext("name"), described(value)) for value in enum.iterfind("enumvalue")]
    if any(lines for _, lines in entries):
        return [line for name, lines in entries for line in (f"``{name}``", "   " + (" ".join(filter(None, lines)) or "..."))] + [""]
    return [", ".join(f"``{name}``" for name, _ in entries), ""]


def indented(lines):
    return ["   " + line if line else "" for line in lines]


class Header:
    """One page: the declarations of a header by line."""

    def __init__(self, path):
        self.path = path  # elastogear/contact/types.h
        self.label = "decl-" + re.sub(r"[/_]", "-", path[len("elastogear/"):-2])
        self.entries = []  # (line, name, namespace, lines)

    def anchor(self, line, name):
        return f"{self.label}-{line}-{re.sub(r'[^a-z0-9]+', '-', name.lower()).strip('-') or 'operator'}"


class Interface:
    """All public headers, by path."""

    def __init__(self, folder):
        self.headers, self.declarations, self.taken = {}, {}, set()
        compounds = [compound for path in sorted(Path(folder).glob("*.xml")) if path.name.startswith(("struct", "class", "namespace"))
                     for compound in xml.etree.ElementTree.parse(path).iter("compounddef")]
        self.classes = {compound.findtext("compoundname") for compound in compounds if compound.get("kind") != "namespace"}
        for compound in compounds:
            self.add_compound(compound)

    def add_compound(self, compound):
        name = compound.findtext("compoundname")
        if compound.get("kind") == "namespace":
            for member in compound.iter("memberdef"):
                self.add(member, name, self.member(member))
            return
        if "<" in name or compound.get("prot") == "private":
            return
        scope = name
        while scope in self.classes:
            scope = scope.rpartition("::")[0]
        shown = name[len(scope) + 2:]
        lines = [f".. cpp:{compound.get('kind')}:: {template(compound)}{shown}", "", *indented(described(compound))]
        members = sorted((m for m in compound.iter("memberdef") if m.get("prot") == "public" and m.get("kind") in KINDS),
                         key=lambda m: (int(m.find("location").get("line")), int(m.find("location").get("column"))))
        for member in members:
            lines += indented(self.member(member))
        self.add(compound, scope, lines, shown)

    def target(self, element, name):
        """Declares an anchor and remembers it."""
        place = element.find("location")
        header = self.headers.setdefault(place.get("file"), Header(place.get("file")))
        anchor, line = header.anchor(place.get("line"), name), int(place.get("line"))
        if anchor in self.taken:  # of overloads by macros or templates on one line
            return []
        self.taken.add(anchor)
        self.declarations.setdefault(header.path, []).append((line, name.split("::")[-1], anchor))
        return [f".. _{anchor}:", ""]

    def member(self, member):
        kind = member.get("kind")
        directive = "enum" if kind == "enum" and member.get("strong") != "yes" else KINDS.get(kind)
        if directive is None:
            return []
        body = described(member) + (values(member) if kind == "enum" else [])
        return [*self.target(member, member.findtext("name")), f".. cpp:{directive}:: {signature(member)}", "", *indented(body)]

    def add(self, element, scope, lines, name=None):
        if not lines:
            return
        place = element.find("location")
        header = self.headers.setdefault(place.get("file"), Header(place.get("file")))
        head = self.target(element, name) if name else []
        header.entries.append((int(place.get("line")), int(place.get("column") or 0), scope, head + lines))

    def page(self, path):
        """The declarations of a header."""
        lines, current = [], None
        for _, _, scope, entry in sorted(self.headers[path].entries if path in self.headers else [], key=lambda entry: entry[:2]):
            if scope != current:
                lines += [f".. cpp:namespace:: {scope}", ""]
                current = scope
            lines += entry
        return "\n".join(lines) + "\n"
