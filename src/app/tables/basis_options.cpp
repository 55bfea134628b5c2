#include "app/tables/basis_options.h"

#include "app/options/rows.h"

namespace elastogear::app {
namespace {

using reduction::ReductionOptions, reduction::RitzOptions;

// Values of the option, in its order; Ritz bases last, as in RitzKind.
enum Basis { modal, modal_residual, full, first_ritz };

const std::vector<std::string> kBases = {"modal",  "modal_residual", "full", "modal_attachment",
                                         "krylov", "craig_bampton"};

const Rows<ReductionOptions> kBasisRows = {
    {"basis", "-", "modal_residual",
     "modal_residual: eigenmodes and the static response to contact forces that they leave out; full: every "
     "free degree of freedom (the finite-element reference). To compare with: modal: eigenmodes alone, which "
     "miss most of the stress at a tooth; and of held bodies, without use of symmetry: modal_attachment: "
     "eigenmodes and static solutions; krylov: moment matching for loads on the surface; craig_bampton: "
     "interface modes and modes of the body held at the interface"},
    {"modes", &ReductionOptions::n_modes, "-",
     "number of eigenmodes; modal_attachment: without the static solutions; krylov, craig_bampton: "
     "vectors in all",
     kPositive},
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

const Rows<RitzOptions> kRitzRows = {
    {"interface_modes", "-", "auto", "craig_bampton: how many of modes; auto: half of them",
     [](auto& options, auto& name, auto& o) {
       if (options.text(name) != "auto") o.interface_modes = options.count(name, 1);
     }},
    {"krylov_shift", &RitzOptions::shift, "Hz",
     "krylov: frequencies at which moments are matched, no eigenfrequencies; each takes an equal part of "
     "modes"},
};

}  // namespace

OptionTable basis_table() { return table_of(kBasisRows, kRitzRows); }

void set_basis(const Options& options, ReductionOptions& o) {
  read_rows(options, kBasisRows, o);
  const int basis = options.choice("basis", kBases);
  o.basis = basis == full ? model::Basis::full : model::Basis::modal;
  o.flexibility = basis == modal_residual;
  if (basis < first_ritz) return;
  o.ritz.emplace().kind = static_cast<reduction::RitzKind>(basis - first_ritz);
  read_rows(options, kRitzRows, *o.ritz);
}

}  // namespace elastogear::app
