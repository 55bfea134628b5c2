#include "io/result/result_rows.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/hdf5/schema.h"
#include "io/result/contact_forces.h"

namespace elastogear::io {
namespace {

using h5::Item;

bool finite(const model::Snapshot& snapshot) {
  bool good = std::isfinite(snapshot.time);
  for (const auto& body : snapshot.bodies)
    good = good && body.r_WB.allFinite() && body.R_WB.allFinite() && body.s.allFinite() &&
           body.s_dot.allFinite() && body.s_ddot.allFinite() && body.q.allFinite() &&
           body.q_dot.allFinite() && body.q_ddot.allFinite() && body.w.allFinite() &&
           body.q_error.allFinite() && body.contact.f_B.allFinite();
  for (const auto& pair : snapshot.pairs)
    good = good && pair.force.allFinite() && pair.torque.allFinite() && std::isfinite(pair.penetration);
  for (const auto& bushing : snapshot.bushings)
    good = good && bushing.force.allFinite() && bushing.torque.allFinite();
  for (const auto& sensor : snapshot.sensors) good = good && sensor.acceleration.allFinite();
  return good;
}

}  // namespace

ResultRows::ResultRows(const h5::File& file, const model::ResultHeader& header, RowCount before)
    : file_(file), header_(header), count_(std::move(before)), first_(count_.times == 0) {
  count_.contacts.resize(header.pairs.size(), 0);
  count_.forces.resize(header.bodies.size(), 0);
}

h5::Series& ResultRows::series_at(const std::string& name, const Item& item) {
  const auto found = series_.find(name);
  if (found == series_.end()) return series_.try_emplace(name, file_, name, item).first->second;
  require(found->second.item().shape == item.shape, file_.path, ": ", name, " changed its size");
  return found->second;
}

void ResultRows::append(const std::string& name, double value, const std::string& unit, bool integer) {
  series_at(name, {{}, unit, integer}).append(&value);
}

void ResultRows::append(const std::string& name, const Eigen::VectorXd& value, const std::string& unit) {
  series_at(name, {{static_cast<hsize_t>(value.size())}, unit}).append(value.data());
}

void ResultRows::append_rotation(const std::string& name,
                                 const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>& R) {
  series_at(name, {{3, 3}, "1"}).append(R.data());
}

// Joint coordinates are lengths or angles, q depends on the basis: their unit is told by the attributes joint
// and file of the body.
void ResultRows::append_body(std::size_t index, const model::BodyState& body) {
  const std::string group = "/bodies/" + header_.bodies[index].name;
  append(group + "/rigid", body.s, "rad or m");
  append(group + "/rigid_velocity", body.s_dot, "rad/s or m/s");
  append(group + "/rigid_acceleration", body.s_ddot, "rad/s^2 or m/s^2");
  append(group + "/joint_force", body.joint_force, "N m or N");
  append(group + "/position", body.r_WB, "m");
  append_rotation(group + "/rotation", body.R_WB);
  append(group + "/q", body.q, "as in the body file");
  append(group + "/q_velocity", body.q_dot, "as q, per s");
  append(group + "/q_acceleration", body.q_ddot, "as q, per s^2");
  if (body.q_error.size() > 0) append(group + kTimeError, body.q_error, "as q");
  if (header_.bodies[index].relaxes)
    series_at(group + kRelaxed, {{extent(body.w.cols()), extent(body.w.rows())}, "as q"})
        .append(body.w.data());
  append_forces(group + kForces, body.contact);
  append_offset(group + kForces, count_.forces[index], body.contact.node.size());
}

void ResultRows::append_forces(const std::string& group, const model::ContactForces& forces) {
  const std::vector<double> node(forces.node.begin(), forces.node.end());
  series_at(group + "/node", {{}, "1", true}).append(node.data(), node.size());
  series_at(group + "/force", {{3}, "N"}).append(forces.f_B.data(), node.size());
}

// The end of n more rows, after the leading 0 of the first.
void ResultRows::append_offset(const std::string& group, double& count, std::size_t n) {
  const std::string offset = group + "/offset";
  if (first_ && !series_.contains(offset)) append(offset, 0, "1", true);
  count += static_cast<double>(n);
  append(offset, count, "1", true);
}

void ResultRows::append_pair(std::size_t index, const model::PairState& pair) {
  const std::string group = "/contact/" + header_.pairs[index].name;
  append(group + "/force", pair.force, "N");
  append(group + "/torque", pair.torque, "N m");
  append(group + "/count", pair.count, "1", true);
  append(group + "/penetration", pair.penetration, "m");
  for (int side : {0, 1}) {
    const std::size_t n = header_.pairs[index].group_name[side].size();
    require(pair.group_force[side].size() == n, file_.path, ": pair ", header_.pairs[index].name, " has ",
            pair.group_force[side].size(), " group forces for ", n, " groups");
    series_at(group + "/groups/" + kSide[side] + "/force", {{n, 3}, "N"})
        .append(n == 0 ? nullptr : pair.group_force[side].front().data());
    append_areas(group + "/groups/" + kSide[side], pair.area[side], n);
  }
  append_total(group, pair.total);
  append_contacts(group + "/points", pair.contacts);
  append_offset(group + "/points", count_.contacts[index], pair.contacts.size());
}

void ResultRows::append_total(const std::string& group, const model::ContactFigures& total) {
  append(group + "/area", total.area, "m^2");
  append(group + "/pressure", total.pressure, "Pa");
  append(group + "/sliding_speed", total.sliding_speed, "m/s");
  append(group + "/friction_power", total.friction_power, "W");
  append(group + "/damping_power", total.damping_power, "W");
}

// areas: one per face group, or none for zeros.
void ResultRows::append_areas(const std::string& group, std::vector<model::ContactFigures> areas,
                              std::size_t n) {
  using Figures = model::ContactFigures;
  require(areas.empty() || areas.size() == n, file_.path, ": ", group, " has ", areas.size(), " areas for ",
          n, " groups");
  areas.resize(n);
  const auto all = [&](const char* name, const Item& item, double (*value)(const Figures&)) {
    Eigen::VectorXd values(n);
    std::transform(areas.begin(), areas.end(), values.begin(), value);
    series_at(group + "/" + name, item).append(values.data());
  };
  Eigen::MatrixXd torque(3, n);
  for (std::size_t i = 0; i < n; ++i) torque.col(static_cast<Eigen::Index>(i)) = areas[i].torque;
  series_at(group + "/torque", {{n, 3}, "N m"}).append(torque.data());
  all("count", {{n}, "1", true}, [](const Figures& f) { return double(f.count); });
  all("area", {{n}, "m^2"}, [](const Figures& f) { return f.area; });
  all("pressure", {{n}, "Pa"}, [](const Figures& f) { return f.pressure; });
  all("sliding_speed", {{n}, "m/s"}, [](const Figures& f) { return f.sliding_speed; });
  all("friction_power", {{n}, "W"}, [](const Figures& f) { return f.friction_power; });
}

void ResultRows::append_contacts(const std::string& group,
                                 const std::vector<model::ContactRecord>& contacts) {
  struct Column {
    const char* name;
    Item item;
    std::array<double, 3> (*value)(const model::ContactRecord&);
  };
  using Record = model::ContactRecord;
  using Values = std::array<double, 3>;
  static const Column columns[] = {
      {"slave_side", {{}, "1", true}, [](const Record& c) { return Values{double(c.slave_side)}; }},
      {"slave_node", {{}, "1", true}, [](const Record& c) { return Values{double(c.slave_node)}; }},
      {"face", {{}, "1", true}, [](const Record& c) { return Values{double(c.face)}; }},
      {"xi", {{}, "1"}, [](const Record& c) { return Values{c.xi}; }},
      {"eta", {{}, "1"}, [](const Record& c) { return Values{c.eta}; }},
      {"gap", {{}, "m"}, [](const Record& c) { return Values{c.g_n}; }},
      {"force",
       {{3}, "N"},
       [](const Record& c) {
         return Values{c.f[0], c.f[1], c.f[2]};
       }},
      {"pressure", {{}, "Pa"}, [](const Record& c) { return Values{c.pressure}; }},
      {"slip", {{3}, "m/s"}, [](const Record& c) {
         return Values{c.slip[0], c.slip[1], c.slip[2]};
       }}};
  for (const Column& column : columns) {
    h5::Series& values = series_at(group + "/" + column.name, column.item);
    for (const Record& contact : contacts) values.append(column.value(contact).data());
  }
}

void ResultRows::append_energy(const model::Energies& energy) {
  append("/energy/kinetic", energy.kinetic, "J");
  append("/energy/elastic", energy.elastic, "J");
  append("/energy/contact", energy.contact, "J");
  append("/energy/dissipated", energy.dissipated, "J");
  append("/energy/work", energy.work, "J");
  append("/energy/balance", energy.balance, "J");
  if (!header_.bushings.empty()) append("/energy/bushing", energy.bushing, "J");
  if (std::any_of(header_.bodies.begin(), header_.bodies.end(),
                  [](const auto& body) { return body.relaxes; }))
    append(kRelaxationLoss, energy.relaxation, "J");
}

void ResultRows::append_bushing(const std::string& group, const model::BushingState& bushing) {
  append(group + "/displacement", bushing.displacement, "m");
  append(group + "/angle", bushing.angle, "rad");
  append(group + "/force", bushing.force, "N");
  append(group + "/torque", bushing.torque, "N m");
}

void ResultRows::append_sensor(const std::string& group, const model::SensorState& sensor) {
  append(group + "/position", sensor.position, "m");
  append(group + "/velocity", sensor.velocity, "m/s");
  append(group + "/acceleration", sensor.acceleration, "m/s^2");
  append_rotation(group + "/rotation", sensor.rotation);
  append(group + "/angular_velocity", sensor.angular_velocity, "rad/s");
}

void ResultRows::check(const model::Snapshot& snapshot) const {
  require(snapshot.bodies.size() == header_.bodies.size() && snapshot.pairs.size() == header_.pairs.size(),
          file_.path, ": a snapshot has ", snapshot.bodies.size(), " bodies and ", snapshot.pairs.size(),
          " pairs, the header ", header_.bodies.size(), " and ", header_.pairs.size());
  require(snapshot.bushings.size() == header_.bushings.size() &&
              snapshot.sensors.size() == header_.sensors.size(),
          file_.path, ": a snapshot has ", snapshot.bushings.size(), " bushings and ",
          snapshot.sensors.size(), " sensors, the header ", header_.bushings.size(), " and ",
          header_.sensors.size());
  for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) {
    const model::ContactForces& forces = snapshot.bodies[i].contact;
    require(forces.f_B.cols() == static_cast<Eigen::Index>(forces.node.size()), file_.path, ": body ",
            header_.bodies[i].name, " has ", forces.f_B.cols(), " contact forces at ", forces.node.size(),
            " nodes");
  }
  require(finite(snapshot), file_.path, ": the state at t = ", snapshot.time, " s is not finite");
  require(snapshot.time > count_.last_time, file_.path, ": time ", snapshot.time, " s does not come after ",
          count_.last_time, " s");
}

void ResultRows::append(const model::Snapshot& snapshot) {
  check(snapshot);
  count_.last_time = snapshot.time;
  ++count_.times;
  append("/time", snapshot.time, "s");
  for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) append_body(i, snapshot.bodies[i]);
  for (std::size_t i = 0; i < snapshot.pairs.size(); ++i) append_pair(i, snapshot.pairs[i]);
  append_energy(snapshot.energy);
  for (std::size_t i = 0; i < snapshot.bushings.size(); ++i)
    append_bushing("/bushings/" + header_.bushings[i], snapshot.bushings[i]);
  for (std::size_t i = 0; i < snapshot.sensors.size(); ++i)
    append_sensor("/sensors/" + header_.sensors[i], snapshot.sensors[i]);
}

void ResultRows::close() {
  for (auto& [name, series] : series_) series.flush();
  series_.clear();
}

}  // namespace elastogear::io
