#include "elastogear/model/flexibility.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <numeric>

#include "elastogear/base/error.h"
#include "elastogear/base/tensor.h"

namespace elastogear::model {
namespace {

using Eigen::Matrix3d;

Matrix3d turn(const Flexibility& flexibility, int sector_index) {
  const double angle = 2 * std::numbers::pi * sector_index / flexibility.n_sectors;
  return Eigen::AngleAxisd(angle, flexibility.axis).toRotationMatrix();
}

using Matrix6d = Eigen::Matrix<double, 6, 6>;

// Turns the six entries of a symmetric matrix S: those of T S T'.
Matrix6d turn_of_entries(const Matrix3d& T) {
  Matrix6d turned;
  for (int j = 0; j < 6; ++j) turned.col(j) = six_entries(T * symmetric(Vector6::Unit(j)) * T.transpose());
  return turned;
}

// The node of the same orbit that comes to `node` when it is turned by sector_index sectors.
int turned_back(const Images& images, int node, int sector_index) {
  const auto n_sectors = static_cast<int>(images.node.rows());
  return images.node((images.sector_index[node] - sector_index + n_sectors) % n_sectors, images.orbit[node]);
}

}  // namespace

Images make_images(std::vector<int> orbit, std::vector<int> sector_index, int n_sectors,
                   const std::string& source) {
  const std::size_t n = orbit.size();
  require(n_sectors >= 1 && n % static_cast<std::size_t>(n_sectors) == 0 && sector_index.size() == n, source,
          ": ", n, " nodes are no whole number of orbits of ", n_sectors, " nodes");
  Images images{std::move(orbit), std::move(sector_index), {}};
  images.node.setConstant(n_sectors, static_cast<Eigen::Index>(n) / n_sectors, -1);
  for (std::size_t i = 0; i < n; ++i) {
    const int o = images.orbit[i], t = images.sector_index[i];
    require(o >= 0 && o < images.node.cols() && t >= 0 && t < n_sectors && images.node(t, o) < 0, source,
            ": node ", i, " has orbit ", o, " and ", t, " turns, which cannot be");
    images.node(t, o) = static_cast<int>(i);
  }
  return images;
}

Images no_images(int n) {
  std::vector<int> orbit(static_cast<std::size_t>(n));
  std::iota(orbit.begin(), orbit.end(), 0);
  return make_images(orbit, std::vector<int>(orbit.size(), 0), 1, "nodes");
}

int find_loaded(const Flexibility& flexibility, int surface_node) {
  const auto at = std::lower_bound(flexibility.node.begin(), flexibility.node.end(), surface_node);
  return at != flexibility.node.end() && *at == surface_node ? static_cast<int>(at - flexibility.node.begin())
                                                             : -1;
}

Eigen::MatrixXf displacement_columns(const Flexibility& flexibility, int orbit) {
  return flexibility.F.size() > 0 ? Eigen::MatrixXf(flexibility.F.middleCols<3>(3 * orbit))
                                  : flexibility.read_F(orbit);
}

Eigen::MatrixXf displacement_columns(const RelaxedResponse& relaxed, int orbit) {
  return relaxed.F.size() > 0 ? Eigen::MatrixXf(relaxed.F.middleCols<3>(3 * orbit)) : relaxed.read_F(orbit);
}

double self_response(const Flexibility& flexibility, int orbit, const Columns3& F) {
  return F.middleRows<3>(3 * flexibility.surface.node(0, orbit)).cast<double>().norm();
}

void set_self(Flexibility& flexibility) {
  const auto n = static_cast<int>(flexibility.surface.node.cols());
  flexibility.self.resize(n);
  for (int orbit = 0; orbit < n; ++orbit)
    flexibility.self[orbit] = self_response(flexibility, orbit, flexibility.F.middleCols<3>(3 * orbit));
}

Matrix3d displacement_response(const Flexibility& flexibility, int a, int b, const Columns3& F) {
  const int sector_index = flexibility.surface.sector_index[b];
  const Matrix3d u = F.middleRows<3>(3 * turned_back(flexibility.surface, a, sector_index)).cast<double>();
  if (sector_index == 0) return u;
  const Matrix3d T = turn(flexibility, sector_index);
  return T * u * T.transpose();
}

Eigen::Matrix<double, Eigen::Dynamic, 3> stress_responses(const Flexibility& flexibility,
                                                          const std::vector<int>& evaluated, int b,
                                                          const Columns3& G) {
  const int sector_index = flexibility.surface.sector_index[b];
  const Matrix3d T = turn(flexibility, sector_index);
  const Matrix6d turned = turn_of_entries(T);
  Eigen::Matrix<double, Eigen::Dynamic, 3> S(6 * static_cast<Eigen::Index>(evaluated.size()), 3);
  for (std::size_t i = 0; i < evaluated.size(); ++i) {
    const int row = turned_back(flexibility.stress, flexibility.stress_row[evaluated[i]], sector_index);
    auto s = S.middleRows<6>(6 * static_cast<Eigen::Index>(i));
    if (sector_index == 0)
      s = G.middleRows<6>(6 * row).cast<double>();
    else
      s = turned * (G.middleRows<6>(6 * row).cast<double>() * T.transpose());
  }
  return S;
}

}  // namespace elastogear::model
