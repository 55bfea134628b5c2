#pragma once
// Words and units of the body file.

#include <algorithm>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "elastogear/base/error.h"
#include "elastogear/model/elastic_body.h"
#include "elastogear/model/material.h"
#include "elastogear/model/stress_recovery.h"

namespace elastogear::io {

/// Nodes on which forces may act. Present where stresses are recovered on free surfaces.
inline constexpr const char* kLoadedNodes = "/stress/loaded";

/// Do numbers ascend strictly within 0 .. n - 1?
inline bool ascends_below(const std::vector<int>& numbers, Eigen::Index n) {
  const bool ascending =
      std::adjacent_find(numbers.begin(), numbers.end(), std::greater_equal<>()) == numbers.end();
  return ascending && (numbers.empty() || (numbers.front() >= 0 && numbers.back() < n));
}

/// Units follow from those of q: m sqrt(kg) when mass-normalised (modal), m for the unit basis (full).
struct BodyUnits {
  const char *Phi, *Psi, *M, *K, *C_l, *C_r, *S_1, *S_2, *marker;
};
constexpr BodyUnits kModalUnits{"kg^-1/2",
                                "Pa m^-1 kg^-1/2",
                                "1",
                                "s^-2",
                                "kg^1/2",
                                "m kg^1/2",
                                "m kg^1/2",
                                "1",
                                "kg^-1/2 or rad m^-1 kg^-1/2"};
constexpr BodyUnits kFullUnits{"1", "Pa/m", "kg", "N/m", "kg", "kg m", "kg m", "kg", "1 or rad/m"};

// Names of the second moments, in the order of model::Inertia::S_2.
inline constexpr const char* kMoments[] = {"11", "22", "33", "12", "23", "13"};

inline const BodyUnits& body_units(model::Basis basis) {
  return basis == model::Basis::modal ? kModalUnits : kFullUnits;
}

inline std::string basis_name(model::Basis basis) { return basis == model::Basis::modal ? "modal" : "full"; }
inline model::Basis parse_basis(const std::string& path, const std::string& name) {
  if (name == "modal") return model::Basis::modal;
  require(name == "full", path, ": unknown basis '", name, "', allowed are modal, full");
  return model::Basis::full;
}

// Names of the elements, in the order of model::Element.
inline constexpr const char* kElementNames[] = {"incompatible", "plain", "bbar"};

inline std::string element_name(model::Element element) {
  return kElementNames[static_cast<std::size_t>(element)];
}
inline model::Element parse_element(const std::string& path, const std::string& name) {
  const auto* const found = std::find(std::begin(kElementNames), std::end(kElementNames), name);
  require(found != std::end(kElementNames), path, ": unknown element '", name,
          "', allowed are incompatible, plain, bbar");
  return static_cast<model::Element>(found - std::begin(kElementNames));
}

/// Attribute of the file: whether the mass of incompatible hex8 has their modes. Files without it do not.
inline constexpr const char* kAttachments = "attachments";
inline constexpr const char* kElementMass = "element_mass";
inline constexpr const char *kAssembledK = "assembled_stiffness", *kAssembledM = "assembled_mass";

inline std::string element_mass_name(model::ElementMass mass) {
  return mass == model::ElementMass::compatible ? "compatible" : "condensed";
}
inline model::ElementMass parse_element_mass(const std::string& path, const std::string& name) {
  if (name == "compatible") return model::ElementMass::compatible;
  require(name == "condensed", path, ": unknown element_mass '", name,
          "', allowed are compatible, condensed");
  return model::ElementMass::condensed;
}

// Names of the recovery methods, in the order of model::RecoveryMethod.
inline std::string recovery_name(model::RecoveryMethod method) {
  return method == model::RecoveryMethod::average ? "average" : "surface";
}

inline std::string system_name(model::Orientation::System system) {
  return system == model::Orientation::System::rectangular ? "rectangular" : "cylindrical";
}
inline model::Orientation::System parse_system(const std::string& path, const std::string& name) {
  if (name == "rectangular") return model::Orientation::System::rectangular;
  require(name == "cylindrical", path, ": unknown orientation '", name,
          "', allowed are rectangular, cylindrical");
  return model::Orientation::System::cylindrical;
}

}  // namespace elastogear::io
