#include "elastogear/contact/pair.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "elastogear/contact/candidates.h"
#include "elastogear/contact/coarse_search.h"
#include "elastogear/contact/penalty.h"
#include "elastogear/contact/tangent.h"

namespace elastogear::contact {
namespace {

struct Side {
  const model::Surface* surface;
  Topology topology;
  Eigen::VectorXd c_p;         // N/m, of each node as slave
  std::vector<int> last_face;  // master face each node touched last; -1
};

Side make_side(const model::Surface& surface, const Settings& settings) {
  const int n_s = static_cast<int>(surface.X.cols());
  return {&surface, topology(surface.face, n_s), node_stiffness(settings, surface),
          std::vector<int>(n_s, -1)};
}

double largest_displacement(const SurfaceState& state, const model::Surface& surface) {
  return std::sqrt((state.x_B - surface.X).colwise().squaredNorm().maxCoeff());
}

// How far the prolonged open ends of a surface reach beyond its faces.
double extension_reach(const SurfaceView& surface) {
  double reach = 0;
  for (int f : surface.topology.open_faces) {
    const Face face = face_of(surface, f);
    for (int corner = 0; corner < face.sides; ++corner) {
      const Eigen::Vector2d at = extended_corner(face, corner);
      reach = std::max(reach, (combine(face, shape(face.sides, at[0], at[1]).N) - face.x[corner]).norm());
    }
  }
  return reach;
}

// From the common frame to the world.
void rotate(ContactPoint& contact, const Eigen::Matrix3d& R) {
  contact.n = R * contact.n;
  contact.f = R * contact.f;
  for (int i = 0; i < 5; ++i) contact.W.middleRows<3>(3 * i) = (R * contact.W.middleRows<3>(3 * i)).eval();
}

ContactPoint make_contact(const SurfaceView& master, const Winner& w, double c_p, bool full_tangent) {
  const Face face = face_of(master, w.face);
  const Eigen::Vector2d natural = natural_coordinates(face.sides, w.point.u, w.point.v);
  ContactPoint contact;
  contact.face = w.face;
  contact.master_node = master.face.col(w.face);
  contact.N = w.point.N;
  contact.xi = natural[0];
  contact.eta = natural[1];
  contact.n = w.n;
  contact.g_n = w.g_n;
  contact.f = -c_p * w.g_n * w.n;
  contact.energy = 0.5 * c_p * w.g_n * w.g_n;
  Tangent tangent = contact_tangent(face, w, c_p, full_tangent);
  contact.W = std::move(tangent.W);
  contact.k = std::move(tangent.k);
  return contact;
}

}  // namespace

struct Pair::Data {
  Settings settings;
  Side side[2];
  CoarseSearch search;
  Configuration configuration;
  Candidates candidates;

  SurfaceView view(int i, double extension) const {
    return {side[i].surface->face, side[i].topology, configuration.x[i], extension};
  }
  void place(const SurfaceState& a, const SurfaceState& b);
  double margin() const;
  void run_pass(int slave_side, const std::vector<NodePair>& face_pairs, double margin,
                std::vector<ContactPoint>& contacts);
};

// Common frame: the BRF of b.
void Pair::Data::place(const SurfaceState& a, const SurfaceState& b) {
  configuration.R.noalias() = b.R_WB.transpose() * a.R_WB;
  configuration.r.noalias() = b.R_WB.transpose() * (a.r_WB - b.r_WB);
  configuration.x[0].noalias() = configuration.R * a.x_B;
  configuration.x[0].colwise() += configuration.r;
  configuration.x[1] = b.x_B;
  if (settings.update == Update::realign)
    configuration.deformation =
        largest_displacement(a, *side[0].surface) + largest_displacement(b, *side[1].surface);
}

// Largest distance of a slave node from a master face's corners that can still matter.
double Pair::Data::margin() const {
  return settings.depth +
         std::max(extension_reach(view(0, settings.extension)), extension_reach(view(1, settings.extension)));
}

void Pair::Data::run_pass(int slave_side, const std::vector<NodePair>& face_pairs, double margin,
                          std::vector<ContactPoint>& contacts) {
  const SurfaceView slave = view(slave_side, 0), master = view(1 - slave_side, settings.extension);
  const Limits limits{settings.depth, std::cos(settings.normal_angle * std::numbers::pi / 180)};
  Side& slaves = side[slave_side];
  candidates.collect(face_pairs, slave_side, slave, master, margin);
  for (int node = 0; node < slave.x.cols(); ++node) {
    const auto faces = candidates[node];
    if (faces.empty()) continue;
    const auto cached = std::find(faces.begin(), faces.end(), slaves.last_face[node]);
    if (cached != faces.end()) std::iter_swap(faces.begin(), cached);
    const SlaveNode q{slave.x.col(node), [&] { return node_normal(slave, node); }};
    const auto winner = find_winner(master, q, limits, faces);
    slaves.last_face[node] = winner ? winner->face : -1;
    if (!winner) continue;
    contacts.push_back(make_contact(master, *winner, slaves.c_p[node], settings.full_tangent));
    contacts.back().slave_side = slave_side;
    contacts.back().slave_node = node;
  }
}

Pair::Pair(const model::Surface& a, const model::Surface& b, const Settings& given) {
  validate(given);
  validate(a, 0);
  validate(b, 1);
  const Settings settings = with_defaults(given, a, b);
  data_.reset(new Data{settings,
                       {make_side(a, settings), make_side(b, settings)},
                       CoarseSearch(a, b, settings.k, settings.update),
                       {},
                       {}});
}

Pair::~Pair() = default;
Pair::Pair(Pair&&) noexcept = default;

const Settings& Pair::settings() const { return data_->settings; }

std::vector<ContactPoint> Pair::detect(const SurfaceState& a, const SurfaceState& b) {
  Data& d = *data_;
  validate(a, *d.side[0].surface, 0);
  validate(b, *d.side[1].surface, 1);
  d.place(a, b);
  const double margin = d.margin();
  const auto& face_pairs = d.search.face_pairs(d.configuration, margin);
  std::vector<ContactPoint> contacts;
  d.run_pass(d.settings.slave, face_pairs, margin, contacts);
  if (d.settings.two_pass) d.run_pass(1 - d.settings.slave, face_pairs, margin, contacts);
  for (ContactPoint& contact : contacts) rotate(contact, b.R_WB);
  return contacts;
}

}  // namespace elastogear::contact
