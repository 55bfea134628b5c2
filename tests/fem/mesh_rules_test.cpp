// Materials, restraints and inertia of a mesh.
#include <gtest/gtest.h>

#include "../message_of.h"
#include "brick.h"
#include "elastogear/base/error.h"
#include "elastogear/fem/inertia.h"
#include "elastogear/fem/material.h"
#include "elastogear/fem/restraint.h"
#include "enclosed_inertia.h"

namespace elastogear::mesh_rules_test {
namespace {

using test::message_of;

constexpr double kRoundoff = 1e-12;

TEST(Materials, fill_named_sets_and_the_rest) {
  auto mesh = test::brick({3, 1, 1}, {1, 1, 1});
  mesh.cell_sets["rim"] = {2};
  mesh.cell_sets["end"] = {1, 2};
  EXPECT_EQ(fem::cell_regions(mesh, {{"", test::kSteel}, {"rim", test::kSteel}}),
            (std::vector<int>{0, 0, 1}));
  EXPECT_NE(message_of([&] {
              fem::cell_regions(mesh, {{"rim", test::kSteel}});
            }).find("cell 0"),
            std::string::npos);
  EXPECT_NE(message_of([&] {
              fem::cell_regions(mesh, {{"rim", test::kSteel}, {"end", test::kSteel}});
            }).find("cell 2"),
            std::string::npos);
}

TEST(Materials, outside_their_range_are_errors_naming_the_value) {
  for (const model::Material& wrong : {model::Material{0, 0.3, 1},
                                       {1, 0.5, 1},
                                       {1, -1, 1},
                                       {1, 0.3, 0},
                                       {NAN, 0.3, 1},
                                       {1, NAN, 1},
                                       {1, 0.3, INFINITY}})
    EXPECT_NE(message_of([&] { fem::validate({{"rim", wrong}}); }).find("rim"), std::string::npos);
  EXPECT_EQ(message_of([] { fem::validate(test::kSteelBody); }), "no error");
}

// A bar along axis k of the material: sigma = E_k eps, and lateral strains by nu.
TEST(Orthotropy, of_a_bar_along_each_axis_has_the_closed_form) {
  const model::Orthotropic& m = *test::kFibre.orthotropic;
  model::Material aligned = test::kFibre;
  aligned.orthotropic->orientation = {};
  const auto H =
      fem::elasticity_at(std::get<fem::Orthotropy>(fem::elasticity(aligned)), Eigen::Vector3d(1, 2, 3));
  const Eigen::Matrix3d axes = fem::material_axes(m.orientation, Eigen::Vector3d::Zero());
  const double strain[3][3] = {{1 / m.E(0), -m.nu(0) / m.E(0), -m.nu(1) / m.E(0)},
                               {-m.nu(0) / m.E(0), 1 / m.E(1), -m.nu(2) / m.E(1)},
                               {-m.nu(1) / m.E(0), -m.nu(2) / m.E(1), 1 / m.E(2)}};
  for (int k = 0; k < 3; ++k) {
    Eigen::Vector<double, 6> eps = Eigen::Vector<double, 6>::Zero();
    eps.head<3>() << strain[k][0], strain[k][1], strain[k][2];
    EXPECT_LT((H[0] * eps - Eigen::Vector<double, 6>::Unit(k)).norm(), kRoundoff);
    EXPECT_NEAR(fem::youngs_modulus(test::kFibre, axes.col(k), {1, 2, 3}) / m.E(k), 1, kRoundoff);
  }
  EXPECT_EQ(H[0](3, 3), m.G(0)) << "xy";
  EXPECT_EQ(H[0](4, 4), m.G(2)) << "yz";
  EXPECT_EQ(H[0](5, 5), m.G(1)) << "xz";
  EXPECT_EQ(fem::youngs_modulus(test::kSteel, {1, 1, 0}, {0, 0, 0}), test::kSteel.E);
}

TEST(Orthotropy, has_no_lame_constants) { EXPECT_THROW(fem::lame(test::kFibre), Error); }

TEST(Orthotropy, of_a_wound_rim_follows_its_circumference) {
  const model::Orientation o{.system = model::Orientation::System::cylindrical, .origin = {1, 0, 0}};
  Eigen::Matrix3d expected;
  expected.col(0) << 0, 1, 0;
  expected.col(1) << -1, 0, 0;
  expected.col(2) << 0, 0, 1;
  EXPECT_LT((fem::material_axes(o, {1, 2, 5}) - expected).norm(), kRoundoff);
  const Eigen::Matrix3d on_axis = fem::material_axes(o, {1, 0, 5});
  EXPECT_LT((on_axis.transpose() * on_axis - Eigen::Matrix3d::Identity()).norm(), kRoundoff);
  model::Orientation wound = o;
  wound.rotation << M_PI / 2, 0, 0;  // about the radius: tangential becomes axial
  EXPECT_LT((fem::material_axes(wound, {1, 2, 5}).col(1) - Eigen::Vector3d::UnitZ()).norm(), kRoundoff);
}

TEST(Orthotropy, has_the_mean_moduli_of_waves_along_its_axes) {
  const auto [lambda, mu] = fem::mean_lame(test::kFibre);
  EXPECT_NEAR(mu / 4.5e9, 1, kRoundoff);
  EXPECT_GT(lambda + 2 * mu, 10e9);
  EXPECT_LT(lambda + 2 * mu, 60e9);
  EXPECT_EQ(fem::mean_lame(test::kSteel).mu, fem::lame(test::kSteel).mu);
}

TEST(Orthotropy, that_is_not_positive_definite_is_an_error_naming_the_values) {
  const auto message = [](auto&& change) {
    model::Material m = test::kFibre;
    change(*m.orthotropic);
    return message_of([&] { fem::validate({{"rim", m}}); });
  };
  EXPECT_EQ(message([](auto&) {}), "no error");
  EXPECT_NE(message([](auto& m) { m.nu(0) = 2; }).find("2, 0.25, 0.4) is not positive definite"),
            std::string::npos);
  EXPECT_NE(message([](auto& m) { m.E(1) = 0; }).find("rim"), std::string::npos);
  EXPECT_NE(message([](auto& m) { m.G(2) = -1; }).find("-1) Pa, must be positive"), std::string::npos);
  EXPECT_NE(message([](auto& m) { m.nu(1) = NAN; }).find("nan"), std::string::npos);
  EXPECT_NE(message([](auto& m) { m.orientation.axis_2 = -m.orientation.axis_1; }).find("parallel"),
            std::string::npos);
  EXPECT_NE(message([](auto& m) {
              m.orientation.system = model::Orientation::System::cylindrical;
              m.orientation.axis.setZero();
            }).find("the axis is zero"),
            std::string::npos);
  EXPECT_NE(message([](auto& m) { m.orientation.rotation(1) = INFINITY; }).find("not finite"),
            std::string::npos);
}

TEST(Restraint, must_hold_every_part_by_three_nodes_off_one_line) {
  const auto mesh = test::brick({2, 2, 2}, {1, 1, 1});
  const auto held_by = [&](std::vector<int> nodes) {
    auto copy = mesh;
    copy.node_sets["held"] = std::move(nodes);
    return message_of([&] { fem::require_held(copy, fem::held_directions(copy, {"held"})); });
  };
  EXPECT_NE(held_by({}), "");
  EXPECT_NE(held_by({0, 1}), "");
  EXPECT_NE(
      held_by({0, 1, 2}).find("3 restrained nodes, which leave it free to turn about (1 0 0) through ("),
      std::string::npos);
  EXPECT_EQ(held_by({0, 1, 3}), "no error");
  EXPECT_EQ(held_by(mesh.node_sets.at("xmin")), "no error");
}

TEST(Restraint, in_single_directions_must_hold_all_rigid_motions) {
  const auto mesh = test::brick({2, 2, 2}, {1, 1, 1});
  const auto held_by = [&](const std::vector<std::string>& restrain) {
    return message_of([&] { fem::require_held(mesh, fem::held_directions(mesh, restrain)); });
  };
  EXPECT_EQ(held_by({"xmin:x", "ymin:y", "zmin:z"}), "no error");
  EXPECT_EQ(held_by({"zmin:z", "zmax:xyz"}), "no error");
  const std::string plane = held_by({"zmin:z"});
  for (const char* motion : {"move along (1 0 0)", "move along (0 1 0)", "turn about (0 0 1)"})
    EXPECT_NE(plane.find(motion), std::string::npos) << plane;
  EXPECT_EQ(plane.find("(1 0 0) through"), std::string::npos) << plane;
  EXPECT_NE(held_by({"xmin:x", "ymin:y"}).find("free to move along (0 0 1); hold"), std::string::npos);
  EXPECT_NE(held_by({"xmin:xz", "zmin:x"}).find("free to move along (0 1 0)"), std::string::npos);
}

TEST(Restraint, names_its_sets_and_directions) {
  auto mesh = test::brick({1, 1, 1}, {1, 1, 1});
  const auto held = fem::held_directions(mesh, {"xmin:zx", "ymin:y"});
  EXPECT_EQ(held[0], 7);
  EXPECT_EQ(held[1], 2);
  EXPECT_EQ(held[2], 5);
  EXPECT_EQ(held[3], 0);
  mesh.node_sets["odd:z"] = {5};
  EXPECT_EQ(fem::held_directions(mesh, {"odd:z"})[5], 7) << "the whole name goes before";
  const auto error = [&](const char* text) {
    return message_of([&] { fem::held_directions(mesh, {text}); });
  };
  EXPECT_NE(error("xmin:q").find("'q' must be directions"), std::string::npos);
  EXPECT_NE(error("xmin:").find("missing"), std::string::npos);
  EXPECT_NE(error("bore:z").find("no node set and no face set 'bore'"), std::string::npos);
}

TEST(Restraint, leaves_out_nodes_of_no_cell) {
  auto mesh = test::brick({1, 1, 1}, {1, 1, 1});
  mesh.X.conservativeResize(3, 9);
  mesh.X.rightCols<1>().setZero();
  EXPECT_EQ(fem::free_dofs(fem::held_directions(mesh, {"xmin"})).size(), 12u);
}

TEST(Inertia, of_a_brick_is_exact) {
  const Eigen::Vector3d l(2, 1, 0.5), at(0.3, -0.2, 1);
  const auto mesh = test::mapped(test::distorted(test::brick({4, 3, 2}, l), 0.05),
                                 [&](auto X) -> Eigen::Vector3d { return X + at; });
  const auto inertia = fem::rigid_inertia(mesh, fem::mass_moments(mesh, test::kSteelBody));
  const double m = test::kSteel.rho * l.prod();
  const Eigen::Vector3d c = at + l / 2;
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d squares = l.cwiseAbs2();
  const Eigen::Matrix3d J = m / 12 * (squares.sum() * I - Eigen::Matrix3d(squares.asDiagonal())) +
                            m * (c.squaredNorm() * I - c * c.transpose());
  EXPECT_NEAR(inertia.m / m, 1, kRoundoff);
  EXPECT_LT((inertia.c - c).norm(), kRoundoff);
  EXPECT_LT((inertia.J - J).norm(), kRoundoff * J.norm());
}

TEST(Inertia, of_a_curved_body_equals_the_geometry_enclosed_by_its_faces) {
  const auto twist = [](const Eigen::Vector3d& X) -> Eigen::Vector3d {
    const double a = 0.8 * X.z(), s = 1 + 0.3 * X.z();
    return {s * (std::cos(a) * X.x() - std::sin(a) * X.y()), s * (std::sin(a) * X.x() + std::cos(a) * X.y()),
            X.z() + 0.1 * X.x() * X.y()};
  };
  const auto mesh = test::mapped(test::brick({3, 3, 4}, {1, 0.8, 1.5}), twist);
  const auto inertia = fem::rigid_inertia(mesh, fem::mass_moments(mesh, test::kSteelBody));
  const auto expected = test::enclosed_inertia(mesh, test::kSteel.rho);
  EXPECT_NEAR(inertia.m / expected.m, 1, kRoundoff);
  EXPECT_LT((inertia.c - expected.c).norm(), kRoundoff);
  EXPECT_LT((inertia.J - expected.J).norm(), kRoundoff * expected.J.norm());
}

}  // namespace
}  // namespace elastogear::mesh_rules_test
