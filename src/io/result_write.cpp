#include <array>
#include <cmath>
#include <limits>

#include "elastogear/base/file.h"
#include "elastogear/io/result_file.h"
#include "schema.h"

namespace elastogear::io {
namespace {

using h5::Item;

constexpr const char* kSide[2] = {"a", "b"};

void write_header(const h5::File& file, const model::ResultHeader& header) {
  write_format(file, kResultFormat);
  h5::write_map(file, "/provenance", header.provenance);
  h5::make_group(file, "/bodies");
  for (std::size_t i = 0; i < header.bodies.size(); ++i) {
    const auto& body = header.bodies[i];
    require_name(file, body.name);
    h5::make_group(file, "/bodies/" + body.name);
    h5::set_attribute(file, "/bodies/" + body.name, "number", static_cast<int>(i));
    h5::set_attribute(file, "/bodies/" + body.name, "file", body.file);
    h5::set_attribute(file, "/bodies/" + body.name, "joint", body.joint);
  }
  h5::make_group(file, "/contact");
  for (std::size_t i = 0; i < header.pairs.size(); ++i) {
    const auto& pair = header.pairs[i];
    require_name(file, pair.name);
    const std::string group = "/contact/" + pair.name;
    h5::make_group(file, group);
    h5::set_attribute(file, group, "number", static_cast<int>(i));
    h5::set_attribute(file, group, "body", std::vector{pair.body[0], pair.body[1]});
    for (int side : {0, 1})
      h5::write_strings(file, group + "/groups/" + kSide[side] + "/name", pair.group_name[side]);
  }
}

// Their order in the snapshots is that of the attribute `number`.
void write_names(const h5::File& file, const std::string& group, const std::vector<std::string>& names) {
  if (names.empty()) return;
  h5::make_group(file, group);
  for (std::size_t i = 0; i < names.size(); ++i) {
    require_name(file, names[i]);
    h5::make_group(file, group + "/" + names[i]);
    h5::set_attribute(file, group + "/" + names[i], "number", static_cast<int>(i));
  }
}

bool finite(const model::Snapshot& snapshot) {
  bool good = std::isfinite(snapshot.time);
  for (const auto& body : snapshot.bodies)
    good = good && body.r_WB.allFinite() && body.R_WB.allFinite() && body.s.allFinite() &&
           body.s_dot.allFinite() && body.s_ddot.allFinite() && body.q.allFinite() &&
           body.q_dot.allFinite() && body.q_ddot.allFinite();
  for (const auto& pair : snapshot.pairs)
    good = good && pair.force.allFinite() && pair.torque.allFinite() && std::isfinite(pair.penetration);
  for (const auto& bushing : snapshot.bushings)
    good = good && bushing.force.allFinite() && bushing.torque.allFinite();
  for (const auto& sensor : snapshot.sensors) good = good && sensor.acceleration.allFinite();
  return good;
}

}  // namespace

struct ResultWriter::Data {
  PendingFile pending;
  model::ResultHeader header;
  h5::File file;
  std::map<std::string, h5::Series> series = {};
  double last_time = -std::numeric_limits<double>::infinity();
  std::vector<double> n_contacts = {};  // so far, by pair

  h5::Series& series_at(const std::string& name, const Item& item) {
    const auto found = series.find(name);
    if (found == series.end()) return series.try_emplace(name, file, name, item).first->second;
    require(found->second.item().shape == item.shape, file.path, ": ", name, " changed its size");
    return found->second;
  }
  void append(const std::string& name, double value, const std::string& unit, bool integer = false) {
    series_at(name, {{}, unit, integer}).append(&value);
  }
  void append(const std::string& name, const Eigen::VectorXd& value, const std::string& unit) {
    series_at(name, {{static_cast<hsize_t>(value.size())}, unit}).append(value.data());
  }
  void append_rotation(const std::string& name, const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>& R) {
    series_at(name, {{3, 3}, "1"}).append(R.data());
  }
  void append_body(const std::string& group, const model::BodyState& body);
  void append_pair(std::size_t index, const model::PairState& pair);
  void append_contacts(const std::string& group, const std::vector<model::ContactRecord>& contacts);
  void append_energy(const model::Energies& energy);
  void append_bushing(const std::string& group, const model::BushingState& bushing);
  void append_sensor(const std::string& group, const model::SensorState& sensor);
  void check(const model::Snapshot& snapshot) const;
};

// Joint coordinates are lengths or angles, q depends on the basis: their unit is told by the attributes joint
// and file of the body.
void ResultWriter::Data::append_body(const std::string& group, const model::BodyState& body) {
  append(group + "/rigid", body.s, "rad or m");
  append(group + "/rigid_velocity", body.s_dot, "rad/s or m/s");
  append(group + "/rigid_acceleration", body.s_ddot, "rad/s^2 or m/s^2");
  append(group + "/joint_force", body.joint_force, "N m or N");
  append(group + "/position", body.r_WB, "m");
  append_rotation(group + "/rotation", body.R_WB);
  append(group + "/q", body.q, "as in the body file");
  append(group + "/q_velocity", body.q_dot, "as q, per s");
  append(group + "/q_acceleration", body.q_ddot, "as q, per s^2");
}

void ResultWriter::Data::append_pair(std::size_t index, const model::PairState& pair) {
  const std::string group = "/contact/" + header.pairs[index].name;
  append(group + "/force", pair.force, "N");
  append(group + "/torque", pair.torque, "N m");
  append(group + "/count", pair.count, "1", true);
  append(group + "/penetration", pair.penetration, "m");
  for (int side : {0, 1}) {
    const std::size_t n = header.pairs[index].group_name[side].size();
    require(pair.group_force[side].size() == n, file.path, ": pair ", header.pairs[index].name, " has ",
            pair.group_force[side].size(), " group forces for ", n, " groups");
    series_at(group + "/groups/" + kSide[side] + "/force", {{n, 3}, "N"})
        .append(n == 0 ? nullptr : pair.group_force[side].front().data());
  }
  append_contacts(group + "/points", pair.contacts);
  const std::string offset = group + "/points/offset";
  if (!series.contains(offset)) append(offset, 0, "1", true);
  n_contacts[index] += static_cast<double>(pair.contacts.size());
  append(offset, n_contacts[index], "1", true);
}

void ResultWriter::Data::append_contacts(const std::string& group,
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
      {"force", {{3}, "N"}, [](const Record& c) {
         return Values{c.f[0], c.f[1], c.f[2]};
       }}};
  for (const Column& column : columns) {
    h5::Series& values = series_at(group + "/" + column.name, column.item);
    for (const Record& contact : contacts) values.append(column.value(contact).data());
  }
}

