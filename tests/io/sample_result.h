#pragma once
// A result with arbitrary but valid numbers, for the tests of files.

#include "elastogear/io/result_file.h"

namespace elastogear::io {

inline model::ResultHeader sample_header() {
  model::ResultHeader header;
  header.bodies = {{"wheel", "wheel.h5", "revolute"}, {"ground", "rigid.h5", "fixed"}};
  header.pairs = {{"wheel:ground", {0, 1}, {{"tooth_1", "tooth_2"}, {}}}};
  header.provenance = {{"options", "-ts_dt 1e-6"}};
  header.bushings = {"right", "left"};
  header.sensors = {"tip"};
  header.input = {model::Analysis::motion, false, model::DriveInput{0.25, -300, 150}, {"wheel"}};
  return header;
}

inline model::BodyState sample_state(int n_q, int n_s) {
  model::BodyState body;
  body.r_WB.setRandom();
  body.R_WB.setRandom();
  for (auto* v : {&body.q, &body.q_dot, &body.q_ddot, &body.q_error}) v->setRandom(n_q);
  for (auto* v : {&body.s, &body.s_dot, &body.s_ddot}) v->setRandom(n_s);
  return body;
}

/// A surface of n nodes that the contact forces of sample_snapshot() act on.
inline model::Surface sample_surface(int n = 20) {
  model::Surface surface;
  surface.X.setZero(3, n);
  return surface;
}

/// n contacts at step n % 4, and as many nodes of the wheel that are touched.
inline model::Snapshot sample_snapshot(int step) {
  model::Snapshot snapshot;
  snapshot.time = 1e-6 * step;
  snapshot.bodies = {sample_state(5, 1), sample_state(0, 0)};
  for (int i = 0; i < step % 4; ++i) snapshot.bodies[0].contact.node.push_back(5 + 2 * i + step % 3);
  snapshot.bodies[0].contact.f_B.setRandom(3, step % 4);
  model::PairState pair;
  pair.force.setRandom();
  pair.torque.setRandom();
  pair.count = step % 4;
  pair.penetration = 1e-6 * (step % 4);
  pair.group_force[0] = {Eigen::Vector3d::Random(), Eigen::Vector3d::Random()};
  for (int i = 0; i < pair.count; ++i)
    pair.contacts.push_back({i % 2, 10 + i, 20 + i, 0.1 * i, -0.1 * i, -1e-6 * i, Eigen::Vector3d::Random(),
                             1e6 * i, Eigen::Vector3d::Random()});
  pair.total = {Eigen::Vector3d::Random(), pair.count, 1e-6, 2e6, 0.3, 4, 5};
  pair.area[0] = {pair.total, {Eigen::Vector3d::Random(), 1, 6, 7, 8, 9, 10}};
  snapshot.pairs = {pair};
  snapshot.energy = {1.0 + step, 2, 3, 4, 5, 6e-3, 7};
  const auto random = [] { return Eigen::Vector3d(Eigen::Vector3d::Random()); };
  for (int i : {0, 1}) {
    snapshot.bushings.push_back({random(), random(), random(), random(), random(), random()});
    snapshot.bushings[i].force[0] = 100 + i;
  }
  snapshot.sensors = {{random(), random(), random(), Eigen::Matrix3d::Random(), random()}};
  return snapshot;
}

inline std::vector<model::Snapshot> sample_snapshots(int n) {
  std::vector<model::Snapshot> snapshots;
  for (int i = 0; i < n; ++i) snapshots.push_back(sample_snapshot(i));
  return snapshots;
}

inline void write_result(const std::string& path, const std::vector<model::Snapshot>& snapshots) {
  ResultWriter writer(path, sample_header());
  for (const auto& snapshot : snapshots) writer.append(snapshot);
  writer.finish();
}

}  // namespace elastogear::io
