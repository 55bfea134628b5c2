// Flank pressure of the worm drive at the pitch point against H. Hertz, for the exact curvatures.
//
//      n |  worm      1. curvatures  of both involute helicoids, closed form -> Hertz's ellipse and pressure
//     ___|___         2. mesh        a block under either flank, graded towards the pitch point
//     ---+---         3. reduce      to modes with residual flexibility, or to the full basis
//        |  wheel     4. simulate    static: the blocks approach each other until some 50 N are between them
//        |            5. compare     largest nodal force over nodal area, half axes, stress
//
// Sample run:   hertz /tmp modal_residual 4 8     (folder; or: full, unilateral, faces, minima;
// facets across the ellipse; with minima nodes of the wheel are moved by an eighth of a facet)
// Expected:     exit code 0: from 8 facets on the peak pressure is within 5 % of Hertz's.

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "../tests/figure_line.h"
#include "elastogear/base/error.h"
#include "elastogear/base/petsc.h"
#include "elastogear/contact/true_surface.h"
#include "elastogear/dynamics/static.h"
#include "elastogear/gear/design.h"
#include "elastogear/io/body_file.h"
#include "elastogear/model/hertz.h"
#include "elastogear/recovery/stress.h"
#include "elastogear/reduction/eigenmodes.h"
#include "elastogear/reduction/reduce.h"

using namespace elastogear;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr double kE = 210e9, kNu = 0.3, kForce = 50;  // Pa, -, N: steel on steel
constexpr double kPi = std::numbers::pi;

// ---- the flanks; the origin is the pitch point, x along the worm's axis, z along the wheel's

struct Flank {
  gear::Toothing toothing;
  int side;    // +1 left, -1 right
  Vector3d r;  // m, centre of the body
  Matrix3d R;  // body to world
  Vector3d n;  // outward normal at the pitch point
};

// > 0 outside. Flanks at a constant distance of each other are one flank, turned: this one goes through the
// origin.
double distance(const Flank& flank, const Vector3d& x) {
  const auto d = [&](const Vector3d& y) {
    return gear::flank_distance(flank.toothing, 0, flank.side, flank.R.transpose() * (y - flank.r));
  };
  return d(x) - d(Vector3d::Zero());
}

// The worm's left and the wheel's right flank, whose common normal is the path of contact
// (docs/theory, 9.1).
std::pair<Flank, Flank> flanks() {
  const gear::Geometry g = gear::derive(gear::Design{});
  const Vector3d n(std::sin(g.worm.beta_b), std::sin(gear::Design{}.alpha_n), std::sin(g.wheel.beta_b));
  Matrix3d worm_axes;  // local x, y, z along world Y, Z, X
  worm_axes << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  Flank worm{g.worm, 1, {0, g.worm.r, 0}, worm_axes, n},
      wheel{g.wheel, -1, {0, -g.wheel.r, 0}, Matrix3d::Identity(), -n};
  constexpr double kStep = 1e-6;  // m
  for (Flank* flank : {&worm, &wheel})
    if (distance(*flank, kStep * flank->n) < 0) flank->n *= -1;
  return {worm, wheel};
}

// Normal curvatures n x g along and zero along the generator g, 3 x 3, 1/m.
Matrix3d curvature(const Flank& flank) {
  const gear::Toothing& t = flank.toothing;
  const Vector3d axis = flank.R.col(2), generator = (axis - axis.dot(flank.n) * flank.n).normalized(),
                 across = flank.n.cross(generator);
  return std::cos(t.beta_b) / std::sqrt(t.r * t.r - t.r_b * t.r_b) * across * across.transpose();
}

// ---- Hertz

struct Hertz : model::HertzEllipse {
  Vector3d along, across;  // of the major and the minor axis
};

// Hertz's ellipse of two surfaces with the gap x'Q x / 2 and the common normal n.
Hertz hertz(const Matrix3d& Q, const Vector3d& n) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(Q);
  const Vector3d along = axes.eigenvectors().col(1);
  return {
      model::hertz_ellipse(axes.eigenvalues()[1] / 2, axes.eigenvalues()[2] / 2, kE / (1 - kNu * kNu) / 2),
      along, n.cross(along)};
}

