#include "reduction/cyclic/harmonic_krylov.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "reduction/dense/residual.h"
#include "reduction/eigensolver/krylov_basis.h"
#include "reduction/eigensolver/window_size.h"

namespace elastogear::reduction {
namespace {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kShift = 0;        // amid the modes it would leave the lowest ones more roundoff
constexpr int kBlock = 4;           // vectors of a harmonic
constexpr double kGrowth = 1.02;    // of the basis between two computations of its Ritz values
constexpr double kFirstLook = 0.2;  // of the basis that is expected to do: when they are first looked at

struct Products {
  BlockProduct K, M;

  explicit Products(const fem::Matrices& matrices)
      : K(matrices.K), M(matrices.M, BlockProduct::Storage::without_zeros) {}
};

// The search for the modes of a harmonic: its blocks go through the factor, and come back.
class HarmonicSearch {
 public:
  virtual ~HarmonicSearch() = default;
  virtual const HarmonicFactor& factor() const = 0;
  virtual const MatrixXd& forces() const = 0;  // that are to go through the factor next
  virtual void take(MatrixXd displacements) = 0;
  virtual bool finished() const = 0;  // or there is no more room
  virtual double share() const = 0;   // of the basis that is filled
  virtual std::optional<HarmonicModes> modes() const = 0;
};

// Scalar: of amplitudes.
template <class Scalar>
class SearchOver final : public HarmonicSearch {
 public:
  SearchOver(const Products& products, CondensedSector& condensed, const HarmonicTask& task,
             const BelowCutoff& wanted)
      : products_(products), task_(task), wanted_(wanted), factor_(condensed, *task.harmonic) {
    const int n = task.harmonic->size() / kParts<Scalar>,
              block = std::min(wanted.block > 0 ? wanted.block : kBlock, n),
              room =
                  std::min(n, columns_with_room({task.n_modes, block}, n, std::numeric_limits<int>::max())) +
                  block;
    next_look_ = kFirstLook * needed_columns(task.n_modes, block);
    V_ = TallBasis(products.M.n(), room * kParts<Scalar>);
    factor_.factorise(kShift);
    forces_ = random_forces(products.M, block * kParts<Scalar>);
  }

  const HarmonicFactor& factor() const override { return factor_; }
  const MatrixXd& forces() const override { return started_ ? basis_.M_next : forces_; }
  bool finished() const override { return started_ && (is_complete() || !has_room(basis_)); }
  double share() const override { return static_cast<double>(basis_.size) * kParts<Scalar> / V_.capacity(); }

  void take(MatrixXd displacements) override {
    if (!started_) {
      basis_ = start_basis<Scalar>(products_.M, factor_.sigma(), std::move(displacements), V_);
      started_ = true;
      forces_ = {};
      return;
    }
    expand(basis_, std::move(displacements));
    if (basis_.size < next_look_ && has_room(basis_)) return;
    next_look_ = kGrowth * basis_.size;
    look();
  }

  std::optional<HarmonicModes> modes() const override {
    if (!is_complete()) return {};
    HarmonicModes modes;
    modes.k = task_.harmonic->k;
    modes.cutoff = wanted_.cutoff;
    modes.iterations = basis_.size / static_cast<int>(basis_.R.cols());
    measure(combine<Scalar>(basis_, improved_coefficients(basis_, pairs_, below_)), modes);
    return modes;
  }

 private:
  bool is_complete() const { return static_cast<int>(below_.size()) == task_.n_modes; }

  // Converged pairs below the cutoff, by ascending eigenvalue.
  void look() {
    pairs_ = ritz_pairs(basis_);
    below_.clear();
    for (int i = 0; i < pairs_.theta.size(); ++i)
      if (pairs_.error(i) <= wanted_.tolerance && eigenvalue(i) < wanted_.cutoff) below_.push_back(i);
    std::sort(below_.begin(), below_.end(), [&](int i, int j) { return eigenvalue(i) < eigenvalue(j); });
  }

  double eigenvalue(int i) const { return basis_.sigma + 1 / pairs_.theta(i); }

