// Compliance of stations: from nodal responses, and of rollers of finite length on half-spaces.

#include "contact/stations/station_compliance.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "elastogear/contact/station_forces.h"
#include "flank_grids.h"

namespace elastogear::contact::station_compliance_test {
namespace {

const double kSteel = (1 - 0.09) / (std::numbers::pi * 210e9);  // 1/Pa

TEST(BodyCompliance, is_the_mean_response_to_the_loads) {
  constexpr int kNodes = 7, kStations = 4;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto noise = [&] { return normal(random); };
  const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(3 * kNodes, 3 * kNodes, noise),
                        F = A * A.transpose();
  BodyLoads loads{};
  for (int a = 0; a < kNodes; ++a) loads.node.push_back(10 + 3 * a);
  loads.weight = Eigen::MatrixXd::NullaryExpr(kStations, kNodes, noise);
  loads.direction = Eigen::Matrix3Xd::NullaryExpr(3, kStations, noise).colwise().normalized();
  const NodalResponse response = [&](int a, int b) -> Eigen::Matrix3d {
    return F.block<3, 3>(a - 10, b - 10);
  };
  const Eigen::MatrixXd C = body_compliance(loads, response);
  for (Eigen::Index i = 0; i < kStations; ++i)
    for (Eigen::Index j = 0; j < kStations; ++j) {
      double sum = 0;
      for (int a = 0; a < kNodes; ++a)
        for (int b = 0; b < kNodes; ++b)
          sum += loads.weight(i, a) * loads.weight(j, b) *
                 loads.direction.col(i).dot(F.block<3, 3>(3 * a, 3 * b) * loads.direction.col(j));
      EXPECT_NEAR(C(i, j), sum, 1e-12 * C.norm());
    }
  EXPECT_EQ(C, C.transpose());
  loads.node.pop_back();
  EXPECT_ANY_THROW(body_compliance(loads, response));
}

TEST(LocalCompliance, acts_within_pairs_of_teeth) {
  const std::vector<StationLine> stations{{4, {0, 1}}, {4, {1, 2}}, {5, {0, 1}}};
  BodyLoads loads{};
  loads.compliance = 3;
  loads.smooth = Eigen::MatrixXd::Constant(3, 3, 0.1);
  const Eigen::MatrixXd C = local_compliance(stations, loads, 0.05);
  EXPECT_EQ(C(0, 2), 0);
  EXPECT_EQ(C(2, 1), 0);
  EXPECT_NEAR(C(2, 2), 3 * (line_inverse_distance({0, 1}, {0, 1}, 0.05) - 0.1), 1e-12);
  EXPECT_NEAR(C(0, 1), 3 * (line_inverse_distance({0, 1}, {1, 2}, 0.05) - 0.1), 1e-12);
}

// A roller of the radius 8 mm and the length 16 mm, pressed by 8 um against a flat body that goes on beyond
// it.
struct Roller {
  static constexpr double kLength = 16e-3, kRadius = 8e-3, kWidth = 0.3e-3;
  StationProblem problem;

