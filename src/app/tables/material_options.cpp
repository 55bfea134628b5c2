#include "app/tables/material_options.h"

#include <algorithm>
#include <cstdio>
#include <set>

#include "app/console/console.h"
#include "app/input/master_curve.h"
#include "app/options/rows.h"
#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

using model::Material, model::Orientation, model::Orthotropic, model::TemperatureShift, model::Viscoelastic;

// One number of a vector.
auto component(Eigen::Vector3d Orthotropic::*vector, int i) {
  return [=](Orthotropic& m) -> double& { return (m.*vector)[i]; };
}

auto axes(Eigen::Vector3d Orientation::*vector) { return in(&Orthotropic::orientation, vector); }

const Rows<Material> kIsotropic = {
    {"<material>_E", &Material::E, "Pa", "Young's modulus", kPositive | kRequired},
    {"<material>_nu", &Material::nu, "-", "Poisson's ratio", kRequired},
    {"<material>_rho", &Material::rho, "kg/m^3", "density", kPositive | kRequired},
};

const Rows<Orthotropic> kOrthotropic = {
    {"<material>_E1", component(&Orthotropic::E, 0), "Pa",
     "orthotropic: Young's modulus along the material's axis 1", kRequired},
    {"<material>_E2", component(&Orthotropic::E, 1), "Pa", "along axis 2", kRequired},
    {"<material>_E3", component(&Orthotropic::E, 2), "Pa", "along axis 3", kRequired},
    {"<material>_nu12", component(&Orthotropic::nu, 0), "-",
     "strain along -2 per strain along 1 when pulled along 1", kRequired},
    {"<material>_nu13", component(&Orthotropic::nu, 1), "-", "strain along -3 when pulled along 1",
     kRequired},
    {"<material>_nu23", component(&Orthotropic::nu, 2), "-", "strain along -3 when pulled along 2",
     kRequired},
    {"<material>_G12", component(&Orthotropic::G, 0), "Pa", "shear modulus of the plane 1 2", kRequired},
    {"<material>_G13", component(&Orthotropic::G, 1), "Pa", "shear modulus of the plane 1 3", kRequired},
    {"<material>_G23", component(&Orthotropic::G, 2), "Pa", "shear modulus of the plane 2 3", kRequired},
    {"<material>_orientation", in(&Orthotropic::orientation, &Orientation::system),
     one_of("rectangular", "cylindrical"),
     "rectangular: axis 1 along axis_1, axis 2 in the plane of axis_1 and axis_2; cylindrical: radial, "
     "tangential, axial"},
    {"<material>_axis_1", axes(&Orientation::axis_1), "-", "rectangular: direction of axis 1"},
    {"<material>_axis_2", axes(&Orientation::axis_2), "-",
     "rectangular: axis 2 lies in the plane of axis_1 and this direction"},
    {"<material>_origin", axes(&Orientation::origin), "m", "cylindrical: a point on the axis"},
    {"<material>_axis", axes(&Orientation::axis), "-", "cylindrical: direction of the axis"},
    {"<material>_rotation", axes(&Orientation::rotation), "rad",
     "rotation vector in these axes that turns them into the material's (a winding angle)"},
};

enum class Moduli { instantaneous, long_term };

// A Prony series and the moduli that the elastic constants are.
struct ViscoelasticInput {
  Viscoelastic material = {};
  std::vector<double> both = {};
  std::string curve = {};  // its file; empty: none
  Moduli moduli = Moduli::instantaneous;
};

auto shift(double TemperatureShift::*member) {
  return [=](ViscoelasticInput& m) -> double& { return m.material.shift.*member; };
}

// Two numbers of the shift.
auto two_numbers(double TemperatureShift::*first, double TemperatureShift::*second) {
  return [=](const Options& options, const std::string& name, ViscoelasticInput& m) {
    if (!options.given(name)) return;
    const std::vector<double> numbers = options.numbers(name);
    require(numbers.size() == 2, options.label(name), ": must be two numbers");
    m.material.shift.*first = numbers[0];
    m.material.shift.*second = numbers[1];
  };
}

