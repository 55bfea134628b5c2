#include "app/compare/compare_options.h"

#include "app/options/rows.h"

namespace elastogear::app {
namespace {

using S = CompareSettings;

const Rows<S> kRows = {
    {"match", &S::by_position, one_of("number", "position"),
     "which nodes of two stress files belong together: of the same number or position"},
    {"match_tolerance", "m", "1e-6", "match position: how far apart two such nodes may lie",
     [](auto& o, auto& name, auto& s) { s.match_tolerance = o.positive(name); }},
    {"at", "s", "peak",
     "time at which values are compared: a number, last, or peak: where the reference's largest von Mises "
     "stress, or its largest contact force, is, between from and to when they are given",
     [](auto& o, auto& name, auto& s) {
       if (o.text(name) != "peak") s.at = file_time(o, name);
     }},
    {"reference_at", "s", "",
     "the same in the reference, when its times mean something else (static analysis): a number or last; no "
     "signals then",
     [](auto& o, auto& name, auto& s) {
       if (o.given(name)) s.reference_at = file_time(o, name);
     }},
    {"node_<body>", &S::node, "-",
     "nodes (numbers in the reference) in tables and signals besides those of the peak"},
    {"from", &S::from, "s",
     "begin of the signals over time; without it, result files: the reference's first contact"},
    {"to", &S::to, "s",
     "end of the signals over time; without it, result files: the reference's last contact"},
    {"output", &S::output, "-", "first part of the names of CSV tables; without it tables are only printed"},
};

}  // namespace

OptionTable compare_table() { return table_of(kRows); }

CompareSettings compare_settings(const Options& options) {
  CompareSettings settings;
  read_rows(options, kRows, settings);
  return settings;
}

}  // namespace elastogear::app
