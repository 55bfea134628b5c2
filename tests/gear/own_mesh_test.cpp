// Meshes of gears that come from elsewhere, in the place of meshes of the data that were turned and moved.

#include "elastogear/gear/own_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <set>

#include "../message_of.h"
#include "elastogear/base/error.h"
#include "elastogear/gear/cylindrical.h"
#include "elastogear/gear/flank.h"
#include "mesh_checks.h"

namespace elastogear::gear::own_mesh_test {
namespace {

using std::numbers::pi;

CylindricalDrive drive(double beta, bool internal) {
  CylindricalDrive d;
  d.m_n = 3e-3;
  d.beta = beta;
  d.gears.resize(2);
  for (CylindricalGear& gear : d.gears) gear.blank.face_width = 12e-3;
  d.gears[0].name = "pinion", d.gears[0].z = 17, d.gears[0].x = 0.3;
  d.gears[1].name = "wheel", d.gears[1].z = internal ? 52 : 23, d.gears[1].internal = internal;
  d.pairs = {GearPair{}};
  return d;
}

struct Case {
  CylindricalDrive d;
  CylindricalGeometry g;
  int gear;

  Case(double beta, bool internal, int of) : d(drive(beta, internal)), g(derive(d)), gear(of) {}
  mesh::Mesh mesh(int order) const {
    return cylindrical_mesh(d, g, gear, cylindrical_counts(d, g, gear, Size::tiny, order));
  }
  OwnGear data() const {
    const auto i = static_cast<std::size_t>(gear);
    return {d.gears[i].name, g.gear[i], g.blank[i].face_width, g.gear[i].internal ? "outer" : "bore",
            g.blank[i].end_diameter() / 2};
  }
};

// Without its sets.
mesh::Mesh moved(mesh::Mesh mesh, double turn, double shift) {
  mesh.X = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix() * mesh.X;
  mesh.X.row(2).array() += shift;
  mesh.node_sets.clear();
  mesh.face_sets.clear();
  return mesh;
}

std::set<mesh::Face> faces(const mesh::Mesh& mesh, const std::string& set) {
  std::set<mesh::Face> all;
  for (const mesh::Face& face : mesh::face_set(mesh, set)) all.insert(mesh::face_key(face));
  return all;
}

TEST(OwnMesh, is_put_into_place_with_all_its_sets) {
  for (int order : {1, 2})
    for (const Case& c : {Case(0, false, 0), Case(0.3, false, 1), Case(-0.2, true, 1)}) {
      const mesh::Mesh original = c.mesh(order);
      const double part = 0.3, pitch = 2 * pi / c.data().toothing.z;
      mesh::Mesh mesh = moved(original, (5 + part) * pitch, 4e-3);
      const MeshFit fit = fit_own_mesh(mesh, c.data());
      EXPECT_NEAR(fit.turn, -part * pitch, 1e-10);
      EXPECT_NEAR(fit.shift, -4e-3, 1e-12);
      EXPECT_LT(fit.farthest, 1e-9);
      const Eigen::Matrix3Xd expected =
          Eigen::AngleAxisd(5 * pitch, Eigen::Vector3d::UnitZ()).toRotationMatrix() * original.X;
      EXPECT_LT((mesh.X - expected).cwiseAbs().maxCoeff(), 1e-9);
      EXPECT_EQ(faces(mesh, "flanks"), faces(original, "flanks"));
      EXPECT_EQ(faces(mesh, "tooth_06_left"), faces(original, "tooth_01_left"));
      EXPECT_EQ(faces(mesh, "tooth_05_right"),
                faces(original, "tooth_" + std::to_string(c.data().toothing.z) + "_right"));
      EXPECT_EQ(mesh.node_sets.at(c.data().held), original.node_sets.at(c.data().held));
      const auto &root = mesh.node_sets.at("root_06"), &of_data = original.node_sets.at("root_01");
      EXPECT_TRUE(std::includes(root.begin(), root.end(), of_data.begin(), of_data.end()));
      EXPECT_LT(root.size(), 2 * of_data.size());
    }
}

TEST(OwnMesh, may_stand_off_its_flanks_by_a_little_and_is_put_onto_them) {
  const Case c(0.3, false, 0);
  mesh::Mesh mesh = c.mesh(1);
  const mesh::Mesh original = mesh;
  const int node = mesh::face_set(mesh, "tooth_03_left")[0][0];
  const Eigen::Vector3d n = flank_normal(c.data().toothing, {2, 1}, mesh.X.col(node));
  mesh.X.col(node) += 5e-6 * n;
  const MeshFit fit = fit_own_mesh(mesh, c.data());
  EXPECT_NEAR(fit.farthest, 5e-6, 1e-7);
  EXPECT_LT((mesh.X - original.X).cwiseAbs().maxCoeff(), 1e-6);  // all turn by the mean
  mesh.X.col(node) += 7e-6 * n;
  const std::string message = test::message_of([&] { fit_own_mesh(mesh, c.data()); });
  EXPECT_NE(message.find("node " + std::to_string(node) + " "), message.npos) << message;
  EXPECT_NE(message.find("outside the left flank of tooth 3"), message.npos) << message;
}

TEST(OwnMesh, of_another_gear_is_refused) {
  const Case c(0, false, 0), longer(0, false, 1);
  const auto said = [&](const mesh::Mesh& mesh, OwnGear data) {
    mesh::Mesh copy = moved(mesh, 0.1, 0);
    return test::message_of([&] { fit_own_mesh(copy, data); });
  };
  OwnGear data = c.data();
  data.width = 13e-3;
  EXPECT_NE(said(c.mesh(1), data).find("12 mm wide"), std::string::npos);
  data = c.data();
  data.toothing.psi_b += 1e-3;  // thicker teeth
  EXPECT_NE(said(c.mesh(1), data).find("inside the"), std::string::npos);
  data = c.data();
  data.held_radius = 5e-3;
  EXPECT_NE(said(c.mesh(1), data).find("cylinder of 10 mm"), std::string::npos);
  EXPECT_NE(said(longer.mesh(1), c.data()), "no error");
  mesh::Mesh in_mm = c.mesh(1);
  in_mm.X *= 1000;
  EXPECT_NE(said(in_mm, c.data()).find("unit: mm"), std::string::npos);
}

}  // namespace
}  // namespace elastogear::gear::own_mesh_test
