#pragma once
// A drive on one mesh: bodies, run and evaluation, each as far as it is not there already.

#include <string>
#include <vector>

#include "app/gear/drive_options.h"

namespace elastogear::app {

/// The options of the verbs that a run consists of. All but the last mesh have their files in a folder.
struct RunOnMesh {
  Options reduce, simulate, evaluate;
  std::string folder = {};  ///< empty: the files are where the verbs leave them
};

/// Those that the options of `run` give the verbs.
RunOnMesh run_options(const Options& given);
/// The same on meshes of another refinement.
RunOnMesh on_mesh(RunOnMesh of, const Drive& drive, double refinement, const std::string& folder);

/// Are the bodies there, of this input?
bool has_bodies(const RunOnMesh& of, const Drive& drive);
/// Are result and evaluation there, of this input, whatever became of the bodies?
bool has_evaluation(const RunOnMesh& of);
/// The evaluation file and the result that it has or will have.
std::string evaluation_file(const RunOnMesh& of);
std::string result_file(const RunOnMesh& of);

/// Throws Error where something stands in the way of a file that a run writes, a folder of its name. Rank 0.
void require_places(const RunOnMesh& of, const Drive& drive);

/// Makes what is not there and evaluates the result; says why it makes something. coarser: evaluation files
/// of coarser meshes, the coarsest first. Collective.
void make(const RunOnMesh& of, const Drive& drive, const std::vector<std::string>& coarser);
/// Moves bodies, result and evaluation to where `to` has them. Rank 0.
void move_files(const RunOnMesh& from, const RunOnMesh& to, const Drive& drive);

}  // namespace elastogear::app
