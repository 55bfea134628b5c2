#include "app/tables/basis_options.h"

namespace elastogear::app {
namespace {

// Values of the option, in its order; Ritz bases last, as in RitzKind.
enum Basis { modal, modal_residual, full, first_ritz };

const std::vector<std::string> kBases = {"modal",  "modal_residual", "full", "modal_attachment",
                                         "krylov", "craig_bampton"};

reduction::RitzOptions ritz_options(const Options& options, int basis) {
  reduction::RitzOptions ritz;
  ritz.kind = static_cast<reduction::RitzKind>(basis - first_ritz);
  if (options.text("interface_modes") != "auto") ritz.interface_modes = options.count("interface_modes", 1);
  ritz.shift = options.numbers("krylov_shift");
  return ritz;
}

}  // namespace

OptionTable basis_table() {
  return {
      {"basis", "-", "modal_residual",
       "modal_residual: eigenmodes and the static response to contact forces that they leave out; full: "
       "every "
       "free degree of freedom (the finite-element reference). To compare with: modal: eigenmodes alone, "
       "which "
       "miss most of the stress at a tooth; and of held bodies, without use of symmetry: modal_attachment: "
       "eigenmodes and static solutions; krylov: moment matching for loads on the surface; craig_bampton: "
       "interface modes and modes of the body held at the interface"},
      {"modes", "-", "100",
       "number of eigenmodes; modal_attachment: without the static solutions; krylov, craig_bampton: "
       "vectors in all"},
      {"loaded", "-", "",
       "face sets that contact forces may act on. modal_residual, modal_attachment: three static solutions "
       "for each node (modal_residual: or one of its images); craig_bampton: the interface; krylov: the "
       "loads (default: all of surface; modal_attachment has none)"},
      {"interface_modes", "-", "auto", "craig_bampton: how many of modes; auto: half of them"},
      {"krylov_shift", "Hz", "0",
       "krylov: frequencies at which moments are matched, no eigenfrequencies; each takes an equal part of "
       "modes"},
  };
}

void set_basis(const Options& options, reduction::ReductionOptions& o) {
  const int basis = options.choice("basis", kBases);
  o.basis = basis == full ? model::Basis::full : model::Basis::modal;
  o.flexibility = basis == modal_residual;
  if (basis >= first_ritz) o.ritz = ritz_options(options, basis);
  o.loaded = options.list("loaded");
  o.n_modes = options.count("modes", 1);
}

}  // namespace elastogear::app
