#include "fem/elements/hex8.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "fem/elements/kernels.h"

namespace elastogear::fem::hex8 {
namespace {

using Point = Eigen::Vector3d;
using Functions = Eigen::Matrix<double, 8, 1>;
using Derivatives = Eigen::Matrix<double, 8, 3>;
constexpr int kModes = 3;  // incompatible functions, each in three directions
constexpr int kFunctions = 8 + kModes;
using Gradients = Eigen::Matrix<double, 3, kFunctions>;

// Corner k of the reference cube [-1, 1]^3, in the mesh's node order.
Point corner(int k) {
  static constexpr int kSigns[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                       {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  return {double(kSigns[k][0]), double(kSigns[k][1]), double(kSigns[k][2])};
}

Functions shape(const Point& xi) {
  Functions N;
  for (int a = 0; a < 8; ++a) N(a) = (1 + corner(a).array() * xi.array()).prod() / 8;
  return N;
}

Derivatives shape_derivatives(const Point& xi) {
  Derivatives dN;
  for (int a = 0; a < 8; ++a) {
    const Point s = corner(a), f = 1 + s.array() * xi.array();
    dN.row(a) << s.x() * f.y() * f.z() / 8, s.y() * f.z() * f.x() / 8, s.z() * f.x() * f.y() / 8;
  }
  return dN;
}

struct Sample {
  Point xi;
  double weight;
  Functions N;
  Derivatives dN;
};

Sample sample(const Point& xi, double weight) { return {xi, weight, shape(xi), shape_derivatives(xi)}; }

// 2x2x2 Gauss points in node order, so that the cube they span is the cell shrunk by 1/sqrt(3).
const std::array<Sample, 8>& stiffness_points() {
  static const std::array<Sample, 8> points = [] {
    std::array<Sample, 8> p;
    for (int k = 0; k < 8; ++k) p[k] = sample(corner(k) / std::sqrt(3.0), 1);
    return p;
  }();
  return points;
}

const std::array<Sample, 27>& mass_points() {
  static const std::array<Sample, 27> points = [] {
    const double x[3] = {-std::sqrt(0.6), 0, std::sqrt(0.6)}, w[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
    std::array<Sample, 27> p;
    for (int i = 0; i < 27; ++i)
      p[i] = sample({x[i % 3], x[i / 3 % 3], x[i / 9]}, w[i % 3] * w[i / 3 % 3] * w[i / 9]);
    return p;
  }();
  return points;
}

Eigen::Matrix3d centre_jacobian(const Coordinates& X) { return X * shape_derivatives(Point::Zero()); }

// Gradients of the eight shape functions and the three corrected incompatible modes at one Gauss point.
// docs/theory, Eq. (1.5).
Gradients gradients(const Coordinates& X, const Sample& point, const Eigen::Matrix3d& J_0, double* det) {
  const Eigen::Matrix3d J = X * point.dN;
  *det = J.determinant();
  Gradients g;
  g.leftCols<8>() = (point.dN * J.inverse()).transpose();
  const Eigen::Matrix3d dP = (-2 * point.xi).asDiagonal();
  g.rightCols<kModes>() = J_0.determinant() / *det * (J_0.inverse().transpose() * dP);
  return g;
}

using FullStiffness = Eigen::Matrix<double, 3 * kFunctions, 3 * kFunctions>;
using Weighted = Eigen::Matrix<double, 3 * kFunctions, 8>;

// Gradients at the points as fem/kernels.h takes them.
Weighted weighted_gradients(const Coordinates& X) {
  const Eigen::Matrix3d J_0 = centre_jacobian(X);
  Weighted G;
  for (int p = 0; p < 8; ++p) {
    double det = 0;
    const Gradients g = gradients(X, stiffness_points()[p], J_0, &det);
    G.col(p) = std::sqrt(det) * g.reshaped();
  }
  return G;
}

// Amplitudes of the incompatible modes per nodal displacement: a = -K_aa^-1 K_au u.
template <class Matrix>
Amplitudes condensation(const Matrix& K) {
  const Eigen::Matrix<double, 9, 9> K_aa = K.template bottomRightCorner<9, 9>();
  const Amplitudes K_au = K.template bottomLeftCorner<9, 24>();
  return -K_aa.ldlt().solve(K_au);
}

// The material without its resistance to dilatation.
Lame deviatoric(const Lame& material) { return {-2.0 / 3 * material.mu, material.mu}; }
double bulk_modulus(const Lame& material) { return material.lambda + 2.0 / 3 * material.mu; }

// Divergence of the displacement per nodal displacement, averaged over the cell (1/m).
Eigen::Matrix<double, 24, 1> mean_divergence(const Coordinates& X) {
  const Eigen::Matrix3d J_0 = centre_jacobian(X);
  Eigen::Matrix<double, 24, 1> sum = Eigen::Matrix<double, 24, 1>::Zero();
  for (const Sample& point : stiffness_points()) {
    double det = 0;
    const Gradients g = gradients(X, point, J_0, &det);
    sum += det * g.leftCols<8>().reshaped();
  }
  return sum / volume(X);
}

// K of all kFunctions functions, before condensation. docs/theory, Eq. (1.6).
FullStiffness full_stiffness(const Coordinates& X, const Lame& material, model::Element element) {
  if (element != model::Element::bbar)
    return isotropic_stiffness<kFunctions, 8>(weighted_gradients(X), material);
  const auto b = mean_divergence(X);
  FullStiffness K = isotropic_stiffness<kFunctions, 8>(weighted_gradients(X), deviatoric(material));
  K.topLeftCorner<24, 24>() += bulk_modulus(material) * volume(X) * b * b.transpose();
  return K;
}

using Strains = Eigen::Matrix<double, 6, 3 * kFunctions>;

// Strains at the points, for bbar with the mean dilatation of the eight shape functions, and det J.
std::array<Strains, 8> strains_at_points(const Coordinates& X, model::Element element,
                                         std::array<double, 8>& det) {
  const Eigen::Matrix3d J_0 = centre_jacobian(X);
  const bool bbar = element == model::Element::bbar;
  const Eigen::Matrix<double, 24, 1> mean = mean_divergence(X);
  std::array<Strains, 8> B;
  for (int p = 0; p < 8; ++p) {
    const Gradients g = gradients(X, stiffness_points()[p], J_0, &det[p]);
    B[p] = strains<kFunctions>(g);
    if (!bbar) continue;
    const Eigen::Matrix<double, 24, 1> missing = mean - g.leftCols<8>().reshaped();
    B[p].topLeftCorner<3, 24>().rowwise() += missing.transpose() / 3;
  }
  return B;
}

std::vector<Matrix6> elasticity_at_points(const Coordinates& X, const Orthotropy& material) {
  Eigen::Matrix3Xd x(3, 8);
  for (int p = 0; p < 8; ++p) x.col(p) = X * stiffness_points()[p].N;
  return elasticity_at(material, x);
}

FullStiffness full_stiffness(const Coordinates& X, const Orthotropy& material, model::Element element) {
  std::array<double, 8> det;
  const auto B = strains_at_points(X, element, det);
  const auto H = elasticity_at_points(X, material);
  FullStiffness K = FullStiffness::Zero();
  for (int p = 0; p < 8; ++p) {
    const Strains HB = det[p] * H[p] * B[p];
    K += B[p].transpose() * HB;
  }
  return K;
}

FullStiffness full_stiffness(const Coordinates& X, const Elasticity& material, model::Element element) {
  return std::visit([&](const auto& m) { return full_stiffness(X, m, element); }, material);
}

using PointStresses = std::array<Strains, 8>;

PointStresses point_stresses(const Coordinates& X, const Lame& material, model::Element element) {
  const Eigen::Matrix3d J_0 = centre_jacobian(X);
  const bool bbar = element == model::Element::bbar;
  const Eigen::Matrix<double, 1, 24> pressure = bulk_modulus(material) * mean_divergence(X).transpose();
  PointStresses sigma;
  for (int p = 0; p < 8; ++p) {
    double det = 0;
    const Gradients g = gradients(X, stiffness_points()[p], J_0, &det);
    sigma[p] = isotropic_stress<kFunctions>(g, bbar ? deviatoric(material) : material);
    if (bbar) sigma[p].topLeftCorner<3, 24>().rowwise() += pressure;
  }
  return sigma;
}

PointStresses point_stresses(const Coordinates& X, const Orthotropy& material, model::Element element) {
  std::array<double, 8> det;
  PointStresses sigma = strains_at_points(X, element, det);
  const auto H = elasticity_at_points(X, material);
  for (int p = 0; p < 8; ++p) sigma[p] = (H[p] * sigma[p]).eval();
  return sigma;
}

}  // namespace

double smallest_jacobian(const Coordinates& X) {
  double smallest = centre_jacobian(X).determinant();
  const auto visit = [&](const Sample& point) {
    const double det = Eigen::Matrix3d(X * point.dN).determinant();
    if (!(det >= smallest)) smallest = det;
  };
  for (const Sample& point : stiffness_points()) visit(point);
  for (const Sample& point : mass_points()) visit(point);
  return smallest;
}

Stiffness stiffness(const Coordinates& X, const Elasticity& material, model::Element element) {
  const FullStiffness K = full_stiffness(X, material, element);
  Stiffness K_e = K.topLeftCorner<24, 24>();
  if (element == model::Element::incompatible) K_e += K.topRightCorner<24, 9>() * condensation(K);
  return (K_e + K_e.transpose()) / 2;
}

Stiffness stiffness_of_part(const Coordinates& X, const Elasticity& material, const Elasticity& part,
                            model::Element element) {
  const FullStiffness K = full_stiffness(X, part, element);
  if (element != model::Element::incompatible) return K.topLeftCorner<24, 24>();
  Eigen::Matrix<double, 3 * kFunctions, 24> T;
  T.topRows<24>().setIdentity();
  T.bottomRows<9>() = condensation(full_stiffness(X, material, element));
  const Eigen::Matrix<double, 3 * kFunctions, 24> KT = K * T;
  const Stiffness K_e = T.transpose() * KT;
  return (K_e + K_e.transpose()) / 2;
}

Mass mass(const Coordinates& X, double rho) {
  Mass M = Mass::Zero();
  for (const Sample& point : mass_points()) {
    const double det = Eigen::Matrix3d(X * point.dN).determinant();
    M += rho * det * point.weight * point.N * point.N.transpose();
  }
  return M;
}

MassWithModes mass_with_modes(const Coordinates& X, double rho) {
  MassWithModes M = MassWithModes::Zero();
  for (const Sample& point : mass_points()) {
    const double det = Eigen::Matrix3d(X * point.dN).determinant();
    Eigen::Matrix<double, kFunctions, 1> f;
    f << point.N, 1 - point.xi.array().square();
    M += rho * det * point.weight * f * f.transpose();
  }
  return M;
}

Amplitudes incompatible_amplitudes(const Coordinates& X, const Elasticity& material) {
  return condensation(full_stiffness(X, material, model::Element::incompatible));
}

StressOperator stress(const Coordinates& X, const Elasticity& material, model::Element element) {
  Amplitudes C = Amplitudes::Zero();
  if (element == model::Element::incompatible) C = condensation(full_stiffness(X, material, element));
  const auto sigma = std::visit([&](const auto& m) { return point_stresses(X, m, element); }, material);
  StressOperator S = StressOperator::Zero();
  for (int p = 0; p < 8; ++p) {
    const Eigen::Matrix<double, 6, 24> at_point = sigma[p].leftCols<24>() + sigma[p].rightCols<9>() * C;
    for (int a = 0; a < 8; ++a) S.middleRows<6>(6 * a) += shape(std::sqrt(3.0) * corner(a))(p) * at_point;
  }
  return S;
}

double volume(const Coordinates& X) {
  double V = 0;
  for (const Sample& point : stiffness_points()) V += Eigen::Matrix3d(X * point.dN).determinant();
  return V;
}

}  // namespace elastogear::fem::hex8