const Rows<ViscoelasticInput> kViscoelastic = {
    {"<material>_prony_tau", in(&ViscoelasticInput::material, &Viscoelastic::tau), "s",
     "viscoelastic: relaxation times of a Prony series, at the reference temperature"},
    {"<material>_prony", &ViscoelasticInput::both, "-",
     "relative moduli of its terms, shares of the instantaneous moduli, for shear and bulk together: "
     "Poisson's "
     "ratio is constant"},
    {"<material>_prony_g", in(&ViscoelasticInput::material, &Viscoelastic::g), "-",
     "in place of prony: relative shear moduli"},
    {"<material>_prony_k", in(&ViscoelasticInput::material, &Viscoelastic::k), "-",
     "in place of prony: relative bulk moduli (with prony_g alone: zeros)"},
    {"<material>_master_curve", &ViscoelasticInput::curve, "-",
     "in place of prony: a CSV file with the columns time [s],modulus [MPa] of a relaxation test, or "
     "frequency [Hz],storage [MPa],loss [MPa] of a vibration, of Young's modulus at the reference "
     "temperature; "
     "fitted with the times prony_tau, by default one a decade; gives E as well where that is not given"},
    {"<material>_moduli", &ViscoelasticInput::moduli, one_of("instantaneous", "long_term"),
     "what E and nu, or E1 ... of a viscoelastic material are: instantaneous (glassy) or long_term "
     "(relaxed)"},
    {"<material>_wlf", "-", "",
     "temperature shift of Williams, Landel and Ferry: C_1 (-) and C_2 (K) at the reference temperature",
     two_numbers(&TemperatureShift::C_1, &TemperatureShift::C_2)},
    {"<material>_activation_energy", shift(&TemperatureShift::E_a), "J/mol",
     "temperature shift of Arrhenius: activation energy", kPositive | kDependent},
    {"<material>_temperature_reference", shift(&TemperatureShift::T_ref), "K",
     "temperature of the relaxation times prony_tau", kPositive | kDependent},
    {"<material>_temperature", shift(&TemperatureShift::T), "K",
     "temperature of the material (default: the reference temperature)", kPositive | kDependent},
    {"<material>_temperature_range", "K", "",
     "least and largest temperature for which the shift is known; others are refused",
     two_numbers(&TemperatureShift::T_least, &TemperatureShift::T_most)},
};

bool given(const Options& options, const std::string& prefix, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(),
                     [&](const char* name) { return options.given(prefix + name); });
}

// The Prony series that fits the master curve of a material.
model::PronyFit fitted(const Options& options, const std::string& name) {
  const std::string file = options.text(name + "_master_curve");
  const model::MasterCurve curve = read_master_curve(file);
  const std::vector<double> tau =
      options.given(name + "_prony_tau") ? options.numbers(name + "_prony_tau") : model::decade_times(curve);
  for (double t : tau)
    require(t > 0, "option -", name, "_prony_tau: relaxation time ", t, " s must be positive");
  model::PronyFit fit = model::fit_prony(curve, tau);
  require(!fit.g.empty(), file, ": the modulus does not relax, no term of a Prony series has a share of it");
  return fit;
}

void print_fit(const std::string& name, const model::PronyFit& fit) {
  const auto percent = [](double share) { return with_unit(100 * share, "%"); };
  double left = 1;
  for (double g : fit.g) left -= g;
  print_item(name, "fit of the master curve by " + std::to_string(fit.g.size()) + " terms: deviation " +
                       percent(fit.rms) + " (root mean square), at most " + percent(fit.largest));
  print_item("", "instantaneous modulus " + with_unit(fit.E_0, "Pa") + ", long-term share " + percent(left));
}

