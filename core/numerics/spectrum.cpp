#include "core/numerics/spectrum.h"

#include <unsupported/Eigen/FFT>

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <numeric>

namespace evical {
namespace {

double meanOf(std::span<const double> samples) {
  return std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
}

std::vector<double> hannWindow(std::size_t size) {
  std::vector<double> window(size);
  for (std::size_t k = 0; k < size; ++k)
    window[k] =
        0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(size));
  return window;
}

}  // namespace

NoiseSpectrum noiseSpectrum(std::span<const double> samples, double rate_hz, int segment) {
  const auto length = static_cast<std::size_t>(segment), half = length / 2;
  if (samples.size() < length) return {};
  const std::vector<double> window = hannWindow(length);
  double window_power = 0.0;
  for (const double w : window) window_power += w * w;

  Eigen::FFT<double> fft;
  std::vector<double> tapered(length), power(half + 1, 0.0);
  std::vector<std::complex<double>> transform;
  int segments = 0;
  for (std::size_t begin = 0; begin + length <= samples.size(); begin += half, ++segments) {
    const std::span<const double> part = samples.subspan(begin, length);
    const double mean = meanOf(part);
    for (std::size_t k = 0; k < length; ++k) tapered[k] = window[k] * (part[k] - mean);
    fft.fwd(transform, tapered);
    for (std::size_t k = 0; k <= half; ++k) power[k] += std::norm(transform[k]);
  }

  NoiseSpectrum spectrum;
  for (std::size_t k = 1; k <= half; ++k) {
    spectrum.frequency_hz.push_back(rate_hz * static_cast<double>(k) / static_cast<double>(length));
    spectrum.density.push_back(std::sqrt(power[k] / (segments * window_power * rate_hz)));
  }
  return spectrum;
}

std::vector<double> autocorrelation(std::span<const double> samples, int lags) {
  std::vector<double> correlation(static_cast<std::size_t>(lags) + 1, 0.0);
  if (samples.empty()) return correlation;
  const double mean = meanOf(samples);
  for (std::size_t lag = 0; lag < correlation.size(); ++lag)
    for (std::size_t k = 0; k + lag < samples.size(); ++k)
      correlation[lag] += (samples[k] - mean) * (samples[k + lag] - mean);
  const double power = correlation.front();
  for (double& c : correlation) c = power > 0.0 ? c / power : 0.0;
  return correlation;
}

}  // namespace evical
