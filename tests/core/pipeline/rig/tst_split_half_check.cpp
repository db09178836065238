#include "core/base/time.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/rig/split_half_check.h"
#include "core/report/report_options.h"
#include "tests/support/simulated_pass.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

using namespace evical;
using namespace evical::test;

class TestSplitHalfCheck : public QObject {
  Q_OBJECT

  SimulatedPass simulated_;
  CalibrationRun run_;

  CalibrationInput input() const {
    CalibrationInput all;
    all.start_ns = run_.detections.start_ns;
    all.board = simulated_.session.board;
    all.cameras = {
        {simulated_.session.cameras[0].name, run_.detections.lenses[0], run_.detections.cameras[0]}};
    all.imus = run_.detections.imus;
    return all;
  }
  static std::size_t circles(const CalibrationInput& half) {
    std::size_t count = 0;
    for (const BoardView& view : half.cameras[0].observations.views) count += view.circles.size();
    return count;
  }

 private slots:
  void initTestCase() {
    simulated_ = simulatePass(8.0);
    run_ = calibrate(simulated_.session, simulated_.detections, {});
  }

  void halves_shareNothing() {
    const CalibrationInput all = input();
    const std::array halves = {halfOf(all, run_.result.state, 1.0, 0),
                               halfOf(all, run_.result.state, 1.0, 1)};
    const std::size_t samples = all.imus[0].samples.size();
    // Except samples at a border, whose specific force belongs to one half and whose rate to the other.
    const std::size_t taken = halves[0].imus[0].samples.size() + halves[1].imus[0].samples.size();
    QVERIFY2(taken <= samples && 1000 * taken > 998 * samples, qPrintable(QString::number(taken)));
    const auto timesOf = [&](const CalibrationInput& half) {
      std::set<std::int64_t> times;
      for (const ImuSample& sample : half.imus[0].samples) times.insert(sample.time_ns);
      return times;
    };
    const std::set<std::int64_t> even = timesOf(halves[0]), odd = timesOf(halves[1]);
    for (const std::int64_t time_ns : even) QVERIFY(odd.count(time_ns) == 0);
    const double share = static_cast<double>(even.size()) / static_cast<double>(samples);
    QVERIFY2(share > 0.4 && share < 0.6, qPrintable(QString::number(share)));
    const std::size_t together = circles(halves[0]) + circles(halves[1]);
    QVERIFY(together <= circles(all));
    QVERIFY2(10 * together > 9 * circles(all), qPrintable(QString::number(together)));
  }

  void circles_areWhereTheSamplesOfTheirHalfAre() {
    const CalibrationInput all = input();
    const std::array halves = {halfOf(all, run_.result.state, 1.0, 0),
                               halfOf(all, run_.result.state, 1.0, 1)};
    for (const CalibrationInput& half : halves) {
      for (const BoardView& view : half.cameras[0].observations.views) {
        for (const CircleObservation& circle : view.circles) {
          const double time_s = circle.time_s + run_.result.state.cameras[0].time_offset_s;
          double nearest_s = 1e9;
          for (const ImuSample& sample : half.imus[0].samples)
            nearest_s = std::min(nearest_s, std::abs(secondsSince(half.start_ns, sample.time_ns) - time_s));
          QVERIFY2(nearest_s < 0.005, qPrintable(QString::number(nearest_s)));
        }
        if (&view - half.cameras[0].observations.views.data() > 20) break;  // enough of them
      }
    }
  }

  void goodRecording_differsByAboutOneSigma() {
    QVERIFY(run_.result.split_half_check.has_value());
    const SplitHalfCheck& validation = *run_.result.split_half_check;
    QVERIFY2(validation.failure.empty(), validation.failure.c_str());
    QVERIFY(validation.windows[0] > 20 && validation.windows[1] > 20);
    QVERIFY(validation.quantities.size() > 12);
    for (const char* name : {"left.edge_localisation_bias", "left.slow_edge_localisation_bias"})
      QVERIFY2(
          std::any_of(validation.quantities.begin(), validation.quantities.end(),
                      [&](const QuantityDifference& each) { return each.name == name && each.sigma > 0.0; }),
          name);
    QVERIFY2(validation.rms_sigmas > 0.2 && validation.rms_sigmas < 2.0,
             qPrintable(QString::number(validation.rms_sigmas)));
  }

  void camerasAlone_areComparedWithoutGravity() {
    const SimulatedPass stereo = simulatePass(8.0, "stereo");
    const CalibrationRun run = calibrate(stereo.session, stereo.detections, {});
    QVERIFY(run.result.split_half_check.has_value());
    const SplitHalfCheck& validation = *run.result.split_half_check;
    QVERIFY2(validation.failure.empty(), validation.failure.c_str());
    QVERIFY(validation.windows[0] > 20 && validation.windows[1] > 20);
    int of_the_other_camera = 0;
    for (const QuantityDifference& each : validation.quantities) {
      QVERIFY2(each.name.find("gravity") == std::string::npos, each.name.c_str());
      of_the_other_camera += each.sigma > 0.0 ? 1 : 0;
    }
    QVERIFY(of_the_other_camera >= 7);
    QVERIFY2(validation.rms_sigmas > 0.02 && validation.rms_sigmas < 2.0,
             qPrintable(QString::number(validation.rms_sigmas)));
  }