// ---- blocks

constexpr double kReach = 6, kRefined = 1.2, kGrowth = 1.35;  // over a, of the half axis, from cell to cell

// From 0: cells of size h up to `fine`, then larger and larger ones up to `end`, in m.
std::vector<double> graded(double h, double fine, double end) {
  std::vector<double> x{0};
  while (x.back() < fine) x.push_back(x.back() + h);
  while (x.back() < end) {
    h *= kGrowth;
    const double rest = end - x.back();
    x.push_back(rest < 1.5 * h ? end : x.back() + h);
  }
  return x;
}

struct Grid {
  std::vector<double> u, v, w;  // m: along and across the ellipse, inwards
  double fine_u, fine_v;        // m, of the patch of fine faces
};

std::vector<double> mirrored(const std::vector<double>& x, double shift) {
  std::vector<double> all;
  for (auto i = x.rbegin(); i != x.rend() - 1; ++i) all.push_back(shift - *i);
  for (double xi : x) all.push_back(shift + xi);
  return all;
}

// shift: of the nodes, over the fine cells' size.
Grid grid(const Hertz& hertz, int facets, double shift) {
  const double a = hertz.a(kForce), b = hertz.k * a, h_u = 2 * a / facets, h_v = 2 * b / facets,
               end = kReach * a;
  const auto u = graded(h_u, kRefined * a, end), v = graded(h_v, kRefined * b, end);
  return {mirrored(u, shift * h_u), mirrored(v, shift * h_v), graded(h_v, 0, end), kRefined * a + h_u,
          kRefined * b + h_v};
}

// On the flank, from the tangent plane along the normal.
Vector3d on_flank(const Flank& flank, Vector3d x) {
  constexpr int kIterations = 20;
  for (int i = 0; i < kIterations; ++i) x -= distance(flank, x) * flank.n;
  return x;
}

Eigen::Matrix3Xd positions(const Flank& flank, const Vector3d& along, const Grid& g) {
  const Vector3d across = flank.n.cross(along);
  Eigen::Matrix3Xd X(3, static_cast<Eigen::Index>(g.w.size() * g.v.size() * g.u.size()));
  for (Eigen::Index n = 0; double w : g.w)
    for (double v : g.v)
      for (double u : g.u) {
        const Vector3d plane = u * along + v * across, top = on_flank(flank, plane);
        X.col(n++) = top + w * ((plane - top) / g.w.back() - flank.n);
      }
  return X;
}

mesh::Mesh block(const Flank& flank, const Vector3d& along, const Grid& g) {
  const int n_u = static_cast<int>(g.u.size()), n_v = static_cast<int>(g.v.size()), layer = n_u * n_v,
            n_w = static_cast<int>(g.w.size());
  const auto is_fine = [](const std::vector<double>& x, int i, double fine) {
    return std::max(std::abs(x[i]), std::abs(x[i + 1])) < fine;
  };
  mesh::Mesh mesh;
  mesh.X = positions(flank, along, g);
  for (int k = 0; k + 1 < n_w; ++k)
    for (int j = 0; j + 1 < n_v; ++j)
      for (int i = 0; i + 1 < n_u; ++i) {
        const int n = k * layer + j * n_u + i;
        const mesh::Face top{n, n + 1, n + n_u + 1, n + n_u};
        const int nodes[] = {top[0] + layer, top[1] + layer, top[2] + layer, top[3] + layer,
                             top[0],         top[1],         top[2],         top[3]};
        mesh.cells.add(mesh::CellType::hex8, nodes);
        if (k == 0 && is_fine(g.u, i, g.fine_u) && is_fine(g.v, j, g.fine_v))
          mesh.face_sets["patch"].push_back(top);
      }
  for (int n = 0; n < layer; ++n) {
    mesh.node_sets["base"].push_back((n_w - 1) * layer + n);
    if (g.u[n % n_u] == 0 && g.v[n / n_u] == 0) mesh.node_sets["middle"].push_back(n);
  }
  return mesh;
}

