// The tables that evaluate prints on the terminal.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "app/console/console.h"
#include "app/evaluate/evaluate_tables.h"
#include "elastogear/base/text.h"

namespace elastogear::app {
namespace {

using io::EvaluationItem;

// Values of one pair, in the units that engineers read.
struct Reader {
  const std::vector<EvaluationItem>& items;

  bool has(const std::string& path) const { return find_item(items, path) != nullptr; }
  double value(const std::string& path) const { return find_item(items, path)->value[0]; }
  std::string in(const std::string& path, double factor, const std::string& unit) const {
    return with_unit(factor * value(path), unit);
  }
  std::string word(const std::string& path) const { return find_item(items, path)->words[0]; }
};

std::string whole(const Reader& of, const std::string& path) {
  return std::to_string(static_cast<long>(of.value(path)));
}

std::string digits_of(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

void print_error(const Reader& of) {
  const std::string name = "transmission_error/";
  // A single position has neither a mean nor a peak-to-peak value.
  const bool several = of.has(name + "peak_to_peak");
  const std::string mean = of.in(name + "mean", 1e6, "um");
  print_item("transmission error",
             (several ? "mean " + mean + ", peak to peak " + of.in(name + "peak_to_peak", 1e6, "um") : mean) +
                 " on the radius " + of.in(name + "radius", 1e3, "mm") + "; > 0: the second gear leads");
  if (of.has(name + "unloaded_peak_to_peak"))
    print_item("", "peak to peak without load " + of.in(name + "unloaded_peak_to_peak", 1e6, "um"));
  const EvaluationItem* amplitude = find_item(of.items, name + "amplitude");
  const EvaluationItem* order = find_item(of.items, name + "order");
  if (!amplitude || find_item(of.items, "time")) return;
  std::string text;
  for (std::size_t i = 0, n = 0; i < order->value.size() && n < 3; ++i)
    if (order->value[i] == static_cast<long>(order->value[i])) {
      text += (n++ ? ", " : "") + digits_of(order->value[i], 3) + ": " +
              with_unit(1e6 * amplitude->value[i], "um");
    }
  print_item("", "orders of the mesh, amplitudes " + text);
}

void print_pitches(const Reader& of) {
  const std::string name = "by_pitch/largest_";
  if (!of.has(name + "peak_to_peak")) return;
  print_item("", "largest peak to peak within a pitch " + of.in(name + "peak_to_peak", 1e6, "um") + ", at " +
                     of.in(name + "at_speed", 1, "rad/s"));
}

void print_stiffness(const Reader& of, bool in_bearings) {
  for (const char* kind : {"secant", "tangent"})
    if (const std::string name = std::string("stiffness/") + kind; of.has(name + "_mean"))
      print_item(std::string("mesh stiffness, ") + kind,
                 of.in(name + "_mean", 1e-6, "N/um") + ", over the face width " +
                     of.in(name + "_per_width", 1e-9, "N/(mm um)") +
                     (of.has(name + "_peak_to_peak")
                          ? ", peak to peak " + of.in(name + "_peak_to_peak", 1e-6, "N/um")
                          : "") +
                     (in_bearings ? ", with the deflection of the bearings" : ""));
}

void print_load(const Reader& of) {
  if (of.has("teeth/contact_ratio"))
    print_item("operating contact ratio", digits_of(of.value("teeth/contact_ratio"), 4) +
                                              "; one pair of teeth carries up to " +
                                              of.in("teeth/largest_share", 100, "%"));
  if (of.has("teeth/begins"))
    print_item("a pair of teeth is loaded",
               "from " + digits_of(of.value("teeth/begins"), 4) + " to " +
                   digits_of(of.value("teeth/ends"), 4) + " pitches of its way" +
                   (of.has("teeth/path_begins")
                        ? ", rigid teeth from " + digits_of(of.value("teeth/path_begins"), 4) + " to " +
                              digits_of(of.value("teeth/path_ends"), 4)
                        : ""));
  if (of.has("line_load/KHbeta")) print_item("KHbeta", digits_of(of.value("line_load/KHbeta"), 4));
}

std::string place_on(const Reader& of, const std::string& gear) {
  const std::string path = "pressure/peak_on_" + gear;
  const bool roll = of.has(path + "/length_of_roll");
  return gear + " tooth " + whole(of, path + "/tooth") + " " + of.word(path + "/side") + ", " +
         (roll ? "length of roll " : "radius ") +
         of.in(path + (roll ? "/length_of_roll" : "/radius"), 1e3, "mm") + ", z " +
         of.in(path + "/z", 1e3, "mm");
}

void print_pressure(const Reader& of, const std::string& pair) {
  if (!of.has("pressure/peak")) return;
  print_item("largest contact pressure", of.in("pressure/peak", 1e-6, "MPa") + ", roll angle " +
                                             of.in("pressure/peak_roll", 1, "pitches"));
  print_item("", place_on(of, pair.substr(0, pair.find(':'))));
  if (of.has("pressure/hertz_peak"))
    print_item("", "by H. Hertz " + of.in("pressure/hertz_peak", 1e-6, "MPa") + ", roll angle " +
                       of.in("pressure/hertz_peak_roll", 1, "pitches") + ", on " +
                       of.in("pressure/hertz_half_width", 1e3, "mm") + " of half width; without " +
                       of.in("pressure/hertz_left_out", 100, "%") + " of the contacts, at ends of flanks");
}

void print_roots(const Reader& of) {
  for (const EvaluationItem& item : of.items) {
    if (!item.path.starts_with("root/") || !item.path.ends_with("/largest_tension")) continue;
    const std::string path = item.path.substr(0, item.path.rfind('/'));
    const auto peak = [&](const std::string& name) {
      const bool error = of.has(path + name + "_error"), mesh_error = of.has(path + name + "_mesh_error"),
                 contact_error = of.has(path + name + "_contact_error"),
                 of_coarser = of.has(path + "/range_mesh_error"),  // the mesh's error has the contact's
          time_error = of.has(path + name + "_time_error");
      return of.in(path + name, 1e-6, "MPa") + " at node " + whole(of, path + name + "_node") + " of tooth " +
             whole(of, path + name + "_tooth") + ", roll angle " +
             of.in(path + name + "_roll", 1, "pitches") +
             (error ? ", estimated error " + of.in(path + name + "_error", 1e-6, "MPa")
                    : std::string(", error not estimated: not to be trusted")) +
             (mesh_error ? ", by the mesh " + of.in(path + name + "_mesh_error", 1e-6, "MPa")
                         : std::string(", error of the mesh not estimated")) +
             (contact_error
                  ? ", by the contact's resolution " + of.in(path + name + "_contact_error", 1e-6, "MPa")
                  : std::string(of_coarser ? "" : ", that of the contact's resolution not estimated")) +
             (time_error ? ", by the steps in time " + of.in(path + name + "_time_error", 1e-6, "MPa") : "");
    };
    const std::string gear = path.substr(5);
    print_item("root of " + gear + ", tension", peak("/largest_tension"));
    if (of.has(path + "/range"))
      print_item("",
                 "range of the signed stress of a tooth on its way " + of.in(path + "/range", 1e-6, "MPa"));
    print_item("root of " + gear + ", von Mises", peak("/largest_von_mises"));
  }
}

void print_losses(const Reader& of) {
  const std::string speed = of.in("losses/speed", 1, "rad/s");
  print_item("sliding", of.in("losses/largest_sliding_speed", 1, "m/s") + ", pressure times sliding speed " +
                            of.in("losses/largest_pv", 1e-6, "W/mm^2") + ", at " + speed);
  const std::string per_friction =
      "loss per coefficient of friction " + digits_of(of.value("losses/loss_factor"), 4);
  if (of.has("losses/efficiency"))
    print_item("efficiency", of.in("losses/efficiency", 100, "%") + "; friction takes " +
                                 of.in("losses/friction_loss", 100, "%") + " of the input; " + per_friction);
  else
    print_item("losses", "the run has no friction; " + per_friction);
  if (of.has("force/dynamic_factor"))
    print_item("dynamic factor", digits_of(of.value("force/dynamic_factor"), 4) + ", largest contact force " +
                                     of.in("force/largest", 1, "N"));
}

constexpr const char* kNone = "-";  // in place of a figure that is not known

// Largest tension at the roots of both gears with its estimated error, MPa, and the gear that has it.
std::array<std::string, 2> largest_tension(const std::vector<EvaluationItem>& items) {
  constexpr std::string_view kGroup = "root/";
  const EvaluationItem* largest = nullptr;
  for (const EvaluationItem& item : items)
    if (item.path.starts_with(kGroup) && item.path.ends_with("/largest_tension"))
      if (!largest || item.value[0] > largest->value[0]) largest = &item;
  if (!largest) return {kNone, kNone};
  const std::string gear = largest->path.substr(kGroup.size(), largest->path.rfind('/') - kGroup.size());
  return {with_error(largest->value[0], whole_error(items, largest->path)), gear};
}

// Largest pressure, MPa: by H. Hertz, in brackets the mean over faces where that is not known.
std::string largest_pressure(const std::vector<EvaluationItem>& items) {
  if (const EvaluationItem* hertz = find_item(items, "pressure/hertz_peak"))
    return short_number(1e-6 * hertz->value[0]);
  const EvaluationItem* mean = find_item(items, "pressure/peak");
  return mean ? "(" + short_number(1e-6 * mean->value[0]) + ")" : kNone;
}

// The text of a case in a column of the table of cases; empty where the case has none.
std::string in_column(const Case& of, const std::string& heading) {
  for (const auto& [name, text] : of.columns)
    if (name == heading) return text;
  return "";
}

std::string torque_of(const Case& of) {
  const double torque = number_in_column(of, "torque");
  return std::isfinite(torque) ? digits_of(torque, 6) : "";
}

using Texts = std::vector<std::string>;

// Columns side by side, the first n_words of them words, without those in which no row has anything.
void print_table(const Texts& title, const std::vector<Texts>& rows, std::size_t n_words) {
  std::vector<int> width(title.size(), 0);
  for (std::size_t i = 0; i < title.size(); ++i) {
    for (const Texts& row : rows) width[i] = std::max(width[i], static_cast<int>(row[i].size()));
    if (width[i] > 0) width[i] = std::max(width[i], static_cast<int>(title[i].size()));
  }
  const auto print = [&](const Texts& row) {
    for (std::size_t i = 0; i < row.size(); ++i)
      if (width[i] > 0) std::printf("%*s  ", i < n_words ? -width[i] : width[i], row[i].c_str());
    std::printf("\n");
  };
  print(title);
  for (const Texts& row : rows) print(row);
}

}  // namespace

void print_figures(const CaseFigures& of) {
  for (const PairFigures& pair : of.pairs) {
    std::printf("%s, %s\n", printable(of.of.name).c_str(), printable(pair.pair).c_str());
    const Reader reader{pair.items};
    print_error(reader);
    print_pitches(reader);
    print_stiffness(reader, is_in_bearings(of, pair.pair));
    print_load(reader);
    print_pressure(reader, pair.pair);
    print_roots(reader);
    print_losses(reader);
  }
  for (const EvaluationItem& item : of.bearings)
    if (item.shape.empty() && item.words.empty()) print_item(item.path, with_unit(item.value[0], item.unit));
  for (const std::string& note : of.notes) print_item("note", note);
}

void print_cases(const std::vector<CaseFigures>& cases) {
  struct Column {
    const char *title, *path;
    double factor;
  };
  constexpr Column kColumns[] = {
      {"TE mean um", "transmission_error/mean", 1e6}, {"TE p-p um", "transmission_error/peak_to_peak", 1e6},
      {"secant N/um", "stiffness/secant_mean", 1e-6}, {"tangent N/um", "stiffness/tangent_mean", 1e-6},
      {"contact ratio", "teeth/contact_ratio", 1},    {"KHbeta", "line_load/KHbeta", 1},
      {"efficiency %", "losses/efficiency", 100}};
  constexpr std::size_t kWords = 5;
  Texts title = {"case", "torque N m", "variant", "pair", "root of", "root MPa", "pressure MPa"};
  for (const Column& column : kColumns) title.emplace_back(column.title);
  std::vector<Texts> rows;
  for (const CaseFigures& of : cases)
    for (const PairFigures& pair : of.pairs) {
      const auto [tension, gear] = largest_tension(pair.items);
      Texts& row = rows.emplace_back(Texts{printable(of.of.name), torque_of(of.of),
                                           printable(in_column(of.of, "variant")), printable(pair.pair),
                                           printable(gear), tension, largest_pressure(pair.items)});
      for (const Column& column : kColumns) {
        const EvaluationItem* item = find_item(pair.items, column.path);
        row.push_back(item ? digits_of(column.factor * item->value[0], 4) : kNone);
      }
    }
  print_table(title, rows, kWords);
}

}  // namespace elastogear::app
