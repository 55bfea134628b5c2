#include "worm_drive.h"

#include <algorithm>
#include <map>

#include "surfaces.h"

namespace elastogear::contact::test {
namespace {

using Eigen::Vector3d;

TrueSurface exact_heights(const Flanks& flanks) {
  TrueSurface exact;
  for (int f = 0; f < flanks.surface.face.cols(); ++f)
    exact.height.push_back(sampled_heights(flanks.surface, f, [&](const Vector3d& x, const Vector3d& n) {
      return gear::flank_distance_along(flanks.toothing, flanks.flank[f], x, n);
    }));
  return exact;
}

// Face sets tooth_<ii>_left and their like.
Flanks flanks_of(const mesh::Mesh& mesh, const gear::Toothing& toothing, double half_width) {
  Flanks flanks{toothing, half_width, {}, {}, {}};
  std::map<int, int> local;
  std::vector<mesh::Face> faces;
  for (const auto& [name, set] : mesh.face_sets) {
    const auto flank = gear::flank_of(name);
    if (!flank) continue;
    for (const mesh::Face& face : set) {
      faces.push_back(face);
      flanks.flank.push_back(*flank);
      for (int node : face) local.try_emplace(node, 0);
    }
  }
  std::vector<int> nodes;
  for (auto& [node, number] : local) number = static_cast<int>(nodes.size()), nodes.push_back(node);
  model::Surface& surface = flanks.surface;
  surface.X = mesh.X(Eigen::all, nodes);
  surface.face.resize(4, static_cast<Eigen::Index>(faces.size()));
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (int i = 0; i < 4; ++i) surface.face(i, static_cast<Eigen::Index>(f)) = local.at(faces[f][i]);
  surface.Phi = model::DenseRows(3 * surface.X.cols(), 0);
  flanks.exact = exact_heights(flanks);
  return flanks;
}

SurfaceMotion at_rest(const Vector3d& r, const Eigen::Matrix3d& R) { return {Eigen::VectorXd(0), r, R}; }

Vector3d in_body(const SurfaceMotion& placed, const Vector3d& x) {
  return placed.R_WB.transpose() * (x - placed.r_WB);
}

}  // namespace

WormDrive worm_drive(int n) {
  const gear::Design design;
  const gear::Geometry geometry = gear::derive(design);
  const gear::WormCounts tiny = gear::worm_counts(gear::Size::tiny);
  const gear::WormCounts worm{
      .tooth = tiny.tooth * n, .space = tiny.space * n, .flank = tiny.flank * n, .turn = tiny.turn * n};
  const gear::WheelCounts wheel{.flank = gear::WheelCounts{}.flank * n,
                                .web_layers = gear::WheelCounts{}.web_layers * n,
                                .face_layers = gear::WheelCounts{}.face_layers * n};
  return {design, geometry, flanks_of(gear::worm_mesh(design, worm), geometry.worm, design.thread_length / 2),
          flanks_of(gear::wheel_mesh(design, wheel), geometry.wheel, design.face_width / 2)};
}

SurfaceMotion worm_motion(const WormDrive& drive, double phi_1) {
  Eigen::Matrix3d axes;  // worm local x, y, z along world Y, Z, X
  axes << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  return at_rest({0, drive.design.a, 0}, axes * rotation({0, 0, phi_1}));
}

SurfaceMotion wheel_motion(const WormDrive& drive, double phi_1, double ahead) {
  return at_rest(Vector3d::Zero(), rotation({0, 0, phi_1 / drive.geometry.ratio + ahead}));
}

double pressed(const WormDrive& drive, double depth) {
  const gear::Toothing& t = drive.geometry.wheel;
  return (drive.design.j_n / 2 + depth) / (t.r_b * std::cos(t.beta_b));
}

double distance(const Flanks& flanks, const SurfaceMotion& placed, const Flank& flank, const Vector3d& x) {
  return gear::flank_distance(flanks.toothing, flank.tooth, flank.side, in_body(placed, x));
}

bool is_within(const Flanks& flanks, const SurfaceMotion& placed, const Flank& flank, const Vector3d& x,
               double margin) {
  constexpr double kStep = 1e-7;  // m, of the difference quotient
  const gear::Toothing& t = flanks.toothing;
  const Vector3d p = in_body(placed, x);
  const auto d = [&](const Vector3d& y) { return gear::flank_distance(t, flank.tooth, flank.side, y); };
  Vector3d n;
  for (int i = 0; i < 3; ++i)
    n[i] = (d(p + kStep * Vector3d::Unit(i)) - d(p - kStep * Vector3d::Unit(i))) / (2 * kStep);
  const Vector3d foot = p - d(p) * n;
  const double r = foot.head<2>().norm();
  return r > t.r_form + margin && r < t.r_a - margin && std::abs(foot.z()) < flanks.half_width - margin;
}

}  // namespace elastogear::contact::test
