#include "elastogear/life/wear.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../contact/surfaces.h"
#include "../figures.h"

namespace elastogear::life::wear_test {
namespace {

using contact::test::at;

constexpr double kRadius = 10e-3, kWidth = 4e-3, kLength = 20e-3;  // m
constexpr double kFoundation = 1e13;                               // Pa/m, pressure over depth
constexpr double kDepth = 5e-6;                                    // m, of the cylinder in the plate
constexpr double kCoefficient = 1e-15;                             // m^2/N
constexpr double kFrom = 4e-3, kTo = 16e-3;                        // m, way of the cylinder's axis

TEST(FlankCells, keep_the_volume_that_is_laid_on_them) {
  const FlankCells cells =
      flank_cells({2e-3, 8e-3}, {-5e-3, 5e-3}, 12, 7, [](double u) { return involute_arc(u, 30e-3); });
  Eigen::MatrixXd volume = Eigen::MatrixXd::Zero(12, 7);
  lay_volume(cells, {{3.1e-3, 4.7e-3}, {-1e-3, 2e-3}}, 2, volume);
  lay_volume(cells, {{1e-3, 9e-3}, {4e-3, 9e-3}}, 3, volume);    // beyond the ends
  lay_volume(cells, {{8e-3, 8e-3}, {-5e-3, -5e-3}}, 4, volume);  // a point at a corner
  EXPECT_NEAR(volume.sum(), 9, 1e-12);
  EXPECT_NEAR(volume(11, 0), 4, 1e-12);
  EXPECT_NEAR(cells.length.sum(), (64e-6 - 4e-6) / 60e-3, 1e-15);
}

TEST(FlankCells, have_an_even_depth_where_the_volume_is_even_over_the_surface) {
  const double r_b = 30e-3;
  const FlankCells cells =
      flank_cells({2e-3, 8e-3}, {0, 10e-3}, 12, 5, [&](double u) { return involute_arc(u, r_b); });
  Eigen::MatrixXd volume = Eigen::MatrixXd::Zero(12, 5);
  for (int k = 0; k < 6000; ++k) {  // 1 um deep over each bit of the profile
    const double u = 2e-3 + 1e-6 * k;
    lay_volume(cells, {{u, u + 1e-6}, {0, 10e-3}},
               1e-6 * 10e-3 * (involute_arc(u + 1e-6, r_b) - involute_arc(u, r_b)), volume);
  }
  EXPECT_NEAR(depth(cells, volume).maxCoeff(), 1e-6, 1e-12);
  EXPECT_NEAR(depth(cells, volume).minCoeff(), 1e-6, 1e-12);
}

// Depths of both bodies after a cylinder has slid over a plate without turning: their contact is that of
// elastogear, with a pressure in proportion to the depth. rows: of nodes over half the patch; columns:
// across.
struct Worn {
  FlankCells plate_cells, cylinder_cells;
  Eigen::MatrixXd plate, cylinder;
};

Worn slide(int rows, int columns, double step) {
  const double half_width = std::sqrt(2 * kRadius * kDepth), spacing = half_width / rows;
  const int n = 6 * rows;
  const model::Surface plate = contact::test::plane(37, 3, kLength, kWidth);
  const model::Surface cylinder =
      contact::test::flipped(contact::test::grid(n, columns, [&](double u, double v) {
        const double angle = (u - 0.5) * n * spacing / kRadius;
        return Eigen::Vector3d(kRadius * std::sin(angle), v * kWidth, kRadius * (1 - std::cos(angle)));
      }));
  contact::Settings settings;
  settings.surface = contact::ContactSurface::facets;
  settings.stiffness = kFoundation;
  settings.depth = 1e-3;
  contact::Pair pair(cylinder, plate, settings);
  Worn worn{flank_cells({0, kLength}, {0, kWidth}, 40, 4, std::identity{}),
            flank_cells(Eigen::Vector2d(-n, n) * spacing / 2, {0, kWidth}, n + 1, 4, std::identity{}),
            Eigen::MatrixXd::Zero(40, 4), Eigen::MatrixXd::Zero(n + 1, 4)};
  const double across = kWidth / columns / 2;
  for (double x = kFrom + step / 2; x < kTo; x += step)
    for (const auto& c : pair.detect(at(cylinder, {x, 0, -kDepth}), at(plate))) {
      const Eigen::Vector3d X = cylinder.X.col(c.slave_node);
      const double volume = kCoefficient * c.f.dot(c.n) * step;
      const double v[] = {std::max(0.0, X[1] - across), std::min(kWidth, X[1] + across)};
      lay_volume(worn.plate_cells, {{x + X[0] - step / 2, x + X[0] + step / 2}, {v[0], v[1]}}, volume,
                 worn.plate);
      lay_volume(worn.cylinder_cells, {{X[0] - spacing / 2, X[0] + spacing / 2}, {v[0], v[1]}}, volume,
                 worn.cylinder);
    }
  return worn;
}

// Archard's law, integrated: the plate loses k F' at each point that the whole patch passes, the cylinder k p
// s.
TEST(Archard, of_a_cylinder_on_a_plate_is_its_integral_on_any_mesh) {
  const double half_width = std::sqrt(2 * kRadius * kDepth);
  const double load = 4.0 / 3 * kFoundation * kDepth * half_width;  // N/m
  for (const auto& [rows, columns, step] : {std::tuple{8, 3, 0.1e-3}, std::tuple{13, 7, 0.237e-3}}) {
    const Worn worn = slide(rows, columns, step);
    const double way = step * std::round((kTo - kFrom) / step);
    EXPECT_NEAR(worn.plate.sum() / (kCoefficient * load * kWidth * way), 1, 0.01);
    EXPECT_NEAR(worn.cylinder.sum() / worn.plate.sum(), 1, 1e-12);
    const Eigen::MatrixXd plate = depth(worn.plate_cells, worn.plate);
    const auto depths = plate.middleRows(10, 20).array() / (kCoefficient * load);
    elastogear::test::figure({"wear of a plate", "depth", "%"}, (depths - 1).abs().maxCoeff(), 0.01);
    EXPECT_LT(plate.topRows(6).maxCoeff(), 1e-3 * kCoefficient * load);
    const Eigen::MatrixXd cylinder = depth(worn.cylinder_cells, worn.cylinder);
    EXPECT_NEAR(cylinder.maxCoeff() / (kCoefficient * kFoundation * kDepth * way), 1, 0.01);
  }
}

}  // namespace
}  // namespace elastogear::life::wear_test
