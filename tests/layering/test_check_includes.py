"""The include check must catch what it is there for."""
import os
import tempfile
import unittest

import check_includes


def violations_of(path, include):
    """Violations in a repository whose only file is `path` with one include."""
    with tempfile.TemporaryDirectory() as repository:
        os.makedirs(os.path.join(repository, os.path.dirname(path)))
        with open(os.path.join(repository, path), "w", encoding="utf-8") as file:
            file.write(f"#pragma once\n#include <vector>\n  #include {include}\n")
        return check_includes.violations(repository)


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

    def test_unknown_modules_are_reported(self):
        self.assert_forbidden("src/utils/a.cpp", '"elastogear/base/error.h"')


if __name__ == "__main__":
    unittest.main()
