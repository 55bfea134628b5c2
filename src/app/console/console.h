#pragma once
// Output of the program: progress with time remaining, and aligned summaries. Rank 0 only.

#include <functional>
#include <string>

#include "elastogear/base/progress.h"

namespace elastogear::app {

/// Progress lines on stderr with the time remaining of the stage, by what this run has done of it: on a
/// terminal one that changes, elsewhere one every 10 to 30 s, also while the work is silent. Silent on ranks
/// > 0. `detail`: what is added behind as far as it fits, asked for when a stage reports.
Progress console_progress(std::function<std::string()> detail = {});

/// "  name ............ text"
void print_item(const std::string& name, const std::string& text);
/// The same of a line that is for those who look closer: shown where everything is (option verbose), and told
/// to a program that the verb runs in.
void print_detail(const std::string& name, const std::string& text);
void set_verbose(bool verbose);
/// Returns whether print_detail says anything.
bool is_verbose();
/// While it lives print_item is silent.
class Silence {
 public:
  explicit Silence(bool silent = true);
  ~Silence();
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  bool before_;
};
/// Returns whether print_item is silent, so that what it would say need not be found out.
bool is_silenced();
/// Number with unit in about four significant digits.
std::string with_unit(double value, const std::string& unit);
/// Number in three significant digits, without an exponent from 1000 on.
std::string short_number(double value);
/// Number whose last digit is the second one of its error, which is positive.
std::string rounded_to(double error, double value);
/// "0.0595 +- 0.0021 um", "3.92e-05 +- 2.1e-07 g"; without an error (0) with_unit.
std::string with_error(double value, double error, const std::string& unit);
/// A share in percent: two digits below 10 %, whole percents above.
std::string percent(double share);
/// with_unit of a length in m, in mm.
std::string in_mm(double length);
/// Seconds as "0.83 s", "2 min 05 s".
std::string duration(double seconds);
/// The most this process has held so far, "1760 MB".
std::string largest_memory();

}  // namespace elastogear::app
