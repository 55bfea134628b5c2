#include "calculix.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

#include "elastogear/base/error.h"
#include "elastogear/mesh/hold.h"

namespace elastogear::test {
namespace {

namespace fs = std::filesystem;

fs::path make_folder() {
  std::string name = (fs::temp_directory_path() / "ccx_XXXXXX").string();
  require(mkdtemp(name.data()) != nullptr, "cannot make the folder ", name);
  return name;
}

void write_mesh(std::ostream& deck, const mesh::Mesh& mesh, const std::string& element) {
  deck << "*NODE, NSET=NALL\n";
  for (int i = 0; i < mesh.n_nodes(); ++i)
    deck << i + 1 << ", " << mesh.X(0, i) << ", " << mesh.X(1, i) << ", " << mesh.X(2, i) << "\n";
  deck << "*ELEMENT, TYPE=" << element << ", ELSET=EALL\n";
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    deck << cell + 1;
    for (int k = 0; int node : mesh.cells[cell]) deck << (++k % 16 == 0 ? ",\n" : ", ") << node + 1;
    deck << "\n";
  }
}

void write_orientation(std::ostream& deck, const model::Orientation& o) {
  const Eigen::IOFormat row(Eigen::StreamPrecision, Eigen::DontAlignCols, ", ", ", ");
  const bool cylindrical = o.system == model::Orientation::System::cylindrical;
  const Eigen::Vector3d a = cylindrical ? o.origin : o.axis_1, b = cylindrical ? o.origin + o.axis : o.axis_2;
  deck << "*ORIENTATION, NAME=O, SYSTEM=" << (cylindrical ? "CYLINDRICAL" : "RECTANGULAR") << "\n"
       << a.format(row) << ", " << b.format(row) << "\n";
}

void write_material(std::ostream& deck, const model::Material& material) {
  const auto& m = material.orthotropic;
  if (m) write_orientation(deck, m->orientation);
  deck << "*MATERIAL, NAME=M\n*ELASTIC";
  if (m) {
    const Eigen::IOFormat row(Eigen::StreamPrecision, Eigen::DontAlignCols, ", ", ", ");
    deck << ", TYPE=ENGINEERING CONSTANTS\n"
         << m->E.format(row) << ", " << m->nu.format(row) << ", " << m->G(0) << ", " << m->G(1) << ",\n"
         << m->G(2);
  } else {
    deck << "\n" << material.E << ", " << material.nu;
  }
  deck << "\n*DENSITY\n"
       << material.rho << "\n*SOLID SECTION, ELSET=EALL, MATERIAL=M" << (m ? ", ORIENTATION=O" : "") << "\n";
}

std::string initial_velocity(const Eigen::Matrix3Xd& velocity) {
  std::ostringstream cards;
  cards << std::scientific << std::setprecision(12) << "*INITIAL CONDITIONS, TYPE=VELOCITY\n";
  for (Eigen::Index node = 0; node < velocity.cols(); ++node)
    for (int d = 0; d < 3; ++d) cards << node + 1 << ", " << d + 1 << ", " << velocity(d, node) << "\n";
  return cards.str();
}

// Newton's method until residual and correction are roundoff of the printed digits.
std::string motion_step(const CalculixMotion& motion) {
  std::ostringstream step;
  step << std::scientific << std::setprecision(12) << "*DYNAMIC, DIRECT, ALPHA=0.\n"
       << motion.dt << ", " << motion.n_steps * motion.dt << "\n*CONTROLS, PARAMETERS=FIELD\n1e-7, 1e-6\n"
       << "*NODE PRINT, NSET=NALL, FREQUENCY=" << motion.print_every << "\nU\n";
  return step.str();
}

// Blocks of rows "node, three displacements", each below a heading.
std::vector<Eigen::Matrix3Xd> read_displacements(const fs::path& path, int n_nodes) {
  std::ifstream dat(path);
  std::vector<Eigen::Matrix3Xd> fields;
  std::string line;
  while (std::getline(dat, line)) {
    std::istringstream row(line);
    int node = 0;
    Eigen::Vector3d u;
    if (line.find("displacements") != std::string::npos)
      fields.emplace_back(Eigen::Matrix3Xd::Constant(3, n_nodes, NAN));
    else if (row >> node >> u[0] >> u[1] >> u[2])
      fields.back().col(node - 1) = u;
  }
  return fields;
}

void write_deck(const fs::path& path, const CalculixModel& model, const std::string& step,
                const std::string& before = "", const std::string& options = "") {
  std::ofstream deck(path);
  deck << std::scientific << std::setprecision(12);  // CalculiX reads 20 characters of a number
  write_mesh(deck, model.mesh, model.element);
  write_material(deck, model.material);
  deck << "*BOUNDARY\n";
  const std::vector<mesh::Directions> held = mesh::held_by(model.mesh, model.restrained_sets);
  for (std::size_t node = 0; node < held.size(); ++node)
    for (int d = 0; d < 3; ++d)
      if (mesh::holds(held[node], d)) deck << node + 1 << ", " << d + 1 << "\n";
  deck << before << "*STEP" << options << "\n" << step << "*END STEP\n";
  require(deck.good(), "cannot write ", path);
}

// Rows "mode, eigenvalue, rad/time, cycles/time, imaginary part" below the heading of the first table.
std::vector<double> read_frequencies(const fs::path& path) {
  std::ifstream dat(path);
  std::vector<double> frequencies;
  std::string line;
  while (std::getline(dat, line)) {
    if (line.find("P A R T I C I P A T I O N") != std::string::npos) break;
    std::istringstream row(line);
    double mode = 0, eigenvalue = 0, omega = 0, hertz = 0;
    if (row >> mode >> eigenvalue >> omega >> hertz) frequencies.push_back(hertz);
  }
  return frequencies;
}

std::string force_step(const std::map<int, Eigen::Vector3d>& forces) {
  std::ostringstream step;
  step << std::scientific << std::setprecision(12) << "*STATIC\n*CLOAD\n";
  for (const auto& [node, f] : forces)
    for (int d = 0; d < 3; ++d) step << node + 1 << ", " << d + 1 << ", " << f(d) << "\n";
  step << "*EL FILE\nS\n";
  return step.str();
}

// Block " -4  STRESS": rows " -1", the node in 10 columns, six numbers in 12 each, up to " -3".
Eigen::MatrixXd read_stress(const fs::path& path, int n_nodes) {
  std::ifstream frd(path);
  Eigen::MatrixXd stress = Eigen::MatrixXd::Constant(6, n_nodes, NAN);
  std::string line;
  while (std::getline(frd, line) && !line.starts_with(" -4  STRESS")) continue;
  while (std::getline(frd, line) && !line.starts_with(" -3")) {
    if (!line.starts_with(" -1")) continue;
    const int node = std::stoi(line.substr(3, 10)) - 1;
    for (int i = 0; i < 6; ++i) stress(i, node) = std::stod(line.substr(13 + 12 * i, 12));
  }
  return stress;
}

// Runs ccx on the deck in the folder.
void run(const fs::path& folder) {
  const std::string command = "cd '" + folder.string() + "' && ccx -i deck > log.txt 2>&1";
  require(std::system(command.c_str()) == 0, "ccx failed in ", folder.string());
}

}  // namespace

