#include "core/numerics/spectrum.h"

#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

using namespace evical;

namespace {

constexpr double kRate_hz = 1000.0;

std::vector<double> whiteNoise(double sigma, std::size_t count) {
  std::mt19937 generator(7);
  std::normal_distribution<double> normal(0.0, sigma);
  std::vector<double> samples(count);
  for (double& s : samples) s = normal(generator);
  return samples;
}

}  // namespace

class TestSpectrum : public QObject {
  Q_OBJECT

 private slots:
  void whiteNoise_hasItsDensityEverywhere() {
    constexpr double kSigma = 0.02;
    const NoiseSpectrum spectrum = noiseSpectrum(whiteNoise(kSigma, 200'000), kRate_hz, 512);
    QCOMPARE(spectrum.frequency_hz.size(), std::size_t(256));
    QCOMPARE(spectrum.frequency_hz.back(), 0.5 * kRate_hz);
    const double given = kSigma / std::sqrt(kRate_hz);
    // Subtracting the mean affects the first two.
    for (std::size_t k = 2; k + 1 < spectrum.density.size(); ++k)
      QVERIFY2(std::abs(spectrum.density[k] / given - 1.0) < 0.25,
               qPrintable(QString::number(spectrum.density[k])));
  }

  void sine_standsOutAtItsFrequency() {
    std::vector<double> samples = whiteNoise(0.1, 20'000);
    for (std::size_t k = 0; k < samples.size(); ++k)
      samples[k] += 5.0 + std::sin(2.0 * std::numbers::pi * 125.0 * static_cast<double>(k) / kRate_hz);
    const NoiseSpectrum spectrum = noiseSpectrum(samples, kRate_hz, 512);
    const auto peak = std::max_element(spectrum.density.begin(), spectrum.density.end());
    QVERIFY(std::abs(spectrum.frequency_hz[static_cast<std::size_t>(peak - spectrum.density.begin())] -
                     125.0) < 2.0);
  }

  void tooFewSamples_haveNoSpectrum() {
    QVERIFY(noiseSpectrum(whiteNoise(1.0, 100), kRate_hz, 512).density.empty());
  }

  void autocorrelation_ofWhiteNoise_isOneAndThenNothing() {
    const std::vector<double> correlation = autocorrelation(whiteNoise(1.0, 100'000), 20);
    QCOMPARE(correlation.size(), std::size_t(21));
    QCOMPARE(correlation.front(), 1.0);
    for (std::size_t lag = 1; lag < correlation.size(); ++lag) QVERIFY(std::abs(correlation[lag]) < 0.015);
  }

  void autocorrelation_ofSmoothedNoise_fallsAsItsFilterSays() {
    constexpr double kKept = 0.8;  // share of the previous sample
    std::vector<double> samples = whiteNoise(1.0, 200'000);
    for (std::size_t k = 1; k < samples.size(); ++k) samples[k] += kKept * samples[k - 1];
    const std::vector<double> correlation = autocorrelation(samples, 5);
    for (std::size_t lag = 1; lag < correlation.size(); ++lag)
      QVERIFY(std::abs(correlation[lag] - std::pow(kKept, static_cast<double>(lag))) < 0.02);
  }

  void autocorrelation_ofAConstant_isZero() {
    QCOMPARE(autocorrelation(std::vector<double>(10, 3.0), 2), std::vector<double>(3, 0.0));
    QCOMPARE(autocorrelation({}, 2), std::vector<double>(3, 0.0));
  }
};

EVICAL_TEST(TestSpectrum)
#include "tst_spectrum.moc"
