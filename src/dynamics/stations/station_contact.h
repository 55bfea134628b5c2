#pragma once
// Contact of exact flanks at stations, of all pairs of a system at one state: gaps, compliance, forces and
// their tangent (docs/theory.md, section 6.18). A function of the state alone.

#include <string>
#include <vector>

#include "dynamics/contact/residual_contact.h"
#include "elastogear/contact/tooth_contact.h"
#include "elastogear/dynamics/system_model.h"

namespace elastogear::dynamics {

/// Why the flanks of a pair do not touch at stations; empty if they can.
std::string lacks_for_stations(const SystemModel& model, const PairSetup& pair);

class StationContact {
 public:
  /// Of pairs that all have contact::SlavePoints::stations. The bodies of the model must outlive this.
  explicit StationContact(const SystemModel& model);

  /// Sets the pairs, loads of stations and nodal forces of the state, whose placements are set, and puts the
  /// static responses to these forces in place.
  void evaluate(const std::vector<contact::SurfaceMotion>& motion, ResidualContact& responses,
                ContactState& state) const;

 private:
  struct Pair {
    int body[2];
    double offset;  // m
  };
  const SystemModel* model_;
  std::vector<Pair> pairs_;
  std::vector<std::unique_ptr<contact::ToothedBody>> toothed_;  // of each body; null: it touches nothing
};

}  // namespace elastogear::dynamics
