#include "evaluation/sections.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "elastogear/evaluation/face_stations.h"
#include "evaluation/load/hertz.h"
#include "evaluation/load/line_load.h"
#include "evaluation/load/pattern.h"
#include "evaluation/root_stress.h"
#include "evaluation/signal.h"

namespace elastogear::evaluation {
namespace {

const char* side_name(int side) { return side > 0 ? "left" : "right"; }

FaceStations stations_of(const PairOfRun& pair, int along) {
  return stations(both(pair), pair.slave_side, pair.strips, along);
}

// Numbers of teeth from 1, as in the names of sets.
Eigen::MatrixXd numbers_of(const ToothPairs& pairs) {
  Eigen::MatrixXd tooth(static_cast<Eigen::Index>(pairs.tooth.size()), 2);
  for (Eigen::Index i = 0; i < tooth.rows(); ++i)
    for (int g : {0, 1})
      tooth(i, g) = pairs.tooth[static_cast<std::size_t>(i)][static_cast<std::size_t>(g)] + 1;
  return tooth;
}

Eigen::MatrixXd places_of(const PairOfRun& pair, const ToothPairs& pairs) {
  Eigen::MatrixXd place = pairs.share;
  for (Eigen::Index i = 0; i < place.rows(); ++i)
    for (Eigen::Index k = 0; k < place.cols(); ++k)
      place(i, k) = place_of_tooth(pair.gear[1], pair.gear[0], pairs.tooth[static_cast<std::size_t>(k)][1],
                                   static_cast<std::size_t>(i));
  return place;
}

// Where on the way of a tooth of the second gear contact begins and ends, beside rigid gears.
void add_path(const PairOfRun& pair, const ToothPairs& pairs, const Eigen::MatrixXd& place, Items& items) {
  const auto bears = (pairs.share.array() > kBears).eval();
  if (!bears.any()) return;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  items.number("teeth/begins", "1", "smallest place of a loaded pair of teeth, pitches",
               bears.select(place.array(), kInfinity).minCoeff());
  items.number("teeth/ends", "1", "largest place of a loaded pair of teeth, pitches",
               bears.select(place.array(), -kInfinity).maxCoeff());
  const auto path = path_of_contact(pair.gear[0], pair.gear[1], loaded_side(pair.contacts, 1));
  if (!path) return;
  items.number("teeth/path_begins", "1", "place where rigid teeth begin to touch, pitches", path->front());
  items.number("teeth/path_ends", "1", "place where rigid teeth cease to touch, pitches", path->back());
}

// Half of the way by which contact moves along the profile from one position to the next, m: for involutes
// the step of a transverse base pitch.
double half_way(const PairOfRun& pair, const Gear& gear) {
  const Eigen::Index n = pair.roll.size();
  const double step = n > 1 ? std::abs(pair.roll[n - 1] - pair.roll[0]) / static_cast<double>(n - 1) : 0;
  const gear::Toothing& t = gear.toothing;
  const double way = has_length_of_roll(t) ? 2 * std::numbers::pi * t.r_b / t.z : std::abs(t.r_a - t.r_f);
  return std::min(step, 0.25) * way / 2;
}

void add_place(const Gear& gear, const FlankContact& c, int g, const std::string& path, Items& items) {
  const FlankPlace place = flank_place(gear.toothing, c.x_B[static_cast<std::size_t>(g)]);
  const gear::Flank& flank = c.flank[static_cast<std::size_t>(g)];
  items.number(path + "/tooth", "1", "tooth of " + gear.name, flank.tooth + 1);
  items.words(path + "/side", "side of the tooth", {side_name(flank.side)});
  items.number(path + (has_length_of_roll(gear.toothing) ? "/length_of_roll" : "/radius"), "m",
               "place along the profile", place.profile);
  items.number(path + "/diameter", "m", "diameter there",
               2 * c.x_B[static_cast<std::size_t>(g)].head<2>().norm());
  items.number(path + "/z", "m", "place along the axis, body frame", place.z);
}

void add_patterns(const PairOfRun& pair, int g, Items& items) {
  const Gear& gear = pair.gear[static_cast<std::size_t>(g)];
  const FaceStations over_face = stations_of(pair, g);
  for (int side : {1, -1}) {
    const auto pattern = contact_pattern(pair.contacts, gear, g, side, half_way(pair, gear), over_face);
    if (!pattern) continue;
    const std::string path = "pattern/" + gear.name + "_" + side_name(side);
    Eigen::VectorXd radius = pattern->profile;
    if (has_length_of_roll(gear.toothing)) {
      items.curve(path + "/length_of_roll", "m", "middles of the cells along the profile", pattern->profile);
      radius = (radius.array().square() + std::pow(gear.toothing.r_b, 2)).sqrt();
    }
    items.curve(path + "/radius", "m", "middles of the cells along the profile", radius);
    items.curve(path + "/z", "m", "middles of the cells along the axis, body frame", pattern->z);
    items.table(path + "/pressure", "Pa", "largest pressure over the run, all teeth; profile x axis",
                pattern->pressure);
    items.number(path + "/covered", "1", "share of the flank that was in contact",
                 (pattern->pressure.array() > 0).cast<double>().mean());
  }
}

void add_peak(const io::StressSet& set, const StressPeak& peak, const Eigen::VectorXd& roll,
              const std::string& path, const std::string& what, Items& items) {
  items.number(path, "Pa", what, peak.value);
  items.number(path + "_node", "1", "mesh node of it", peak.node);
  items.number(path + "_tooth", "1", "tooth of it", peak.tooth + 1);
  items.number(path + "_roll", "1", "roll angle of it, pitches", roll[peak.step]);
  items.number(path + "_diameter", "m", "diameter at its node", 2 * peak.x.head<2>().norm());
  items.number(path + "_z", "m", "place of its node along the axis, body frame", peak.x[2]);
  if (set.error.size() > 0)
    items.number(path + "_error", "Pa", "estimated error of the reduction of von Mises stress there",
                 peak.error);
  if (set.mesh_error.size() > 0)
    items.number(path + "_mesh_error", "Pa", "estimated error of von Mises stress there by the mesh",
                 peak.mesh_error);
  if (set.contact_error.size() > 0)
    items.number(path + "_contact_error", "Pa",
                 "estimated error of von Mises stress there by the contact's resolution", peak.contact_error);
  if (set.time_error.size() > 0)
    items.number(path + "_time_error", "Pa", "estimated error of von Mises stress there by the steps in time",
                 peak.time_error);
}

void add_way(const RootStress& stress, const std::string& path, Items& items) {
  const auto n = static_cast<Eigen::Index>(stress.way.size());
  Eigen::VectorXd place(n), tension(n), von_mises(n), principal(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ToothStress& s = stress.way[static_cast<std::size_t>(i)];
    place[i] = s.place, tension[i] = s.tension, von_mises[i] = s.von_mises;
    principal[i] = s.stress;
  }
  items.curve(path + "/way/place", "1", "place of a tooth on its way through the mesh, pitches", place);
  items.curve(path + "/way/tension", "Pa", "largest principal stress at the node of the largest tension",
              tension);
  items.curve(path + "/way/von_mises", "Pa", "at the node of the largest von Mises stress", von_mises);
  items.curve(path + "/way/stress", "Pa",
              "principal stress of largest size with its sign, at the node of the largest tension",
              principal);
  if (n > 0) items.number(path + "/range", "Pa", "largest less smallest value of way/stress", stress.range);
}

// E* of both flanks, Pa; 0: not known.
double plane_modulus(const PairOfRun& pair) {
  const bool known = pair.compliance[0] > 0 && pair.compliance[1] > 0;
  return known ? 1 / (pair.compliance[0] + pair.compliance[1]) : 0;
}

bool is_parallel(const PairOfRun& pair) { return transmission(pair.gear[0], pair.gear[1], 1).parallel; }

}  // namespace

void add_teeth(const PairOfRun& pair, Items& items) {
  const ToothPairs pairs = tooth_pairs(pair.contacts);
  if (pairs.tooth.empty()) return;
  items.table("teeth/tooth", "1", "teeth of both gears that form a pair, from 1 as in the names of sets",
              numbers_of(pairs));
  items.table("teeth/force", "N", "normal force of each pair of teeth", pairs.force);
  items.table("teeth/share", "1", "share of each pair of teeth in the sum of normal forces", pairs.share);
  const Eigen::MatrixXd place = places_of(pair, pairs);
  items.table("teeth/place", "1",
              "place of each pair, by the tooth of the second gear, on its way through the mesh, pitches",
              place);
  add_path(pair, pairs, place, items);
  items.curve("teeth/count", "1", "pairs of teeth in contact", pairs.count.cast<double>());
  items.number("teeth/contact_ratio", "1", "operating contact ratio: mean number of pairs in contact",
               contact_ratio(pairs));
  items.number("teeth/largest_share", "1", "largest share of one pair of teeth", pairs.share.maxCoeff());
}

void add_line_load(const PairOfRun& pair, Items& items) {
  const LineLoad load = line_load(pair.contacts, stations_of(pair, 1));
  const double factor = face_load_factor(load);
  if (!std::isfinite(factor)) return;
  items.curve("line_load/z", "m", "stations along the second gear's axis, its body frame", load.stations.z);
  items.curve("line_load/width", "m", "of the face that each of them stands for", load.stations.widths());
  items.table("line_load/value", "N/m", "normal force of all pairs of teeth per width", load.value);
  items.curve("line_load/mean", "N/m", "the same in the mean over the run", mean_line_load(load));
  if (is_parallel(pair))  // on crossed axes flanks touch at points, or on lines across the face
    items.number("line_load/KHbeta", "1", "largest over mean line load, in the mean over the run", factor);
}

void take_hertz(PairOfRun& pair) {
  const double E_star = plane_modulus(pair);
  if (!(E_star > 0)) return;
  take_hertz(both(pair), stations_of(pair, 1), E_star, pair.contacts);
  pair.by_hertz = is_parallel(pair);
}

void add_hertz(const PairOfRun& pair, Items& items) {
  const double E_star = plane_modulus(pair);
  if (!(E_star > 0)) return;
  const auto hertz = hertz_pressure(both(pair), pair.contacts, stations_of(pair, 1), E_star);
  if (!hertz || !(hertz->patch.pressure > 0)) return;
  items.curve("pressure/hertz", "Pa", "largest contact pressure by H. Hertz under the forces of the run",
              hertz->largest);
  items.number("pressure/hertz_peak", "Pa", "its largest value", hertz->patch.pressure);
  items.number("pressure/hertz_peak_roll", "1", "roll angle of it, pitches", pair.roll[hertz->step]);
  items.number("pressure/hertz_half_width", "m", "half the patch's width there, by H. Hertz",
               hertz->patch.half_width);
  const model::ShearBelow shear = model::largest_shear(hertz->patch, pair.friction);
  items.number("pressure/hertz_shear", "Pa", "largest shear stress below it, by H. Hertz", shear.stress);
  items.number("pressure/hertz_shear_depth", "m", "depth of it below the flank", shear.depth);
  items.number("pressure/hertz_left_out", "1",
               "share of the pairs of teeth of all times whose patch has no such figure", hertz->left_out);
}

void add_pressure(const PairOfRun& pair, Items& items) {
  const auto peak = largest_pressure(pair.contacts);
  if (!peak) return;
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(pair.roll.size());
  for (Eigen::Index i = 0; i < largest.size(); ++i)
    for (const FlankContact& c : pair.contacts[static_cast<std::size_t>(i)])
      largest[i] = std::max(largest[i], c.pressure);
  const std::string what = pair.by_hertz ? "largest contact pressure by H. Hertz"
                                         : "largest contact pressure in the mean over faces of the mesh";
  items.curve("pressure/largest", "Pa", what, largest);
  items.number("pressure/peak", "Pa", what + ", of the run", peak->pressure);
  items.number("pressure/by_hertz", "1", "1: pressures and patterns are by H. Hertz; 0: means over faces",
               pair.by_hertz ? 1 : 0);
  items.number("pressure/peak_roll", "1", "roll angle of it, pitches", pair.roll[peak->step]);
  for (int g : {0, 1}) {
    add_place(pair.gear[static_cast<std::size_t>(g)], peak->contact, g,
              "pressure/peak_on_" + pair.gear[static_cast<std::size_t>(g)].name, items);
    add_patterns(pair, g, items);
  }
}

void add_roots(const PairOfRun& pair, Items& items) {
  for (std::size_t g : {0, 1}) {
    const int side = loaded_side(pair.contacts, static_cast<int>(g));
    if (!pair.root[g] || side == 0) continue;
    const Gear& gear = pair.gear[g];
    const io::StressSet& set = *pair.root[g];
    const RootStress stress =
        root_stress(set, gear, pair.gear[1 - g], side, beside_contacts(set, gear, pair.contacts, g));
    const std::string path = "root/" + gear.name;
    Eigen::VectorXd tooth(static_cast<Eigen::Index>(stress.tooth.size()));
    for (Eigen::Index i = 0; i < tooth.size(); ++i) tooth[i] = stress.tooth[static_cast<std::size_t>(i)] + 1;
    items.curve(path + "/tooth", "1", "teeth, from 1 as in the names of sets", tooth);
    items.table(path + "/tension", "Pa", "largest principal stress at the loaded side of each tooth's root",
                stress.tension);
    items.table(path + "/von_mises", "Pa", "largest von Mises stress at each tooth's root", stress.von_mises);
    items.words(path + "/side", "loaded side of the teeth", {side_name(side)});
    add_peak(set, stress.largest_tension, pair.roll, path + "/largest_tension",
             "largest principal stress at the loaded side of the roots", items);
    add_peak(set, stress.largest_von_mises, pair.roll, path + "/largest_von_mises",
             "largest von Mises stress at the roots", items);
    add_way(stress, path, items);
  }
}

}  // namespace elastogear::evaluation
