#include "gear/own/tooth_sides.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <sstream>

#include "elastogear/base/error.h"
#include "elastogear/mesh/outer_sides.h"

namespace elastogear::gear {
namespace {

constexpr double kCovered = 0.8;  // of the area of a flank

// m^2, of one flank: of the helicoid theta = z/p + psi(r).
double flank_area(const Toothing& t, double width) {
  constexpr int kSteps = 40;
  const double step = (t.r_a - t.r_form) / kSteps;
  double area = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double r = t.r_form + (i + 0.5) * step;
    area += std::abs(step) * width * std::hypot(1, r / t.p, r * half_angle(t, r).d_r);
  }
  return area;
}

}  // namespace

std::vector<ToothSide> tooth_sides(const mesh::Mesh& mesh, const std::vector<std::vector<int>>& outer) {
  std::vector<ToothSide> sides;
  for (const std::vector<int>& nodes : outer) {
    ToothSide side;
    side.node = nodes;
    side.corners = mesh::side_corners(side.node.size());
    const auto corner = [&](int i) { return mesh.X.col(side.node[static_cast<std::size_t>(i)]); };
    side.middle.setZero();
    for (int i = 0; i < side.corners; ++i) side.middle += corner(i) / side.corners;
    const Eigen::Vector3d twice = side.corners == 3 ? (corner(1) - corner(0)).cross(corner(2) - corner(0))
                                                    : (corner(2) - corner(0)).cross(corner(3) - corner(1));
    side.area = twice.norm() / 2;
    side.n = twice.normalized();
    sides.push_back(std::move(side));
  }
  return sides;
}

double around_axis(const ToothSide& side) {
  return (side.middle[0] * side.n[1] - side.middle[1] * side.n[0]) / radius(side.middle);
}

double normal_module(const Toothing& t) { return 2 * t.r / t.z * std::cos(std::atan(t.r / t.p)); }

std::string in_mm(double length) {
  std::ostringstream text;
  text.precision(6);
  text << 1e3 * length << " mm";
  return text.str();
}

void require_covered(const std::string& name, const Toothing& t, double width,
                     const std::vector<std::array<double, 2>>& covered) {
  const double whole = flank_area(t, width);
  for (std::size_t tooth = 0; tooth < covered.size(); ++tooth)
    for (std::size_t side : {0, 1}) {
      const double share = covered[tooth][side] / whole;
      require(share >= kCovered, name, ": faces of the mesh lie on ", std::round(100 * share), " % of the ",
              side == 1 ? "left" : "right", " flank of tooth ", tooth + 1, " between the diameters ",
              in_mm(2 * t.r_form), " and ", in_mm(2 * t.r_a), ", at least ", 100 * kCovered,
              " % are needed: give the gear the tip_diameter and face_width of the mesh, or mesh all of its "
              "teeth");
    }
}

}  // namespace elastogear::gear
