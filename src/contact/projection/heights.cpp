#include "contact/projection/heights.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "contact/projection/smoothing.h"
#include "elastogear/base/error.h"

namespace elastogear::contact {
namespace {

constexpr int kP = kHeightPoints;
using Terms = Eigen::Matrix<double, kP, 1>;

// The Chebyshev polynomials T_0 .. T_{kP-1} with their first two derivatives.
struct Chebyshev {
  Terms T = Terms::Zero(), T_t = Terms::Zero(), T_tt = Terms::Zero();
};

Chebyshev chebyshev(double t) {
  Chebyshev c;
  c.T[0] = 1;
  c.T[1] = t;
  c.T_t[1] = 1;
  for (int i = 2; i < kP; ++i) {
    c.T[i] = 2 * t * c.T[i - 1] - c.T[i - 2];
    c.T_t[i] = 2 * c.T[i - 1] + 2 * t * c.T_t[i - 1] - c.T_t[i - 2];
    c.T_tt[i] = 4 * c.T_t[i - 1] + 2 * t * c.T_tt[i - 1] - c.T_tt[i - 2];
  }
  return c;
}

// The coordinate a in [-1, 1] of the stretched t, Eq. (6.19b).
double unstretched(double stretch, double t) { return t + stretch * (t * t - 1) / 2; }

double stretched(double stretch, double a) {
  const double root = std::sqrt((1 - stretch) * (1 - stretch) + 2 * stretch * (1 + a));
  return (2 * a + stretch) / (root + 1);
}

// The side, at -1 or 1 of the stretched coordinate, where the stretch is finest.
double fine_side(const Stretch& stretch) { return stretch.amount > 0 ? -1 : 1; }

// Returns whether heights go on as straight lines, and fall, beyond an end, -1 or 1, of that coordinate.
bool falls_beyond(const Stretch& stretch, double end) {
  return stretch.fall > 0 && end == fine_side(stretch);
}

// The Chebyshev polynomials of the stretched coordinate and their derivatives with a; beyond |a| = 1 each one
// goes on as its parabola there, or where heights fall as its tangent.
Chebyshev chebyshev(const Stretch& stretch, double a) {
  const double end = std::clamp(a, -1.0, 1.0), beyond = a - end, t = stretched(stretch.amount, end);
  const double t_a = 1 / (1 + stretch.amount * t), t_aa = -stretch.amount * t_a * t_a * t_a;
  Chebyshev c = chebyshev(t);
  c.T_tt = t_a * t_a * c.T_tt + t_aa * c.T_t;
  c.T_t *= t_a;
  if (beyond != 0) {
    if (falls_beyond(stretch, end)) c.T_tt.setZero();
    c.T += beyond * (c.T_t + 0.5 * beyond * c.T_tt);
    c.T_t += beyond * c.T_tt;
  }
  return c;
}

// The coordinate that is stretched, as a function of both with its derivatives, Eq. (6.19c).
FaceFunction bent(const Stretch& stretch, const Eigen::Vector2d& at) {
  const int k = stretch.along;
  const double across = at[1 - k], from = at[k] + fine_side(stretch), beta = stretch.bulge;
  FaceFunction p;
  p.f = at[k] + beta / 2 * (1 - across * across) * from;
  p.f_a[k] = 1 + beta / 2 * (1 - across * across);
  p.f_a[1 - k] = -beta * across * from;
  p.f_ab(0, 1) = p.f_ab(1, 0) = -beta * across;
  p.f_ab(1 - k, 1 - k) = -beta * from;
  return p;
}

// How far heights fall beyond the line that they begin at, Eq. (6.19d). begin: bent(stretch, ...).
FaceFunction fall_beyond(const Stretch& stretch, const FaceFunction& begin) {
  constexpr double kRounded = 1e-3;  // of half a face, of the edge there
  const double side = fine_side(stretch), beyond = side * begin.f - 1;
  if (stretch.fall == 0 || beyond <= 0) return {};
  const double root = std::hypot(beyond, kRounded), slope = stretch.fall * beyond / root * side;
  const double curvature = stretch.fall * kRounded * kRounded / (root * root * root);
  return {stretch.fall * (root - kRounded), slope * begin.f_a,
          curvature * begin.f_a * begin.f_a.transpose() + slope * begin.f_ab};
}

// (u, v) where heights of a face are known.
Eigen::Vector2d sampled_at(int sides, const Stretch& stretch, Eigen::Index p) {
  Eigen::Vector2d at = height_points(sides)[static_cast<std::size_t>(p)];
  if (sides == 3) return at;
  const int k = stretch.along;
  const double half = stretch.bulge / 2 * (1 - at[1 - k] * at[1 - k]);
  at[k] = (unstretched(stretch.amount, at[k]) - fine_side(stretch) * half) / (1 + half);
  return at;
}

std::vector<Eigen::Vector2d> quadrilateral_points() {
  std::vector<Eigen::Vector2d> points;
  const auto lobatto = [](int i) { return -std::cos(std::numbers::pi * i / (kP - 1)); };
  for (int j = 0; j < kP; ++j)
    for (int i = 0; i < kP; ++i) points.emplace_back(lobatto(i), lobatto(j));
  return points;
}

std::vector<Eigen::Vector2d> triangle_points() {
  std::vector<Eigen::Vector2d> points;
  for (int j = 0; j < kP; ++j)
    for (int i = 0; i + j < kP; ++i) points.push_back(Eigen::Vector2d(i, j) / (kP - 1));
  return points;
}

// The terms (i, j) of a face: all on quadrilaterals, i + j < kP on triangles.
std::vector<std::pair<int, int>> terms_of(int sides) {
  std::vector<std::pair<int, int>> terms;
  for (int j = 0; j < kP; ++j)
    for (int i = 0; i < kP; ++i)
      if (sides == 4 || i + j < kP) terms.emplace_back(i, j);
  return terms;
}

// From heights at the height_points to the coefficients of the terms.
Eigen::MatrixXd interpolation(int sides) {
  const auto& points = height_points(sides);
  const auto terms = terms_of(sides);
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd values(n, n);
  for (Eigen::Index p = 0; p < n; ++p) {
    const Eigen::Vector2d t = sides == 4 ? points[p] : Eigen::Vector2d(2 * points[p].array() - 1);
    const Terms a = chebyshev(t[0]).T, b = chebyshev(t[1]).T;
    for (Eigen::Index j = 0; j < n; ++j) values(p, j) = a[terms[j].first] * b[terms[j].second];
  }
  return values.inverse();
}

FaceHeights interpolated(int sides, const ExactHeights& samples) {
  static const Eigen::MatrixXd of_triangle = interpolation(3), of_quadrilateral = interpolation(4);
  static const auto triangle_terms = terms_of(3), quadrilateral_terms = terms_of(4);
  const Eigen::VectorXd coefficient = (sides == 4 ? of_quadrilateral : of_triangle) * samples.value;
  const auto& terms = sides == 4 ? quadrilateral_terms : triangle_terms;
  FaceHeights heights{HeightCoefficients::Zero(), samples.stretch};
  for (std::size_t t = 0; t < terms.size(); ++t)
    heights.C(terms[t].first, terms[t].second) = coefficient[static_cast<Eigen::Index>(t)];
  return heights;
}

void require_fits(const TrueSurface& known, const SurfaceView& surface) {
  const auto n_faces = static_cast<std::size_t>(surface.face.cols());
  require(known.height.empty() || known.height.size() == n_faces, "contact: exact heights of ",
          known.height.size(), " faces given, the surface has ", n_faces);
  require(known.deviation.size() == 0 || known.deviation.size() == surface.x.cols(),
          "contact: deviations of ", known.deviation.size(), " nodes given, the surface has ",
          surface.x.cols());
  require(known.deviation.allFinite(), "contact: a deviation is not finite");
  for (std::size_t f = 0; f < known.height.size(); ++f) {
    const Eigen::VectorXd& h = known.height[f].value;
    const Stretch& stretch = known.height[f].stretch;
    const int sides = side_count(surface.face, static_cast<int>(f));
    const auto n = height_points(sides).size();
    require(h.size() == 0 || h.size() == static_cast<Eigen::Index>(n), "contact: ", h.size(),
            " exact heights of face ", f, " given, it has ", n, " points");
    require(h.allFinite(), "contact: an exact height of face ", f, " is not finite");
    const bool bends = stretch.amount != 0 || stretch.bulge != 0;
    require(!bends || (sides == 4 && std::abs(stretch.amount) < 1 && stretch.bulge >= 0 &&
                       stretch.bulge < 1 && (stretch.along == 0 || stretch.along == 1)),
            "contact: face ", f, " with ", sides, " sides has the stretch ", stretch.amount, " along ",
            stretch.along, " and the bulge ", stretch.bulge,
            "; must be between -1 and 1 along 0 or 1, and 0 to 1, on quadrilaterals");
    require(stretch.fall == 0 || (stretch.amount != 0 && stretch.fall > 0 && std::isfinite(stretch.fall)),
            "contact: face ", f, " with the stretch ", stretch.amount, " has the fall ", stretch.fall,
            " m; must be above 0, of a stretched face");
  }
}

ExactHeights smooth_samples(int sides, const CornerSlopes& slopes) {
  const auto& points = height_points(sides);
  Eigen::VectorXd h(static_cast<Eigen::Index>(points.size()));
  for (Eigen::Index p = 0; p < h.size(); ++p) h[p] = smooth_height(sides, slopes, points[p][0], points[p][1]);
  return {h};
}

// sum_ij C_ij a_i b_j with the derivatives with the coordinates of a and b.
FaceFunction sum_of(const HeightCoefficients& C, const Chebyshev& a, const Chebyshev& b) {
  const Terms by_b = C * b.T, by_b_t = C * b.T_t, by_b_tt = C * b.T_tt;
  FaceFunction h;
  h.f = a.T.dot(by_b);
  h.f_a << a.T_t.dot(by_b), a.T.dot(by_b_t);
  const double mixed = a.T_t.dot(by_b_t);
  h.f_ab << a.T_tt.dot(by_b), mixed, mixed, a.T.dot(by_b_tt);
  return h;
}

FaceFunction polynomial(const FaceHeights& heights, int sides, double u, double v) {
  if (sides == 3) {
    FaceFunction h = sum_of(heights.C, chebyshev(Stretch{}, 2 * u - 1), chebyshev(Stretch{}, 2 * v - 1));
    h.f_a *= 2;
    h.f_ab *= 4;
    return h;
  }
  const int k = heights.stretch.along;
  const FaceFunction p = bent(heights.stretch, {u, v});
  const Chebyshev along = chebyshev(heights.stretch, p.f), across = chebyshev(Stretch{}, k == 0 ? v : u);
  FaceFunction h = k == 0 ? sum_of(heights.C, along, across) : sum_of(heights.C, across, along);
  Eigen::Matrix2d J = Eigen::Matrix2d::Identity();  // of the bent coordinates
  J.row(k) = p.f_a.transpose();
  h.f_ab = (J.transpose() * h.f_ab * J + h.f_a[k] * p.f_ab).eval();
  h.f_a = (J.transpose() * h.f_a).eval();
  const FaceFunction fall = fall_beyond(heights.stretch, p);
  return {h.f - fall.f, h.f_a - fall.f_a, h.f_ab - fall.f_ab};
}

// The length of the gradient of (6.19) on the surface itself: a height over the distance along its normal.
double gradient_length(const Face& face, const FaceFunction& h, const Shape& s) {
  Eigen::Matrix<double, 3, 2> a;
  a << combine(face, s.N_u), combine(face, s.N_v);
  const Eigen::Matrix2d metric = a.transpose() * a;
  const double slope = h.f_a.dot(metric.inverse() * h.f_a);
  return std::isfinite(slope) ? std::sqrt(1 + slope) : 1;  // 1 where the face is degenerate
}

// Adds deviations, which count along the normal of the surface, to its heights h at the height_points.
void add_deviation(const SurfaceView& surface, int f, const Eigen::VectorXd& deviation, ExactHeights& h) {
  const Face face = face_of(surface, f);
  const FaceHeights without = interpolated(face.sides, h);
  for (Eigen::Index p = 0; p < h.value.size(); ++p) {
    const Eigen::Vector2d at = sampled_at(face.sides, h.stretch, p);
    const Shape s = shape(face.sides, at[0], at[1]);
    double d = 0;
    for (int i = 0; i < face.sides; ++i) d += s.N[i] * deviation[surface.face(i, f)];
    h.value[p] += d * gradient_length(face, polynomial(without, face.sides, at[0], at[1]), s);
  }
}

Face undeformed_face(const model::Surface& surface, int f) {
  Face face;
  face.sides = side_count(surface.face, f);
  for (int i = 0; i < face.sides; ++i) face.x[i] = surface.X.col(surface.face(i, f));
  return face;
}

// A part of the range of one coordinate over which sum_i C_i T_i is the sum of terms * C times functions that
// are at most as large as `weight`.
struct Piece {
  Eigen::Matrix<double, Eigen::Dynamic, kP, 0, kP, kP> terms;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kP, 1> weight;
};

// The range between the sides, where |T_i| <= 1, and beyond each of them the parabola or tangent as far as
// `beyond`.
std::vector<Piece> pieces(const Stretch& stretch, double beyond) {
  std::vector<Piece> all{{HeightCoefficients::Identity(), Terms::Ones()}};
  if (beyond <= 0) return all;
  for (double end : {-1.0, 1.0}) {
    Chebyshev c = chebyshev(stretch, end);
    if (falls_beyond(stretch, end)) c.T_tt.setZero();
    Eigen::Matrix<double, 3, kP> terms;
    terms << c.T.transpose(), c.T_t.transpose(), c.T_tt.transpose();
    all.push_back({terms, Eigen::Vector3d(1, beyond, 0.5 * beyond * beyond)});
  }
  return all;
}

Eigen::Matrix<double, 2, 4> slopes_at_corners(const FaceHeights& heights, int sides) {
  Eigen::Matrix<double, 2, 4> slopes = Eigen::Matrix<double, 2, 4>::Zero();
  for (int c = 0; c < sides; ++c) {
    const Eigen::Vector2d at = on_side(sides, c, 0);
    slopes.col(c) = polynomial(heights, sides, at[0], at[1]).f_a;
  }
  return slopes;
}

}  // namespace

const std::vector<Eigen::Vector2d>& height_points(int sides) {
  static const std::vector<Eigen::Vector2d> triangle = triangle_points(),
                                            quadrilateral = quadrilateral_points();
  return sides == 4 ? quadrilateral : triangle;
}

ExactHeights sampled_heights(
    const model::Surface& surface, int f,
    const std::function<double(const Eigen::Vector3d& x, const Eigen::Vector3d& n)>& distance,
    const Stretch& stretch) {
  const Face face = undeformed_face(surface, f);
  ExactHeights h{Eigen::VectorXd(static_cast<Eigen::Index>(height_points(face.sides).size())), stretch};
  for (Eigen::Index p = 0; p < h.value.size(); ++p) {
    const Eigen::Vector2d at = sampled_at(face.sides, stretch, p);
    h.value[p] = distance(combine(face, shape(face.sides, at[0], at[1]).N), normal(face, at[0], at[1]));
  }
  return h;
}

double height_error(
    const model::Surface& surface, int f, const ExactHeights& heights,
    const std::function<double(const Eigen::Vector3d& x, const Eigen::Vector3d& n)>& distance) {
  const Face face = undeformed_face(surface, f);
  const FaceHeights polynomials = interpolated(face.sides, heights);
  double error = 0;
  for (Eigen::Index p = 0; p + kP + 1 < heights.value.size(); ++p) {
    const Eigen::Vector2d at =
        (sampled_at(face.sides, heights.stretch, p) + sampled_at(face.sides, heights.stretch, p + kP + 1)) /
        2;
    const double exact =
        distance(combine(face, shape(face.sides, at[0], at[1]).N), normal(face, at[0], at[1]));
    error = std::max(error, std::abs(polynomial(polynomials, face.sides, at[0], at[1]).f - exact));
  }
  return error;
}

Heights make_heights(const SurfaceView& undeformed, ContactSurface kind, double feature_angle,
                     const TrueSurface& known) {
  require_fits(known, undeformed);
  Heights heights;
  if (kind == ContactSurface::facets && known.deviation.size() == 0) return heights;
  const auto slopes = kind == ContactSurface::facets
                          ? std::vector<CornerSlopes>(undeformed.face.cols(), CornerSlopes::Zero())
                          : corner_slopes(undeformed, feature_angle);
  for (int f = 0; f < undeformed.face.cols(); ++f) {
    const int sides = side_count(undeformed.face, f);
    const bool exact =
        kind == ContactSurface::exact && !known.height.empty() && known.height[f].value.size() > 0;
    ExactHeights h = exact ? known.height[f] : smooth_samples(sides, slopes[f]);
    if (known.deviation.size() > 0) add_deviation(undeformed, f, known.deviation, h);
    heights.face.push_back(interpolated(sides, h));
    heights.slope.push_back(slopes_at_corners(heights.face.back(), sides));
  }
  return heights;
}

FaceFunction height(const Heights& heights, int sides, int f, double u, double v) {
  return polynomial(heights.face[f], sides, u, v);
}

double largest_height(const Heights& heights, double extension) {
  const double beyond = 2 * extension;
  const std::vector<Piece> across = pieces({}, beyond);
  std::vector<Piece> along = across;  // of the last stretch
  Stretch last;
  double largest = 0;
  for (const auto& [C, stretch] : heights.face) {
    const double beyond_begin = beyond + stretch.bulge * (1 + beyond / 2);
    if (stretch.amount != last.amount || stretch.bulge != last.bulge || stretch.fall != last.fall) {
      along = pieces(stretch, beyond_begin);
      last = stretch;
    }
    const double fall = stretch.fall * beyond_begin;
    for (const Piece& a : stretch.along == 0 ? along : across) {
      const Eigen::Matrix<double, Eigen::Dynamic, kP, 0, kP, kP> a_C = a.terms.lazyProduct(C);
      for (const Piece& b : stretch.along == 0 ? across : along)
        largest = std::max(
            largest,
            fall + a.weight.dot(a_C.lazyProduct(b.terms.transpose()).cwiseAbs().lazyProduct(b.weight)));
    }
  }
  return largest;
}

double largest_curvature(const SurfaceView& undeformed, const Heights& heights, int f) {
  const Face face = face_of(undeformed, f);
  double largest = 0;
  for (int i = 0; i < 9; ++i) {
    const Eigen::Vector2d t(i % 3, i / 3), at = face.sides == 4 ? Eigen::Vector2d(t.array() - 1) : t / 4;
    const Shape s = shape(face.sides, at[0], at[1]);
    const Eigen::Matrix2d h = height(heights, face.sides, f, at[0], at[1]).f_ab;
    largest = std::max({largest, std::abs(h(0, 0)) / combine(face, s.N_u).squaredNorm(),
                        std::abs(h(1, 1)) / combine(face, s.N_v).squaredNorm()});
  }
  return largest;
}

}  // namespace elastogear::contact
