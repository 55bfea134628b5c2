// The floating frame at inertia level full against bodies that know neither a frame nor a reduction.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "../fem/other_cells.h"
#include "../figures.h"
#include "../reduction/calculix.h"
#include "box_body.h"
#include "elastogear/base/petsc.h"
#include "elastogear/base/rotation.h"
#include "elastogear/dynamics/simulate.h"
#include "elastogear/io/body_file.h"
#include "elastogear/reduction/reduce.h"

namespace elastogear::unreduced_test {
using namespace dynamics;
using body::InertiaLevel;
using body::JointType;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr int kRigid = 6;

// Newton's method to roundoff in every step.
class Tight {
 public:
  Tight() { check(PetscOptionsSetValue(nullptr, "-snes_rtol", "1e-13")); }
  ~Tight() { PetscOptionsClearValue(nullptr, "-snes_rtol"); }
  Tight(const Tight&) = delete;
};

// All elastic modes of a body of the full basis that nothing holds.
struct CompleteBody {
  MatrixXd Phi;  // n_dofs x n_q
  std::shared_ptr<model::ElasticBody> body;
};

CompleteBody complete(const model::ElasticBody& full) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> modes{MatrixXd(full.K_r), MatrixXd(full.M_r)};
  const Eigen::Index n = full.n_q() - kRigid;
  CompleteBody result{modes.eigenvectors().rightCols(n), nullptr};
  result.body =
      std::make_shared<model::ElasticBody>(test::in_modes(full, result.Phi, modes.eigenvalues().tail(n)));
  return result;
}

// Start of a flight: the frame's motion, and velocities of the modes.
struct Launch {
  Vector3d v, w;  // m/s; rad/s
  VectorXd q_dot;
};

System flying(const CompleteBody& body, const Launch& launch, InertiaLevel level) {
  return System({{.name = "body",
                  .body = body.body,
                  .joint = {JointType::free},
                  .velocity0 = launch.v,
                  .omega0 = launch.w,
                  .q_dot0 = launch.q_dot}},
                {}, {.inertia = level});
}

// World positions of all nodes, whose undeformed ones are X.
Eigen::Matrix3Xd positions(const CompleteBody& body, const Eigen::Matrix3Xd& X,
                           const model::BodyState& state) {
  const VectorXd u = body.Phi * state.q;
  return (state.R_WB * (X + u.reshaped(3, X.cols()))).colwise() + state.r_WB;
}

Eigen::Matrix3Xd velocities(const CompleteBody& body, const Eigen::Matrix3Xd& X, const Launch& launch) {
  const VectorXd u_dot = body.Phi * launch.q_dot;
  return (skew(launch.w) * X + u_dot.reshaped(3, X.cols())).colwise() + launch.v;
}

double distance(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  return std::sqrt((a - b).colwise().squaredNorm().maxCoeff());
}

// ---- nodes in the world, in the stead of frame and modes

// Node positions x with the constant mass M and the elastic energy d'K d / 2 of d = R'(x - r) - X. r and R
// are those of the mean-axis frame: S'M d = 0 for the rigid fields S about the centre of mass.
class AbsoluteBody {
 public:
  AbsoluteBody(const model::ElasticBody& full)
      : K_(full.K_r), M_(full.M_r), M_inverse_(M_.llt()), S_(M_.rows(), kRigid) {
    MatrixXd M_S(M_.rows(), kRigid);
    M_S << full.inertia.C_l, full.inertia.C_r;
    S_ = M_inverse_.solve(M_S);
    M_S_ = M_S;
    X_.resize(3, M_.rows() / 3);  // from the rotations e_3 x X = (-y, x, 0) and e_1 x X = (0, -z, y)
    for (Eigen::Index i = 0; i < X_.cols(); ++i)
      X_.col(i) << S_(3 * i + 1, 5), -S_(3 * i, 5), -S_(3 * i + 1, 3);
  }

  const Eigen::Matrix3Xd& X() const { return X_; }

  // At x, with R_ of the last call as first guess.
  Eigen::Matrix3Xd acceleration(const Eigen::Matrix3Xd& x) {
    const Vector3d r = x.reshaped().transpose() * M_S_.leftCols<3>() / (M_S_.col(0).dot(S_.col(0)));
    const Eigen::Matrix3Xd y_W = x.colwise() - r;
    align(y_W);
    const Eigen::Matrix3Xd y = R_.transpose() * y_W;
    const VectorXd K_d = K_ * (y - X_).reshaped();
    const MatrixXd S_y = rigid_fields(y), A = M_S_.transpose() * S_y;
    const VectorXd a = S_ * A.transpose().lu().solve(S_y.transpose() * K_d) - M_inverse_.solve(K_d);
    return R_ * a.reshaped(3, x.cols());
  }

