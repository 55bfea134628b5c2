#include "fem/surface/surface_stress.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "elastogear/base/tensor.h"
#include "elastogear/fem/material.h"

namespace elastogear::fem {
namespace {

constexpr int kTerms = 6;            // of a polynomial of degree 2 in two variables
constexpr int kPatchNodes = 9;       // nodes of a patch, so that errors of single displacements are smoothed
constexpr int kMostRings = 3;        // of faces around a node
constexpr double kWellPosed = 1e-4;  // smallest eigenvalue of the fit's matrix in normalised coordinates
constexpr double kRidge = 1e-6;      // weight of curvature where the nodes do not determine it
constexpr double kOnOneLine = 1e-8;  // least square of the width over that of the length of a patch
constexpr int kPasses = 2;           // that improve the normal

using Eigen::Matrix2d, Eigen::Matrix3d, Eigen::Vector3d;

// Derivatives along two directions in the tangent plane from values at nodes.
struct SurfaceDerivative {
  std::vector<int> node;
  Eigen::Matrix2Xd D;  // 2 x n, 1/m
  Vector3d n, t_1, t_2;
};

// Positions of nodes in a plane, in coordinates z of unit variance about their mean: x = L z.
struct Patch {
  std::vector<int> node;
  Eigen::Matrix2Xd z;
  Eigen::VectorXd height;  // m, above the plane
  Matrix2d L;
};

std::optional<Patch> make_patch(std::vector<int> node, const Eigen::Matrix3Xd& X, const Vector3d& origin,
                                const SurfaceDerivative& plane) {
  const Eigen::Matrix3Xd d = X(Eigen::all, node).colwise() - origin;
  Eigen::Matrix2Xd x(2, d.cols());
  x << plane.t_1.transpose() * d, plane.t_2.transpose() * d;
  const Eigen::Matrix2Xd about_mean = x.colwise() - Eigen::Vector2d(x.rowwise().mean());
  const Matrix2d variance = about_mean * about_mean.transpose() / static_cast<double>(d.cols());
  const Eigen::SelfAdjointEigenSolver<Matrix2d> axes(variance, Eigen::EigenvaluesOnly);
  if (!(axes.eigenvalues()[0] > kOnOneLine * axes.eigenvalues()[1])) return {};
  const Matrix2d L = variance.llt().matrixL();
  return Patch{std::move(node), L.triangularView<Eigen::Lower>().solve(x), d.transpose() * plane.n, L};
}

// Terms of degree 0, 1 and 2. The mixed one is scaled so that the sum of squares of the quadratic ones is the
// same in all axes.
Eigen::Matrix<double, kTerms, Eigen::Dynamic> polynomials(const Eigen::Matrix2Xd& z) {
  Eigen::Matrix<double, kTerms, Eigen::Dynamic> P(kTerms, z.cols());
  const auto x = z.row(0).array(), y = z.row(1).array();
  P.row(0).setOnes();
  P.middleRows<2>(1) = z;
  P.row(3) = x.square();
  P.row(4) = std::sqrt(2.0) * x * y;
  P.row(5) = y.square();
  return P;
}

using FitMatrix = Eigen::Matrix<double, kTerms, kTerms>;

FitMatrix fit_matrix(const Patch& patch) {
  const auto P = polynomials(patch.z);
  return P * P.transpose() / static_cast<double>(P.cols());
}

bool is_well_posed(const Patch& patch) {
  const Eigen::SelfAdjointEigenSolver<FitMatrix> modes(fit_matrix(patch), Eigen::EigenvaluesOnly);
  return patch.node.size() >= kPatchNodes && modes.eigenvalues()[0] > kWellPosed;
}

// Derivatives at the origin of the polynomial of degree 2 that fits values at the nodes best. Where they
// leave the curvature open it is the least one. docs/theory, Eq. (1.14).
Eigen::Matrix2Xd derivatives(const Patch& patch, bool well_posed) {
  const auto P = polynomials(patch.z);
  FitMatrix N = fit_matrix(patch);
  if (!well_posed) N.diagonal().tail<3>().array() += kRidge;
  const Eigen::Matrix<double, kTerms, 2> slopes =
      N.ldlt().solve(FitMatrix::Identity().middleCols<2>(1));  // of the fit, per P times values
  const Eigen::Matrix2Xd along_z = slopes.transpose() * P / static_cast<double>(P.cols());
  return patch.L.transpose().triangularView<Eigen::Upper>().solve(along_z);
}

void set_plane(SurfaceDerivative& plane, const Vector3d& n) {
  plane.n = n.normalized();
  plane.t_1 = plane.n.unitOrthogonal();
  plane.t_2 = plane.n.cross(plane.t_1);
}

// The smallest patch that determines all terms; where none does, the smallest one.
std::optional<SurfaceDerivative> surface_derivative(const FreeSurface& surface, const Eigen::Matrix3Xd& X,
                                                    const Sheet& sheet, int node) {
  SurfaceDerivative result;
  set_plane(result, sheet.n);
  std::optional<Patch> patch;
  bool well_posed = false;
  for (int rings = 1; rings <= kMostRings && !well_posed; ++rings) {
    auto wider = make_patch(surface.patch(sheet, rings), X, X.col(node), result);
    if (!wider) continue;
    well_posed = is_well_posed(*wider);
    if (!patch || well_posed) patch = std::move(wider);
  }
  if (!patch) return {};
  for (int pass = 0; pass < kPasses; ++pass) {
    const Eigen::Vector2d slope = derivatives(*patch, well_posed) * patch->height;
    set_plane(result, result.n - slope[0] * result.t_1 - slope[1] * result.t_2);
    patch = make_patch(patch->node, X, X.col(node), result);
    if (!patch) return {};
  }
  result.D = derivatives(*patch, well_posed);
  result.node = std::move(patch->node);
  return result;
}

Matrix3d symmetric_product(const Vector3d& a, const Vector3d& b) {
  return (a * b.transpose() + b * a.transpose()) / 2;
}

// Stress per strain in the directions of the tensors G (six entries each): the others are without traction.
// docs/theory, Eq. (1.15).
template <int k>
Eigen::Matrix<double, 6, k> stress_per_strain(const Eigen::Matrix<double, 6, k>& G, const Matrix6& H) {
  const Eigen::Matrix<double, 6, k> compliance = H.ldlt().solve(G);
  return G * (G.transpose() * compliance).inverse();
}

// The projection of stresses on those that have no traction and the same strains in the directions of the
// tensors G (six entries each). docs/theory, Eq. (1.16a).
template <int k>
Matrix6 within(const Eigen::Matrix<double, 6, k>& G, const Matrix6& H) {
  return stress_per_strain(G, H) * H.ldlt().solve(G).transpose();
}

// Stress of a surface with the traction of its normal zero.
SurfaceRows rows_of_plane(const SurfaceDerivative& d, const Matrix6& H) {
  Eigen::Matrix<double, 6, 3> G;
  G << six_entries(symmetric_product(d.t_1, d.t_1)), six_entries(symmetric_product(d.t_2, d.t_2)),
      2 * six_entries(symmetric_product(d.t_1, d.t_2));
  Eigen::Matrix3Xd strain(3, 3 * d.D.cols());  // 11, 22, 2 x 12
  for (Eigen::Index i = 0; i < d.D.cols(); ++i)
    strain.middleCols<3>(3 * i) << d.D(0, i) * d.t_1.transpose(), d.D(1, i) * d.t_2.transpose(),
        d.D(0, i) * d.t_2.transpose() + d.D(1, i) * d.t_1.transpose();
  return {d.node, stress_per_strain(G, H) * strain, within(G, H)};
}

// Stress at an edge of two surfaces, along it alone: the strain is the mean of theirs.
SurfaceRows rows_of_edge(const std::vector<SurfaceDerivative>& sheets, const Matrix6& H) {
  const Vector3d t = sheets[0].n.cross(sheets[1].n).normalized();
  const Eigen::Matrix<double, 6, 1> G = six_entries(t * t.transpose()), stiffness = stress_per_strain(G, H);
  SurfaceRows rows{{}, {}, within(G, H)};
  Eigen::RowVectorXd strain;
  for (const SurfaceDerivative& d : sheets) {
    const Eigen::RowVectorXd along = Eigen::RowVector2d(t.dot(d.t_1), t.dot(d.t_2)) * d.D / 2;
    const Eigen::Index begin = strain.size();
    strain.conservativeResize(begin + 3 * along.size());
    for (Eigen::Index i = 0; i < along.size(); ++i)
      strain.segment<3>(begin + 3 * i) = along[i] * t.transpose();
    rows.node.insert(rows.node.end(), d.node.begin(), d.node.end());
  }
  rows.S = stiffness * strain;
  return rows;
}

}  // namespace

std::optional<SurfaceRows> surface_stress(const FreeSurface& surface, const Eigen::Matrix3Xd& X,
                                          const model::Material& material, int node) {
  const std::vector<Sheet> sheets = surface.sheets(node);
  if (sheets.empty()) return {};
  if (sheets.size() > 2) return SurfaceRows{};
  std::vector<SurfaceDerivative> derivative;
  for (const Sheet& sheet : sheets) {
    auto of_sheet = surface_derivative(surface, X, sheet, node);
    if (!of_sheet) return {};
    derivative.push_back(std::move(*of_sheet));
  }
  const Matrix6 H = elasticity_matrix(material, X.col(node));
  return sheets.size() == 1 ? rows_of_plane(derivative[0], H) : rows_of_edge(derivative, H);
}

}  // namespace elastogear::fem
