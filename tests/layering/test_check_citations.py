"""The check of citations must catch what it is there for."""
import os
import tempfile
import unittest

import check_citations

EQ, EQS, PAGE = "Eq" + ".", "Eqs" + ".", "docs" + "/theory"  # in parts: the check reads this file, too


def violations_of(comment, path="src/a.cpp"):
    """Violations in a repository of three equations, (1.1), (1.2) and (1.2a), and one comment besides."""
    with tempfile.TemporaryDirectory() as repository:
        pages = {"docs/theory/model.md": "# 1 Model\n## 1.1 Elements\n\\tag{1.1}\n\\tag{1.2a}\n",
                 "docs/theory/another.md": "# Another\n\\tag{1.2}\n",
                 "docs/format.md": "# Format\n## Matrices\n",
                 path: comment}
        for name, text in pages.items():
            os.makedirs(os.path.join(repository, os.path.dirname(name)), exist_ok=True)
            with open(os.path.join(repository, name), "w", encoding="utf-8") as file:
                file.write(text)
        return check_citations.violations(repository)


class CheckCitations(unittest.TestCase):
    def setUp(self):
        self.not_implemented, check_citations.NOT_IMPLEMENTED = check_citations.NOT_IMPLEMENTED, []

    def tearDown(self):
        check_citations.NOT_IMPLEMENTED = self.not_implemented

    def assert_missing(self, comment, *missing, path="src/a.cpp"):
        expected = [f"no code cites equation ({number})" for number in missing]
        self.assertEqual(violations_of(comment, path), expected)

    def assert_message(self, comment, message, path="src/a.cpp"):
        self.assertTrue(any(message in found for found in violations_of(comment, path)))

    def test_one_several_and_ranges_are_read(self):
        self.assert_missing(f"// {EQ} (1.1)", "1.2", "1.2a")
        self.assert_missing(f"// {EQS} (1.1), (1.2) and (1.2a)")
        self.assert_missing(f"// {EQS} (1.1) to (1.2a)")

    def test_a_number_that_two_equations_have_is_reported(self):
        self.assert_message("\\tag{1.2}", "numbers two equations (1.2)", path="docs/theory/third.md")

    def test_citations_go_on_in_the_next_line(self):
        self.assert_missing(f"/// {EQS} (1.1),\n  /// (1.2)", "1.2a")

    def test_tests_and_scripts_do_not_count_as_code(self):
        self.assert_missing(f"# {EQ} (1.1)", "1.1", "1.2", "1.2a", path="scripts/a.py")

    def test_equations_without_code_are_listed_and_not_cited(self):
        check_citations.NOT_IMPLEMENTED = ["1.2", "1.2a"]
        self.assert_missing(f"// {EQ} (1.1)")
        self.assert_message(f"// {EQS} (1.1) and (1.2)", "(1.2) of NOT_IMPLEMENTED is cited")

    def test_unknown_and_unreadable_equations_are_reported(self):
        self.assert_message(f"// {EQ} (1.3)", "src/a.cpp: docs/theory has no equation (1.3)")
        self.assert_message(f"// {EQ} 1.1", "src/a.cpp: docs/theory has no equation (?)")

    def test_unknown_sections_are_reported(self):
        self.assert_message(f"// {PAGE}, section 2", "has no section 2")
        self.assert_message(f"// {PAGE}, section\n// 1.2", "has no section 1.2")
        self.assert_message(f"// {PAGE}, section Elements", "has no section Elements")
        self.assert_message("// docs/none" + ".md, section 1", "docs/none.md has no section 1")
        self.assert_missing(f"// {EQS} (1.1) to (1.2a), {PAGE}, sections 1 and 1.1")
        self.assert_missing(f"// {EQS} (1.1) to (1.2a), docs/format" + ".md, section Matrices")


if __name__ == "__main__":
    unittest.main()
