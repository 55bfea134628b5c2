#include "reduction/eigensolver/spectrum_slicing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "elastogear/base/error.h"
#include "reduction/eigensolver/block_lanczos.h"
#include "reduction/static_response/residual.h"

namespace elastogear::reduction {
namespace {

constexpr double kGap = 1e-5;            // relative, of eigenvalues: room for a window's end
constexpr int kEndChoices = 8;           // gaps of which the widest becomes the end
constexpr double kColumnsPerMode = 1.7;  // of a Krylov basis without restarts, measured
constexpr double kFirstBlocks = 24;      // more of them, until the first Ritz values converge
constexpr double kFirstLook = 0.9;       // of these sizes: when Ritz values are first looked at
constexpr double kFewestColumns = 200;   // of a basis, however small the window
constexpr double kGrowth = 1.02;         // of the basis between two looks at its Ritz values
constexpr double kAim = 0.45;            // of a window's modes: to lie under its shift
constexpr double kTooMany = 0.65;        // the same: move the shift down
constexpr double kRoom = 1.3;            // columns there is room for, over those needed
constexpr int kShifts = 4;               // tries to place one
constexpr int kSpare = 2;                // modes above the wanted ones that show the gap there
constexpr double kStretch = 0.2;         // by which windows may be larger than chosen, to save the last one
constexpr double kWeyl = 1.5;            // exponent of N(lambda) in a solid
constexpr int kFewModes = 16;            // too few to see an exponent of their own

// The cost of a flop, over that in a product of the basis with 16 vectors (benchmarks/kernels.csv): kFactor
// in a factorisation, kSolve + kSolveOnce / block in a solve, kProduct + kProductOnce / block in such
// products.
constexpr double kFactor = 2, kSolve = 1.3, kSolveOnce = 20, kProduct = 0.75, kProductOnce = 5;
constexpr double kLargestBasis = 1.5;  // entries, over those of the factor
constexpr double kSmallBasis = 1e8;    // entries that are always allowed: 0.8 GB
constexpr std::array kWindows{60, 100, 150, 200, 250, 300, 400, 500, 600};
constexpr std::array kBlocks{8, 16, 24, 32};

struct Search {
  Mat K, M;
  const EigenOptions& options;
  const ModeSink& sink;
  const Progress& progress;
  BlockProduct K_times, M_times;
  ShiftedFactor factor;
  UniqueVec phi;
  WindowSize size;
  SearchState state;
  KrylovBasis basis = {};  // its memory serves all windows, for new pages cost as much as filling them

