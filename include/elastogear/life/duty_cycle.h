#pragma once
// Damage of the nodes of a gear over a duty cycle of torques and revolutions (docs/life.md).

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastogear/life/fatigue.h"
#include "elastogear/life/revolution.h"

namespace elastogear::life {

/// Part of a duty cycle. Torque and revolutions are those of the drive's first gear.
struct Block {
  double torque = 0;       ///< N m, > 0 on the drive side, < 0 on the coast side
  double revolutions = 0;  ///< > 0
  double time = 0;         ///< s; 0: not known
};

/// How the stress at a block's torque comes from the torques whose stresses are known.
struct Between {
  int below = 0, above = 0;  ///< numbers among them
  double share = 0;          ///< of the second; > 1 or `below` = `above` where it is scaled in proportion
  double factor = 1;         ///< on both
};

/// Linear between two known torques of the same sense. Outside them the nearest is scaled in proportion when
/// `proportional`, else Error naming the torque, those known and the remedy.
Between between(const std::vector<double>& known, double torque, bool proportional);

/// What nodes of one gear bear over a duty cycle.
struct Damage {
  Eigen::MatrixXd of_block;   ///< m x n_blocks, in one duty cycle
  Eigen::VectorXd total;      ///< m
  Eigen::VectorXd amplitude;  ///< m, Pa, largest fully reversed amplitude that does the same damage
};

/// histories: of the gear at each known torque, of the same nodes. ratio: size of the gear's revolutions over
/// those of the first gear.
Damage duty_cycle_damage(const std::vector<Revolutions>& histories, const std::vector<double>& known,
                         const std::vector<Block>& blocks, double ratio, const SnCurve& curve,
                         const MeanStress& mean_stress, bool proportional);

/// The stress of one of the nodes over the revolutions at a torque, Pa.
Eigen::VectorXd history_at(const std::vector<Revolutions>& histories, const Between& at, Eigen::Index node);

}  // namespace elastogear::life
