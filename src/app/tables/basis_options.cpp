#include "app/tables/basis_options.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "app/options/rows.h"

namespace elastogear::app {
namespace {

using reduction::ReductionOptions, reduction::RitzOptions;

constexpr const char* kAutomatic = "auto";

// How fast contact forces change, by which the modes of a body are chosen.
struct LoadSpectrum {
  std::optional<double> rise_time, frequency;  // s, Hz
  double mode_error = 0.01;                    // -
};

// Values of the option, in its order; Ritz bases last, as in RitzKind.
enum Basis { modal, modal_residual, full, first_ritz };

const std::vector<std::string> kBases = {"modal",  "modal_residual", "full", "modal_attachment",
                                         "krylov", "craig_bampton"};

const Rows<ReductionOptions> kBasisRows = {
    {"basis", "-", "modal_residual",
     "modal_residual: eigenmodes and the static responses to contact forces and to loads at markers that "
     "they "
     "leave out; full: every "
     "free degree of freedom (the finite-element reference). To compare with: modal: eigenmodes alone, which "
     "miss most of the stress at a tooth; and of held bodies, without use of symmetry: modal_attachment: "
     "eigenmodes and static solutions; krylov: moment matching for loads on the surface; craig_bampton: "
     "interface modes and modes of the body held at the interface"},
    {"modes", "-", "100",
     "number of eigenmodes, 0 with modal_residual: static responses alone, which equilibria ask for; "
     "modal_attachment: without the static solutions; krylov, craig_bampton: "
     "vectors in all; auto (modal_residual): all that rise_time or highest_frequency ask for",
     [](auto& options, auto& name, auto& o) {
       if (options.text(name) != kAutomatic) o.n_modes = options.count(name);
     }},
    {"loaded", &ReductionOptions::loaded, "-",
     "face sets that contact forces may act on. modal_residual, modal_attachment: three static solutions "
     "for each node (modal_residual: or one of its images); craig_bampton: the interface; krylov: the "
     "loads (default: all of surface; modal_attachment has none)"},
    {"relaxed_states", "-", "auto",
     "modal_residual, bodies of several materials of which one relaxes: in how many states of relaxation "
     "static responses are found, beside the instantaneous one (1 to 8; auto: as many as 1 % of any response "
     "takes; each takes one more factorisation and as much memory)",
     [](auto& options, auto& name, auto& o) {
       if (options.text(name) != "auto") o.relaxed_states = options.count(name, 1);
     }},
};

const Rows<LoadSpectrum> kSpectrumRows = {
    {"rise_time", &LoadSpectrum::rise_time, "s",
     "modes: auto: shortest time in which a contact force rises, as by half a cosine", kPositive},
    {"highest_frequency", &LoadSpectrum::frequency, "Hz", "modes: auto: up to which contact forces vibrate",
     kPositive},
    {"mode_error", &LoadSpectrum::mode_error, "-",
     "modes: auto: by how much the inertia of a mode that is left out may change its part of the response",
     kPositive},
};

const Rows<RitzOptions> kRitzRows = {
    {"interface_modes", "-", "auto", "craig_bampton: how many of modes; auto: half of them",
     [](auto& options, auto& name, auto& o) {
       if (options.text(name) != "auto") o.interface_modes = options.count(name, 1);
     }},
    {"krylov_shift", &RitzOptions::shift, "Hz",
     "krylov: frequencies at which moments are matched, no eigenfrequencies; each takes an equal part of "
     "modes"},
};

// Hz, of the highest mode that counts: docs/theory, Eq. (6.20b).
double highest_mode(const LoadSpectrum& spectrum) {
  const double by_rise = spectrum.rise_time ? 0.5 / *spectrum.rise_time : 0;
  const double f = std::max(by_rise, spectrum.frequency.value_or(0));
  return f * std::sqrt(1 + 1 / spectrum.mode_error);
}

// All modes up to the frequency that the loads ask for.
void set_automatic_modes(const Options& options, ReductionOptions& o) {
  const bool automatic = options.text("modes") == kAutomatic;
  for (const char* name : {"rise_time", "highest_frequency", "mode_error"})
    require(automatic || !options.given(name), options.label(name), ": belongs to modes: auto");
  if (!automatic) return;
  require(o.flexibility, options.label("modes"),
          " = auto: needs basis: modal_residual, whose static responses stand in for the modes left out");
  require(options.given("rise_time") || options.given("highest_frequency"), options.label("modes"),
          " = auto: give the loads' rise_time (s) or highest_frequency (Hz)");
  LoadSpectrum spectrum;
  read_rows(options, kSpectrumRows, spectrum);
  const double omega = 2 * std::numbers::pi * highest_mode(spectrum);
  o.interval = reduction::Interval{.upper = omega * omega};
}

}  // namespace

OptionTable basis_table() { return table_of(kBasisRows, kSpectrumRows, kRitzRows); }

void set_basis(const Options& options, ReductionOptions& o) {
  read_rows(options, kBasisRows, o);
  const int basis = options.choice("basis", kBases);
  o.basis = basis == full ? model::Basis::full : model::Basis::modal;
  o.flexibility = o.attachments = basis == modal_residual;
  set_automatic_modes(options, o);
  if (basis < first_ritz) return;
  o.ritz.emplace().kind = static_cast<reduction::RitzKind>(basis - first_ritz);
  read_rows(options, kRitzRows, *o.ritz);
}

}  // namespace elastogear::app
