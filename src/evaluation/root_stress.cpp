#include "evaluation/root_stress.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "elastogear/base/error.h"
#include "elastogear/life/revolution.h"

namespace elastogear::evaluation {
namespace {

constexpr double kSameNode = 1e-5;  // of the tip radius: copies of a node under a turn by pitches

// Nodes of the set by tooth and side.
using ByTooth = std::map<int, std::vector<Eigen::Index>>;
struct Roots {
  ByTooth loaded, both;
};

Roots sort_by_tooth(const io::StressSet& set, const gear::Toothing& toothing, int side) {
  Roots roots;
  for (Eigen::Index i = 0; i < set.X.cols(); ++i) {
    const gear::Flank flank = nearest_flank(toothing, set.X.col(i));
    roots.both[flank.tooth].push_back(i);
    if (flank.side == side) roots.loaded[flank.tooth].push_back(i);
  }
  return roots;
}

// Largest of all times and of some nodes by tooth; adds the histories of their largest ones to `history`.
StressPeak find_peak(const io::StressSet& set, const Eigen::MatrixXd& stress, const Beside& beside,
                     const ByTooth& teeth, const std::vector<int>& tooth, Eigen::MatrixXd& history,
                     Eigen::Index& row) {
  constexpr double kEqualHalves = 1e-6;  // of both halves of an even face, of which the first node is named
  history = Eigen::MatrixXd::Zero(stress.cols(), static_cast<Eigen::Index>(tooth.size()));
  StressPeak peak;
  peak.value = -INFINITY;
  for (std::size_t k = 0; k < tooth.size(); ++k) {
    const auto nodes = teeth.find(tooth[k]);
    if (nodes == teeth.end()) continue;
    for (Eigen::Index step = 0; step < stress.cols(); ++step) {
      double largest = -INFINITY;
      for (Eigen::Index i : nodes->second) {
        if (beside.size() > 0 && beside(i, step)) continue;
        largest = std::max(largest, stress(i, step));
        if (stress(i, step) - peak.value <= kEqualHalves * std::abs(stress(i, step))) continue;
        row = i;
        peak = {.value = stress(i, step),
                .tooth = tooth[k],
                .node = set.node[static_cast<std::size_t>(i)],
                .step = static_cast<int>(step),
                .x = set.X.col(i)};
      }
      if (std::isfinite(largest)) history(step, static_cast<Eigen::Index>(k)) = largest;
    }
  }
  if (set.error.size() > 0) peak.error = set.error(row, peak.step);
  if (set.mesh_error.size() > 0) peak.mesh_error = set.mesh_error(row, peak.step);
  if (set.contact_error.size() > 0) peak.contact_error = set.contact_error(row, peak.step);
  if (set.time_error.size() > 0) peak.time_error = set.time_error(row, peak.step);
  return peak;
}

// The node that is where `node` of one tooth comes when it is turned to another one; -1: there is none.
Eigen::Index copy_of(const io::StressSet& set, const gear::Toothing& t, Eigen::Index node, int pitches) {
  const Eigen::Vector3d x =
      Eigen::AngleAxisd(2 * std::numbers::pi * pitches / t.z, Eigen::Vector3d::UnitZ()) * set.X.col(node);
  Eigen::Index at = 0;
  const double off = (set.X.colwise() - x).colwise().norm().minCoeff(&at);
  return off <= kSameNode * std::max(t.r_a, t.r_f) ? at : -1;
}

// History of one tooth from the copies of its nodes at all others.
std::vector<ToothStress> way_of_tooth(const io::StressSet& set, const Gear& gear, const Gear& mate,
                                      const RootStress& stress, Eigen::Index tension,
                                      Eigen::Index von_mises) {
  std::vector<ToothStress> way;
  for (int tooth : stress.tooth) {
    const Eigen::Index a = copy_of(set, gear.toothing, tension, tooth - stress.largest_tension.tooth),
                       b = copy_of(set, gear.toothing, von_mises, tooth - stress.largest_von_mises.tooth);
    if (a < 0 || b < 0) continue;
    const Eigen::MatrixXd principal = life::signed_principal(set.stress.middleRows<6>(6 * a));
    for (Eigen::Index step = 0; step < set.rankine.cols(); ++step)
      way.push_back({place_of_tooth(gear, mate, tooth, static_cast<std::size_t>(step)), set.rankine(a, step),
                     set.von_mises(b, step), principal(0, step)});
  }
  std::sort(way.begin(), way.end(), [](const auto& x, const auto& y) { return x.place < y.place; });
  return way;
}

}  // namespace

Beside beside_contacts(const io::StressSet& set, const Gear& gear, const ContactHistory& contacts,
                       std::size_t g) {
  constexpr double kAtForm = 1e-6;  // of the form radius
  constexpr double kReach = 2;      // half widths of a patch
  const gear::Toothing& t = gear.toothing;
  const Eigen::ArrayXd below =
      t.sign() * (t.r_form - set.X.topRows<2>().colwise().norm().transpose().array());
  Beside beside(set.X.cols(), static_cast<Eigen::Index>(contacts.size()));
  beside.colwise() = (below <= kAtForm * t.r_form).eval();
  if (beside.all()) beside.setConstant(false);
  for (std::size_t step = 0; step < contacts.size(); ++step)
    for (const FlankContact& c : contacts[step]) {
      if (!(c.half_width > 0) || !(c.normal_force > 0)) continue;
      const double reach = kReach * c.half_width;
      beside.col(static_cast<Eigen::Index>(step)) =
          beside.col(static_cast<Eigen::Index>(step)) ||
          ((set.X.colwise() - c.x_B[g]).colwise().squaredNorm().transpose().array() < reach * reach);
    }
  return beside;
}

RootStress root_stress(const io::StressSet& set, const Gear& gear, const Gear& mate, int side,
                       const Beside& beside) {
  require(set.X.cols() == set.rankine.rows() && set.X.cols() > 0 && set.stress.rows() == 6 * set.X.cols(),
          "stresses of ", set.body, "/", set.set,
          ": hold no positions or no stresses of all their nodes; recover them anew");
  const Roots roots = sort_by_tooth(set, gear.toothing, side);
  require(!roots.loaded.empty(), "stresses of ", set.body, "/", set.set, ": no node is at the ",
          side > 0 ? "left" : "right", " side of a tooth");
  RootStress stress;
  stress.side = side;
  for (const auto& [tooth, nodes] : roots.both) stress.tooth.push_back(tooth);
  Eigen::Index tension = 0, von_mises = 0;
  stress.largest_tension =
      find_peak(set, set.rankine, beside, roots.loaded, stress.tooth, stress.tension, tension);
  stress.largest_von_mises =
      find_peak(set, set.von_mises, beside, roots.both, stress.tooth, stress.von_mises, von_mises);
  stress.way = way_of_tooth(set, gear, mate, stress, tension, von_mises);
  if (!stress.way.empty()) {
    const auto [low, high] =
        std::minmax_element(stress.way.begin(), stress.way.end(),
                            [](const auto& x, const auto& y) { return x.stress < y.stress; });
    stress.range = high->stress - low->stress;
  }
  return stress;
}

}  // namespace elastogear::evaluation
