#include "elastogear/contact/load_table.h"

#include <algorithm>
#include <cmath>

#include "contact/stations/smooth_load.h"

namespace elastogear::contact {
namespace {

constexpr double kStep = 0.5;  // of the half width of loads, between places

// The loads across the profile at all places.
std::vector<AcrossLoad> across_loads(const LoadTable& table, const FlankGrid& flank) {
  std::vector<AcrossLoad> loads;
  for (int g = 0; g < table.n_v; ++g)
    loads.push_back(across_load(table.v_0 + g * table.step, table.width.a, flank.v.front(), flank.v.back()));
  return loads;
}

void set_weights(const FlankGrid& flank, const std::function<double(double v)>& slope, LoadTable& table) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int g = 0; g < table.n_v; ++g) {
    std::vector<StationPlace> stations;
    const double v = table.v_0 + g * table.step;
    for (const Strip& strip : table.strips) stations.push_back({strip, v, slope(v)});
    const Eigen::MatrixXd weight = consistent_weights(flank, stations, {table.width.a, 0});
    for (Eigen::Index i = 0; i < weight.rows(); ++i)
      for (Eigen::Index a = 0; a < weight.cols(); ++a)
        if (weight(i, a) != 0)
          entries.emplace_back(static_cast<int>(i) * table.n_v + g, static_cast<int>(a), weight(i, a));
  }
  table.W.resize(static_cast<Eigen::Index>(table.n()) * table.n_v, flank.n_nodes);
  table.W.setFromTriplets(entries.begin(), entries.end());
}

// Strips have one length, so that what they do to each other depends on the difference of their numbers, and
// what the image of one does on the sum.
class SmoothTable {
 public:
  SmoothTable(const FlankGrid& flank, const std::function<double(double v)>& slope, LoadTable& table)
      : table_(table), flank_(flank), across_(across_loads(table, flank)) {
    for (int g = 0; g < table.n_v; ++g) slope_.push_back(slope(table.v_0 + g * table.step));
  }
  void fill() {
    const Eigen::Index size = static_cast<Eigen::Index>(table_.n()) * table_.n_v;
    table_.smooth = Eigen::MatrixXd::Zero(size, size);
    add_direct();
    add_images();
  }

 private:
  Strip along(int i) const {
    const Strip& strip = table_.strips[static_cast<std::size_t>(i)];
    return {strip.from * table_.scale.along, strip.to * table_.scale.along};
  }
  double place(int g) const { return table_.v_0 + g * table_.step; }
  AcrossLoad seen(int g, double shift) const {
    return across_[static_cast<std::size_t>(g)].seen_from(place(g) - shift, table_.scale.across);
  }
  double& entry(int i, int g, int j, int h) {
    return table_.smooth(static_cast<Eigen::Index>(i) * table_.n_v + g,
                         static_cast<Eigen::Index>(j) * table_.n_v + h);
  }

  void add_direct() {
    for (int k = 0; k < table_.n(); ++k)  // strip k at the place h beside strip 0 at the place g
      for (int g = 0; g < table_.n_v; ++g)
        for (int h = 0; h < table_.n_v; ++h) {
          const double z = table_.strips[static_cast<std::size_t>(k)].centre() - table_.strips[0].centre();
          const double slope =
              (slope_[static_cast<std::size_t>(g)] + slope_[static_cast<std::size_t>(h)]) / 2;
          const double shift = place(h) - place(g) - slope * z;
          const double mean = smooth_inverse_distance(seen(g, 0), along(0), seen(h, shift), along(k));
          for (int i = 0; i + k < table_.n(); ++i) entry(i, g, i + k, h) = entry(i + k, h, i, g) = mean;
        }
  }
  void add_images() {
    const FreeEnds ends{flank_.z.front() * table_.scale.along, flank_.z.back() * table_.scale.along};
    const int n = table_.n();
    for (int sum = 0; sum <= 2 * (n - 1); ++sum) {
      const int i_0 = std::max(0, sum - n + 1), j_0 = sum - i_0;
      for (int g = 0; g < table_.n_v; ++g)
        for (int h = 0; h < table_.n_v; ++h) {
          double mean = 0;
          for (const Strip& image : images(along(j_0), ends))
            mean += ends.share *
                    smooth_inverse_distance(seen(g, 0), along(i_0), seen(h, place(h) - place(g)), image);
          for (int i = i_0; i <= j_0; ++i) entry(i, g, sum - i, h) += mean;
        }
    }
  }

  LoadTable& table_;
  const FlankGrid& flank_;
  std::vector<AcrossLoad> across_;
  std::vector<double> slope_;
};

}  // namespace

std::vector<Strip> pieces_of(const std::vector<Strip>& strips, int pieces) {
  std::vector<Strip> parts;
  for (const Strip& strip : strips)
    for (int i = 0; i < pieces; ++i)
      parts.push_back(
          {strip.from + strip.length() * i / pieces, strip.from + strip.length() * (i + 1) / pieces});
  return parts;
}