// ---- contact

// Basis of the two blocks and their contact, by which a row of the printed table is computed.
struct Method {
  bool full = false;  // the full basis; otherwise ten modes with residual flexibility
  contact::ContactLaw law = contact::ContactLaw::penalty;
  contact::SlavePoints points = contact::SlavePoints::nodes;
};

Method method(const std::string& name) {
  if (name == "full") return {.full = true};
  if (name == "modal_residual") return {};
  if (name == "unilateral") return {.law = contact::ContactLaw::unilateral};
  if (name == "faces") return {.law = contact::ContactLaw::unilateral, .points = contact::SlavePoints::faces};
  if (name == "minima")
    return {.law = contact::ContactLaw::unilateral, .points = contact::SlavePoints::minima};
  fail("no method '", name, "': full, modal_residual, unilateral, faces or minima");
}

std::shared_ptr<const model::ElasticBody> reduced(const mesh::Mesh& mesh, bool full,
                                                  const std::string& file) {
  reduction::ReductionOptions options;
  options.regions = {{"", {.E = kE, .nu = kNu, .rho = 7850}}};
  options.restrain = {"base"};
  options.surface = {"patch"};
  if (mesh.node_sets.contains("middle")) options.stress_nodes = {"middle"};
  options.basis = full ? model::Basis::full : model::Basis::modal;
  options.flexibility = !full;
  options.n_modes = 10;
  options.window = reduction::kAutomaticWindow;
  options.completeness = false;
  reduction::reduce(PETSC_COMM_WORLD, mesh, options, file);
  return std::make_shared<model::ElasticBody>(io::read_body(file));
}

// Exact flank of a block.
std::shared_ptr<const contact::TrueSurface> true_surface(const Flank& flank, const model::Surface& surface) {
  auto known = std::make_shared<contact::TrueSurface>();
  for (int f = 0; f < surface.face.cols(); ++f)
    known->height.push_back(contact::sampled_heights(surface, f, [&](const Vector3d& x, const Vector3d& n) {
      constexpr int kIterations = 10;
      double way = 0;
      for (int i = 0; i < kIterations; ++i) way -= distance(flank, x + way * n) / flank.n.dot(n);
      return way;
    }));
  return known;
}

dynamics::System pressed(const Flank& worm, const Flank& wheel, double approach, const Method& method,
                         std::shared_ptr<const model::ElasticBody> worm_body,
                         std::shared_ptr<const model::ElasticBody> wheel_body) {
  constexpr double kStiff = 20;  // over that of a fine cell: contact itself hardly yields
  dynamics::BodySetup fixed{.name = "worm", .body = std::move(worm_body)},
      moving{.name = "wheel", .body = std::move(wheel_body)};
  moving.joint = {.type = body::JointType::prismatic, .axis = wheel.n};
  moving.translation.drive = dynamics::still_drive(0, approach);
  contact::Settings contact{
      .law = method.law, .points = method.points, .slave = 1, .surface = contact::ContactSurface::smooth};
  if (method.points == contact::SlavePoints::minima) {
    contact.surface = contact::ContactSurface::exact;
    fixed.true_surface = true_surface(worm, fixed.body->surface);
    moving.true_surface = true_surface(wheel, moving.body->surface);
  } else {
    contact.stiffness = kStiff * moving.body->surface.c_f.mean();
  }
  return dynamics::System({fixed, moving}, {{"worm:wheel", {0, 1}, contact}});
}

struct Row {
  double facets;                 // across the ellipse of the force that was found
  double force;                  // N
  double pressure, a, b;         // over Hertz's values
  double stress = std::nan("");  // along the normal under the middle, too; full basis only
};

double normal_stress(const model::ElasticBody& body, const Eigen::VectorXd& q, const Vector3d& n) {
  const Eigen::VectorXd s = recovery::stress_history(body.stress, {0}, q).stress.col(0);
  Matrix3d sigma;
  sigma << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  return n.dot(sigma * n);
}

