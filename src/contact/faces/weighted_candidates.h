#pragma once
// The slave nodes whose weighted gaps may lie within the reach, told from the gaps at the nodes
// (docs/theory, section 6.13).

#include <map>
#include <vector>

#include "contact/forces/gap_minima.h"

namespace elastogear::contact {

/// Slave nodes, ascending. nodes: those with a gap that is not too large to have one within the reach beside
/// it. given: forces by node; these nodes are among the candidates.
std::vector<int> weighted_candidates(const GapField& field, const std::map<int, NodeGap>& nodes,
                                     const std::map<int, double>& given);

}  // namespace elastogear::contact