  // Given quantities are the same in both halves; their difference is zero and says nothing about the sigmas.
  void givenValues_areHeldInBothHalves() {
    Session session = simulated_.session;
    const CameraState& found = run_.result.state.cameras[0];
    session.cameras[0].prior.time_offset = KnownNumber{found.time_offset_s};
    session.cameras[0].prior.translation = KnownVector{found.reference_from_camera.translation_m};
    session.options.optimisation.edit().free_imu_intrinsics = false;
    const CalibrationRun run = calibrate(session, simulated_.detections, {});
    QVERIFY(run.result.state.cameras[0].time_offset_s == found.time_offset_s);
    QCOMPARE(run.result.uncertainty.given.size(), std::size_t{5});
    const std::string note = "given, not estimated: left.translation, left.time_offset";
    QVERIFY(std::any_of(run.result.notes.begin(), run.result.notes.end(),
                        [&](const std::string& each) { return each.starts_with(note); }));
    const SplitHalfCheck& validation = *run.result.split_half_check;
    QVERIFY2(validation.failure.empty(), validation.failure.c_str());
    int held = 0;
    for (const QuantityDifference& each : validation.quantities) {
      QVERIFY(std::isfinite(each.normalised()));
      if (each.sigma > 0.0) continue;
      ++held;
      QVERIFY2(each.difference == 0.0, each.name.c_str());
    }
    QVERIFY2(held == 4 + 12 + 1, qPrintable(QString::number(held)));
    QVERIFY2(validation.rms_sigmas > 0.2 && validation.rms_sigmas < 2.5,
             qPrintable(QString::number(validation.rms_sigmas)));
  }

  void timeOffsetsThatAreNotFree_areNotLookedFor() {
    Session session = simulated_.session;
    session.options.optimisation.edit().free_time_offsets = false;
    session.options.report.edit().split_half_check = false;
    const CalibrationRun run = calibrate(session, simulated_.detections, {});
    QVERIFY(run.result.state.cameras[0].time_offset_s == 0.0);
    QVERIFY(std::abs(run_.result.state.cameras[0].time_offset_s) > 1e-3);
    QVERIFY(run.result.status == CalibrationStatus::Doubtful);
    QVERIFY2(run.result.reason.find("left.time_offset") != std::string::npos, run.result.reason.c_str());
  }

  void cameraThatSlipped_isSeen() {
    // In every second block from the third on, the camera sees the board with an offset of 1 px: no single
    // pose fits both halves, nor a single lens.
    const CalibrationInput all = input();
    CalibrationInput slipped = all;
    const double block_s = run_.result.split_half_check->block_s;
    const double start_s = run_.result.state.world_from_imu_rotation.start_s;
    for (BoardView& view : slipped.cameras[0].observations.views)
      if (static_cast<int>((view.time_s - start_s) / block_s) % 2 == 1)
        for (CircleObservation& circle : view.circles) circle.centre_px.x() += 1.0;
    const SplitHalfCheck validation =
        checkHalves(slipped, run_.result.state, *simulated_.session.options.optimisation, block_s, {});
    QVERIFY2(validation.failure.empty(), validation.failure.c_str());
    double largest = 0.0;
    for (const QuantityDifference& each : validation.quantities)
      if (each.name.find("rotation") != std::string::npos ||
          each.name.find("principal_point") != std::string::npos)
        largest = std::max(largest, std::abs(each.normalised()));
    QVERIFY2(largest > 5.0, qPrintable(QString::number(largest)));
  }

  void switchedOff_costsNothing() {
    Session session = simulated_.session;
    session.options.report.edit().split_half_check = false;
    const CalibrationRun without = calibrate(session, simulated_.detections, {});
    QVERIFY(!without.result.split_half_check.has_value());
    QCOMPARE(without.result.timing.split_half_check_s, 0.0);
    QVERIFY(without.result.state.cameras[0].reference_from_camera.translation_m ==
            run_.result.state.cameras[0].reference_from_camera.translation_m);
  }

  void boardInOneHalfOnly_isSaid() {
    CalibrationInput half = input();
    auto& views = half.cameras[0].observations.views;
    const double block_s = run_.result.split_half_check->block_s;
    const double start_s = run_.result.state.world_from_imu_rotation.start_s;
    std::erase_if(views, [&](const BoardView& view) { return view.time_s > start_s + 0.8 * block_s; });
    const SplitHalfCheck validation =
        checkHalves(half, run_.result.state, *simulated_.session.options.optimisation, block_s, {});
    QVERIFY(QString::fromStdString(validation.failure).contains("is not visible in one half"));
    QVERIFY(validation.quantities.empty());
  }
};

EVICAL_TEST(TestSplitHalfCheck)
#include "tst_split_half_check.moc"
