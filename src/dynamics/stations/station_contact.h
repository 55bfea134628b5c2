#pragma once
// Contact of exact flanks at stations, of all pairs of a system at one state: gaps, compliance, forces and
// their tangent (docs/theory.md, section 6.18). A function of the state alone.

#include <memory>
#include <vector>

#include "dynamics/contact/residual_contact.h"
#include "dynamics/stations/response_tables.h"
#include "elastogear/contact/station_forces.h"
#include "elastogear/dynamics/system_model.h"

namespace elastogear::dynamics {

class StationContact {
 public:
  /// Of pairs that all have contact::SlavePoints::stations. The bodies of the model must outlive this.
  explicit StationContact(const SystemModel& model);

  /// Sets the pairs, loads of stations and nodal forces of the state, whose placements are set, and puts the
  /// static responses to these forces in place.
  void evaluate(const std::vector<contact::SurfaceMotion>& motion, ResidualContact& responses,
                ContactState& state);

 private:
  // Two teeth in contact, and where their stations begin among all.
  struct Teeth {
    std::size_t pair;
    contact::ToothContact contact;
    Eigen::Index first;
  };
  // The loads of all n stations on one body.
  struct Loads {
    std::vector<int> node;          // of the surface, ascending
    Eigen::SparseMatrix<double> S;  // 3 nodes x n, BRF: nodal forces of 1 N of each station
    Eigen::MatrixXd Phi_S;          // n_q x n: the same on elastic coordinates
  };
  struct Body {
    std::unique_ptr<contact::ToothedBody> toothed;  // null: it touches nothing
    std::unique_ptr<ResponseTables> tables;
  };
  struct Pair {
    std::array<std::size_t, 2> body;
    double offset;  // m
    contact::ToothedPair toothed;
  };

  void add_body(const SystemModel::Body& body);
  std::vector<Teeth> teeth_in_contact(const std::vector<contact::SurfaceMotion>& motion) const;
  Loads loads_on(std::size_t body, const std::vector<Teeth>& teeth, Eigen::Index n) const;
  void add_compliance(std::size_t body, const std::vector<Teeth>& teeth, const Loads& loads,
                      Eigen::MatrixXd& C);
  void add_joint_forces(const std::vector<contact::SurfaceMotion>& motion, const std::vector<Teeth>& teeth,
                        const std::vector<Loads>& loads, const Eigen::VectorXd& f, ContactState& state);
  void set_nodal_forces(std::size_t body, const Loads& loads, const contact::StationForces& forces,
                        const contact::SurfaceMotion& motion, ResidualContact& responses,
                        ContactState& state) const;

  const SystemModel* model_;
  std::vector<Body> bodies_;
  std::vector<Pair> pairs_;
};

}  // namespace elastogear::dynamics
