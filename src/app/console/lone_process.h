#pragma once
// How MPI starts in a process that no launcher has started.

#include <string_view>

namespace elastogear::app {

/// Returns whether a variable of the environment, "NAME=value", is one by which a launcher (mpirun, srun)
/// tells a process its place.
bool is_of_launcher(std::string_view variable);

/// Initialises MPI in a process that is alone, and returns whether this is one; does nothing under mpirun,
/// srun or another launcher. Open MPI looks for fast networks, which takes 0.3 s, starts a daemon, and makes
/// a folder in /tmp, all of no use here. Variables OMPI_MCA_* of the user's win. Who initialises MPI would
/// finalise it, and there threads of Open MPI 4.1 crash one time in a thousand: this process ends without.
bool start_alone();

}  // namespace elastogear::app
