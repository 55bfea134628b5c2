// Beams of solid elements, reduced and turned about one end, beside Euler and Bernoulli's theory.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>

#include "../fem/other_cells.h"
#include "../figures.h"
#include "../message_of.h"
#include "elastogear/base/petsc.h"
#include "elastogear/dynamics/simulate.h"
#include "elastogear/io/body_file.h"
#include "elastogear/reduction/reduce.h"

namespace elastogear::rotating_beam_test {
using namespace dynamics;
using body::InertiaLevel;
using Eigen::VectorXd;

namespace {

constexpr double kTiny = 1e-9;  // of a length

// Of a rectangular section: h in the plane of the motion, b across. nu = 0: no section changes its shape.
struct Beam {
  double L, h, b;      // m
  double E, rho;       // Pa, kg/m^3
  int cells, n_modes;  // hex20 along L

  double m() const { return rho * h * b; }  // kg/m
  double EI() const { return E * b * h * h * h / 12; }
};

std::shared_ptr<const model::ElasticBody> reduced(const Beam& beam) {
  reduction::ReductionOptions options;
  options.name = "beam";
  options.regions = {{"", {beam.E, 0, beam.rho}}};
  options.restrain = {"held"};
  options.surface = {"surface"};
  options.n_modes = beam.n_modes;
  options.completeness = false;
  options.invariants = reduction::Invariants::full;
  options.symmetry = reduction::Symmetry::none;
  mesh::Mesh mesh =
      test::cells_of(mesh::CellType::hex20, test::brick({beam.cells, 1, 1}, {beam.L, beam.h, beam.b}));
  for (int node = 0; node < mesh.n_nodes(); ++node)
    if (mesh.X(0, node) < kTiny * beam.L) mesh.node_sets["held"].push_back(node);
  mesh.X.row(1).array() -= beam.h / 2;
  mesh.X.row(2).array() -= beam.b / 2;
  const std::string output = (std::filesystem::temp_directory_path() / "rotating_beam.h5").string();
  reduction::reduce(PETSC_COMM_SELF, mesh, options, output);
  auto body = std::make_shared<model::ElasticBody>(io::read_body(output));
  std::filesystem::remove(output);
  return body;
}

// Mean displacement of the end face's nodes in the body frame.
Eigen::Vector3d tip(const model::ElasticBody& body, const VectorXd& q) {
  const double end = (1 - kTiny) * body.surface.X.row(0).maxCoeff();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int n = 0;
  for (int node = 0; node < body.surface.X.cols(); ++node)
    if (body.surface.X(0, node) > end) {
      sum += model::displacement(body.surface.Phi, node, q);
      ++n;
    }
  return sum / n;
}

// ---- the theory: bending modes of the cantilever with unit modal mass

constexpr int kModes = 5;
constexpr std::array<double, kModes> kRoots = {1.875104068711961, 4.694091132974175, 7.854757438237612,
                                               10.995540734875467, 14.137168391046471};  // cos x cosh x = -1
using Modal = Eigen::Array<double, kModes, 1>;
using ModalMatrix = Eigen::Matrix<double, kModes, kModes>;

struct Theory {
  Modal omega;         // rad/s
  Modal tip;           // of the modes
  Modal c, a;          // integrals of m x phi and m phi
  ModalMatrix string;  // integral of m (L^2 - x^2) / 2 phi_i' phi_j': stiffening by w^2
};

// phi and its derivative at x = s L.
std::array<double, 2> mode(const Beam& beam, int i, double s) {
  const double k = kRoots[i], sigma = (std::cosh(k) + std::cos(k)) / (std::sinh(k) + std::sin(k));
  const double scale = 1 / std::sqrt(beam.m() * beam.L);
  return {scale * (std::cosh(k * s) - std::cos(k * s) - sigma * (std::sinh(k * s) - std::sin(k * s))),
          scale * k / beam.L *
              (std::sinh(k * s) + std::sin(k * s) - sigma * (std::cosh(k * s) - std::cos(k * s)))};
}

Theory theory(const Beam& beam) {
  constexpr int kPoints = 2000;
  Theory t{Modal::Zero(), Modal::Zero(), Modal::Zero(), Modal::Zero(), ModalMatrix::Zero()};
  for (int i = 0; i < kModes; ++i) {
    t.omega[i] = std::pow(kRoots[i] / beam.L, 2) * std::sqrt(beam.EI() / beam.m());
    t.tip[i] = mode(beam, i, 1)[0];
  }
  for (int p = 0; p < kPoints; ++p) {
    const double s = (p + 0.5) / kPoints, x = s * beam.L, dm = beam.m() * beam.L / kPoints;
    for (int i = 0; i < kModes; ++i) {
      const auto [phi, slope] = mode(beam, i, s);
      t.c[i] += dm * x * phi;
      t.a[i] += dm * phi;
      for (int j = 0; j < kModes; ++j)
        t.string(i, j) += dm * (beam.L * beam.L - x * x) / 2 * slope * mode(beam, j, s)[1];
    }
  }
  return t;
}

using Rates = std::function<VectorXd(double, const VectorXd&)>;

// One step of the classical Runge-Kutta method.
VectorXd step(const Rates& f, double t, const VectorXd& y, double h) {
  const VectorXd k_1 = f(t, y), k_2 = f(t + h / 2, y + h / 2 * k_1), k_3 = f(t + h / 2, y + h / 2 * k_2),
                 k_4 = f(t + h, y + h * k_3);
  return y + h / 6 * (k_1 + 2 * k_2 + 2 * k_3 + k_4);
}

// ---- spin-up

// J. C. Simo, L. Vu-Quoc, J. Appl. Mech. 53 (1986) 855-863: EA = 2.8e7 N, EI = 1.4e4 N m^2, m = 1.2 kg/m,
// with the ramp of T. R. Kane, R. R. Ryan, A. K. Banerjee, J. Guid. Control Dyn. 10 (1987) 139-151.
constexpr double kSpeed = 6, kRamp = 15, kEnd = 20;  // rad/s, s, s

Beam spin_up_beam() {
  const double h = std::sqrt(12 * 1.4e4 / 2.8e7), b = 1.5 * h;
  return {10, h, b, 2.8e7 / (h * b), 1.2 / (h * b), 20, 40};
}
const Beam kSpinUp = spin_up_beam();

// What multiplies w^2 in q_i'' + (w_i^2 + w^2 stiffness) q = -w' c_i: nothing at level linear, the softening
// of -1 at level full, which the pull along the beam outweighs in Kane's theory.
const ModalMatrix kNone = ModalMatrix::Zero(), kSoftening = -ModalMatrix::Identity();

// Tip deflection at multiples of dt.
std::vector<double> expected_spin_up(const ModalMatrix& stiffness, double dt, double end) {
  const Theory t = theory(kSpinUp);
  const Drive drive = spin_up_drive(0, kSpeed, kRamp);
  const Rates rates = [&](double time, const VectorXd& y) {
    const Prescribed p = at(drive, time);
    const Eigen::Vector<double, kModes> q = y.head<kModes>();
    VectorXd rate(2 * kModes);
    rate << y.tail<kModes>(), -(t.omega.square() * q.array()).matrix() - p.s_dot * p.s_dot * stiffness * q -
                                  p.s_ddot * t.c.matrix();
    return rate;
  };
  VectorXd y = VectorXd::Zero(2 * kModes);
  std::vector<double> deflection{0};
  for (int n = 0; n * dt < end - dt / 2; ++n) {
    y = step(rates, n * dt, y, dt);
    deflection.push_back((t.tip * y.head<kModes>().array()).sum());
  }
  return deflection;
}

struct TipHistory {
  std::vector<double> lag, extension;  // m, across and along the beam
  std::string end = {};                // what the run said that was given up
};

// Until the end, or until the beam is bent so far that the run is given up.
TipHistory spin_up(const std::shared_ptr<const model::ElasticBody>& beam, InertiaLevel level, double dt,
                   double end) {
  System system({{.name = "beam",
                  .body = beam,
                  .joint = {.type = body::JointType::revolute},
                  .rotation = {.drive = spin_up_drive(0, kSpeed, kRamp)}}},
                {}, {.inertia = level});
  TipHistory history;
  history.end = test::message_of([&] {
    simulate(system, {.dt = dt, .end_time = end}, [&](const model::Snapshot& x) {
      const Eigen::Vector3d u = tip(*beam, x.bodies[0].q);
      history.lag.push_back(u.y());
      history.extension.push_back(u.x());
    });
  });
  return history;
}

double largest(const std::vector<double>& x) {
  double largest = 0;
  for (double value : x) largest = std::max(largest, std::abs(value));
  return largest;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double difference = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    difference = std::max(difference, std::abs(a[i] - b[i]));
  return difference;
}

class SpinUp : public testing::Test {
 protected:
  static void SetUpTestSuite() { beam_ = reduced(kSpinUp); }
  static void TearDownTestSuite() { beam_.reset(); }
  static inline std::shared_ptr<const model::ElasticBody> beam_;
};

// ---- pendulum

constexpr double kGravity = 9.81;  // m/s^2
const Beam kPendulum{1, 0.01, 0.03, 2e9, 1000, 12, 14};

struct Swing {
  std::vector<double> angle, lag;
};

// Set going where it hangs, so that its load comes smoothly: a shock would excite modes that no step
// resolves.
constexpr double kStart = -M_PI / 2, kPush = 5;  // rad against the horizontal, rad/s

// Lagrange's equations of the angle and the modal amplitudes.
Swing expected_swing(InertiaLevel level, double dt, double end) {
  const Theory t = theory(kPendulum);
  const double mass = kPendulum.m() * kPendulum.L, second = level == InertiaLevel::full ? 1 : 0;
  const double J = mass * (std::pow(kPendulum.L, 2) / 3 + std::pow(kPendulum.h, 2) / 12);
  const Rates rates = [&](double, const VectorXd& y) {
    const Modal q = y.segment<kModes>(1), q_dot = y.tail<kModes>();
    const double theta = y[0], theta_dot = y[1 + kModes];
    const Modal h =
        -(t.omega.square() - second * theta_dot * theta_dot) * q - kGravity * std::cos(theta) * t.a;
    const double moment = -mass * kGravity * kPendulum.L / 2 * std::cos(theta) +
                          kGravity * std::sin(theta) * (t.a * q).sum() -
                          2 * second * theta_dot * (q * q_dot).sum();
    const double theta_ddot =
        (moment - (t.c * h).sum()) / (J + second * q.square().sum() - t.c.square().sum());
    VectorXd rate(2 + 2 * kModes);
    rate << theta_dot, q_dot.matrix(), theta_ddot, (h - t.c * theta_ddot).matrix();
    return rate;
  };
  constexpr int kSubsteps = 8;
  VectorXd y = VectorXd::Zero(2 + 2 * kModes);
  y[0] = kStart;
  y[1 + kModes] = kPush;
  Swing swing{{kStart}, {0}};
  for (int n = 0; n * dt < end - dt / 2; ++n) {
    for (int i = 0; i < kSubsteps; ++i) y = step(rates, 0, y, dt / kSubsteps);
    swing.angle.push_back(y[0]);
    swing.lag.push_back((t.tip * y.segment<kModes>(1).array()).sum());
  }
  return swing;
}

// Of the tip around the hinge. (Angle and lag each depend on the number of modes: the frame holds an end that
// bears no moment.)
std::vector<double> arcs(const Swing& swing) {
  std::vector<double> arcs;
  for (std::size_t i = 0; i < swing.angle.size(); ++i)
    arcs.push_back(kPendulum.L * (swing.angle[i] + std::atan(swing.lag[i] / kPendulum.L)));
  return arcs;
}

Swing swing(const std::shared_ptr<const model::ElasticBody>& beam, InertiaLevel level, double dt,
            double end) {
  System system({{.name = "beam",
                  .body = beam,
                  .joint = {.type = body::JointType::revolute},
                  .rotation = {.s_0 = kStart, .s_dot_0 = kPush}}},
                {}, {.inertia = level, .gravity = {0, -kGravity, 0}});
  Swing result;
  simulate(system, {.dt = dt, .end_time = end}, [&](const model::Snapshot& x) {
    result.angle.push_back(x.bodies[0].s[0]);
    result.lag.push_back(tip(*beam, x.bodies[0].q).y());
  });
  return result;
}

constexpr double kDt = 0.01;  // s

TEST_F(SpinUp, bends_and_stretches_as_beam_theory_says_at_level_linear) {
  const TipHistory history = spin_up(beam_, InertiaLevel::linear, kDt, kEnd);
  const auto expected = expected_spin_up(kNone, kDt, kEnd);
  test::figure({"spin-up, level `linear`", "lag of the tip", "%"},
               largest_difference(history.lag, expected) / largest(expected), 0.01);
  const double extension = kSpinUp.rho * std::pow(kSpeed, 2) * std::pow(kSpinUp.L, 3) / (3 * kSpinUp.E);
  EXPECT_NEAR(history.extension.back(), extension, 0.03 * extension);
  std::cout << "largest lag " << largest(history.lag) << " m, extension " << history.extension.back()
            << " m\n";
}

// Without the stiffening by the pull along the beam what remains of the second order destabilises it, until
// the run is given up.
TEST_F(SpinUp, diverges_beyond_its_first_frequency_at_level_full) {
  const Theory t = theory(kSpinUp);
  const TipHistory history = spin_up(beam_, InertiaLevel::full, kDt, 12);
  const auto expected = expected_spin_up(kSoftening, kDt, 12);
  const auto until = [&](double time, std::vector<double> x) {
    x.resize(static_cast<std::size_t>(time / kDt));
    return x;
  };
  EXPECT_LT(largest_difference(until(8, history.lag), until(8, expected)),
            0.01 * largest(until(8, expected)));
  EXPECT_NE(history.end.find("elastic rotation or strain"), std::string::npos) << history.end;
  EXPECT_GT(largest(history.lag), 1.5 * largest(until(8, history.lag)));
  EXPECT_NEAR(history.lag.back() / expected[history.lag.size() - 1], 1, 0.05);
  std::cout << "first frequency " << t.omega[0] << " rad/s; lag at 8 s " << history.lag[800] << " m, at "
            << kDt * static_cast<double>(history.lag.size() - 1) << " s " << history.lag.back() << " m\n";
}

TEST_F(SpinUp, of_the_affine_part_goes_with_level_full) {
  const TipHistory affine = spin_up(beam_, InertiaLevel::affine, kDt, 6),
                   full = spin_up(beam_, InertiaLevel::full, kDt, 6);
  EXPECT_LT(largest_difference(affine.lag, full.lag), 0.02 * largest(full.lag));
}

// J. R. Wright, C. E. Smith, R. W. Thresher, J. L. C. Wang, J. Appl. Mech. 49 (1982) 197-202: first frequency
// across the plane of rotation against the speed, both over sqrt(EI / m L^4).
TEST(BeamTheory, stiffens_by_the_published_frequencies_of_a_rotating_cantilever) {
  constexpr double kModesLeftOut = 5e-4;  // relative
  const Theory t = theory(kSpinUp);
  const double unit = std::sqrt(kSpinUp.EI() / kSpinUp.m()) / std::pow(kSpinUp.L, 2);
  const ModalMatrix K = t.omega.square().matrix().asDiagonal();
  for (const auto& [speed, frequency] : std::map<double, double>{
           {0, 3.5160}, {1, 3.6816}, {3, 4.7973}, {5, 6.4495}, {7, 8.2996}, {10, 11.2023}}) {
    const ModalMatrix stiffened = K + std::pow(speed * unit, 2) * t.string;
    const double lowest = Eigen::SelfAdjointEigenSolver<ModalMatrix>(stiffened).eigenvalues()[0];
    EXPECT_NEAR(std::sqrt(lowest) / unit, frequency, kModesLeftOut * frequency) << speed;
  }
}

TEST_F(SpinUp, lags_more_than_with_stiffening) {
  const Theory t = theory(kSpinUp);
  const auto stiffened = expected_spin_up(t.string + kSoftening, kDt, kEnd);
  const double with = largest(stiffened),
               without = largest(spin_up(beam_, InertiaLevel::linear, kDt, kEnd).lag);
  std::cout << "largest lag with stiffening " << with << " m, without " << without << " m\n";
  EXPECT_GT(without, with);
  EXPECT_LT(without, 1.2 * with);
}

class Pendulum : public testing::TestWithParam<InertiaLevel> {};
INSTANTIATE_TEST_SUITE_P(Levels, Pendulum, testing::Values(InertiaLevel::linear, InertiaLevel::full));

TEST_P(Pendulum, swings_as_lagranges_equations_of_the_beam_say) {
  const auto beam = reduced(kPendulum);
  constexpr double kStep = 5e-4, kTime = 1.5;
  const Swing found = swing(beam, GetParam(), kStep, kTime),
              expected = expected_swing(GetParam(), kStep, kTime);
  const double arc = largest_difference(arcs(found), arcs(expected));
  std::cout << "largest difference of the tip's arc " << arc << " m; largest lag " << largest(expected.lag)
            << " m\n";
  EXPECT_LT(arc, 0.01 * largest(expected.lag));
  EXPECT_GT(largest(expected.lag), 2e-3);
}

}  // namespace
}  // namespace elastogear::rotating_beam_test
