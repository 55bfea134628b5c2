// What evaluate prints on one screen: stress at the roots first, with what limits its accuracy, then the
// mesh.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <set>

#include "app/console/console.h"
#include "app/evaluate/evaluate_tables.h"

namespace elastogear::app {
namespace {

using io::EvaluationItem;
using Items = std::vector<EvaluationItem>;

constexpr double kMega = 1e6;

// Pairs of gears of one kind, as a sun has with each of its planets.
struct PairsOfKind {
  std::string name;  // "sun:planet"
  std::vector<const PairFigures*> pairs;
};

std::vector<PairsOfKind> sum_up(const CaseFigures& of, const Surroundings& about) {
  std::vector<PairsOfKind> all;
  for (const PairFigures& pair : of.pairs) {
    const std::size_t colon = pair.pair.find(':');
    const std::string name =
        about.kind_of(pair.pair.substr(0, colon)) + ":" + about.kind_of(pair.pair.substr(colon + 1));
    const auto known =
        std::find_if(all.begin(), all.end(), [&](const PairsOfKind& kind) { return kind.name == name; });
    if (known == all.end())
      all.push_back({name, {&pair}});
    else
      known->pairs.push_back(&pair);
  }
  return all;
}

double number(const Items& items, const std::string& path) {
  const EvaluationItem* item = find_item(items, path);
  return item && !item->value.empty() ? item->value[0] : NAN;
}

std::string word(const Items& items, const std::string& path) {
  const EvaluationItem* item = find_item(items, path);
  return item && !item->words.empty() ? item->words[0] : "";
}

// The smallest and the largest value of all pairs of a kind; empty where none has it.
struct Span {
  double low = INFINITY, high = -INFINITY, error = 0;

  // "11.1 to 11.4", with the largest of the estimated errors "11.07 to 11.41 +- 0.21".
  std::string text() const {
    if (low > high) return "";
    const bool knows = error > 0;
    const auto number = [&](double x) { return knows ? rounded_to(error, x) : short_number(x); };
    const std::string first = number(low), last = number(high);
    return (first == last ? first : first + " to " + last) + (knows ? " +- " + number(error) : "");
  }
};

Span span_of(const PairsOfKind& of, const std::string& path, double factor) {
  Span span;
  for (const PairFigures* pair : of.pairs) {
    const double value = factor * number(pair->items, path);
    if (!std::isfinite(value)) continue;
    span.low = std::min(span.low, value), span.high = std::max(span.high, value);
    const double error = factor * number(pair->items, path + "_mesh_error");
    if (error > span.error) span.error = error;
  }
  return span;
}

std::string span(const PairsOfKind& of, const std::string& path, double factor) {
  return span_of(of, path, factor).text();
}

// "left (drive) flank": where the first gear drives by the flanks of a side, these are that side's flanks.
std::string flank(const std::string& side, const Surroundings& about) {
  return side + " (" + about.loaded_flanks + ") flank";
}

// A largest stress at the roots of gears of one kind.
struct RootPeak {
  std::string gear, path;  // "root/pinion/largest_tension"
  const Items* items = nullptr;

