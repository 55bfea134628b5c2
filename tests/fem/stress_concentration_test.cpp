// Stresses at a hole and at a cavity against their closed forms, averaged and recovered on the free surface.
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <iostream>
#include <numbers>

#include "../figures.h"
#include "elastogear/base/tensor.h"
#include "elastogear/fem/stress.h"
#include "elastogear/mesh/surface_patches.h"
#include "elastogear/recovery/patch_error.h"
#include "other_cells.h"
#include "system.h"

namespace elastogear::stress_concentration_test {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;
using mesh::CellType;
using mesh::Mesh;

constexpr double kPi = std::numbers::pi, kTension = 1e6;  // Pa, far away
constexpr double kNu = 0.3, kMu = 210e9 / 2.6;

// Plate of infinite extent with a hole of radius 1 m along z under tension along x, plane strain (E. G.
// Kirsch, 1898): stress 3 T beside the hole.
Vector3d hole(const Vector3d& X) {
  const double r = std::hypot(X.x(), X.y()), theta = std::atan2(X.y(), X.x()), kappa = 3 - 4 * kNu;
  const double c = std::cos(2 * theta), s = std::sin(2 * theta), cube = r * r * r;
  const double u_r = r * (kappa - 1 + 2 * c) + 2 / r * (1 + (1 + kappa) * c) - 2 / cube * c,
               u_t = (-2 * r + 2 / r * (1 - kappa) - 2 / cube) * s;
  const double cos = X.x() / r, sin = X.y() / r;
  return kTension / (8 * kMu) * Vector3d(u_r * cos - u_t * sin, u_r * sin + u_t * cos, 0);
}

// Body of infinite extent with a spherical cavity of radius 1 m under tension along z (J. N. Goodier, J.
// Appl. Mech. 55 (1933) 39-44): stress (27 - 15 nu) / (2 (7 - 5 nu)) T = 2.045 T at its equator.
Vector3d cavity(const Vector3d& X) {
  const double r = X.norm(), rho = std::hypot(X.x(), X.y()), cos = X.z() / r, sin = rho / r;
  const double k = 1 / (8 * kMu * (7 - 5 * kNu)), A = -k * (13 - 10 * kNu), B = k, C = 5 * k * (1 - 2 * kNu);
  const double r_2 = r * r, r_4 = r_2 * r_2;
  const double u_r = -A / r_2 - 3 * B / r_4 +
                     ((5 - 4 * kNu) / (1 - 2 * kNu) * C / r_2 - 9 * B / r_4) * (cos * cos - sin * sin),
               u_t = -(2 * C / r_2 + 6 * B / r_4) * 2 * sin * cos;
  const Vector3d e_r = X / r, e_t = (e_r * cos - Vector3d::UnitZ()) / sin;
  const double E = 2 * kMu * (1 + kNu);
  return kTension * (u_r * e_r + u_t * e_t + Vector3d(-kNu * X.x(), -kNu * X.y(), X.z()) / E);
}

double von_mises(const Vector6& s) {
  const double mean = s.head<3>().mean();
  return std::sqrt(1.5 *
                   ((s.head<3>().array() - mean).matrix().squaredNorm() + 2 * s.tail<3>().squaredNorm()));
}

using Field = Vector3d (*)(const Vector3d&);

// From central differences, exact to 1e-9 of the largest.
Vector6 exact_stress(Field field, const Vector3d& X) {
  constexpr double kStep = 1e-5;
  Matrix3d gradient;
  for (int k = 0; k < 3; ++k)
    gradient.col(k) =
        (field(X + kStep * Vector3d::Unit(k)) - field(X - kStep * Vector3d::Unit(k))) / (2 * kStep);
  const Matrix3d strain = (gradient + gradient.transpose()) / 2;
  return six_entries(2 * kMu * kNu / (1 - 2 * kNu) * strain.trace() * Matrix3d::Identity() +
                     2 * kMu * strain);
}

struct Problem {
  Mesh mesh;
  Field field;
  double largest;                      // stress, Pa
  std::vector<mesh::Directions> held;  // with the displacement of the field
  std::vector<int> evaluated;          // nodes of the hole or cavity whose faces are all on it
};

// Half of the plate, two cells thick between planes of symmetry, n faces along a quarter of the hole.
Problem hole_problem(CellType type, int n) {
  const int rings = 3 * n / 4, layers = 2;
  const double ratio = std::exp(kPi / 2 / n), height = ratio - 1;
  Problem p{test::cells_of(type, test::brick({rings, 2 * n, layers}, {1. * rings, 2. * n, 1. * layers})),
            hole,
            3 * kTension,
            {},
            {}};
  p.mesh = test::mapped(p.mesh, [&](const Vector3d& X) {
    const double r = std::pow(ratio, X.x()), theta = kPi * X.y() / (2 * n);
    return Vector3d(r * std::cos(theta), r * std::sin(theta), height * X.z());
  });
  const double R = std::pow(ratio, rings), kSame = 1e-9;
  for (int i = 0; i < p.mesh.n_nodes(); ++i) {
    const Vector3d X = p.mesh.X.col(i);
    const double r = std::hypot(X.x(), X.y());
    const bool outside = r > R - kSame || X.y() < kSame,
               in_plane = X.z() < kSame || X.z() > layers * height - kSame;
    p.held.push_back(outside ? mesh::kAllDirections : in_plane ? mesh::Directions{4} : mesh::Directions{0});
    if (r < 1 + kSame && std::abs(X.x()) < 0.7) p.evaluated.push_back(i);
  }
  return p;
}

// The part of the space around the cavity that a face of a cube sees, with n x n faces on the cavity. Nodes
// on it are moved along it by up to a fifth of a face.
Problem cavity_problem(CellType type, int n) {
  const int rings = 3 * n / 5;
  const double ratio = std::exp(kPi / 2 / n);
  auto flat = test::brick({rings, n, n}, {1. * rings, 1. * n, 1. * n});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(-0.2, 0.2);
  for (int i = 0; i < flat.n_nodes(); ++i)
    for (int d : {1, 2})
      if (const double move = shift(random); flat.X(d, i) > 0.5 && flat.X(d, i) < n - 0.5)
        flat.X(d, i) += move;
  Problem p{test::cells_of(type, flat), cavity, (27 - 15 * kNu) / (2 * (7 - 5 * kNu)) * kTension, {}, {}};
  p.mesh = test::mapped(p.mesh, [&](const Vector3d& X) {
    const auto slope = [&](double x) { return std::tan(kPi / 2 * (x / n - 0.5)); };
    return Vector3d(std::pow(ratio, X.x()) * Vector3d(1, slope(X.y()), slope(X.z())).normalized());
  });
  const double R = std::pow(ratio, rings), kSame = 1e-9;
  for (int i = 0; i < p.mesh.n_nodes(); ++i) {
    const Vector3d X = p.mesh.X.col(i);
    const bool outside = X.norm() > R - kSame || X.tail<2>().cwiseAbs().maxCoeff() > X.x() - kSame;
    p.held.push_back(outside ? mesh::kAllDirections : mesh::Directions{0});
    if (!outside && X.norm() < 1 + kSame) p.evaluated.push_back(i);
  }
  return p;
}

Eigen::VectorXd solve(const Problem& p) {
  const auto system = test::assemble(p.mesh, {}, PETSC_COMM_SELF);
  const Eigen::SparseMatrix<double> K = fem::gather_matrix(system.matrices.K, system.rows);
  Eigen::VectorXd u(K.rows()), is_held(K.rows());
  for (int i = 0; i < p.mesh.n_nodes(); ++i) {
    u.segment<3>(3 * i) = p.field(p.mesh.X.col(i));
    for (int d = 0; d < 3; ++d) is_held[3 * i + d] = mesh::holds(p.held[i], d);
  }
  const Eigen::VectorXd is_open = 1 - is_held.array();
  const Eigen::SparseMatrix<double> held((is_held.cwiseProduct(Eigen::VectorXd(K.diagonal()))).asDiagonal()),
      A = Eigen::SparseMatrix<double>(is_open.asDiagonal() * K * is_open.asDiagonal()) + held;
  const Eigen::VectorXd known = is_held.cwiseProduct(u);
  return known - is_open.cwiseProduct(Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(A).solve(
                     is_open.cwiseProduct(Eigen::VectorXd(K * known))));
}

// Largest error of the stress tensor at the evaluated nodes, over the largest stress.
double error(const Problem& p, const Eigen::VectorXd& u, model::RecoveryMethod method) {
  const Eigen::MatrixXd sigma =
      fem::nodal_stress({p.mesh, test::kSteelBody, model::Element::incompatible, {method, {}}, p.held}, u);
  double largest = 0;
  for (int node : p.evaluated)
    largest = std::max(largest, (sigma.col(node) - exact_stress(p.field, p.mesh.X.col(node))).norm());
  return largest / p.largest;
}

// How the estimate tells the error of the von Mises stress at the evaluated nodes: of means the von Mises
// stress of the difference of both recoveries, of recovered stresses Eq. (1.17).
struct Estimate {
  double holds = 0;   // share of nodes where the error is below twice the estimate
  double median = 0;  // of estimate over error
};

// At all nodes, Pa.
struct BothRecoveries {
  Eigen::MatrixXd recovered;                     // 6 x n_nodes
  Eigen::VectorXd recovered_stress, difference;  // von Mises stresses
};

BothRecoveries both_recoveries(const Problem& p, const Eigen::VectorXd& u) {
  using model::RecoveryMethod;
  const auto stress = [&](RecoveryMethod method) {
    return fem::nodal_stress({p.mesh, test::kSteelBody, model::Element::incompatible, {method, {}}, p.held},
                             u);
  };
  BothRecoveries both{stress(RecoveryMethod::surface), {}, {}};
  const Eigen::MatrixXd difference = both.recovered - stress(RecoveryMethod::average);
  both.recovered_stress.resize(difference.cols());
  both.difference.resize(difference.cols());
  for (Eigen::Index i = 0; i < difference.cols(); ++i) {
    both.recovered_stress[i] = von_mises(both.recovered.col(i));
    both.difference[i] = von_mises(difference.col(i));
  }
  return both;
}

// Estimated errors of recovered stresses at the evaluated nodes, Pa.
std::vector<double> recovered_errors(const Problem& p, const BothRecoveries& both) {
  std::vector<double> errors;
  auto patches = mesh::surface_patches(p.mesh, p.evaluated);
  const std::vector<int> order = mesh::cell_orders(p.mesh, p.evaluated);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    std::erase_if(patches[i], [&](int node) { return both.difference[node] == 0; });
    errors.push_back(
        recovery::patch_error(both.difference(patches[i]), both.recovered_stress(patches[i]), order[i])
            .error);
  }
  return errors;
}

