#include "elastogear/model/elastic_body.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "elastogear/base/error.h"
#include "elastogear/base/finite.h"
#include "elastogear/model/row_products.h"
#include "elastogear/model/validate_rows.h"

namespace elastogear::model {
namespace {

constexpr double kUnit = 1e-9;  // roundoff of a unit vector in a file

template <class Rows>
bool finite(const Rows& rows) {
  if constexpr (std::is_same_v<Rows, DenseRows>) {
    return all_finite(rows);
  } else {
    return all_finite(rows.valuePtr(), rows.nonZeros());
  }
}

bool finite(const BasisRows& rows) {
  return with_rows(rows, [](const auto& r) { return finite(r); });
}

bool in_range(const std::vector<int>& numbers, int n) {
  return std::all_of(numbers.begin(), numbers.end(), [n](int i) { return i >= 0 && i < n; });
}

void validate_inertia(const Inertia& inertia, Eigen::Index n_q, const std::string& source) {
  require(std::isfinite(inertia.m) && inertia.m > 0, source, ": mass is ", inertia.m,
          " kg, must be positive");
  require(inertia.c.allFinite() && inertia.J.allFinite(), source,
          ": centre of mass or inertia is not finite");
  require(inertia.C_l.rows() == n_q && inertia.C_r.rows() == n_q && inertia.S_1.cols() == n_q, source,
          ": C_l, C_r, S_1 do not have n_q = ", n_q, " entries");
  require(inertia.C_l.allFinite() && inertia.C_r.allFinite() && inertia.S_1.allFinite(), source,
          ": inertia coupling terms are not finite");
  require(inertia.S_2.empty() || inertia.S_2.size() == 6, source, ": S_2 has ", inertia.S_2.size(),
          " matrices, must have none or 6");
  for (const BasisRows& S : inertia.S_2)
    require(row_count(S) == n_q && column_count(S) == n_q && finite(S), source,
            ": S_2 is not finite or not square of size n_q = ", n_q);
}

// Returns whether the side of a cell is left out or has six or eight nodes, with those of the face among
// them.
bool is_side_of(const Eigen::Vector4i& face, const Eigen::Matrix<int, 8, 1>& side, int n_nodes) {
  const int* end = std::find(side.data(), side.data() + side.size(), -1);
  const auto n = end - side.data();
  if (n == 0) return true;
  return (n == 6 || n == 8) &&
         std::all_of(side.data(), end, [&](int node) { return node >= 0 && node < n_nodes; }) &&
         std::all_of(face.begin(), face.end(),
                     [&](int node) { return std::find(side.data(), end, node) != end; });
}

void validate_surface(const Surface& surface, Eigen::Index n_q, const std::string& source) {
  const auto n_s = static_cast<int>(surface.node.size());
  const auto n_f = surface.face.cols();
  require(surface.X.cols() == n_s && row_count(surface.Phi) == 3 * n_s, source,
          ": surface arrays do not all have ", n_s, " nodes");
  require(column_count(surface.Phi) == n_q || n_s == 0, source, ": surface basis does not have n_q = ", n_q,
          " columns");
  require(n_f == 0 || (surface.face.minCoeff() >= 0 && surface.face.maxCoeff() < n_s), source,
          ": surface face names a node outside 0..", n_s - 1);
  require(surface.side.cols() == 0 || surface.side.cols() == n_f, source, ": surface sides do not have ", n_f,
          " entries");
  for (Eigen::Index f = 0; f < surface.side.cols(); ++f)
    require(is_side_of(surface.face.col(f), surface.side.col(f), n_s), source, ": surface face ", f,
            " is no part of its second-order side");
  require(static_cast<Eigen::Index>(surface.group.size()) == n_f && surface.c_f.size() == n_f, source,
          ": surface groups or stiffnesses do not have ", n_f, " entries");
  require(in_range(surface.group, static_cast<int>(surface.group_name.size())), source,
          ": surface group number out of range");
  require(surface.X.allFinite() && surface.c_f.allFinite(), source, ": surface data is not finite");
}

void validate_stress(const Stress& stress, Eigen::Index n_q, const std::string& source) {
  const auto n_e = static_cast<int>(stress.node.size());
  require(stress.X.cols() == n_e && row_count(stress.Psi) == 6 * n_e, source,
          ": stress arrays do not all have ", n_e, " nodes");
  require(column_count(stress.Psi) == n_q || n_e == 0, source, ": stress modes do not have n_q = ", n_q,
          " columns");
  for (const auto& [name, members] : stress.sets)
    require(in_range(members, n_e), source, ": stress set '", name, "' names a node outside 0..", n_e - 1);
}

void validate_markers(const std::vector<Marker>& markers, Eigen::Index n_q, const std::string& source) {
  std::set<std::string> names = {kFrameMarker};
  for (const Marker& marker : markers) {
    require(!marker.name.empty() && names.insert(marker.name).second, source, ": two markers are named '",
            marker.name, "'");
    require(marker.X.allFinite() && finite(marker.Phi), source, ": marker '", marker.name, "' is not finite");
    require(row_count(marker.Phi) == 6 && column_count(marker.Phi) == n_q, source, ": marker '", marker.name,
            "' does not have 6 rows of n_q = ", n_q, " entries");
  }
}

void validate_relaxed_responses(const ElasticBody& body, const std::string& source) {
  const Flexibility& f = body.flexibility;
  const auto n_c = static_cast<Eigen::Index>(f.node.size()),
             n_p = static_cast<Eigen::Index>(body.relaxing.size()),
             n_s = static_cast<Eigen::Index>(f.relaxed.size());
  require(f.creep >= -1 && f.creep < n_p, source, ": the static responses creep by relaxing part ", f.creep,
          ", there are ", n_p);
  if (n_s == 0) return;
  require(f.creep < 0 && f.law.rows() == n_s && f.law.cols() == n_p && (f.law.array() >= 0).all() &&
              (f.law.rowwise().sum().array() <= 1 + kUnit).all(),
          source, ": the laws by which static responses creep are not those of ", n_s, " relaxed states and ",
          n_p, " relaxing parts");
  for (const RelaxedResponse& relaxed : f.relaxed)
    require(relaxed.share.size() == n_p && (relaxed.share.array() >= 0).all() &&
                (relaxed.share.array() < 1).all() && relaxed.self.size() == f.self.size() &&
                relaxed.self.allFinite() && (relaxed.self.array() >= 0).all() &&
                (relaxed.F.size() == 0
                     ? relaxed.read_F != nullptr
                     : relaxed.F.rows() == 3 * n_c && relaxed.F.cols() == 3 * f.surface.node.cols()) &&
                all_finite(relaxed.F),
            source, ": the static responses of a relaxed state do not fit those of the instantaneous body");
}

void validate_flexibility(const ElasticBody& body, const std::string& source) {
  const Flexibility& f = body.flexibility;
  if (f.empty()) return;
  const auto n_c = static_cast<Eigen::Index>(f.node.size()), n_r = f.stress.node.size();
  const std::size_t n_e = body.stress.node.size();
  require(body.basis == Basis::modal, source, ": static responses belong to a modal basis");
  require(std::is_sorted(f.node.begin(), f.node.end()) &&
              in_range(f.node, static_cast<int>(body.surface.node.size())),
          source, ": loaded nodes of the flexibility must ascend within the surface");
  require(f.surface.node.size() == n_c && (f.stress_row.size() == n_e || n_e == 0) &&
              in_range(f.stress_row, static_cast<int>(n_r)) && f.surface.node.rows() == f.n_sectors &&
              f.stress.node.rows() == f.n_sectors && std::abs(f.axis.norm() - 1) < kUnit,
          source, ": the symmetry of the flexibility does not fit the body");
  require(f.self.size() == f.surface.node.cols() && f.self.allFinite() && (f.self.array() >= 0).all(), source,
          ": each loaded orbit needs the size of its own answer, finite and not negative");
  const Eigen::Index n_columns = 3 * f.surface.node.cols(),
                     n_states = 1 + static_cast<Eigen::Index>(f.relaxed.size());
  require((f.F.size() == 0 ? f.read_F != nullptr : f.F.rows() == 3 * n_c && f.F.cols() == n_columns) &&
              (f.G.size() == 0 || (f.G.rows() == 6 * n_r * n_states && f.G.cols() == n_columns)),
          source, ": F or G does not have a row for each node and a column for each force");
  require(all_finite(f.F) && all_finite(f.G), source, ": static responses are not finite");
  validate_relaxed_responses(body, source);
}

void validate_relaxing(const ElasticBody& body, const std::string& source) {
  const Eigen::Index n_q = body.n_q();
  for (const RelaxingPart& part : body.relaxing) {
    const std::string who = source + ": relaxing part of the cell set '" + part.cell_set + "'";
    require(part.g.size() > 0 && part.tau.size() == part.g.size(), who,
            ": each relative modulus needs a time");
    require(part.g.allFinite() && (part.g.array() >= 0).all() && part.g.sum() < 1, who,
            ": relative moduli must not be negative, and their sum stay below 1");
    require(part.tau.allFinite() && (part.tau.array() > 0).all(), who, ": relaxation times must be positive");
    require(part.K.rows() == n_q && part.K.cols() == n_q, who,
            ": the stiffness is not square of size n_q = ", n_q);
    const auto n_e = static_cast<int>(body.stress.node.size());
    require(n_e == 0 || in_range(part.stress_node, n_e), who, " names a stress node outside 0..", n_e - 1);
  }
}

}  // namespace

Eigen::Index row_count(const BasisRows& rows) {
  return std::visit([](const auto& r) { return r.rows(); }, rows);
}

Eigen::Index column_count(const BasisRows& rows) {
  return std::visit([](const auto& r) { return r.cols(); }, rows);
}

const DenseRows* dense_rows(const BasisRows& rows) {
  if (const auto* lazy = std::get_if<LazyRows>(&rows)) return &lazy->all();
  return std::get_if<DenseRows>(&rows);
}

const RowBounds* known_bounds(const BasisRows& rows) {
  const auto* lazy = std::get_if<LazyRows>(&rows);
  return lazy ? &lazy->bounds() : nullptr;
}

const double* node_rows(const BasisRows& Phi, int node) {
  if (const auto* lazy = std::get_if<LazyRows>(&Phi)) return lazy->node(node);
  return std::get<DenseRows>(Phi).row(3 * node).data();
}

Eigen::VectorXd multiply(const BasisRows& rows, const Eigen::VectorXd& q) {
  return with_rows(rows, [&](const auto& r) -> Eigen::VectorXd { return r * q; });
}

Eigen::VectorXd multiply_transposed(const BasisRows& rows, const Eigen::VectorXd& x) {
  return with_rows(rows, [&](const auto& r) -> Eigen::VectorXd { return r.transpose() * x; });
}

// Surfaces of bodies without elastic coordinates may lack the rows of Phi.
Eigen::Vector3d displacement(const BasisRows& Phi, int node, const Eigen::VectorXd& q) {
  if (q.size() == 0) return Eigen::Vector3d::Zero();
  if (const auto* sparse = std::get_if<SparseRows>(&Phi)) return sparse->middleRows(3 * node, 3) * q;
  return three_products(node_rows(Phi, node), q.data(), q.size());
}

void add_force(const BasisRows& Phi, int node, const Eigen::Vector3d& f, Eigen::Ref<Eigen::VectorXd> h) {
  if (h.size() == 0) return;
  if (const auto* sparse = std::get_if<SparseRows>(&Phi)) {
    h += sparse->middleRows(3 * node, 3).transpose() * f;
    return;
  }
  add_three_rows(node_rows(Phi, node), f, h.data(), h.size());
}

Eigen::Matrix3d J_1(const Inertia& inertia, int k) {
  // S(a, b) = integral of rho X_a phi_b dV;  J_1 = 2 tr(S) I - S - S'
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> S(inertia.S_1.col(k).data());
  return 2 * S.trace() * Eigen::Matrix3d::Identity() - S - S.transpose();
}

void validate_except_rows(const ElasticBody& body, const std::string& source) {
  const Eigen::Index n_q = body.n_q();
  require(n_q >= 0 && body.K_r.cols() == n_q && body.M_r.rows() == n_q && body.M_r.cols() == n_q, source,
          ": reduced matrices are not square of size n_q = ", n_q);
  require(body.n_attachments >= 0 && body.n_attachments <= n_q, source, ": ", body.n_attachments, " of ", n_q,
          " coordinates are attachment modes");
  require(body.alpha >= 0 && body.beta >= 0, source, ": damping alpha = ", body.alpha, ", beta = ", body.beta,
          " must not be negative");
  require(body.zeta.size() == 0 ||
              (body.zeta.size() == n_q && body.zeta.allFinite() && (body.zeta.array() >= 0).all()),
          source, ": there must be n_q = ", n_q, " damping ratios, finite and not negative, or none");
  require(body.zeta.size() == 0 || body.frequency.size() == n_q, source,
          ": damping ratios need modes; the full basis takes Rayleigh's alpha and beta only");
  validate_inertia(body.inertia, n_q, source);
  validate_surface(body.surface, n_q, source);
  validate_stress(body.stress, n_q, source);
  validate_markers(body.markers, n_q, source);
  validate_flexibility(body, source);
  validate_relaxing(body, source);
}

void validate(const ElasticBody& body, const std::string& source) {
  validate_except_rows(body, source);
  require(finite(body.surface.Phi), source, ": surface data is not finite");
  require(finite(body.stress.Psi), source, ": stress modes are not finite");
}

}  // namespace elastogear::model
