// The study tells on which counts of cells stresses and transmission error of a gear pair depend. It sweeps
// the pair over a pitch with each count doubled in turn, and with all of them as `refinement: 2` has them.
//
//   mesh_counts README 300 FOLDER      (README's pair, or helical, C14; N m; body files go there)
//
// Prints, for each mesh, its nodes, transmission error (mean and peak to peak), KHbeta, the largest pressure
// by H. Hertz and the largest tension at both roots.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "elastogear/base/error.h"
#include "elastogear/base/petsc.h"
#include "elastogear/drive/reduce.h"
#include "elastogear/drive/sweep_drive.h"

using namespace elastogear;

namespace {

constexpr int kPositions = 16;

gear::CylindricalDrive design(const std::string& name) {
  gear::CylindricalDrive d;
  d.rack = gear::basic_rack("A");
  d.gears.resize(2);
  gear::CylindricalGear &pinion = d.gears[0], &wheel = d.gears[1];
  pinion.name = "pinion", wheel.name = "wheel";
  d.pairs = {{.first = 0, .second = 1}};
  if (name == "README") {
    d.m_n = 3e-3;
    pinion.z = 17, pinion.x = 0.3, wheel.z = 43, wheel.x = 0.1;
    pinion.blank.face_width = wheel.blank.face_width = 25e-3;
  } else if (name == "helical") {
    d.m_n = 2e-3, d.beta = 20 * M_PI / 180;
    pinion.z = 19, pinion.x = 0.2, wheel.z = 52;
    pinion.blank.face_width = wheel.blank.face_width = 16e-3;
    wheel.blank.bore = 30e-3;
  } else {
    require(name == "C14", "'", name, "': must be README, helical or C14");
    d.m_n = 4.5e-3;
    pinion.z = 16, pinion.x = 0.1817, pinion.r_a = 82.635e-3 / 2;
    wheel.z = 24, wheel.x = 0.1715, wheel.r_a = 118.544e-3 / 2;
    pinion.blank.face_width = wheel.blank.face_width = 14e-3;
    d.pairs[0].a = 91.5e-3;
  }
  return d;
}

using Change = void (*)(gear::WheelCounts&);

// Rows that grow do so over the same depth.
const std::vector<std::pair<const char*, Change>> kChanges = {
    {"as they are", [](gear::WheelCounts&) {}},
    {"tooth",
     [](gear::WheelCounts& n) { n.tooth *= 2, n.tooth_growth = gear::refined_growth(n.tooth_growth, 2); }},
    {"space", [](gear::WheelCounts& n) { n.space *= 2; }},
    {"flank", [](gear::WheelCounts& n) { n.flank *= 2; }},
    {"fillet", [](gear::WheelCounts& n) { n.fillet *= 2; }},
    {"rim", [](gear::WheelCounts& n) { n.rim *= 2, n.growth = gear::refined_growth(n.growth, 2); }},
    {"ring", [](gear::WheelCounts& n) { n.ring *= 2; }},
    {"web_layers", [](gear::WheelCounts& n) { n.web_layers *= 2; }},
    {"refinement 2", [](gear::WheelCounts& n) { n = gear::refined(n, 2); }},
};

void solve(const gear::CylindricalDrive& of, Change change, double torque, const std::string& folder) {
  const gear::CylindricalGeometry geometry = gear::derive(of);
  const drive::Drive pair = drive::cylindrical_drive(of, geometry, {});
  std::vector<std::string> files;
  for (int i : {0, 1}) {
    const drive::Member& gear = pair.members[static_cast<std::size_t>(i)];
    gear::WheelCounts counts = gear::cylindrical_counts(of, geometry, i, gear::Size::tiny, 2);
    change(counts);
    const mesh::Mesh mesh = gear::cylindrical_mesh(of, geometry, i, counts);
    files.push_back(folder + "/" + gear.name + ".h5");
    auto options = drive::reduction_options(gear, {.E = 210e9, .nu = 0.3, .rho = 7850});
    options.completeness = false;
    reduction::reduce(PETSC_COMM_WORLD, mesh, options, files.back());
    std::printf(" %7d", mesh.n_nodes());
  }
  std::vector<double> positions;
  for (int i = 0; i < kPositions; ++i) positions.push_back(static_cast<double>(i) / kPositions);
  const auto run = drive::sweep_drive(pair, {.torque = torque}, files, positions, folder + "/mesh_counts.h5");
  const evaluation::PairEvaluation found = evaluation::evaluate(run[0]);
  const auto value = [&](const char* path) { return found.values(path)[0]; };
  std::printf("  %8.3f um  %7.3f um  %6.4f  %7.1f MPa  %6.1f MPa  %6.1f MPa\n",
              1e6 * value("transmission_error/mean"), 1e6 * value("transmission_error/peak_to_peak"),
              value("line_load/KHbeta"), 1e-6 * value("pressure/hertz_peak"),
              1e-6 * value("root/pinion/largest_tension"), 1e-6 * value("root/wheel/largest_tension"));
}

}  // namespace

int main(int argc, char** argv) {
  Session session(argc, argv);
  if (argc < 4) {
    std::fprintf(stderr, "mesh_counts: needs a pair (README, helical, C14), a torque in N m and a folder\n");
    return 1;
  }
  const gear::CylindricalDrive of = design(argv[1]);
  for (const auto& [name, change] : kChanges) {
    std::printf("%-13s", name);
    solve(of, change, std::atof(argv[2]), argv[3]);
  }
  return 0;
}
