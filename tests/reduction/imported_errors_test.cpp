// Matrices of other programs that give no body.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "elastogear/base/error.h"
#include "imported_files.h"

namespace elastogear::imported_errors_test {
namespace {

using namespace test;
using testing::HasSubstr;

// Every rank throws the same message, which names `part`.
void expect_error(const mesh::Mesh& mesh, const reduction::ReductionOptions& options,
                  const std::string& part) {
  std::string message;
  try {
    reduced(mesh, options, "error");
  } catch (const Error& error) {
    message = error.what();
  }
  EXPECT_THAT(message, HasSubstr(part));
}

TEST(ImportedBody, of_damaged_files_is_an_error_on_all_ranks) {
  const auto mesh = block();
  auto options = options_of_block();
  Files files = our_matrices(mesh, {});
  options.imported = files.imported;
  const auto with_stiffness = [&](const std::function<void(Labelled&)>& change, const std::string& part) {
    Labelled K = files.K;
    change(K);
    if (is_root()) write_triplets(files.imported.stiffness, K, Half::both);
    expect_error(mesh, options, part);
  };
  if (is_root()) write_triplets(files.imported.mass, files.M, Half::lower);
  with_stiffness([](auto& K) { K.A.coeffRef(3, 0) *= 1.01; }, "not symmetric");
  with_stiffness([](auto& K) { K.A.coeffRef(5, 5) = -1; }, "node 2, direction 3 has no positive entry");
  with_stiffness([](auto& K) { K.A.coeffRef(5, 5) = NAN; }, "nan");
  with_stiffness([](auto& K) { K.A.conservativeResize(90, 90); }, "complete?");
  with_stiffness([](auto& K) { K.A.conservativeResize(200, 200), K.A.coeffRef(199, 199) = 1; },
                 "row 200 of 180");
  with_stiffness([](auto& K) { K.A.coeffRef(100, 100) *= 1e-3; },
                 "k.txt: the matrix is not positive definite");
  if (is_root()) {
    Labelled M = files.M;
    M.A.coeffRef(90, 93) = M.A.coeffRef(93, 90) = 10 * M.A.coeff(90, 90);
    write_triplets(files.imported.mass, M, Half::lower);
  }
  options.restrain = {"xmax"};
  expect_error(mesh, options, "m.txt: the matrix is not positive definite");
  options.imported->mass = "/nowhere.txt";
  expect_error(mesh, options, "/nowhere.txt");
}

TEST(ImportedBody, without_restraint_is_an_error_that_offers_a_free_body) {
  const auto mesh = block();
  auto options = options_of_block();
  Files files = our_matrices(mesh, {});
  if (is_root()) {
    write_triplets(files.imported.stiffness, files.K, Half::lower);
    write_triplets(files.imported.mass, files.M, Half::lower);
  }
  options.imported = files.imported;
  options.restrain = {};
  expect_error(mesh, options, "restrain");
  options.floating = true;
  mesh::Mesh moved = mesh;
  moved.X.row(0) += 0.3 * mesh.X.row(1).cwiseAbs2();
  expect_error(moved, options, "coordinates");
}

}  // namespace
}  // namespace elastogear::imported_errors_test
