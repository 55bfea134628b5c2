#include "evaluation/load/hertz.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "elastogear/model/hertz.h"
#include "evaluation/load/line_load.h"

namespace elastogear::evaluation {
using model::HertzEllipse, model::HertzPatch;

namespace {

// Contacts of one pair of teeth at one time.
using PairContacts = std::vector<const FlankContact*>;
using Pairs = std::map<std::array<int, 2>, PairContacts>;

Pairs pairs_of(const std::vector<FlankContact>& contacts) {
  Pairs pairs;
  for (const FlankContact& c : contacts)
    if (c.normal_force > 0) pairs[{c.flank[0].tooth, c.flank[1].tooth}].push_back(&c);
  return pairs;
}

// Line contact of one pair of teeth on parallel axes at each station of the face.
std::vector<HertzPatch> line_contact(const std::array<const Gear*, 2>& gear,
                                     const std::vector<const FlankContact*>& contacts,
                                     const FaceStations& stations, double E_star, std::size_t step) {
  const auto n = static_cast<Eigen::Index>(contacts.size());
  Eigen::VectorXd z(n), force(n), per_length(n), curved(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const FlankContact& c = *contacts[static_cast<std::size_t>(i)];
    const model::Curvatures at = model::principal_curvatures(relative_curvature(gear, c, step), c.n);
    z[i] = c.x_B[1][2];
    force[i] = c.normal_force;
    per_length[i] = c.normal_force * std::abs(at.along.dot(gear[1]->axis(step)));
    curved[i] = c.normal_force * at.largest;
  }
  const Eigen::VectorXd load = line_load(stations, z, force), w = line_load(stations, z, per_length),
                        kappa = line_load(stations, z, curved);
  std::vector<HertzPatch> lines(static_cast<std::size_t>(load.size()));
  for (Eigen::Index i = 0; i < load.size(); ++i)
    if (load[i] > 0) lines[static_cast<std::size_t>(i)] = model::hertz_line(w[i], kappa[i] / load[i], E_star);
  return lines;
}

HertzPatch largest_of(const std::vector<HertzPatch>& lines) {
  return *std::max_element(lines.begin(), lines.end(),
                           [](const HertzPatch& a, const HertzPatch& b) { return a.pressure < b.pressure; });
}

HertzPatch at_place(const std::vector<HertzPatch>& lines, const FaceStations& stations, double z) {
  const auto [station, share] = share_out(stations, z);
  HertzPatch here;
  for (std::size_t k : {0, 1}) {
    const HertzPatch& line = lines[static_cast<std::size_t>(station[k])];
    here.pressure += share[k] * line.pressure;
    here.half_width += share[k] * line.half_width;
  }
  return here;
}

// True where the patch of one pair of teeth, with its half width in m, reaches beyond the tip or the form
// radius of either gear. The radius of the patch is the mean of the contacts' by their forces.
bool crosses_end(const std::array<const Gear*, 2>& gear, const std::vector<const FlankContact*>& contacts,
                 double half_width) {
  for (std::size_t g : {0, 1}) {
    double radius = 0, force = 0;
    for (const FlankContact* c : contacts) {
      radius += c->normal_force * c->x_B[g].head<2>().norm();
      force += c->normal_force;
    }
    const gear::Toothing& t = gear[g]->toothing;
    const double to_fillet = t.sign() * (radius / force - t.r_form),
                 to_tip = t.sign() * (t.r_a - radius / force);
    if (std::min(to_fillet, to_tip) < half_width) return true;
  }
  return false;
}

// Point contact of one pair of teeth on crossed axes, under the force of all its contacts and with their mean
// curvature.
std::optional<HertzPatch> point_contact(const std::array<const Gear*, 2>& gear,
                                        const std::vector<const FlankContact*>& contacts, double E_star,
                                        std::size_t step) {
  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
  Eigen::Vector3d n = Eigen::Vector3d::Zero();
  double F = 0;
  for (const FlankContact* c : contacts) {
    Q += c->normal_force * relative_curvature(gear, *c, step);
    n += c->normal_force * c->n;
    F += c->normal_force;
  }
  const model::Curvatures at = model::principal_curvatures(Q / F, n.normalized());
  if (!(at.least > 0)) return {};
  const HertzEllipse ellipse = model::hertz_ellipse(at.least / 2, at.largest / 2, E_star);
  if (ellipse.k < model::kLeastAxes || ellipse.a(F) > std::min(gear[0]->width, gear[1]->width) / 2) return {};
  const HertzPatch found{ellipse.pressure(F), ellipse.k * ellipse.a(F), ellipse.k};
  if (!std::isfinite(found.pressure) || crosses_end(gear, contacts, found.half_width)) return {};
  return found;
}

}  // namespace

Eigen::Matrix3d relative_curvature(const std::array<const Gear*, 2>& gear, const FlankContact& c,
                                   std::size_t step) {
  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
  for (std::size_t g : {0, 1}) {
    const Eigen::Matrix3d& R = gear[g]->rotation[step];
    Q += R * gear::flank_curvature(gear[g]->toothing, c.flank[g], c.x_B[g]) * R.transpose();
  }
  return Q;
}

std::optional<HertzPressure> hertz_pressure(const std::array<const Gear*, 2>& gear,
                                            const ContactHistory& contacts, const FaceStations& over_face,
                                            double E_star) {
  const bool parallel = transmission(*gear[0], *gear[1], 1).parallel;
  HertzPressure found{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(contacts.size()))};
  int n_pairs = 0, n_left_out = 0;
  for (std::size_t step = 0; step < contacts.size(); ++step)
    for (const auto& [teeth, of_pair] : pairs_of(contacts[step])) {
      const std::optional<HertzPatch> here =
          parallel ? largest_of(line_contact(gear, of_pair, over_face, E_star, step))
                   : point_contact(gear, of_pair, E_star, step);
      ++n_pairs;
      if (!here || !std::isfinite(here->pressure)) {
        ++n_left_out;
        continue;
      }
      const auto i = static_cast<Eigen::Index>(step);
      found.largest[i] = std::max(found.largest[i], here->pressure);
      if (here->pressure <= found.patch.pressure) continue;
      found.patch = *here;
      found.step = i;
    }
  if (n_left_out == n_pairs) return {};
  found.left_out = static_cast<double>(n_left_out) / n_pairs;
  return found;
}

void take_hertz(const std::array<const Gear*, 2>& gear, const FaceStations& over_face, double E_star,
                ContactHistory& contacts) {
  const bool parallel = transmission(*gear[0], *gear[1], 1).parallel;
  for (std::size_t step = 0; step < contacts.size(); ++step) {
    const auto changed = [&](const FlankContact* c) -> FlankContact& {
      return contacts[step][static_cast<std::size_t>(c - contacts[step].data())];
    };
    for (const auto& [teeth, of_pair] : pairs_of(contacts[step])) {
      if (parallel) {
        const std::vector<HertzPatch> lines = line_contact(gear, of_pair, over_face, E_star, step);
        for (const FlankContact* c : of_pair) {
          const HertzPatch here = at_place(lines, over_face, c->x_B[1][2]);
          changed(c).pressure = here.pressure;
          changed(c).half_width = here.half_width;
        }
      } else if (const auto patch = point_contact(gear, of_pair, E_star, step)) {
        for (const FlankContact* c : of_pair) changed(c).half_width = patch->half_width;
      }
    }
  }
}

}  // namespace elastogear::evaluation
