#pragma once
// *NGEN and *ELGEN of an Abaqus input file, which make rows of nodes and elements.

#include "mesh/inp/inp_deck.h"

namespace elastogear::mesh {

/// Nodes on straight lines between two that are defined above.
void generate_nodes(InpLines& in, const Keyword& key, InpDeck& deck);
/// Rows, layers and blocks of an element that is defined above.
void generate_elements(InpLines& in, const Keyword& key, InpDeck& deck);

}  // namespace elastogear::mesh
