#pragma once
// The flanks that carry load in a run, for which its finer bodies are reduced.

#include <string>

#include "app/run/run_on_mesh.h"

namespace elastogear::app {

/// Gives each gear whose teeth carry load on one side alone, over all of this result, the face set of that
/// side as its `loaded`, unless the input names one. Static responses to loads on the other side take the
/// same time and memory again, and nothing asks for them. result: of the same drive on a coarser mesh, a file
/// or the folder of its cases. Collective.
RunOnMesh with_loaded_sides(RunOnMesh of, const Drive& drive, const std::string& result);

}  // namespace elastogear::app
