// Charts of exact flanks of worm drives: on the flanks, with their derivatives, normals and distances.

#include "elastogear/drive/exact_flanks.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "../gear/worm_designs.h"
#include "elastogear/gear/flank.h"

namespace elastogear::drive::exact_flanks_test {
namespace {

using contact::FlankName;
using contact::FlankPoint;
using Eigen::Vector3d;

struct Case {
  const char* name;
  gear::FlankForm form;
  int starts;
  gear::WheelForm wheel;
  gear::Hand hand;
  double oversize;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

class ExactFlanks : public testing::TestWithParam<Case> {
 protected:
  ExactFlanks() {
    gear::Design d = gear::worm_design(GetParam().form, GetParam().starts, GetParam().wheel);
    d.hand = GetParam().hand;
    d.hob_oversize = GetParam().oversize;
    geometry = gear::derive(d);
    half_face = d.face_width / 2;
  }
  gear::Geometry geometry;
  double half_face;
};

void expect_chart(const gear::Toothing& t, Layers layers, double half_face) {
  const auto flanks = exact_flanks(t, {}, layers);
  const auto [lower, upper, tip_at_upper, edge] = flanks->extent();
  const double h = 1e-5 * (upper - lower);
  for (const FlankName flank : {FlankName{0, 1}, FlankName{0, -1}, FlankName{t.z - 1, 1}})
    for (double part : {0.02, 0.4, 0.97})
      for (double side : {-0.95, -0.3, 0.2, 0.9}) {
        const double v = std::lerp(lower, upper, part), z = side * half_face;
        const FlankPoint at = flanks->point(flank, v, z);
        EXPECT_LT(std::abs(gear::flank_distance(t, flank.tooth, flank.side, at.x)), 1e-9);
        const Vector3d n = gear::flank_normal(t, {flank.tooth, flank.side}, at.x);
        EXPECT_LT((at.n - n).norm(), 1e-6) << at.n.transpose() << ", " << n.transpose();
        const Vector3d x_v = (flanks->point(flank, v + h, z).x - flanks->point(flank, v - h, z).x) / (2 * h);
        const Vector3d x_z = (flanks->point(flank, v, z + h).x - flanks->point(flank, v, z - h).x) / (2 * h);
        EXPECT_LT((at.x_v - x_v).norm(), 1e-6 * x_v.norm());
        EXPECT_LT((at.x_z - x_z).norm(), 1e-6 * x_z.norm());
        EXPECT_LT(std::abs(at.n.dot(at.x_v)) + std::abs(at.n.dot(at.x_z)), 1e-9 * at.x_z.norm());
        EXPECT_LT((flanks->chart(flank, at.x) - Eigen::Vector2d(v, z)).norm(), 1e-9);
        for (double off : {1e-5, -1e-4}) {
          const contact::FlankDistance d = flanks->distance(flank, at.x + off * at.n);
          EXPECT_NEAR(d.distance, off, 1e-9 * std::abs(off) + 1e-13);
          EXPECT_LT((d.gradient - at.n).norm(), 1e-7);
          EXPECT_NEAR(d.v, v, 1e-7 * (upper - lower));
        }
      }
}

TEST_P(ExactFlanks, of_worms_are_on_their_flanks) { expect_chart(geometry.worm, Layers::axial, 3e-3); }

TEST_P(ExactFlanks, of_wheels_are_on_their_flanks) {
  expect_chart(geometry.wheel, Layers::transverse, half_face);
}

using gear::FlankForm, gear::Hand, gear::WheelForm;
INSTANTIATE_TEST_SUITE_P(
    Forms, ExactFlanks,
    testing::Values(Case{"ZA", FlankForm::ZA, 2, WheelForm::throated, Hand::right, 0},
                    Case{"ZI_left", FlankForm::ZI, 1, WheelForm::throated, Hand::left, 0},
                    Case{"ZN_cylindrical", FlankForm::ZN, 3, WheelForm::cylindrical, Hand::right, 0},
                    Case{"ZK_oversize_left", FlankForm::ZK, 2, WheelForm::throated, Hand::left, 1e-3},
                    Case{"ZI_helical", FlankForm::ZI, 2, WheelForm::helical, Hand::right, 0},
                    Case{"ZI_helical_left", FlankForm::ZI, 2, WheelForm::helical, Hand::left, 0}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace elastogear::drive::exact_flanks_test
