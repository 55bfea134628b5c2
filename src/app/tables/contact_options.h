#pragma once
// Options of contact pairs in simulate.

#include "app/options/options.h"
#include "elastogear/dynamics/system.h"

namespace elastogear::app {

/// Part of simulate's option table.
OptionTable contact_table();

/// One setup per pair that -contact_pairs names. Throws Error for unknown bodies.
std::vector<dynamics::PairSetup> pair_setups(const Options& options, const std::vector<std::string>& bodies);

/// Warns of options that shape the slave surface of a pair of which only the nodes are in contact, so that it
/// stays what it is. pair: of a System, which has chosen the points.
void warn_of_facets(const Options& options, const dynamics::PairSetup& pair,
                    const std::vector<std::string>& bodies);

/// Returns whether pairs in contact have friction by tangential springs.
bool friction_sticks(const Options& options);

}  // namespace elastogear::app