LoadTable load_table(const FlankGrid& flank, const std::vector<Strip>& strips, int pieces,
                     const std::function<double(double v)>& slope, const LineScale& scale, double q) {
  LoadTable table;
  table.strips = strips;
  table.pieces = pieces;
  table.width = load_width(flank);
  table.scale = scale;
  table.q = q;
  table.v_0 = flank.v.front();
  const double height = flank.v.back() - flank.v.front();
  table.n_v = static_cast<int>(std::max(3., std::ceil(height / (kStep * table.width.a)))) + 1;
  table.step = height / (table.n_v - 1);
  const Eigen::MatrixXd Z = spread_along(strips, table.width.c);
  table.Z.resize(table.n() * pieces, table.n());
  for (Eigen::Index i = 0; i < table.Z.rows(); ++i) table.Z.row(i) = Z.row(i / pieces);
  set_weights(flank, slope, table);
  SmoothTable(flank, slope, table).fill();
  std::vector<Strip> along;
  for (const Strip& part : pieces_of(strips, pieces))
    along.push_back({part.from * scale.along, part.to * scale.along});
  table.line = line_kernel(along, q, {flank.z.front() * scale.along, flank.z.back() * scale.along});
  return table;
}

Stencil stencil(const LoadTable& table, double v) {
  const double x = std::clamp((v - table.v_0) / table.step, 0., table.n_v - 1.);
  const int cell = std::min(static_cast<int>(x), table.n_v - 2);
  const double t = x - cell;
  Stencil s;
  s.N = {t * (-1 + t * (2 - t)) / 2, 1 + t * t * (-5 + 3 * t) / 2, t * (1 + t * (4 - 3 * t)) / 2,
         t * t * (t - 1) / 2};
  s.dN = {(-1 + t * (4 - 3 * t)) / 2, t * (-10 + 9 * t) / 2, (1 + t * (8 - 9 * t)) / 2, t * (3 * t - 2) / 2};
  s.first = cell - 1;
  // Places beyond the ends are linear continuations of the two there.
  if (s.first < 0) {
    for (auto* w : {&s.N, &s.dN}) *w = {2 * (*w)[0] + (*w)[1], (*w)[2] - (*w)[0], (*w)[3], 0};
    ++s.first;
  }
  if (s.first + 3 > table.n_v - 1) {
    for (auto* w : {&s.N, &s.dN}) *w = {0, (*w)[0], (*w)[1] - (*w)[3], (*w)[2] + 2 * (*w)[3]};
    --s.first;
  }
  for (double& d : s.dN) d /= table.step;
  return s;
}

Eigen::MatrixXd smooth_kernel(const LoadTable& table, const std::vector<Stencil>& at) {
  using Eigen::Vector4d;
  const auto n = std::ssize(at);
  Eigen::MatrixXd H(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      const Stencil &a = at[static_cast<std::size_t>(i)], &b = at[static_cast<std::size_t>(j)];
      const auto block = table.smooth.block<4, 4>(i * table.n_v + a.first, j * table.n_v + b.first);
      H(i, j) = H(j, i) = Vector4d::Map(a.N.data()).dot(block * Vector4d::Map(b.N.data()));
    }
  return table.Z * H * table.Z.transpose();
}

Eigen::MatrixXd weights(const LoadTable& table, const std::vector<Stencil>& at) {
  Eigen::MatrixXd weight = Eigen::MatrixXd::Zero(std::ssize(at), table.W.cols());
  for (Eigen::Index i = 0; i < weight.rows(); ++i) {
    const Stencil& s = at[static_cast<std::size_t>(i)];
    for (int k = 0; k < 4; ++k)
      for (decltype(table.W)::InnerIterator entry(table.W, i * table.n_v + s.first + k); entry; ++entry)
        weight(i, entry.col()) += s.N[static_cast<std::size_t>(k)] * entry.value();
  }
  return weight;
}

Eigen::MatrixXd response_table(const LoadTable& a, const std::vector<int>& nodes_a, const LoadTable& b,
                               const std::vector<int>& nodes_b, const NodalResponse& response) {
  const auto n_a = std::ssize(nodes_a), n_b = std::ssize(nodes_b);
  std::array<Eigen::MatrixXd, 9> F;
  F.fill(Eigen::MatrixXd(n_a, n_b));
  for (Eigen::Index i = 0; i < n_a; ++i)
    for (Eigen::Index j = 0; j < n_b; ++j) {
      const Eigen::Matrix3d F_ij =
          response(nodes_a[static_cast<std::size_t>(i)], nodes_b[static_cast<std::size_t>(j)]);
      for (Eigen::Index k = 0; k < 9; ++k) F[static_cast<std::size_t>(k)](i, j) = F_ij(k / 3, k % 3);
    }
  Eigen::MatrixXd table(3 * a.W.rows(), 3 * b.W.rows());
  for (Eigen::Index k = 0; k < 9; ++k) {
    const Eigen::MatrixXd of_a = a.W * F[static_cast<std::size_t>(k)];
    const Eigen::MatrixXd part = (b.W * of_a.transpose()).transpose();
    for (Eigen::Index j = 0; j < part.cols(); ++j)
      for (Eigen::Index i = 0; i < part.rows(); ++i) table(3 * i + k / 3, 3 * j + k % 3) = part(i, j);
  }
  return table;
}

