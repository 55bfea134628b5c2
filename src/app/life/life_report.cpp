#include "app/life/life_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/console/console.h"
#include "app/console/json_text.h"
#include "elastogear/base/file.h"
#include "elastogear/base/text.h"
#include "elastogear/io/body_file.h"
#include "elastogear/io/csv.h"
#include "elastogear/io/field_file.h"

namespace elastogear::app {
namespace {

using nlohmann::ordered_json;

constexpr const char* kNote =
    "linear damage of local elastic stresses; no rating standard (ISO 6336, DIN 3996, AGMA) is claimed";

std::string stem(const std::string& output) {
  return std::filesystem::path(output).replace_extension().string();
}

std::string set_stem(const std::string& output, const LifeOfSet& one) {
  return stem(output) + "_" + one.set.body + "_" + one.set.set;
}

// Sums over the duty cycle; hours < 0: not known.
struct Total {
  double revolutions = 0, hours = 0;
};

Total total(const std::vector<life::Block>& blocks) {
  Total sum;
  bool known = true;
  for (const life::Block& block : blocks) {
    sum.revolutions += block.revolutions;
    sum.hours += block.time / 3600;
    known = known && block.time > 0;
  }
  if (!known) sum.hours = -1;
  return sum;
}

double largest_damage(const LifeOfSet& one) { return one.set.damage[one.set.critical]; }

Eigen::VectorXd as_numbers(const std::vector<int>& values) {
  return Eigen::Map<const Eigen::VectorXi>(values.data(), static_cast<Eigen::Index>(values.size()))
      .cast<double>();
}

void write_damage_table(const std::string& path, const io::LifeSet& set) {
  std::vector<io::CsvColumn> columns = {{"node", "1", as_numbers(set.node)},
                                        {"tooth", "1", as_numbers(set.tooth)},
                                        {"x", "m", set.X.row(0)},
                                        {"y", "m", set.X.row(1)},
                                        {"z", "m", set.X.row(2)},
                                        {"damage", "1", set.damage},
                                        {"amplitude", "Pa", set.amplitude}};
  if (set.damage_with_error.size() > 0)
    columns.push_back({"damage with estimated error", "1", set.damage_with_error});
  io::write_csv(path, columns);
}

void write_cycle_table(const std::string& path, const LifeReport& report, const io::LifeSet& set) {
  const io::CycleTable& cycles = set.cycles;
  Eigen::VectorXd torque(static_cast<Eigen::Index>(cycles.block.size()));
  for (Eigen::Index i = 0; i < torque.size(); ++i)
    torque[i] = report.blocks[static_cast<std::size_t>(cycles.block[static_cast<std::size_t>(i)])].torque;
  io::write_csv(path, {{"torque", "N m", torque},
                       {"range", "Pa", cycles.range},
                       {"mean", "Pa", cycles.mean},
                       {"amplitude", "Pa", cycles.amplitude},
                       {"count", "1", cycles.count},
                       {"damage", "1", cycles.damage}});
}

// Zero at nodes that are in none of the gear's sets.
void write_field_of(const std::string& path, const LifeReport& report, const LifeOfSet& first) {
  const mesh::Mesh mesh = io::read_body_source(first.body_file).mesh;
  Eigen::MatrixXd damage = Eigen::MatrixXd::Zero(1, mesh.n_nodes()), amplitude = damage, evaluated = damage;
  for (const LifeOfSet& one : report.sets) {
    if (one.set.body != first.set.body) continue;
    for (std::size_t i = 0; i < one.set.node.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      damage(0, one.set.node[i]) = one.set.damage[at];
      amplitude(0, one.set.node[i]) = one.set.amplitude[at];
      evaluated(0, one.set.node[i]) = 1;
    }
  }
  io::write_vtu(path, mesh,
                {{"damage [1]", damage}, {"amplitude [Pa]", amplitude}, {"evaluated [1]", evaluated}});
}

// Sets whose body has not come before.
std::vector<const LifeOfSet*> first_of_bodies(const LifeReport& report) {
  std::vector<const LifeOfSet*> first;
  for (const LifeOfSet& one : report.sets)
    if (std::none_of(first.begin(), first.end(),
                     [&](const LifeOfSet* other) { return other->set.body == one.set.body; }))
      first.push_back(&one);
  return first;
}

std::string field_path(const std::string& output, const LifeOfSet& one) {
  return stem(output) + "_" + one.set.body + ".vtu";
}

// The largest of the set, whichever node has it; nothing where the error is not estimated.
std::optional<double> largest_with_error(const LifeOfSet& one) {
  if (one.set.damage_with_error.size() == 0) return {};
  return one.set.damage_with_error.maxCoeff();
}

ordered_json json_of_life(double damage, const LifeOfSet& one, const Total& sum) {
  if (damage == 0) return nullptr;
  ordered_json life = {{"duty_cycles", 1 / damage},
                       {"revolutions_of_first_gear", sum.revolutions / damage},
                       {"revolutions_of_this_gear", sum.revolutions * one.ratio / damage}};
  life["hours"] = sum.hours < 0 ? ordered_json(nullptr) : ordered_json(sum.hours / damage);
  return life;
}

ordered_json json_of_set(const LifeOfSet& one, const Total& sum) {
  const auto at = static_cast<std::size_t>(one.set.critical);
  const Eigen::Vector3d x = one.set.X.col(one.set.critical);
  const std::optional<double> with_error = largest_with_error(one);
  const Eigen::VectorXd blocks = one.set.block_damage.row(one.set.critical);
  return {{"body", one.set.body},
          {"set", one.set.set},
          {"damage", largest_damage(one)},
          {"damage_by_block", std::vector<double>(blocks.begin(), blocks.end())},
          {"node", one.set.node[at]},
          {"tooth", one.laid ? ordered_json("all alike") : ordered_json(one.set.tooth[at])},
          {"x_m", {x[0], x[1], x[2]}},
          {"largest_stress_Pa", one.largest},
          {"largest_amplitude_fully_reversed_Pa", one.set.amplitude[one.set.critical]},
          {"from_one_pitch", one.laid},
          {"life", json_of_life(largest_damage(one), one, sum)},
          {"damage_with_error", with_error ? ordered_json(*with_error) : nullptr},
          {"life_with_error", with_error ? json_of_life(*with_error, one, sum) : nullptr}};
}

void write_summary(const std::string& path, const LifeReport& report) {
  const Total sum = total(report.blocks);
  ordered_json json = {{"note", kNote}};
  for (const life::Block& block : report.blocks)
    json["duty_cycle"].push_back({{"torque_Nm", block.torque},
                                  {"revolutions_of_first_gear", block.revolutions},
                                  {"hours", block.time > 0 ? ordered_json(block.time / 3600) : nullptr}});
  for (const SweptTorque& at : report.swept)
    json["sweeps"].push_back({{"torque_Nm", at.torque}, {"file", at.file}});
  for (const LifeOfSet& one : report.sets) json["sets"].push_back(json_of_set(one, sum));
  write_file(path, json_text(json));
}

std::string place(const LifeOfSet& one) {
  const auto at = static_cast<std::size_t>(one.set.critical);
  return "at node " + std::to_string(one.set.node[at]) +
         (one.laid ? ", the same of every tooth" : ", tooth " + std::to_string(one.set.tooth[at]));
}

// Rounded, since a life is not known to more digits.
std::string rounded(double value, const std::string& unit) {
  if (is_verbose()) return with_unit(value, unit);
  char number[32];
  std::snprintf(number, sizeof number, "%.3g", value);
  return std::string(number).append(" ").append(unit);
}

// Does the gear last for the duty cycle? It fails where the damage reaches 1.
std::string verdict(const LifeOfSet& one) {
  const double damage = largest_damage(one);
  const std::optional<double> with_error = largest_with_error(one);
  const std::string figures =
      "damage " + rounded(damage, "by the stress") +
      (with_error ? ", " + rounded(*with_error, "by the stress and its estimated error") : "") +
      "; failure at 1";
  if (damage >= 1) return "not reached: " + figures;
  if (!with_error) return "reached by the stress, whose error is not estimated: " + figures;
  return (*with_error < 1 ? "reached: " : "open within the error of the stress, a finer mesh decides: ") +
         figures;
}

std::string name_of(const LifeOfSet& one) { return one.set.body + " " + one.set.set; }

std::string life_text(double damage, const Total& sum) {
  if (damage == 0) return "without end";
  std::string text = rounded(sum.revolutions / damage, "revolutions of the first gear");
  if (sum.hours >= 0) text += ", " + rounded(sum.hours / damage, "h");
  return text;
}

void print_set(const LifeOfSet& one, const Total& sum) {
  const double damage = largest_damage(one);
  print_item(name_of(one), "largest damage " + rounded(damage, "in a duty cycle") + ", " + place(one));
  print_item("", "largest stress there " + rounded(1e-6 * one.largest, "MPa") +
                     ", fully reversed amplitude " +
                     rounded(1e-6 * one.set.amplitude[one.set.critical], "MPa"));
  print_item("", "life at the stress " + life_text(damage, sum));
  if (const std::optional<double> with_error = largest_with_error(one))
    print_item("", "life at the stress and its estimated error " + life_text(*with_error, sum));
  else
    print_item("warning", name_of(one) +
                              ": the error of the stress is not estimated, and the life goes with a high "
                              "power of it: recover with error estimates, or repeat with a finer mesh");
  if (one.laid && one.pitches > 1)
    print_item("", "from the first of " + std::to_string(one.pitches) +
                       " pitches; others differ by at most " + rounded(1e-6 * one.difference, "MPa"));
}

}  // namespace

std::vector<std::string> side_files(const std::string& output, const LifeReport& report, bool field) {
  std::vector<std::string> files = {stem(output) + ".json"};
  for (const LifeOfSet& one : report.sets) {
    files.push_back(set_stem(output, one) + ".csv");
    files.push_back(set_stem(output, one) + "_cycles.csv");
  }
  for (const LifeOfSet* one : first_of_bodies(report))
    if (field && !one->body_file.empty()) files.push_back(field_path(output, *one));
  return files;
}

void write_side_files(const std::string& output, const LifeReport& report, bool field) {
  for (const LifeOfSet& one : report.sets) {
    write_damage_table(set_stem(output, one) + ".csv", one.set);
    write_cycle_table(set_stem(output, one) + "_cycles.csv", report, one.set);
  }
  write_summary(stem(output) + ".json", report);
  for (const LifeOfSet* one : first_of_bodies(report))
    if (field && !one->body_file.empty()) write_field_of(field_path(output, *one), report, *one);
  for (const std::string& file : side_files(output, report, field)) print_item("written", file);
}

void print_life(const LifeReport& report) {
  const Total sum = total(report.blocks);
  const std::size_t n = report.blocks.size();
  print_item("duty cycle", std::to_string(n) + (n == 1 ? " block, " : " blocks, ") +
                               rounded(sum.revolutions, "revolutions of the first gear") +
                               (sum.hours < 0 ? "" : ", " + rounded(sum.hours, "h")));
  for (const LifeOfSet& one : report.sets) print_item("  " + name_of(one), verdict(one));
  print_item("stresses known at",
             join(report.swept, ", ", [](const SweptTorque& at) { return with_unit(at.torque, "N m"); }));
  for (const LifeOfSet& one : report.sets) print_set(one, sum);
  print_item("note", kNote);
}

}  // namespace elastogear::app
