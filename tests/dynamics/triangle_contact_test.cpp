// Contact surfaces of triangles and of cut second-order sides: from a mesh through reduction to a simulation.
#include <gtest/gtest.h>

#include <unistd.h>
#include <Eigen/Geometry>

#include <filesystem>

#include "../fem/other_cells.h"
#include "elastogear/dynamics/simulate.h"
#include "elastogear/io/body_file.h"
#include "elastogear/reduction/reduce.h"

namespace elastogear::triangle_contact_test {
using namespace dynamics;
using mesh::CellType;

namespace {

constexpr double kForce = 1000;    // N
constexpr double kSettled = 1e-3;  // relative: what is left of the approach
const model::Material kRubber{1e6, 0.3, 1000};

std::shared_ptr<const model::ElasticBody> block(const mesh::Mesh& mesh, const std::string& held,
                                                const std::string& surface) {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("triangle_contact_" + std::to_string(getpid()) + ".h5"))
          .string();
  reduction::ReductionOptions options;
  options.name = held;
  options.regions = {{"", kRubber}};
  options.restrain = {held};
  options.surface = {surface};
  options.n_modes = 20;
  options.alpha = 50;
  reduction::reduce(PETSC_COMM_SELF, mesh, options, path);
  auto body = std::make_shared<model::ElasticBody>(io::read_body(path));
  std::filesystem::remove(path);
  return body;
}

// The mesh of another cell type, with the brick's face sets cut as the cells cut them.
mesh::Mesh cells_with_faces(CellType type, const mesh::Mesh& brick) {
  mesh::Mesh mesh = test::cells_of(type, brick);
  const double top = mesh.X.row(2).maxCoeff(), bottom = mesh.X.row(2).minCoeff();
  const auto at = [&](const mesh::Face& face, double z) {
    return std::all_of(face.begin(), face.end(),
                       [&](int node) { return std::abs(mesh.X(2, node) - z) < 1e-9; });
  };
  for (const mesh::Face& face : mesh.face_sets.at("surface")) {
    if (at(face, top)) mesh.face_sets["zmax"].push_back(face);
    if (at(face, bottom)) mesh.face_sets["zmin"].push_back(face);
  }
  return mesh;
}

struct Pair {
  CellType upper, lower;
};

// A block slides down onto a larger one under a force; a damper takes the energy of the approach.
System press(const Pair& cells) {
  const auto lower =
      block(cells_with_faces(cells.lower, test::brick({3, 3, 2}, {1, 1, 0.5})), "zmin", "zmax");
  const auto upper =
      block(cells_with_faces(cells.upper, test::brick({2, 2, 2}, {0.5, 0.5, 0.4})), "zmax", "zmin");
  body::Joint joint{.type = body::JointType::prismatic, .r_WB0 = {0.3, 0.2, 0.501}};
  joint.R_WB0 = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ());
  const Axis slide{.load = constant_signal(-kForce), .damping = 1e4};
  PairSetup pair{"upper:lower", {0, 1}, {}};
  pair.settings.two_pass = true;
  return System({{.name = "upper", .body = upper, .joint = joint, .translation = slide},
                 {.name = "lower", .body = lower}},
                {pair});
}

class Press : public testing::TestWithParam<Pair> {};

TEST_P(Press, transmits_its_force_through_the_contact) {
  System system = press(GetParam());
  model::Snapshot last;
  const RunSummary run = simulate(system, {.dt = 2e-3, .end_time = 1, .rho_inf = 0.8},
                                  [&](const model::Snapshot& x) { last = x; });
  const model::PairState& pair = last.pairs[0];
  EXPECT_NEAR(pair.force.z() / kForce, -1, kSettled);  // on the lower block
  EXPECT_LT(pair.force.head<2>().norm(), 0.05 * kForce);
  EXPECT_GT(pair.count, 8);
  EXPECT_LT(std::abs(last.bodies[0].s_dot[0]), 1e-4);
  EXPECT_LT(run.largest_imbalance, 0.02 * last.energy.work);
}

INSTANTIATE_TEST_SUITE_P(
    Cells, Press,
    testing::Values(Pair{CellType::tet4, CellType::hex8}, Pair{CellType::tet10, CellType::hex8},
                    Pair{CellType::hex20, CellType::wedge15}, Pair{CellType::tet10, CellType::tet10}),
    [](const auto& info) {
      return std::string(mesh::name(info.param.upper)) + "_on_" + mesh::name(info.param.lower);
    });

}  // namespace
}  // namespace elastogear::triangle_contact_test
