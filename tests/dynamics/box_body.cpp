#include "box_body.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <numbers>
#include <numeric>

namespace elastogear::test {
namespace {

using Matrix8 = Eigen::Matrix<double, 8, 8>;
using Matrix24 = Eigen::Matrix<double, 24, 24>;
using Eigen::MatrixXd;
using Sparse = Eigen::SparseMatrix<double>;

constexpr int kCorner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                               {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

struct Grid {
  Eigen::Vector3i n;  // nodes per direction
  int node(int i, int j, int k) const { return i + n[0] * (j + n[1] * k); }
  int size() const { return n.prod(); }
};

struct CellMatrices {
  Matrix24 K = Matrix24::Zero();
  Matrix8 M_s = Matrix8::Zero();
};

Eigen::Matrix<double, 6, 6> elasticity(const model::Material& m) {
  const double lambda = m.E * m.nu / ((1 + m.nu) * (1 - 2 * m.nu)), mu = m.E / (2 * (1 + m.nu));
  Eigen::Matrix<double, 6, 6> C = Eigen::Matrix<double, 6, 6>::Zero();
  C.topLeftCorner<3, 3>().setConstant(lambda);
  C.diagonal() << Eigen::Vector3d::Constant(lambda + 2 * mu), Eigen::Vector3d::Constant(mu);
  return C;
}

void add_gauss_point(const Eigen::Vector3d& xi, const Eigen::Vector3d& h, const model::Material& material,
                     CellMatrices& cell) {
  Eigen::Matrix<double, 8, 1> N;
  Eigen::Matrix<double, 6, 24> B = Eigen::Matrix<double, 6, 24>::Zero();
  for (int a = 0; a < 8; ++a) {
    Eigen::Vector3d f, d;
    for (int i = 0; i < 3; ++i) {
      f[i] = kCorner[a][i] ? xi[i] : 1 - xi[i];
      d[i] = (kCorner[a][i] ? 1 : -1) / h[i];
    }
    N[a] = f.prod();
    const double x = d[0] * f[1] * f[2], y = f[0] * d[1] * f[2], z = f[0] * f[1] * d[2];
    B.block<6, 3>(0, 3 * a) << x, 0, 0, 0, y, 0, 0, 0, z, y, x, 0, z, 0, x, 0, z, y;
  }
  const double dV = h.prod() / 8;
  cell.K += dV * B.transpose() * elasticity(material) * B;
  cell.M_s += dV * material.rho * N * N.transpose();
}

CellMatrices cell_matrices(const Eigen::Vector3d& h, const model::Material& material) {
  CellMatrices cell;
  const double a = 0.5 - 0.5 / std::numbers::sqrt3, b = 1 - a;
  for (int p = 0; p < 8; ++p)
    add_gauss_point({p & 1 ? b : a, p & 2 ? b : a, p & 4 ? b : a}, h, material, cell);
  return cell;
}

struct Model {
  Grid grid;
  Eigen::Matrix3Xd X;
  Sparse K, M;  // all dofs
  std::vector<int> free;
};

void assemble(const BoxSpec& spec, const CellMatrices& cell, Model& model) {
  std::vector<Eigen::Triplet<double>> K, M;
  for (int k = 0; k < spec.cells[2]; ++k)
    for (int j = 0; j < spec.cells[1]; ++j)
      for (int i = 0; i < spec.cells[0]; ++i) {
        int node[8];
        for (int a = 0; a < 8; ++a)
          node[a] = model.grid.node(i + kCorner[a][0], j + kCorner[a][1], k + kCorner[a][2]);
        for (int r = 0; r < 24; ++r)
          for (int c = 0; c < 24; ++c) {
            K.emplace_back(3 * node[r / 3] + r % 3, 3 * node[c / 3] + c % 3, cell.K(r, c));
            if (r % 3 == c % 3)
              M.emplace_back(3 * node[r / 3] + r % 3, 3 * node[c / 3] + c % 3, cell.M_s(r / 3, c / 3));
          }
      }
  const int n = 3 * model.grid.size();
  model.K.resize(n, n);
  model.M.resize(n, n);
  model.K.setFromTriplets(K.begin(), K.end());
  model.M.setFromTriplets(M.begin(), M.end());
}

Model make_model(const BoxSpec& spec) {
  Model model;
  model.grid.n = spec.cells + Eigen::Vector3i::Ones();
  model.X.resize(3, model.grid.size());
  const Eigen::Vector3d h = spec.size.cwiseQuotient(spec.cells.cast<double>());
  for (int k = 0; k < model.grid.n[2]; ++k)
    for (int j = 0; j < model.grid.n[1]; ++j)
      for (int i = 0; i < model.grid.n[0]; ++i)
        model.X.col(model.grid.node(i, j, k)) = spec.corner + h.cwiseProduct(Eigen::Vector3d(i, j, k));
  assemble(spec, cell_matrices(h, spec.material), model);
  for (int dof = 0; dof < 3 * model.grid.size(); ++dof)
    if (!spec.held(model.X.col(dof / 3), dof % 3)) model.free.push_back(dof);
  return model;
}

Sparse selection(const Model& model) {
  Sparse S(3 * model.grid.size(), static_cast<int>(model.free.size()));
  for (int j = 0; j < S.cols(); ++j) S.insert(model.free[j], j) = 1;
  return S;
}

// Rigid fields, 3 n_nodes x 6: translations, rotations about the origin.
MatrixXd rigid_fields(const Eigen::Matrix3Xd& X) {
  MatrixXd S = MatrixXd::Zero(3 * X.cols(), 6);
  for (int p = 0; p < X.cols(); ++p)
    for (int i = 0; i < 3; ++i) {
      S(3 * p + i, i) = 1;
      S.block<3, 1>(3 * p, 3 + i) = Eigen::Vector3d::Unit(i).cross(X.col(p));
    }
  return S;
}

model::Inertia inertia(const Model& model, const Sparse& Phi) {
  model::Inertia result;
  const MatrixXd S = rigid_fields(model.X), M_S = model.M * S;
  const Eigen::Matrix<double, 6, 6> M_6 = S.transpose() * M_S;
  result.m = M_6(0, 0);
  result.c = Eigen::Vector3d(M_6(1, 5), M_6(2, 3), M_6(0, 4)) / result.m;
  result.J = M_6.bottomRightCorner<3, 3>();
  const MatrixXd C = Phi.transpose() * M_S;
  result.C_l = C.leftCols<3>();
  result.C_r = C.rightCols<3>();
  result.S_1.resize(9, Phi.cols());
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      Eigen::VectorXd field = Eigen::VectorXd::Zero(model.M.rows());
      for (int p = 0; p < model.X.cols(); ++p) field[3 * p + b] = model.X(a, p);
      result.S_1.row(3 * a + b) = (Phi.transpose() * (model.M * field)).transpose();
    }
  return result;
}

// S^ab over all displacements: the scalar mass between directions a and b.
Sparse mass_between(const Sparse& M, int a, int b) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < M.outerSize(); j += 3)
    for (Sparse::InnerIterator it(M, j); it; ++it)
      if (it.row() % 3 == 0) entries.emplace_back(static_cast<int>(it.row()) + a, j + b, it.value());
  Sparse S(M.rows(), M.cols());
  S.setFromTriplets(entries.begin(), entries.end());
  return S;
}

