"""Decks of decks.py: variants of a bar of 80 x 20 x 20 mm of 8 x 2 x 2 hexahedra, with what must come of each. Frequencies are those of
CalculiX 2.20 for the same deck; where CalculiX lacks a keyword of Abaqus, for the deck that says the same without it."""
import dataclasses

NX, NY, NZ = 8, 2, 2
FREE_TIP = (2714.739, 2714.739, 10040.04, 14086.12)  # Hz
TIP_IN_Y = (2714.741, 10466.62, 14086.58, 16412.49)
OF_WEDGES = (2641.862, 3484.293)
OF_TETRAHEDRA = (3240.267, 3780.357)
FEWER_POINTS = 4e-3  # by which CalculiX's mass of wedges and tetrahedra is off (docs/validation/statics_and_modes.md, section Frequencies of elements)
HEAVY_CORNER = (613.9447, 630.5974, 2522.251, 5816.802)


@dataclasses.dataclass
class Deck:
    """frequencies: Hz, of the first modes; none: the deck is refused with `error`. warns: regular expressions of warnings, all that there
    are of what is lost. same_as: the deck that says the same to CalculiX. files: further ones by name."""
    name: str
    text: str
    frequencies: tuple = ()
    error: str = ""
    warns: tuple = ()
    same_as: str = ""
    equals: str = ""  # the deck of this name, which is read before, to roundoff
    tolerance: float = 2e-6  # relative: CalculiX prints seven digits
    files: dict = dataclasses.field(default_factory=dict)
    options: str = ""
    encoding: str = "utf-8"
    file: str = "deck.inp"


def node(i, j, k):
    return 1 + i + (NX + 1) * (j + (NY + 1) * k)


def nodes(head="*NODE, NSET=NALL", line="{}, {}., {}., {}."):
    rows = [line.format(node(i, j, k), 10 * i, 10 * j, 10 * k) for k in range(NZ + 1) for j in range(NY + 1) for i in range(NX + 1)]
    return "\n".join([head] * (head != "") + rows) + "\n"


def cell(i, j, k):
    return [node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k), node(i, j, k + 1), node(i + 1, j, k + 1),
            node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)]


def elements(head="*ELEMENT, TYPE=C3D8, ELSET=EALL", first=1):
    cells = [cell(i, j, k) for k in range(NZ) for j in range(NY) for i in range(NX)]
    return "\n".join([head] * (head != "") + [", ".join(map(str, [first + n, *c])) for n, c in enumerate(cells)]) + "\n"


def section(name, i, head="*NSET, NSET={}"):
    return head.format(name) + "\n" + ", ".join(str(node(i, j, k)) for k in range(NZ + 1) for j in range(NY + 1)) + "\n"


NODES, ELEMENTS, SETS = nodes(), elements(), section("FIX", 0) + section("TIP", NX)
MATERIAL = "*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n*DENSITY\n7.85E-9\n*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL\n"
HELD = "*BOUNDARY\nFIX, 1, 3\n"
STEP = "*STEP\n*FREQUENCY, SOLVER=ARPACK\n4\n*END STEP\n"
MASS = f"*ELEMENT, TYPE=MASS, ELSET=LUMP\n900, {node(NX, NY, NZ)}\n*MASS, ELSET=LUMP\n1.E-3\n"
TIP_HELD = "*BOUNDARY\nTIP, 2, 2\n"


def bar(n=NODES, e=ELEMENTS, s=SETS, m=MATERIAL, x="", b=HELD, step=STEP):
    """n: nodes, e: elements, s: sets, m: material, x: further cards, b: restraint."""
    return n + e + s + m + x + b + step


def first_step(cards):
    return STEP.replace("*FREQUENCY", cards + "*FREQUENCY")


