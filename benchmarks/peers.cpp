// The coarse search of contact.cpp by two other libraries, on the same surfaces in the same frame: FCL
// (KDOP<24> over triangles, with the flags of this build) and Embree (boxes over quadrilaterals, rtcCollide).
// All list every overlapping pair of leaves.

#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>
#include <fcl/math/bv/utility.h>
// utility.h declares fit(), which BVH_model.h needs
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/detail/traversal/collision/bvh_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/traversal_recurse.h>

#include <algorithm>
#include <array>
#include <vector>

#include "flanks.h"

namespace elastogear::contact {
namespace {

using Box = fcl::KDOP<double, 24>;
using Model = fcl::BVHModel<Box>;
using PairList = std::vector<std::array<int, 2>>;

void add_triangles(Model& model, const Eigen::Matrix3Xd& x, const Eigen::Matrix4Xi& face) {
  std::vector<fcl::Vector3d> points;
  std::vector<fcl::Triangle> triangles;
  for (const auto& p : x.colwise()) points.emplace_back(p);
  for (const auto& f : face.colwise()) {
    triangles.emplace_back(f[0], f[1], f[2]);
    triangles.emplace_back(f[0], f[2], f[3]);
  }
  model.beginModel();
  model.addSubModel(points, triangles);
  model.endModel();
}

void move_vertices(Model& model, const Eigen::Matrix3Xd& x) {
  model.beginReplaceModel();
  for (const auto& p : x.colwise()) model.replaceVertex(p);
  model.endReplaceModel(true, true);
}

class LeafPairs : public fcl::detail::BVHCollisionTraversalNode<Box> {
 public:
  explicit LeafPairs(PairList& pairs) : pairs_(pairs) {}
  void leafTesting(int a, int b) const override {
    pairs_.push_back({model1->getBV(a).primitiveId(), model2->getBV(b).primitiveId()});
  }
  bool canStop() const override { return false; }

 private:
  PairList& pairs_;
};

void fcl_query(benchmark::State& state) {
  const auto [f, x_a, x_b] = placed_flanks(state.range(0));
  Model a, b;
  add_triangles(a, x_a, f.a.face);
  add_triangles(b, x_b, f.b.face);
  PairList pairs;
  LeafPairs node(pairs);
  node.model1 = &a;
  node.model2 = &b;
  for (auto _ : state) {
    pairs.clear();
    fcl::detail::collisionRecurse<double>(&node, 0, 0, nullptr);
    benchmark::DoNotOptimize(pairs.data());
  }
  state.counters["pairs"] = static_cast<double>(pairs.size());
}
BENCHMARK(fcl_query)->ArgName("contact")->DenseRange(0, 2)->Unit(benchmark::kMicrosecond);

void fcl_refit_both_trees(benchmark::State& state) {
  const auto [f, x_a, x_b] = placed_flanks(0);
  Model a, b;
  add_triangles(a, x_a, f.a.face);
  add_triangles(b, x_b, f.b.face);
  for (auto _ : state) {
    move_vertices(a, x_a);
    move_vertices(b, x_b);
  }
}
BENCHMARK(fcl_refit_both_trees)->Unit(benchmark::kMicrosecond);

// One surface as an Embree scene of user geometry: one box per quadrilateral.
struct Scene {
  const Eigen::Matrix3Xd* x;
  const Eigen::Matrix4Xi* face;
  RTCScene scene;

  static void bounds(const RTCBoundsFunctionArguments* arguments) {
    const auto& self = *static_cast<const Scene*>(arguments->geometryUserPtr);
    const Eigen::Matrix<float, 3, 4> corner =
        (*self.x)(Eigen::all, self.face->col(static_cast<int>(arguments->primID))).cast<float>();
    const Eigen::Vector3f lo = corner.rowwise().minCoeff(), hi = corner.rowwise().maxCoeff();
    *arguments->bounds_o = {lo[0], lo[1], lo[2], 0, hi[0], hi[1], hi[2], 0};
  }

  Scene(RTCDevice device, const Eigen::Matrix3Xd& points, const Eigen::Matrix4Xi& faces)
      : x(&points), face(&faces), scene(rtcNewScene(device)) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(faces.cols()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
  }
  ~Scene() { rtcReleaseScene(scene); }
  Scene(const Scene&) = delete;
};

void append(void* list, RTCCollision* found, unsigned count) {
  auto& pairs = *static_cast<PairList*>(list);
  for (unsigned i = 0; i < count; ++i)
    pairs.push_back({static_cast<int>(found[i].primID0), static_cast<int>(found[i].primID1)});
}

void embree_query(benchmark::State& state) {
  const auto [f, x_a, x_b] = placed_flanks(state.range(0));
  RTCDevice device = rtcNewDevice("threads=1");
  PairList pairs;
  {
    const Scene a(device, x_a, f.a.face), b(device, x_b, f.b.face);
    for (auto _ : state) {
      pairs.clear();
      rtcCollide(a.scene, b.scene, append, &pairs);
      benchmark::DoNotOptimize(pairs.data());
    }
  }
  rtcReleaseDevice(device);
  state.counters["pairs"] = static_cast<double>(pairs.size());
}
BENCHMARK(embree_query)->ArgName("contact")->DenseRange(0, 2)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace elastogear::contact
