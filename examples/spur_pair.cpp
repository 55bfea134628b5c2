// A spur pair, from its design to the load over its face and the tension at its roots, in one program.
//
//     design -> meshes -> bodies -> a sweep over a pitch -> w(z) over the wheel's face, largest tension
//
// Sample run:   spur_pair /tmp
// Expected:     exit code 0: the mean load over the face carries the torque to 1 %; the largest tension is
//               422 MPa at the pinion's root and 437 MPa at the wheel's.

#include <cmath>
#include <cstdio>

#include "elastogear/base/petsc.h"
#include "elastogear/drive/reduce.h"
#include "elastogear/drive/sweep_drive.h"

using namespace elastogear;

namespace {

drive::Drive spur_pair() {
  gear::CylindricalDrive d;
  d.m_n = 3e-3;
  d.rack = gear::basic_rack("A");
  d.gears.resize(2);
  d.gears[0] = {.name = "pinion", .z = 17, .x = 0.3, .cutter = {}, .blank = {.face_width = 25e-3}};
  d.gears[1] = {.name = "wheel", .z = 43, .x = 0.1, .cutter = {}, .blank = {.face_width = 25e-3}};
  d.pairs = {{.first = 0, .second = 1}};
  return drive::cylindrical_drive(d, gear::derive(d), {});
}

}  // namespace

int main(int argc, char** argv) {
  Session session(argc, argv);
  constexpr double kTorque = 300;  // N m
  constexpr int kPositions = 16;
  const std::string folder = argc > 1 ? argv[1] : ".";
  const drive::Drive pair = spur_pair();
  std::vector<std::string> files;
  for (const drive::Member& gear : pair.members) {
    files.push_back(folder + "/" + gear.name + ".h5");
    mesh::ReadReport report;
    const mesh::Mesh mesh = gear.mesh({.size = gear::Size::tiny, .order = 2}, report);
    reduction::reduce(PETSC_COMM_WORLD, mesh,
                      drive::reduction_options(gear, {.E = 210e9, .nu = 0.3, .rho = 7850}), files.back());
  }
  std::vector<double> positions;
  for (int i = 0; i < kPositions; ++i) positions.push_back(static_cast<double>(i) / kPositions);
  const auto run = drive::sweep_drive(pair, {.torque = kTorque}, files, positions, folder + "/spur_pair.h5");
  const evaluation::PairEvaluation found = evaluation::evaluate(run[0]);

  const auto &z = found.values("line_load/z"), &w = found.values("line_load/mean"),
             &width = found.values("line_load/width");
  double force = 0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    std::printf("w at z = %6.2f mm  %8.1f N/mm\n", 1e3 * z[i], 1e-3 * w[i]);
    force += w[i] * width[i];
  }
  const double asked = kTorque / pair.members[0].toothing.r_b;
  const double pinion = found.values("root/pinion/largest_tension")[0],
               wheel = found.values("root/wheel/largest_tension")[0];
  std::printf("force             %8.1f N, torque over base radius %.1f N\n", force, asked);
  std::printf("tension           %8.1f MPa, pinion, %.1f MPa, wheel\n", 1e-6 * pinion, 1e-6 * wheel);
  const bool right = std::abs(pinion - 422e6) < 1e6 && std::abs(wheel - 437.5e6) < 1e6;
  return std::abs(force / asked - 1) < 0.01 && right ? 0 : 1;
}
