// Coarse and fine contact search on the two surfaces of flanks.h; peers.cpp does the same with FCL and
// Embree.

#include <benchmark/benchmark.h>

#include "elastogear/contact/bvh.h"
#include "flanks.h"

namespace elastogear::contact {
namespace {

void refit_both_trees(benchmark::State& state) {
  const Flanks f = flanks(0);
  Bvh a = build(f.a.X, f.a.face, state.range(0)), b = build(f.b.X, f.b.face, state.range(0));
  RefitMemory work;
  for (auto _ : state) {
    refit(a, f.a.X, f.a.face, 0, work);
    refit(b, f.b.X, f.b.face, 0, work);
    benchmark::DoNotOptimize(b.box.data());
  }
}
BENCHMARK(refit_both_trees)->Arg(6)->Arg(18)->Arg(24)->Arg(26)->Unit(benchmark::kMicrosecond);

// Arguments: k, contact, margin in um.
void query(benchmark::State& state) {
  const auto [f, x_a, x_b] = placed_flanks(state.range(1));
  Bvh a = build(f.a.X, f.a.face, state.range(0)), b = build(f.b.X, f.b.face, state.range(0));
  RefitMemory work;
  refit(a, x_a, f.a.face, 1e-6 * state.range(2), work);
  refit(b, x_b, f.b.face, 0, work);
  DescentMemory memory;
  std::vector<NodePair> pairs;
  for (auto _ : state) {
    overlapping_faces(a, b, {}, memory, pairs);
    benchmark::DoNotOptimize(pairs.data());
  }
  state.counters["pairs"] = static_cast<double>(pairs.size());
}
BENCHMARK(query)
    ->ArgNames({"k", "contact", "margin_um"})
    ->ArgsProduct({{6, 18, 24}, {0, 1, 2}, {0, 50}})
    ->Unit(benchmark::kMicrosecond);

// Arguments: update (0 refit, 1 realign), contact.
void detect(benchmark::State& state) {
  const Flanks f = flanks(state.range(1));
  Settings settings;
  settings.update = state.range(0) == 0 ? Update::refit : Update::realign;
  settings.surface = ContactSurface::facets;
  Pair pair(f.a, f.b, settings);
  std::size_t contacts = 0;
  for (auto _ : state) contacts = pair.detect(f.state_a, f.state_b).size();
  state.counters["contacts"] = static_cast<double>(contacts);
}
BENCHMARK(detect)
    ->ArgNames({"realign", "contact"})
    ->ArgsProduct({{0, 1}, {0, 1, 2}})
    ->Unit(benchmark::kMicrosecond);

void build_tree(benchmark::State& state) {
  const Flanks f = flanks(0);
  for (auto _ : state) benchmark::DoNotOptimize(build(f.b.X, f.b.face, state.range(0)));
}
BENCHMARK(build_tree)->Arg(24)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace elastogear::contact