Estimate estimate(const Problem& p, const Eigen::VectorXd& u, model::RecoveryMethod method) {
  const BothRecoveries both = both_recoveries(p, u);
  const Eigen::MatrixXd sigma =
      fem::nodal_stress({p.mesh, test::kSteelBody, model::Element::incompatible, {method, {}}, p.held}, u);
  const Eigen::VectorXd of_means = both.difference(p.evaluated);
  const std::vector<double> estimated = method == model::RecoveryMethod::surface
                                            ? recovered_errors(p, both)
                                            : std::vector<double>(of_means.begin(), of_means.end());
  Estimate result;
  std::vector<double> ratio;
  for (std::size_t i = 0; i < p.evaluated.size(); ++i) {
    const int node = p.evaluated[i];
    const double truth = von_mises(exact_stress(p.field, p.mesh.X.col(node)));
    ratio.push_back(estimated[i] / std::abs(von_mises(sigma.col(node)) - truth));
    result.holds += (ratio.back() > 0.5) / static_cast<double>(p.evaluated.size());
  }
  std::nth_element(ratio.begin(), ratio.begin() + std::ssize(ratio) / 2, ratio.end());
  result.median = ratio[ratio.size() / 2];
  return result;
}

struct Case {
  const char* name;
  Problem (*make)(CellType type, int n);
  CellType type;
  std::vector<int> n;  // faces along a quarter of a circle
  double at_finest;    // bound of the error
  double gain;         // by which averages err more on the finest mesh
};

