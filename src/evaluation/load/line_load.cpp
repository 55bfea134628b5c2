#include "evaluation/load/line_load.h"

#include <limits>

#include "elastogear/evaluation/face_stations.h"

namespace elastogear::evaluation {
namespace {

// The width that each station stands for, m: the integral of its linear function.
Eigen::VectorXd widths(const Eigen::VectorXd& stations) {
  const Eigen::VectorXd ends = ends_of_parts(stations);
  return ends.tail(stations.size()) - ends.head(stations.size());
}

}  // namespace

Eigen::VectorXd line_load(const Eigen::VectorXd& stations, const Eigen::VectorXd& z,
                          const Eigen::VectorXd& force) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(stations.size());
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const auto [station, share] = share_out(stations, z[i]);
    for (std::size_t k : {0, 1}) load[station[k]] += share[k] * force[i];
  }
  return load.cwiseQuotient(widths(stations));
}

LineLoad line_load(const ContactHistory& contacts, const Eigen::VectorXd& stations) {
  LineLoad load{stations, Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(contacts.size()), stations.size())};
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
  if (load.value.rows() == 0) return Eigen::VectorXd::Zero(load.z.size());
  return load.value.colwise().mean().transpose();
}

double face_load_factor(const LineLoad& load) {
  const Eigen::VectorXd mean = mean_line_load(load), width = widths(load.z);
  const double over_width = mean.dot(width) / width.sum();
  return over_width > 0 ? mean.maxCoeff() / over_width : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace elastogear::evaluation
