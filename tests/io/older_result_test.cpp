// Contact forces at nodes from results of versions 1 and 2, which hold contact points only. The files were
// written by elastogear 17c2e82 and c987262.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../mesh/box_mesh.h"
#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/io/body_file.h"
#include "elastogear/io/describe.h"
#include "io/hdf5/hdf5_api.h"
#include "sample_result.h"

namespace elastogear::older_result_test {
using namespace io;
using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;

namespace {

constexpr double kRoundoff = 1e-14;

// A quadrilateral 0 1 2 3 and a triangle 1 4 2.
model::Surface two_faces() {
  model::Surface s;
  s.X.resize(3, 5);
  s.X << 0, 1, 1, 0, 2,  //
      0, 0, 1, 1, 0.5,   //
      0, 0, 0, 0, 0;
  s.face.resize(4, 2);
  s.face << 0, 1,  //
      1, 4,        //
      2, 2,        //
      3, 2;
  return s;
}

void make_version_2(const std::string& path) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT),
              version = H5Aopen(file, "version", H5P_DEFAULT);
  const int two = 2;
  ASSERT_GE(H5Awrite(version, H5T_NATIVE_INT, &two), 0);
  H5Aclose(version);
  H5Fclose(file);
}

struct OlderResult : testing::Test {
  mesh::Folder folder{"older_result"};
  std::string path = folder / "result.h5";

  // A result of version 2 with these contacts and this rotation of the wheel at its second time.
  void write(const std::vector<model::ContactRecord>& contacts,
             const Vector3d& psi = Vector3d::Zero()) const {
    std::vector<model::Snapshot> snapshots = sample_snapshots(2);
    snapshots[0].pairs[0].contacts.clear();
    snapshots[1].pairs[0].contacts = contacts;
    snapshots[1].bodies[0].R_WB = rotation_matrix(psi);
    write_result(path, snapshots);
    make_version_2(path);
  }
  template <class F>
  static std::string message(const F& f) {
    try {
      f();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
};

TEST_F(OlderResult, has_forces_on_slave_nodes_in_the_body_frame) {
  const Vector3d psi(0.3, -0.8, 0.5), f(1, 2, 3), g(-2, 0.5, 4);
  write({{0, 3, 0, 0, 0, -1e-6, f}, {0, 3, 0, 0, 0, -1e-6, g}}, psi);
  const model::ForceHistory h = read_contact_forces(path, "wheel", two_faces());
  ASSERT_EQ(h.node, std::vector<int>{3});
  EXPECT_EQ(h.force.col(0).norm(), 0);
  EXPECT_NEAR((h.force.col(1) - rotation_matrix(psi).transpose() * (f + g)).norm(), 0, 10 * kRoundoff);
}

TEST_F(OlderResult, has_forces_on_a_master_face_with_the_opposite_sum_and_moment) {
  const model::Surface s = two_faces();
  const Vector3d f(1, 2, 3);
  for (int face : {0, 1}) {
    write({{1, 0, face, 0.25, -0.5, -1e-6, f}});
    const model::ForceHistory h = read_contact_forces(path, "wheel", s);
    Vector3d sum = f, at = Vector3d::Zero();
    for (std::size_t i = 0; i < h.node.size(); ++i) {
      sum += h.force.col(1).segment<3>(3 * i);
      at -= h.force(3 * i, 1) / f[0] * s.X.col(h.node[i]);
    }
    EXPECT_NEAR(sum.norm(), 0, 10 * kRoundoff);
    const Vector3d quadrilateral(0.625, 0.25, 0), triangle(1 + 0.75 * 0.625, 0.25 + 0.75 * 0.625 * 0.5, 0);
    EXPECT_NEAR((at - (face == 0 ? quadrilateral : triangle)).norm(), 0, 10 * kRoundoff);
  }
}

TEST_F(OlderResult, of_each_version_has_forces_that_sum_to_those_of_the_pair) {
  const model::Surface surface = read_body(IO_TESTS "/version_1/body.h5").surface;
  for (const char* version : {"1", "2"}) {
    const std::string file = std::string(IO_TESTS "/version_") + version + "/result.h5";
    EXPECT_THAT(describe(file), HasSubstr(std::string("elastogear result, version ") + version));
    const Eigen::Vector3d on_low = read_pair_history(file, "high:low").force.rightCols(1);  // on body b
    for (const char* name : {"low", "high"}) {
      const model::ForceHistory forces = read_contact_forces(file, name, surface);
      const Eigen::MatrixXd R = read_joint_history(file, name).R_WB.rightCols(1);
      const Vector3d sum = R.reshaped(3, 3).transpose() *
                           forces.force.rightCols(1).reshaped(3, forces.node.size()).rowwise().sum();
      ASSERT_GT(sum.norm(), 30);
      EXPECT_LT((sum - (name == std::string("low") ? 1 : -1) * on_low).norm(), 100 * kRoundoff * sum.norm());
    }
  }
}

TEST_F(OlderResult, of_another_surface_is_refused) {
  const auto read = [&] { read_contact_forces(path, "wheel", two_faces()); };
  write({{1, 0, 2, 0, 0, -1e-6, Vector3d::Ones()}});
  EXPECT_THAT(message(read), AllOf(HasSubstr(path), HasSubstr("face 2 of 'wheel', whose surface has 0..1")));
  write({{0, 5, 0, 0, 0, -1e-6, Vector3d::Ones()}});
  EXPECT_THAT(message(read), AllOf(HasSubstr(path), HasSubstr("node 5 of 'wheel', whose surface has 0..4")));
}

TEST_F(OlderResult, that_was_left_unfinished_cannot_go_on) {
  {
    ResultWriter writer(path, sample_header());
    writer.append(sample_snapshot(0));
    writer.checkpoint({1});
  }
  ASSERT_TRUE(read_unfinished_run(path));
  make_version_2(path + ".partial/state.h5");
  EXPECT_THAT(message([&] { read_unfinished_run(path); }), HasSubstr("state.h5: has version 2"));
}

}  // namespace
}  // namespace elastogear::older_result_test
