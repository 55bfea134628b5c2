#include <cmath>
#include <numbers>

#include "elastogear/drive/drive.h"
#include "elastogear/gear/wheel.h"
#include "elastogear/gear/worm.h"

namespace elastogear::drive {

using std::numbers::pi;

namespace {

// Flanks touch at points. A cell gives the force of a point to all its nodes, also to those beside a root,
// and the stress at the root below a point falls off along the face. Size tiny, which runs begin with, is
// finer here than for frequencies.
bool is_coarse(const MeshDensity& by) { return by.size == gear::Size::tiny && by.order == 2; }

gear::WormCounts worm_counts(const MeshDensity& by, int z1) {
  gear::WormCounts n = gear::worm_counts(by.size, z1, by.order);
  if (is_coarse(by)) n.flank = 3, n.fillet = 2;
  return gear::refined(n, z1, by.refinement);
}

gear::WheelCounts wheel_counts(const MeshDensity& by) {
  gear::WheelCounts n = gear::wheel_counts(by.size, by.order);
  if (is_coarse(by)) n.web_layers = 4, n.face_layers = 2, n.fillet = 3;
  return gear::refined(n, by.refinement);
}

}  // namespace

// Worm local (x, y, z) = world (Y, Z, X): a third of a turn about (1, 1, 1). At zero angles both flanks have
// half the backlash; a driving worm pushes the wheel from behind. A left-handed wheel turns the other way.
Drive worm_drive(const gear::Design& design, const gear::Geometry& geometry, const Start& start) {
  const gear::Geometry& g = geometry;
  const double turned = 2 * pi * start.roll / design.z1;
  const double hand = design.hand == gear::Hand::left ? -1 : 1;
  const double closing = g.j_n / 2 / (g.wheel.r * std::cos(g.alpha_w) * std::cos(g.gamma_w));
  const double sense = start.coasts ? -1 : 1;
  Member worm, wheel;
  worm.name = "worm";
  worm.toothing = g.worm;
  worm.mesh = [design](const MeshDensity& by, mesh::ReadReport&) {
    return gear::worm_mesh(design, worm_counts(by, design.z1));
  };
  worm.is_worm = true;
  worm.held = "seats";
  worm.position = {0, design.a, 0};
  worm.rotation = Eigen::Vector3d::Constant(2 * pi / 3 / std::sqrt(3.0));
  worm.angle = turned;
  worm.width = design.thread_length;
  wheel.name = "wheel";
  wheel.toothing = g.wheel;
  wheel.mesh = [design](const MeshDensity& by, mesh::ReadReport&) {
    return gear::wheel_mesh(design, wheel_counts(by));
  };
  wheel.held = "bore";
  wheel.angle = hand * (turned / g.ratio - sense * closing);
  wheel.ratio = hand / g.ratio;
  wheel.width = design.face_width;
  return {{worm, wheel}, {{0, 1}}, {1, 2, 3, 4, 6}};  // half a space of the worm has one column
}

}  // namespace elastogear::drive
