#include "calculix.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <set>
#include <sstream>

#include "elastogear/base/error.h"

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

void write_deck(const fs::path& path, const CalculixModel& model, int n, const std::string& solver = "") {
  std::ofstream deck(path);
  deck << std::scientific << std::setprecision(12);  // CalculiX reads 20 characters of a number
  write_mesh(deck, model.mesh, model.element);
  deck << "*MATERIAL, NAME=M\n*ELASTIC\n"
       << model.material.E << ", " << model.material.nu << "\n*DENSITY\n"
       << model.material.rho << "\n*SOLID SECTION, ELSET=EALL, MATERIAL=M\n*BOUNDARY\n";
  std::set<int> held;
  for (const auto& name : model.restrained_sets)
    for (int node : mesh::node_set(model.mesh, name)) held.insert(node);
  for (int node : held) deck << node + 1 << ", 1, 3\n";
  deck << "*STEP\n*FREQUENCY" << solver << "\n" << n << "\n*END STEP\n";
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

}  // namespace

bool calculix_is_installed() { return std::system("command -v ccx > /dev/null 2>&1") == 0; }

std::vector<double> calculix_frequencies(const CalculixModel& model, int n) {
  const fs::path folder = make_folder();
  write_deck(folder / "deck.inp", model, n);
  const std::string run = "cd '" + folder.string() + "' && ccx -i deck > log.txt 2>&1";
  const int status = std::system(run.c_str());
  const auto frequencies = read_frequencies(folder / "deck.dat");
  require(status == 0 && static_cast<int>(frequencies.size()) >= n, "ccx failed in ", folder.string(), ": ",
          frequencies.size(), " of ", n, " frequencies");
  fs::remove_all(folder);
  return {frequencies.begin(), frequencies.begin() + n};
}

CalculixMatrices::CalculixMatrices(const CalculixModel& model) : folder(make_folder()) {
  write_deck(fs::path(folder) / "deck.inp", model, 1, ", SOLVER=MATRIXSTORAGE");
  const int status = std::system(("cd '" + folder + "' && ccx -i deck > log.txt 2>&1").c_str());
  require(status == 0 && fs::exists(stiffness()) && fs::exists(mass()) && fs::exists(dofs()),
          "ccx stored no matrices in ", folder);
}

CalculixMatrices::~CalculixMatrices() {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
}

}  // namespace elastogear::test
