#include "evaluation/signal.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "elastogear/base/error.h"

namespace elastogear::evaluation {
namespace {

using std::numbers::pi;

constexpr double kEven = 1e-6;        // of a step, per position
constexpr double kWhole = 1e-6;       // of a pitch
constexpr double kMostMissing = 0.1;  // of the positions

// Positive half of the discrete Fourier transform, without the factor 1/n.
std::vector<std::complex<double>> half_transform(const Eigen::VectorXd& signal) {
  std::vector<double> in(signal.begin(), signal.end());
  std::vector<std::complex<double>> out;
  Eigen::FFT<double> fft;
  fft.fwd(out, in);
  out.resize(in.size() / 2 + 1);
  return out;
}

// Two halves of the spectrum meet in each order but in the highest one of an even number of samples.
double one_sided(std::size_t k, Eigen::Index n) { return 2 * static_cast<Eigen::Index>(k) == n ? 1 : 2; }

// Linear interpolation at even roll angles.
Eigen::VectorXd resampled(const Eigen::VectorXd& roll, const Eigen::VectorXd& signal) {
  const Eigen::Index n = roll.size();
  const double step = (roll[n - 1] - roll[0]) / static_cast<double>(n - 1);
  Eigen::VectorXd even(n);
  for (Eigen::Index i = 0, j = 0; i < n; ++i) {
    const double at = roll[0] + step * static_cast<double>(i);
    while (j < n - 2 && roll[j + 1] < at) ++j;
    const double s = (at - roll[j]) / (roll[j + 1] - roll[j]);
    even[i] = (1 - s) * signal[j] + s * signal[j + 1];
  }
  return even;
}

// The signal at all positions, linear where some are missing, the first one behind the last one.
Eigen::VectorXd filled(const EvenPositions& even, const Eigen::VectorXd& signal) {
  Eigen::VectorXd all(even.n);
  for (std::size_t i = 0; i < even.index.size(); ++i) {
    const bool last = i + 1 == even.index.size();
    const Eigen::Index begin = even.index[i], end = last ? even.n + even.index[0] : even.index[i + 1];
    const double from = signal[static_cast<Eigen::Index>(i)],
                 to = signal[last ? 0 : static_cast<Eigen::Index>(i) + 1];
    for (Eigen::Index k = begin; k < end; ++k)
      all[k] = from + (to - from) * static_cast<double>(k - begin) / static_cast<double>(end - begin);
  }
  return all;
}

}  // namespace

double peak_to_peak(const Eigen::VectorXd& signal) {
  return signal.size() == 0 ? 0 : signal.maxCoeff() - signal.minCoeff();
}

double dynamic_factor(const Eigen::VectorXd& force) {
  const double mean = force.size() == 0 ? 0 : force.mean();
  return mean > 0 ? force.maxCoeff() / mean : std::numeric_limits<double>::quiet_NaN();
}

std::optional<EvenPositions> even_positions(const Eigen::VectorXd& roll) {
  const Eigen::Index n = roll.size();
  if (n < 2) return {};
  const double step = (roll.tail(n - 1) - roll.head(n - 1)).minCoeff();
  if (!(step > 0)) return {};
  EvenPositions even;
  for (double angle : roll) {
    const double index = (angle - roll[0]) / step;
    if (std::abs(index - std::round(index)) > kEven * static_cast<double>(n)) return {};
    even.index.push_back(static_cast<Eigen::Index>(std::llround(index)));
  }
  even.pitches = static_cast<int>(std::ceil(static_cast<double>(even.index.back() + 1) * step - kWhole));
  const double all = even.pitches / step;
  even.n = static_cast<Eigen::Index>(std::llround(all));
  if (std::abs(all - static_cast<double>(even.n)) > kWhole * all) return {};
  if (static_cast<double>(even.n - n) > kMostMissing * static_cast<double>(even.n)) return {};
  return even;
}

Spectrum fourier_orders(const Eigen::VectorXd& roll, const Eigen::VectorXd& signal) {
  const auto even = even_positions(roll);
  require(even.has_value(), "Fourier orders need roll angles that are even and fill whole pitches");
  const auto c = half_transform(filled(*even, signal));
  const auto orders = static_cast<Eigen::Index>(c.size()) - 1;
  Spectrum spectrum{Eigen::VectorXd(orders), Eigen::VectorXd(orders), Eigen::VectorXd(orders)};
  for (std::size_t k = 1; k < c.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k) - 1;
    spectrum.order[i] = static_cast<double>(k) / even->pitches;
    spectrum.amplitude[i] = one_sided(k, even->n) * std::abs(c[k]) / static_cast<double>(even->n);
    spectrum.phase[i] = std::remainder(std::arg(c[k]) - 2 * pi * spectrum.order[i] * roll[0], 2 * pi);
  }
  return spectrum;
}

bool rolls_on(const Eigen::VectorXd& roll) {
  const Eigen::Index n = roll.size();
  for (Eigen::Index i = 1; i < n; ++i)
    if (!(roll[i] > roll[i - 1])) return false;
  return n > 2 && roll[n - 1] - roll[0] >= 2;
}

Spectrum windowed_orders(const Eigen::VectorXd& roll, const Eigen::VectorXd& signal) {
  const Eigen::Index n = roll.size();
  for (Eigen::Index i = 1; i < n; ++i)
    require(roll[i] > roll[i - 1], "orders of a run: the roll angle ", roll[i], " pitches follows ",
            roll[i - 1], "; it must increase, in a span of time in which the gears roll on");
  require(n > 2 && roll[n - 1] - roll[0] >= 2, "orders of a run: it rolls over ",
          n > 0 ? roll[n - 1] - roll[0] : 0, " pitches, at least 2 are needed");
  Eigen::VectorXd even = resampled(roll, signal);
  even.array() -= even.mean();
  double sum = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double window = 0.5 - 0.5 * std::cos(2 * pi * static_cast<double>(i) / static_cast<double>(n));
    even[i] *= window;
    sum += window;
  }
  const auto c = half_transform(even);
  const auto orders = static_cast<Eigen::Index>(c.size()) - 1;
  const double length = (roll[n - 1] - roll[0]) * static_cast<double>(n) / static_cast<double>(n - 1);
  Spectrum spectrum{Eigen::VectorXd(orders), Eigen::VectorXd(orders), {}};
  for (std::size_t k = 1; k < c.size(); ++k) {
    spectrum.order[static_cast<Eigen::Index>(k) - 1] = static_cast<double>(k) / length;
    spectrum.amplitude[static_cast<Eigen::Index>(k) - 1] = one_sided(k, n) * std::abs(c[k]) / sum;
  }
  return spectrum;
}

double amplitude_at(const Spectrum& spectrum, double order) {
  if (spectrum.order.size() == 0) return 0;
  Eigen::Index at = 0;
  const double off = (spectrum.order.array() - order).abs().minCoeff(&at);
  return off <= 0.5 * spectrum.order[0] ? spectrum.amplitude[at] : 0;
}

}  // namespace elastogear::evaluation