  double value() const { return number(*items, path); }
  double part(const char* cause) const { return number(*items, path + cause); }
};

struct Cause {
  const char *item, *name;
};
constexpr Cause kCauses[] = {{"_mesh_error", "the mesh"},
                             {"_contact_error", "the resolution of the contact by the mesh"},
                             {"_error", "the modes"},
                             {"_time_error", "the steps in time"}};

double error_of(const RootPeak& peak) { return whole_error(*peak.items, peak.path); }

std::string in_megapascal(const RootPeak& peak) {
  const double error = error_of(peak);
  return with_error(peak.value(), error) + " MPa" + (error > 0 ? "" : ", its error is not estimated");
}

// The largest tension of each kind of gear, in the order of the pairs.
std::vector<std::pair<std::string, RootPeak>> root_peaks(const CaseFigures& of, const Surroundings& about) {
  std::vector<std::pair<std::string, RootPeak>> peaks;
  for (const PairFigures& pair : of.pairs)
    for (const EvaluationItem& item : pair.items) {
      if (!item.path.starts_with("root/") || !item.path.ends_with("/largest_tension")) continue;
      const std::string gear = item.path.substr(5, item.path.rfind('/') - 5);
      const RootPeak peak{gear, item.path, &pair.items};
      const std::string kind = about.kind_of(gear);
      const auto known =
          std::find_if(peaks.begin(), peaks.end(), [&](const auto& entry) { return entry.first == kind; });
      if (known == peaks.end())
        peaks.emplace_back(kind, peak);
      else if (peak.value() > known->second.value())
        known->second = peak;
    }
  return peaks;
}

// A length in m, in mm, to a tenth.
std::string place_in_mm(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f mm", 1e3 * length + 0.0);
  return std::string(text) == "-0.0 mm" ? "0.0 mm" : text;
}

std::string place_of_root(const RootPeak& peak, const Surroundings& about) {
  const std::string group = peak.path.substr(0, peak.path.rfind('/'));
  return "tooth " + short_number(peak.part("_tooth")) + ", root of the " +
         flank(word(*peak.items, group + "/side"), about) + ", diameter " +
         place_in_mm(peak.part("_diameter")) + ", z " + place_in_mm(peak.part("_z"));
}

// The option that makes an error of this kind smaller.
std::string remedy(const Cause& cause, const RootPeak& peak, const Surroundings& about) {
  const std::string item = cause.item;
  if (item == "_error") return "more modes (-modes)";
  if (item == "_time_error") return "a smaller -step_error";
  if (about.chosen_by_accuracy) {
    char text[48];
    const double half = 50 * error_of(peak) / std::abs(peak.value());
    std::snprintf(text, sizeof text, half < 9.5 ? "-accuracy \"%.1g %%\"" : "-accuracy \"%.0f %%\"", half);
    return text;
  }
  if (!find_item(*peak.items, "time")) return "elastogear run with -accuracy in place of -size";
  return about.finer.empty() ? "a finer mesh" : "a finer mesh (-size " + about.finer + ")";
}

void print_limit(const RootPeak& peak, const Surroundings& about) {
  const double all = error_of(peak);
  if (!(all > 0)) return;
  const Cause* most = &kCauses[0];
  for (const Cause& cause : kCauses)
    if (peak.part(cause.item) > peak.part(most->item)) most = &cause;
  print_item("  limited by", std::string(most->name) + ", " + short_number(1e-6 * peak.part(most->item)) +
                                 " of " + short_number(1e-6 * all) + " MPa at " + peak.gear +
                                 "; remedy: " + remedy(*most, peak, about));
}

void print_roots(const CaseFigures& of, const Surroundings& about) {
  const auto peaks = root_peaks(of, about);
  if (peaks.empty()) return;
  print_item("tension at the roots", "largest principal stress in the fillets");
  const RootPeak* least_sure = &peaks.front().second;
  const auto share = [](const RootPeak& peak) { return error_of(peak) / std::abs(peak.value()); };
  for (const auto& [kind, peak] : peaks) {
    print_item("  " + kind, in_megapascal(peak) + (kind == peak.gear ? ", " : ", " + peak.gear + " ") +
                                place_of_root(peak, about));
    if (share(peak) > share(*least_sure)) least_sure = &peak;
  }
  print_limit(*least_sure, about);
}

// "; below it 500 MPa of shear, 0.21 mm deep".
std::string shear_below(const Items& items) {
  const double shear = number(items, "pressure/hertz_shear");
  if (!std::isfinite(shear)) return {};
  return "; below it " + short_number(1e-6 * shear) + " MPa of shear, " +
         short_number(1e3 * number(items, "pressure/hertz_shear_depth")) + " mm deep";
}

void print_pressure(const PairsOfKind& of, const Surroundings& about) {
  const auto peak_of = [](const PairFigures& pair) {
    const double hertz = number(pair.items, "pressure/hertz_peak");
    return std::isfinite(hertz) ? hertz : number(pair.items, "pressure/peak");
  };
  const PairFigures& pair =
      **std::max_element(of.pairs.begin(), of.pairs.end(),
                         [&](const auto* a, const auto* b) { return peak_of(*a) < peak_of(*b); });
  const bool hertz = find_item(pair.items, "pressure/hertz_peak") != nullptr,
             placed = number(pair.items, "pressure/by_hertz") > 0 || !hertz;
  if (!std::isfinite(peak_of(pair))) return;
  const std::string gear = pair.pair.substr(0, pair.pair.find(':')), place = "pressure/peak_on_" + gear;
  const auto in_mm_of = [&](const char* name) { return place_in_mm(number(pair.items, place + name)); };
  print_item("  flank pressure",
             with_error(peak_of(pair), hertz ? number(pair.items, "pressure/hertz_peak_mesh_error") : 0) +
                 " MPa" + (hertz ? " by H. Hertz" : " in the mean over faces of the mesh") +
                 (placed ? ", " + gear + " tooth " + short_number(number(pair.items, place + "/tooth")) +
                               ", " + flank(word(pair.items, place + "/side"), about) + ", diameter " +
                               in_mm_of("/diameter") + ", z " + in_mm_of("/z")
                         : ", roll angle " + short_number(number(pair.items, "pressure/hertz_peak_roll")) +
                               " pitches") +
                 shear_below(pair.items));
}

// Amplitudes of the first orders of the mesh with their errors, where these are known: "1: 5.87 +- 0.12, 2:
// 2.42 +- 0.05".
std::string orders_of(const Items& items, const std::string& path, double factor) {
  const EvaluationItem *order = find_item(items, path + "/order"),
                       *amplitude = find_item(items, path + "/amplitude"),
                       *error = find_item(items, path + "/amplitude_mesh_error");
  if (!order || !amplitude) return "";
  std::string text;
  constexpr int kFirst = 3;
  for (std::size_t i = 0, n = 0; i < order->value.size() && n < kFirst; ++i) {
    if (order->value[i] != std::round(order->value[i]) || !(order->value[i] > 0)) continue;
    const double value = factor * amplitude->value[i];
    text += (n++ ? ", " : "") + short_number(order->value[i]) + ": " +
            (error ? Span{value, value, factor * error->value[i]}.text() : short_number(value));
  }
  return text;
}

void print_error(const PairsOfKind& of) {
  const std::string name = "transmission_error/", p_p = span(of, name + "peak_to_peak", 1e6),
                    unloaded = span(of, name + "unloaded_peak_to_peak", 1e6),
                    orders = orders_of(of.pairs[0]->items, "transmission_error", 1e6);
  print_item("  transmission error",
             (p_p.empty() ? ""
                          : p_p + " um peak to peak" +
                                (unloaded.empty() ? "" : " (" + unloaded + " without load)") + ", mean ") +
                 span(of, name + "mean", 1e6) + " um" +
                 (orders.empty() || find_item(of.pairs[0]->items, "time")
                      ? ""
                      : "; orders of the mesh " + orders + " um"));
}

void print_stiffness(const PairsOfKind& of, bool in_bearings) {
  for (const std::string kind : {"secant", "tangent"}) {
    std::string text = span(of, "stiffness/" + kind + "_mean", 1e-6);
    if (text.empty()) continue;
    Span per_width = span_of(of, "stiffness/" + kind + "_per_width", 1e-9);
    per_width.error = 0;
    text.append(" N/um, ").append(per_width.text());
    text.append(" N/(mm um) over the face width (").append(kind);
    text.append(in_bearings ? ", with the deflection of the bearings)" : ")");
    print_item("  mesh stiffness", text);
  }
}

void print_sharing(const PairsOfKind& of) {
  const std::string factor = span(of, "line_load/KHbeta", 1);
  print_item("  load sharing", "contact ratio " + span(of, "teeth/contact_ratio", 1) + " under load, up to " +
                                   span(of, "teeth/largest_share", 100) + " % on one pair of teeth" +
                                   (factor.empty() ? "" : "; KHbeta " + factor));
}

void print_losses(const PairsOfKind& of) {
  std::string text = span(of, "losses/largest_sliding_speed", 1) + " m/s at " + span(of, "losses/speed", 1) +
                     " rad/s of the first gear";
  if (const std::string efficiency = span(of, "losses/efficiency", 100); !efficiency.empty())
    text += "; efficiency " + efficiency + " %";
  print_item("  sliding", text);
  if (const std::string factor = span(of, "force/dynamic_factor", 1); !factor.empty())
    print_item("  dynamic factor", factor + ", contact force up to " + span(of, "force/largest", 1) + " N");
}

void print_kind(const PairsOfKind& of, const Surroundings& about, bool in_bearings) {
  print_item(of.name, of.pairs.size() > 1 ? std::to_string(of.pairs.size()) + " meshes" : "");
  print_pressure(of, about);
  print_error(of);
  print_stiffness(of, in_bearings);
  print_sharing(of);
  print_losses(of);
}

// "6890 N radial"; empty where there is none.
std::string largest_of_bearing(const Items& items, const std::string& group, const char* name, double factor,
                               const std::string& what) {
  constexpr double kNoticeable = 1e-3;  // of the radial one
  const std::string across = std::string("radial") + std::strchr(name, '_');
  const double value = factor * number(items, group + "largest_" + name),
               radial = factor * number(items, group + "largest_" + across);
  return std::abs(value) > kNoticeable * radial ? short_number(value) + " " + what : "";
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words)
    if (!word.empty()) text += (text.empty() ? "" : ", ") + word;
  return text;
}

void print_bearings(const Items& items) {
  for (const EvaluationItem& item : items) {
    if (!item.path.ends_with("/gear")) continue;
    const std::string group = item.path.substr(0, item.path.rfind('/') + 1),
                      name = group.substr(9, group.size() - 10),
                      orders = orders_of(items, group + "radial_load_orders", 1);
    const auto largest = [&](const char* what, double factor, const char* words) {
      return largest_of_bearing(items, group, what, factor, words);
    };
    print_item(name, joined({largest("radial_load", 1, "N radial"), largest("axial_load", 1, "N axial"),
                             largest("radial_deflection", 1e6, "um radial"),
                             largest("axial_deflection", 1e6, "um axial")}) +
                         (orders.empty() ? "" : "; orders of the radial load " + orders + " N"));
  }
}

}  // namespace

