#pragma once
// The 8-node hexahedron: plain, with nine incompatible modes, or B-bar (docs/theory, section 1.1).
//
// Incompatible modes: P_k = 1 - xi_k^2, k = 1..3, for each direction of displacement; E. L. Wilson's modes
// with the corrected gradient grad P = (det J_0/det J) J_0^-T dP/dxi (J_0: Jacobian at the centre) of R. L.
// Taylor, P. J. Beresford, E. L. Wilson, "A non-conforming element for stress analysis", Int. J. Numer. Meth.
// Eng. 10 (1976) 1211-1219: it integrates to zero over the cell, so the patch test is passed on any shape.
// The modes are condensed statically. Their mass is left out by mass(), and is in mass_with_modes().
//
// B-bar: the dilatation is its mean over the cell, so that nearly incompressible bodies do not lock; T. J. R.
// Hughes, "Generalization of selective integration procedures to anisotropic and nonlinear media", Int. J.
// Numer. Meth. Eng. 15 (1980) 1413-1418, with J. C. Nagtegaal's constant dilatation.
//
// Dofs are node-major (x y z of node 0, then of node 1, ...); stresses are ordered xx yy zz xy yz xz.

#include <Eigen/Core>

#include "elastogear/fem/material.h"

namespace elastogear::fem::hex8 {

using Coordinates = Eigen::Matrix<double, 3, 8>;       ///< m, one column per node
using Stiffness = Eigen::Matrix<double, 24, 24>;       ///< N/m
using Mass = Eigen::Matrix<double, 8, 8>;              ///< kg, scalar: the element's mass is Mass (x) I_3
using MassWithModes = Eigen::Matrix<double, 11, 11>;   ///< kg, of the shape functions, then of P_1, P_2, P_3
using Amplitudes = Eigen::Matrix<double, 9, 24>;       ///< -, row 3 k + d: of P_(k+1) in direction d
using StressOperator = Eigen::Matrix<double, 48, 24>;  ///< Pa/m, 6 rows per node

/// Smallest determinant of the Jacobian (m^3) over the centre and all points of both quadratures. Every
/// function below presumes that it is positive.
double smallest_jacobian(const Coordinates& X);

/// Stiffness K_e of the cell, 2x2x2 Gauss points.
Stiffness stiffness(const Coordinates& X, const Elasticity& material, model::Element element);

/// Stiffness of the cell by a part of the material's elasticity, with the incompatible amplitudes of the
/// whole material: parts sum to stiffness(). docs/theory, Eq. (1.13).
Stiffness stiffness_of_part(const Coordinates& X, const Elasticity& material, const Elasticity& part,
                            model::Element element);

/// Consistent mass, 3x3x3 Gauss points: exact for every trilinear hexahedron.
Mass mass(const Coordinates& X, double rho);

/// Consistent mass of the shape functions and the incompatible modes, 3x3x3 Gauss points: exact for every
/// trilinear hexahedron but for the products of two modes, which are exact on parallelepipeds.
MassWithModes mass_with_modes(const Coordinates& X, double rho);

/// Amplitudes of the incompatible modes per nodal displacement by static condensation: zero for every rigid
/// motion. docs/theory, Eq. (1.5a).
Amplitudes incompatible_amplitudes(const Coordinates& X, const Elasticity& material);

/// Stress at the 2x2x2 Gauss points, incompatible part included, extrapolated trilinearly to the nodes.
StressOperator stress(const Coordinates& X, const Elasticity& material, model::Element element);

/// Volume of the cell, m^3, exact.
double volume(const Coordinates& X);

}  // namespace elastogear::fem::hex8
