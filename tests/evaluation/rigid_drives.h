#pragma once
// Rigid gears that roll on each other, for tests of what is read off.

#include <Eigen/Geometry>
#include <numbers>

#include "elastogear/base/rotation.h"
#include "elastogear/evaluation/contact.h"
#include "elastogear/gear/cylindrical.h"
#include "elastogear/gear/design.h"

namespace elastogear::test {

struct RollingPair {
  evaluation::Gear gear[2];
  Eigen::VectorXd roll;  // pitches
  std::array<const evaluation::Gear*, 2> both() const { return {&gear[0], &gear[1]}; }
};

/// Puts both gears to their nominal angles at the roll angles, and the second one ahead by `lead` (rad, in
/// the sense in which it turns).
inline void roll_to(RollingPair& pair, const Eigen::VectorXd& roll, const Eigen::VectorXd& lead = {}) {
  pair.roll = roll;
  for (int g : {0, 1}) {
    evaluation::Gear& gear = pair.gear[g];
    const Eigen::Vector3d x = gear.position.at(0);
    gear.position.assign(static_cast<std::size_t>(roll.size()), x);
    gear.rotation.clear();
    Eigen::VectorXd phi = evaluation::nominal_angles(gear, pair.gear[0].toothing.z, roll);
    if (g == 1 && lead.size() > 0) phi += (gear.ratio > 0 ? 1 : -1) * lead;
    for (double angle : phi) gear.rotation.push_back(gear.R * rotation_matrix(Eigen::Vector3d(0, 0, angle)));
  }
}

/// 17/43 teeth of module 3 mm, 25 mm wide; the second axis stands on +X.
inline RollingPair spur_pair() {
  gear::CylindricalDrive d;
  d.m_n = 3e-3;
  d.rack = gear::basic_rack("A");
  d.gears.resize(2);
  for (int i : {0, 1}) {
    d.gears[i].name = i == 0 ? "pinion" : "wheel";
    d.gears[i].z = i == 0 ? 17 : 43;
    d.gears[i].x = i == 0 ? 0.3 : 0.1;
    d.gears[i].blank.face_width = 25e-3;
  }
  d.pairs = {{.first = 0, .second = 1}};
  const gear::CylindricalGeometry g = gear::derive(d);
  const std::vector<double> angle = gear::angles(d, g, 0);
  RollingPair pair;
  for (int i : {0, 1}) {
    evaluation::Gear& gear = pair.gear[i];
    gear.name = d.gears[i].name;
    gear.toothing = g.gear[i];
    gear.width = 25e-3;
    gear.ratio = i == 0 ? 1 : -17.0 / 43;
    gear.angle = angle[i];
    gear.position = {Eigen::Vector3d(g.axis[i][0], g.axis[i][1], 0)};
    gear.layers = Eigen::VectorXd::LinSpaced(6, -12.5e-3, 12.5e-3);
  }
  roll_to(pair, Eigen::VectorXd::LinSpaced(8, 0, 7.0 / 8));
  return pair;
}

/// The steering worm: axis of the worm along +X above the wheel's, which is +Z.
inline RollingPair worm_pair() {
  const gear::Design d;
  const gear::Geometry g = gear::derive(d);
  RollingPair pair;
  evaluation::Gear &worm = pair.gear[0], &wheel = pair.gear[1];
  worm.name = "worm", worm.toothing = g.worm, worm.width = d.thread_length;
  wheel.name = "wheel", wheel.toothing = g.wheel, wheel.width = d.face_width;
  worm.R = rotation_matrix(Eigen::Vector3d::Constant(2 * std::numbers::pi / 3 / std::sqrt(3.0)));
  worm.position = {Eigen::Vector3d(0, d.a, 0)};
  wheel.position = {Eigen::Vector3d::Zero()};
  wheel.ratio = 1 / g.ratio;
  roll_to(pair, Eigen::VectorXd::LinSpaced(4, 0, 0.75));
  return pair;
}

}  // namespace elastogear::test
