#include "reduction/slepc/spectrum_slicing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "elastogear/base/error.h"
#include "reduction/dense/residual.h"
#include "reduction/eigensolver/krylov_basis.h"
#include "reduction/slepc/shift_placement.h"

namespace elastogear::reduction {
namespace {

constexpr double kGap = 1e-5;       // relative, of eigenvalues: room for a window's end
constexpr int kEndChoices = 8;      // gaps of which the widest becomes the end
constexpr double kFirstLook = 0.9;  // of what is needed: when Ritz values are first looked at
constexpr double kGrowth = 1.02;    // of the basis between two computations of its Ritz values
constexpr int kLargestBlock = 128;  // after modes were missed
constexpr int kSpare = 2;           // modes above the wanted ones that show the gap there
constexpr double kStretch = 0.2;    // by which windows may be larger than chosen, to save the last one

struct Search {
  Mat K, M;
  SpectralTransform& transform;
  const Slicing& slicing;
  const SliceHooks& hooks;
  BlockProduct K_times, M_times;
  UniqueVec phi;
  WindowSize size;
  SearchState state;
  int block = 0;  // columns at present: more from where modes were missed up to `missed_at`
  double missed_at = -std::numeric_limits<double>::infinity();
  TallBasis* V = nullptr;  // its memory serves all windows, for new pages cost as much as filling them

