#pragma once
// Static responses of the flanks of one body to the loads of stations on them, by pairs of teeth. Teeth that
// are turned copies of each other share them.

#include <map>
#include <tuple>
#include <vector>

#include "elastogear/contact/tooth_contact.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::dynamics {

class ResponseTables {
 public:
  /// Both must outlive this.
  ResponseTables(const model::ElasticBody& body, const contact::ToothedBody& toothed);

  /// n x n, m/N: displacements at the stations of one side of a contact, along their directions, by forces at
  /// those of another, 3 x n, N; of the whole body.
  Eigen::MatrixXd responses(const contact::ToothContact::Side& a, const contact::ToothContact::Side& b,
                            const Eigen::Matrix3Xd& force);
  /// Adds displacements at a's stations by forces on b's strips, 3 x n, N.
  void add(const contact::ToothContact::Side& a, const contact::ToothContact::Side& b,
           const Eigen::Matrix3Xd& force, contact::StationDisplacements& displacements);

 private:
  using Key = std::tuple<const contact::LoadTable*, const contact::LoadTable*, int, int>;

  Eigen::Matrix3d back(const contact::ToothContact::Side& a) const;
  const Eigen::MatrixXd& table(const contact::ToothContact::Side& a, const contact::ToothContact::Side& b);

  const model::ElasticBody* body_;
  const contact::ToothedBody* toothed_;
  int period_;  // teeth after which the body repeats
  std::map<Key, Eigen::MatrixXd> tables_;
};

}  // namespace elastogear::dynamics
