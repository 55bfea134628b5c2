#pragma once
// Load over the face width and its unevenness (docs/theory, section 10.3).

#include <Eigen/Core>

#include "elastogear/evaluation/contact.h"
#include "elastogear/evaluation/face_stations.h"

namespace elastogear::evaluation {

/// Normal force of all pairs of teeth per width at stations over the face.
struct LineLoad {
  FaceStations stations;  ///< n, along the second gear's axis
  Eigen::MatrixXd value;  ///< n_t x n, N/m
};

/// Forces (N) at z (m) shared out to the stations, over the width that each station stands for, N/m: Eq.
/// (10.7). Forces beyond the ends count at the end.
Eigen::VectorXd line_load(const FaceStations& stations, const Eigen::VectorXd& z,
                          const Eigen::VectorXd& force);

LineLoad line_load(const ContactHistory& contacts, const FaceStations& stations);

/// Largest over mean line load, of the mean over all times: KHbeta, Eq. (10.8); NaN without load.
double face_load_factor(const LineLoad& load);
/// The mean over all times, N/m.
Eigen::VectorXd mean_line_load(const LineLoad& load);

}  // namespace elastogear::evaluation