void ResultWriter::Data::append_energy(const model::Energies& energy) {
  append("/energy/kinetic", energy.kinetic, "J");
  append("/energy/elastic", energy.elastic, "J");
  append("/energy/contact", energy.contact, "J");
  append("/energy/dissipated", energy.dissipated, "J");
  append("/energy/work", energy.work, "J");
  append("/energy/balance", energy.balance, "J");
  if (!header.bushings.empty()) append("/energy/bushing", energy.bushing, "J");
}

void ResultWriter::Data::append_bushing(const std::string& group, const model::BushingState& bushing) {
  append(group + "/displacement", bushing.displacement, "m");
  append(group + "/angle", bushing.angle, "rad");
  append(group + "/force", bushing.force, "N");
  append(group + "/torque", bushing.torque, "N m");
}

void ResultWriter::Data::append_sensor(const std::string& group, const model::SensorState& sensor) {
  append(group + "/position", sensor.position, "m");
  append(group + "/velocity", sensor.velocity, "m/s");
  append(group + "/acceleration", sensor.acceleration, "m/s^2");
  append_rotation(group + "/rotation", sensor.rotation);
  append(group + "/angular_velocity", sensor.angular_velocity, "rad/s");
}

void ResultWriter::Data::check(const model::Snapshot& snapshot) const {
  require(snapshot.bodies.size() == header.bodies.size() && snapshot.pairs.size() == header.pairs.size(),
          file.path, ": a snapshot has ", snapshot.bodies.size(), " bodies and ", snapshot.pairs.size(),
          " pairs, the header ", header.bodies.size(), " and ", header.pairs.size());
  require(
      snapshot.bushings.size() == header.bushings.size() && snapshot.sensors.size() == header.sensors.size(),
      file.path, ": a snapshot has ", snapshot.bushings.size(), " bushings and ", snapshot.sensors.size(),
      " sensors, the header ", header.bushings.size(), " and ", header.sensors.size());
  require(finite(snapshot), file.path, ": the state at t = ", snapshot.time, " s is not finite");
  require(snapshot.time > last_time, file.path, ": time ", snapshot.time, " s does not come after ",
          last_time, " s");
}

ResultWriter::ResultWriter(const std::string& path, const model::ResultHeader& header) {
  data_.reset(new Data{PendingFile(path), header, {}});
  data_->file = h5::create(path, data_->pending.temporary());
  data_->n_contacts.assign(header.pairs.size(), 0);
  write_header(data_->file, header);
  write_names(data_->file, "/bushings", header.bushings);
  write_names(data_->file, "/sensors", header.sensors);
}

ResultWriter::~ResultWriter() = default;

void ResultWriter::append(const model::Snapshot& snapshot) {
  data_->check(snapshot);
  data_->last_time = snapshot.time;
  data_->append("/time", snapshot.time, "s");
  for (std::size_t i = 0; i < snapshot.bodies.size(); ++i)
    data_->append_body("/bodies/" + data_->header.bodies[i].name, snapshot.bodies[i]);
  for (std::size_t i = 0; i < snapshot.pairs.size(); ++i) data_->append_pair(i, snapshot.pairs[i]);
  data_->append_energy(snapshot.energy);
  for (std::size_t i = 0; i < snapshot.bushings.size(); ++i)
    data_->append_bushing("/bushings/" + data_->header.bushings[i], snapshot.bushings[i]);
  for (std::size_t i = 0; i < snapshot.sensors.size(); ++i)
    data_->append_sensor("/sensors/" + data_->header.sensors[i], snapshot.sensors[i]);
}

void ResultWriter::finish() {
  require(!data_->series.empty(), data_->file.path, ": there is no snapshot to write");
  for (auto& [name, series] : data_->series) series.flush();
  data_->series.clear();
  h5::close(data_->file);
  data_->pending.commit();
}

}  // namespace elastogear::io
