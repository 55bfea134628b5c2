#pragma once
// The gap between two exact flanks over the chart of the owner's (docs/theory, section 6.18).

#include <Eigen/Core>
#include <array>

#include "elastogear/contact/station_places.h"

namespace elastogear::contact {

/// Eq. (6.50). ends: of both faces, in z; flanks are rounded beyond them as beyond their tips.
class FlankGap {
 public:
  FlankGap(const FlankPair& flanks, const RelativePlacement& placement, const FaceEnds& ends = {});

  struct Seen {
    FlankPoint owner;
    Eigen::Vector3d x_mate;  ///< m
    FlankDistance mate;
  };
  Seen seen(double v, double z) const;
  double mate_z(const Seen& seen) const { return flanks_.mate->chart(flanks_.on_mate, seen.x_mate)[1]; }
  /// Normal of the mate's flank with its deviation and rounded edges, which is the gradient of the gap, in
  /// the mate's frame. Its length is 1 to second order of their slope.
  Eigen::Vector3d mate_normal(const Seen& seen) const;
  double at(double v, double z) const;
  /// m, of the flanks without their rounded edges.
  double without_edges(double v, double z) const;
  /// m: what the rounded edges of one body take away at its own place.
  double taken(bool of_owner, double v, double z) const;
  /// Its derivatives; those of what is added, by differences.
  double slope_v(double v, double z) const;
  double slope_z(double v, double z) const;
  /// m: ends of the owner's flank across the profile and along the face, with its rounded edges.
  double low() const { return owner_.lower - (owner_.tip_at_upper ? 0 : owner_.edge_radius); }
  double high() const { return owner_.upper + (owner_.tip_at_upper ? owner_.edge_radius : 0); }
  double height() const { return owner_.upper - owner_.lower; }
  Strip face() const { return {ends_.owner.from - owner_.edge_radius, ends_.owner.to + owner_.edge_radius}; }
  const FlankPair& flanks() const { return flanks_; }
  const RelativePlacement& placement() const { return placement_; }

 private:
  double added(double v, double z, const Seen& seen) const;
  double added_by_owner(double v, double z) const;
  double added_by_mate(double v, double z) const;
  double added_slope(double v, double z, int along, const Seen& seen) const;
  bool mate_is_plain_around(const Seen& seen) const;  // without deviation and off its edges

  const FlankPair& flanks_;
  const RelativePlacement& placement_;
  FaceEnds ends_;
  ExactFlanks::Extent owner_, mate_;
};

/// What a place (v, middle of the face's piece) tells of both flanks.
NearestPlace place_at(const FlankGap& gap, const Strip& face, double v);

/// The placement after a motion of the mate with this twist.
RelativePlacement moved(const RelativePlacement& placement, const Eigen::Matrix<double, 6, 1>& twist,
                        double time);
/// s, of a motion that is small beside a flank, by which rates are differences; 0 without a motion.
double rate_time(const FlankPair& flanks, const RelativePlacement& placement,
                 const Eigen::Matrix<double, 6, 1>& twist);

}  // namespace elastogear::contact