 private:
  static MatrixXd rigid_fields(const Eigen::Matrix3Xd& y) {
    MatrixXd S(3 * y.cols(), kRigid);
    for (Eigen::Index i = 0; i < y.cols(); ++i)
      S.middleRows<3>(3 * i) << Eigen::Matrix3d::Identity(), -skew(y.col(i));
    return S;
  }

  // Newton's method for the integral of rho X x R'y_W.
  void align(const Eigen::Matrix3Xd& y_W) {
    constexpr int kIterations = 6;
    for (int i = 0; i < kIterations; ++i) {
      const Eigen::Matrix3Xd y = R_.transpose() * y_W;
      const MatrixXd M_S_r = M_S_.rightCols<3>();
      const Eigen::Matrix3d slope = M_S_r.transpose() * rigid_fields(y).rightCols<3>();
      const Vector3d moment = M_S_r.transpose() * y.reshaped();
      R_ = R_ * rotation_matrix(slope.lu().solve(moment));
    }
  }

  MatrixXd K_, M_;
  Eigen::LLT<MatrixXd> M_inverse_;
  MatrixXd S_, M_S_;
  Eigen::Matrix3Xd X_;
  Eigen::Matrix3d R_ = Eigen::Matrix3d::Identity();
};

// By the classical Runge-Kutta method.
Eigen::Matrix3Xd fly(AbsoluteBody& body, Eigen::Matrix3Xd v, double end, int n_steps) {
  const double h = end / n_steps;
  Eigen::Matrix3Xd x = body.X();
  for (int i = 0; i < n_steps; ++i) {
    const Eigen::Matrix3Xd a_1 = body.acceleration(x), v_2 = v + h / 2 * a_1,
                           a_2 = body.acceleration(x + h / 2 * v), v_3 = v + h / 2 * a_2,
                           a_3 = body.acceleration(x + h / 2 * v_2), v_4 = v + h * a_3,
                           a_4 = body.acceleration(x + h * v_3);
    x += h / 6 * (v + 2 * v_2 + 2 * v_3 + v_4);
    v += h / 6 * (a_1 + 2 * a_2 + 2 * a_3 + a_4);
  }
  return x;
}

model::ElasticBody soft_box() {
  return test::make_box(
      {.corner = {-1, -0.5, -0.25}, .size = {2, 1, 0.5}, .cells = {3, 2, 1}, .material = {200, 0.3, 1}},
      model::Basis::full);
}

constexpr double kFlight = 2;  // s

constexpr double kBent = 0.15;  // m, at least

Eigen::Matrix3Xd last_positions(const CompleteBody& body, const Eigen::Matrix3Xd& X, System system,
                                double dt) {
  const Tight tight;
  model::Snapshot last;
  double deformation = 0;
  simulate(system, {.dt = dt, .end_time = kFlight}, [&](const model::Snapshot& snapshot) {
    last = snapshot;
    deformation = std::max(deformation, (body.Phi * snapshot.bodies[0].q).cwiseAbs().maxCoeff());
  });
  EXPECT_GT(deformation, kBent) << "m, largest displacement of a node in the body frame";
  return positions(body, X, last.bodies[0]);
}

// ---- CalculiX

mesh::Mesh hex20_beam(const Vector3d& size) {
  mesh::Mesh beam = test::cells_of(mesh::CellType::hex20, test::brick({4, 1, 1}, size));
  beam.X.colwise() -= size / 2;
  return beam;
}

CompleteBody reduce_complete(const mesh::Mesh& mesh, const model::Material& material) {
  reduction::ReductionOptions options;
  options.name = "beam";
  options.regions = {{"", material}};
  options.floating = options.frame_at_center = true;
  options.basis = model::Basis::full;
  options.invariants = reduction::Invariants::full;
  const std::string output = (std::filesystem::temp_directory_path() / "unreduced_beam.h5").string();
  reduction::reduce(PETSC_COMM_SELF, mesh, options, output);
  const model::ElasticBody full = io::read_body(output);
  std::filesystem::remove(output);
  return complete(full);
}

struct Comparison {
  double distance, deformation;  // m, largest
};

