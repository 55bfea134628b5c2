// Coarse and fine contact search on two flank-like surfaces of 10,100 and 11,800 quadrilaterals, 32 x 80 mm,
// tilted by 0.7 rad against the k-DOP axes. `contact` 0: localised, 1: medium, 2: conforming over the full
// width.

#include <benchmark/benchmark.h>

#include <Eigen/Geometry>

#include "elastogear/contact/bvh.h"
#include "elastogear/contact/pair.h"

namespace elastogear::contact {
namespace {

model::Surface flank(int n_u, int n_v, double curvature_u, double curvature_v, bool up) {
  model::Surface s;
  s.X.resize(3, (n_u + 1) * (n_v + 1));
  s.face.resize(4, n_u * n_v);
  const auto node = [&](int i, int j) { return j * (n_u + 1) + i; };
  for (int j = 0; j <= n_v; ++j)
    for (int i = 0; i <= n_u; ++i) {
      const double x = 0.032 * (static_cast<double>(i) / n_u - 0.5),
                   y = 0.08 * (static_cast<double>(j) / n_v - 0.5);
      s.X.col(node(i, j)) << x, y, 0.5 * (curvature_u * x * x + curvature_v * y * y);
    }
  for (int j = 0; j < n_v; ++j)
    for (int i = 0; i < n_u; ++i) {
      auto f = s.face.col(j * n_u + i);
      f << node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1);
      if (!up) f.reverseInPlace();
    }
  s.c_f = Eigen::VectorXd::Constant(s.face.cols(), 1e14);
  return s;
}

struct Flanks {
  model::Surface a, b;
  SurfaceState state_a, state_b;
};

Flanks flanks(int contact) {
  const double curvature[3][2] = {{25, 130}, {5, 60}, {0, 5}};  // 1/m, relative
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const double depth = 10e-6;
  Flanks f{flank(101, 100, curvature[contact][0], curvature[contact][1], false),
           flank(100, 118, 0, 0, true),
           {},
           {}};
  f.state_a = {f.a.X, R * Eigen::Vector3d(1e-4, 2e-4, -depth), R};
  f.state_b = {f.b.X, Eigen::Vector3d::Zero(), R};
  return f;
}

void refit_both_trees(benchmark::State& state) {
  const Flanks f = flanks(0);
  Bvh a = build(f.a.X, f.a.face, state.range(0)), b = build(f.b.X, f.b.face, state.range(0));
  std::vector<float> work;
  for (auto _ : state) {
    refit(a, f.a.X, f.a.face, 0, work);
    refit(b, f.b.X, f.b.face, 0, work);
    benchmark::DoNotOptimize(b.box.data());
  }
}
BENCHMARK(refit_both_trees)->Arg(6)->Arg(18)->Arg(24)->Arg(26)->Unit(benchmark::kMicrosecond);

// Arguments: k, contact, margin in um.
void query(benchmark::State& state) {
  const Flanks f = flanks(state.range(1));
  const Eigen::Matrix3Xd x_a = (f.state_a.R_WB * f.a.X).colwise() + f.state_a.r_WB,
                         x_b = f.state_b.R_WB * f.b.X;
  Bvh a = build(f.a.X, f.a.face, state.range(0)), b = build(f.b.X, f.b.face, state.range(0));
  std::vector<float> work;
  refit(a, x_a, f.a.face, 1e-6 * state.range(2), work);
  refit(b, x_b, f.b.face, 0, work);
  std::vector<NodePair> front, pairs;
  for (auto _ : state) {
    overlapping_faces(a, b, {}, front, pairs);
    benchmark::DoNotOptimize(pairs.data());
  }
  state.counters["pairs"] = static_cast<double>(pairs.size());
  state.counters["tests"] = static_cast<double>(front.size());
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