std::vector<model::BasisRows> second_moments(const Sparse& M, const Sparse& Phi) {
  std::vector<model::BasisRows> S_2;
  for (const auto& [a, b] : {std::pair(0, 0), {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}})
    S_2.push_back(model::SparseRows(Phi.transpose() * mass_between(M, a, b) * Phi));
  return S_2;
}

void add_end_faces(const BoxSpec& spec, const Grid& grid, int group, model::Surface& surface) {
  const int i = group == 0 ? 0 : grid.n[0] - 1;
  for (int k = 0; k < spec.cells[2]; ++k)
    for (int j = 0; j < spec.cells[1]; ++j) {
      Eigen::Vector4i face(grid.node(i, j, k), grid.node(i, j + 1, k), grid.node(i, j + 1, k + 1),
                           grid.node(i, j, k + 1));
      if (group == 0) std::swap(face[1], face[3]);
      surface.face.conservativeResize(4, surface.face.cols() + 1);
      surface.face.rightCols(1) = face;
      surface.group.push_back(group);
    }
}

model::Surface surface(const BoxSpec& spec, const Model& model, const Sparse& Phi) {
  model::Surface surface;
  surface.face.resize(4, 0);
  surface.group_name = {"x_min", "x_max"};
  for (int group : {0, 1}) add_end_faces(spec, model.grid, group, surface);
  std::vector<int> local(model.grid.size(), -1);
  for (int p = 0; p < model.grid.size(); ++p)
    if ((surface.face.array() == p).any()) {
      local[p] = static_cast<int>(surface.node.size());
      surface.node.push_back(p);
    }
  for (int& p : surface.face.reshaped()) p = local[p];
  surface.X = model.X(Eigen::all, surface.node);
  surface.c_f.setConstant(surface.face.cols(), spec.material.E * spec.cells[0] / spec.size[0]);
  Sparse select(3 * static_cast<int>(surface.node.size()), model.M.rows());
  for (int r = 0; r < select.rows(); ++r) select.insert(r, 3 * surface.node[r / 3] + r % 3) = 1;
  surface.Phi = model::SparseRows(select * Phi);
  return surface;
}