double whole_error(const Items& items, const std::string& path) {
  double sum = 0;
  for (const Cause& cause : kCauses)
    if (const double part = number(items, path + cause.item); part >= 0) sum += part;
  const bool known = number(items, path + "_error") >= 0 && number(items, path + "_mesh_error") >= 0;
  return known ? sum : 0;
}

std::string with_error(double value, double error) {
  if (!(error > 0)) return short_number(value / kMega);
  return Span{value / kMega, value / kMega, error / kMega}.text();
}

std::string Surroundings::kind_of(const std::string& gear) const {
  const auto known = kind.find(gear);
  return known == kind.end() ? gear : known->second;
}

bool is_in_bearings(const CaseFigures& of, const std::string& pair) {
  const std::size_t colon = pair.find(':');
  return std::any_of(of.bearings.begin(), of.bearings.end(), [&](const EvaluationItem& item) {
    return item.path.ends_with("/gear") &&
           (item.words[0] == pair.substr(0, colon) || item.words[0] == pair.substr(colon + 1));
  });
}

void print_case_in_short(const CaseFigures& of, const Surroundings& about) {
  print_roots(of, about);
  constexpr std::size_t kMostKinds = 3;
  const std::vector<PairsOfKind> kinds = sum_up(of, about);
  if (kinds.size() > kMostKinds)
    print_cases({of});
  else
    for (const PairsOfKind& kind : kinds) print_kind(kind, about, is_in_bearings(of, kind.pairs[0]->pair));
  print_bearings(of.bearings);
  for (const std::string& note : of.notes) print_item("note", note);
}

}  // namespace elastogear::app