// The same flight in both programs with the same step, nodes in all modes as fast as kSpeed at most.
Comparison compare(const CompleteBody& body, const mesh::Mesh& beam, const model::Material& material,
                   const Vector3d& w) {
  constexpr double kSpeed = 1;  // m/s
  constexpr int kSteps = 300, kEvery = 10;
  const double dt = 1 / body.body->frequency[0] / 40;
  Launch launch{{0.5, -0.3, 0.2}, w, VectorXd::Zero(body.body->n_q())};
  for (int i : {0, 1, 2}) launch.q_dot[i] = kSpeed / body.Phi.col(i).cwiseAbs().maxCoeff();
  const auto expected = test::calculix_motion({beam, material, {}, "C3D20"},
                                              {velocities(body, beam.X, launch), dt, kSteps, kEvery});
  System system = flying(body, launch, InertiaLevel::full);
  Comparison result{0, 0};
  int printed = -1;
  simulate(system, {.dt = dt, .end_time = kSteps * dt, .output_every = kEvery}, [&](const auto& x) {
    if (++printed == 0) return;
    const model::BodyState& state = x.bodies[0];
    const auto now = positions(body, beam.X, state);
    result.distance = std::max(result.distance, distance(now, beam.X + expected.at(printed - 1)));
    result.deformation = std::max(result.deformation, (body.Phi * state.q).cwiseAbs().maxCoeff());
  });
  EXPECT_EQ(printed, kSteps / kEvery);
  return result;
}

// Deforms by kBent at a length of 2 m while it turns by 2 rad.
TEST(FlyingBox, moves_as_its_finite_elements_do_in_absolute_coordinates) {
  const model::ElasticBody full = soft_box();
  const CompleteBody body = complete(full);
  Launch launch{{0.1, 0.2, -0.1}, {0.3, 1, 0.2}, VectorXd::Zero(body.body->n_q())};
  launch.q_dot.head<3>() << 0.7, -0.7, 0.7;
  AbsoluteBody absolute(full);
  const Eigen::Matrix3Xd X = absolute.X();
  const auto v = velocities(body, X, launch);
  const auto reference = fly(absolute, v, kFlight, 2000);
  const auto error_of = [&](InertiaLevel level) {
    const auto coarse = last_positions(body, X, flying(body, launch, level), 0.0025),
               fine = last_positions(body, X, flying(body, launch, level), 0.00125);
    return distance((4 * fine - coarse) / 3, reference);  // the error of second order eliminated
  };
  const double full_error = error_of(InertiaLevel::full), linear_error = error_of(InertiaLevel::linear);
  std::cout << "error of positions: full " << full_error << " m, linear " << linear_error << " m\n";
  test::figure({"free flight of a box", "path at level `full`", "m"}, full_error, 1.5e-4);
  EXPECT_GT(linear_error, 500 * full_error);
}

// Seven periods of bending during a quarter turn at the faster speed. What is left is the stiffening by the
// spin, which linear strains do not have: its effect on the phase grows with the square of the speed.
TEST(FlyingBeam, moves_as_in_calculix_up_to_stiffening_by_the_spin) {
  if (!test::calculix_is_installed()) GTEST_SKIP() << "ccx is not installed";
  const model::Material material{1e9, 0.3, 1000};
  const mesh::Mesh beam = hex20_beam({1, 0.1, 0.08});
  const CompleteBody body = reduce_complete(beam, material);
  const Vector3d w(6, 4, 20);
  const Comparison fast = compare(body, beam, material, w), slow = compare(body, beam, material, w / 2);
  for (const Comparison& c : {fast, slow})
    std::cout << "largest distance of nodes: " << c.distance << " m, deformation " << c.deformation << " m\n";
  EXPECT_LT(slow.distance, 0.03 * slow.deformation);
  EXPECT_NEAR(std::log2(fast.distance / slow.distance), 2, 0.3);
}

// Held at one end, on a joint that leaves all rotations free.
TEST(FullBasis, moves_as_the_complete_set_of_modes) {
  const test::BoxSpec spec{
      .size = {2, 1, 0.5}, .cells = {3, 1, 1}, .material = {200, 0.3, 1}, .held = [](const auto& X, int) {
        return X.x() < 0.1;
      }};
  const auto tip = [&](model::Basis basis) {
    const Tight tight;
    const auto box = std::make_shared<model::ElasticBody>(test::make_box(spec, basis));
    System system({{.name = "box", .body = box, .joint = {JointType::spherical}, .omega0 = {0.5, 1, 2}}}, {},
                  {.inertia = InertiaLevel::full, .gravity = {0, -1, 0}});
    model::Snapshot last;
    simulate(system, {.dt = 0.01, .end_time = 0.5}, [&](const model::Snapshot& x) { last = x; });
    const model::BodyState& state = last.bodies[0];
    const int node = static_cast<int>(box->surface.X.cols()) - 1;
    const Vector3d u = model::displacement(box->surface.Phi, node, state.q);
    EXPECT_GT(u.norm(), 0.05);
    return Vector3d(state.R_WB * (box->surface.X.col(node) + u));
  };
  const double kRoundoff = 1e-9;  // over 50 steps; modes of a dense eigensolver
  EXPECT_LT((tip(model::Basis::full) - tip(model::Basis::modal)).norm(), kRoundoff);
}

}  // namespace
}  // namespace elastogear::unreduced_test