BAR, BAR_TIP_HELD, BAR_MASS = bar(), bar(b=HELD + TIP_HELD), bar(x=MASS)
CORNERS = "\n".join(f"{node(i, j, k)}, {10 * i}., {10 * j}., {10 * k}." for i in (0, NX) for j in range(NY + 1) for k in range(NZ + 1))
NGEN = "*NGEN, NSET=NALL\n" + "\n".join(f"{node(0, j, k)}, {node(NX, j, k)}" for j in range(NY + 1) for k in range(NZ + 1)) + "\n"
ELGEN = "*ELGEN, ELSET=EALL\n1, 8, 1, 1, 2, 9, 8, 2, 27, 16\n"
ONE = "*ELEMENT, TYPE=C3D8, ELSET=EALL\n" + ", ".join(map(str, [1, *cell(0, 0, 0)])) + "\n"
SHELL = "*ELEMENT, TYPE={}, ELSET=SKIN\n" + "\n".join(
    f"{901 + i}, {node(i, 0, 0)}, {node(i + 1, 0, 0)}, {node(i + 1, 1, 0)}, {node(i, 1, 0)}" for i in range(NX)) + "\n"


def divided(head, parts):
    """Each hexahedron as elements of the corners in parts, which count from 0."""
    cells = [cell(i, j, k) for k in range(NZ) for j in range(NY) for i in range(NX)]
    rows = [[c[a] for a in p] for c in cells for p in parts]
    return head + "\n" + "\n".join(", ".join(map(str, [1 + n, *row])) for n, row in enumerate(rows)) + "\n"


WEDGES = ((0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7))
TETRAHEDRA = ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6))
C3D6, C3D4, C3D8 = ("*ELEMENT, TYPE=" + name + ", ELSET=EALL" for name in ("C3D6", "C3D4", "C3D8"))
BAR_OF_WEDGES, BAR_OF_TETRAHEDRA = bar(e=divided(C3D6, WEDGES)), bar(e=divided(C3D4, TETRAHEDRA))


def turned(transform, held, set_of="TIP"):
    return bar(x=f"*TRANSFORM, NSET={set_of}, {transform}\n", b=HELD + f"*BOUNDARY\n{held}\n")


def part(n=NODES, e=ELEMENTS, instance="*INSTANCE, NAME=BAR-1, PART=BAR\n*END INSTANCE\n"):
    return ("*HEADING\nas Abaqus CAE writes it\n*PART, NAME=BAR\n" + n + e + SETS + "*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL\n,\n"
            "*END PART\n*ASSEMBLY, NAME=ASSEMBLY\n" + instance + "*NSET, NSET=HELD, INSTANCE=BAR-1\n1, 10, 19, 28, 37, 46, 55, 64, 73\n"
            "*END ASSEMBLY\n" + MATERIAL.replace("*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL\n", "") + "*BOUNDARY\nHELD, ENCASTRE\n" + STEP)


BOTH = "*NSET, NSET=BOTH, INSTANCE=LONG-1\n3, 7\n" + section("BOTH", NX, "*NSET, NSET={}, INSTANCE=BAR-1")


def two_parts(sets="", held=""):
    """The bar beside a longer one of other sets, which is placed first and held elsewhere. sets: of the assembly; held: lines of *BOUNDARY."""
    long = ("*PART, NAME=LONG\n*NODE\n1, 0., 0., 0.\n2, 99., 0., 0.\n3, 99., 9., 0.\n4, 0., 9., 0.\n5, 0., 0., 9.\n6, 99., 0., 9.\n"
            "7, 99., 9., 9.\n8, 0., 9., 9.\n*ELEMENT, TYPE=C3D8, ELSET=EALL\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*NSET, NSET=FIX\n1, 2\n"
            "*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL\n,\n*END PART\n")
    deck = part(instance="*INSTANCE, NAME=LONG-1, PART=LONG\n0., 0., 50.\n*END INSTANCE\n*INSTANCE, NAME=BAR-1, PART=BAR\n100., 0., 5.\n*END INSTANCE\n"
                "*NSET, NSET=OTHER, INSTANCE=LONG-1\n1, 2\n*ELSET, ELSET=_TOP_S2, INTERNAL, INSTANCE=LONG-1\n1\n"
                "*SURFACE, NAME=TOP, TYPE=ELEMENT\n_TOP_S2, S2\n").replace("*END ASSEMBLY", sets + "*END ASSEMBLY")
    return deck.replace("*PART, NAME=BAR", long + "*PART, NAME=BAR").replace("*BOUNDARY\n", "*BOUNDARY\n" + held + "OTHER, ENCASTRE\nLONG-1.FIX, 1, 3\n")


