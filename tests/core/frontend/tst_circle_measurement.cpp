#include "core/frontend/circle_measurement.h"

#include "tests/core/frontend/synthetic_bursts.h"
#include "tests/support/test_program.h"

#include <set>

namespace {

using namespace evical;
using namespace evical::test;

constexpr double kCircleMeasurementHalfWindow_s = 0.02;

std::vector<CircleObservation> measure(const MovingBoard& moving, const std::vector<EdgeCrossing>& bursts,
                                       double half_slot_s) {
  const SyntheticWindow synthetic(bursts);
  const TrackingOptions options;
  const auto motion =
      fitBoardMotion(synthetic.window, moving.motionAt(0.0), moving.scene(), options.first_gate_px, options);
  if (!motion) return {};
  return measureCircles(synthetic.window, *motion, moving.scene(), {half_slot_s}, options);
}

class TestCircleMeasurement : public QObject {
  Q_OBJECT
 private slots:
  void withoutNoise_centresAreExact();
  void errors_matchCovariance();
  void burstsOutsideTheSlot_doNotCount();
  void circlesWithoutBursts_areLeftOut();
  void time_isThatOfTheBursts();
};

void TestCircleMeasurement::withoutNoise_centresAreExact() {
  std::mt19937 random(30);
  const MovingBoard moving;
  const std::vector<CircleObservation> circles = measure(
      moving, burstsOf(moving, kCircleMeasurementHalfWindow_s, 0.0, random), kCircleMeasurementHalfWindow_s);
  QCOMPARE(static_cast<int>(circles.size()), moving.board.pointCount());
  for (const CircleObservation& circle : circles) {
    const OutlineImage truth = moving.imageAt(circle.circle, circle.time_s);
    QVERIFY2((circle.centre_px - truth.centre_px).norm() < 0.02,
             qPrintable(QString::number((circle.centre_px - truth.centre_px).norm())));
    QVERIFY((circle.velocity_px_s - moving.velocityAt(circle.circle, circle.time_s)).norm() < 1.0);
    QVERIFY(std::abs(circle.semi_axes_px.x() - truth.max_radius_px) < 0.05);
    QVERIFY(circle.semi_axes_px.x() >= circle.semi_axes_px.y());
  }
}

void TestCircleMeasurement::errors_matchCovariance() {
  double chi2 = 0.0;
  int count = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    std::mt19937 random(40 + seed);
    MovingBoard moving;
    moving.angles_rad.z() = 0.5 * seed;
    const std::vector<CircleObservation> circles =
        measure(moving, burstsOf(moving, kCircleMeasurementHalfWindow_s, 0.15, random),
                kCircleMeasurementHalfWindow_s);
    for (const CircleObservation& circle : circles) {
      const Eigen::Vector2d error = circle.centre_px - moving.imageAt(circle.circle, circle.time_s).centre_px;
      chi2 += error.dot(circle.covariance_px2.inverse() * error);
      ++count;
    }
  }
  QVERIFY(count > 400);
  // Two degrees of freedom per circle. The noise is Gaussian and white, as the covariance assumes.
  const double normalised = chi2 / (2.0 * count);
  QVERIFY2(normalised > 0.7 && normalised < 1.4, qPrintable(QString::number(normalised)));
}

void TestCircleMeasurement::burstsOutsideTheSlot_doNotCount() {
  std::mt19937 random(31);
  const MovingBoard moving;
  const std::vector<EdgeCrossing> bursts = burstsOf(moving, kCircleMeasurementHalfWindow_s, 0.1, random);
  const auto sum = [](const std::vector<CircleObservation>& circles) {
    int events = 0;
    for (const CircleObservation& circle : circles) events += circle.events;
    return events;
  };
  const int whole = sum(measure(moving, bursts, kCircleMeasurementHalfWindow_s)),
            half = sum(measure(moving, bursts, 0.5 * kCircleMeasurementHalfWindow_s));
  QVERIFY2(half > 0.4 * whole && half < 0.6 * whole, qPrintable(QString("%1 of %2").arg(half).arg(whole)));
}

void TestCircleMeasurement::circlesWithoutBursts_areLeftOut() {
  std::mt19937 random(32);
  const MovingBoard moving;
  std::vector<EdgeCrossing> bursts = burstsOf(moving, kCircleMeasurementHalfWindow_s, 0.1, random);
  const std::set<int> hidden = {0, 17, 43};
  std::erase_if(bursts, [&](const EdgeCrossing& burst) {
    return std::any_of(hidden.begin(), hidden.end(), [&](int i) {
      const OutlineImage image = moving.imageAt(i, 0.0);
      return (Eigen::Vector2d(burst.x_px, burst.y_px) - image.centre_px).norm() < image.max_radius_px + 3.0;
    });
  });
  std::set<int> found;
  for (const CircleObservation& circle : measure(moving, bursts, kCircleMeasurementHalfWindow_s))
    found.insert(circle.circle);
  QCOMPARE(static_cast<int>(found.size()), moving.board.pointCount() - 3);
  for (const int i : hidden) QVERIFY(!found.contains(i));
}

void TestCircleMeasurement::time_isThatOfTheBursts() {
  std::mt19937 random(33);
  const MovingBoard moving;
  std::vector<EdgeCrossing> bursts = burstsOf(moving, kCircleMeasurementHalfWindow_s, 0.1, random);
  std::erase_if(bursts, [](const EdgeCrossing& burst) { return burst.time_ns < -5'000'000; });
  const std::vector<CircleObservation> circles = measure(moving, bursts, kCircleMeasurementHalfWindow_s);
  QVERIFY(circles.size() > 30);
  for (const CircleObservation& circle : circles) QVERIFY(circle.time_s > 0.002 && circle.time_s < 0.015);
}

}  // namespace

EVICAL_TEST(TestCircleMeasurement)
#include "tst_circle_measurement.moc"
