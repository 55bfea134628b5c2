#include "app/console/mesh_accuracy.h"

namespace elastogear::app {
namespace {

// Error of the largest stress at a root, recovered on the free surface, under a load that is spread along a
// flank, of the wheel under one as narrow as a patch of contact, too (docs/validation.md, section 36): a row
// for meshes of order 1 and 2, a column for the sizes tiny, small, medium and paper.
constexpr const char* kWorm[2][4] = {{"22 % low", "21 % low", "14 % low", "11 % low"},
                                     {"within 9 %", "within 3 %", "within 1 %", "within 1 %"}};
constexpr const char* kWheel[2][4] = {
    {"48 % low (under a patch of contact 53 %)", "30 % low (under a patch of contact 34 %)",
     "20 % low (under a patch of contact 19 %)", "8 % low (under a patch of contact 13 %)"},
    {"9 % low (under a patch of contact 13 %)", "within 1 % (under a patch of contact 6 % low)",
     "within 1 % (under a patch of contact 6 % low)", "within 1 % (under a patch of contact, too)"}};

// Secant mesh stiffness of the reference drive beside what meshes go to with the local approach of
// flanks, with that and without; rows and columns as above (docs/validation.md, section 42).
constexpr const char* kStiffness[2][4] = {
    {"8 % high (without the approach by H. Hertz 50 %)", "5 % high (without the approach by H. Hertz 26 %)",
     "3 % high (without the approach by H. Hertz 17 %)", "2 % high (without the approach by H. Hertz 10 %)"},
    {"5 % high (without the approach by H. Hertz 34 %)", "2 % high (without the approach by H. Hertz 22 %)",
     "2 % high (without the approach by H. Hertz 21 %)", "1 % high (without the approach by H. Hertz 14 %)"}};
constexpr const char* kMeasured = "within 1 % (without the approach by H. Hertz 4 %)";
constexpr const char* kHertz[2][4] = {{kMeasured, kMeasured, kMeasured, kMeasured},
                                      {kMeasured, kMeasured, kMeasured, kMeasured}};

}  // namespace

std::string root_accuracy(bool is_worm, gear::Size size, int order) {
  std::string accuracy = (is_worm ? kWorm : kWheel)[order - 1][static_cast<int>(size)];
  accuracy += is_worm ? " at the root of the reference worm" : " at the root of the reference wheel";
  return accuracy;
}

std::string drive_accuracy(gear::Size size, int order) {
  return std::string("mesh stiffness ") + kStiffness[order - 1][static_cast<int>(size)] +
         "; flank pressure by H. Hertz " + kHertz[order - 1][static_cast<int>(size)] +
         "; on the reference worm drive";
}

}  // namespace elastogear::app
