// Stress at the roots of the reference worm drive on meshes of several sizes and orders, averaged and
// recovered on the free surface:
//
//   drive_roots worm|wheel [load=RADIUS,HALF_HEIGHT,HALF_LENGTH] MESH ... [deck FILE]
//
// MESH is a size of elastogear mesh, times a factor of all counts (x), with counts and growths of its own
// and, behind a colon, the order of the hexahedra: tiny, smallx2, small,fillet=3,growth=2:2. thread is the
// length of the worm's thread in mm. The load is 1 kN along the normals of a flank, spread smoothly over its
// whole height and 12 mm of its length, which the coarsest mesh resolves, or over what `load` says, in mm, as
// narrow as a patch of contact if need be. The worm is held at its seats; of
// the wheel five teeth on their part of the disc are taken, held at the bore and where they are cut. Printed
// are the largest von Mises and first principal stress (MPa) at all nodes of the root that are not on a
// flank, and the largest and the root mean square error of the stress tensor there as shares of the largest
// von Mises stress, beside what is recovered on the last mesh, interpolated at the nodes; and there and on
// the loaded flank how many nodes estimates are held against, at how many the error is below twice the
// estimate, and the median of estimate over error. deck: the last mesh with its load as a deck for CalculiX
// is written to FILE, with the largest stresses of the same nodes on its first line.

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "elastogear/base/error.h"
#include "elastogear/base/petsc.h"
#include "elastogear/gear/design.h"
#include "elastogear/gear/size.h"
#include "elastogear/gear/wheel.h"
#include "elastogear/gear/worm.h"
#include "root_case.h"

