#include <algorithm>
#include <cmath>
#include <sstream>

#include "elastogear/io/result_file.h"
#include "io/hdf5/schema.h"
#include "io/result/contact_forces.h"
#include "io/result/result_rows.h"
#include "io/result/run_input.h"

namespace elastogear::io {
namespace {

// Names of the members of a group in the order of their attribute `number`.
std::vector<std::string> in_order(const h5::File& file, const std::string& group) {
  const std::vector<std::string> names = h5::members(file, group);
  std::vector<std::string> ordered(names.size());
  for (const std::string& name : names) {
    const int number = h5::int_attribute(file, std::string(group).append("/").append(name), "number").front();
    require(number >= 0 && number < static_cast<int>(names.size()) && ordered[number].empty(), file.path,
            ": ", group, "/", name, " has the number ", number, ", must be one of 0..", names.size() - 1);
    ordered[number] = name;
  }
  return ordered;
}

std::vector<std::string> members_if_any(const h5::File& file, const std::string& group) {
  return h5::exists(file, group) ? h5::members(file, group) : std::vector<std::string>();
}

h5::File open_with(const std::string& path, const std::string& group, const std::string& name) {
  h5::File file = open_format(path, kResultFormat);
  const std::vector<std::string> names = members_if_any(file, group);
  std::string known;
  for (const std::string& n : names) known += (known.empty() ? "" : ", ") + n;
  require(std::find(names.begin(), names.end(), name) != names.end(), path, ": has no ", group, "/", name,
          "; it has: ", known.empty() ? "none" : known);
  return file;
}

hsize_t time_count(const h5::File& file) { return static_cast<hsize_t>(read_time(file).size()); }

// n_t x item in the file is item x n_t here.
Eigen::MatrixXd read_columns(const h5::File& file, const std::string& name, const h5::Shape& item) {
  const hsize_t n_t = time_count(file);
  h5::Shape expected{n_t};
  expected.insert(expected.end(), item.begin(), item.end());
  const auto values = h5::read<double>(file, name, expected);
  const auto columns = static_cast<Eigen::Index>(n_t);
  // An item of size 0 or a file without times leaves no values to divide.
  return Eigen::Map<const Eigen::MatrixXd>(
      values.data(), columns == 0 ? 0 : static_cast<Eigen::Index>(values.size()) / columns, columns);
}

// n_t + 1 ends of the rows of each time.
std::vector<int> read_offset(const h5::File& file, const std::string& group) {
  auto offset = h5::read<int>(file, group + "/offset", {time_count(file) + 1});
  require(offset.front() == 0 && std::is_sorted(offset.begin(), offset.end()), file.path, ": ", group,
          "/offset does not ascend from 0");
  return offset;
}

Eigen::Matrix3Xd read_vectors(const h5::File& file, const std::string& name, hsize_t n) {
  const auto values = h5::read<double>(file, name, {n, 3});
  return Eigen::Map<const Eigen::Matrix3Xd>(values.data(), 3, static_cast<Eigen::Index>(n));
}

std::vector<NodalForce> stored_forces(const h5::File& file, const std::string& body) {
  const std::string group = "/bodies/" + body + kForces;
  const std::vector<int> offset = read_offset(file, group);
  const auto n = static_cast<hsize_t>(offset.back());
  const auto node = h5::read<int>(file, group + "/node", {n});
  const Eigen::Matrix3Xd f_B = read_vectors(file, group + "/force", n);
  std::vector<NodalForce> forces;
  for (std::size_t step = 0; step + 1 < offset.size(); ++step)
    for (int i = offset[step]; i < offset[step + 1]; ++i)
      forces.push_back({static_cast<Eigen::Index>(step), node[i], f_B.col(i)});
  return forces;
}

int read_strips(const h5::File& file, const std::string& group) {
  constexpr int kMost = 1000;
  const std::vector<int> strips = h5::int_attribute(file, group, "strips");
  require(strips.size() == 1 && strips[0] > 0 && strips[0] <= kMost, file.path, ": ", group,
          ": attribute strips must be a number from 1 to ", kMost);
  return strips[0];
}

double read_friction(const h5::File& file, const std::string& group) {
  const double friction = h5::number_attribute(file, group, "friction");
  require(std::isfinite(friction) && friction >= 0, file.path, ": ", group,
          ": attribute friction = ", friction, ", must be at least 0");
  return friction;
}

model::ResultHeader::Pair read_pair(const h5::File& file, const std::string& name, std::size_t n_bodies) {
  const std::string group = "/contact/" + name;
  model::ResultHeader::Pair pair;
  pair.name = name;
  const std::vector<int> body = h5::int_attribute(file, group, "body");
  require(body.size() == 2, file.path, ": ", group, ": attribute body must be two numbers");
  if (h5::has_attribute(file, group, "law")) pair.law = h5::string_attribute(file, group, "law");
  if (h5::has_attribute(file, group, "strips")) pair.strips = read_strips(file, group);
  if (h5::has_attribute(file, group, "friction")) pair.friction = read_friction(file, group);
  for (int side : {0, 1}) {
    require(body[side] >= 0 && body[side] < static_cast<int>(n_bodies), file.path, ": ", group,
            " names body ", body[side], " of ", n_bodies);
    pair.body[side] = body[side];
    pair.group_name[side] = h5::read_strings(file, group + "/groups/" + kSide[side] + "/name");
  }
  return pair;
}

}  // namespace

model::ResultHeader read_result_header(const std::string& path) {
  const h5::File file = open_format(path, kResultFormat);
  model::ResultHeader header;
  header.provenance = h5::read_map(file, "/provenance");
  for (const std::string& name : in_order(file, "/bodies"))
    header.bodies.push_back({name, h5::string_attribute(file, "/bodies/" + name, "file"),
                             h5::string_attribute(file, "/bodies/" + name, "joint")});
  for (const std::string& name : in_order(file, "/contact"))
    header.pairs.push_back(read_pair(file, name, header.bodies.size()));
  if (h5::exists(file, "/bushings")) header.bushings = in_order(file, "/bushings");
  if (h5::exists(file, "/sensors")) header.sensors = in_order(file, "/sensors");
  header.input = read_run_input(file);
  return header;
}

bool is_complete(const std::string& path) {
  const h5::File file = open_format(path, kResultFormat);
  return !h5::has_attribute(file, "/", "complete") || h5::int_attribute(file, "/", "complete").front() != 0;
}

TimeAxis time_axis(const std::optional<model::RunInput>& input) {
  const model::RunInput run = input.value_or(model::RunInput{});
  if (run.analysis == model::Analysis::sweep) return {"roll angle", "pitches"};
  if (run.analysis == model::Analysis::equilibrium && !run.creeps) return {"load factor", "1"};
  return {"time", "s"};
}

std::string TimeAxis::at(double value) const {
  std::ostringstream text;
  text << (unit == "s" ? "t =" : name) << " " << value << (unit == "1" ? "" : " " + unit);
  return text.str();
}

Eigen::VectorXd read_times(const std::string& path) { return read_time(open_format(path, kResultFormat)); }

BodyHistory read_joint_history(const std::string& path, const std::string& body) {
  const h5::File file = open_with(path, "/bodies", body);
  const std::string group = "/bodies/" + body;
  const auto read = [&](const char* name) { return read_columns(file, group + name, {h5::kAny}); };
  BodyHistory history;
  history.s = read("/rigid");
  history.s_dot = read("/rigid_velocity");
  history.s_ddot = read("/rigid_acceleration");
  history.r_WB = read_columns(file, group + "/position", {3});
  history.R_WB = read_columns(file, group + "/rotation", {3, 3});
  return history;
}

BodyHistory read_body_history(const std::string& path, const std::string& body) {
  BodyHistory history = read_joint_history(path, body);
  const h5::File file = open_with(path, "/bodies", body);
  const auto read = [&](const char* name) {
    return read_columns(file, "/bodies/" + body + name, {h5::kAny});
  };
  history.q = read("/q");
  history.q_dot = read("/q_velocity");
  history.q_ddot = read("/q_acceleration");
  const std::string error = "/bodies/" + body + kTimeError;
  if (h5::exists(file, error)) history.q_error = read_columns(file, error, {extent(history.q.rows())});
  const std::string relaxed = "/bodies/" + body + kRelaxed;
  if (h5::exists(file, relaxed)) history.w = read_columns(file, relaxed, {h5::kAny, h5::kAny});
  return history;
}

model::ForceHistory read_contact_forces(const std::string& path, const std::string& body,
                                        const model::Surface& surface) {
  const h5::File file = open_with(path, "/bodies", body);
  const std::vector<NodalForce> forces =
      version(file) < kFirstWithForces ? forces_of_points(path, body, surface) : stored_forces(file, body);
  model::ForceHistory history;
  std::vector<int>& nodes = history.node;
  for (const NodalForce& force : forces) nodes.push_back(force.node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const auto outside = std::find_if(nodes.begin(), nodes.end(),
                                    [&](int node) { return node < 0 || node >= surface.X.cols(); });
  if (outside != nodes.end())
    fail(path, ": a contact force acts on node ", *outside, " of '", body, "', whose surface has 0..",
         surface.X.cols() - 1, ": is this the body file of the run?");
  history.force.setZero(3 * static_cast<Eigen::Index>(nodes.size()),
                        static_cast<Eigen::Index>(time_count(file)));
  for (const NodalForce& force : forces) {
    const auto slot = std::lower_bound(nodes.begin(), nodes.end(), force.node) - nodes.begin();
    history.force.block<3, 1>(3 * slot, force.step) += force.f_B;
  }
  return history;
}

PairHistory read_pair_history(const std::string& path, const std::string& pair) {
  const h5::File file = open_with(path, "/contact", pair);
  const std::string group = "/contact/" + pair;
  PairHistory history;
  history.force = read_columns(file, group + "/force", {3});
  history.torque = read_columns(file, group + "/torque", {3});
  history.count = read_columns(file, group + "/count", {}).transpose().cast<int>();
  history.penetration = read_columns(file, group + "/penetration", {}).transpose();
  const auto figure = [&](const char* name) {
    return Eigen::VectorXd(read_columns(file, group + "/" + name, {}).transpose());
  };
  history.area = figure("area");
  history.pressure = figure("pressure");
  history.sliding_speed = figure("sliding_speed");
  history.friction_power = figure("friction_power");
  history.damping_power = figure("damping_power");
  for (int side : {0, 1}) {
    const std::string groups = group + "/groups/" + kSide[side];
    history.group_name[side] = h5::read_strings(file, groups + "/name");
    history.group_force[side] = read_columns(file, groups + "/force", {history.group_name[side].size(), 3});
  }
  return history;
}

EnergyHistory read_energies(const std::string& path) {
  const h5::File file = open_format(path, kResultFormat);
  const auto read = [&](const std::string& name) {
    return read_vector(file, "/energy/" + name, time_count(file));
  };
  EnergyHistory energy{read("kinetic"),
                       read("elastic"),
                       read("contact"),
                       read("dissipated"),
                       read("work"),
                       read("balance"),
                       {},
                       {}};
  const auto read_if_there = [&](const std::string& name) -> Eigen::VectorXd {
    if (h5::exists(file, name)) return read_vector(file, name, time_count(file));
    return Eigen::VectorXd::Zero(energy.kinetic.size());
  };
  energy.bushing = read_if_there("/energy/bushing");
  energy.relaxation = read_if_there(kRelaxationLoss);
  return energy;
}

BushingHistory read_bushing_history(const std::string& path, const std::string& bushing) {
  const h5::File file = open_with(path, "/bushings", bushing);
  const auto read = [&](const char* name) { return read_columns(file, "/bushings/" + bushing + name, {3}); };
  return {read("/displacement"), read("/angle"), read("/force"), read("/torque")};
}

SensorHistory read_sensor_history(const std::string& path, const std::string& sensor) {
  const h5::File file = open_with(path, "/sensors", sensor);
  const std::string group = "/sensors/" + sensor;
  const auto read = [&](const char* name) { return read_columns(file, group + name, {3}); };
  return {read("/position"), read("/velocity"), read("/acceleration"),
          read_columns(file, group + "/rotation", {3, 3}), read("/angular_velocity")};
}

std::vector<std::vector<model::ContactRecord>> read_contacts(const std::string& path,
                                                             const std::string& pair) {
  const h5::File file = open_with(path, "/contact", pair);
  const std::string group = "/contact/" + pair + "/points/";
  const std::vector<int> offset = read_offset(file, "/contact/" + pair + "/points");
  const auto n = static_cast<hsize_t>(offset.back());
  const auto integers = [&](const char* name) { return h5::read<int>(file, group + name, {n}); };
  const auto side = integers("slave_side"), node = integers("slave_node"), face = integers("face");
  const Eigen::VectorXd xi = read_vector(file, group + "xi", n), eta = read_vector(file, group + "eta", n),
                        gap = read_vector(file, group + "gap", n);
  const Eigen::VectorXd pressure = read_vector(file, group + "pressure", n);
  const Eigen::Matrix3Xd force = read_vectors(file, group + "force", n),
                         slip = read_vectors(file, group + "slip", n);
  std::vector<std::vector<model::ContactRecord>> contacts(offset.size() - 1);
  for (std::size_t step = 0; step < contacts.size(); ++step)
    for (int i = offset[step]; i < offset[step + 1]; ++i)
      contacts[step].push_back(
          {side[i], node[i], face[i], xi[i], eta[i], gap[i], force.col(i), pressure[i], slip.col(i)});
  return contacts;
}

}  // namespace elastogear::io
