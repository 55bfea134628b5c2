// The names of PETSc's options as they stand in its libraries, against what its objects print as their help.
#include "app/options/petsc_names.h"

#include <gtest/gtest.h>
#include <petscts.h>
#include <slepceps.h>

#include <algorithm>
#include <cstdarg>
#include <set>
#include <sstream>

namespace elastogear::app::petsc_names_test {
namespace {

std::string help;

PetscErrorCode keep_help(FILE*, const char format[], va_list arguments) {
  std::vector<char> text(1 << 16);
  PetscVSNPrintf(text.data(), text.size(), format, nullptr, arguments);
  help += text.data();
  return 0;
}

// While it lives, objects that take their options print their help, which is kept.
struct HelpAsked {
  HelpAsked() {
    char program[] = "test", word[] = "-help";
    char* words[] = {program, word, nullptr};
    char** argv = words;
    int argc = 2;
    PetscVFPrintf = keep_help;
    PetscOptionsInsert(nullptr, &argc, &argv, nullptr);
  }
  ~HelpAsked() {
    PetscVFPrintf = print;
    char program[] = "test", word[] = "-help", no[] = "false";
    char* words[] = {program, word, no, nullptr};
    char** argv = words;
    int argc = 3;
    PetscOptionsInsert(nullptr, &argc, &argv, nullptr);
  }

  decltype(PetscVFPrintf) print = PetscVFPrintf;
};

// "  -ts_dt <0.1>: ..." at the beginning of lines.
std::set<std::string> names_in(const std::string& text) {
  std::set<std::string> names;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const auto dash = line.find_first_not_of(' ');
    if (dash == line.npos || line[dash] != '-' || dash > 4) continue;
    const auto end = std::find_if(line.begin() + static_cast<long>(dash) + 1, line.end(),
                                  [](unsigned char c) { return !std::isalnum(c) && c != '_'; });
    const std::string name(line.begin() + static_cast<long>(dash) + 1, end);
    if (!name.empty() && std::isalpha(static_cast<unsigned char>(name[0]))) names.insert(name);
  }
  return names;
}

template <class SetType>
void each_type(PetscFunctionList list, const SetType& set_type) {
  const char** types = nullptr;
  int n = 0;
  PetscFunctionListGet(list, &types, &n);
  for (int i = 0; i < n; ++i)
    if (types[i]) set_type(types[i]);
  PetscFree(types);
}

// Help of every solver under the prefix; what some types cannot do without a matrix is not of interest.
void ask_solvers(const char* prefix) {
  KSP ksp = nullptr;
  KSPCreate(PETSC_COMM_SELF, &ksp);
  each_type(KSPList, [&](const char* type) {
    KSPSetOptionsPrefix(ksp, prefix);
    if (KSPSetType(ksp, type) == 0) KSPSetFromOptions(ksp);
  });
  KSPDestroy(&ksp);
  each_type(PCList, [&](const char* type) {
    PC pc = nullptr;
    PCCreate(PETSC_COMM_SELF, &pc);
    PCSetOptionsPrefix(pc, prefix);
    if (PCSetType(pc, type) == 0) PCSetFromOptions(pc);
    PCDestroy(&pc);
  });
}

TEST(PetscNames, AllThatObjectsPrintAsTheirHelpAreKnown) {
  TS ts = nullptr;
  EPS eps = nullptr;
  {
    const HelpAsked asked;
    TSCreate(PETSC_COMM_SELF, &ts);
    each_type(TSList, [&](const char* type) {
      if (TSSetType(ts, type) == 0) TSSetFromOptions(ts);
    });
    EPSCreate(PETSC_COMM_SELF, &eps);
    each_type(EPSList, [&](const char* type) {
      if (EPSSetType(eps, type) == 0) EPSSetFromOptions(eps);
    });
    ask_solvers("");
    ask_solvers("elastic_");
  }
  TSDestroy(&ts);
  EPSDestroy(&eps);
  const std::set<std::string> names = names_in(help);
  EXPECT_GT(names.size(), 500u);
  for (const char* name : {"ts_dt", "snes_rtol", "eps_ncv", "st_type", "elastic_ksp_rtol", "elastic_pc_type"})
    EXPECT_TRUE(names.contains(name)) << name;
  for (const std::string& name : names) EXPECT_TRUE(is_petsc_name(name)) << name;
}

TEST(PetscNames, OptionsOfNestedSolversAndOfPetscItselfAreKnown) {
  for (const char* name : {"st_mat_mumps_icntl_14",
                           "elastic_mg_levels_1_ksp_type",
                           "elastic_mg_levels_ksp_type",
                           "elastic_mg_coarse_sub_pc_type",
                           "elastic_mg_levels_3_esteig_ksp_max_it",
                           "elastic_fieldsplit_0_pc_type",
                           "elastic_pc_factor_levels",
                           "pc_fieldsplit_0_fields",
                           "st_ksp_rtol",
                           "TS_DT",
                           "log_view",
                           "malloc_debug",
                           "options_left",
                           "options_view",
                           "on_error_abort",
                           "info",
                           "memory_view",
                           "fp_trap",
                           "citations",
                           "ts_view",
                           "snes_view",
                           "no_signal_handler",
                           "eps_view_values",
                           "start_in_debugger",
                           "mat_view",
                           "draw_pause"})
    EXPECT_TRUE(is_petsc_name(name)) << name;
}

TEST(PetscNames, MisspeltOnesAreNot) {
  for (const char* name : {"ts_dtt",       "ts_dt=1e-7",      "infoo",
                           "debugg",       "is_foo",          "ts_adapt_typ",
                           "snes_rtoll",   "elastc_ksp_rtol", "elastic_pc_typ",
                           "log_veiw",     "eps_nvc",         "st_",
                           "ts_",          "elastic_",        "mg_levels_x_ksp_type",
                           "modes",        "worm_file",       "contact_pairs",
                           "basis_info",   "damping_info",    "is_ts_dt",
                           "elastic_info", "st_options_left", "mg_levels_1_ts_dt"})
    EXPECT_FALSE(is_petsc_name(name)) << name;
}

}  // namespace
}  // namespace elastogear::app::petsc_names_test
