#include "elastogear/dynamics/marker_forces.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "dynamics/contact/low_rank_columns.h"
#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"

namespace elastogear::dynamics {
namespace {

using body::MarkerMotion;
using body::Wrench;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRotationRoundoff = 1e-9;

template <class Setups>
void require_names(const Setups& setups, const std::string& kind) {
  for (std::size_t i = 0; i < setups.size(); ++i) {
    require(!setups[i].name.empty(), "a ", kind, " has no name");
    for (std::size_t j = 0; j < i; ++j)
      require(setups[j].name != setups[i].name, "two ", kind, "s are named '", setups[i].name, "'");
  }
}

std::string marker_list(const model::ElasticBody& body) {
  std::string list = model::kFrameMarker;
  for (const model::Marker& marker : body.markers)
    if (!marker.area) list += ", " + marker.name;
  return list;
}

Wrench wrench_of(const LoadSetup& load, double time, const MarkerMotion& marker) {
  const Eigen::Matrix3d R = load.follows ? marker.R : Eigen::Matrix3d::Identity();
  Wrench wrench;
  wrench << R * load.force, R * load.torque;
  wrench *= at(load.signal, time);
  if (!load.law) return wrench;
  const Wrench computed = load.law(time, marker);
  require(computed.allFinite(), "load '", load.name, "': its law gives (", computed.transpose(),
          ") at t = ", time, " s: must be finite");
  wrench.head<3>() += R * computed.head<3>();
  wrench.tail<3>() += R * computed.tail<3>();
  return wrench;
}

// R: of the frame that the wrench is given in.
Wrench world_wrench(const Eigen::Matrix3d& R, const Wrench& wrench) {
  Wrench in_world;
  in_world << R * wrench.head<3>(), R * wrench.tail<3>();
  return in_world;
}

// Changes place (m), orientation (rad), velocity (m/s) or angular velocity (rad/s) along one of the axes.
MarkerMotion moved(MarkerMotion marker, int column, double h) {
  const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(column % 3);
  if (column < 3)
    marker.x += step;
  else if (column < 6)
    marker.R = rotation_matrix(step) * marker.R;
  else if (column < 9)
    marker.v += step;
  else
    marker.w += step;
  return marker;
}

}  // namespace

MarkerForces::MarkerForces(const MarkerSetups& setups, const std::vector<Body>& bodies)
    : setups_(setups), bodies_(bodies) {
  require_names(setups.loads, "load");
  require_names(setups.bushings, "bushing");
  require_names(setups.sensors, "sensor");
  for (const LoadSetup& load : setups.loads) add_load(load);
  for (const BushingSetup& bushing : setups.bushings) add_bushing(bushing);
  for (const SensorSetup& sensor : setups.sensors) {
    const std::string who = "sensor '" + sensor.name + "': ";
    sensor_at_.push_back(find(sensor.marker, who));
    require(sensor_at_.back().body >= 0, who, "the ground does not move");
  }
}

MarkerForces::Place MarkerForces::find(const MarkerName& name, const std::string& who) const {
  if (name.body.empty()) return {};
  const auto body =
      std::find_if(bodies_.begin(), bodies_.end(), [&](const Body& b) { return b.name == name.body; });
  require(body != bodies_.end(), who, "there is no body '", name.body, "'");
  const int number = static_cast<int>(body - bodies_.begin());
  if (name.marker == model::kFrameMarker) return {number};
  const auto& markers = body->body->markers;
  const auto marker = std::find_if(markers.begin(), markers.end(),
                                   [&](const model::Marker& m) { return m.name == name.marker; });
  require(marker != markers.end(), who, "body '", name.body, "' has no marker '", name.marker,
          "'; it has: ", marker_list(*body->body), ". Reduce the body again with '", name.marker,
          "' in the option markers of reduce, which takes node sets, face sets and numbers of nodes");
  return {number, &*marker};
}

// Places on the ground are not shared.
int MarkerForces::use(const MarkerName& name, const std::string& who) {
  Place place = find(name, who);
  for (std::size_t i = 0; i < place_.size() && place.body >= 0; ++i)
    if (place_[i].body == place.body && place_[i].marker == place.marker) return static_cast<int>(i);
  if (place.marker) place.row = 6 * marker_count(place.body);
  if (place.body >= 0) {
    place.column = n_columns_;
    n_columns_ += place.marker ? kMotion + 3 : kMotion;
  }
  place_.push_back(place);
  return static_cast<int>(place_.size()) - 1;
}

Index MarkerForces::marker_count(int b) const {
  return std::count_if(place_.begin(), place_.end(),
                       [b](const Place& place) { return place.body == b && place.marker; });
}

void MarkerForces::add_load(const LoadSetup& load) {
  const std::string who = "load '" + load.name + "': ";
  require(!load.marker.body.empty(), who, "a load on the ground moves nothing");
  require(load.force.allFinite() && load.torque.allFinite(), who, "force (", load.force.transpose(),
          ") and torque (", load.torque.transpose(), ") must be finite");
  for (double value : load.signal.value)
    require(std::isfinite(value), who, "signal ", value, " must be finite");
  require(std::isfinite(load.pressure), who, "pressure ", load.pressure, " Pa must be finite");
  load_at_.push_back(use(load.marker, who));
  if (load.pressure != 0) add_pressure(load, who);
  if (!load.torque.isZero(0) || load.follows || load.law) require_turning(place(load_at_.back()), who);
}

// Eq. (3.18a). Of the volume V that the faces sweep, in the first row of Phi of a marker at the origin, a
// unit force along x there has the generalised force dV/dq. The frame takes what the sum over the faces has
// beyond that force.
void MarkerForces::add_pressure(const LoadSetup& load, const std::string& who) {
  const std::size_t number = load_at_.size() - 1;
  const Place& at = place(load_at_.back());
  const auto& markers = bodies_[static_cast<std::size_t>(at.body)].body->markers;
  const std::string name = model::pressure_marker(load.marker.marker);
  const auto faces =
      std::find_if(markers.begin(), markers.end(), [&](const model::Marker& m) { return m.name == name; });
  require(faces != markers.end() && faces->area, who, "marker '", load.marker.marker, "' of body '",
          load.marker.body,
          "' is no set of outer faces, on which a pressure could act: reduce the body again with a face set "
          "of its mesh in the option markers of reduce");
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  Wrench swept = Wrench::Zero(), frame;
  swept.head<3>() = -load.pressure * x;
  frame << -load.pressure * (faces->area->sum - x), -load.pressure * faces->area->moment;
  part_.push_back({number, use({load.marker.body, name}, who), swept});
  part_.push_back({number, use({load.marker.body, model::kFrameMarker}, who), frame});
}

void MarkerForces::add_bushing(const BushingSetup& bushing) {
  const std::string who = "bushing '" + bushing.name + "': ";
  validate(bushing.law, who);
  const Eigen::Matrix3d& A = bushing.axes;
  require(A.allFinite() && (A.transpose() * A - Eigen::Matrix3d::Identity()).norm() < kRotationRoundoff, who,
          "its axes must be of length one and at right angles");
  bushing_at_.push_back({use(bushing.marker[0], who), use(bushing.marker[1], who)});
  const auto [first, second] = bushing_at_.back();
  require(first != second && (place(first).body >= 0 || place(second).body >= 0), who,
          "must lie between two markers, or a marker and the ground");
  for (int i : {first, second}) require_turning(place(i), who);
}

void MarkerForces::require_turning(const Place& place, const std::string& who) {
  require(
      !place.marker || place.marker->turns, who, "marker '", place.marker ? place.marker->name : "",
      "' has no rotation, because its nodes lie on a line: it takes forces in the world's directions only");
}

void MarkerForces::require_tables_cover(double end_time) const {
  for (const LoadSetup& load : setups_.loads)
    require_covers(load.signal, end_time, "load '" + load.name + "': ");
}

MatrixXd MarkerForces::columns(std::size_t b) const {
  const int number = static_cast<int>(b);
  MatrixXd all(bodies_[b].body->n_q(), 6 * marker_count(number));
  for (const Place& place : place_) {
    if (place.body != number || !place.marker) continue;
    model::with_rows(place.marker->Phi,
                     [&](const auto& rows) { all.middleCols(place.row, 6) = MatrixXd(rows).transpose(); });
  }
  return all;
}

void MarkerForces::turn_unloaded(std::size_t bushing, double angle) {
  bushing_[bushing].A_2 *= rotation_matrix({0, 0, -angle});
}

void MarkerForces::set_unloaded(const std::vector<MovingBody>& bodies) {
  bushing_.clear();
  for (std::size_t i = 0; i < bushing_at_.size(); ++i) {
    Place &first = place_[bushing_at_[i][0]], &second = place_[bushing_at_[i][1]];
    if (first.body < 0) first.ground = motion(second, bodies).x;
    if (second.body < 0) second.ground = motion(first, bodies).x;
    const MarkerMotion at_first = motion(first, bodies);
    const BushingSetup& setup = setups_.bushings[i];
    const Eigen::Matrix3d A = setup.axes_of_first ? at_first.R * setup.axes : setup.axes;
    bushing_.push_back(make_bushing(setup.law, A, at_first, motion(second, bodies)));
  }
}

MarkerMotion MarkerForces::motion(const Place& place, const std::vector<MovingBody>& bodies) {
  if (place.body < 0) return {.x = place.ground};
  const MovingBody& body = bodies[static_cast<std::size_t>(place.body)];
  return body::marker_motion(*body.eq, place.marker, body.motion);
}

std::vector<MarkerMotion> MarkerForces::motions(const std::vector<MovingBody>& bodies) const {
  std::vector<MarkerMotion> all;
  for (const Place& place : place_) all.push_back(motion(place, bodies));
  return all;
}

Wrench MarkerForces::part_wrench(const Part& part, double time, const MarkerMotion& marker) const {
  return world_wrench(marker.R, at(setups_.loads[part.load].signal, time) * part.wrench);
}

std::vector<Wrench> MarkerForces::load_wrenches(double time, const std::vector<MarkerMotion>& motion) const {
  std::vector<Wrench> wrench(place_.size(), Wrench::Zero());
  for (std::size_t i = 0; i < load_at_.size(); ++i)
    wrench[load_at_[i]] += wrench_of(setups_.loads[i], time, motion[load_at_[i]]);
  for (const Part& part : part_) wrench[part.place] += part_wrench(part, time, motion[part.place]);
  return wrench;
}

std::vector<Wrench> MarkerForces::bushing_wrenches(const std::vector<MarkerMotion>& motion) const {
  std::vector<Wrench> wrench(place_.size(), Wrench::Zero());
  for (std::size_t i = 0; i < bushing_.size(); ++i) {
    const auto [first, second] = bushing_at_[i];
    const BushingForce state = dynamics::bushing_force(bushing_[i], motion[first], motion[second]);
    wrench[first] += state.on_first(motion[second].x - motion[first].x);
    wrench[second] += state.on_second();
  }
  return wrench;
}

// Adds minus the change of a load's wrench with the motion of its marker, where a law gives it by
// differences.
void MarkerForces::add_stiffness(std::size_t load, double time, const MarkerMotion& marker,
                                 Eigen::Ref<Eigen::Matrix<double, 6, 12>> K) const {
  constexpr double kStep = 1e-6;
  const LoadSetup& setup = setups_.loads[load];
  if (!setup.law && !setup.follows) return;
  const Wrench wrench = wrench_of(setup, time, marker);
  if (setup.law) {
    for (int column = 0; column < kMotion; ++column)
      K.col(column) -= (wrench_of(setup, time, moved(marker, column, kStep)) - wrench) / kStep;
  } else {
    K.block<3, 3>(0, 3) += skew(wrench.head<3>());
    K.block<3, 3>(3, 3) += skew(wrench.tail<3>());
  }
}

// Minus the change of all wrenches with all motions.
MatrixXd MarkerForces::stiffness(double time, const std::vector<MarkerMotion>& motion) const {
  const auto n = static_cast<Index>(place_.size());
  MatrixXd K = MatrixXd::Zero(6 * n, kMotion * n);
  for (std::size_t i = 0; i < load_at_.size(); ++i) {
    const Index at = load_at_[i];
    add_stiffness(i, time, motion[at], K.block<6, kMotion>(6 * at, kMotion * at));
  }
  for (const Part& part : part_) {
    const Wrench wrench = part_wrench(part, time, motion[part.place]);
    K.block<3, 3>(6 * part.place, kMotion * part.place + 3) += skew(wrench.head<3>());
    K.block<3, 3>(6 * part.place + 3, kMotion * part.place + 3) += skew(wrench.tail<3>());
  }
  for (std::size_t i = 0; i < bushing_.size(); ++i) {
    const auto& at = bushing_at_[i];
    const auto D = bushing_derivative(bushing_[i], motion[at[0]], motion[at[1]]);
    for (int a : {0, 1})
      for (int b : {0, 1})
        K.block<6, kMotion>(6 * at[a], kMotion * at[b]) -= D.block<6, kMotion>(6 * a, kMotion * b);
  }
  return K;
}

std::vector<MarkerForce> MarkerForces::forces(double time, const std::vector<MovingBody>& bodies) const {
  std::vector<MarkerForce> h;
  for (const MovingBody& body : bodies) {
    const body::Force none{VectorXd::Zero(body.eq->n_s()), VectorXd::Zero(body.eq->n_q())};
    h.push_back({none, none});
  }
  const std::vector<MarkerMotion> motion = motions(bodies);
  const auto loads = load_wrenches(time, motion), bushings = bushing_wrenches(motion);
  for (std::size_t i = 0; i < place_.size(); ++i) {
    if (place_[i].body < 0) continue;
    const auto b = static_cast<std::size_t>(place_[i].body);
    const auto add = [&](const Wrench& wrench, body::Force& sum) {
      const body::Force force = body::marker_force(*bodies[b].eq, place_[i].marker, bodies[b].motion, wrench);
      sum.s += force.s;
      sum.q += force.q;
    };
    add(loads[i], h[b].loads);
    add(bushings[i], h[b].bushings);
  }
  return h;
}

// The rows of E that belong to markers lie between those of U and of the surface nodes.
void MarkerForces::add_place(const Place& place, const MovingBody& body, const Tangent& tangent,
                             BodyTerms& terms) const {
  const body::MarkerDerivative D =
      body::marker_derivative(*body.eq, place.marker, body.motion, tangent.shift);
  const body::WrenchStiffness K = body::wrench_stiffness(*body.eq, place.marker, body.motion, tangent.wrench);
  const Index column = tangent.first_column + place.column;
  terms.C += K.C;
  terms.V_s.middleCols(column, kMotion) = D.by_s.transpose();
  terms.W_s.middleCols(column, 6) = D.virtual_s.transpose();
  if (!place.marker) return;
  const Index row = terms.beta.rows() - 3 * static_cast<Index>(terms.node.size()) -
                    6 * marker_count(place.body) + place.row;
  terms.beta.middleRows(row, 6) += K.beta;
  terms.rho.middleRows(row, 6) += K.rho;
  for (auto* L : elastic_rows(terms)) {
    add_block(row, column, D.by_q.transpose(), *L);
    add_block(row + 3, column + kMotion, Eigen::Matrix3d::Identity(), *L);
  }
  add_block(column + kMotion, column + kMotion, K.Z, *tangent.k);
}

void MarkerForces::add_tangent(double time, const std::vector<MovingBody>& bodies, const body::Shifts& shift,
                               EffectiveMatrix& A) const {
  const Index first = add_columns(n_columns_, A);
  const std::vector<MarkerMotion> motion = motions(bodies);
  const std::vector<Wrench> loads = load_wrenches(time, motion), bushings = bushing_wrenches(motion);
  const MatrixXd K = stiffness(time, motion);
  for (std::size_t i = 0; i < place_.size(); ++i) {
    if (place_[i].body < 0) continue;
    const auto b = static_cast<std::size_t>(place_[i].body);
    add_place(place_[i], bodies[b], {shift, loads[i] + bushings[i], first, &A.k}, A.body[b]);
    for (std::size_t j = 0; j < place_.size(); ++j)
      if (place_[j].body >= 0)
        add_block(first + place_[i].column, first + place_[j].column,
                  K.block<6, kMotion>(6 * static_cast<Index>(i), kMotion * static_cast<Index>(j)), A.k);
  }
}

MarkerMotion MarkerForces::load_motion(std::size_t i, const std::vector<MovingBody>& bodies) const {
  return motion(place(load_at_[i]), bodies);
}

MarkerMotion MarkerForces::sensor_motion(std::size_t i, const std::vector<MovingBody>& bodies) const {
  return motion(sensor_at_[i], bodies);
}

// Force and moment that load i exerts, N and N m, in the world. Those of a pressure are summed up over its
// faces, the moment about the undeformed place of the marker.
Wrench MarkerForces::load_wrench(std::size_t i, double time, const MarkerMotion& marker) const {
  Wrench wrench = wrench_of(setups_.loads[i], time, marker);
  Wrench pressure = Wrench::Zero();
  for (const Part& part : part_)
    if (part.load == i) pressure += part.wrench;
  if (const Place& at_marker = place(load_at_[i]); at_marker.marker)
    pressure.tail<3>() -= at_marker.marker->X.cross(pressure.head<3>());
  return wrench + world_wrench(marker.R, at(setups_.loads[i].signal, time) * pressure);
}

BushingForce MarkerForces::bushing_force(std::size_t i, const std::vector<MovingBody>& bodies) const {
  const auto [first, second] = bushing_at_[i];
  return dynamics::bushing_force(bushing_[i], motion(place(first), bodies), motion(place(second), bodies));
}

}  // namespace elastogear::dynamics
