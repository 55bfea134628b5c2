#include "reduction/eigensolver/window_size.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace elastogear::reduction {
namespace {

constexpr double kColumnsPerMode = 1.7;  // of a Krylov basis without restarts, measured
constexpr double kBlocksPerDigit = 2.4;  // more of them, until the first Ritz values converge
constexpr double kFewestColumns = 200;   // of a basis, however small the window
constexpr double kRoom = 1.3;            // columns there is room for, over those needed

// The cost of a flop, over that in a product of the basis with 16 vectors (benchmarks/kernels.csv): kFactor
// in a factorisation, kSolve + kSolveOnce / block in a solve, kProduct + kProductOnce / block in such
// products.
constexpr double kFactor = 2, kSolve = 1.3, kSolveOnce = 20, kProduct = 0.75, kProductOnce = 5;
constexpr double kLargestBasis = 1.5;  // entries, over those of the factor
constexpr double kSmallBasis = 1e8;    // entries that are always allowed: 0.8 GB
constexpr std::array kWindows{60, 100, 150, 200, 250, 300, 400, 500, 600};
constexpr std::array kBlocks{8, 16, 24, 32};

}  // namespace

double needed_columns(int modes, int block, double tolerance) {
  return kColumnsPerMode * modes - kBlocksPerDigit * std::log10(tolerance) * block;
}

int columns_with_room(const WindowSize& size, int n, int most_columns) {
  const double allowed = std::min<double>(kRoom * needed_columns(size.modes, size.block), most_columns);
  return static_cast<int>(std::min<double>(std::max(allowed, kFewestColumns), n));
}

WindowSize choose_window(const FactorSize& factor, int n, WindowSize asked, int most_columns) {
  const auto rows = static_cast<double>(n);
  const auto cost_per_mode = [&](const WindowSize& size) {
    const double c = needed_columns(size.modes, size.block);
    const double solves = 4 * factor.entries * c * (kSolve + kSolveOnce / size.block);
    const double products =
        (2 * rows * c * c + 4 * rows * c * size.modes) * (kProduct + kProductOnce / size.block);
    return (kFactor * factor.flops + solves + products) / size.modes;
  };
  const double most =
      std::min<double>(most_columns, std::max(kLargestBasis * factor.entries, kSmallBasis) / rows);
  WindowSize best{asked.modes > 0 ? asked.modes : kWindows.front(),
                  asked.block > 0 ? asked.block : kBlocks.front()};
  for (int modes : kWindows)
    for (int block : kBlocks) {
      const WindowSize size{asked.modes > 0 ? asked.modes : modes, asked.block > 0 ? asked.block : block};
      const bool fits = asked.modes > 0 || kRoom * needed_columns(size.modes, size.block) <= most;
      if (fits && cost_per_mode(size) < cost_per_mode(best)) best = size;
    }
  return best;
}

}  // namespace elastogear::reduction