  Roller(int n, const FreeEnds& own, const FreeEnds& flat) {
    std::vector<StationLine> stations;
    for (int i = 0; i < n; ++i) stations.push_back({0, {i * kLength / n, (i + 1) * kLength / n}});
    problem.C = Eigen::MatrixXd::Zero(n, n);
    for (const FreeEnds& ends : {own, flat}) {
      BodyLoads half_space{};
      half_space.compliance = kSteel;
      half_space.smooth = Eigen::MatrixXd::Zero(n, n);
      half_space.ends = ends;
      problem.C += local_compliance(stations, half_space, Roller::kWidth);
    }
    problem.own.assign(static_cast<std::size_t>(n), {kLength / n, kRadius, 2 * kSteel, kWidth});
    problem.gap = Eigen::VectorXd::Constant(n, -8e-6);
  }
  // Load of each station over the mean.
  Eigen::VectorXd relative_load() const {
    const Eigen::VectorXd f = station_forces(problem).f;
    return f / f.mean();
  }
};

const FreeEnds kRollerEnds{0, Roller::kLength};

// Half-spaces that go on beyond the roller hold its ends up: their pressure rises, the more the finer it is
// asked (K. L. Johnson, Contact Mechanics, 1985, section 5.4). Images let go of them where a body ends.
TEST(Rollers, have_end_loads_where_a_body_goes_on_and_none_where_both_end) {
  const Eigen::VectorXd both_go_on = Roller(32, {}, {}).relative_load();
  const Eigen::VectorXd one_ends = Roller(32, kRollerEnds, {}).relative_load();
  const Eigen::VectorXd both_end = Roller(32, kRollerEnds, kRollerEnds).relative_load();
  for (const Eigen::VectorXd& load : {both_go_on, one_ends, both_end})
    EXPECT_LT((load - load.reverse()).norm(), 1e-8);
  EXPECT_GT(both_go_on[0], 1.2);
  EXPECT_GT(one_ends[0], 1.08);
  EXPECT_LT(one_ends[0], both_go_on[0] - 0.05);
  EXPECT_LT((both_end.array() - 1).abs().maxCoeff(), 0.05);
  EXPECT_GT(Roller(64, {}, {}).relative_load()[0], both_go_on[0] + 0.02);
}

// Images at infinity on both sides would make the roller a part of an endless one: with one image at each end
// of two the middle is off by what the others would do.
TEST(Rollers, with_one_free_end_are_half_of_longer_ones) {
  const Eigen::VectorXd whole = Roller(40, {}, {}).relative_load();
  const FreeEnds middle{Roller::kLength / 2, std::numeric_limits<double>::infinity()};
  std::vector<StationLine> stations;
  BodyLoads half_space{};
  half_space.compliance = 2 * kSteel;
  half_space.smooth = Eigen::MatrixXd::Zero(20, 20);
  half_space.ends = middle;
  const double D = Roller::kLength / 40;
  for (int i = 20; i < 40; ++i) stations.push_back({0, {i * D, (i + 1) * D}});
  StationProblem half{local_compliance(stations, half_space, Roller::kWidth),
                      std::vector<StationLaw>(20, {D, Roller::kRadius, 2 * kSteel, Roller::kWidth}),
                      Eigen::VectorXd::Constant(20, -8e-6)};
  const Eigen::VectorXd f = station_forces(half).f;
  EXPECT_LT((f / f.mean() - whole.tail(20)).lpNorm<Eigen::Infinity>(), 1e-8);
}

// Under a load that leans over the face the contact is up to 0.4 mm wide: strips may be longer and shorter.
TEST(Rollers, are_loaded_the_same_with_any_number_of_stations) {
  const auto load = [](int n) {
    Roller roller(n, kRollerEnds, kRollerEnds);
    for (int i = 0; i < n; ++i) roller.problem.gap[i] = -12e-6 + 10e-6 * (i + 0.5) / n;
    return Eigen::VectorXd(station_forces(roller.problem).f);
  };
  const Eigen::VectorXd finest = load(128);
  for (int n : {8, 16, 64}) {
    const Eigen::VectorXd f = load(n), same = finest.reshaped(128 / n, n).colwise().sum().transpose();
    const Eigen::VectorXd off = (f - same).cwiseAbs() / same.mean();
    EXPECT_NEAR(f.sum(), finest.sum(), 1e-3 * finest.sum());
    EXPECT_LT(off.segment(1, n - 2).maxCoeff(), 0.01) << n;
    EXPECT_LT(off.maxCoeff(), 0.03) << n;  // at the ends, where the load changes most
  }
}

// A load that leans over the roller and a hundred times as large a one leave strips narrower than the
// contact.
TEST(Rollers, are_found_under_any_load) {
  for (double closing : {1e-9, 8e-6, 1e-3, 0.02})
    for (int n : {16, 64}) {
      Roller roller(n, kRollerEnds, {});
      roller.problem.gap = Eigen::VectorXd::LinSpaced(n, -2 * closing, closing);
      const StationForces forces = station_forces(roller.problem);
      EXPECT_LT(forces.iterations, 30) << closing;
      EXPECT_GT(forces.f[0], 0);
      EXPECT_EQ(forces.f[n - 1], 0);
    }
}

// On a half-space in place of both meshes the smooth loads take out what they put in: the answer does not
// depend on how wide they are, and the compliance of stations in contact stays positive definite.
TEST(Rollers, do_not_depend_on_the_smooth_loads_of_a_half_space) {
  constexpr int kStations = 12;
  const FlankGrid flank = numbered_flank({-4e-3, -1e-3, 2e-3, 4e-3}, {0, 5e-3, 11e-3, 16e-3}, true);
  const auto places = even_stations(kStations, 0, Roller::kLength, 0.4e-3);
  std::vector<StationLine> stations;
  for (const StationPlace& place : places) stations.push_back({0, place.face});
  for (double a : {0.5e-3, 2e-3}) {
    BodyLoads body{};
    body.compliance = 2 * kSteel;
    body.ends = kRollerEnds;
    body.smooth = smooth_kernel(flank, places, {a, 2e-3}, kRollerEnds, {});
    const Eigen::MatrixXd local = local_compliance(stations, body, Roller::kWidth);
    StationProblem problem = Roller(kStations, kRollerEnds, kRollerEnds).problem;
    EXPECT_LT((local + body.compliance * body.smooth - problem.C).norm(), 1e-12 * problem.C.norm());
    Eigen::MatrixXd M = local;
    const double f = station_forces(problem).f.maxCoeff();
    for (Eigen::Index i = 0; i < kStations; ++i) M(i, i) += problem.own[static_cast<std::size_t>(i)].slope(f);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M).eigenvalues().minCoeff(), 0) << a;
  }
}

}  // namespace
}  // namespace elastogear::contact::station_compliance_test
