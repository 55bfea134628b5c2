#include "elastogear/reduction/windows.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "elastogear/base/error.h"
#include "elastogear/reduction/block_lanczos.h"
#include "residual.h"

namespace elastogear::reduction {
namespace {

constexpr double kGap = 1e-5;           // relative, of eigenvalues: room for a window's end
constexpr double kColumnsPerMode = 2;   // of a Krylov basis without restarts, with a margin
constexpr double kFirstBlocks = 10;     // until the first Ritz values converge
constexpr double kFewestColumns = 200;  // of a basis, however small the window
constexpr double kGrowth = 1.08;        // of the basis between two looks at its Ritz values
constexpr double kTooMany = 1.5;        // times the wanted modes under a shift: move the shift down
constexpr int kShifts = 4;              // tries to place one
constexpr int kSpare = 2;               // modes above the wanted ones that show the gap there
constexpr double kWeyl = 2.0 / 3;       // eigenvalues of a solid: lambda ~ N^(2/3)

struct Search {
  Mat K, M;
  const EigenOptions& options;
  const ModeSink& sink;
  const Progress& progress;
  ShiftedFactor factor;
  Residual residual;
  int n;
  Window window = {};
  Eigenmodes modes = {};
  int delivered = 0;

  int wanted() const { return options.n_modes - window.below; }
};

// Which Ritz pairs make up the window.
struct Choice {
  std::vector<int> column;
  double upper = 0;
};

double eigenvalue(const KrylovBasis& basis, const RitzPairs& pairs, int i) {
  return basis.sigma + 1 / pairs.theta(i);
}

// Converged pairs from the shift outwards up to the first that is not: (eigenvalue, column), ascending.
// Between them none is missing, as far as the basis can know.
std::vector<std::pair<double, int>> trusted(const KrylovBasis& basis, const RitzPairs& pairs,
                                            double tolerance) {
  std::vector<std::pair<double, int>> found;
  for (int i = 0; i < pairs.theta.size() && pairs.error(i) <= tolerance; ++i)
    found.emplace_back(eigenvalue(basis, pairs, i), i);
  std::sort(found.begin(), found.end());
  return found;
}

// Of `found` those above window.lower that end in a gap: as few as are wanted in the last window, else as
// many as possible. None when the basis has not yet reached down to window.lower, or not yet up to enough.
std::optional<Choice> choose(const Search& search, const KrylovBasis& basis,
                             const std::vector<std::pair<double, int>>& found, int least) {
  const double lower = search.window.lower;
  const bool all = static_cast<int>(found.size()) == search.n;
  const double reach =
      found.empty() ? 0 : std::max(basis.sigma - found.front().first, found.back().first - basis.sigma);
  if (found.empty() || (!all && search.window.below > 0 && basis.sigma - lower > reach)) return {};
  Choice choice;
  std::optional<std::size_t> end;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i].first <= lower) continue;
    choice.column.push_back(found[i].second);
    if (static_cast<int>(choice.column.size()) < least) continue;
    const bool top = i + 1 == found.size();
    if (top ? !all : found[i + 1].first - found[i].first < kGap * found[i].first) continue;
    choice.upper = top ? found[i].first * (1 + kGap) : (found[i].first + found[i + 1].first) / 2;
    end = choice.column.size();
    if (static_cast<int>(*end) >= search.wanted()) break;
  }
  if (!end) return {};
  choice.column.resize(*end);
  return choice;
}

int room(const Search& search) {
  const double columns = kColumnsPerMode * search.options.window + kFirstBlocks * search.options.block;
  return static_cast<int>(std::min<double>(std::max(columns, kFewestColumns), search.n));
}

// Modes that one basis is to yield.
int target(const Search& search) { return std::min(search.options.window, search.wanted() + kSpare); }

void report_search(const Search& search, const KrylovBasis& basis) {
  const double inside = static_cast<double>(basis.size) / room(search);
  const double modes = search.delivered + std::min(1.0, inside) * std::min(search.wanted(), target(search));
  report(search.progress, "eigenmodes", std::min(1.0, modes / search.options.n_modes));
}

// Grows the basis until it holds a window of `modes`, or as much of one as there is room for.
std::optional<Choice> grow(Search& search, KrylovBasis& basis, RitzPairs& pairs, int modes) {
  std::optional<Choice> choice;
  for (double next = modes; has_room(basis) && !choice;) {
    expand(basis, search.factor);
    ++search.modes.iterations;
    report_search(search, basis);
    if (basis.size < next && has_room(basis)) continue;
    next = kGrowth * basis.size;
    pairs = ritz_pairs(basis);
    const auto found = trusted(basis, pairs, search.options.tolerance);
    choice = choose(search, basis, found, has_room(basis) ? std::min(search.wanted(), modes) : 1);
  }
  return choice;
}

