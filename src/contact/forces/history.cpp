#include "contact/forces/history.h"

#include <algorithm>
#include <utility>

namespace elastogear::contact {
namespace {

// The entries of a map, each with its number.
template <class Value, class Visit>
void serialize_map(Archive& archive, std::map<int, Value>& map, const Visit& visit) {
  std::vector<std::pair<int, Value>> entries(map.begin(), map.end());
  archive.each(entries, [&](auto& entry) {
    archive(entry.first);
    visit(entry.second);
  });
  map = {entries.begin(), entries.end()};
}

void require_on(const StickPoint& point, int node, const model::Surface& slave,
                const model::Surface& master) {
  const auto n_nodes = slave.X.cols(), n_faces = master.face.cols();
  require(node >= 0 && node < n_nodes && point.face >= 0 && point.face < n_faces, "contact history: node ",
          node, " on face ", point.face, ", there are ", n_nodes, " nodes and ", n_faces, " faces");
}

void require_on(const StandingPoint& point, const model::Surface& slave, const model::Surface& master) {
  const auto n_slave = slave.face.cols(), n_master = master.face.cols();
  require(point.face >= 0 && point.face < n_slave && point.master_face >= 0 && point.master_face < n_master,
          "contact history: a point of face ", point.face, " of ", n_slave, " over face ", point.master_face,
          " of ", n_master);
}

}  // namespace

double given_force(const History& history, int point) {
  const auto given = history.p.find(point);
  return given == history.p.end() ? 0 : given->second;
}

const StickPoint* stuck_at(const History& history, int node) {
  const auto stuck = history.stuck.find(node);
  return stuck == history.stuck.end() ? nullptr : &stuck->second;
}

GivenFriction friction_at(const History& history, int node) {
  const auto given = history.t.find(node);
  return given == history.t.end() ? GivenFriction{} : given->second;
}

void set_forces(Histories& histories, const std::vector<ContactPoint>& contacts, const Eigen::Matrix3d& R) {
  for (History& history : histories) {
    history.p_before = std::exchange(history.p, {});
    history.t.clear();
  }
  for (const ContactPoint& contact : contacts) {
    if (!(contact.p > 0)) continue;
    History& history = histories[contact.slave_side];
    history.p[contact.slave_point] = contact.p;
    if (const auto& f = contact.tangential) history.t[contact.slave_node] = {R * (f->T * f->t), f->slides};
  }
}

double unclosed(const Histories& histories, const std::vector<ContactPoint>& contacts,
                const std::function<double(int side, int point)>& stiffness) {
  std::array<std::map<int, double>, 2> before{histories[0].p, histories[1].p};
  double most = 0;
  const auto enter = [&](int side, int point, double change) {
    most = std::max(most, std::abs(change) / stiffness(side, point));
  };
  for (const ContactPoint& contact : contacts) {
    double& p = before[contact.slave_side][contact.slave_point];
    enter(contact.slave_side, contact.slave_point, contact.p - std::exchange(p, 0));
  }
  for (int side : {0, 1})
    for (const auto& [point, p] : before[side]) enter(side, point, p);
  return most;
}

void accept(Histories& histories, const std::vector<ContactPoint>& contacts, bool sticks) {
  for (History& history : histories) {
    history.stuck = std::exchange(history.open, {});
    history.start = std::exchange(history.near, {});
  }
  if (!sticks) return;
  for (const ContactPoint& contact : contacts)
    histories[contact.slave_side].stuck[contact.slave_node] = contact.stick;
}

void serialize(History& history, const model::Surface& slave, const model::Surface& master,
               Archive& archive) {
  serialize_map(archive, history.stuck, [&](StickPoint& point) {
    for (int* n : {&point.slave_side, &point.slave_node, &point.face}) archive(*n);
    for (double* x : {&point.u, &point.v, &point.e_u, &point.e_v}) archive(*x);
    archive(point.slides);
  });
  for (const auto& [node, point] : history.stuck) require_on(point, node, slave, master);
  for (std::map<int, double>* p : {&history.p, &history.p_before})
    serialize_map(archive, *p, [&](double& force) { archive(force); });
  serialize_map(archive, history.t, [&](GivenFriction& given) {
    archive(given.t);
    archive(given.slides);
  });
  serialize_map(archive, history.start, [&](GapRate& at) {
    for (double* x : {&at.gap, &at.rate, &at.fade}) archive(*x);
  });
  serialize_map(archive, history.standing, [&](StandingPoint& point) {
    for (int* n : {&point.face, &point.master_face}) archive(*n);
    for (Eigen::Vector2d* x : {&point.at, &point.way}) archive(*x);
  });
  for (const auto& [number, point] : history.standing) require_on(point, slave, master);
  const std::size_t n_nodes = history.last_face.size();
  archive(history.last_face);
  require(history.last_face.size() == n_nodes, "the stored contacts are of other surfaces");
}

}  // namespace elastogear::contact
