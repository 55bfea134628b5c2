#pragma once
// Local minimum-gap points that open and close by turns while contact forces are solved for: where lines of
// contact run over faces that deform under the forces, a minimum that bears one may vanish by it. Such points
// stay where they were, as further points that must not enter the master (docs/theory, section 6.12). In a
// step of the impact law all points stand (section 6.15).

#include <map>
#include <vector>

#include "contact/forces/history.h"
#include "contact/forces/least_gap.h"

namespace elastogear::contact {

/// A point that bore a force.
struct KeptMinimum {
  Minimum last = {};
  bool stays = false;  ///< where it was: it has vanished, or jumped to another face of the master
};

/// Of one slave surface, by number; those that stay have numbers of their own.
using KeptMinima = std::map<int, KeptMinimum>;

/// Keeps those of `minima` that carry a force, p > 0, in `contacts` of the same slave side.
void keep_loaded(const std::vector<ContactPoint>& contacts, int slave_side,
                 const std::vector<Minimum>& minima, KeptMinima& kept);

/// Adds the points that stay to the minima found, in place of minima of the same side or face of the slave
/// over the same face of the master. Points that bore a force and are not found begin to stay.
void add_kept(const GapField& field, KeptMinima& kept, std::vector<Minimum>& found);

/// Where minima stand during the next step of an impact law (docs/theory, Eq. (6.33a)), by number.
/// before: in the last step.
std::map<int, StandingPoint> standing_points(const std::vector<Minimum>& minima,
                                             const std::map<int, StandingPoint>& before);

/// Half a step ahead of these points, over the master where both bodies are now; without those that the
/// master is not near.
std::vector<Minimum> standing_minima(const GapField& field, const std::map<int, StandingPoint>& points);

}  // namespace elastogear::contact