// own: m^2, second moments along and across that the pressure of one node has.
Row compare(const model::Snapshot& last, const model::ElasticBody& wheel, const Flank& flank,
            const Hertz& hertz, const Eigen::Vector2d& own) {
  const model::PairState& pair = last.pairs[0];
  double total = 0, along = 0, across = 0;
  for (const model::ContactRecord& c : pair.contacts) {
    const Vector3d x = wheel.surface.X.col(c.slave_node);
    const double f = std::abs(c.f.dot(flank.n));
    total += f;
    along += f * (std::pow(x.dot(hertz.along), 2) + own[0]);
    across += f * (std::pow(x.dot(hertz.across), 2) + own[1]);
  }
  const double a = hertz.a(total), p_0 = hertz.pressure(total);
  Row row{a / hertz.a(kForce), total, pair.total.pressure / p_0, std::sqrt(5 * along / total) / a,
          std::sqrt(5 * across / total) / (hertz.k * a)};
  if (wheel.basis == model::Basis::full) row.stress = -normal_stress(wheel, last.bodies[1].q, flank.n) / p_0;
  return row;
}

Row solve(const std::string& folder, const Method& method, int facets) {
  const auto [worm, wheel] = flanks();
  const Hertz h = hertz(curvature(worm) + curvature(wheel), wheel.n);
  constexpr double kShift = 1. / 3;  // of the worm's nodes, which lie between the wheel's
  constexpr int kSteps = 4;
  const double wheel_shift = method.points == contact::SlavePoints::minima ? 0.125 : 0;
  const mesh::Mesh worm_mesh = block(worm, h.along, grid(h, facets, kShift)),
                   wheel_mesh = block(wheel, h.along, grid(h, facets, wheel_shift));
  const auto wheel_body = reduced(wheel_mesh, method.full, folder + "/wheel_block.h5");
  dynamics::System system = pressed(worm, wheel, h.approach(kForce), method,
                                    reduced(worm_mesh, method.full, folder + "/worm_block.h5"), wheel_body);
  model::Snapshot last;
  dynamics::solve_static(system, {kSteps}, [&](const model::Snapshot& snapshot) { last = snapshot; });
  const Eigen::Vector2d side = 2 * h.a(kForce) / facets * Eigen::Vector2d(1, h.k);  // of a face
  const bool faces = method.points == contact::SlavePoints::faces;
  Row row = compare(last, *wheel_body, wheel, h,
                    faces ? Eigen::Vector2d(side.cwiseAbs2() / 6) : Eigen::Vector2d(0, 0));
  row.facets *= facets;
  std::printf("%6.1f %8d %8d %8.1f %9.0f %9.4f %9.4f %9.4f %9.4f\n", row.facets, wheel_mesh.n_nodes(),
              last.pairs[0].count, row.force, 1e-6 * h.pressure(row.force), row.pressure, row.a, row.b,
              row.stress);
  std::fflush(stdout);
  return row;
}

bool all_close(const std::string& folder, const Method& method, const std::vector<int>& facets) {
  constexpr double kTolerance = 0.05;  // of the pressure
  constexpr int kEnough = 8;           // facets
  bool close = true;
  std::printf("                                             over Hertz's values:\n");
  std::printf("facets    nodes contacts force, N  p_0, MPa p_max         a         b   sigma_n\n");
  for (int n : facets) {
    const Row row = solve(folder, method, n);
    if (n < kEnough) continue;
    elastogear::test::state_figure("flanks of the worm drive", std::to_string(n) + " facets: peak pressure",
                                   "%", row.pressure - 1, "< 0.05");
    close &= std::abs(row.pressure - 1) < kTolerance;
  }
  return close;
}

}  // namespace

int main(int argc, char** argv) {
  const Session session(argc, argv);
  try {
    const std::string folder = argc > 1 ? argv[1] : ".";
    const Method chosen = method(argc > 2 ? argv[2] : "modal_residual");
    std::vector<int> facets;
    for (int i = 3; i < argc; ++i) facets.push_back(std::stoi(argv[i]));
    if (facets.empty()) facets = {4, 8};
    return all_close(folder, chosen, facets) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