  int delivered() const { return static_cast<int>(state.eigenvalue.size()); }
  int known() const { return options.n_rigid + delivered(); }
  int wanted() const { return options.n_modes - delivered(); }
};

struct Shift {
  double sigma = 0;
  int below = 0;  // eigenvalues under it
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
Found trusted(const KrylovBasis& basis, const RitzPairs& pairs, double tolerance) {
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
  return search.delivered() == 0 || sigma - search.state.lower <= reach;
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
  if (all && !modes.empty()) ends.push_back({modes.size(), modes.back().first * (1 + kGap), kGap});
  return ends;
}

// The modes of `found` above the last window and the rigid modes.
Found new_modes(const Search& search, const Found& found) {
  const auto above = std::find_if(found.begin(), found.end(),
                                  [&](const auto& mode) { return mode.first > search.state.lower; });
  const std::ptrdiff_t rigid = search.delivered() == 0 ? search.options.n_rigid : 0;
  return {above + std::min(rigid, found.end() - above), found.end()};
}

// The new modes of `found` that end in a gap: as few as are wanted in the last window, else as many as
// possible but for a better gap. None when `found` does not reach down, or no gap shows.
std::optional<Choice> choose(const Search& search, double sigma, const Found& found) {
  if (!reaches_down(search, sigma, found)) return {};
  Choice choice{new_modes(search, found), 0, search.delivered() == 0 ? 0 : search.known()};
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

// Columns that a basis needs for so many modes on both sides of the shift.
double columns(int modes, int block) { return kColumnsPerMode * modes + kFirstBlocks * block; }

int room(const Search& search) {
  const double needed = kRoom * columns(search.size.modes, search.size.block);
  return static_cast<int>(std::min<double>(std::max(needed, kFewestColumns), search.M_times.n()));
}

// Number of modes that one basis is to give: windows of equal size up to the end, for a small last one costs
// as much as any to begin.
int target(const Search& search) {
  const double windows = static_cast<double>(search.wanted()) / search.size.modes;
  const int n_windows = std::max(1, static_cast<int>(std::ceil(windows - kStretch)));
  return (search.wanted() + n_windows - 1) / n_windows + kSpare;
}

void report_search(const Search& search, const KrylovBasis& basis) {
  const double inside = std::min(1.0, static_cast<double>(basis.size) / room(search));
  const double modes = search.delivered() + inside * std::min(search.wanted(), target(search));
  report(search.progress, "eigenmodes", std::min(1.0, modes / search.options.n_modes));
}

// Grows the basis until it holds `modes` about the shift, known ones included, and reaches down to the last
// window, or holds all that are wanted, or is full.
std::optional<Choice> grow(Search& search, KrylovBasis& basis, RitzPairs& pairs, int modes) {
  std::optional<Choice> choice;
  for (double next = std::max(kFirstLook * columns(modes, search.size.block), kGrowth * basis.size);
       has_room(basis) && !choice;) {
    expand(basis, search.factor);
    ++search.state.iterations;
    report_search(search, basis);
    if (basis.size < next && has_room(basis)) continue;
    next = kGrowth * basis.size;
    pairs = ritz_pairs(basis);
    const Found found = trusted(basis, pairs, search.options.tolerance);
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
double overlap(const Search& search, const KrylovBasis& basis, const Eigen::MatrixXd& s, int first,
               const Eigen::MatrixXd& M_phi) {
  Eigen::MatrixXd gram = project(basis, s.leftCols(first + M_phi.cols()), M_phi);
  gram.bottomRows(M_phi.cols()).diagonal().setZero();
  double largest = gram.size() > 0 ? gram.cwiseAbs().maxCoeff() : 0;
  if (search.state.edge.cols() > 0)
    largest = std::max(largest, inner(search.M_times.comm(), search.state.edge, M_phi).cwiseAbs().maxCoeff());
  return largest;
}

// Mass-normalised, in ascending order, as many columns at a time as go through the factor together. Enters
// the modes into a new state, for the edge of the old one serves all blocks.
void deliver(Search& search, const KrylovBasis& basis, const RitzPairs& pairs, const Choice& choice) {
  const int found = static_cast<int>(choice.modes.size()), before = search.delivered();
  const int count = search.options.whole_pairs ? found : std::min(search.wanted(), found);
  std::vector<int> columns;
  for (int i = 0; i < count; ++i) columns.push_back(choice.modes[i].second);
  const Eigen::MatrixXd s = improved_coefficients(basis, pairs, columns);
  SearchState next = search.state;
  next.eigenvalue.conservativeResize(before + count);
  next.residual.conservativeResize(before + count);
  for (int begin = 0; begin < count; begin += search.size.block) {
    const int width = std::min(count - begin, search.size.block);
    next.edge = combine(basis, s.middleCols(begin, width));
    Eigen::MatrixXd M_phi = search.M_times(next.edge);
    measure_block(search, next.edge, M_phi, before + begin, next);
    next.orthogonality = std::max(next.orthogonality, overlap(search, basis, s, begin, M_phi));
    for (int j = 0; j < width; ++j) {
      load(search.phi, next.edge.col(j));
      search.sink(before + begin + j, search.phi);
    }
  }
  search.state = std::move(next);
}

// The eigenvalue up to which `more` modes are expected above the known ones, by the power law N(lambda) of
// the last of these.
double extrapolate(const SearchState& state, double more) {
  const auto n = state.eigenvalue.size();
  double exponent = kWeyl;
  if (n >= kFewModes) {
    const auto half = std::max<Eigen::Index>(n / 2, n - static_cast<Eigen::Index>(2 * more));
    exponent = std::log(static_cast<double>(n) / half) / std::log(state.lower / state.eigenvalue(half - 1));
    exponent = std::clamp(exponent, kWeyl / 3, 3 * kWeyl);
  }
  return state.lower * std::pow(1 + more / n, 1 / exponent);
}

// A shift with nearly half of the next window's modes under it, and the factor there.
Shift place_shift(Search& search, int modes) {
  const SearchState& state = search.state;
  Shift shift{search.options.first_shift, 0};
  if (search.delivered() == 0) {
    shift.below = search.factor.factorise(shift.sigma);
    return shift;
  }
  const double half = std::max(1.0, kAim * modes);
  shift.sigma = extrapolate(state, half);
  for (int i = 1;; ++i) {
    shift.below = search.factor.factorise(shift.sigma);
    const int under = shift.below - search.known();
    if (under <= std::max(1.0, kTooMany * modes) || i == kShifts) return shift;
    shift.sigma = state.lower + (shift.sigma - state.lower) * half / under;
  }
}

// The last modes wanted lie where they were counted before.
bool is_counted(const Search& search, const Choice& choice) {
  const EigenOptions& options = search.options;
  return options.n_rigid == 0 && choice.modes[search.wanted() - 1].first < options.counted_below;
}

// Returns whether the number of modes found under the shift is right: docs/theory.md, Eq. (2.5). The last
// window is counted up to its end, too; that leaves the factor at the shift again when modes are missing.
bool is_complete(Search& search, const Shift& shift, const Choice& choice) {
  if (!search.options.verify_count) return true;
  if (choice.below_shift != shift.below) return false;
  const int known = search.known() + static_cast<int>(choice.modes.size());
  const bool last = search.delivered() + static_cast<int>(choice.modes.size()) >= search.options.n_modes;
  if (!last || choice.upper <= shift.sigma || known == search.M_times.n() || is_counted(search, choice))
    return true;
  if (search.factor.factorise(choice.upper) == known) return true;
  search.factor.factorise(shift.sigma);
  return false;
}

// The modes above the last shift are not proved complete: they are looked for once more, from there.
void step_back(Search& search, const Shift& shift, const Choice& choice) {
  SearchState& state = search.state;
  if (state.lower <= state.shift) require_complete(choice.below_shift, shift.below, shift.sigma);
  require(state.lower > state.shift, "the eigensolver misses modes above ",
          std::sqrt(std::max(0.0, shift.sigma)) / (2 * M_PI),
          " Hz; use a smaller tolerance or larger windows");
  state.lower = state.shift;
  state.eigenvalue.conservativeResize(std::max(0, state.below_shift - search.options.n_rigid));
  state.residual.conservativeResize(state.eigenvalue.size());
  state.edge.resize(state.edge.rows(), 0);
}

// One window, or none when a basis for `modes` of them has no room for any.
bool solve_window(Search& search, int modes) {
  const Shift shift = place_shift(search, modes);
  KrylovBasis& basis = search.basis;
  basis = start_basis(search.M_times, search.factor, shift.sigma, search.size.block, std::move(basis.V));
  RitzPairs pairs;
  std::optional<Choice> choice;
  for (bool complete = false; !complete;) {
    const std::optional<Choice> larger = grow(search, basis, pairs, modes);
    if (!larger && !choice) return false;
    if (!larger) {
      step_back(search, shift, *choice);
      return true;
    }
    choice = larger;
    if (search.delivered() == 0 && search.options.n_rigid == 0)
      require_definite(search.K, search.M, choice->modes.front().first);
    complete = is_complete(search, shift, *choice);
  }
  deliver(search, basis, pairs, *choice);
  search.state.lower = choice->upper;
  search.state.shift = shift.sigma;
  search.state.below_shift = shift.below;
  if (search.options.commit) search.options.commit(search.state);
  return true;
}

}  // namespace

WindowSize choose_window(const FactorSize& factor, int n, WindowSize asked) {
  const auto rows = static_cast<double>(n);
  const auto cost_per_mode = [&](const WindowSize& size) {
    const double c = columns(size.modes, size.block);
    const double solves = 4 * factor.entries * c * (kSolve + kSolveOnce / size.block);
    const double products =
        (2 * rows * c * c + 4 * rows * c * size.modes) * (kProduct + kProductOnce / size.block);
    return (kFactor * factor.flops + solves + products) / size.modes;
  };
  const double most = std::max(kLargestBasis * factor.entries, kSmallBasis) / rows;
  WindowSize best{asked.modes > 0 ? asked.modes : kWindows.front(),
                  asked.block > 0 ? asked.block : kBlocks.front()};
  for (int modes : kWindows)
    for (int block : kBlocks) {
      const WindowSize size{asked.modes > 0 ? asked.modes : modes, asked.block > 0 ? asked.block : block};
      const bool fits = asked.modes > 0 || kRoom * columns(size.modes, size.block) <= most;
      if (fits && cost_per_mode(size) < cost_per_mode(best)) best = size;
    }
  return best;
}

void require_complete(int known, int exact, double sigma) {
  require(exact == known, "the eigensolver found ", known, " of the ", exact, " modes below ",
          std::sqrt(std::max(0.0, sigma)) / (2 * M_PI),
          " Hz; use larger blocks of vectors or a smaller tolerance");
}

Eigenmodes find_by_slices(Mat K, Mat M, const EigenOptions& options, const ModeSink& sink,
                          const Progress& progress) {
  report(progress, "eigenmodes",  // ordering and the first factor take long in silence
         static_cast<double>(options.start.eigenvalue.size()) / options.n_modes);
  Search search{K,
                M,
                options,
                sink,
                progress,
                BlockProduct(K),
                BlockProduct(M, BlockProduct::Storage::without_zeros),
                ShiftedFactor(K, M),
                {},
                {},
                options.start};
  check(MatCreateVecs(K, search.phi.out(), nullptr));
  search.size = choose_window(search.factor.size(), search.M_times.n(), {options.window, options.block});
  search.basis.V = TallBasis(search.M_times.n_own(), room(search) + search.size.block);
  for (int modes = target(search); search.delivered() < options.n_modes;) {
    if (solve_window(search, modes)) {
      modes = target(search);
      continue;
    }
    require(modes > 1, "no modes converged above ", std::sqrt(std::max(0.0, search.state.lower)) / (2 * M_PI),
            " Hz; use larger windows or a larger tolerance than ", options.tolerance);
    modes /= 2;
  }
  const SearchState& state = search.state;
  return {state.eigenvalue, state.residual, state.orthogonality, state.iterations};
}

}  // namespace elastogear::reduction
