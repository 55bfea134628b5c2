#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "../mesh/box_mesh.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "sample_result.h"

namespace elastogear::result_file_test {
using namespace io;
using testing::HasSubstr;

namespace {

struct ResultFile : testing::Test {
  mesh::Folder folder{"result"};
  std::string path = folder / "impact.h5";

  template <class F>
  static std::string message(const F& f) {
    try {
      f();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
  void read_all() const {
    for (const auto& body : read_result_header(path).bodies) {
      read_body_history(path, body.name);
      read_contact_forces(path, body.name, sample_surface());
    }
    read_pair_history(path, "wheel:ground");
    read_contacts(path, "wheel:ground");
    read_energies(path);
  }
};

TEST_F(ResultFile, gives_the_header_back_in_order) {
  write_result(path, sample_snapshots(1));
  const model::ResultHeader a = sample_header(), b = read_result_header(path);
  ASSERT_EQ(b.bodies.size(), 2u);
  for (int i : {0, 1}) {
    EXPECT_EQ(a.bodies[i].name, b.bodies[i].name);
    EXPECT_EQ(a.bodies[i].file, b.bodies[i].file);
    EXPECT_EQ(a.bodies[i].joint, b.bodies[i].joint);
    EXPECT_EQ(a.pairs[0].body[i], b.pairs[0].body[i]);
    EXPECT_EQ(a.pairs[0].group_name[i], b.pairs[0].group_name[i]);
  }
  EXPECT_EQ(a.pairs[0].name, b.pairs[0].name);
  EXPECT_EQ(a.provenance, b.provenance);
}

TEST_F(ResultFile, says_what_the_run_was_asked_for) {
  write_result(path, sample_snapshots(1));
  const auto input = read_result_header(path).input;
  ASSERT_TRUE(input && input->drive);
  EXPECT_EQ(input->analysis, model::Analysis::motion);
  EXPECT_FALSE(input->creeps);
  EXPECT_EQ(input->drive->roll, 0.25);
  EXPECT_EQ(input->drive->torque, -300);
  EXPECT_EQ(input->drive->speed, 150);
  EXPECT_EQ(input->inexact, std::vector<std::string>{"wheel"});
}

TEST_F(ResultFile, may_lack_what_the_run_was_asked_for) {
  model::ResultHeader header = sample_header();
  header.input = {};
  ResultWriter writer(path, header);
  writer.append(sample_snapshot(1));
  writer.finish();
  EXPECT_FALSE(read_run_input(path));
}

TEST(TimeAxis, is_that_of_the_analysis) {
  const auto text = [](model::Analysis analysis, bool creeps) {
    return time_axis(model::RunInput{analysis, creeps}).at(2);
  };
  EXPECT_EQ(text(model::Analysis::sweep, false), "roll angle 2 pitches");
  EXPECT_EQ(text(model::Analysis::equilibrium, false), "load factor 2");
  EXPECT_EQ(text(model::Analysis::equilibrium, true), "t = 2 s");
  EXPECT_EQ(text(model::Analysis::relaxation, false), "t = 2 s");
  EXPECT_EQ(time_axis({}).at(2), "t = 2 s");
}

// More snapshots than are buffered, and not a multiple of them.
constexpr int kSteps = 150;

TEST_F(ResultFile, gives_bushings_and_sensors_back_to_the_bit) {
  const auto snapshots = sample_snapshots(kSteps);
  write_result(path, snapshots);
  EXPECT_EQ(read_result_header(path).bushings, sample_header().bushings);
  EXPECT_EQ(read_result_header(path).sensors, sample_header().sensors);
  const BushingHistory left = read_bushing_history(path, "left");
  const SensorHistory tip = read_sensor_history(path, "tip");
  for (int i = 0; i < kSteps; ++i) {
    const model::BushingState& bushing = snapshots[i].bushings[1];
    const model::SensorState& sensor = snapshots[i].sensors[0];
    EXPECT_EQ(left.force.col(i), bushing.force);
    EXPECT_EQ(left.torque.col(i), bushing.torque);
    EXPECT_EQ(left.displacement.col(i), bushing.displacement);
    EXPECT_EQ(left.angle.col(i), bushing.angle);
    EXPECT_EQ(tip.position.col(i), sensor.position);
    EXPECT_EQ(tip.velocity.col(i), sensor.velocity);
    EXPECT_EQ(tip.acceleration.col(i), sensor.acceleration);
    EXPECT_EQ(tip.rotation.col(i), sensor.rotation.reshaped<Eigen::RowMajor>());
    EXPECT_EQ(tip.angular_velocity.col(i), sensor.angular_velocity);
  }
  EXPECT_EQ(read_energies(path).bushing, Eigen::VectorXd::Constant(kSteps, 7));
  EXPECT_THAT(message([&] { read_sensor_history(path, "tap"); }), HasSubstr("it has: tip"));
}

TEST_F(ResultFile, gives_body_histories_back_to_the_bit) {
  const auto snapshots = sample_snapshots(kSteps);
  write_result(path, snapshots);
  const Eigen::VectorXd time = read_times(path);
  const BodyHistory wheel = read_body_history(path, "wheel"), ground = read_body_history(path, "ground");
  ASSERT_EQ(time.size(), kSteps);
  for (int i = 0; i < kSteps; ++i) {
    const model::BodyState& body = snapshots[i].bodies[0];
    EXPECT_EQ(time[i], snapshots[i].time);
    EXPECT_TRUE(wheel.q.col(i) == body.q && wheel.q_dot.col(i) == body.q_dot &&
                wheel.q_ddot.col(i) == body.q_ddot && wheel.q_error.col(i) == body.q_error);
    EXPECT_TRUE(wheel.s.col(i) == body.s && wheel.s_dot.col(i) == body.s_dot &&
                wheel.s_ddot.col(i) == body.s_ddot);
    EXPECT_EQ(wheel.r_WB.col(i), body.r_WB);
    EXPECT_EQ(wheel.R_WB.col(i), body.R_WB.transpose().reshaped());
    EXPECT_EQ(ground.r_WB.col(i), snapshots[i].bodies[1].r_WB);
  }
  EXPECT_EQ(ground.q.rows(), 0);
  EXPECT_EQ(ground.q.cols(), kSteps);
}

TEST_F(ResultFile, gives_pair_histories_back_to_the_bit) {
  const auto snapshots = sample_snapshots(kSteps);
  write_result(path, snapshots);
  const PairHistory history = read_pair_history(path, "wheel:ground");
  EXPECT_EQ(history.group_name[0], sample_header().pairs[0].group_name[0]);
  EXPECT_EQ(history.group_force[1].rows(), 0);
  for (int i = 0; i < kSteps; ++i) {
    const model::PairState& pair = snapshots[i].pairs[0];
    EXPECT_TRUE(history.force.col(i) == pair.force && history.torque.col(i) == pair.torque);
    EXPECT_TRUE(history.count[i] == pair.count && history.penetration[i] == pair.penetration);
    EXPECT_EQ(history.group_force[0].col(i).tail(3), pair.group_force[0][1]);
    EXPECT_TRUE(history.area[i] == pair.total.area && history.pressure[i] == pair.total.pressure);
    EXPECT_TRUE(history.sliding_speed[i] == pair.total.sliding_speed &&
                history.friction_power[i] == pair.total.friction_power &&
                history.damping_power[i] == pair.total.damping_power);
  }
}

TEST_F(ResultFile, gives_contacts_back_to_the_bit) {
  const auto snapshots = sample_snapshots(kSteps);
  write_result(path, snapshots);
  const auto contacts = read_contacts(path, "wheel:ground");
  ASSERT_EQ(contacts.size(), snapshots.size());
  for (int i = 0; i < kSteps; ++i) {
    const auto& expected = snapshots[i].pairs[0].contacts;
    ASSERT_EQ(contacts[i].size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const model::ContactRecord &a = contacts[i][k], &b = expected[k];
      EXPECT_TRUE(a.slave_side == b.slave_side && a.slave_node == b.slave_node && a.face == b.face);
      EXPECT_TRUE(a.xi == b.xi && a.eta == b.eta && a.g_n == b.g_n && a.f == b.f);
      EXPECT_TRUE(a.pressure == b.pressure && a.slip == b.slip);
    }
  }
}

TEST_F(ResultFile, gives_contact_forces_at_nodes_back_to_the_bit) {
  const auto snapshots = sample_snapshots(kSteps);
  write_result(path, snapshots);
  const model::ForceHistory history = read_contact_forces(path, "wheel", sample_surface());
  ASSERT_EQ(history.node, (std::vector<int>{5, 6, 7, 8, 9, 10, 11}));
  ASSERT_EQ(history.force.cols(), kSteps);
  for (int i = 0; i < kSteps; ++i) {
    const model::ContactForces& forces = snapshots[i].bodies[0].contact;
    Eigen::Matrix3Xd expected = Eigen::Matrix3Xd::Zero(3, 7);
    for (std::size_t k = 0; k < forces.node.size(); ++k)
      expected.col(forces.node[k] - 5) = forces.f_B.col(static_cast<Eigen::Index>(k));
    EXPECT_EQ(history.force.col(i), expected.reshaped());
  }
  EXPECT_TRUE(read_contact_forces(path, "ground", sample_surface(0)).node.empty());
  EXPECT_THAT(message([&] { read_contact_forces(path, "wheel", sample_surface(11)); }),
              HasSubstr("acts on node 11 of 'wheel', whose surface has 0..10"));
}

TEST_F(ResultFile, gives_energies_back_to_the_bit) {
  write_result(path, sample_snapshots(3));
  const EnergyHistory energy = read_energies(path);
  EXPECT_EQ(energy.kinetic, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(energy.elastic, Eigen::Vector3d::Constant(2));
  EXPECT_EQ(energy.contact, Eigen::Vector3d::Constant(3));
  EXPECT_EQ(energy.dissipated, Eigen::Vector3d::Constant(4));
  EXPECT_EQ(energy.work, Eigen::Vector3d::Constant(5));
  EXPECT_EQ(energy.balance, Eigen::Vector3d::Constant(6e-3));
}

TEST_F(ResultFile, without_any_contact_has_empty_lists) {
  write_result(path, {sample_snapshot(0), sample_snapshot(4)});
  const auto contacts = read_contacts(path, "wheel:ground");
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_TRUE(contacts[0].empty() && contacts[1].empty());
}

TEST_F(ResultFile, appears_only_when_finished) {
  write_file(path, "old");
  {
    ResultWriter writer(path, sample_header());
    writer.append(sample_snapshot(0));
  }
  EXPECT_EQ(read_file(path), "old");
  EXPECT_THROW(ResultWriter(path, sample_header()).finish(), Error);
  EXPECT_EQ(folder.files(), 1);
}

// What a file holds, byte for byte, but for its attributes.
void expect_equal_histories(const std::string& a, const std::string& b) {
  EXPECT_EQ(read_times(a), read_times(b));
  EXPECT_EQ(read_body_history(a, "wheel").q, read_body_history(b, "wheel").q);
  EXPECT_EQ(read_body_history(a, "ground").q.cols(), read_body_history(b, "ground").q.cols());
  EXPECT_EQ(read_pair_history(a, "wheel:ground").group_force[0],
            read_pair_history(b, "wheel:ground").group_force[0]);
  const model::ForceHistory f_a = read_contact_forces(a, "wheel", sample_surface()),
                            f_b = read_contact_forces(b, "wheel", sample_surface());
  EXPECT_EQ(f_a.node, f_b.node);
  EXPECT_EQ(f_a.force, f_b.force);
  const auto of_a = read_contacts(a, "wheel:ground"), of_b = read_contacts(b, "wheel:ground");
  ASSERT_EQ(of_a.size(), of_b.size());
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    ASSERT_EQ(of_a[i].size(), of_b[i].size());
    for (std::size_t k = 0; k < of_a[i].size(); ++k) EXPECT_EQ(of_a[i][k].f, of_b[i][k].f);
  }
}

TEST_F(ResultFile, goes_on_after_the_last_checkpoint_of_a_writer_that_vanished) {
  const auto snapshots = sample_snapshots(kSteps);
  {
    ResultWriter writer(path, sample_header());
    for (int i = 0; i < 90; ++i) {
      if (i == 40 || i == 70) writer.checkpoint({1.0 * i, 0.5});
      writer.append(snapshots[i]);
    }
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  const auto unfinished = read_unfinished_run(path);
  ASSERT_TRUE(unfinished);
  EXPECT_EQ(unfinished->state, (std::vector<double>{70, 0.5}));
  EXPECT_EQ(unfinished->time, snapshots[69].time);
  EXPECT_EQ(unfinished->provenance, sample_header().provenance);
  ResultWriter writer(path, sample_header(), true);
  EXPECT_EQ(writer.n_times(), 70);
  writer.checkpoint({7});  // without anything new
  for (int i = 70; i < kSteps; ++i) writer.append(snapshots[i]);
  writer.finish();
  EXPECT_TRUE(is_complete(path));
  write_result(folder / "whole.h5", snapshots);
  expect_equal_histories(path, folder / "whole.h5");
  EXPECT_FALSE(read_unfinished_run(path));
}

TEST_F(ResultFile, unfinished_is_marked_and_can_still_go_on) {
  const auto snapshots = sample_snapshots(20);
  {
    ResultWriter writer(path, sample_header());
    for (int i = 0; i < 10; ++i) writer.append(snapshots[i]);
    writer.checkpoint({1});
    writer.finish(false);
  }
  EXPECT_FALSE(is_complete(path));
  EXPECT_EQ(read_times(path).size(), 10);
  ResultWriter writer(path, sample_header(), true);
  for (int i = 10; i < 20; ++i) writer.append(snapshots[i]);
  writer.finish();
  EXPECT_TRUE(is_complete(path));
  EXPECT_EQ(read_times(path).size(), 20);
}

TEST_F(ResultFile, begun_anew_forgets_what_was_unfinished) {
  {
    ResultWriter writer(path, sample_header());
    writer.append(sample_snapshot(1));
    writer.checkpoint({1});
  }
  write_result(path, sample_snapshots(3));
  EXPECT_EQ(read_times(path).size(), 3);
  EXPECT_FALSE(read_unfinished_run(path));
}

TEST_F(ResultFile, parts_that_do_not_follow_each_other_are_an_error) {
  ResultWriter writer(path, sample_header());
  for (int i = 0; i < 3; ++i) {
    writer.append(sample_snapshot(i));
    writer.checkpoint({1});
  }
  std::filesystem::copy_file(path + ".partial/part_000001.h5", path + ".partial/part_000002.h5",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(message([&] { writer.finish(); }), HasSubstr("does not follow the part before"));
}

TEST_F(ResultFile, refuses_snapshots_that_do_not_fit) {
  ResultWriter writer(path, sample_header());
  writer.append(sample_snapshot(1));
  model::Snapshot snapshot = sample_snapshot(1);
  EXPECT_THAT(message([&] { writer.append(snapshot); }), HasSubstr("does not come after"));
  snapshot = sample_snapshot(2);
  snapshot.bodies[0].q[1] = NAN;
  EXPECT_THAT(message([&] { writer.append(snapshot); }), HasSubstr("not finite"));
  snapshot = sample_snapshot(2);
  snapshot.bodies[0].contact.f_B(2, 1) = NAN;
  EXPECT_THAT(message([&] { writer.append(snapshot); }), HasSubstr("not finite"));
  snapshot = sample_snapshot(2);
  snapshot.bodies[0].contact.node.pop_back();
  EXPECT_THAT(message([&] { writer.append(snapshot); }), HasSubstr("wheel has 2 contact forces at 1 nodes"));
  snapshot = sample_snapshot(2);
  snapshot.bodies.pop_back();
  EXPECT_THAT(message([&] { writer.append(snapshot); }), HasSubstr("1 bodies"));
  snapshot = sample_snapshot(2);
  snapshot.bodies[0].q.setZero(6);
  EXPECT_THAT(message([&] { writer.append(snapshot); }), HasSubstr("/bodies/wheel/q changed its size"));
}

TEST_F(ResultFile, names_the_bodies_and_pairs_it_has) {
  write_result(path, sample_snapshots(1));
  EXPECT_THAT(message([&] { read_body_history(path, "worm"); }), HasSubstr("it has: ground, wheel"));
  EXPECT_THAT(message([&] { read_pair_history(path, "a:b"); }), HasSubstr("it has: wheel:ground"));
}

TEST_F(ResultFile, is_an_error_when_truncated_anywhere) {
  write_result(path, sample_snapshots(3));
  const std::string content = read_file(path);
  for (std::size_t n = 0; n < content.size(); n += 61) {
    write_file(path, content.substr(0, n));
    EXPECT_THROW(read_all(), Error) << "cut at byte " << n;
  }
}

}  // namespace
}  // namespace elastogear::result_file_test