// Young's modulus from the master curve, where it is not given.
Options with_modulus(const Options& options, const std::string& name) {
  if (!options.given(name + "_master_curve")) return options;
  const model::PronyFit fit = fitted(options, name);
  print_fit(name, fit);
  Options with = options;
  if (!given(options, name + "_", {"E", "E1", "E2", "E3"})) {
    require(!options.given(name + "_moduli"), "option -", name, "_moduli: E comes from the master curve");
    char E[32];
    std::snprintf(E, sizeof E, "%.17g", fit.E_0);
    with.set_default(name + "_E", E);
  }
  return with;
}

// The Prony series of both moduli from what is given.
void set_moduli(const Options& options, const std::string& name, ViscoelasticInput& input) {
  const bool apart = given(options, name + "_", {"prony_g", "prony_k"});
  if (!input.curve.empty()) {
    require(!apart && !options.given(name + "_prony"), "option -", name,
            "_master_curve: gives the relative moduli; leave -", name, "_prony out");
    const model::PronyFit fit = fitted(options, name);
    input.material.g = input.material.k = fit.g;
    input.material.tau = fit.tau;
    return;
  }
  require(options.given(name + "_prony") != apart, "option -", name,
          "_prony_tau needs the relative moduli of the series: -", name,
          "_prony for shear and bulk together, or -", name, "_prony_g and -", name, "_prony_k");
  Viscoelastic& m = input.material;
  if (!apart) m.g = m.k = input.both;
  for (std::vector<double>* relative : {&m.g, &m.k})
    if (apart && relative->empty()) relative->assign(m.tau.size(), 0);
}

void set_shift(const Options& options, const std::string& name, TemperatureShift& shift) {
  const bool wlf = options.given(name + "_wlf"), arrhenius = options.given(name + "_activation_energy");
  require(!wlf || !arrhenius, "options -", name, "_wlf and -", name,
          "_activation_energy: only one of them can be the temperature shift");
  for (const char* key : {"_temperature", "_temperature_reference", "_temperature_range"})
    require(wlf || arrhenius || !options.given(name + key), "option -", name, key,
            " needs a temperature shift, -", name, "_wlf or -", name, "_activation_energy");
  if (!wlf && !arrhenius) return;
  require(options.given(name + "_temperature_reference"), "option -", name,
          "_temperature_reference is missing: the temperature of -", name, "_prony_tau");
  shift.law = wlf ? TemperatureShift::Law::wlf : TemperatureShift::Law::arrhenius;
  if (!options.given(name + "_temperature")) shift.T = shift.T_ref;
}

bool is_viscoelastic(const Options& options, const std::string& name) {
  if (options.given(name + "_prony_tau") || options.given(name + "_master_curve")) return true;
  for (const Row<ViscoelasticInput>& row : kViscoelastic)
    require(!options.given(with_word(row.spec.name, name)), "option -", with_word(row.spec.name, name),
            " needs -", name, "_prony_tau, the relaxation times of a viscoelastic material");
  return false;
}

Material relaxing(const Options& options, const std::string& name, Material material) {
  ViscoelasticInput input;
  read_rows(options, kViscoelastic, input, name);
  set_moduli(options, name, input);
  set_shift(options, name, input.material.shift);
  model::validate(input.material,
                  options.label(name + (input.curve.empty() ? "_prony_tau" : "_master_curve")));
  material.viscoelastic = input.material;
  return input.moduli == Moduli::long_term ? model::from_long_term(material) : material;
}

// name: "material" or "material_<set>".
Material material(const Options& given_options, const std::string& name) {
  const Options options = with_modulus(given_options, name);
  Material material;
  if (!given(options, name + "_", {"E1", "E2", "E3"})) {
    read_rows(options, kIsotropic, material, name);
  } else {
    material.rho = options.positive(name + "_rho");
    read_rows(options, kOrthotropic, material.orthotropic.emplace(), name);
  }
  return is_viscoelastic(options, name) ? relaxing(options, name, material) : material;
}