struct StressConcentration : testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Cases, StressConcentration,
                         testing::Values(Case{"hole", hole_problem, CellType::hex8, {4, 8, 16}, 0.006, 15},
                                         Case{"hole", hole_problem, CellType::tet4, {4, 8, 16}, 0.03, 4},
                                         Case{"hole", hole_problem, CellType::hex20, {4, 8}, 0.001, 30},
                                         Case{"hole", hole_problem, CellType::tet10, {4, 8}, 0.005, 8},
                                         Case{"cavity", cavity_problem, CellType::hex8, {4, 8, 12}, 0.02, 7},
                                         Case{"cavity", cavity_problem, CellType::tet4, {4, 8, 12}, 0.06, 3},
                                         Case{"cavity", cavity_problem, CellType::hex20, {4, 8}, 0.006, 6},
                                         Case{"cavity", cavity_problem, CellType::tet10, {4, 8}, 0.006, 8}),
                         [](const auto& info) {
                           return std::string(info.param.name) + "_" + mesh::name(info.param.type);
                         });

TEST_P(StressConcentration, is_nearer_to_the_closed_form_than_averages) {
  const Case& c = GetParam();
  double averaged = 0, recovered = 0;
  for (int n : c.n) {
    const Problem p = c.make(c.type, n);
    const Eigen::VectorXd u = solve(p);
    averaged = error(p, u, model::RecoveryMethod::average);
    recovered = error(p, u, model::RecoveryMethod::surface);
    std::cout << c.name << " " << mesh::name(c.type) << ", " << n << " faces per 90 degrees, "
              << p.mesh.n_nodes() << " nodes: averaged " << 100 * averaged << " %, recovered "
              << 100 * recovered << " %";
    const Estimate of_averaged = estimate(p, u, model::RecoveryMethod::average),
                   of_recovered = estimate(p, u, model::RecoveryMethod::surface);
    std::cout << "; estimate holds at " << 100 * of_averaged.holds << " and " << 100 * of_recovered.holds
              << " %, median of estimate over error " << of_averaged.median << " and " << of_recovered.median
              << "\n";
    EXPECT_GE(of_averaged.holds, 0.95);
    EXPECT_GE(of_recovered.holds, 0.95);
    EXPECT_GT(of_averaged.median, 1);
    EXPECT_LT(of_averaged.median, 6);
    EXPECT_GT(of_recovered.median, 1);
    if (c.type == CellType::hex8 || c.type == CellType::tet4) {
      EXPECT_LT(of_recovered.median, 15);
    }
    EXPECT_LT(recovered, 0.6 * averaged);
  }
  test::figure(
      {std::string(c.name) + ", " + mesh::name(c.type) + ", " + std::to_string(c.n.back()) + " faces",
       "stress tensor", "%"},
      recovered, c.at_finest);
  EXPECT_GT(averaged, c.gain * recovered);
}

}  // namespace
}  // namespace elastogear::stress_concentration_test
