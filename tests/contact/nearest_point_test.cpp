// Points of contact on axes that cross: two round cylinders, whose least gap and curvatures are known.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "elastogear/contact/station_law.h"
#include "elastogear/contact/station_places.h"

namespace elastogear::contact::nearest_point_test {
namespace {

// A round cylinder about z as one flank; v is the arc from x on.
class Cylinder : public ExactFlanks {
 public:
  explicit Cylinder(double R) : R_(R) {}

  int teeth() const override { return 1; }
  Extent extent() const override { return {-R_ / 2, R_ / 2, true, R_ / 100}; }
  FlankPoint point(const FlankName&, double v, double z) const override {
    const double c = std::cos(v / R_), s = std::sin(v / R_);
    return {{R_ * c, R_ * s, z}, {c, s, 0}, {-s, c, 0}, Eigen::Vector3d::UnitZ()};
  }
  FlankDistance distance(const FlankName&, const Eigen::Vector3d& x) const override {
    const double r = x.head<2>().norm();
    return {r - R_, {x[0] / r, x[1] / r, 0}, R_ * std::atan2(x[1], x[0])};
  }
  double deviation(const FlankName&, double, double) const override { return 0; }
  Eigen::Vector2d chart(const FlankName&, const Eigen::Vector3d& x) const override {
    return {R_ * std::atan2(x[1], x[0]), x[2]};
  }
  double tip_radius() const override { return R_; }
  FlankName flank_of(const std::string&) const override { return {0, 1}; }

 private:
  double R_;
};

const Cylinder kOwner(0.02), kMate(0.05);
const FlankPair kPair{&kOwner, {0, 1}, &kMate, {0, 1}};
constexpr double kGap = -10e-6;

// The mate beyond +x of the owner, its x towards it, its axis turned by an angle from the owner's y to its z.
RelativePlacement placement(double angle, double along = 0) {
  RelativePlacement placed;
  const double c = std::cos(angle), s = std::sin(angle);
  placed.R.col(0) = -Eigen::Vector3d::UnitX();
  placed.R.col(1) = Eigen::Vector3d(0, -s, c);
  placed.R.col(2) = Eigen::Vector3d(0, c, s);
  placed.r = Eigen::Vector3d(0.07 + kGap, 0, along);
  return placed;
}

TEST(NearestPoint, is_where_crossed_cylinders_touch) {
  for (const Eigen::Vector2d& start : {Eigen::Vector2d(0, 0), {5e-3, -2e-3}, {-9e-3, 8e-3}}) {
    const NearestPlace place = nearest_point(kPair, {}, placement(0, 1e-3), start);
    EXPECT_NEAR(place.gap, kGap, 1e-15);
    EXPECT_NEAR(place.v, 0, 1e-12);
    EXPECT_NEAR(place.face.centre(), 1e-3, 1e-12);
    EXPECT_NEAR(place.mate_v, 0, 1e-12);
    EXPECT_NEAR((place.n + Eigen::Vector3d::UnitX()).norm(), 0, 1e-10);
  }
}

// K. L. Johnson, Contact Mechanics, Eq. (4.3): sum and difference of principal relative curvatures.
TEST(NearestPoint, has_the_curvatures_of_crossed_cylinders) {
  for (double angle : {0., 0.4, 1.1}) {
    const RelativePlacement at = placement(angle);
    const NearestPlace place = nearest_point(kPair, {}, at, {0, 0});
    const PrincipalCurvatures found = curvatures(kPair, {}, at, place, 1e-4);
    const double a = 1 / 0.02, b = 1 / 0.05, between = std::numbers::pi / 2 - angle;
    const double difference = std::sqrt(a * a + b * b + 2 * a * b * std::cos(2 * between));
    EXPECT_NEAR(found.least + found.largest, a + b, 1e-4 * (a + b));
    EXPECT_NEAR(found.largest - found.least, difference, 1e-4 * (a + b));
  }
}

// A face that ends before the point turns the contact to its rounded end.
TEST(NearestPoint, stays_on_a_face_that_ends) {
  const FaceEnds ends{{-1e-3, 1e-3}, FaceEnds::kNone};
  const RelativePlacement at = placement(0, 1.5e-3);
  const NearestPlace place = nearest_point(kPair, ends, at, {0, 0});
  EXPECT_GT(place.face.centre(), 1e-3);
  EXPECT_LT(place.face.centre(), 1e-3 + 0.02 / 100);
  const PrincipalCurvatures there = curvatures(kPair, ends, at, place, 1e-5);
  EXPECT_GT(there.largest, 0.5 * 100 / 0.02);
}

TEST(StationLaw, of_a_point_has_the_derivatives_that_it_says) {
  const StationLaw law = point_law(24, 130, 3e-12);
  for (double f : {1e-3, 1., 2000.}) {
    const double h = 1e-5 * f;
    EXPECT_NEAR((law.energy(f + h) - law.energy(f - h)) / (2 * h), law.approach(f), 1e-8 * law.approach(f));
    EXPECT_NEAR((law.approach(f + h) - law.approach(f - h)) / (2 * h), law.slope(f), 1e-8 * law.slope(f));
    EXPECT_NEAR(law.pressure(f), 1.5 * f / law.area(f), 1e-9 * law.pressure(f));
  }
}

}  // namespace
}  // namespace elastogear::contact::nearest_point_test
