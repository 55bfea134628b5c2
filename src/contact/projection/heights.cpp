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

// Beyond |t| = 1 each polynomial goes on as its parabola there.
Chebyshev chebyshev(double t) {
  const double end = std::clamp(t, -1.0, 1.0), beyond = t - end;
  Chebyshev c;
  c.T[0] = 1;
  c.T[1] = end;
  c.T_t[1] = 1;
  for (int i = 2; i < kP; ++i) {
    c.T[i] = 2 * end * c.T[i - 1] - c.T[i - 2];
    c.T_t[i] = 2 * c.T[i - 1] + 2 * end * c.T_t[i - 1] - c.T_t[i - 2];
    c.T_tt[i] = 4 * c.T_t[i - 1] + 2 * end * c.T_tt[i - 1] - c.T_tt[i - 2];
  }
  if (beyond != 0) {
    c.T += beyond * (c.T_t + 0.5 * beyond * c.T_tt);
    c.T_t += beyond * c.T_tt;
  }
  return c;
}

// |T_i| and its derivatives are largest at the end of a parabola, t = 1 + beyond.
Chebyshev largest_chebyshev(double beyond) { return chebyshev(1 + beyond); }

// Coordinate of a face along which the Chebyshev polynomials are orthogonal.
double chebyshev_coordinate(int sides, double u) { return sides == 4 ? u : 2 * u - 1; }

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
    const Terms a = chebyshev(chebyshev_coordinate(sides, points[p][0])).T,
                b = chebyshev(chebyshev_coordinate(sides, points[p][1])).T;
    for (Eigen::Index t = 0; t < n; ++t) values(p, t) = a[terms[t].first] * b[terms[t].second];
  }
  return values.inverse();
}

HeightCoefficients interpolated(int sides, const Eigen::VectorXd& samples) {
  static const Eigen::MatrixXd of_triangle = interpolation(3), of_quadrilateral = interpolation(4);
  static const auto triangle_terms = terms_of(3), quadrilateral_terms = terms_of(4);
  const Eigen::VectorXd coefficient = (sides == 4 ? of_quadrilateral : of_triangle) * samples;
  const auto& terms = sides == 4 ? quadrilateral_terms : triangle_terms;
  HeightCoefficients C = HeightCoefficients::Zero();
  for (std::size_t t = 0; t < terms.size(); ++t)
    C(terms[t].first, terms[t].second) = coefficient[static_cast<Eigen::Index>(t)];
  return C;
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
    const Eigen::VectorXd& h = known.height[f];
    const auto n = height_points(side_count(surface.face, static_cast<int>(f))).size();
    require(h.size() == 0 || h.size() == static_cast<Eigen::Index>(n), "contact: ", h.size(),
            " exact heights of face ", f, " given, it has ", n, " points");
    require(h.allFinite(), "contact: an exact height of face ", f, " is not finite");
  }
}

Eigen::VectorXd smooth_samples(int sides, const CornerSlopes& slopes) {
  const auto& points = height_points(sides);
  Eigen::VectorXd h(static_cast<Eigen::Index>(points.size()));
  for (Eigen::Index p = 0; p < h.size(); ++p) h[p] = smooth_height(sides, slopes, points[p][0], points[p][1]);
  return h;
}

FaceFunction polynomial(const HeightCoefficients& C, int sides, double u, double v) {
  const Chebyshev a = chebyshev(chebyshev_coordinate(sides, u)),
                  b = chebyshev(chebyshev_coordinate(sides, v));
  const Terms by_b = C * b.T, by_b_t = C * b.T_t, by_b_tt = C * b.T_tt;
  const double scale = chebyshev_coordinate(sides, 1) - chebyshev_coordinate(sides, 0);
  FaceFunction h;
  h.f = a.T.dot(by_b);
  h.f_a = scale * Eigen::Vector2d(a.T_t.dot(by_b), a.T.dot(by_b_t));
  const double mixed = a.T_t.dot(by_b_t);
  h.f_ab << a.T_tt.dot(by_b), mixed, mixed, a.T.dot(by_b_tt);
  h.f_ab *= scale * scale;
  return h;
}

// The length of the gradient of (6.19) on the surface itself: a height over the distance along its normal.
double stretch(const Face& face, const FaceFunction& h, const Shape& s) {
  Eigen::Matrix<double, 3, 2> a;
  a << combine(face, s.N_u), combine(face, s.N_v);
  const Eigen::Matrix2d metric = a.transpose() * a;
  const double slope = h.f_a.dot(metric.inverse() * h.f_a);
  return std::isfinite(slope) ? std::sqrt(1 + slope) : 1;  // 1 where the face is degenerate
}

