#include "contact/stations/station_compliance.h"

#include "elastogear/base/error.h"

namespace elastogear::contact {
namespace {

void require_same_stations(const BodyLoads& loads) {
  const Eigen::Index n = loads.direction.cols();
  require(loads.weight.rows() == n && loads.weight.cols() == std::ssize(loads.node), "loads of ", n,
          " stations on ", loads.node.size(), " nodes have ", loads.weight.rows(), " x ", loads.weight.cols(),
          " weights");
}

// 3 nodes x n: nodal forces of 1 N of each station.
Eigen::MatrixXd nodal_forces(const BodyLoads& loads) {
  Eigen::MatrixXd S(3 * loads.weight.cols(), loads.weight.rows());
  for (Eigen::Index a = 0; a < loads.weight.cols(); ++a)
    S.middleRows<3>(3 * a) = loads.direction * loads.weight.col(a).asDiagonal();
  return S;
}

}  // namespace

Eigen::MatrixXd body_compliance(const BodyLoads& loads, const NodalResponse& response) {
  require_same_stations(loads);
  const Eigen::MatrixXd S = nodal_forces(loads);
  Eigen::MatrixXd U = Eigen::MatrixXd::Zero(S.rows(), S.cols());  // displacements, from responses on one side
  for (Eigen::Index a = 0; a < loads.weight.cols(); ++a)
    for (Eigen::Index b = 0; b <= a; ++b) {
      const Eigen::Matrix3d F =
          response(loads.node[static_cast<std::size_t>(a)], loads.node[static_cast<std::size_t>(b)]) *
          (a == b ? 0.5 : 1);
      U.middleRows<3>(3 * a).noalias() += F * S.middleRows<3>(3 * b);
    }
  const Eigen::MatrixXd half = S.transpose() * U;
  return half + half.transpose();
}

Eigen::MatrixXd local_compliance(const std::vector<StationLine>& stations, const BodyLoads& loads, double q) {
  const auto n = std::ssize(stations);
  require(loads.smooth.rows() == n && loads.smooth.cols() == n, n, " stations have ", loads.smooth.rows(),
          " x ", loads.smooth.cols(), " half-space means, must be n x n");
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t begin = 0, end = 0; begin < stations.size(); begin = end) {
    std::vector<Strip> strips;
    for (; end < stations.size() && stations[end].pair == stations[begin].pair; ++end)
      strips.push_back(stations[end].along);
    const auto first = static_cast<Eigen::Index>(begin), size = std::ssize(strips);
    C.block(first, first, size, size) = loads.compliance * (line_kernel(strips, q, loads.ends) -
                                                            loads.smooth.block(first, first, size, size));
  }
  return C;
}

}  // namespace elastogear::contact
