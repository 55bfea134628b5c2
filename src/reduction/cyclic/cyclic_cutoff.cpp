#include <algorithm>
#include <cmath>
#include <numeric>

#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "reduction/cyclic/cyclic_search.h"
#include "reduction/modes/cutoff.h"

namespace elastogear::reduction {
namespace {

constexpr double kSurplus = 0.05;      // modes found beyond the wanted ones, at most
constexpr double kMoreSurplus = 0.25;  // of few modes, which take less time than another count
constexpr int kFewSurplus = 50;        // of these at most
constexpr int kLeastSurplus = 8;       // and at least so many may be
constexpr int kPairsInDoubt = 4;       // in a sample
constexpr double kMoreModes = 60;      // of a worm or wheel than Weyl's law says, among the first hundreds
constexpr double kMoreShare = 0.45;    // and among the first hundred
constexpr int kSampleEvery = 5;        // harmonics counted for the first guess of the cutoff

// Eigenvalues below sigma of a harmonic of this rank's group.
int count_below(CyclicSearch& search, int k, double sigma) {
  CountedHarmonic& last = search.last;
  if (last.k != k) {
    last = {};
    if (search.condensed) {
      last.factor = std::make_unique<HarmonicFactor>(*search.condensed, search.harmonics[k]);
    } else {
      last.matrices = search.assemble(k);
      last.factor = search.make_factor(last.matrices);
    }
    last.k = k;
  }
  return last.factor->count(sigma);
}

// Eigenvalues below sigma of each of the harmonics `which`. Pairs are never split, even where roundoff may.
std::vector<int> count_below(CyclicSearch& search, const std::vector<int>& which, double sigma) {
  std::vector<int> count(search.harmonics.size(), 0);
  collectively(search.comm, [&] {
    for (std::size_t i = 0; i < which.size(); ++i) {
      const int k = which[i];
      report(search.progress, "mode count", static_cast<double>(i) / which.size());
      if (!search.mine(k) || search.counts.contains({k, sigma})) continue;
      const int below = count_below(search, k, sigma);
      if (search.group->first) count[k] = search.harmonics[k].real ? below : below + below % 2;
    }
  });
  MPI_Allreduce(MPI_IN_PLACE, count.data(), static_cast<int>(count.size()), MPI_INT, MPI_SUM, search.comm);
  for (int k : which) count[k] = search.counts.try_emplace({k, sigma}, count[k]).first->second;
  return count;
}

double share_of_coordinates(const CyclicSearch& search, const std::vector<int>& harmonics) {
  double share = 0, all = 0;
  for (int k : harmonics) share += search.harmonics[k].size();
  for (const fem::Harmonic& harmonic : search.harmonics) all += harmonic.size();
  return share / all;
}

// A sigma with about n eigenvalues below it, by counting those of every few harmonics.
double estimate_cutoff(CyclicSearch& search, int n) {
  const double weyl =
      weyl_cutoff(search.sector, search.body.body.regions, n - std::min(kMoreModes, kMoreShare * n));
  std::vector<int> sample;
  for (int k = kSampleEvery / 2; k < search.n_harmonics(); k += kSampleEvery) sample.push_back(k);
  const double share = share_of_coordinates(search, sample);
  if (share == 0) return weyl;
  const auto estimate = [&](double sigma) {
    const std::vector<int> count = count_below(search, sample, sigma);
    return static_cast<int>(std::accumulate(count.begin(), count.end(), 0) / share);
  };
  const int doubt = static_cast<int>(std::max(kPairsInDoubt / share, kSurplus * n));
  return find_cutoff(estimate, {std::max(1, n - doubt), n + doubt}, weyl);
}

int sum(const std::vector<int>& counts) { return std::accumulate(counts.begin(), counts.end(), 0); }

// All harmonics of the interval, whose number of modes becomes that of the search.
Cutoff cutoff_of_interval(CyclicSearch& search) {
  const auto& [lower, upper] = *search.options.eigen.interval;
  std::vector<int> all(search.harmonics.size());
  std::iota(all.begin(), all.end(), 0);
  Cutoff cutoff{upper, {}};
  if (std::isfinite(upper)) {
    cutoff.count = count_below(search, all, upper);
  } else {
    for (const fem::Harmonic& harmonic : search.harmonics) cutoff.count.push_back(harmonic.size());
  }
  if (lower > 0) {  // the body is held: none lies below zero
    const std::vector<int> below = count_below(search, all, lower);
    for (std::size_t k = 0; k < all.size(); ++k) cutoff.count[k] -= below[k];
  }
  search.n_wanted = sum(cutoff.count);
  require(search.n_wanted > 0, "no eigenvalue lies between ", lower, " and ", upper,
          " rad^2/s^2 (-eps_interval, or modes: auto); take one mode (-modes 1)");
  return cutoff;
}

Cutoff choose_cutoff(CyclicSearch& search) {
  const int n = search.n_wanted;
  const int surplus = std::max({kLeastSurplus, static_cast<int>(kSurplus * n),
                                std::min(kFewSurplus, static_cast<int>(kMoreSurplus * n))});
  std::vector<int> all(search.harmonics.size());
  std::iota(all.begin(), all.end(), 0);
  Cutoff cutoff{0, {}};
  const auto count = [&](double sigma) {
    cutoff.count = count_below(search, all, sigma);
    return sum(cutoff.count);
  };
  cutoff.sigma = find_cutoff(count, {n, n + surplus}, estimate_cutoff(search, n + surplus / 2));
  return cutoff;
}

}  // namespace

Cutoff find_cutoff(CyclicSearch& search) {
  return search.options.eigen.interval ? cutoff_of_interval(search) : choose_cutoff(search);
}

}  // namespace elastogear::reduction
