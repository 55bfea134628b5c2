#pragma once
// Charts of flanks that are no involutes share this base: a distance is found by projection onto the chart.

#include "drive/charts.h"

namespace elastogear::drive {

class FormedFlanks : public contact::ExactFlanks {
 public:
  FormedFlanks(const gear::Toothing& toothing, const std::optional<gear::FlankDeviations>& deviations)
      : t_(toothing), deviations_(deviations) {}

  int teeth() const override { return t_.z; }
  Extent extent() const override { return extent_; }
  contact::FlankDistance distance(const contact::FlankName& flank, const Eigen::Vector3d& x) const override;
  double deviation(const contact::FlankName& flank, double v, double z) const override;
  contact::FlankName flank_of(const std::string& group) const override;

 protected:
  // v runs outwards and z along the axis; side: of the flank, whose outer side is that of larger angles where
  // it is 1.
  static contact::FlankPoint with_normal(const Eigen::Vector3d& x, const Eigen::Vector3d& x_v,
                                         const Eigen::Vector3d& x_z, int side);

  gear::Toothing t_;
  std::optional<gear::FlankDeviations> deviations_;
  Extent extent_{};
};

}  // namespace elastogear::drive