READ = [
    Deck("the bar", BAR, FREE_TIP),
    Deck("mass at a corner", BAR_MASS, HEAVY_CORNER),
    Deck("mass as two elements on a node", bar(x=MASS.replace("900,", f"899, {node(NX, NY, NZ)}\n900,").replace("1.E-3", "0.5E-3")),
         HEAVY_CORNER),
    Deck("mass below the step's restraint", bar(x=MASS, b="", step=first_step(HELD)), HEAVY_CORNER),
    Deck("restraint of the first step beside the model's", bar(step=first_step(TIP_HELD)), TIP_IN_Y),
    Deck("restraint of the first step alone", bar(b="", step=first_step(HELD)), FREE_TIP),
    Deck("restraint of the first step by numbers", bar(b="", step=first_step("*BOUNDARY\n" + "".join(
        f"{node(0, j, k)}, 1, 3\n" for j in range(3) for k in range(3)))), FREE_TIP),
    Deck("OP=NEW takes back", bar(b=HELD + TIP_HELD, step=first_step("*BOUNDARY, OP=NEW\nFIX, 1, 3\n")), FREE_TIP, same_as=BAR),
    Deck("OP=MOD adds", bar(step=first_step(TIP_HELD.replace("*BOUNDARY", "*BOUNDARY, OP=MOD"))), TIP_IN_Y),
    Deck("restraint of a second step", bar(step=STEP + first_step(TIP_HELD)), FREE_TIP, warns=("BOUNDARY of a later step",), same_as=BAR),
    Deck("label ENCASTRE", bar(b="*BOUNDARY\nFIX, ENCASTRE\n"), FREE_TIP, same_as=BAR),
    Deck("label PINNED", bar(b="*BOUNDARY\nFIX, PINNED\n"), FREE_TIP, same_as=BAR),
    Deck("label YSYMM", bar(b=HELD + "*BOUNDARY\nTIP, YSYMM\n"), TIP_IN_Y, same_as=BAR_TIP_HELD),
    Deck("degrees of freedom to 6", bar(b="*BOUNDARY\nFIX, 1, 6\n"), FREE_TIP, same_as=BAR),
    Deck("one degree of freedom a line", bar(b="*BOUNDARY\nFIX, 1\nFIX, 2\nFIX, 3\n"), FREE_TIP),
    Deck("prescribed displacement", bar(b=HELD + "*BOUNDARY\nTIP, 2, 2, 0.1\n"), TIP_IN_Y, warns=("a displacement other than 0 are held",)),
    Deck("prescribed displacement of the first step", bar(step=first_step("*BOUNDARY\nTIP, 2, 2, 0.1\n")), TIP_IN_Y,
         warns=("the displacement is left out",)),
    Deck("axes of nodes held in all directions", turned("TYPE=C\n0., 10., 10., 1., 10., 10.", "FIX, 1, 3", "FIX"), FREE_TIP),
    Deck("rectangular axes, turned by a quarter", turned("TYPE=R\n0., 1., 0., -1., 0., 0.", "TIP, 1"), TIP_IN_Y),
    Deck("rectangular axes, x along -y", turned("TYPE=R\n0., -1., 0., 1., 0., 0.", "TIP, 1"), TIP_IN_Y),
    Deck("axial direction of a cylinder along y", turned("TYPE=C\n40., 0., 5., 40., 1., 5.", "TIP, 3"), TIP_IN_Y),
    Deck("comma behind *NSET, NSET=TIP", bar(s=section("FIX", 0) + section("TIP", NX, "*NSET, NSET={},"), b=HELD + TIP_HELD), TIP_IN_Y),
    Deck("comma behind *NODE", bar(n=nodes("*NODE, NSET=NALL,")), FREE_TIP),
    Deck("comma behind *ELEMENT", bar(e=elements("*ELEMENT, TYPE=C3D8, ELSET=EALL,")), FREE_TIP),
    Deck("comma behind *ELASTIC", bar(m=MATERIAL.replace("*ELASTIC", "*ELASTIC,")), FREE_TIP),
    Deck("comma behind *BOUNDARY", bar(b=HELD.replace("*BOUNDARY", "*BOUNDARY,")), FREE_TIP),
    Deck("keyword line on two lines", bar(e=elements("*ELEMENT, TYPE=C3D8,\nELSET=EALL")), FREE_TIP, same_as=BAR),
    Deck("generated nodes", bar(n="*NODE, NSET=NALL\n" + CORNERS + "\n" + NGEN), FREE_TIP, same_as=BAR),
    Deck("generated elements", bar(e=ONE + ELGEN), FREE_TIP, same_as=BAR),
    Deck("generated nodes and elements", bar(n="*NODE\n" + CORNERS + "\n" + NGEN, e=ONE + ELGEN), FREE_TIP, same_as=BAR),
    Deck("nodes of a file", bar(n="*NODE, NSET=NALL, INPUT=nodes.txt\n"), FREE_TIP, same_as=BAR, files={"nodes.txt": nodes("")}),
    Deck("elements of a file", bar(e="*ELEMENT, TYPE=C3D8, ELSET=EALL, INPUT=parts/cells.txt\n"), FREE_TIP, same_as=BAR,
         files={"parts/cells.txt": elements("")}),
    Deck("included mesh", bar(n="*INCLUDE, INPUT=mesh.inp\n", e=""), FREE_TIP, files={"mesh.inp": NODES + ELEMENTS}),
    Deck("no third coordinate where it is 0", bar(n=NODES.replace(", 0.\n", "\n")), FREE_TIP),
    Deck("blank coordinates", bar(n=NODES.replace(", 0.,", ", ,")), FREE_TIP),
    Deck("exponents with D", bar(m=MATERIAL.replace("210000.", "2.1D5").replace("7.85E-9", "7.85D-9")), FREE_TIP, same_as=BAR),
    Deck("lower case", bar().lower(), FREE_TIP),
    Deck("blanks and tabs", bar().replace(",", " ,\t"), FREE_TIP, same_as=BAR),
    Deck("line ends of Windows", bar().replace("\n", "\r\n"), FREE_TIP),
    Deck("keywords without blanks", bar().replace("*SOLID SECTION", "*SOLIDSECTION").replace("*END STEP", "*ENDSTEP"), FREE_TIP),
    Deck("parameter cut short", bar(s=SETS + "*NSET, NSET=ROW, GENER\n1, 9\n*NSET, NSET=HOLD\nFIX\n", b=HELD.replace("FIX", "HOLD")), FREE_TIP,
         same_as=BAR),
    Deck("sets within sets", bar(s=SETS + "*NSET, NSET=HOLD\nFIX, 1\n", b=HELD.replace("FIX", "HOLD")), FREE_TIP, same_as=BAR),
    Deck("material behind its section", bar(m="*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL\n" + MATERIAL.split("*SOLID")[0]), FREE_TIP,
         same_as=BAR),
    Deck("numbers with gaps", bar(e=elements(first=500001)), FREE_TIP),
    Deck("part and instance of Abaqus CAE", part(), FREE_TIP, same_as=BAR),
    Deck("instance that is moved", part(instance="*INSTANCE, NAME=BAR-1, PART=BAR\n100., 0., 5.\n*END INSTANCE\n"), FREE_TIP, same_as=BAR),
    Deck("instance that is turned by a quarter", part(instance="*INSTANCE, NAME=BAR-1, PART=BAR\n100., 0., 5.\n0., 1., 0., 0., 1., 1., 90.\n"
         "*END INSTANCE\n"), FREE_TIP, same_as=BAR),
    Deck("instance that is turned askew", part(instance="*INSTANCE, NAME=BAR-1, PART=BAR\n0., 0., 0.\n0., 1., 0., 1., 2., 1., 33.\n"
         "*END INSTANCE\n"), FREE_TIP, same_as=BAR),
    Deck("one of two instances", two_parts(), FREE_TIP, same_as=BAR, options="-instance bar-1"),
    Deck("set that spans two instances", two_parts(BOTH, "BOTH, 2, 2\n"), TIP_IN_Y, same_as=BAR_TIP_HELD, options="-instance BAR-1"),
    Deck("set of sets of two instances", two_parts("*NSET, NSET=BOTH\nLONG-1.FIX, BAR-1.TIP, OTHER\n", "BOTH, 2, 2\n"), TIP_IN_Y,
         same_as=BAR_TIP_HELD, options="-instance BAR-1"),
    Deck("set of another instance with the name of the part's", two_parts("*NSET, NSET=TIP, INSTANCE=LONG-1\n3\n", "TIP, 2, 2\n"), FREE_TIP,
         same_as=BAR, options="-instance BAR-1"),
    Deck("names in Latin-1", bar().replace("FIX", "B\u00dcGEL"), FREE_TIP, encoding="latin-1", same_as=BAR),
    Deck("names in UTF-8 behind its mark", bar().replace("FIX", "B\u00dcGEL"), FREE_TIP, encoding="utf-8-sig", same_as=BAR),
    Deck("names with commas", bar().replace("FIX", '"FIX, LEFT"'), FREE_TIP, same_as=BAR),
    Deck("plane elements on cells", bar(x=SHELL.format("CPS4")), FREE_TIP, same_as=BAR),
    Deck("shells on cells", bar(x=SHELL.format("S4") + "*SHELL SECTION, ELSET=SKIN, MATERIAL=STEEL\n0.01\n"), FREE_TIP,
         warns=("SHELL SECTION.*made of solids alone",), same_as=BAR),
    Deck("shells beside cells", bar(x=SHELL.format("S4").replace(" 11, 10\n", " 11, 19\n")), FREE_TIP, warns=("TYPE=S4.*left out",), same_as=BAR),
    Deck("surface of a blank label", bar(x="*SURFACE, NAME=ALL\nEALL,\n"), FREE_TIP, same_as=BAR),
    Deck("surface of shells and cells", bar(x="*ELEMENT, TYPE=B31, ELSET=SKIN\n901, 1, 2\n" + "*SURFACE, NAME=ANY\nSKIN, SPOS\n1, S1\n"), FREE_TIP,
         warns=("TYPE=B31.*left out", "NAME=ANY.*no solids"), same_as=BAR),
    Deck("surface of nodes", bar(x="*SURFACE, NAME=ANY, TYPE=NODE\nTIP,\n"), FREE_TIP, warns=("TYPE=NODE.*not read",)),
    Deck("wedges", BAR_OF_WEDGES, OF_WEDGES, tolerance=FEWER_POINTS),
    Deck("hexahedra that are wedges", bar(e=divided(C3D8, [(a, b, c, c, d, e, f, f) for a, b, c, d, e, f in WEDGES])), OF_WEDGES,
         same_as=BAR_OF_WEDGES, equals="wedges", tolerance=FEWER_POINTS),
    Deck("hexahedra that are wedges, collapsed elsewhere", bar(e=divided(C3D8, [(a, a, b, c, d, d, e, f) for a, b, c, d, e, f in WEDGES])),
         OF_WEDGES, same_as=BAR_OF_WEDGES, equals="wedges", tolerance=FEWER_POINTS),
    Deck("tetrahedra", BAR_OF_TETRAHEDRA, OF_TETRAHEDRA, tolerance=FEWER_POINTS),
    Deck("hexahedra that are tetrahedra", bar(e=divided(C3D8, [(a, b, c, c, d, d, d, d) for a, b, c, d in TETRAHEDRA])), OF_TETRAHEDRA,
         same_as=BAR_OF_TETRAHEDRA, equals="tetrahedra", tolerance=FEWER_POINTS),
    Deck("wedges that are tetrahedra", bar(e=divided(C3D6, [(a, b, c, d, d, d) for a, b, c, d in TETRAHEDRA])), OF_TETRAHEDRA,
         same_as=BAR_OF_TETRAHEDRA, equals="tetrahedra", tolerance=FEWER_POINTS),
    Deck("springs", bar(x=f"*ELEMENT, TYPE=SPRING1, ELSET=SP\n900, {node(NX, 0, 0)}\n*SPRING, ELSET=SP\n2\n1000.\n"), FREE_TIP,
         warns=("SPRING1.*left out", "SPRING.*springs"), same_as=BAR),
    Deck("tie", bar(x="*TIE, NAME=T\nA, B\n"), FREE_TIP, warns=("TIE.*merge the nodes",), same_as=BAR),
    Deck("equation", bar(x="*EQUATION\n2\n9, 2, 1., 18, 2, -1.\n"), FREE_TIP, warns=("EQUATION.*left out",), same_as=BAR),
    Deck("rigid body", bar(x="*RIGID BODY, NSET=TIP, REF NODE=9\n"), FREE_TIP, warns=("RIGID BODY.*marker",), same_as=BAR),
    Deck("plasticity", bar(m=MATERIAL.replace("*DENSITY", "*PLASTIC\n300., 0.\n400., 0.1\n*DENSITY")), FREE_TIP,
         warns=("PLASTIC.*stays elastic",)),
    Deck("thermal expansion", bar(m=MATERIAL.replace("*DENSITY", "*EXPANSION\n1.2E-5\n*DENSITY")), FREE_TIP),
    Deck("unknown keyword", bar(x="*SPRUNG\n1, 2\n"), FREE_TIP, warns=("SPRUNG.*not known",), same_as=BAR),
    Deck("unknown parameter", bar(b=HELD.replace("*BOUNDARY", "*BOUNDARY, PHASE=1")), FREE_TIP, warns=("BOUNDARY, PHASE.*not read",), same_as=BAR),
    Deck("loads and output", bar(step=STEP + "*STEP\n*STATIC\n*CLOAD\nTIP, 2, 1.\n*NODE FILE\nU\n*EL PRINT, ELSET=EALL\nS\n*END STEP\n"),
         FREE_TIP, same_as=BAR),
]

