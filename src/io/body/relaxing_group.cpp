#include "io/body/relaxing_group.h"

#include <algorithm>
#include <iterator>

#include "elastogear/base/error.h"
#include "io/body/basis_rows.h"

namespace elastogear::io {
namespace {

const std::string kRelaxing = "/relaxing";

// In the order of their enumerations.
constexpr const char* kPartNames[] = {"both", "shear", "bulk"};
constexpr const char* kShiftNames[] = {"none", "wlf", "arrhenius"};

template <class Names>
std::size_t find_word(const h5::File& file, const Names& names, const std::string& word) {
  const auto* const found = std::find(std::begin(names), std::end(names), word);
  require(found != std::end(names), file.path, ": unknown word '", word, "' in the relaxing materials");
  return static_cast<std::size_t>(found - std::begin(names));
}

// The temperatures and constants of a shift with their names and units.
template <class Shift, class Visit>
void visit_shift(Shift& shift, const Visit& visit) {
  visit("/C_1", shift.C_1, "1");
  visit("/C_2", shift.C_2, "K");
  visit("/activation_energy", shift.E_a, "J/mol");
  visit("/temperature_reference", shift.T_ref, "K");
  visit("/temperature", shift.T, "K");
  visit("/temperature_least", shift.T_least, "K");
  visit("/temperature_most", shift.T_most, "K");
}

h5::View<double> numbers(const std::vector<double>& values) { return {{values.size()}, values.data()}; }

}  // namespace

std::string modulus_part_name(model::ModulusPart part) { return kPartNames[static_cast<std::size_t>(part)]; }
std::string shift_name(model::TemperatureShift::Law law) {
  return kShiftNames[static_cast<std::size_t>(law)];
}

void write_relaxing(const h5::File& file, const model::ElasticBody& body, const std::string& unit_of_K) {
  if (body.relaxing.empty()) return;
  h5::make_group(file, kRelaxing);
  for (std::size_t p = 0; p < body.relaxing.size(); ++p) {
    const model::RelaxingPart& part = body.relaxing[p];
    const std::string group = kRelaxing + "/" + std::to_string(p);
    h5::make_group(file, group);
    h5::set_attribute(file, group, "cell_set", part.cell_set);
    h5::set_attribute(file, group, "moduli", modulus_part_name(part.part));
    h5::write<double>(file, group + "/g", view(part.g), "1");
    h5::write<double>(file, group + "/tau", view(part.tau), "s");
    write_square(file, group + "/K", part.K, {body.basis, unit_of_K});
    h5::write<int>(file, group + "/stress_nodes", view(part.stress_node), "1");
  }
}

std::vector<model::RelaxingPart> read_relaxing(const h5::File& file, bool with_stress) {
  std::vector<model::RelaxingPart> parts;
  for (std::size_t p = 0; h5::exists(file, kRelaxing + "/" + std::to_string(p)); ++p) {
    const std::string group = kRelaxing + "/" + std::to_string(p);
    const std::size_t moduli = find_word(file, kPartNames, h5::string_attribute(file, group, "moduli"));
    parts.push_back({h5::string_attribute(file, group, "cell_set"), static_cast<model::ModulusPart>(moduli),
                     read_vector(file, group + "/g"), read_vector(file, group + "/tau"),
                     read_square(file, group + "/K")});
    if (with_stress) parts.back().stress_node = h5::read<int>(file, group + "/stress_nodes", {h5::kAny});
  }
  return parts;
}

void write_viscoelastic(const h5::File& file, const std::string& group, const model::Viscoelastic& material) {
  h5::write<double>(file, group + "/prony_g", numbers(material.g), "1");
  h5::write<double>(file, group + "/prony_k", numbers(material.k), "1");
  h5::write<double>(file, group + "/prony_tau", numbers(material.tau), "s");
  h5::set_attribute(file, group, "shift", shift_name(material.shift.law));
  if (material.shift.law == model::TemperatureShift::Law::none) return;
  visit_shift(material.shift, [&](const char* name, const double& value, const char* unit) {
    h5::write<double>(file, group + name, view(value), unit);
  });
}

std::optional<model::Viscoelastic> read_viscoelastic(const h5::File& file, const std::string& group) {
  if (!h5::exists(file, group + "/prony_tau")) return {};
  const auto list = [&](const char* name) { return h5::read<double>(file, group + name, {h5::kAny}); };
  model::Viscoelastic material{list("/prony_g"), list("/prony_k"), list("/prony_tau")};
  const std::size_t law = find_word(file, kShiftNames, h5::string_attribute(file, group, "shift"));
  material.shift.law = static_cast<model::TemperatureShift::Law>(law);
  if (material.shift.law != model::TemperatureShift::Law::none)
    visit_shift(material.shift, [&](const char* name, double& value, const char*) {
      value = h5::read<double>(file, group + name, {}).front();
    });
  model::validate(material, file.path + ": " + group);
  return material;
}

}  // namespace elastogear::io
