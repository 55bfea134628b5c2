#include "reduction/bases/ritz.h"

#include <algorithm>
#include <cmath>

#include "reduction/dense/dense_eigenproblem.h"
#include "reduction/dense/residual.h"
#include "reduction/eigensolver/krylov_basis.h"

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kDependent = 1e-7;  // relative, energy norm: its square is 100 roundoffs of the Gram matrix
constexpr int kPasses = 2;           // the second one repairs what dividing by 1e-7 loses
constexpr int kFormedTogether = 32;  // vectors that are formed together

// Columns of unit energy; those without any stay.
void scale_to_unit_energy(const RitzSpace& space, MatrixXd& W) {
  const MatrixXd own = W.cwiseProduct((*space.K)(W)).colwise().sum();
  const MatrixXd energy = sum(space.K->comm(), own);
  for (Index j = 0; j < W.cols(); ++j)
    if (energy(0, j) > 0) W.col(j) /= std::sqrt(energy(0, j));
}

void project_out(const RitzSpace& space, MatrixXd& W) {
  if (space.size == 0) return;
  const MatrixXd C = sum(space.K->comm(), space.V.dot(space.size, (*space.K)(W)));
  space.V.add_product(0, -C, W);
}

// U such that the columns of W U are orthonormal and span those of W, by Gram and Schmidt on G = W' K W.
MatrixXd orthonormaliser(const MatrixXd& G) {
  MatrixXd U(G.rows(), G.cols());
  Index n = 0;
  for (Index j = 0; j < G.cols(); ++j) {
    const auto before = U.leftCols(n);
    const VectorXd u = VectorXd::Unit(G.cols(), j) - before * (before.transpose() * G.col(j));
    const double rest = u.dot(G * u);
    if (rest > kDependent * kDependent) U.col(n++) = u / std::sqrt(rest);
  }
  return U.leftCols(n);
}

// Mass projected on the space, V' M V.
MatrixXd projected_mass(const RitzSpace& space) {
  MatrixXd own(space.size, space.size);
  for (int begin = 0; begin < space.size; begin += kFormedTogether) {
    const int n = std::min(kFormedTogether, space.size - begin);
    MatrixXd columns = MatrixXd::Zero(space.V.n_rows(), n);
    space.V.add_product(begin, MatrixXd::Identity(n, n), columns);
    own.middleCols(begin, n) = space.V.dot(space.size, (*space.M)(columns));
  }
  return sum(space.M->comm(), own);
}

double largest_off_diagonal(MatrixXd G) {
  G.diagonal().setZero();
  return G.lpNorm<Eigen::Infinity>();
}

}  // namespace

RitzSpace make_space(const BlockProduct& K, const BlockProduct& M, int capacity) {
  return {&K, &M, TallBasis(K.n_own(), capacity), 0};
}

MatrixXd extend(RitzSpace& space, MatrixXd W, int most) {
  scale_to_unit_energy(space, W);
  for (int pass = 0; pass < kPasses && W.cols() > 0; ++pass) {
    project_out(space, W);
    const MatrixXd G = inner(space.K->comm(), W, (*space.K)(W));
    W = (W * orthonormaliser(G)).eval();
  }
  if (W.cols() > most) W = W.leftCols(most).eval();
  if (W.cols() > 0) space.V.set(space.size, W);
  space.size += static_cast<int>(W.cols());
  return W;
}

// V' K V = I: the eigenvalues of V' M V are 1/lambda.
RitzVectors ritz_vectors(const RitzSpace& space) {
  const MatrixXd M_r = projected_mass(space);
  MatrixXd s = M_r;
  const VectorXd inverse = diagonalise(s).reverse();
  RitzVectors ritz{inverse.cwiseInverse(), s.rowwise().reverse()};
  ritz.s *= ritz.eigenvalue.cwiseSqrt().asDiagonal();
  ritz.orthogonality = largest_off_diagonal(ritz.s.transpose() * M_r * ritz.s);
  return ritz;
}

MatrixXd combine(const RitzSpace& space, const Eigen::Ref<const MatrixXd>& s) {
  MatrixXd phi = MatrixXd::Zero(space.V.n_rows(), s.cols());
  space.V.add_product(0, s, phi);
  return phi;
}

Eigenmodes deliver(const RitzSpace& space, const RitzVectors& ritz, Mat K, Mat M, const ModeSink& sink) {
  Eigenmodes modes{VectorXd(space.size), VectorXd(space.size), ritz.orthogonality};
  const Residual w = make_residual(K);
  for (int begin = 0; begin < space.size; begin += kFormedTogether) {
    const MatrixXd phi =
        combine(space, ritz.s.middleCols(begin, std::min(kFormedTogether, space.size - begin)));
    for (int j = 0; j < phi.cols(); ++j) {
      const int k = begin + j;
      load(w.phi, phi.col(j));
      measure(K, M, w, &modes.eigenvalue(k), &modes.residual(k));
      sink(k, w.phi);
    }
  }
  return modes;
}

}  // namespace elastogear::reduction