REFUSED = [
    Deck("radial direction of a cylinder", turned("TYPE=C\n0., 5., 5., 1., 5., 5.", "TIP, 1"), error=r"TRANSFORM: node 9 is held along.*turn"),
    Deck("axes that are turned by 45 degrees", turned("TYPE=R\n0., 1., 1., 0., -1., 1.", "TIP, 1"), error=r"line 126: \*TRANSFORM: node 9"),
    Deck("spherical axes", turned("TYPE=S\n0., 1., 1., 0., -1., 1.", "TIP, 1"), error="TYPE=S, read are"),
    Deck("copied nodes", bar(x="*NCOPY, CHANGE NUMBER=100, OLD SET=TIP, SHIFT\n10.,\n,\n"), error=r"NCOPY: it makes nodes.*write them out"),
    Deck("copied elements", bar(x="*ELCOPY, ELEMENT SHIFT=100, OLD SET=EALL, SHIFT NODES=100\n"), error="ELCOPY"),
    Deck("filled nodes", bar(x="*NFILL\nFIX, TIP, 8, 1\n"), error="NFILL.*write them out"),
    Deck("nodes in a local system", bar(n="*SYSTEM\n0., 0., 1.\n" + NODES), error="SYSTEM: only global coordinates"),
    Deck("cylindrical coordinates", bar(n=nodes("*NODE, NSET=NALL, SYSTEM=C")), error="SYSTEM=C, only rectangular"),
    Deck("parameters", "*PARAMETER\nE = 210000.\n" + BAR, error="PARAMETER: it computes values"),
    Deck("unknown parameter of elements", bar(e=elements("*ELEMENT, TYPE=C3D8, ELSET=EALL, OFFSET=1000")), error="line 83.*OFFSET"),
    Deck("rows that do not end", bar(n="*NODE\n" + CORNERS + "\n*NGEN\n1, 9, 3\n"), error="NGEN from node 1 to 9 in steps of 3"),
    Deck("rows of no element", bar(e=ONE + "*ELGEN\n2, 8\n"), error="element of a solid, 2 is not defined above"),
    Deck("hexahedron that is folded", bar(e=ELEMENTS + "500011, 1, 2, 1, 10, 28, 29, 38, 37\n"), error="element 500011 repeats nodes"),
    Deck("hexahedra of 27 nodes", bar(e=ELEMENTS.replace("C3D8", "C3D27")), error="C3D27.*write C3D20"),
    Deck("instance that is moved, with axes", part(instance="*INSTANCE, NAME=BAR-1, PART=BAR\n100., 0., 5.\n*END INSTANCE\n").replace(
        "*MATERIAL", "*ORIENTATION, NAME=O\n1., 0., 0., 0., 1., 0.\n*MATERIAL"), error="INSTANCE that is moved"),
    Deck("second instance", part(instance="*INSTANCE, NAME=BAR-1, PART=BAR\n*END INSTANCE\n*INSTANCE, NAME=BAR-2, PART=BAR\n*END INSTANCE\n"),
         error=r"a second \*INSTANCE, 'BAR-2' after 'BAR-1'.*option instance"),
    Deck("second part", two_parts(), error=r"a second \*PART.*option instance"),
    Deck("instance that is not there", two_parts(), error=r"no instance 'BAR-7'; its instances are: LONG-1, BAR-1", options="-instance BAR-7"),
    Deck("element that is inside out", bar(e=ELEMENTS + "500011, 1, 10, 11, 2, 28, 37, 38, 29\n"), error="cell 500011, of node 1, .*Jacobian"),
    Deck("node twice", bar(n=NODES + "1, 0., 0., 0.\n"), error="node 1 is defined twice"),
    Deck("element of an unknown node", bar(e=ELEMENTS + "500011, 1, 2, 11, 10, 28, 29, 38, 9999\n"), error="element 500011 names node 9999"),
    Deck("tetrahedron that repeats a node", bar(e=ELEMENTS + "*ELEMENT, TYPE=C3D4\n500011, 1, 2, 2, 11\n"), error="element 500011 repeats nodes"),
    Deck("missing file", bar(n="*NODE, INPUT=none.txt\n"), error=r"line 1: \*NODE: .*none.txt"),
    Deck("unknown node held", bar(b=HELD + "*BOUNDARY\n999, 1\n"), error="unknown node or node set '999'"),
    Deck("mass of elements that are none", bar(x="*MASS, ELSET=NONE\n1.E-3\n"), error="MASS names the unknown element set 'NONE'"),
    Deck("reference point", part(instance="*INSTANCE, NAME=BAR-1, PART=BAR\n*END INSTANCE\n*NODE\n1, 0., 0., 0.\n"), error="reference point"),
]

DECKS = READ + REFUSED
