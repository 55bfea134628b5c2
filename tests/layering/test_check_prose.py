"""The check of prose finds words, sentences and lines that it is there for, and nothing else."""
import unittest

import check_prose

SHORT = "So it is. " * 4


def of(count):
    return " ".join(["x"] * count)


class Prose(unittest.TestCase):
    def assert_found(self, text, *messages):
        found = check_prose.violations(text)
        self.assertEqual(len(found), len(messages), found)
        for message, complaint in zip(messages, found):
            self.assertIn(message, complaint)

    def test_plain_sentences_pass(self):
        self.assert_found("# A heading\n\nThe wheel turns. A formula $a = b$ stands for a word (A. Author, J. Mech. 3 (1999) 1-2).\n")

    def test_words_are_found_in_prose_tables_and_headings(self):
        self.assert_found("Nodes at points\nof least gap.\n", "minimum-gap")
        self.assert_found("| points of least gap | 1 |\n\n# Points of least gap\n", "minimum-gap", "minimum-gap")

    def test_words_in_code_and_what_only_looks_alike_pass(self):
        self.assert_found("Coordinates are told apart. `to and fro` is code. What is left out counts.\n")

    def test_words_are_found_in_the_texts_of_a_source_but_not_in_its_comments(self):
        source = '// "A softer contact" is a comment.\nfail("try a softer "\n     "contact, or \\"more\\" steps");\n#include "to and fro.h"\n'
        self.assertEqual(len(check_prose.messages(source)), 1)
        self.assertIn("contact_stiffness", check_prose.messages(source)[0])

    def test_words_are_found_in_the_strings_of_a_script(self):
        found = check_prose.strings('def f(n):\n    """Results of a\n    drive."""\n    return f"{n} pairs\\n bear it"  # bears\n')
        self.assertEqual([text.split('"')[1] for text in found], ["bear"])

    def test_words_of_contact_are_found_in_comments_across_lines(self):
        found = check_prose.comments("// Nodes at points\n/// of least gap.\nint n;  // an open end\nint bears;  // what is left\n")
        self.assertEqual([text.split('"')[1] for text in found], ["points of least gap", "open end"])

    def test_long_sentences_are_found(self):
        self.assert_found(f"{SHORT}\n{of(41)}.\n", "a sentence of 41 words")
        self.assert_found(f"{SHORT}\n{of(40)}.\n{of(23)}.\n")

    def test_a_formula_goes_on_with_its_sentence_unless_it_ends_it(self):
        self.assert_found(f"{SHORT}\n\n{of(23)}\n\n$$ a = b, \\tag{{1.1}} $$\n\n{of(23)}.\n", "a sentence of 47 words")
        self.assert_found(f"{SHORT}\n\n{of(23)}\n\n$$ a = b . \\tag{{1.1}} $$\n\n{of(23)}.\n")

    def test_the_median_is_bounded(self):
        self.assert_found(f"{of(25)}.\n", "25 words in the median")

    def test_wide_lines_are_found_but_for_tables_code_and_links(self):
        wide = " ".join(["a. b."] * 30)
        self.assert_found(f"{wide}\n", "a line of 179 characters")
        self.assert_found(f"| {wide} |\n\n    {wide}\n\n[a](b) {wide}\n\n```\n{wide}\n```\n")


if __name__ == "__main__":
    unittest.main()