  int delivered() const { return static_cast<int>(state.eigenvalue.size()); }
  int known() const { return slicing.n_below + delivered(); }
  int wanted() const { return slicing.n_modes - delivered(); }
  bool from_bottom() const { return delivered() == 0 && !std::isfinite(slicing.lower); }
};

using Found = std::vector<std::pair<double, int>>;  // eigenvalue and column, ascending

// Which Ritz pairs make up the window.
struct Choice {
  Found modes;  // in ascending order
  double upper = 0;
  int below_shift = 0;  // eigenvalues under the shift, by what was found
};

// Converged pairs from the shift outwards up to the first that is not. Between them none is missing, as far
// as the basis can know.
Found trusted(const KrylovBasis<>& basis, const RitzPairs<>& pairs, double tolerance) {
  Found found;
  for (int i = 0; i < pairs.theta.size() && pairs.error(i) <= tolerance; ++i)
    found.emplace_back(basis.sigma + 1 / pairs.theta(i), i);
  std::sort(found.begin(), found.end());
  return found;
}

// Returns whether the modes `found` about sigma come down to the end of the last window.
bool reaches_down(const Search& search, double sigma, const Found& found) {
  if (static_cast<int>(found.size()) == search.M_times.n()) return true;
  if (found.empty()) return false;
  const double reach = std::max(sigma - found.front().first, found.back().first - sigma);
  return search.from_bottom() || sigma - search.state.lower <= reach;
}

struct End {
  std::size_t count;
  double upper, gap;
};

// Numbers of modes, ascending, after which there is a gap.
std::vector<End> possible_ends(const Found& modes, bool all) {
  std::vector<End> ends;
  for (std::size_t n = 1; n < modes.size(); ++n) {
    const double below = modes[n - 1].first, above = modes[n].first, gap = (above - below) / std::abs(below);
    if (gap >= kGap) ends.push_back({n, (below + above) / 2, gap});
  }
  if (all && !modes.empty())
    ends.push_back({modes.size(), modes.back().first + kGap * std::abs(modes.back().first), kGap});
  return ends;
}

// The modes of `found` above the last window.
Found new_modes(const Search& search, const Found& found) {
  const auto above = std::find_if(found.begin(), found.end(),
                                  [&](const auto& mode) { return mode.first > search.state.lower; });
  return {above, found.end()};
}

// The new modes of `found` that end in a gap: as few as are wanted in the last window, else as many as
// possible but for a better gap. None when `found` does not reach down, or no gap shows.
std::optional<Choice> choose(const Search& search, double sigma, const Found& found) {
  if (!reaches_down(search, sigma, found)) return {};
  Choice choice{new_modes(search, found), 0, search.known()};
  const bool all = static_cast<int>(found.size()) == search.M_times.n();
  const std::vector<End> ends = possible_ends(choice.modes, all);
  if (ends.empty()) return {};
  const auto enough = std::find_if(ends.begin(), ends.end(), [&](const End& end) {
    return static_cast<int>(end.count) >= search.wanted();
  });
  const auto first = ends.end() - std::min<std::ptrdiff_t>(kEndChoices, ends.end() - ends.begin());
  const auto widest = std::max_element(first, ends.end(), [](auto& x, auto& y) { return x.gap < y.gap; });
  const End& end = enough != ends.end() ? *enough : *widest;
  for (const auto& mode : choice.modes) choice.below_shift += mode.first < sigma;
  choice.modes.resize(end.count);
  choice.upper = end.upper;
  return choice;
}

int room(const Search& search) {
  return columns_with_room(search.size, search.M_times.n(), search.slicing.most_columns);
}

// Number of modes that one basis is to give: windows of equal size up to the end, for a small last one costs
// as much as any to begin.
int target(const Search& search) {
  const double windows = static_cast<double>(search.wanted()) / search.size.modes;
  const int n_windows = std::max(1, static_cast<int>(std::ceil(windows - kStretch)));
  return (search.wanted() + n_windows - 1) / n_windows + kSpare;
}

void report_search(const Search& search, const KrylovBasis<>& basis) {
  if (!search.hooks.progress) return;
  const double inside = std::min(1.0, static_cast<double>(basis.size) / room(search));
  const double modes = search.delivered() + inside * std::min(search.wanted(), target(search));
  search.hooks.progress(std::min(1.0, modes / search.slicing.n_modes));
}

void report_look(const Search& search, const KrylovBasis<>& basis, const RitzPairs<>& pairs,
                 const Found& found) {
  if (!search.hooks.look) return;
  const Found fresh = new_modes(search, found);
  const auto n = search.delivered() + static_cast<Eigen::Index>(fresh.size());
  const bool more = found.size() < static_cast<std::size_t>(pairs.theta.size());
  Look look{basis.sigma, Eigen::VectorXd::Zero(n + more), Eigen::VectorXd::Zero(n + more),
            static_cast<int>(n)};
  look.eigenvalue.head(search.delivered()) = search.state.eigenvalue;
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    const auto at = search.delivered() + static_cast<Eigen::Index>(i);
    look.eigenvalue(at) = fresh[i].first;
    look.error(at) = pairs.error(fresh[i].second);
  }
  if (more) {
    const auto next = static_cast<Eigen::Index>(found.size());
    look.eigenvalue(n) = basis.sigma + 1 / pairs.theta(next);
    look.error(n) = pairs.error(next);
  }
  search.hooks.look(look, search.state.iterations);
}

bool has_blocks_left(const Search& search) { return search.state.iterations < search.slicing.most_blocks; }

// Grows the basis until it holds `modes` about the shift, known ones included, and reaches down to the last
// window, or holds all that are wanted, or is full.
std::optional<Choice> grow(Search& search, KrylovBasis<>& basis, RitzPairs<>& pairs, int modes) {
  std::optional<Choice> choice;
  const double needed = needed_columns(modes, search.block, search.slicing.tolerance);
  for (double next = std::max(kFirstLook * needed, kGrowth * basis.size);
       has_room(basis) && has_blocks_left(search) && !choice;) {
    expand(basis, search.transform.solve(basis.M_next));
    ++search.state.iterations;
    report_search(search, basis);
    if (basis.size < next && has_room(basis)) continue;
    next = kGrowth * basis.size;
    pairs = ritz_pairs(basis);
    const Found found = trusted(basis, pairs, search.slicing.tolerance);
    report_look(search, basis, pairs, found);
    choice = choose(search, basis.sigma, found);
    const bool last = modes >= search.wanted();
    const int reached = static_cast<int>(!last ? found.size() : choice ? choice->modes.size() : 0);
    const bool enough = reached >= std::min(modes, search.wanted());
    if (!enough && has_room(basis)) choice.reset();
  }
  return choice;
}

// Eigenvalue and residual of each column of phi, which are scaled to phi' M phi = 1, with M_phi.
void measure_block(const Search& search, Eigen::MatrixXd& phi, Eigen::MatrixXd& M_phi, int first,
                   SearchState& state) {
  const MPI_Comm comm = search.M_times.comm();
  const Eigen::RowVectorXd scale =
      sum(comm, phi.cwiseProduct(M_phi).colwise().sum()).cwiseSqrt().cwiseInverse();
  phi *= scale.asDiagonal();
  M_phi *= scale.asDiagonal();
  Eigen::MatrixXd K_phi = search.K_times(phi);
  const Eigen::RowVectorXd lambda = sum(comm, phi.cwiseProduct(K_phi).colwise().sum());
  const Eigen::RowVectorXd force = sum(comm, K_phi.colwise().squaredNorm());
  K_phi -= M_phi * lambda.asDiagonal();
  const Eigen::RowVectorXd rest = sum(comm, K_phi.colwise().squaredNorm());
  state.eigenvalue.segment(first, phi.cols()) = lambda;
  state.residual.segment(first, phi.cols()) = rest.cwiseQuotient(force).cwiseSqrt();
}

// Largest |phi_i' M phi_j| of the columns j from `first` on of the window with all i < j of it, and with the
// edge of the window before.
double overlap(const Search& search, const KrylovBasis<>& basis, const Eigen::MatrixXd& s, int first,
               const Eigen::MatrixXd& M_phi) {
  Eigen::MatrixXd gram = project<double>(basis, s.leftCols(first + M_phi.cols()), M_phi);
  gram.bottomRows(M_phi.cols()).diagonal().setZero();
  double largest = gram.size() > 0 ? gram.cwiseAbs().maxCoeff() : 0;
  if (search.state.edge.cols() > 0)
    largest = std::max(largest, inner(search.M_times.comm(), search.state.edge, M_phi).cwiseAbs().maxCoeff());
  return largest;
}

// Mass-normalised, in ascending order, as many columns at a time as go through the factor together. Enters
// the modes into a new state, for the edge of the old one serves all blocks.
void deliver(Search& search, const KrylovBasis<>& basis, const RitzPairs<>& pairs, const Choice& choice) {
  const int found = static_cast<int>(choice.modes.size()), before = search.delivered();
  const int count = search.slicing.whole_pairs ? found : std::min(search.wanted(), found);
  std::vector<int> columns;
  for (int i = 0; i < count; ++i) columns.push_back(choice.modes[i].second);
  const Eigen::MatrixXd s = improved_coefficients(basis, pairs, columns);
  SearchState next = search.state;
  next.eigenvalue.conservativeResize(before + count);
  next.residual.conservativeResize(before + count);
  for (int begin = 0; begin < count; begin += search.size.block) {
    const int width = std::min(count - begin, search.size.block);
    next.edge = combine<double>(basis, s.middleCols(begin, width));
    Eigen::MatrixXd M_phi = search.M_times(next.edge);
    measure_block(search, next.edge, M_phi, before + begin, next);
    next.orthogonality = std::max(next.orthogonality, overlap(search, basis, s, begin, M_phi));
    for (int j = 0; j < width; ++j) {
      load(search.phi, next.edge.col(j));
      search.hooks.mode(before + begin + j, search.phi);
    }
  }
  search.state = std::move(next);
}

// The last modes wanted lie where they were counted before.
bool is_counted(const Search& search, const Choice& choice) {
  return choice.modes[search.wanted() - 1].first < search.slicing.counted_below;
}

// Returns whether the number of modes found under the shift is right: docs/theory, Eq. (2.5). The last
// window is counted up to its end, too; that leaves the factor at the shift again when modes are missing.
bool is_complete(Search& search, const Shift& shift, const Choice& choice) {
  if (!search.slicing.verify_count) return true;
  if (choice.below_shift != shift.below) return false;
  const int known = search.known() + static_cast<int>(choice.modes.size());
  const bool last = search.delivered() + static_cast<int>(choice.modes.size()) >= search.slicing.n_modes;
  if (!last || choice.upper <= shift.sigma || known == search.M_times.n() || is_counted(search, choice))
    return true;
  if (search.transform.factorise(choice.upper) == known) return true;
  search.transform.factorise(shift.sigma);
  return false;
}

// The modes above the last shift are not proved complete: they are looked for once more, from there, by
// larger blocks, for a block finds no eigenvalue more often than it has columns.
void step_back(Search& search, const Shift& shift, const Choice& choice) {
  SearchState& state = search.state;
  if (2 * search.block > kLargestBlock) {
    if (state.lower <= state.shift) require_complete(choice.below_shift, shift.below, shift.sigma);
    require(state.lower > state.shift, "the eigensolver misses modes above ",
            std::sqrt(std::max(0.0, shift.sigma)) / (2 * M_PI),
            " Hz; use a smaller tolerance (-eps_tol) or larger windows (-window)");
  }
  search.block = std::min(kLargestBlock, 2 * search.block);
  search.missed_at = std::max(search.missed_at, shift.sigma);
  if (state.lower <= state.shift) return;
  state.lower = state.shift;
  state.eigenvalue.conservativeResize(std::max(0, state.below_shift - search.slicing.n_below));
  state.residual.conservativeResize(state.eigenvalue.size());
  state.edge.resize(state.edge.rows(), 0);
}

// One window, or none when a basis for `modes` of them has no room for any.
bool solve_window(Search& search, int modes) {
  const Shift shift =
      place_shift({search.K, search.M, search.transform, search.slicing, search.state}, modes);
  const Eigen::MatrixXd first = random_forces(search.M_times, std::min(search.block, search.M_times.n()));
  KrylovBasis<> basis =
      start_basis<double>(search.M_times, shift.sigma, search.transform.solve(first), *search.V);
  RitzPairs<> pairs;
  std::optional<Choice> choice;
  for (bool complete = false; !complete;) {
    const std::optional<Choice> larger = grow(search, basis, pairs, modes);
    if (!larger && !choice) return false;
    if (!larger) {
      step_back(search, shift, *choice);
      return true;
    }
    choice = larger;
    if (search.delivered() == 0 && search.hooks.lowest) search.hooks.lowest(choice->modes.front().first);
    complete = is_complete(search, shift, *choice);
  }
  deliver(search, basis, pairs, *choice);
  search.state.lower = choice->upper;
  search.state.shift = shift.sigma;
  search.state.below_shift = shift.below;
  if (search.state.lower > search.missed_at) search.block = search.size.block;
  // A search that is continued begins with blocks of the usual size.
  const bool resumable = search.block == search.size.block || search.wanted() <= 0;
  if (search.hooks.window && resumable) search.hooks.window(search.state);
  return true;
}

}  // namespace

