#include "elastogear/model/material.h"

#include <numeric>

namespace elastogear::model {
namespace {

// The share of a modulus that stays for good.
double long_term_share(const std::vector<double>& relative) {
  return 1 - std::accumulate(relative.begin(), relative.end(), 0.0);
}

}  // namespace

Material from_long_term(Material material) {
  if (!material.viscoelastic) return material;
  const double g = long_term_share(material.viscoelastic->g), k = long_term_share(material.viscoelastic->k);
  if (material.orthotropic) {
    material.orthotropic->E /= g;
    material.orthotropic->G /= g;
    return material;
  }
  if (material.viscoelastic->has_constant_ratio()) {
    material.E /= g;
    return material;
  }
  const double G = material.E / (2 * (1 + material.nu)) / g, K = material.E / (3 * (1 - 2 * material.nu)) / k;
  material.E = 9 * K * G / (3 * K + G);
  material.nu = (3 * K - 2 * G) / (2 * (3 * K + G));
  return material;
}

}  // namespace elastogear::model
