"""The checker of links finds what is dead and nothing else."""
import os
import tempfile
import unittest

import check_links


class Links(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        os.makedirs(os.path.join(self.folder.name, "src"))
        self.write("src/a.cpp", "void System::solve() {}\n")

    def write(self, name, text):
        with open(os.path.join(self.folder.name, name), "w", encoding="utf-8") as file:
            file.write(text)

    def complaints(self, text):
        self.write("page.md", text)
        return check_links.check(self.folder.name)

    def test_what_is_there_passes(self):
        self.assertEqual(self.complaints("# One, two\n# One two\n[a](src/a.cpp) [b](#one-two-1) [c](https://x.y/z#w) "
                                         "`src/a.cpp:System::solve`\n"), [])

    def test_dead_links_and_anchors_are_found(self):
        self.assertEqual(self.complaints("# One\n[a](b.md) [c](#two)\n"),
                         ["page.md: there is no b.md", "page.md: there is no #two"])

    def test_headings_in_code_are_none(self):
        self.assertEqual(self.complaints("```\n# one\n```\n[a](#one)\n"), ["page.md: there is no #one"])

    def test_dead_places_are_found(self):
        self.assertEqual(self.complaints("`src/b.cpp:solve` `src/a.cpp:System::find`\n"),
                         ["page.md: there is no src/b.cpp:solve", "page.md: there is no src/a.cpp:System::find"])


if __name__ == "__main__":
    unittest.main()