// Adds deviations, which count along the normal of the surface, to its heights h at the height_points.
void add_deviation(const SurfaceView& surface, int f, const Eigen::VectorXd& deviation, Eigen::VectorXd& h) {
  const Face face = face_of(surface, f);
  const HeightCoefficients C = interpolated(face.sides, h);
  const auto& points = height_points(face.sides);
  for (Eigen::Index p = 0; p < h.size(); ++p) {
    const double u = points[p][0], v = points[p][1];
    const Shape s = shape(face.sides, u, v);
    double d = 0;
    for (int i = 0; i < face.sides; ++i) d += s.N[i] * deviation[surface.face(i, f)];
    h[p] += d * stretch(face, polynomial(C, face.sides, u, v), s);
  }
}

Face undeformed_face(const model::Surface& surface, int f) {
  Face face;
  face.sides = side_count(surface.face, f);
  for (int i = 0; i < face.sides; ++i) face.x[i] = surface.X.col(surface.face(i, f));
  return face;
}

Eigen::Matrix<double, 2, 4> slopes_at_corners(const HeightCoefficients& C, int sides) {
  Eigen::Matrix<double, 2, 4> slopes = Eigen::Matrix<double, 2, 4>::Zero();
  for (int c = 0; c < sides; ++c) {
    const Eigen::Vector2d at = on_side(sides, c, 0);
    slopes.col(c) = polynomial(C, sides, at[0], at[1]).f_a;
  }
  return slopes;
}

}  // namespace

const std::vector<Eigen::Vector2d>& height_points(int sides) {
  static const std::vector<Eigen::Vector2d> triangle = triangle_points(),
                                            quadrilateral = quadrilateral_points();
  return sides == 4 ? quadrilateral : triangle;
}

Eigen::VectorXd sampled_heights(
    const model::Surface& surface, int f,
    const std::function<double(const Eigen::Vector3d& x, const Eigen::Vector3d& n)>& distance) {
  const Face face = undeformed_face(surface, f);
  const auto& points = height_points(face.sides);
  Eigen::VectorXd h(static_cast<Eigen::Index>(points.size()));
  for (Eigen::Index p = 0; p < h.size(); ++p) {
    const double u = points[p][0], v = points[p][1];
    h[p] = distance(combine(face, shape(face.sides, u, v).N), normal(face, u, v));
  }
  return h;
}

double height_error(
    const model::Surface& surface, int f, const Eigen::VectorXd& heights,
    const std::function<double(const Eigen::Vector3d& x, const Eigen::Vector3d& n)>& distance) {
  const Face face = undeformed_face(surface, f);
  const HeightCoefficients C = interpolated(face.sides, heights);
  const auto& points = height_points(face.sides);
  double error = 0;
  for (std::size_t p = 0; p + kP + 1 < points.size(); ++p) {
    const Eigen::Vector2d at = (points[p] + points[p + kP + 1]) / 2;
    const double exact =
        distance(combine(face, shape(face.sides, at[0], at[1]).N), normal(face, at[0], at[1]));
    error = std::max(error, std::abs(polynomial(C, face.sides, at[0], at[1]).f - exact));
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
    const bool exact = kind == ContactSurface::exact && !known.height.empty() && known.height[f].size() > 0;
    Eigen::VectorXd h = exact ? known.height[f] : smooth_samples(sides, slopes[f]);
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
  const Terms T = largest_chebyshev(2 * extension).T;
  double largest = 0;
  for (const HeightCoefficients& C : heights.face) largest = std::max(largest, T.dot(C.cwiseAbs() * T));
  return largest;
}

double largest_second_derivative(const Heights& heights) {
  const Chebyshev c = largest_chebyshev(0);
  constexpr double kTriangle = 4;  // (da/du)^2 there, 1 on quadrilaterals
  double largest = 0;
  for (const HeightCoefficients& C : heights.face) {
    const HeightCoefficients size = C.cwiseAbs();
    for (const double bound : {c.T_tt.dot(size * c.T), c.T_t.dot(size * c.T_t), c.T.dot(size * c.T_tt)})
      largest = std::max(largest, kTriangle * bound);
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