bool calculix_is_installed() { return std::system("command -v ccx > /dev/null 2>&1") == 0; }

std::vector<double> calculix_frequencies(const CalculixModel& model, int n) {
  const fs::path folder = make_folder();
  write_deck(folder / "deck.inp", model, "*FREQUENCY\n" + std::to_string(n) + "\n");
  run(folder);
  const auto frequencies = read_frequencies(folder / "deck.dat");
  require(static_cast<int>(frequencies.size()) >= n, "ccx in ", folder.string(), ": ", frequencies.size(),
          " of ", n, " frequencies");
  fs::remove_all(folder);
  return {frequencies.begin(), frequencies.begin() + n};
}

Eigen::MatrixXd calculix_stress(const CalculixModel& model, const std::map<int, Eigen::Vector3d>& forces) {
  const fs::path folder = make_folder();
  write_deck(folder / "deck.inp", model, force_step(forces));
  run(folder);
  const Eigen::MatrixXd stress = read_stress(folder / "deck.frd", model.mesh.n_nodes());
  require(stress.allFinite(), "ccx in ", folder.string(), ": no stress at some nodes");
  fs::remove_all(folder);
  return stress;
}

std::vector<Eigen::Matrix3Xd> calculix_motion(const CalculixModel& model, const CalculixMotion& motion) {
  const fs::path folder = make_folder();
  write_deck(folder / "deck.inp", model, motion_step(motion), initial_velocity(motion.velocity),
             ", NLGEOM, INC=" + std::to_string(motion.n_steps + 1));
  run(folder);
  const auto fields = read_displacements(folder / "deck.dat", model.mesh.n_nodes());
  require(static_cast<int>(fields.size()) == motion.n_steps / motion.print_every && fields.back().allFinite(),
          "ccx in ", folder.string(), ": ", fields.size(), " printed states");
  fs::remove_all(folder);
  return fields;
}

CalculixMatrices::CalculixMatrices(const CalculixModel& model) : folder(make_folder()) {
  write_deck(fs::path(folder) / "deck.inp", model, "*FREQUENCY, SOLVER=MATRIXSTORAGE\n1\n");
  run(folder);
  require(fs::exists(stiffness()) && fs::exists(mass()) && fs::exists(dofs()), "ccx stored no matrices in ",
          folder);
}

CalculixMatrices::~CalculixMatrices() {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
}

}  // namespace elastogear::test
