#include <algorithm>
#include <cmath>
#include <numbers>

#include "gear/cylindrical/generating_tool.h"
#include "gear/gear_mesh.h"

namespace elastogear::gear {

RackTip generating_rack(const CylindricalDrive& d, const CylindricalGeometry& g, int i) {
  const Toothing& t = g.gear[i];
  const double beta = std::acos(d.m_n * t.z / (2 * t.r));
  const Protuberance protuberance{d.rack.pr * d.m_n,
                                  d.rack.alpha_pr < 0 ? d.rack.alpha_n / 2 : d.rack.alpha_pr};
  return rack_tip(d.rack.alpha_n, beta, t.r, g.s_n[i], t.r - t.r_f, d.rack.rho_fP * d.m_n, protuberance);
}

Cutter generating_cutter(const CylindricalDrive& d, const CylindricalGeometry& g, int i) {
  return cutter(g.gear[i], g.cutter[i].z_0, g.cutter[i].rho_a0 * d.m_n);
}

Profile tooth_profile(const CylindricalDrive& d, const CylindricalGeometry& g, int i, double r_inner) {
  return g.gear[i].internal ? shaped_profile(generating_cutter(d, g, i), g.gear[i], r_inner)
                            : generated_profile(generating_rack(d, g, i), g.gear[i], r_inner);
}

WheelCounts cylindrical_counts(const CylindricalDrive& d, const CylindricalGeometry& g, int i, Size size,
                               int order) {
  constexpr double kWidth = 8;         // modules, which the layers of a size are for
  constexpr int kLeastLayers[]{2, 4};  // of cells of 8 and of 20 nodes
  constexpr int kLeastColumns = 2;  // of half a space: cells of the root land as long as those of the fillet
  WheelCounts n = wheel_counts(size, order);
  n.web_growth = 0;
  const Blank& b = g.blank[i];
  // Lines of contact of helical gears cross the layers.
  const double more = order == 2 && size == Size::tiny && d.beta != 0 ? 1.5 : 1;
  const double total = more * (n.web_layers + 2 * n.face_layers) * b.face_width / (kWidth * d.m_n);
  const int layers = std::max(kLeastLayers[order - 1], static_cast<int>(std::lround(total)));
  const double column = std::numbers::pi * g.gear[i].r / (g.gear[i].z * (n.space + 0.5 * n.tooth));
  const auto rows = [&](double outer, double inner) {
    constexpr double kSlender = 3;  // columns that a row may be high
    return std::max(1, static_cast<int>(std::lround(std::abs(outer - inner) / 2 / (kSlender * column))));
  };
  if (order == 2) n.space = std::max(n.space, kLeastColumns);
  if (!b.has_web()) {
    n.web_layers = layers;
    n.ring = rows(b.rim_diameter, b.end_diameter());
    return n;
  }
  n.web_layers = std::max(1, static_cast<int>(std::lround(layers * b.web_width / b.face_width)));
  n.face_layers = std::max(1, (layers - n.web_layers) / 2);
  n.ring = rows(b.rim_diameter, b.web_diameter);
  n.web = rows(b.web_diameter, b.hub_diameter);
  n.hub = rows(b.hub_diameter, b.bore);
  return n;
}

mesh::Mesh cylindrical_mesh(const CylindricalDrive& d, const CylindricalGeometry& g, int i,
                            const WheelCounts& counts) {
  const Profile profile = tooth_profile(d, g, i, g.blank[i].rim_diameter / 2);
  return gear_mesh(d.gears[i].name, g.gear[i], profile, g.blank[i], counts);
}

}  // namespace elastogear::gear