model::ElasticBody full_box(const BoxSpec& spec) {
  const Model model = make_model(spec);
  const Sparse Phi = selection(model);
  model::ElasticBody body;
  body.name = "box";
  body.basis = model::Basis::full;
  body.inertia = inertia(model, Phi);
  body.inertia.S_2 = second_moments(model.M, Phi);
  body.M_r = Phi.transpose() * model.M * Phi;
  body.K_r = Phi.transpose() * model.K * Phi;
  body.surface = surface(spec, model, Phi);
  return body;
}

// Columns of V as the new basis.
void project(model::ElasticBody& body, const MatrixXd& V) {
  body.basis = model::Basis::modal;
  body.inertia.C_l = V.transpose() * MatrixXd(body.inertia.C_l);
  body.inertia.C_r = V.transpose() * MatrixXd(body.inertia.C_r);
  body.inertia.S_1 = MatrixXd(body.inertia.S_1) * V;
  for (model::BasisRows& S : body.inertia.S_2)
    S = model::DenseRows(V.transpose() * (std::get<model::SparseRows>(S) * V));
  body.surface.Phi = model::DenseRows(std::get<model::SparseRows>(body.surface.Phi) * V);
}

}  // namespace

model::ElasticBody make_box(const BoxSpec& spec, model::Basis basis, int n_modes) {
  model::ElasticBody body = full_box(spec);
  if (basis == model::Basis::full) return body;
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> modes{MatrixXd(body.K_r), MatrixXd(body.M_r)};
  const auto n = n_modes > 0 ? n_modes : body.n_q() - spec.rigid_modes;
  return in_modes(std::move(body), modes.eigenvectors().middleCols(spec.rigid_modes, n),
                  modes.eigenvalues().segment(spec.rigid_modes, n).cwiseMax(0));
}

model::ElasticBody in_modes(model::ElasticBody full, const MatrixXd& V, const Eigen::VectorXd& lambda) {
  project(full, V);
  full.frequency = lambda.cwiseSqrt() / (2 * std::numbers::pi);
  full.M_r = Eigen::VectorXd::Ones(lambda.size()).asDiagonal();
  full.K_r = lambda.asDiagonal();
  return full;
}

void set_flexibility(model::ElasticBody& body, const MatrixXd& F) {
  const auto n = static_cast<int>(body.surface.node.size());
  model::Flexibility& flexibility = body.flexibility;
  flexibility.node.resize(n);
  std::iota(flexibility.node.begin(), flexibility.node.end(), 0);
  flexibility.surface = model::no_images(n);
  flexibility.stress = model::no_images(0);
  flexibility.F = F.cast<float>();
  model::set_self(flexibility);
}

model::ElasticBody make_flexible_box(const BoxSpec& spec, int n_modes) {
  const model::ElasticBody full = full_box(spec);
  model::ElasticBody body = make_box(spec, model::Basis::modal, n_modes);
  const MatrixXd Phi = std::get<model::SparseRows>(full.surface.Phi);
  set_flexibility(body, Phi * MatrixXd(full.K_r).ldlt().solve(Phi.transpose()));
  return body;
}

std::shared_ptr<model::ElasticBody> make_damped_box(const Eigen::Vector3d& corner,
                                                    const Eigen::Vector3i& cells, model::Basis basis,
                                                    int n_modes) {
  const BoxSpec spec{.corner = corner, .size = {2, 1, 1}, .cells = cells, .material = {100, 0.3, 1}};
  auto body = std::make_shared<model::ElasticBody>(make_box(spec, basis, n_modes));
  body->alpha = 0.1;
  body->beta = 0.01;
  return body;
}

model::ElasticBody make_rigid_box(const BoxSpec& spec) {
  model::ElasticBody body = full_box(spec);
  project(body, MatrixXd(body.n_q(), 0));
  body.M_r = body.K_r = Sparse(0, 0);
  return body;
}

Eigen::VectorXd uniform_velocity(const model::ElasticBody& body, const Eigen::Vector3d& v) {
  const Eigen::SimplicialLDLT<Sparse> M_r(body.M_r);
  return M_r.solve(body.inertia.C_l * v);
}

}  // namespace elastogear::test
