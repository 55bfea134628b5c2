#pragma once
// The exact flanks of one body in a chart (v, z), as stations see them (docs/theory, section 6.18).

#include <Eigen/Core>
#include <string>

namespace elastogear::contact {

/// One flank of a body: tooth, 0-based, and +1 left or -1 right.
struct FlankName {
  int tooth = 0;
  int side = 1;

  bool operator==(const FlankName&) const = default;
};

/// A point of a flank in the body frame.
struct FlankPoint {
  Eigen::Vector3d x;         ///< m
  Eigen::Vector3d n;         ///< outward unit normal
  Eigen::Vector3d x_v, x_z;  ///< -, dx/dv and dx/dz
};

/// How a flank lies to a point beside it.
struct FlankDistance {
  double distance;           ///< m, signed, > 0 outside the tooth
  Eigen::Vector3d gradient;  ///< -, of the distance
  double v;                  ///< m, of the flank's nearest point
};

/// Charts of all flanks of a body. v runs across the profile, at its arc length, z along the face or the
/// thread; both in m. Flanks go on beyond their ends.
class ExactFlanks {
 public:
  struct Extent {
    double lower, upper;  ///< m, of v between the ends of the flank
    bool tip_at_upper;    ///< is its tip at the larger v? That of internal gears is at the smaller one
    double edge_radius;   ///< m, by which the edge of its tip is rounded
  };

  virtual ~ExactFlanks() = default;
  virtual int teeth() const = 0;
  virtual Extent extent() const = 0;
  virtual FlankPoint point(const FlankName& flank, double v, double z) const = 0;
  /// Exact at the flank, with its gradient; beside it to second order of the distance.
  virtual FlankDistance distance(const FlankName& flank, const Eigen::Vector3d& x) const = 0;
  /// m, how far the flank stands out of its chart along the normal; > 0: material added.
  virtual double deviation(const FlankName& flank, double v, double z) const = 0;
  /// The chart of a point on a flank, m. v is that of its radius.
  virtual Eigen::Vector2d chart(const FlankName& flank, const Eigen::Vector3d& x) const = 0;
  /// m, from the axis to the tip, the largest one.
  virtual double tip_radius() const = 0;
  /// Are they the envelope of their mate's, so that both touch along lines over the face on axes that cross?
  virtual bool is_hobbed() const { return false; }
  /// The flank of a group of faces by its name; tooth < 0: it is none.
  virtual FlankName flank_of(const std::string& group) const = 0;
};

}  // namespace elastogear::contact
