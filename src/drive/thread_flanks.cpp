// The flanks of a worm whose half angle depends on the radius alone.

#include <Eigen/Core>
#include <cmath>

#include "drive/formed_flanks.h"

namespace elastogear::drive {
namespace {

class ThreadFlanks : public FormedFlanks {
 public:
  ThreadFlanks(const gear::Toothing& toothing, const std::optional<gear::FlankDeviations>& deviations)
      : FormedFlanks(toothing, deviations), psi_0_(gear::psi(toothing, toothing.r_form)) {
    extent_ = {t_.r_form, t_.r_a, true, kEdgeRadius * normal_module(t_)};
  }

  // A profile in an axial section: its angle does not depend on v, which is the radius.
  contact::FlankPoint point(const contact::FlankName& flank, double v, double z) const override {
    const gear::HalfAngle half = gear::half_angle(t_, v);
    const double theta = z / t_.p + flank.side * psi_0_ + gear::tooth_angle(t_, flank.tooth);
    const Eigen::Vector3d radial(std::cos(theta), std::sin(theta), 0), around(-radial[1], radial[0], 0);
    const double s_p = flank.side * t_.p;
    return with_normal(v * radial + (z + s_p * (psi_0_ - half.psi)) * Eigen::Vector3d::UnitZ(),
                       radial - s_p * half.d_r * Eigen::Vector3d::UnitZ(),
                       v / t_.p * around + Eigen::Vector3d::UnitZ(), flank.side);
  }

  Eigen::Vector2d chart(const contact::FlankName& flank, const Eigen::Vector3d& x) const override {
    const double r = x.head<2>().norm();
    return {r, x[2] - flank.side * t_.p * (psi_0_ - gear::psi(t_, r))};
  }

  double tip_radius() const override { return t_.r_a; }

 private:
  double psi_0_;
};

}  // namespace

std::shared_ptr<const contact::ExactFlanks> thread_flanks(
    const gear::Toothing& toothing, const std::optional<gear::FlankDeviations>& deviations) {
  return std::make_shared<ThreadFlanks>(toothing, deviations);
}

}  // namespace elastogear::drive
