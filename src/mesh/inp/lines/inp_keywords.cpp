#include "mesh/inp/lines/inp_keywords.h"

#include <algorithm>
#include <functional>
#include <map>

namespace elastogear::mesh {
namespace {

using enum KeywordKind;

constexpr KeywordRow kTable[] = {
    {"NODE", makes, "NSET, INPUT, SYSTEM"},
    {"ELEMENT", makes, "TYPE, ELSET, INPUT"},
    {"NGEN", makes, "NSET"},
    {"ELGEN", makes, "ELSET"},
    {"PART, ASSEMBLY", makes, "NAME"},
    {"INSTANCE", makes, "NAME, PART"},
    {"END PART, END ASSEMBLY, END INSTANCE", makes, ""},
    {"TRANSFORM", makes, "NSET, TYPE"},
    {"NSET", read, "NSET, GENERATE, INSTANCE, INTERNAL, UNSORTED, ELSET, INPUT"},
    {"ELSET", read, "ELSET, GENERATE, INSTANCE, INTERNAL, UNSORTED, INPUT"},
    {"SURFACE", read, "NAME, TYPE, INTERNAL, INSTANCE, INPUT"},
    {"MATERIAL", read, "NAME, RTOL"},
    {"ELASTIC", read, "TYPE, DEPENDENCIES, MODULI, INPUT"},
    {"DENSITY", read, "DEPENDENCIES, INPUT"},
    {"ORIENTATION", read, "NAME, SYSTEM, DEFINITION"},
    {"SOLID SECTION", read, "ELSET, MATERIAL, ORIENTATION, CONTROLS"},
    {"MASS", read, "ELSET"},
    {"BOUNDARY", read, "TYPE, OP, AMPLITUDE, FIXED, LOAD CASE, INPUT"},
    {"INCLUDE", read, "INPUT"},

    {"HEADING, PREPRINT, RESTART, AMPLITUDE, TIME POINTS, PHYSICAL CONSTANTS, NO ANALYSIS", harmless, ""},
    {"FILE FORMAT, NODE PRINT, NODE FILE, NODE OUTPUT, EL PRINT, EL FILE, ELEMENT OUTPUT, OUTPUT", harmless,
     ""},
    {"CONTACT PRINT, CONTACT FILE, CONTACT OUTPUT, ENERGY PRINT, ENERGY FILE, ENERGY OUTPUT", harmless, ""},
    {"FACE PRINT, SECTION PRINT, SECTION FILE, MODAL FILE, MODAL OUTPUT, MODAL PRINT", harmless, ""},
    {"INTEGRATED OUTPUT, INTEGRATED OUTPUT SECTION, INCREMENTATION OUTPUT", harmless, ""},
    {"SURFACE OUTPUT, RADIATION OUTPUT, RADIATION FILE, MONITOR, PRINT, FILTER, DIAGNOSTICS", harmless, ""},
    {"STEP, END STEP, STATIC, FREQUENCY, COMPLEX FREQUENCY, BUCKLE, DYNAMIC, VISCO, GREEN", harmless, ""},
    {"MODAL DYNAMIC, STEADY STATE DYNAMICS, RANDOM RESPONSE, RESPONSE SPECTRUM, CREEP STEP", harmless, ""},
    {"HEAT TRANSFER, COUPLED TEMPERATURE-DISPLACEMENT, UNCOUPLED TEMPERATURE-DISPLACEMENT", harmless, ""},
    {"ANNEAL, GEOSTATIC, SENSITIVITY, OBJECTIVE, CONSTRAINT, DESIGN VARIABLES, FILTERING", harmless, ""},
    {"CONTROLS, SOLUTION TECHNIQUE, SECTION CONTROLS, BULK VISCOSITY, FIXED MASS SCALING", harmless, ""},
    {"SELECT EIGENMODES, SELECT CYCLIC SYMMETRY MODES, MODAL DAMPING, BASE MOTION, CORRELATION", harmless,
     ""},
    {"CLOAD, DLOAD, DSLOAD, CFLUX, DFLUX, DSFLUX, FILM, SFILM, CFILM, RADIATE, SRADIATE", harmless, ""},
    {"LOAD CASE, END LOAD CASE, TEMPERATURE, INERTIA RELIEF, MASS FLOW RATE", harmless, ""},
    {"CONDUCTIVITY, SPECIFIC HEAT, EXPANSION, LATENT HEAT, INELASTIC HEAT FRACTION, DEPVAR", harmless, ""},
    {"DISTRIBUTION TABLE, NORMAL, NODAL THICKNESS, HOURGLASS STIFFNESS, TRANSVERSE SHEAR STIFFNESS", harmless,
     ""},
    {"POST OUTPUT, VIEWFACTOR, ELEMENT RESPONSE", harmless, ""},

    {"SPRING, DASHPOT, GAP, JOINT, BUSHING, CONNECTOR SECTION, CONNECTOR BEHAVIOR, CONNECTOR ELASTICITY",
     lost, "springs, dampers and connectors are left out"},
    {"ROTARY INERTIA, NONSTRUCTURAL MASS", lost,
     "this mass is left out: name it by point_mass_<set> of reduce"},
    {"RIGID BODY, COUPLING, KINEMATIC, DISTRIBUTING, KINEMATIC COUPLING, DISTRIBUTING COUPLING", lost,
     "what it makes rigid or couples stays as it is: a marker or restrain of reduce takes its place"},
    {"EQUATION, MPC, MULTI-POINT CONSTRAINT, CYCLIC SYMMETRY MODEL, PRE-TENSION SECTION", lost,
     "these equations between displacements are left out"},
    {"TIE, EMBEDDED ELEMENT, EMBEDDED REGION, SHELL TO SOLID COUPLING", lost,
     "what it joins is open: merge the nodes there"},
    {"CONTACT, CONTACT PAIR, CONTACT INCLUSIONS, CONTACT EXCLUSIONS, CONTACT PROPERTY ASSIGNMENT, "
     "CONTACT CONTROLS, CONTACT CONTROLS ASSIGNMENT, CONTACT INITIALIZATION ASSIGNMENT, CONTACT DAMPING, "
     "SURFACE PROPERTY ASSIGNMENT, CLEARANCE, CONTACT INTERFERENCE",
     lost, "contact within the body is left out"},
    {"SURFACE INTERACTION, SURFACE BEHAVIOR, FRICTION, GAP CONDUCTANCE, GAP HEAT GENERATION", harmless, ""},
    {"PLASTIC, CYCLIC HARDENING, CREEP, POTENTIAL, DEFORMATION PLASTICITY, RATE DEPENDENT, "
     "DRUCKER PRAGER, DRUCKER PRAGER HARDENING, MOHR COULOMB, MOHR COULOMB HARDENING, CAP PLASTICITY, "
     "CONCRETE DAMAGED PLASTICITY, CONCRETE COMPRESSION HARDENING, CONCRETE TENSION STIFFENING, "
     "CRUSHABLE FOAM, CRUSHABLE FOAM HARDENING, DAMAGE INITIATION, DAMAGE EVOLUTION, NO COMPRESSION, "
     "NO TENSION, FAIL STRAIN, FAIL STRESS",
     lost, "the material stays elastic"},
    {"HYPERELASTIC, HYPERFOAM, MOONEY-RIVLIN, USER MATERIAL, HYPOELASTIC, POROUS ELASTIC", lost,
     "this elasticity is not read: name the material by options material_E and material_nu of reduce"},
    {"VISCOELASTIC, TRS, DAMPING, GLOBAL DAMPING", lost,
     "relaxation and damping of the file are not read: name them by options of reduce"},
    {"INITIAL CONDITIONS, PRESTRESS HOLD, RESIDUAL STRESS, CHANGE FRICTION", lost,
     "the body begins without stress and at rest"},
    {"MODEL CHANGE, CHANGE SOLID SECTION, CHANGE MATERIAL, IMPERFECTION, MAP SOLUTION", lost,
     "the body stays as the elements make it"},
    {"SUBMODEL, GLOBAL ELEMENTS", lost, "what the global model would hold is free"},
    {"SHELL SECTION, SHELL GENERAL SECTION, MEMBRANE SECTION, BEAM SECTION, BEAM GENERAL SECTION, "
     "FRAME SECTION, SURFACE SECTION, GASKET SECTION, COHESIVE SECTION, FLUID SECTION, REBAR LAYER, REBAR, "
     "ACOUSTIC SECTION",
     lost, "a body is made of solids alone: these elements have neither stiffness nor mass here"},
    {"MATRIX INPUT, MATRIX ASSEMBLE, USER ELEMENT, UEL PROPERTY, SUBSTRUCTURE PROPERTY, "
     "SUBSTRUCTURE MATRIX OUTPUT, SUBSTRUCTURE GENERATE, RETAINED NODAL DOFS",
     lost, "matrices are read by options stiffness and mass of reduce"},

    {"NCOPY, NFILL, NMAP, ELCOPY, SYMMETRIC MODEL GENERATION, REFINE MESH, IMPORT, IMPORT NSET, IMPORT ELSET",
     refused, "it makes nodes or elements: write them out as *NODE and *ELEMENT"},
    {"SYSTEM", refused, "only global coordinates are read: write the nodes in them"},
    {"PARAMETER", refused, "it computes values: write them out"},
    {"USER ELEMENT FILE, ADAPTIVE MESH", refused, "it changes the elements: write them out"},
};

// Calls f with each word between commas until it returns true; tells whether one did.
bool any_word(std::string_view list, const std::function<bool(std::string_view)>& f) {
  while (!list.empty()) {
    const std::size_t comma = std::min(list.find(','), list.size());
    std::string_view word = list.substr(0, comma);
    word.remove_prefix(std::min(word.find_first_not_of(' '), word.size()));
    if (f(word)) return true;
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
  return false;
}

std::string without_blanks(std::string_view name) {
  std::string text(name);
  std::erase_if(text, [](char c) { return c == ' ' || c == '\t'; });
  return text;
}

std::map<std::string, KnownKeyword> all_keywords() {
  std::map<std::string, KnownKeyword> keywords;
  for (const KeywordRow& row : kTable)
    any_word(row.names, [&](std::string_view name) {
      keywords.try_emplace(without_blanks(name), KnownKeyword{std::string(name), &row});
      return false;
    });
  return keywords;
}

}  // namespace

const KnownKeyword* find_keyword(std::string_view name) {
  static const std::map<std::string, KnownKeyword> keywords = all_keywords();
  const auto found = keywords.find(without_blanks(name));
  return found == keywords.end() ? nullptr : &found->second;
}

bool knows(const KeywordRow& row, std::string_view parameter) {
  return any_word(row.text, [&](std::string_view known) { return known == parameter; });
}

std::string whole_parameter(const KeywordRow& row, const std::string& parameter) {
  constexpr std::size_t kLeast = 3;
  std::string whole;
  int n = 0;
  any_word(row.text, [&](std::string_view known) {
    if (known.starts_with(parameter)) {
      whole = known;
      ++n;
    }
    return false;
  });
  return n == 1 && parameter.size() >= kLeast && !knows(row, parameter) ? whole : parameter;
}

}  // namespace elastogear::mesh
