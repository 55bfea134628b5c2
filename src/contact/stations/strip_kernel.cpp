#include "elastogear/contact/strip_kernel.h"

#include <cmath>

namespace elastogear::contact {
namespace {

// m, twice the integral over x of asinh(q / x) / q, up to a linear function of |x|. Eq. (6.40).
double line_primitive(double x, double q) {
  x = std::abs(x);
  if (x == 0) return -q / 2;
  if (q == 0) return x * std::log(x);
  const double u = x / q;
  return x * (u / 2 * std::asinh(1 / u) + std::asinh(u)) - std::hypot(q, x) / 2;
}

}  // namespace

std::vector<Strip> images(const Strip& strip, const FreeEnds& ends) {
  std::vector<Strip> beyond;
  for (double end : {ends.lower, ends.upper})
    if (std::isfinite(end)) beyond.push_back({2 * end - strip.to, 2 * end - strip.from});
  return beyond;
}

double line_inverse_distance(const Strip& a, const Strip& b, double q) {
  const double difference = line_primitive(a.to - b.from, q) - line_primitive(a.to - b.to, q) -
                            line_primitive(a.from - b.from, q) + line_primitive(a.from - b.to, q);
  return difference / (a.length() * b.length());
}

Eigen::MatrixXd line_kernel(const std::vector<Strip>& strips, double q, const FreeEnds& ends) {
  const auto n = static_cast<Eigen::Index>(strips.size());
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      const Strip &a = strips[static_cast<std::size_t>(i)], &b = strips[static_cast<std::size_t>(j)];
      double sum = line_inverse_distance(a, b, q);
      for (const Strip& image : images(b, ends)) sum += ends.share * line_inverse_distance(a, image, q);
      H(i, j) = H(j, i) = sum;
    }
  return H;
}

}  // namespace elastogear::contact
