#include "evaluation/load/line_load.h"

#include <limits>

namespace elastogear::evaluation {
Eigen::VectorXd line_load(const FaceStations& stations, const Eigen::VectorXd& z,
                          const Eigen::VectorXd& force) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(stations.n());
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const auto [station, share] = share_out(stations, z[i]);
    for (std::size_t k : {0, 1}) load[station[k]] += share[k] * force[i];
  }
  return load.cwiseQuotient(stations.widths());
}

LineLoad line_load(const ContactHistory& contacts, const FaceStations& stations) {
  LineLoad load{stations, Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(contacts.size()), stations.n())};
  for (std::size_t step = 0; step < contacts.size(); ++step) {
    const auto n = static_cast<Eigen::Index>(contacts[step].size());
    Eigen::VectorXd z(n), force(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const FlankContact& c = contacts[step][static_cast<std::size_t>(i)];
      z[i] = c.x_B[1][2];
      force[i] = c.normal_force;
    }
    load.value.row(static_cast<Eigen::Index>(step)) = line_load(stations, z, force);
  }
  return load;
}

Eigen::VectorXd mean_line_load(const LineLoad& load) {
  if (load.value.rows() == 0) return Eigen::VectorXd::Zero(load.stations.n());
  return load.value.colwise().mean().transpose();
}

double face_load_factor(const LineLoad& load) {
  const Eigen::VectorXd mean = mean_line_load(load), width = load.stations.widths();
  const double over_width = mean.dot(width) / width.sum();
  return over_width > 0 ? mean.maxCoeff() / over_width : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace elastogear::evaluation
