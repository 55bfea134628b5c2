#include "contact/projection/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/projection/face_boxes.h"

namespace elastogear::contact {
namespace {

struct Nearest {
  int face = std::numeric_limits<int>::max();
  ClosestPoint point;
  double distance2;
  mutable std::optional<Eigen::Vector3d> outward = {};  // of the surface there, once it is known

  explicit Nearest(double limit2) : distance2(limit2) {}
  bool found() const { return face != std::numeric_limits<int>::max(); }

  // Ties go to the lower face number. Neighbours find bitwise the same point on a shared edge or vertex.
  void offer(int f, const ClosestPoint& p) {
    if (p.distance2 < distance2 || (p.distance2 == distance2 && f < face))
      face = f, point = p, distance2 = p.distance2, outward.reset();
  }
};

double distance_bound(const Face& face, const Eigen::Vector3d& q) {
  Eigen::Vector3d lo = face.x[0], hi = face.x[0];
  for (int i = 1; i < face.sides; ++i) lo = lo.cwiseMin(face.x[i]), hi = hi.cwiseMax(face.x[i]);
  const double extension = *std::max_element(face.extension.begin(), face.extension.end());
  const double reach = 4 * extension * (hi - lo).norm();
  const Eigen::Vector3d out = (lo - q).cwiseMax(q - hi).cwiseMax(0.0);
  return std::max(0.0, out.norm() - reach);
}

// Master faces that a slave node is tried against.
struct Trial {
  const SurfaceView& master;
  Eigen::Vector3d q;
  double depth;
  std::span<const int> faces;
  int likely;
  const FaceBounds* bounds;
};

template <class Accept>
Nearest nearest(const Trial& trial, const Accept& accept) {
  constexpr double kRoundoff = 1e-14;      // which must not decide between faces that are as near
  constexpr double kRoundoffOfWay = 1e-9;  // of a distance; that of positions adds to it
  Nearest best(trial.depth * trial.depth);
  const Eigen::Vector3d q_B = trial.bounds ? trial.bounds->in_surface(trial.q) : trial.q;
  const auto is_beyond = [&](double bound) { return (1 - kRoundoff) * bound * bound > best.distance2; };
  const double of_positions = kRoundoff * trial.q.cwiseAbs().maxCoeff();
  const auto offer = [&](int f) {
    const double far = (1 + kRoundoffOfWay) * std::sqrt(best.distance2) + of_positions;
    if (trial.bounds && (is_beyond(trial.bounds->least(f, q_B)) || trial.bounds->is_farther(f, q_B, far)))
      return;
    const Face face = face_of(trial.master, f);
    if (is_beyond(distance_bound(face, trial.q)) || is_farther(face, trial.q, far)) return;
    const ClosestPoint p = closest_point(face, trial.q);
    if (accept(face, p)) best.offer(f, p);
  };
  const bool known = std::binary_search(trial.faces.begin(), trial.faces.end(), trial.likely);
  if (known) offer(trial.likely);
  for (int f : trial.faces)
    if (!known || f != trial.likely) offer(f);
  return best;
}

// Points outwards at the closest point; zero where the surface is degenerate.
Eigen::Vector3d outward(const SurfaceView& master, int f, const ClosestPoint& p) {
  if (p.feature == Feature::vertex) return node_normal(master, master.face(p.part, f));
  if (p.feature == Feature::edge)
    return edge_normal(master, f, p.part, p.N[(p.part + 1) % side_count(master.face, f)]);
  return normal(face_of(master, f), p.u, p.v);
}

// Points outwards at the nearest point; found once for all that ask for it.
const Eigen::Vector3d& outward(const SurfaceView& master, const Nearest& best) {
  if (!best.outward) best.outward = outward(master, best.face, best.point);
  return *best.outward;
}

enum class Place { inside, outside, on, unknown };

Place place(const SurfaceView& master, const Eigen::Vector3d& q, const Nearest& best) {
  if (!best.found() || best.point.feature == Feature::outside) return Place::unknown;
  const Eigen::Vector3d& n = outward(master, best);
  const double side = (q - best.point.x).dot(n);
  if (side != 0) return side < 0 ? Place::inside : Place::outside;
  return vanishes(q - best.point.x, q) && !n.isZero(0) ? Place::on : Place::unknown;
}

bool is_taken(const SurfaceView& master, const SlaveNode& slave, const Nearest& best, double outside) {
  const Place at = place(master, slave.x, best);
  return at == Place::inside || (at == Place::on && outside > 0) ||
         (at == Place::outside && best.point.distance2 <= outside * outside);
}

Projection make_projection(const SurfaceView& master, const Eigen::Vector3d& q, const Nearest& best) {
  Projection w{best.face, best.point, {}, 0};
  const Eigen::Vector3d d = q - w.point.x;
  if (w.point.feature == Feature::face || vanishes(d, q)) {
    w.n = outward(master, best);
    w.g_n = w.n.dot(d);
  } else {  // x_slave lies in the normal cone of the edge or vertex: n follows it
    const double side = place(master, q, best) == Place::outside ? 1 : -1;
    w.g_n = side * d.stableNorm();
    w.n = d / w.g_n;
  }
  return w;
}

// Tells whether a normal of the master opposes that of the slave node however the slave is deformed: strains
// that are linear leave its normal near the undeformed one.
bool surely_opposes(const Eigen::Vector3d& n, const SlaveNode& slave, const Limits& limits) {
  constexpr double kTurn = 0.4;  // of the cosine, by deformation
  return !slave.undeformed_normal.isZero(0) && n.dot(slave.undeformed_normal) <= limits.cos_angle - kTurn;
}

}  // namespace

bool vanishes(const Eigen::Vector3d& d, const Eigen::Vector3d& q) {
  constexpr double kRoundoff = 1e-13;
  const Eigen::Vector3d foot = q - d;
  return d.squaredNorm() <= kRoundoff * kRoundoff * std::max(q.squaredNorm(), foot.squaredNorm());
}

std::optional<Projection> find_projection(const SurfaceView& master, const SlaveNode& slave,
                                          const Limits& limits, std::span<const int> faces, int* likely,
                                          double* clearance) {
  const int first = likely ? *likely : -1;
  const Trial trial{master, slave.x, limits.depth, faces, first, slave.bounds};
  const Nearest any = nearest(trial, [](auto&&...) { return true; });
  if (!any.found()) return {};
  if (likely) *likely = any.face;
  const bool is_far = any.distance2 > limits.outside * limits.outside;
  if (is_far && place(master, slave.x, any) == Place::outside) {
    if (clearance) *clearance = std::sqrt(any.distance2);
    return {};
  }
  std::optional<Eigen::Vector3d> n_slave;
  const auto opposes_slave = [&](const Eigen::Vector3d& n) {
    if (surely_opposes(n, slave, limits)) return true;
    if (!n_slave) n_slave = slave.normal();
    return n.dot(*n_slave) <= limits.cos_angle;
  };
  const auto opposes = [&](const Face& face, const ClosestPoint& p) {
    return opposes_slave(normal(face, p.u, p.v));
  };
  const bool settled = any.point.feature == Feature::face ? opposes_slave(outward(master, any))
                                                          : opposes(face_of(master, any.face), any.point);
  const auto all = [&] { return slave.all_faces ? slave.all_faces() : faces; };
  const Nearest best =
      settled ? any : nearest({master, slave.x, trial.depth, all(), first, slave.bounds}, opposes);
  if (!is_taken(master, slave, best, limits.outside)) return {};
  return make_projection(master, slave.x, best);
}

std::optional<Projection> walk_to_projection(const SurfaceView& master, const Eigen::Vector3d& x,
                                             const Limits& limits, int start) {
  Nearest best(std::numeric_limits<double>::infinity());
  best.offer(start, closest_point(face_of(master, start), x));
  const Topology& t = master.topology;
  for (int from = -1; from != best.face;) {
    from = best.face;
    if (best.point.feature != Feature::edge && best.point.feature != Feature::vertex) break;
    const int part = best.point.part;
    if (best.point.feature == Feature::edge && t.edge(part, from) < 0) break;
    const std::span<const int> around = best.point.feature == Feature::edge
                                            ? t.edge_sides[t.edge(part, from)]
                                            : t.node_corners[master.face(part, from)];
    for (int entry : around)
      if (entry / 4 != from) best.offer(entry / 4, closest_point(face_of(master, entry / 4), x));
  }
  if (best.distance2 > limits.depth * limits.depth) return {};
  if (place(master, x, best) != Place::on && !is_taken(master, {x, {}}, best, limits.outside)) return {};
  return make_projection(master, x, best);
}

std::optional<Projection> extended_projection(const Face& face, const Eigen::Vector3d& q, Projection w) {
  constexpr double kBeyond = 0.25;  // of local coordinates
  constexpr int kNewtonSteps = 8;
  const Eigen::Vector2d start(w.point.u, w.point.v);
  Eigen::Vector2d at = start;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Shape s = shape(face.sides, at[0], at[1]);
    Eigen::Matrix<double, 3, 2> a;
    a << combine(face, s.N_u), combine(face, s.N_v);
    const Eigen::Vector3d d = q - combine(face, s.N);
    Eigen::Matrix2d A = a.transpose() * a;
    A(0, 1) -= d.dot(combine(face, s.N_uv));
    A(1, 0) = A(0, 1);
    at += A.inverse() * (a.transpose() * d);
    if (!((at - start).cwiseAbs().maxCoeff() <= kBeyond)) return {};
  }
  const Shape s = shape(face.sides, at[0], at[1]);
  w.point = {Feature::face, 0, at[0], at[1], s.N, combine(face, s.N), 0};
  w.n = normal(face, at[0], at[1]);
  w.g_n = w.n.dot(q - w.point.x);
  return w;
}

Approach approach(const SurfaceView& master, const Eigen::Vector3d& x, const Move& move,
                  std::span<const int> faces) {
  const auto& [reach, limit, around, bounds] = move;
  const Nearest any = nearest({master, x, reach, faces, -1, bounds}, [](auto&&...) { return true; });
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!any.found()) return {kInfinity, kInfinity, {}, {}};
  const double distance = std::sqrt(any.distance2);
  Approach result{distance, place(master, x, any) == Place::outside ? distance : 0, {}, {}};
  if (result.clearance > limit) return result;
  const Eigen::Vector3d x_B = bounds ? bounds->in_surface(x) : x;
  const double farthest = std::max(distance, around) + 2 * limit;
  for (int f : faces) {  // all move by `limit`
    const double of_undeformed = bounds ? bounds->least(f, x_B) : 0;
    if (of_undeformed > farthest) continue;
    const double bound = bounds && around == 0 ? of_undeformed : distance_bound(face_of(master, f), x);
    if (bound <= distance + 2 * limit) result.faces.push_back(f);
    if (around > 0 && bound <= around + 2 * limit) result.around.push_back(f);
  }
  return result;
}

}  // namespace elastogear::contact
