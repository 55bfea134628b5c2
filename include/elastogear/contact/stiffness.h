#pragma once
// Penalty stiffness of a pair and of its slave nodes.

#include "elastogear/contact/types.h"

namespace elastogear::contact {

/// Mean penalty stiffness of both sides in series: Pa/m, or N/m per node times the mean area of a slave node.
/// Throws Error when c_f is needed and not positive. docs/theory, Eq. (6.6).
double default_stiffness(const Settings& settings, const model::Surface& a, const model::Surface& b);

/// N/m per node of the slave surface, settings complete.
Eigen::VectorXd node_stiffness(const Settings& settings, const model::Surface& slave);

}  // namespace elastogear::contact
