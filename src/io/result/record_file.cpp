#include "elastogear/io/record_file.h"

#include "elastogear/base/file.h"
#include "io/hdf5/schema.h"

namespace elastogear::io {
namespace {

constexpr Format kRecordFormat{"elastogear record", 2, 2};

void visit(model::BodyState& body, Archive& archive) {
  archive(body.r_WB);
  archive(body.R_WB);
  for (Eigen::VectorXd* x :
       {&body.s, &body.s_dot, &body.s_ddot, &body.q, &body.q_dot, &body.q_ddot, &body.joint_force})
    archive(*x);
  archive(body.contact.node);
  archive(body.contact.f_B);
  archive(body.z);
  archive(body.w);
}

void visit(model::ContactFigures& figures, Archive& archive) {
  archive(figures.torque);
  archive(figures.count);
  for (double* x : {&figures.area, &figures.pressure, &figures.sliding_speed, &figures.friction_power,
                    &figures.damping_power})
    archive(*x);
}

void visit(model::ContactRecord& contact, Archive& archive) {
  for (int* i : {&contact.slave_side, &contact.slave_node, &contact.face}) archive(*i);
  for (double* x : {&contact.xi, &contact.eta, &contact.g_n, &contact.pressure}) archive(*x);
  archive(contact.f);
  archive(contact.slip);
}

void visit(model::PairState& pair, Archive& archive) {
  archive(pair.force);
  archive(pair.torque);
  archive(pair.count);
  archive(pair.penetration);
  visit(pair.total, archive);
  for (int side : {0, 1}) {
    archive(pair.group_force[side]);
    archive.each(pair.area[side], [&](model::ContactFigures& figures) { visit(figures, archive); });
  }
  archive.each(pair.contacts, [&](model::ContactRecord& contact) { visit(contact, archive); });
}

void visit(model::Energies& energy, Archive& archive) {
  for (double* x : {&energy.kinetic, &energy.elastic, &energy.contact, &energy.dissipated, &energy.work,
                    &energy.balance, &energy.bushing, &energy.relaxation})
    archive(*x);
}

void visit_markers(model::Snapshot& snapshot, Archive& archive) {
  archive.each(snapshot.bushings, [&](model::BushingState& b) {
    for (Eigen::Vector3d* x : {&b.displacement, &b.velocity, &b.angle, &b.rate, &b.force, &b.torque})
      archive(*x);
  });
  archive.each(snapshot.loads, [&](model::LoadState& load) {
    for (Eigen::Vector3d* x : {&load.force, &load.torque, &load.x}) archive(*x);
    archive(load.R);
  });
  archive.each(snapshot.sensors, [&](model::SensorState& sensor) {
    for (Eigen::Vector3d* x :
         {&sensor.position, &sensor.velocity, &sensor.acceleration, &sensor.angular_velocity})
      archive(*x);
    archive(sensor.rotation);
  });
}

}  // namespace

void write_record(const std::string& path, const StoredRecord& record) {
  PendingFile pending(path);
  h5::File file = h5::create(path, pending.temporary());
  write_format(file, kRecordFormat);
  h5::write_map(file, "/text", record.text);
  h5::write<double>(file, "/numbers", {{record.numbers.size()}, record.numbers.data()}, "1");
  h5::close(file);
  pending.commit();
}

StoredRecord read_record(const std::string& path) {
  const h5::File file = open_format(path, kRecordFormat);
  return {h5::read_map(file, "/text"), h5::read<double>(file, "/numbers", {h5::kAny}, h5::Finite::any)};
}

void serialize(model::Snapshot& snapshot, Archive& archive) {
  archive(snapshot.time);
  archive.each(snapshot.bodies, [&](model::BodyState& body) { visit(body, archive); });
  archive.each(snapshot.pairs, [&](model::PairState& pair) { visit(pair, archive); });
  visit(snapshot.energy, archive);
  visit_markers(snapshot, archive);
}

}  // namespace elastogear::io
