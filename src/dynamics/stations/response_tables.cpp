#include "dynamics/stations/response_tables.h"

#include <Eigen/Geometry>
#include <numbers>
#include <unordered_map>

namespace elastogear::dynamics {

using contact::ToothContact;

ResponseTables::ResponseTables(const model::ElasticBody& body, const contact::ToothedBody& toothed)
    : body_(&body), toothed_(&toothed) {
  const int teeth = toothed.flanks().teeth(), sectors = body.flexibility.n_sectors;
  const bool about_z = body.flexibility.axis.isApprox(Eigen::Vector3d::UnitZ());
  period_ = about_z && sectors > 0 && teeth % sectors == 0 ? teeth / sectors : teeth;
  if (!toothed.repeats(period_)) period_ = teeth;
}

const Eigen::MatrixXd& ResponseTables::table(const ToothContact::Side& a, const ToothContact::Side& b) {
  const int teeth = toothed_->flanks().teeth(), from = a.flank.tooth % period_;
  const int to = (b.flank.tooth - a.flank.tooth + from + teeth) % teeth;
  const auto [at, is_new] = tables_.try_emplace(Key{a.loads, b.loads, from, to});
  if (!is_new) return at->second;
  const model::Flexibility& flexibility = body_->flexibility;
  std::unordered_map<int, Eigen::MatrixXf> columns;  // by orbit
  const auto response = [&](int node_a, int node_b) {
    const int i = model::find_loaded(flexibility, node_a), j = model::find_loaded(flexibility, node_b);
    const int orbit = flexibility.surface.orbit[static_cast<std::size_t>(j)];
    const auto [known, unknown] = columns.try_emplace(orbit);
    if (unknown) known->second = model::displacement_columns(flexibility, orbit);
    return model::displacement_response(flexibility, i, j, known->second);
  };
  at->second = contact::response_table(*a.loads, toothed_->nodes({from, a.flank.side}), *b.loads,
                                       toothed_->nodes({to, b.flank.side}), response);
  return at->second;
}

// Turns what acts on a tooth to its copy in the table.
Eigen::Matrix3d ResponseTables::back(const ToothContact::Side& a) const {
  const int teeth = toothed_->flanks().teeth(), turned = a.flank.tooth - a.flank.tooth % period_;
  return Eigen::AngleAxisd(-2 * std::numbers::pi * turned / teeth, Eigen::Vector3d::UnitZ())
      .toRotationMatrix();
}

Eigen::MatrixXd ResponseTables::responses(const ToothContact::Side& a, const ToothContact::Side& b,
                                          const Eigen::Matrix3Xd& force) {
  return contact::responses(*a.loads, a.at, back(a) * a.direction, *b.loads, b.at, back(a) * force,
                            table(a, b));
}

void ResponseTables::add(const ToothContact::Side& a, const ToothContact::Side& b,
                         const Eigen::Matrix3Xd& force, contact::StationDisplacements& displacements) {
  const Eigen::Matrix3d turn = back(a);
  contact::StationDisplacements turned{Eigen::Matrix3Xd::Zero(3, displacements.u.cols()),
                                       Eigen::Matrix3Xd::Zero(3, displacements.u.cols())};
  contact::add_responses(*a.loads, a.at, *b.loads, b.at, turn * force, table(a, b), turned);
  displacements.u += turn.transpose() * turned.u;
  displacements.u_v += turn.transpose() * turned.u_v;
}

}  // namespace elastogear::dynamics
