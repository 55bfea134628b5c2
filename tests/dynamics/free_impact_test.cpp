// Two blocks that nothing holds collide: few free modes with residual flexibility, whose static responses are
// balanced by inertia, against all modes.
#include <gtest/gtest.h>

#include <filesystem>

#include "../fem/brick.h"
#include "../figures.h"
#include "elastogear/dynamics/simulate.h"
#include "elastogear/io/body_file.h"
#include "elastogear/reduction/eigenmodes.h"
#include "elastogear/reduction/reduce.h"

namespace elastogear::free_impact_test {
using namespace dynamics;
using Eigen::Vector3d;

namespace {

constexpr const char* kCase = "impact of two free blocks, 10 modes";
constexpr int kModes = 10;
constexpr double kSpeed = 0.5, kGap = 1e-3, kStep = 2e-4, kEnd = 0.04;  // m/s, m, s, s

enum class Kind { modal, flexible, all };

std::shared_ptr<const model::ElasticBody> block(Kind kind) {
  const auto mesh = test::brick({3, 2, 2}, {1, 0.8, 0.8});
  reduction::ReductionOptions o;
  o.name = "block";
  o.regions = {{"", {1e4, 0.3, 1}}};
  o.floating = o.frame_at_center = true;
  o.surface = {"xmin", "xmax"};
  o.n_modes = kind == Kind::all ? 3 * mesh.n_nodes() - 6 : kModes;
  o.flexibility = kind == Kind::flexible;
  o.window = reduction::kAutomaticWindow;
  // Static answers are read when they are needed.
  const std::string path = std::filesystem::temp_directory_path() /
                           ("free_impact_" + std::to_string(static_cast<int>(kind)) + ".h5");
  reduction::reduce(PETSC_COMM_WORLD, mesh, o, path);
  return std::make_shared<model::ElasticBody>(io::read_body(path));
}

// y: by which the blocks miss each other.
std::vector<model::Snapshot> impact(Kind kind, double y) {
  const auto body = block(kind);
  std::vector<BodySetup> setups{{.name = "a", .body = body}, {.name = "b", .body = body}};
  setups[0].joint.type = setups[1].joint.type = body::JointType::free;
  setups[0].velocity0 = {kSpeed, 0, 0};
  setups[1].joint.r_WB0 = {1 + kGap, y, 0};
  PairSetup pair{"a:b", {0, 1}, {}};
  pair.settings.stiffness = 5e3;
  pair.settings.depth = 0.05;
  pair.settings.two_pass = true;
  System system(setups, {pair});
  std::vector<model::Snapshot> history;
  simulate(system, {.dt = kStep, .end_time = kEnd}, [&](const model::Snapshot& s) { history.push_back(s); });
  return history;
}

double peak_force(const std::vector<model::Snapshot>& history) {
  double peak = 0;
  for (const model::Snapshot& s : history) peak = std::max(peak, s.pairs[0].force.norm());
  return peak;
}

// Between two snapshots, for steps may be cut.
Vector3d force_at(const std::vector<model::Snapshot>& history, double time) {
  const auto after = std::lower_bound(history.begin() + 1, history.end() - 1, time,
                                      [](const model::Snapshot& s, double t) { return s.time < t; });
  const model::Snapshot &a = after[-1], &b = *after;
  const double share = (time - a.time) / (b.time - a.time);
  return (1 - share) * a.pairs[0].force + share * b.pairs[0].force;
}

// L2 over time of the difference of the forces, as a share of the second.
double deviation(const std::vector<model::Snapshot>& a, const std::vector<model::Snapshot>& b) {
  double difference = 0, size = 0;
  for (double t = 0; t < kEnd; t += kStep) {
    difference += (force_at(a, t) - force_at(b, t)).squaredNorm();
    size += force_at(b, t).squaredNorm();
  }
  return std::sqrt(difference / size);
}

void print(const std::vector<model::Snapshot>& modal, const std::vector<model::Snapshot>& flexible,
           const std::vector<model::Snapshot>& exact) {
  std::cout << "peak force " << peak_force(exact) << " N; " << kModes << " modes " << peak_force(modal)
            << ", with residual flexibility " << peak_force(flexible) << "; deviation over time "
            << deviation(modal, exact) << ", " << deviation(flexible, exact) << "\n";
}

// 0 m: face to face; beside the middle the blocks turn away.
TEST(FreeImpact, with_residual_flexibility_nears_that_of_all_modes) {
  for (double y : {0., 0.3}) {
    const auto modal = impact(Kind::modal, y), flexible = impact(Kind::flexible, y),
               all = impact(Kind::all, y);
    print(modal, flexible, all);
    test::figure({kCase, "force (L2)", "%"}, deviation(flexible, all), 0.02);
    test::figure({kCase, "peak", "%"}, peak_force(flexible) / peak_force(all) - 1, 0.01);
    EXPECT_LT(deviation(flexible, all), 0.2 * deviation(modal, all));
    const Vector3d spin = all.back().bodies[1].s_dot.tail<3>(),
                   found = flexible.back().bodies[1].s_dot.tail<3>();
    EXPECT_EQ(spin.norm() > 0.1, y > 0);
    EXPECT_LT((found - spin).norm(), 0.01 * std::max(spin.norm(), 0.1));
  }
}

}  // namespace
}  // namespace elastogear::free_impact_test