void require_complete(int known, int exact, double sigma) {
  require(exact == known, "the eigensolver found ", known, " of the ", exact, " modes below ",
          std::sqrt(std::max(0.0, sigma)) / (2 * M_PI),
          " Hz; use larger blocks of vectors (-eps_block_lanczos_block) or a smaller tolerance (-eps_tol)");
}

SearchState slice_spectrum(Mat K, Mat M, SpectralTransform& transform, const Slicing& slicing,
                           const SliceHooks& hooks, const MakeBasis& make_basis) {
  Search search{K,
                M,
                transform,
                slicing,
                hooks,
                BlockProduct(K),
                BlockProduct(M, BlockProduct::Storage::without_zeros),
                {},
                {},
                slicing.start};
  if (search.delivered() == 0 && std::isfinite(slicing.lower)) {
    search.state.lower = search.state.shift = slicing.lower;
    search.state.below_shift = slicing.n_below;
  }
  check(MatCreateVecs(K, search.phi.out(), nullptr));
  search.size = choose_window(transform.size(), search.M_times.n(), slicing.window, slicing.most_columns);
  search.block = search.size.block;
  search.V = &make_basis(room(search) + search.size.block);
  for (int modes = target(search); search.delivered() < slicing.n_modes && has_blocks_left(search);) {
    if (solve_window(search, modes)) {
      modes = target(search);
      continue;
    }
    if (!has_blocks_left(search)) break;
    require(modes > 1, "no modes converged above ", std::sqrt(std::max(0.0, search.state.lower)) / (2 * M_PI),
            " Hz; use larger windows (-window) or a larger tolerance (-eps_tol) than ", slicing.tolerance);
    modes /= 2;
  }
  return std::move(search.state);
}

}  // namespace elastogear::reduction
