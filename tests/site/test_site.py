"""What the pages of scripts/api are made with finds declarations and citations, and refuses what leads nowhere."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts/site"))
import check_site  # noqa: E402  (the others are found through the line above)
import citations  # noqa: E402
import diagram  # noqa: E402
import docstrings  # noqa: E402
import links  # noqa: E402

EQ, EQS, THEORY = "Eq" + ".", "Eqs" + ".", "docs" + "/theory"  # in parts: layering.citations reads this file, too
HEADER = f"""#pragma once
// A file, {EQ} (1.1).

namespace elastogear {{
/// A sum: {EQS}
/// (1.1) to (1.3).
template <class T>
T sum(const T& a,
      const T& b);
struct Part {{
  double mass = 0;  ///< kg, {EQ} (2.1)
  /// {EQ} (2.2)
  int count() const;
}};
int twice(int a) {{
  if (a > 0) {{
    return 2 * a;  // {EQ} (2.3)
  }}
  return 0;
}}
}}
""".split("\n")


class Citations(unittest.TestCase):
    def test_every_equation_of_a_range_has_its_line(self):
        self.assertEqual(list(citations.citations("\n".join(HEADER))),
                         [(1, "1.1"), (5, "1.1"), (5, "1.2"), (5, "1.3"), (10, "2.1"), (11, "2.2"), (16, "2.3")])

    def test_declarations_are_those_that_a_comment_is_about(self):
        names = [citations.declaration(HEADER, line)[0] for line in (1, 4, 10, 11, 16)]
        self.assertEqual(names, [None, "sum", "mass", "count", "twice"])

    def test_every_equation_but_derivations_has_code(self):
        from check_citations import NOT_IMPLEMENTED
        self.assertEqual([tag for tag, found in citations.places().items() if not found], NOT_IMPLEMENTED)


class Links(unittest.TestCase):
    def found(self, text, docname="api/cpp/a", of_theory=True):
        self.warnings = []
        return [(text[start:end], page, anchor) for start, end, page, anchor in links.found_in(text, docname, of_theory, self.warnings.append)]

    def test_equations_pages_and_sections(self):
        self.assertEqual(self.found(f"{EQS} (3.1), (3.2)"), [("(3.1)", f"{THEORY}/floating_frame", "eq-3-1"), ("(3.2)", f"{THEORY}/floating_frame", "eq-3-2")])
        self.assertEqual(self.found(f"{THEORY}, section\n6.11"), [(THEORY, f"{THEORY}/README", ""), ("6.11", f"{THEORY}/unilateral_contact", "section-6-11")])
        self.assertEqual(self.found("docs/life" + ".md, section 1"), [("docs/life" + ".md", "docs/life", "")])
        self.assertEqual(self.found("ASTM, sections 5.4.4 and 5.4.5"), [])
        self.assertEqual(self.found("a factor (3.1) of time"), [])
        self.assertEqual(self.found("by (3.1) and (99.1)", "docs/life"), [("(3.1)", f"{THEORY}/floating_frame", "eq-3-1")])
        self.assertEqual(self.found("12 s (3.1)", links.NO_EQUATIONS), [])

    def test_an_equation_that_is_not_there_is_a_warning(self):
        self.assertEqual(self.found(f"{EQ} (99.1)"), [])
        self.assertEqual(self.warnings, ["docs/theory has no equation (99.1)"])


class Texts(unittest.TestCase):
    def test_docstrings(self):
        text = ["A file_name, `code_here`.", "", "time    (n_t,), s;", "        of motions", "", "    eg.Drive()"]
        self.assertEqual(docstrings.restructured(text), ["A file\\_name, ``code_here``.", "", "``time``", "   (n\\_t,), s;", "   of motions", "",
                                                         "::", "", "    eg.Drive()", ""])

    def test_flow_charts(self):
        chart = diagram.dot('flowchart LR\n  a[data] -- "mesh" --> b[("file<br/>x")]\n  a & b --> c[("out")]')
        for part in ('a [label="data"]', 'b [label="file\\nx", shape=cylinder]', 'a -> b [label="mesh"]', 'b -> c [label=""]'):
            self.assertIn(part, chart)


class Pages(unittest.TestCase):
    def test_dead_links_are_found(self):
        pages = check_site.Pages("/nowhere")
        pages.text = {"a.html": '<a href="b.html#x">b</a> <a href="b.html#y">b</a> <a href="c.html">c</a> <script src="https://x.y/z.js"></script>',
                      "b.html": '<p id="x"></p>'}
        pages.anchors = {"a.html": set(), "b.html": {"x"}}
        self.assertEqual(sorted(pages.dead()), ["a.html: b.html#y has no such place", "a.html: c.html is not there",
                                                "a.html: takes https://x.y/z.js from a network"])


if __name__ == "__main__":
    unittest.main()