// All numbers of a material; visit(x) sees them in the same order for writing and reading.
template <class Visit>
void visit_numbers(model::Material& material, const Visit& visit) {
  for (double* x : {&material.E, &material.nu, &material.rho}) visit(*x);
  if (material.viscoelastic) {
    TemperatureShift& s = material.viscoelastic->shift;
    for (double* x : {&s.C_1, &s.C_2, &s.E_a, &s.T_ref, &s.T, &s.T_least, &s.T_most}) visit(*x);
    for (std::vector<double>* v :
         {&material.viscoelastic->g, &material.viscoelastic->k, &material.viscoelastic->tau})
      for (double& x : *v) visit(x);
  }
  if (!material.orthotropic) return;
  model::Orthotropic& m = *material.orthotropic;
  model::Orientation& o = m.orientation;
  for (Eigen::Vector3d* v : {&m.E, &m.nu, &m.G, &o.axis_1, &o.axis_2, &o.origin, &o.axis, &o.rotation})
    for (double& x : *v) visit(x);
}

// MPI's own errors end the program.
void broadcast(MPI_Comm comm, int& value) { MPI_Bcast(&value, 1, MPI_INT, 0, comm); }

// Number of terms, and the law.
void broadcast_sizes(MPI_Comm comm, std::optional<Viscoelastic>& viscoelastic) {
  int n = viscoelastic ? static_cast<int>(viscoelastic->tau.size()) : 0;
  broadcast(comm, n);
  if (n == 0) return;
  if (!viscoelastic) viscoelastic.emplace();
  for (std::vector<double>* v : {&viscoelastic->g, &viscoelastic->k, &viscoelastic->tau})
    v->resize(static_cast<std::size_t>(n));
  int law = static_cast<int>(viscoelastic->shift.law);
  broadcast(comm, law);
  viscoelastic->shift.law = static_cast<TemperatureShift::Law>(law);
}

void broadcast(MPI_Comm comm, model::MaterialRegion& region) {
  auto& [name, material] = region;
  int length = static_cast<int>(name.size()), orthotropic = material.orthotropic.has_value();
  broadcast(comm, length);
  name.resize(static_cast<std::size_t>(length));
  MPI_Bcast(name.data(), length, MPI_CHAR, 0, comm);
  broadcast(comm, orthotropic);
  if (orthotropic && !material.orthotropic) material.orthotropic.emplace();
  broadcast_sizes(comm, material.viscoelastic);
  visit_numbers(material, [comm](double& x) { MPI_Bcast(&x, 1, MPI_DOUBLE, 0, comm); });
  if (!orthotropic) return;
  auto& system = material.orthotropic->orientation.system;
  int number = static_cast<int>(system);
  broadcast(comm, number);
  system = static_cast<model::Orientation::System>(number);
}

}  // namespace

OptionTable material_table() {
  OptionTable table;
  for (const auto& [name, of] : {std::pair{"material", ""}, {"material_<set>", " (one cell set)"}})
    for (OptionSpec spec : table_of(kIsotropic, kOrthotropic, kViscoelastic)) {
      spec.name = with_word(spec.name, name);
      spec.help += of;
      table.push_back(spec);
    }
  return table;
}

std::vector<model::MaterialRegion> material_options(const Options& options) {
  std::set<std::string> sets;
  for (const char* constant : {"E", "E1", "rho"})
    for (const std::string& set : options.placeholder_values("material_<set>_" + std::string(constant)))
      sets.insert(set);
  std::vector<model::MaterialRegion> regions;
  for (const std::string& set : sets) regions.push_back({set, material(options, "material_" + set)});
  if (given(options, "material_", {"E", "E1", "rho"})) regions.push_back({"", material(options, "material")});
  return regions;
}

void broadcast(MPI_Comm comm, std::vector<model::MaterialRegion>& regions) {
  int n = static_cast<int>(regions.size());
  broadcast(comm, n);
  regions.resize(static_cast<std::size_t>(n));
  for (model::MaterialRegion& region : regions) broadcast(comm, region);
}

}  // namespace elastogear::app
