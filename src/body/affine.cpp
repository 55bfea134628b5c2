#include "elastogear/body/affine.h"

#include <Eigen/Eigenvalues>

namespace elastogear::body {
namespace {

using Eigen::Index;
using Eigen::Matrix4d;
using Eigen::MatrixXd;

constexpr double kNoMass = 1e-12;  // of a field of mass one: a direction without extension

// Integral of rho f f' dV with f = (1, X).
Matrix4d gram(const model::Inertia& inertia) {
  Matrix4d N;
  const Eigen::Vector3d S = inertia.m * inertia.c;
  N << inertia.m, S.transpose(), S, 0.5 * inertia.J.trace() * Eigen::Matrix3d::Identity() - inertia.J;
  return N;
}

// T with T N T' = I, but for rows of zeros.
Matrix4d orthonormalising(const Matrix4d& N) {
  const Eigen::Vector4d scale = N.diagonal().unaryExpr([](double n) { return n > 0 ? 1 / std::sqrt(n) : 0; });
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(MatrixXd(scale.asDiagonal() * N * scale.asDiagonal()));
  const Eigen::Vector4d weight =
      eigen.eigenvalues().unaryExpr([](double n) { return n > kNoMass ? 1 / std::sqrt(n) : 0; });
  return weight.asDiagonal() * eigen.eigenvectors().transpose() * scale.asDiagonal();
}

// Integral of rho f phi_kb dV, 4 x n_q.
MatrixXd moments(const model::Inertia& inertia, int b) {
  MatrixXd K(4, inertia.S_1.cols());
  K << inertia.C_l.col(b).transpose(), inertia.S_1.row(b), inertia.S_1.row(3 + b), inertia.S_1.row(6 + b);
  return K;
}

// Integral of rho f_j u_b dV = sum_i L(j, i) y[4 b + i]
void set_first_moments(const Matrix4d& L, model::Inertia& inertia) {
  inertia.C_l.setZero(12, 3);
  inertia.C_r.resize(12, 3);
  inertia.S_1.setZero(9, 12);
  for (int b : {0, 1, 2}) {
    inertia.C_l.col(b).segment<4>(4 * b) = L.row(0);
    for (int a : {0, 1, 2}) inertia.S_1.row(3 * a + b).segment<4>(4 * b) = L.row(1 + a);
  }
  for (int a : {0, 1, 2}) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    inertia.C_r.col(a) = inertia.S_1.row(3 * b + c) - inertia.S_1.row(3 * c + b);
  }
}

}  // namespace

Eigen::MatrixXd mean_gradient(const model::Inertia& inertia) {
  const Matrix4d T = orthonormalising(gram(inertia)), N_inverse = T.transpose() * T;
  MatrixXd G(9, inertia.S_1.cols());
  for (int a : {0, 1, 2})
    for (int b : {0, 1, 2}) G.row(3 * a + b) = N_inverse.row(1 + a) * moments(inertia, b);
  return G;
}

AffinePart affine_part(const model::Inertia& inertia) {
  const Matrix4d N = gram(inertia), T = orthonormalising(N), L = N * T.transpose();
  AffinePart part;
  part.Y.resize(inertia.S_1.cols(), 12);
  for (int b : {0, 1, 2}) part.Y.middleCols<4>(4 * b) = (T * moments(inertia, b)).transpose();
  part.inertia.m = inertia.m;
  part.inertia.c = inertia.c;
  part.inertia.J = inertia.J;
  set_first_moments(L, part.inertia);
  return part;
}

}  // namespace elastogear::body
