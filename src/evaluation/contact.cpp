#include "elastogear/evaluation/contact.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "elastogear/base/error.h"
#include "elastogear/model/corner_shares.h"
#include "elastogear/model/face_point.h"

namespace elastogear::evaluation {
namespace {

constexpr double kSameLayer = 1e-4;  // of the range of z
constexpr std::size_t kMostLayers = 200;

void require_on_surface(const model::ContactRecord& record, const std::array<Flanks, 2>& flanks) {
  const int slave = record.slave_side;
  require(slave == 0 || slave == 1, "contact record: slave_side ", slave, ", must be 0 or 1");
  require(record.slave_node >= 0 && record.slave_node < flanks[slave].surface->X.cols(),
          "contact record: the surface has no node ", record.slave_node);
  require(record.face >= 0 && record.face < flanks[1 - slave].surface->face.cols(),
          "contact record: the surface has no face ", record.face);
}

}  // namespace

Flanks flanks(const gear::Toothing& toothing, const model::Surface& surface) {
  Flanks flanks{.surface = &surface};
  for (const std::string& name : surface.group_name)
    flanks.of_group.push_back(gear::flank_of(toothing, name));
  flanks.of_node.assign(static_cast<std::size_t>(surface.X.cols()), 0);
  for (int f = static_cast<int>(surface.face.cols()) - 1; f >= 0; --f)
    for (int node : surface.face.col(f)) flanks.of_node[static_cast<std::size_t>(node)] = surface.group[f];
  return flanks;
}

Eigen::VectorXd node_layers(const Flanks& flanks) {
  const std::vector<model::CornersOfNode> corners = model::corners_of_nodes(*flanks.surface);
  std::vector<double> z;
  for (std::size_t node = 0; node < flanks.of_node.size(); ++node)
    if (flanks.of_group[flanks.of_node[node]] && corners[node][0] == corners[node][1])
      z.push_back(flanks.surface->X(2, static_cast<Eigen::Index>(node)));
  if (z.empty()) return {};
  std::sort(z.begin(), z.end());
  const double same = kSameLayer * (z.back() - z.front());
  std::vector<double> layers;
  for (double value : z)
    if (layers.empty() || value - layers.back() > same) layers.push_back(value);
  if (layers.size() < 2 || layers.size() > kMostLayers) return {};
  return Eigen::Map<Eigen::VectorXd>(layers.data(), static_cast<Eigen::Index>(layers.size()));
}

namespace {

// The gear whose flank gives the normal: the master, but where its tip's edge touches, which has none, the
// other one.
std::size_t farther_from_tip(const std::array<const Gear*, 2>& gear,
                             const std::array<Eigen::Vector3d, 2>& x_B, std::size_t master) {
  constexpr double kAtEdge = 2e-3;  // of the tooth's height
  const gear::Toothing& toothing = gear[master]->toothing;
  const double below = std::abs(x_B[master].head<2>().norm() - toothing.r_a);
  return below > kAtEdge * std::abs(toothing.r_a - toothing.r_f) ? master : 1 - master;
}

}  // namespace

std::vector<FlankContact> flank_contacts(const std::vector<model::ContactRecord>& records,
                                         const std::array<const Gear*, 2>& gear,
                                         const std::array<Flanks, 2>& flanks, std::size_t step) {
  std::vector<FlankContact> contacts;
  for (const model::ContactRecord& record : records) {
    require_on_surface(record, flanks);
    const int slave = record.slave_side, master = 1 - slave;
    std::array<std::optional<gear::Flank>, 2> flank;
    flank[slave] = flanks[slave].of_group[flanks[slave].of_node[record.slave_node]];
    flank[master] = flanks[master].of_group[flanks[master].surface->group[record.face]];
    if (!flank[0] || !flank[1]) continue;
    FlankContact c{.flank = {*flank[0], *flank[1]}, .x_B = {}, .x_W = {}, .n = {}, .f = {}};
    const auto& R = gear[master]->rotation[step];
    c.x_B[master] = model::point_on_face(*flanks[master].surface, record.face, record.xi, record.eta);
    c.x_W = gear[master]->position[step] + R * c.x_B[master];
    c.x_B[slave] = gear[slave]->rotation[step].transpose() * (c.x_W - gear[slave]->position[step]);
    const std::size_t plain = farther_from_tip(gear, c.x_B, static_cast<std::size_t>(master));
    c.n = (plain == 0 ? 1 : -1) * (gear[plain]->rotation[step] *
                                   gear::flank_normal(gear[plain]->toothing, *flank[plain], c.x_B[plain]));
    c.f = slave == 1 ? record.f : Eigen::Vector3d(-record.f);
    c.normal_force = c.f.dot(c.n);
    c.pressure = record.pressure;
    contacts.push_back(c);
  }
  return contacts;
}

int slave_side(const std::vector<std::vector<model::ContactRecord>>& records) {
  std::size_t of_second = 0, all = 0;
  for (const auto& step : records)
    for (const auto& record : step) of_second += record.slave_side == 1, ++all;
  return 2 * of_second > all ? 1 : 0;
}

ToothPairs tooth_pairs(const ContactHistory& contacts) {
  std::map<std::array<int, 2>, Eigen::VectorXd> force;
  const auto n_t = static_cast<Eigen::Index>(contacts.size());
  for (std::size_t step = 0; step < contacts.size(); ++step)
    for (const FlankContact& c : contacts[step]) {
      Eigen::VectorXd& of_pair = force[{c.flank[0].tooth, c.flank[1].tooth}];
      if (of_pair.size() == 0) of_pair = Eigen::VectorXd::Zero(n_t);
      of_pair[static_cast<Eigen::Index>(step)] += c.normal_force;
    }
  ToothPairs pairs;
  pairs.force.resize(n_t, static_cast<Eigen::Index>(force.size()));
  for (const auto& [tooth, values] : force) {
    pairs.force.col(static_cast<Eigen::Index>(pairs.tooth.size())) = values;
    pairs.tooth.push_back(tooth);
  }
  const Eigen::VectorXd sum = pairs.force.rowwise().sum();
  pairs.share = pairs.force;
  for (Eigen::Index i = 0; i < n_t; ++i) pairs.share.row(i) *= sum[i] > 0 ? 1 / sum[i] : 0;
  pairs.count = (pairs.share.array() > kBears).cast<int>().rowwise().sum();
  return pairs;
}

double contact_ratio(const ToothPairs& pairs) {
  return pairs.count.size() == 0 ? 0 : pairs.count.cast<double>().mean();
}

int loaded_side(const ContactHistory& contacts, int g) {
  double left = 0, right = 0;
  for (const auto& step : contacts)
    for (const FlankContact& c : step) (c.flank[g].side > 0 ? left : right) += c.normal_force;
  if (!(left + right > 0)) return 0;
  return left >= right ? 1 : -1;
}

}  // namespace elastogear::evaluation