// Mass-normalised, in ascending order, as many columns at a time as go through the factor together.
void deliver(Search& search, const KrylovBasis& basis, const RitzPairs& pairs, const Choice& choice) {
  const int count = std::min(search.wanted(), static_cast<int>(choice.column.size()));
  for (int begin = 0; begin < count; begin += search.options.block) {
    const int end = std::min(count, begin + search.options.block);
    const std::vector<int> columns(choice.column.begin() + begin, choice.column.begin() + end);
    const Eigen::MatrixXd phi = ritz_vectors(basis, pairs, columns);
    for (int j = 0; j < end - begin; ++j) {
      const int k = search.delivered++;
      load(search.residual, phi.col(j));
      measure(search.K, search.M, search.residual, &search.modes.eigenvalue(k), &search.modes.residual(k));
      search.sink(k, search.residual.phi);
    }
  }
}

// A shift with about half of the next window's modes under it. N(omega) ~ omega^3 places the first try.
double place_shift(Search& search, int modes) {
  const Window& window = search.window;
  if (window.below == 0) {
    search.factor.factorise(0);
    return 0;
  }
  const double half = std::max(1.0, modes / 2.0);
  double sigma = window.lower * std::pow((window.below + half) / window.below, kWeyl);
  for (int i = 1;; ++i) {  // leaves the factor at sigma
    const int under = search.factor.factorise(sigma) - window.below;
    if (under <= kTooMany * half || i == kShifts) break;
    sigma = window.lower + (sigma - window.lower) * half / under;
  }
  return sigma;
}

int known(const Window& window) { return window.below + static_cast<int>(window.eigenvalue.size()); }

void set_window(Window& window, const KrylovBasis& basis, const RitzPairs& pairs, const Choice& choice) {
  window.upper = choice.upper;
  window.eigenvalue.resize(static_cast<Eigen::Index>(choice.column.size()));
  for (std::size_t i = 0; i < choice.column.size(); ++i)
    window.eigenvalue(static_cast<Eigen::Index>(i)) = eigenvalue(basis, pairs, choice.column[i]);
}

// Whether the window may be delivered. A mode that the basis does not show yet (the second of an equal pair,
// say) calls for more columns, and thus the factor at the shift again, while there is room.
bool accept(Search& search, const KrylovBasis& basis) {
  if (!search.options.verify_count) return true;
  if (search.factor.factorise(search.window.upper) == known(search.window)) return true;
  if (!has_room(basis)) require_complete(search.factor, search.window);
  search.factor.factorise(basis.sigma);
  return false;
}

// One window: its modes are delivered after their count was checked.
bool solve_window(Search& search, int modes) {
  const double sigma = place_shift(search, modes);
  KrylovBasis basis = start_basis(search.M, search.factor, sigma, search.options.block, room(search));
  RitzPairs pairs;
  Window& window = search.window;
  std::optional<Choice> choice;
  do {
    choice = grow(search, basis, pairs, modes);
    if (!choice) return false;
    set_window(window, basis, pairs, *choice);
    if (search.delivered == 0) require_definite(search.K, search.M, window.eigenvalue(0));
  } while (!accept(search, basis));
  deliver(search, basis, pairs, *choice);
  window.below = known(window);
  window.lower = window.upper;
  return true;
}

}  // namespace

void require_complete(ShiftedFactor& factor, const Window& window) {
  const int exact = factor.factorise(window.upper);
  require(exact == known(window), "the eigensolver found ", known(window), " of the ", exact, " modes below ",
          std::sqrt(window.upper) / (2 * M_PI), " Hz; use larger blocks of vectors or a smaller tolerance");
}

Eigenmodes find_by_windows(Mat K, Mat M, const EigenOptions& options, const ModeSink& sink,
                           const Progress& progress) {
  PetscInt n = 0;
  check(MatGetSize(K, &n, nullptr));
  report(progress, "eigenmodes", 0);
  Search search{K, M, options, sink, progress, ShiftedFactor(K, M), make_residual(K), static_cast<int>(n)};
  search.modes = {Eigen::VectorXd(options.n_modes), Eigen::VectorXd(options.n_modes), 0};
  for (int modes = target(search); search.delivered < options.n_modes;) {
    if (solve_window(search, modes)) {
      modes = target(search);
      continue;
    }
    require(modes > 1, "no modes converged above ", std::sqrt(search.window.lower) / (2 * M_PI),
            " Hz; use larger windows or a larger tolerance than ", options.tolerance);
    modes /= 2;
  }
  return search.modes;
}

}  // namespace elastogear::reduction
