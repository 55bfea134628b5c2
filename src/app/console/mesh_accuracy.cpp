#include "app/console/mesh_accuracy.h"

#include "app/console/console.h"

namespace elastogear::app {
namespace {

// Error of the largest stress at a root, recovered on the free surface, under a load that is spread along a
// flank, of the wheel under one as narrow as a patch of contact, too (docs/validation/recovery.md, section
// Roots): a row for meshes of order 1 and 2, a column for the sizes tiny, small, medium and paper.
constexpr const char* kWorm[2][4] = {{"22 % low", "21 % low", "14 % low", "11 % low"},
                                     {"within 9 %", "within 3 %", "within 1 %", "within 1 %"}};
constexpr const char* kWheel[2][4] = {
    {"48 % low (under a patch of contact 53 %)", "30 % low (under a patch of contact 34 %)",
     "20 % low (under a patch of contact 19 %)", "8 % low (under a patch of contact 13 %)"},
    {"9 % low (under a patch of contact 13 %)", "within 1 % (under a patch of contact 6 % low)",
     "within 1 % (under a patch of contact 6 % low)",
     "within 1 % (under a patch of contact 0.4 to 1.4 % low)"}};

// Error of the first 20 frequencies, rows and columns as above (docs/validation/gears.md, section Meshes).
constexpr const char* kWormFrequencies[2][4] = {
    {"up to 6.1 % high", "up to 2 % high", "up to 2 % high", "within 1 %"},
    {"up to 1.1 % high", "within 1 %", "within 1 %", "within 1 %"}};
constexpr const char* kWheelFrequencies[2][4] = {
    {"up to 17 % high", "up to 5.3 % high", "up to 3 % high", "up to 1.3 % high"},
    {"up to 6.4 % high", "within 1 %", "within 1 %", "within 1 %"}};

// Secant mesh stiffness of the reference drive beside what meshes go to; rows and columns as above
// (docs/validation/gears.md, section Meshes).
constexpr const char* kStiffness[2][4] = {{"8 % high", "5 % high", "3 % high", "2 % high"},
                                          {"5 % high", "2 % high", "2 % high", "1 % high"}};
constexpr const char* kMeasured = "within 1 %";
constexpr const char* kHertz[2][4] = {{kMeasured, kMeasured, kMeasured, kMeasured},
                                      {kMeasured, kMeasured, kMeasured, kMeasured}};

std::string accuracy(const char* const (&errors)[2][4], gear::Size size, int order) {
  return errors[order - 1][static_cast<int>(size)];
}

}  // namespace

void print_mesh_accuracy(bool is_worm, gear::Size size, int order) {
  const std::string body = is_worm ? "the reference worm" : "the reference wheel";
  print_item("stress on such meshes",
             accuracy(is_worm ? kWorm : kWheel, size, order) + " at the root of " + body);
  print_item("frequencies on such meshes",
             "the first 20 " + accuracy(is_worm ? kWormFrequencies : kWheelFrequencies, size, order) +
                 " on " + body);
}

std::string drive_accuracy(gear::Size size, int order) {
  return std::string("mesh stiffness ") + accuracy(kStiffness, size, order) +
         "; flank pressure by H. Hertz " + accuracy(kHertz, size, order) + "; on the reference worm drive";
}

}  // namespace elastogear::app
