// Sums of noise with and without autocorrelation, as statistics of windows.
#include "core/maintenance/pair_tracking.h"
#include "tests/support/random_vector.h"
#include "tests/support/test_program.h"

#include <Eigen/Core>

#include <cmath>
#include <random>
#include <vector>

using namespace evical;

class TestNoiseColour : public QObject {
  Q_OBJECT

  // Windows of noise of unit variance that keeps this part of the window before.
  static NoiseAutocorrelation colourOf(double kept, std::size_t windows) {
    std::mt19937 generator(11);
    std::normal_distribution<double> normal;
    const double fresh = std::sqrt(1.0 - kept * kept);
    std::vector<Eigen::Vector3d> noise;
    const auto draw = [&] { return normal(generator); };
    Eigen::Vector3d now = test::randomVector<3>(draw);
    for (std::size_t k = 0; k < windows; ++k) {
      noise.push_back(now);
      now = kept * now + fresh * test::randomVector<3>(draw);
    }
    constexpr std::size_t kBefore = 16;
    const auto meanOf = [&](std::size_t first, std::size_t count) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (std::size_t k = first; k < first + count; ++k) sum += noise[k];
      return Eigen::Vector3d(sum / static_cast<double>(count));
    };
    ColourStatistics statistics(3, kBefore);
    for (std::size_t l = 0; l < ColourStatistics::kLengths.size(); ++l) {
      const std::size_t length = ColourStatistics::kLengths[l];
      const double variance = 1.0 / static_cast<double>(length) + 1.0 / static_cast<double>(kBefore);
      for (std::size_t from = kBefore; from + length <= windows; ++from) {
        const Eigen::Vector3d apart = meanOf(from, length) - meanOf(from - kBefore, kBefore);
        statistics.add(l, apart.squaredNorm() / variance);
      }
    }
    return statistics.colour();
  }

 private slots:
  void white_isNotWider() {
    const NoiseAutocorrelation colour = colourOf(0.0, 4000);
    for (const std::size_t n : {std::size_t{1}, std::size_t{5}, std::size_t{25}})
      QVERIFY2(colour.of(n) < 1.15, qPrintable(QString::number(colour.of(n))));
  }

  // With first-order autocorrelation p, the variance of sums is (1 + p) / (1 - p) times as large in the
  // limit; if it lasts longer than a window, as here, up to a quarter of that is missed.
  void memory_isFound() {
    const NoiseAutocorrelation colour = colourOf(0.5, 4000);
    QVERIFY2(colour.settled > 2.2 && colour.settled < 3.4, qPrintable(QString::number(colour.settled)));
    QVERIFY(std::abs(colour.of(2) - 1.5) < 0.3);
    QVERIFY(colour.of(1) < colour.of(4) && colour.of(4) < colour.of(25));
  }

  void few_tellNothing() {
    const NoiseAutocorrelation colour = colourOf(0.9, 20);
    QCOMPARE(colour.of(25), 1.0);
  }
};

EVICAL_TEST(TestNoiseColour)
#include "tst_noise_autocorrelation.moc"
