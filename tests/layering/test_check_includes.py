"""The include check must catch what it is there for."""
import os
import tempfile
import unittest

import check_includes


def found_in(files, check):
    """What a check of a repository finds that holds these files, each a path and the headers that it includes."""
    with tempfile.TemporaryDirectory() as repository:
        for path, includes in files.items():
            os.makedirs(os.path.join(repository, os.path.dirname(path)), exist_ok=True)
            with open(os.path.join(repository, path), "w", encoding="utf-8") as file:
                file.write("#pragma once\n#include <vector>\n" + "".join(f"  #include {name}\n" for name in includes))
        return check(repository)


def violations_of(path, include):
    """Violations in a repository whose only file is `path` with one include."""
    return found_in({path: [include]}, check_includes.violations)


class CheckIncludes(unittest.TestCase):
    def assert_allowed(self, path, include):
        self.assertEqual(violations_of(path, include), [])

    def assert_forbidden(self, path, include):
        self.assertEqual(len(violations_of(path, include)), 1)

    def test_downward_includes_are_allowed(self):
        self.assert_allowed("src/fem/a.cpp", '"elastogear/mesh/mesh.h"')
        self.assert_allowed("src/io/a.cpp", '"elastogear/model/result.h"')
        self.assert_allowed("src/mesh/a.cpp", '"elastogear/model/material.h"')
        self.assert_allowed("src/recovery/a.cpp", '"elastogear/io/body_file.h"')
        self.assert_allowed("include/elastogear/dynamics/a.h", '"elastogear/contact/pair.h"')

    def test_own_module_and_other_libraries_are_allowed(self):
        self.assert_allowed("src/fem/a.cpp", '"quadrature.h"')
        self.assert_allowed("src/fem/a.cpp", '"../fem/quadrature.h"')
        self.assert_allowed("src/fem/a.cpp", "<petscmat.h>")

    def test_the_programs_may_include_everything(self):
        self.assert_allowed("src/app/a.cpp", '"elastogear/dynamics/simulate.h"')
        self.assert_allowed("src/python/a.cpp", '"app/options/options.h"')
        self.assert_forbidden("src/app/a.cpp", '"python/arrays.h"')
        self.assert_forbidden("src/python/a.cpp", '"fem/elements/hex8.h"')

    def test_upward_includes_are_forbidden(self):
        self.assert_forbidden("src/model/a.cpp", '"elastogear/mesh/mesh.h"')
        self.assert_forbidden("src/base/a.cpp", '"elastogear/mesh/mesh.h"')
        self.assert_forbidden("include/elastogear/model/a.h", '"elastogear/io/body_file.h"')
        self.assert_forbidden("src/fem/a.cpp", "<elastogear/reduction/reduce.h>")
        self.assert_forbidden("src/recovery/a.cpp", '"elastogear/app/options.h"')

    def test_includes_within_a_level_are_forbidden(self):
        self.assert_forbidden("src/recovery/a.cpp", '"elastogear/dynamics/simulate.h"')
        self.assert_forbidden("src/io/a.cpp", '"elastogear/gear/worm.h"')

    def test_the_two_halves_never_include_each_other(self):
        self.assert_forbidden("src/dynamics/a.cpp", '"elastogear/fem/assemble.h"')
        self.assert_forbidden("src/contact/a.cpp", '"elastogear/mesh/mesh.h"')
        self.assert_forbidden("src/reduction/a.cpp", '"elastogear/body/equations.h"')

    def test_private_headers_of_other_modules_are_seen(self):
        self.assert_forbidden("src/mesh/a.cpp", '"../fem/quadrature.h"')
        self.assert_forbidden("src/mesh/a.cpp", '"fem/quadrature.h"')

    def test_private_headers_are_for_their_module(self):
        self.assert_allowed("src/fem/a.cpp", '"fem/elements/hex8.h"')
        self.assert_forbidden("src/reduction/a.cpp", '"fem/elements/hex8.h"')
        self.assert_forbidden("src/app/a.cpp", '"fem/elements/hex8.h"')
        self.assert_forbidden("include/elastogear/fem/a.h", '"fem/elements/hex8.h"')

    def test_public_headers_have_users_elsewhere(self):
        api = [f"include/elastogear/{header}" for header in check_includes.API]

        def needless(files):
            return [message.split(":")[0] for message in found_in(files, check_includes.all_violations)
                    if "no other module" in message and message.split(":")[0] not in api]

        header, deeper = "include/elastogear/mesh/a.h", "include/elastogear/mesh/b.h"
        files = {header: ['"elastogear/mesh/b.h"'], deeper: [], "src/mesh/a.cpp": ['"elastogear/mesh/a.h"']}
        self.assertEqual(sorted(needless(files)), [header, deeper])
        self.assertEqual(needless(files | {"src/fem/a.cpp": ['"elastogear/mesh/a.h"']}), [])
        self.assertEqual(needless(files | {"examples/a.cpp": ['"elastogear/mesh/a.h"']}), [])
        self.assertEqual(needless(files | {"studies/a.cpp": ['"elastogear/mesh/a.h"']}), [])

    def test_knots_are_found_and_twos_are_not(self):
        def knots(files):
            return [message for message in found_in(files, check_includes.all_violations) if "knot" in message]

        twos = {"src/fem/a.h": [], "src/fem/a.cpp": ['"fem/b.h"'], "src/fem/b.h": ['"fem/a.h"']}
        self.assertEqual(knots(twos), [])
        threes = twos | {"src/fem/b.h": ['"fem/c.h"'], "src/fem/c.h": ['"fem/a.h"']}
        self.assertEqual(knots(threes), ["a knot of includes: fem/a, fem/b, fem/c"])

    def test_rings_of_folders_are_reported(self):
        def found(files):
            return [message for message in found_in(files, check_includes.all_violations) if "folders" in message]

        down = {"src/fem/a.cpp": ['"fem/b/b.h"'], "src/fem/b/b.h": ['"elastogear/fem/c.h"'], "include/elastogear/fem/c.h": []}
        self.assertEqual(found(down), [])
        self.assertEqual(found(down | {"src/fem/b/d.cpp": ['"fem/a.h"'], "src/fem/a.h": []}), ["folders include each other: src/fem, src/fem/b"])

    def test_unknown_modules_are_reported(self):
        self.assert_forbidden("src/utils/a.cpp", '"elastogear/base/error.h"')


if __name__ == "__main__":
    unittest.main()
