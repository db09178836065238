// Noise of a signal over frequency and over time: P. Welch, The use of fast Fourier transform for the
// estimation of power spectra, 1967. Samples are assumed to be equidistant in time.
#pragma once

#include <span>
#include <vector>

namespace evical {

// Unit of IMUs' noise densities: white noise of sigma s, sampled at r Hz, has s / sqrt(r) at every frequency.
struct NoiseSpectrum {
  std::vector<double> frequency_hz;  // from the first above zero up to half the rate
  std::vector<double> density;       // the samples' unit per sqrt(Hz)
};

// Mean over segments that overlap by half, each without its mean and tapered by Hann's window. Empty for
// fewer than `segment` samples; `segment` is even.
NoiseSpectrum noiseSpectrum(std::span<const double> samples, double rate_hz, int segment);

// Autocorrelation for lags 0, 1, ... `lags`, without the mean; 1 at lag 0. Zeros if all samples are the same.
std::vector<double> autocorrelation(std::span<const double> samples, int lags);

}  // namespace evical