namespace {

using Vector12 = Eigen::Matrix<double, 12, 1>;

// 12 x n: the weights of a stencil's places times each force.
Eigen::MatrixXd directed(const std::vector<Stencil>& at, const Eigen::Matrix3Xd& force) {
  Eigen::MatrixXd weights(12, force.cols());
  for (Eigen::Index i = 0; i < force.cols(); ++i)
    for (Eigen::Index k = 0; k < 4; ++k)
      weights.col(i).segment<3>(3 * k) =
          at[static_cast<std::size_t>(i)].N[static_cast<std::size_t>(k)] * force.col(i);
  return weights;
}

}  // namespace

Eigen::MatrixXd responses(const LoadTable& a, const std::vector<Stencil>& at_a,
                          const Eigen::Matrix3Xd& direction_a, const LoadTable& b,
                          const std::vector<Stencil>& at_b, const Eigen::Matrix3Xd& direction_b,
                          const Eigen::MatrixXd& table) {
  const Eigen::MatrixXd w_a = directed(at_a, direction_a), w_b = directed(at_b, direction_b);
  Eigen::MatrixXd C(w_a.cols(), w_b.cols());
  for (Eigen::Index j = 0; j < C.cols(); ++j) {
    const Eigen::Index column = 3 * (j * b.n_v + at_b[static_cast<std::size_t>(j)].first);
    const Vector12 of_b = w_b.col(j);
    for (Eigen::Index i = 0; i < C.rows(); ++i) {
      const Eigen::Index row = 3 * (i * a.n_v + at_a[static_cast<std::size_t>(i)].first);
      const Vector12 there = table.block<12, 12>(row, column).lazyProduct(of_b);
      C(i, j) = w_a.col(i).dot(there);
    }
  }
  return a.Z * C * b.Z.transpose();
}

void add_responses(const LoadTable& a, const std::vector<Stencil>& at_a, const LoadTable& b,
                   const std::vector<Stencil>& at_b, const Eigen::Matrix3Xd& force_b,
                   const Eigen::MatrixXd& table, StationDisplacements& displacements) {
  const Eigen::MatrixXd w_b = directed(at_b, force_b);
  for (Eigen::Index j = 0; j < w_b.cols(); ++j) {
    const Vector12 of_b = w_b.col(j);
    if (of_b.isZero(0)) continue;
    const Eigen::Index column = 3 * (j * b.n_v + at_b[static_cast<std::size_t>(j)].first);
    for (Eigen::Index i = 0; i < displacements.u.cols(); ++i) {
      const Stencil& s = at_a[static_cast<std::size_t>(i)];
      const Vector12 there = table.block<12, 12>(3 * (i * a.n_v + s.first), column).lazyProduct(of_b);
      const auto of_places = there.reshaped<Eigen::ColMajor>(3, 4);
      displacements.u.col(i) += of_places * Eigen::Vector4d::Map(s.N.data());
      displacements.u_v.col(i) += of_places * Eigen::Vector4d::Map(s.dN.data());
    }
  }
}

StationDisplacements displacements(const LoadTable& table, const std::vector<Stencil>& at,
                                   const Eigen::Matrix3Xd& of_nodes) {
  StationDisplacements all{Eigen::Matrix3Xd::Zero(3, std::ssize(at)),
                           Eigen::Matrix3Xd::Zero(3, std::ssize(at))};
  for (Eigen::Index i = 0; i < all.u.cols(); ++i) {
    const Stencil& s = at[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < 4; ++k) {
      Eigen::Vector3d u = Eigen::Vector3d::Zero();
      for (decltype(table.W)::InnerIterator entry(table.W, i * table.n_v + s.first + static_cast<int>(k));
           entry; ++entry)
        u += entry.value() * of_nodes.col(entry.col());
      all.u.col(i) += s.N[k] * u;
      all.u_v.col(i) += s.dN[k] * u;
    }
  }
  return all;
}

Eigen::VectorXd smooth_slopes(const LoadTable& a, const std::vector<Stencil>& at,
                              const Eigen::VectorXd& force) {
  using Eigen::Vector4d;
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(std::ssize(at));
  for (Eigen::Index i = 0; i < slope.size(); ++i)
    for (Eigen::Index j = 0; j < slope.size(); ++j) {
      if (force[j] == 0) continue;
      const Stencil &s = at[static_cast<std::size_t>(i)], &b = at[static_cast<std::size_t>(j)];
      const Vector4d there =
          a.smooth.block<4, 4>(i * a.n_v + s.first, j * a.n_v + b.first) * Vector4d::Map(b.N.data());
      slope[i] += force[j] * Vector4d::Map(s.dN.data()).dot(there);
    }
  return slope;
}

}  // namespace elastogear::contact
