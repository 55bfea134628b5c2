#include "elastogear/contact/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "contact/search/coarse_search.h"
#include "surfaces.h"

namespace elastogear::contact::bvh_test {
namespace {

using test::Random;
constexpr int sizes[] = {6, 14, 18, 24, 26};
using Pairs = std::set<NodePair>;

Kdop face_kdop(int k, const Eigen::Matrix3Xd& x, const Eigen::Matrix4Xi& face, int f) {
  return tight_kdop(k, x(Eigen::all, face.col(f)));
}

// Pairs of faces whose exact k-DOPs, one of them wider by a margin, overlap.
Pairs brute_force(int k, const model::Surface& a, const model::Surface& b, const Configuration& c,
                  double margin) {
  Pairs pairs;
  for (int i = 0; i < a.face.cols(); ++i)
    for (int j = 0; j < b.face.cols(); ++j)
      if (overlap(inflated(face_kdop(k, c.x[0], a.face, i), margin), face_kdop(k, c.x[1], b.face, j)))
        pairs.insert({i, j});
  return pairs;
}

model::Surface wavy(int n, double phase) {
  return test::grid(n, n, [=](double u, double v) {
    return Eigen::Vector3d(u, v, 0.1 * std::sin(6 * u + phase) * std::cos(5 * v));
  });
}

Configuration configuration(const model::Surface& a, const model::Surface& b, const Eigen::Vector3d& psi,
                            const Eigen::Vector3d& r, Random& random, double deformation) {
  Configuration c;
  c.R = test::rotation(psi);
  c.r = r;
  Eigen::Matrix3Xd x_a = a.X, x_b = b.X;
  for (auto x : x_a.colwise()) x += random.vector(deformation);
  for (auto x : x_b.colwise()) x += random.vector(deformation);
  c.x[0] = (c.R * x_a).colwise() + c.r;
  c.x[1] = x_b;
  return c;
}

// Inflates every leaf of the exact boxes by what float boxes may be wider.
constexpr double float_slack = 2e-6;

TEST(Bvh, has_every_face_in_one_leaf_and_children_after_their_parent) {
  const model::Surface s = wavy(13, 0);
  for (int k : sizes) {
    const Bvh bvh = build(s.X, s.face, k);
    std::set<int> faces;
    for (int node = 0; node < bvh.n_nodes(); ++node) {
      if (bvh.is_leaf(node))
        EXPECT_TRUE(faces.insert(bvh.face(node)).second);
      else
        EXPECT_GT(bvh.child[node], node);
    }
    EXPECT_EQ(faces.size(), 169u);
    EXPECT_EQ(bvh.n_nodes(), 2 * 169 - 1);
    EXPECT_LT(depth(bvh), 16);
  }
}

TEST(Bvh, float_boxes_enclose_the_double_ones_and_hardly_more) {
  Random random(1);
  for (int k : sizes)
    for (double size : {1e-30, 1e-3, 1.0, 1e6}) {
      model::Surface s = wavy(5, 1);
      for (auto x : s.X.colwise()) x = size * (x + random.vector(1));
      const Bvh bvh = build(s.X, s.face, k);
      for (int node = 0; node < bvh.n_nodes(); ++node) {
        if (!bvh.is_leaf(node)) continue;
        const Kdop exact = face_kdop(k, s.X, s.face, bvh.face(node)), stored = box(bvh, node);
        for (int i = 0; i < k / 2; ++i) {
          EXPECT_LE(stored.lo[i], exact.lo[i]);
          EXPECT_GE(stored.hi[i], exact.hi[i]);
          EXPECT_NEAR(stored.lo[i], exact.lo[i], 8 * size * float_slack);
        }
      }
    }
}

TEST(Bvh, refit_boxes_hold_their_children_and_their_margin) {
  Random random(2);
  const model::Surface s = wavy(6, 0);
  for (int k : sizes) {
    Bvh bvh = build(s.X, s.face, k);
    Eigen::Matrix3Xd x = s.X;
    for (auto p : x.colwise()) p += random.vector(0.3);
    RefitMemory work;
    const double margin = 0.01;
    refit(bvh, x, s.face, margin, work);
    for (int node = 0; node < bvh.n_nodes(); ++node) {
      Kdop inner;
      if (bvh.is_leaf(node)) {
        inner = inflated(face_kdop(k, x, s.face, bvh.face(node)), margin);
      } else {
        inner = box(bvh, bvh.child[node]);
        merge(inner, box(bvh, bvh.child[node] + 1));
      }
      for (int i = 0; i < k / 2; ++i) {
        EXPECT_LE(box(bvh, node).lo[i], inner.lo[i]);
        EXPECT_GE(box(bvh, node).hi[i], inner.hi[i]);
      }
    }
  }
}

TEST(Bvh, boxes_hold_points_far_from_the_origin_with_their_margin) {
  Random random(5);
  for (int k : sizes)
    for (double margin : {0.0, 1e-3, 10.0}) {
      model::Surface s = wavy(5, 1);
      for (auto x : s.X.colwise()) x += random.vector(0.1) + Eigen::Vector3d(-300, 2000, 1);
      Bvh bvh = build(s.X, s.face, k);
      RefitMemory work;
      refit(bvh, s.X, s.face, margin, work);
      for (int node = 0; node < bvh.n_nodes(); ++node) {
        if (!bvh.is_leaf(node)) continue;
        const Kdop exact = inflated(face_kdop(k, s.X, s.face, bvh.face(node)), margin),
                   stored = box(bvh, node);
        for (int i = 0; i < k / 2; ++i) {
          EXPECT_LE(stored.lo[i], exact.lo[i]);
          EXPECT_GE(stored.hi[i], exact.hi[i]);
        }
      }
    }
}

TEST(Bvh, boxes_do_not_depend_on_the_instructions) {
  Random random(6);
  for (int k : sizes) {
    model::Surface s = wavy(20, 1);  // several blocks of nodes
    for (auto x : s.X.colwise()) x += random.vector(0.1);
    Bvh bvh = build(s.X, s.face, k);
    std::vector<float> portable;
    for (Instructions instructions : {Instructions::portable, Instructions::avx2, Instructions::avx512}) {
      if (instructions > best_instructions()) continue;
      RefitMemory work{{}, instructions};
      std::fill(bvh.box.begin(), bvh.box.end(), 0);
      refit(bvh, s.X, s.face, 0.01, work);
      if (portable.empty()) portable = bvh.box;
      EXPECT_EQ(bvh.box, portable) << k;
    }
  }
}

TEST(Bvh, pairs_equal_brute_force) {
  Random random(3);
  const model::Surface a = wavy(11, 0), b = wavy(9, 2);
  std::size_t n_pairs = 0;
  for (int k : sizes)
    for (const Eigen::Vector3d& psi :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.7, 0, 0), Eigen::Vector3d(1, -2, 0.5)}) {
      const Configuration c = configuration(a, b, psi, {0.1, 0.2, 0.05}, random, 0.01);
      for (double margin : {0.0, 0.02}) {
        CoarseSearch search(a, b, k, Update::refit);
        const auto& found = search.face_pairs(c, margin);
        const Pairs pairs(found.begin(), found.end());
        EXPECT_EQ(pairs.size(), found.size()) << "a pair was found twice";
        const Pairs least = brute_force(k, a, b, c, margin),
                    most = brute_force(k, a, b, c, margin + float_slack);
        EXPECT_TRUE(std::includes(pairs.begin(), pairs.end(), least.begin(), least.end())) << k;
        EXPECT_TRUE(std::includes(most.begin(), most.end(), pairs.begin(), pairs.end())) << k;
        n_pairs += least.size();
      }
    }
  EXPECT_GT(n_pairs, 1000u);
}