namespace {

using namespace elastogear;
using namespace root_stress;
using Eigen::Vector3d;

constexpr const char* kThread = "thread";
constexpr double kRoot = 10e-3;  // m, from its middle to the ends of the worm's root that is looked at

// Patch of a flank that bears the load: around a radius, up the flank, and around the flank's middle, along
// it; m.
struct Spread {
  double radius, half_height, half_length;
};

// load=RADIUS,HALF_HEIGHT,HALF_LENGTH in mm; nothing of another word.
std::optional<Spread> spread_of(const std::string& word) {
  Spread s{};
  if (std::sscanf(word.c_str(), "load=%lf,%lf,%lf", &s.radius, &s.half_height, &s.half_length) != 3)
    return {};
  return Spread{1e-3 * s.radius, 1e-3 * s.half_height, 1e-3 * s.half_length};
}

// SIZE[xTIMES][,COUNT=N ...][:ORDER|:tet]
struct MeshChoice {
  gear::Size size;
  int times = 1, order = 1;
  bool tetrahedra = false;
  std::map<std::string, double> counts;
};

MeshChoice mesh_choice(const std::string& word) {
  const auto colon = word.find(':');
  const std::string cells = colon == std::string::npos ? "1" : word.substr(colon + 1);
  std::istringstream body(word.substr(0, colon));
  std::string part;
  std::getline(body, part, ',');
  const auto x = part.find('x');
  MeshChoice choice{.size = gear::size(part.substr(0, x)),
                    .times = x == std::string::npos ? 1 : std::stoi(part.substr(x + 1)),
                    .order = 1,
                    .tetrahedra = cells == "tet",
                    .counts = {}};
  if (!choice.tetrahedra) choice.order = std::stoi(cells);
  while (std::getline(body, part, ',')) {
    const auto at = part.find('=');
    choice.counts[part.substr(0, at)] = std::stod(part.substr(at + 1));
  }
  return choice;
}

template <class Counts, class Value>
using Members = std::map<std::string, Value Counts::*>;

const Members<gear::WormCounts, int> kWormCounts = {
    {"tooth", &gear::WormCounts::tooth}, {"space", &gear::WormCounts::space},
    {"flank", &gear::WormCounts::flank}, {"fillet", &gear::WormCounts::fillet},
    {"ring", &gear::WormCounts::ring},   {"turn", &gear::WormCounts::turn},
    {"shaft", &gear::WormCounts::shaft}};
const Members<gear::WheelCounts, int> kWheelCounts = {{"tooth", &gear::WheelCounts::tooth},
                                                      {"space", &gear::WheelCounts::space},
                                                      {"flank", &gear::WheelCounts::flank},
                                                      {"fillet", &gear::WheelCounts::fillet},
                                                      {"rim", &gear::WheelCounts::rim},
                                                      {"ring", &gear::WheelCounts::ring},
                                                      {"web", &gear::WheelCounts::web},
                                                      {"hub", &gear::WheelCounts::hub},
                                                      {"web_layers", &gear::WheelCounts::web_layers},
                                                      {"face_layers", &gear::WheelCounts::face_layers},
                                                      {"hub_layers", &gear::WheelCounts::hub_layers}};

template <class Counts>
Counts counts_of(const MeshChoice& choice, Counts n, const Members<Counts, int>& members) {
  for (const auto& [name, count] : members) n.*count *= choice.times;
  for (const auto& [name, value] : choice.counts) {
    if (name == "growth")
      n.growth = value;
    else if (name == "tooth_growth")
      n.tooth_growth = value;
    else if (name != kThread)
      n.*members.at(name) = static_cast<int>(value);
  }
  n.order = choice.order;
  return n;
}

// The load's middle is at z = 0; on the worm its length counts around the axis.
Case case_of(const std::string& body, const MeshChoice& choice, const std::optional<Spread>& load) {
  gear::Design design;
  if (const auto thread = choice.counts.find(kThread); thread != choice.counts.end())
    design.thread_length = 1e-3 * thread->second;
  const gear::Geometry geometry = gear::derive(design);
  const bool worm = body == "worm";
  Case c{worm ? gear::worm_mesh(
                    design,
                    counts_of(choice, gear::worm_counts(choice.size, design.z1, choice.order), kWormCounts))
              : gear::wheel_mesh(
                    design, counts_of(choice, gear::wheel_counts(choice.size, choice.order), kWheelCounts)),
         {worm ? "seats" : "bore"},
         worm ? "thread_1_left" : "tooth_01_left",
         {},
         {}};
  const gear::Toothing t = worm ? geometry.worm : geometry.wheel;
  const double along = worm ? t.r / t.p : 1;
  const Spread over = load.value_or(Spread{(t.r_form + t.r_a) / 2, std::abs(t.r_a - t.r_form) / 2, 6e-3});
  c.intensity = [=](const Vector3d& X) {
    return bump(X.head<2>().norm(), over.radius, over.half_height) * bump(along * X[2], 0, over.half_length);
  };
  const std::string root = worm ? "root_1" : "root_01";
  for (int node : c.mesh.node_sets.at(root)) {
    if (std::abs(along * c.mesh.X(2, node)) < kRoot) c.root.push_back(node);
  }
  if (!worm) cut_teeth(c, t.z, 2);
  if (choice.tetrahedra) c.mesh = tetrahedra(c.mesh);
  return c;
}

// Stress of the reference at a point of the surface: the polynomial of degree 2 over the plane through the
// nearest nodes that fits it best.
Eigen::Matrix<double, 6, 1> interpolated(const Solution& reference, const Vector3d& x) {
  constexpr int kNearest = 30;  // in more than two rows, where these are wider apart than their nodes
  std::vector<int> order(static_cast<std::size_t>(reference.X.cols()));
  std::iota(order.begin(), order.end(), 0);
  const Eigen::RowVectorXd distance = (reference.X.colwise() - x).colwise().norm();
  std::partial_sort(order.begin(), order.begin() + kNearest, order.end(),
                    [&](int a, int b) { return distance[a] < distance[b]; });
  order.resize(kNearest);
  if (distance[order[0]] < 1e-8) return reference.recovered.col(order[0]);
  const Eigen::Matrix3Xd near = reference.X(Eigen::all, order).colwise() - x;
  const Eigen::Matrix3d axes = Eigen::JacobiSVD<Eigen::Matrix3Xd>(near, Eigen::ComputeFullU).matrixU();
  const double scale = distance[order.back()];
  Eigen::MatrixXd P(kNearest, 6);
  for (int i = 0; i < kNearest; ++i) {
    const double u = axes.col(0).dot(near.col(i)) / scale, v = axes.col(1).dot(near.col(i)) / scale;
    P.row(i) << 1, u, v, u * u, u * v, v * v;
    P.row(i) *= std::exp(-4 * std::pow(distance[order[static_cast<std::size_t>(i)]] / scale, 2));
  }
  Eigen::MatrixXd value = reference.recovered(Eigen::all, order).transpose();
  for (int i = 0; i < kNearest; ++i)
    value.row(i) *= std::exp(-4 * std::pow(distance[order[static_cast<std::size_t>(i)]] / scale, 2));
  return P.completeOrthogonalDecomposition().solve(value).row(0).transpose();
}

Eigen::MatrixXd interpolated(const Solution& reference, const Eigen::Matrix3Xd& X) {
  Eigen::MatrixXd sigma(6, X.cols());
  for (Eigen::Index i = 0; i < X.cols(); ++i) sigma.col(i) = interpolated(reference, Vector3d(X.col(i)));
  return sigma;
}

// Nodes in ascending order, in lines of 8, counted from 1.
void write_set(std::ofstream& file, const std::string& name, const std::vector<int>& nodes) {
  file << "*NSET, NSET=" << name << "\n";
  for (std::size_t i = 0; i < nodes.size(); ++i)
    file << nodes[i] + 1 << (i % 8 == 7 || i + 1 == nodes.size() ? "\n" : ", ");
}

void write_deck(const std::string& path, const Case& c, const Solution& s) {
  std::ofstream file(path);
  file.precision(12);  // CalculiX reads 20 letters of a number
  file << "** largest von Mises stress, averaged, recovered: " << largest(s.averaged).von_mises << " "
       << largest(s.recovered).von_mises << "\n*NODE\n";
  const std::set<int> used(c.mesh.cells.nodes.begin(), c.mesh.cells.nodes.end());
  for (int n : used)
    file << n + 1 << ", " << c.mesh.X(0, n) << ", " << c.mesh.X(1, n) << ", " << c.mesh.X(2, n) << "\n";
  file << "*ELEMENT, TYPE=" << (c.mesh.cells.type[0] == mesh::CellType::hex20 ? "C3D20" : "C3D8I")
       << ", ELSET=ALL\n";
  for (int cell = 0; cell < c.mesh.cells.size(); ++cell) {
    file << cell + 1;
    const auto nodes = c.mesh.cells[cell];
    for (std::size_t i = 0; i < nodes.size(); ++i) file << (i == 9 ? ",\n" : ", ") << nodes[i] + 1;
    file << "\n";
  }
  write_set(file, "ROOT", s.node);
  file << "*MATERIAL, NAME=STEEL\n*ELASTIC\n210e9, 0.3\n*SOLID SECTION, ELSET=ALL, "
          "MATERIAL=STEEL\n*BOUNDARY\n";
  std::set<int> held;
  for (const std::string& set : c.held)
    for (int node : c.mesh.node_sets.at(set))
      if (used.contains(node)) held.insert(node);
  for (int node : held) file << node + 1 << ", 1, 3\n";
  const std::vector<int> loaded = nodes_of(c.mesh, c.flank);
  const Eigen::Matrix3Xd f = nodal_forces(c, loaded);
  file << "*STEP\n*STATIC\n*CLOAD\n";
  for (std::size_t i = 0; i < loaded.size(); ++i)
    for (int k = 0; k < 3; ++k)
      file << loaded[i] + 1 << ", " << k + 1 << ", " << f(k, static_cast<Eigen::Index>(i)) << "\n";
  file << "*NODE FILE, NSET=ROOT\nU\n*EL FILE, NSET=ROOT\nS\n*END STEP\n";
}

void run(const std::vector<std::string>& words) {
  const auto deck = std::find(words.begin(), words.end(), "deck");
  std::vector<std::pair<Case, Solutions>> solved;
  const std::optional<Spread> load = spread_of(words[1]);
  const auto first = words.begin() + (load ? 2 : 1);
  require(first != deck, "drive_roots: no mesh is named");
  for (auto word = first; word != deck; ++word) {
    Case c = case_of(words[0], mesh_choice(*word), load);
    Solutions s = solve(c);
    print(*word, c.mesh, s.root);
    std::printf("\n");
    std::fflush(stdout);
    if (deck != words.end() && word + 1 == deck) write_deck(deck[1], c, s.root);
    solved.emplace_back(std::move(c), std::move(s));
  }
  const Solutions& reference = solved.back().second;
  const double scale = largest(reference.root.recovered).von_mises;
  for (std::size_t i = 0; i + 1 < solved.size(); ++i) {
    const auto& [root, flank] = solved[i].second;
    const std::string& word = first[static_cast<std::ptrdiff_t>(i)];
    const Eigen::MatrixXd at_root = interpolated(reference.root, root.X),
                          on_flank = interpolated(reference.flank, flank.X);
    std::printf("%-10s", word.c_str());
    print_errors(root, at_root, scale);
    print_estimates(word, "estimates at the root", root, at_root, scale);
    print_estimates(word, "on the flank", flank, on_flank, largest(on_flank).von_mises);
    std::printf("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Session session(argc, argv);
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 2)
    return std::fprintf(stderr,
                        "usage: drive_roots worm|wheel [load=RADIUS,HALF_HEIGHT,HALF_LENGTH] "
                        "SIZE[xTIMES][,COUNT=N ...][:ORDER|:tet] ... [deck FILE]\n"),
           2;
  try {
    run(words);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
