#include "evaluation/load/pattern.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "elastogear/gear/modification.h"

namespace elastogear::evaluation {
namespace {

constexpr int kProfileCells = 60, kFaceCells = 60;

Eigen::VectorXd middles(double begin, double end, int n) {
  const double half = (end - begin) / (2 * n);
  return Eigen::VectorXd::LinSpaced(n, begin + half, end - half);
}

// The part of the face that a contact at z stands for: that of its station, or half of the way to the next
// stations, within them.
std::array<double, 2> part_of_face(const FaceStations& stations, double z) {
  const Eigen::Index left = share_out(stations, z).station[0];
  if (stations.of_parts) return {stations.ends[left], stations.ends[left + 1]};
  const double half = (stations.z[left + 1] - stations.z[left]) / 2;
  return {std::max(z - half, stations.z[0]), std::min(z + half, stations.z[stations.n() - 1])};
}

// First and last cell whose middles lie in a span; first > last: none does, then the nearest one is taken.
std::pair<Eigen::Index, Eigen::Index> cells(const Eigen::VectorXd& middle, double begin, double end) {
  const double cell = middle[1] - middle[0], start = middle[0] - cell / 2;
  const auto index = [&](double at) {
    return std::clamp<Eigen::Index>(static_cast<Eigen::Index>(std::floor((at - start) / cell)), 0,
                                    middle.size() - 1);
  };
  return {index(begin), index(end)};
}

void cover(ContactPattern& pattern, const FaceStations& stations, const FlankPlace& at, double reach,
           double pressure) {
  const auto [begin, end] = part_of_face(stations, at.z);
  const auto [p_0, p_1] = cells(pattern.profile, at.profile - reach, at.profile + reach);
  const auto [z_0, z_1] = cells(pattern.z, begin, end);
  auto block = pattern.pressure.block(p_0, z_0, p_1 - p_0 + 1, z_1 - z_0 + 1);
  block = block.cwiseMax(pressure);
}

}  // namespace

bool has_length_of_roll(const gear::Toothing& toothing) { return toothing.r_b > 0 && !toothing.half_angle; }

FlankPlace flank_place(const gear::Toothing& toothing, const Eigen::Vector3d& x_B) {
  const double r = std::hypot(x_B[0], x_B[1]);
  return {has_length_of_roll(toothing) ? gear::length_of_roll(toothing, r) : r, x_B[2]};
}

std::optional<ContactPattern> contact_pattern(const ContactHistory& contacts, const Gear& gear, int g,
                                              int side, double reach, const FaceStations& stations) {
  const gear::Toothing& t = gear.toothing;
  const auto profile = [&](double r) { return flank_place(t, {r, 0, 0}).profile; };
  const auto [begin, end] = std::minmax({profile(t.r_form), profile(t.r_a)});
  ContactPattern pattern{side, middles(begin, end, kProfileCells),
                         middles(-gear.width / 2, gear.width / 2, kFaceCells),
                         Eigen::MatrixXd::Zero(kProfileCells, kFaceCells)};
  bool touched = false;
  for (const auto& step : contacts)
    for (const FlankContact& c : step) {
      if (c.flank[g].side != side) continue;
      touched = true;
      cover(pattern, stations, flank_place(t, c.x_B[g]), reach, c.pressure);
    }
  if (!touched) return {};
  return pattern;
}

std::optional<PressurePeak> largest_pressure(const ContactHistory& contacts) {
  constexpr double kEqualEnds = 1e-6;  // of both ends of an even face, of which the first one is named
  std::optional<PressurePeak> peak;
  for (std::size_t step = 0; step < contacts.size(); ++step)
    for (const FlankContact& c : contacts[step])
      if (!peak || c.pressure > (1 + kEqualEnds) * peak->pressure)
        peak = {c.pressure, static_cast<int>(step), c};
  return peak;
}

}  // namespace elastogear::evaluation