  // phi: vectors of the modes.
  void measure(MatrixXd phi, HarmonicModes& modes) const {
    const HarmonicNodes& nodes = factor_.nodes();
    MatrixXd M_phi = products_.M(phi);
    Dense<Scalar> mass = gram<Scalar>(MPI_COMM_SELF, phi, M_phi);
    const VectorXd scale = mass.diagonal().real().cwiseSqrt().cwiseInverse(),
                   of_columns = scale.transpose().replicate(kParts<Scalar>, 1).reshaped();
    phi *= of_columns.asDiagonal();
    M_phi *= of_columns.asDiagonal();
    mass = (scale.asDiagonal() * mass * scale.asDiagonal()).eval();
    mass.diagonal().setZero();
    modes.orthogonality = mass.cwiseAbs().maxCoeff();
    const MatrixXd K_phi = products_.K(phi);
    modes.eigenvalue = gram<Scalar>(MPI_COMM_SELF, phi, K_phi).diagonal().real();
    const MatrixXd force = nodes.fold(K_phi), inertia = nodes.fold(M_phi) * modes.eigenvalue.asDiagonal();
    modes.residual = (force - inertia).colwise().norm().cwiseQuotient(force.colwise().norm());
    modes.z = nodes.coordinates(phi);
    fix_phases(*task_.harmonic, modes.z);
  }

  const Products& products_;
  HarmonicTask task_;
  BelowCutoff wanted_;
  HarmonicFactor factor_;
  TallBasis V_;
  MatrixXd forces_;
  bool started_ = false;
  KrylovBasis<Scalar> basis_;
  RitzPairs<Scalar> pairs_;
  std::vector<int> below_;
  double next_look_ = 0;
};

using Searches = std::vector<std::unique_ptr<HarmonicSearch>>;

Searches begin(const Products& products, CondensedSector& sector, const std::vector<HarmonicTask>& tasks,
               const BelowCutoff& wanted) {
  Searches searches;
  for (const HarmonicTask& task : tasks)
    if (task.harmonic->real)
      searches.push_back(std::make_unique<SearchOver<double>>(products, sector, task, wanted));
    else
      searches.push_back(std::make_unique<SearchOver<std::complex<double>>>(products, sector, task, wanted));
  return searches;
}

// One step of all searches that are not finished; returns whether there was any.
bool advance(CondensedSector& sector, const Searches& all) {
  std::vector<HarmonicSearch*> searches;
  std::vector<Share> shares;
  Eigen::Index n_columns = 0;
  for (const auto& search : all)
    if (!search->finished()) {
      searches.push_back(search.get());
      shares.push_back({&search->factor(), search->forces().cols()});
      n_columns += shares.back().n_columns;
    }
  if (searches.empty()) return false;
  MatrixXd F(searches.front()->factor().nodes().n_rows(), n_columns);
  const auto visit = [&](const auto& f) {
    Eigen::Index first = 0;
    for (std::size_t i = 0; i < searches.size(); first += shares[i++].n_columns)
      f(*searches[i], F.middleCols(first, shares[i].n_columns));
  };
  visit([](HarmonicSearch& search, auto columns) { columns = search.forces(); });
  solve_together(sector, shares, F);
  visit([](HarmonicSearch& search, auto columns) { search.take(columns); });
  return true;
}

double least_share(const Searches& searches) {
  double least = 1;
  for (const auto& search : searches) least = std::min(least, search->share());
  return least;
}

}  // namespace

std::vector<std::optional<HarmonicModes>> find_modes_together(CondensedSector& sector,
                                                              const std::vector<HarmonicTask>& tasks,
                                                              const BelowCutoff& wanted,
                                                              const Progress& progress) {
  const auto& [K, M] = sector.matrices();
  const Products products(sector.matrices());
  const Searches searches = begin(products, sector, tasks, wanted);
  while (advance(sector, searches)) report(progress, "eigenmodes", least_share(searches));
  std::vector<std::optional<HarmonicModes>> modes;
  for (const auto& search : searches) {
    modes.push_back(search->modes());
    if (modes.back()) require_definite(K, M, modes.back()->eigenvalue.minCoeff());
  }
  return modes;
}

}  // namespace elastogear::reduction
