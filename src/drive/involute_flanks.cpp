#include "drive/charts.h"

#include <algorithm>
#include <cmath>

#include "elastogear/gear/flank.h"

namespace elastogear::drive {
namespace {

class InvoluteFlanks : public contact::ExactFlanks {
 public:
  InvoluteFlanks(const gear::Toothing& toothing, const std::optional<gear::FlankDeviations>& deviations,
                 Layers layers)
      : t_(toothing), deviations_(deviations), layers_(layers) {
    const double form = arc(t_.r_form), tip = arc(t_.r_a);
    extent_ = {std::min(form, tip), std::max(form, tip), !t_.internal, kEdgeRadius * normal_module(t_)};
  }

  int teeth() const override { return t_.z; }
  Extent extent() const override { return extent_; }

  contact::FlankPoint point(const contact::FlankName& flank, double v, double z) const override {
    const double roll = std::sqrt(2 * std::max(v, 0.) / t_.r_b);  // tan(alpha)
    const double cosine = 1 / std::sqrt(1 + roll * roll), sine = roll * cosine, r = t_.r_b / cosine;
    const double height = z + shift(flank, roll);
    const double theta = height / t_.p + gear::tooth_angle(t_, flank.tooth) +
                         flank.side * (t_.psi_b - t_.sign() * (roll - std::atan(roll)));
    const Eigen::Vector3d radial(std::cos(theta), std::sin(theta), 0), around(-radial[1], radial[0], 0);
    contact::FlankPoint point;
    point.x = r * radial + height * Eigen::Vector3d::UnitZ();
    point.x_v = cosine * radial - flank.side * t_.sign() * sine * around;
    point.x_z = r / t_.p * around + Eigen::Vector3d::UnitZ();
    if (layers_ == Layers::axial)  // the shift grows with the involute function
      point.x_v += t_.p * flank.side * t_.sign() * sine * cosine / t_.r_b * point.x_z;
    point.n = normal(flank, radial, around, cosine, sine);
    return point;
  }

  contact::FlankDistance distance(const contact::FlankName& flank, const Eigen::Vector3d& x) const override {
    const double r = x.head<2>().norm(), length = gear::length_of_roll(t_, r);
    const Eigen::Vector3d radial(x[0] / r, x[1] / r, 0), around(-radial[1], radial[0], 0);
    contact::FlankDistance d;
    d.distance = gear::flank_distance(t_, flank.tooth, flank.side, x);
    d.gradient = normal(flank, radial, around, t_.r_b / r, length / r);
    const double foot = length - t_.sign() * d.distance * std::cos(t_.beta_b);
    d.v = foot * std::abs(foot) / (2 * t_.r_b);
    return d;
  }

  double deviation(const contact::FlankName& flank, double v, double z) const override {
    if (!deviations_) return 0;
    return gear::flank_deviation(t_, *deviations_, {flank.tooth, flank.side}, point(flank, v, z).x);
  }

  Eigen::Vector2d chart(const contact::FlankName& flank, const Eigen::Vector3d& x) const override {
    const double r = x.head<2>().norm();
    return {arc(r), x[2] - shift(flank, gear::length_of_roll(t_, r) / t_.r_b)};
  }

  double tip_radius() const override { return t_.r_a; }

  contact::FlankName flank_of(const std::string& group) const override {
    const auto flank = gear::flank_of(t_, group);
    return flank ? contact::FlankName{flank->tooth, flank->side} : contact::FlankName{-1, 0};
  }

 private:
  double arc(double r) const {
    const double length = gear::length_of_roll(t_, r);
    return length * length / (2 * t_.r_b);
  }
  // m: how far along the axis the flank has the angle that it has on the base circle.
  double shift(const contact::FlankName& flank, double roll) const {
    if (layers_ == Layers::transverse) return 0;
    return t_.p * flank.side * t_.sign() * (roll - std::atan(roll));
  }
  // Along the tangent of the base circle, turned out of the transverse section by the base helix angle.
  Eigen::Vector3d normal(const contact::FlankName& flank, const Eigen::Vector3d& radial,
                         const Eigen::Vector3d& around, double cosine, double sine) const {
    const Eigen::Vector3d along = flank.side * cosine * around + t_.sign() * sine * radial;
    return std::cos(t_.beta_b) * along - flank.side * std::sin(t_.beta_b) * Eigen::Vector3d::UnitZ();
  }

  gear::Toothing t_;
  std::optional<gear::FlankDeviations> deviations_;
  Layers layers_;
  Extent extent_;
};

}  // namespace

std::shared_ptr<const contact::ExactFlanks> involute_flanks(
    const gear::Toothing& toothing, const std::optional<gear::FlankDeviations>& deviations, Layers layers) {
  return std::make_shared<InvoluteFlanks>(toothing, deviations, layers);
}

}  // namespace elastogear::drive
