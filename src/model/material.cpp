#include "elastogear/model/material.h"

#include <numeric>
#include <utility>

namespace elastogear::model {
namespace {

// The share of a modulus that stays for good.
double long_term_share(const std::vector<double>& relative) {
  return 1 - std::accumulate(relative.begin(), relative.end(), 0.0);
}

// The material with g times the shear modulus and k times the bulk modulus.
Material scaled(Material material, double g, double k) {
  if (material.orthotropic) {
    material.orthotropic->E *= g;
    material.orthotropic->G *= g;
    return material;
  }
  if (g == k) {
    material.E *= g;
    return material;
  }
  const double G = g * material.E / (2 * (1 + material.nu)), K = k * material.E / (3 * (1 - 2 * material.nu));
  material.E = 9 * K * G / (3 * K + G);
  material.nu = (3 * K - 2 * G) / (2 * (3 * K + G));
  return material;
}

}  // namespace

Material from_long_term(Material material) {
  if (!material.viscoelastic) return material;
  const double g = long_term_share(material.viscoelastic->g), k = long_term_share(material.viscoelastic->k);
  return scaled(std::move(material), 1 / g, 1 / k);
}

}  // namespace elastogear::model