TEST(Bvh, pairs_of_realigned_trees_hold_those_of_brute_force) {
  Random random(4);
  const model::Surface a = wavy(11, 0), b = wavy(9, 2);
  for (int k : sizes) {
    CoarseSearch search(a, b, k, Update::realign);
    for (const Eigen::Vector3d& psi :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.7, 0, 0), Eigen::Vector3d(1, -2, 0.5)}) {
      const Configuration c = configuration(a, b, psi, {0.1, 0.2, 0.05}, random, 0.01);
      const double deformation = 2 * std::sqrt(3.0) * 0.01;  // of both surfaces, at most
      const auto& found = search.face_pairs(c, 0.02 + deformation);
      const Pairs pairs(found.begin(), found.end()), least = brute_force(k, a, b, c, 0.02);
      EXPECT_EQ(pairs.size(), found.size());
      EXPECT_TRUE(std::includes(pairs.begin(), pairs.end(), least.begin(), least.end())) << k;
      EXPECT_LT(pairs.size(), 99u * 99u) << "nothing was sorted out";
    }
  }
}

TEST(Bvh, of_one_face_finds_its_partner) {
  const model::Surface one = test::plane(1, 1), many = test::plane(7, 7);
  for (Update update : {Update::refit, Update::realign}) {
    Configuration c;
    c.x[0] = one.X, c.x[1] = many.X;
    EXPECT_EQ(CoarseSearch(one, many, 24, update).face_pairs(c, 0).size(), 49u);
    c.x[1] = one.X;
    EXPECT_EQ(CoarseSearch(one, one, 24, update).face_pairs(c, 0).size(), 1u);
  }
}

TEST(Bvh, of_coinciding_faces_is_balanced) {
  model::Surface s = test::plane(1, 1);
  s.face = s.face.replicate(1, 1000).eval();
  EXPECT_EQ(depth(build(s.X, s.face, 18)), 10);
}

TEST(Bvh, nodes_at_any_level_hold_every_face_once) {
  const model::Surface s = wavy(7, 0);
  const Bvh bvh = build(s.X, s.face, 24);
  std::function<int(int)> leaves = [&](int node) {
    return bvh.is_leaf(node) ? 1 : leaves(bvh.child[node]) + leaves(bvh.child[node] + 1);
  };
  for (int level = 0; level <= depth(bvh) + 1; ++level) {
    int sum = 0;
    for (int node : nodes_at_level(bvh, level)) sum += leaves(node);
    EXPECT_EQ(sum, 49);
  }
  EXPECT_EQ(nodes_at_level(bvh, 0).size(), 1u);
  EXPECT_EQ(nodes_at_level(bvh, 1).size(), 2u);
}

}  // namespace
}  // namespace elastogear::contact::bvh_test
