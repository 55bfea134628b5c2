#pragma once
// Contact of exact flanks at stations, of all pairs of a system at one state: gaps, compliance, forces and
// their tangent (docs/theory, section 6.18). A function of the state alone.

#include <array>
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
  using Motions = std::vector<contact::SurfaceMotion>;
  /// Two teeth in contact, and where their stations begin among all.
  struct Teeth {
    std::size_t pair;
    contact::ToothContact contact;
    Eigen::Index first;
    Eigen::Matrix3Xd sliding = {};  ///< 3 x n, m/s, of the owner on the mate, owner's frame
    /// 3 x n of each side, in its frame: friction over the normal force of each strip. Empty: none.
    std::array<Eigen::Matrix3Xd, 2> traction = {};
    Eigen::VectorXd resistance = {};  ///< n, s/m: by how much it changes with the sliding speed
  };
  /// The loads of all n stations on one body.
  struct Loads {
    std::vector<int> node;            ///< of the surface, ascending
    Eigen::SparseMatrix<double> S;    ///< 3 nodes x n, BRF: normal nodal forces of 1 N of each station
    Eigen::SparseMatrix<double> S_t;  ///< the friction that comes with them
    Eigen::MatrixXd Phi_S, Phi_S_t;   ///< n_q x n: the same on elastic coordinates
  };
  struct Body {
    std::unique_ptr<contact::ToothedBody> toothed;  ///< null: it touches nothing
    std::unique_ptr<ResponseTables> tables;         ///< null: it touches nothing or is rigid
    bool by_nodes = false;  ///< it touches at stations that move: static responses are those of nodes
    std::vector<contact::FlankName> stiff = {};  ///< flanks to loads on which it has no static responses
  };
  struct Pair {
    std::array<std::size_t, 2> body;  ///< owner and mate
    int owner;                        ///< which body of the pair's setup that is
    double offset;                    ///< m
    contact::FrictionSettings friction;
    contact::ToothedPair toothed;
  };
  /// One body's part in two teeth in contact.
  struct Part {
    const Teeth* teeth;
    std::size_t s;
    const contact::ToothContact::Side& side() const { return teeth->contact.side[s]; }
  };
  struct Solution {
    contact::StationForces forces;
    Eigen::MatrixXd stiffness;  ///< N/m, among active stations, with what friction does to gaps
    double local_energy = 0;    ///< J
  };

  void add_body(const SystemModel::Body& body);
  bool has_responses(const Pair& pair, const contact::ToothContact& contact) const;
  std::vector<Teeth> teeth_in_contact(const Motions& motion) const;
  void set_traction(const Motions& motion, Teeth& teeth) const;
  Eigen::Matrix3Xd node_displacements(const Part& part, std::size_t body, const Eigen::VectorXd& q) const;
  std::vector<Part> parts_of(std::size_t body, const std::vector<Teeth>& teeth) const;
  Loads loads_on(std::size_t body, const std::vector<Teeth>& teeth, Eigen::Index n) const;
  Eigen::MatrixXd compliance(std::size_t body, const std::vector<Teeth>& teeth, const Loads& loads,
                             bool of_friction, ResidualContact& responses);
  Solution solve(const Motions& motion, const std::vector<Teeth>& teeth, const std::vector<Loads>& loads,
                 Eigen::Index n, ResidualContact& responses);
  void add_joint_forces(const Motions& motion, const std::vector<Teeth>& teeth,
                        const std::vector<Loads>& loads, const Eigen::VectorXd& f, ResidualContact& responses,
                        ContactState& state);
  contact::StationDisplacements moved(const Part& part, std::size_t body, const std::vector<Teeth>& teeth,
                                      const Eigen::VectorXd& q, const Eigen::VectorXd& f);
  Eigen::Matrix3Xd moved_nodes(const Part& part, std::size_t body, const Eigen::VectorXd& q,
                               ResidualContact& responses) const;
  contact::PotentialSlopes slopes(const Part& part, std::size_t body,
                                  const contact::StationDisplacements& moved, const Eigen::VectorXd& f) const;
  void set_loads(const std::vector<Teeth>& teeth, const std::vector<Loads>& loads, const Solution& solution,
                 ContactState& state) const;
  void set_nodal_forces(std::size_t body, const Loads& loads, const Eigen::VectorXd& f,
                        const contact::SurfaceMotion& motion, ResidualContact& responses,
                        ContactState& state) const;
  void set_points(const Motions& motion, const std::vector<Teeth>& teeth, const Eigen::VectorXd& f,
                  ContactState& state) const;

  const SystemModel* model_;
  std::vector<Body> bodies_;
  std::vector<Pair> pairs_;
};

}  // namespace elastogear::dynamics
