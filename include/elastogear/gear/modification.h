#pragma once
// Deviations of flanks from their exact shape: designed modifications (ISO 21771) and deviations of
// manufacture, as distances along the normal of the exact flank (docs/theory, section 9).

#include <Eigen/Core>
#include <vector>

#include "elastogear/gear/flank.h"

namespace elastogear::gear {

/// Material removed towards an end of the flank.
struct Relief {
  double amount = 0;       ///< m, at the end
  double length = 0;       ///< m, from its beginning to the end
  bool parabolic = false;  ///< with the square of the distance from its beginning, else linear
};

/// Modifications of the flanks of one side of all teeth; amounts > 0 remove material. Lengths along the
/// profile are lengths of roll, those along the face are along the gear's axis.
struct FlankModification {
  Relief tip;           ///< C_alpha_a
  Relief root;          ///< C_alpha_f, towards the start of contact
  double C_alpha = 0;   ///< m, profile crowning: at both ends of the profile
  double C_Halpha = 0;  ///< m, profile slope: at the tip, nothing at the start of contact
  Relief end;           ///< C_beta_I and C_beta_II, at both ends of the face
  double C_beta = 0;    ///< m, lead crowning: at both ends of the face
  double C_Hbeta = 0;   ///< m, helix slope: at the end of larger z, nothing at the other end
  double S_alpha = 0;   ///< m, twist: profile slope at the end of larger z less that at the other end
};

/// Measured heights over the flank of one tooth, or of all; linear between the points, constant beyond.
struct Topography {
  int tooth = -1;          ///< 0-based; -1: all
  int side = 0;            ///< +1 left, -1 right, 0 both
  Eigen::VectorXd roll;    ///< m, lengths of roll, increasing
  Eigen::VectorXd z;       ///< m, increasing
  Eigen::MatrixXd height;  ///< roll x z, m, > 0: material added
};

/// All deviations of the flanks of one gear.
struct FlankDeviations {
  FlankModification left, right;
  double width = 0;       ///< m, of the face, which is symmetric about z = 0
  Eigen::VectorXd index;  ///< m, by tooth: index deviation along the pitch circle, > 0 counter-clockwise;
                          ///< empty: none
  Eigen::Vector2d eccentricity = Eigen::Vector2d::Zero();  ///< m, of the toothing against the gear's axis
  std::vector<Topography> topography;
};

/// Are all deviations zero?
bool are_exact(const FlankDeviations& deviations);
/// Do deviations differ from tooth to tooth?
bool teeth_differ(const FlankDeviations& deviations);

/// m, along the base tangent from the base circle to the radius r; 0 inside it.
double length_of_roll(const Toothing& toothing, double r);

/// m, length of roll from the start of contact to the tip: that of the profile's modifications.
double profile_length(const Toothing& toothing);

/// m, length of roll in which a second pair is in contact, at either end of the profile; at least a tenth and
/// at most half of the profile: relief of this length leaves the flank as it is where one pair touches.
double relief_length(const Toothing& toothing);

/// Throws Error, naming the value and the largest that would do, for lengths beyond the flank, amounts that
/// are not small against it, and values that are not finite. name: of the gear.
void check(const std::string& name, const Toothing& toothing, const FlankDeviations& deviations);

/// m, how far the flank stands out of its exact shape at its point x (body frame, m) along the outward
/// normal.
double flank_deviation(const Toothing& toothing, const FlankDeviations& deviations, const Flank& flank,
                       const Eigen::Vector3d& x);

/// Distance from x along the unit direction n to the deviating flank, m; NaN as that of the exact one, see
/// flank_distance_along.
double flank_distance_along(const Toothing& toothing, const FlankDeviations& deviations, const Flank& flank,
                            const Eigen::Vector3d& x, const Eigen::Vector3d& n);

}  // namespace elastogear::gear
