#include "app/wear/wear_report.h"

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/console/console.h"
#include "app/console/json_text.h"
#include "elastogear/base/file.h"
#include "elastogear/base/number.h"
#include "elastogear/evaluation/grid_convergence.h"
#include "elastogear/io/csv.h"

namespace elastogear::app {
namespace {

Eigen::VectorXd middles(const Eigen::VectorXd& edges) {
  const Eigen::Index n = edges.size() - 1;
  return (edges.head(n) + edges.tail(n)) / 2;
}

Eigen::VectorXd diameters(const WearingGear& gear) {
  const double r_b = gear.member->toothing.r_b;
  return middles(gear.cells.u).unaryExpr([r_b](double u) { return 2 * std::hypot(r_b, u); });
}

Eigen::VectorXd column(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// Shares of the last rates. rates: by mesh and gear.
std::vector<double> error_shares(const std::vector<std::vector<double>>& rates,
                                 const std::vector<double>& refinement) {
  const std::vector<double>& finest = rates.back();
  std::vector<double> error;
  for (std::size_t gear = 0; gear < finest.size(); ++gear) {
    std::vector<double> value;
    for (const std::vector<double>& on_mesh : rates) value.push_back(on_mesh[gear]);
    error.push_back(evaluation::mesh_error(value, refinement));
  }
  evaluation::raise_to_median(finest, error);
  for (std::size_t gear = 0; gear < finest.size(); ++gear)
    error[gear] = finest[gear] > 0 ? error[gear] / finest[gear] : 0;
  return error;
}

// m and revolutions, at the end. A depth that has ended the run is known, and the revolutions are not.
double depth_error(const WearCourse& course, std::size_t gear) {
  const bool known = course.error.depth.empty() || course.limited_by == static_cast<int>(gear);
  return known ? 0 : course.error.depth[gear] * course.depth[gear].back();
}
double mass_error(const WearCourse& course, std::size_t gear) {
  return course.error.mass.empty() ? 0 : course.error.mass[gear] * course.mass[gear].back();
}
double revolutions_error(const WearCourse& course) {
  if (course.error.depth.empty() || course.limited_by < 0) return 0;
  return course.error.depth[static_cast<std::size_t>(course.limited_by)] * course.revolutions.back();
}

}  // namespace

std::string without_end(const std::string& output) {
  return std::filesystem::path(output).replace_extension().string();
}

void estimate_errors(WearCourse& course, std::vector<WearRates> on_meshes,
                     const std::vector<double>& refinement) {
  if (on_meshes.empty()) return;
  on_meshes.push_back(course.first);
  std::vector<std::vector<double>> depth, mass;
  for (const WearRates& rates : on_meshes) depth.push_back(rates.depth), mass.push_back(rates.mass);
  course.error = {error_shares(depth, refinement), error_shares(mass, refinement)};
}

void note(WearCourse& course, const std::vector<WearingGear>& gears, double revolutions) {
  course.depth.resize(gears.size());
  course.mass.resize(gears.size());
  if (!course.depth.front().empty()) course.revolutions.push_back(revolutions);
  for (std::size_t i = 0; i < gears.size(); ++i) {
    course.depth[i].push_back(largest_depth(gears[i]));
    course.mass[i].push_back(worn_mass(gears[i], gears[i].depth));
  }
}

std::string worn_flanks_file(const std::string& output, const std::string& gear) {
  return without_end(output) + "_" + gear + ".csv";
}

void write_worn_flanks(const std::string& path, const WearingGear& gear) {
  const Eigen::VectorXd diameter = diameters(gear), z = middles(gear.cells.v);
  std::string text = "diameter [m],z [m],height [m],tooth,side\n";
  const auto add = [&text](double value) {
    print(text, value);
    text += ',';
  };
  for (int side = 0; side < 2; ++side)
    for (Eigen::Index i = 0; i < diameter.size(); ++i)
      for (Eigen::Index j = 0; j < z.size(); ++j) {
        for (double value : {diameter[i], z[j], 0 - gear.depth[side](i, j)}) add(value);
        text += side == 0 ? "0,left\n" : "0,right\n";
      }
  write_file(path, text);
}

std::vector<std::string> course_files(const std::string& output) {
  return {without_end(output) + ".csv", without_end(output) + ".json"};
}

void write_course(const std::string& output, const WearCourse& course, const std::vector<WearingGear>& gears,
                  const std::string& why) {
  std::vector<io::CsvColumn> columns = {{"revolutions", "1", column(course.revolutions)}};
  nlohmann::ordered_json json = {{"ended", why}, {"revolutions_of_first_gear", course.revolutions.back()}};
  if (!course.error.depth.empty()) json["revolutions_mesh_error"] = revolutions_error(course);
  for (std::size_t i = 0; i < gears.size(); ++i) {
    const std::string& name = gears[i].member->name;
    columns.push_back({"largest depth of " + name, "m", column(course.depth[i])});
    columns.push_back({"worn mass of " + name, "kg", column(course.mass[i])});
    nlohmann::ordered_json gear = {{"gear", name},
                                   {"largest_depth_m", course.depth[i].back()},
                                   {"worn_mass_kg", course.mass[i].back()},
                                   {"flanks", worn_flanks_file(output, name)}};
    if (!course.error.depth.empty()) {
      gear["largest_depth_mesh_error_m"] = depth_error(course, i);
      gear["worn_mass_mesh_error_kg"] = mass_error(course, i);
    }
    json["gears"].push_back(std::move(gear));
  }
  io::write_csv(course_files(output)[0], columns);
  write_file(course_files(output)[1], json_text(json));
}

io::WearFile wear_file(const WearCourse& course, const std::vector<WearingGear>& gears) {
  io::WearFile file;
  file.revolutions = column(course.revolutions);
  for (std::size_t i = 0; i < gears.size(); ++i) {
    file.gears.push_back({gears[i].member->name, diameters(gears[i]), middles(gears[i].cells.u),
                          middles(gears[i].cells.v), gears[i].depth[0], gears[i].depth[1],
                          column(course.depth[i]), column(course.mass[i])});
    if (course.error.depth.empty()) continue;
    file.gears.back().largest_mesh_error = course.error.depth[i] * column(course.depth[i]);
    file.gears.back().mass_mesh_error = course.error.mass[i] * column(course.mass[i]);
  }
  return file;
}

void print_wear(const WearCourse& course, const std::vector<WearingGear>& gears, const std::string& why) {
  print_item("wear", with_error(course.revolutions.back(), revolutions_error(course),
                                "revolutions of the first gear") +
                         ", " + why);
  for (std::size_t i = 0; i < gears.size(); ++i)
    print_item(
        gears[i].member->name,
        "largest depth " + with_error(1e6 * course.depth[i].back(), 1e6 * depth_error(course, i), "um") +
            ", worn mass " + with_error(1e3 * course.mass[i].back(), 1e3 * mass_error(course, i), "g"));
  if (!course.error.depth.empty())
    print_item("errors",
               "by the mesh alone; more positions (sweep_positions) and cells (cells_along, "
               "cells_across) tell what these change");
}

}  // namespace elastogear::app
