// Mirrored images and negated accelerations, which are the same data on a board that is its own mirror image:
// a wrong result is never ok, the true cause is named, and a repair is offered only if nothing else explains
// the data.
#include "core/base/error.h"
#include "core/geometry/projection_difference.h"
#include "core/geometry/so3.h"
#include "core/intrinsics/estimate_intrinsics.h"
#include "core/intrinsics/intrinsics_options.h"
#include "core/numerics/angles.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/report/report_options.h"
#include "tests/support/perturbations.h"
#include "tests/support/simulated_pass.h"
#include "tests/support/test_program.h"

#include <Eigen/Geometry>

namespace {

using namespace evical;
using test::SimulatedPass;

const char* nameOf(Mirroring how) {
  return kMirroringNames[static_cast<std::size_t>(how)];
}
constexpr Mirroring kAll[] = {Mirroring::X, Mirroring::Y, Mirroring::Transposed};

void negate(ImuData& imu) {
  for (ImuSample& sample : imu.samples) sample.specific_force_m_s2 *= -1.0;
}
void mirror(Mirroring how, std::size_t camera, SimulatedPass& rig) {
  test::mirrorImage(how, camera, false, rig.session, rig.detections);
}
// The session reverses a camera's image that is not mirrored.
void stateWrongly(Mirroring how, std::size_t camera, SimulatedPass& rig) {
  mirror(how, camera, rig);
  rig.session.cameras[camera].mirrored = how;
}
// The session's reading of the accelerometer, which has been applied to the samples.
void declareNegated(SessionImu& imu) {
  imu.accelerometer_axes = {-1, -2, -3};
}
void stateMount(SimulatedPass& rig, std::optional<double> sigma_deg) {
  KnownRotation mount{rig.truth.cameras.front().imu_from_camera.rotation};
  if (sigma_deg) mount.sigma = Eigen::Vector3d::Constant(kRadPerDeg * *sigma_deg);
  rig.session.cameras.front().prior.rotation = mount;
}

struct Outcome {
  QString failure, repair, reason;
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // of the first camera

  bool ok() const { return failure.isEmpty() && reason.isEmpty(); }
};

Outcome outcomeOf(const SimulatedPass& rig) {
  Outcome outcome;
  const auto textOf = [](const std::optional<Repair>& repair) {
    return repair ? QString::fromStdString(repair->text()) : QString();
  };
  try {
    const CalibrationRun run = calibrate(rig.session, rig.detections, RunContext{});
    if (run.result.status != CalibrationStatus::Ok)
      outcome.reason = QString::fromStdString(run.result.reason);
    outcome.repair = textOf(run.result.repair);
    outcome.rotation = run.result.state.cameras.front().reference_from_camera.rotation;
  } catch (const CalibrationError& error) {
    outcome.failure = error.what();
    outcome.repair = textOf(error.repair());
  }
  return outcome;
}

double errorOf_deg(const SimulatedPass& rig, const Outcome& outcome) {
  return kDegPerRad *
         rotationAngleBetween_rad(outcome.rotation, rig.truth.cameras.front().imu_from_camera.rotation);
}

// The text has all of these words.
#define VERIFY_NAMES(text, ...)                                                          \
  do {                                                                                   \
    const QString told = (text);                                                         \
    for (const char* const word : {__VA_ARGS__})                                         \
      QVERIFY2(told.contains(word), qPrintable(QString("'%1' in: %2").arg(word, told))); \
  } while (false)

class TestMirroredImages : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase() {
    single_ = rig("davis346_10s");
    QVERIFY(outcomeOf(single_).ok());
  }

  void mirroredOrNegated_isEitherOfBoth() {
    for (const Mirroring how : kAll) {
      SimulatedPass mirrored = single_;
      mirror(how, 0, mirrored);
      const Outcome outcome = outcomeOf(mirrored);
      VERIFY_NAMES(outcome.failure, "negated", "the image of left is mirrored", "readable");
      QCOMPARE(outcome.repair, QString());
    }
    SimulatedPass negated = single_;
    negate(negated.detections.imus.front());
    const Outcome outcome = outcomeOf(negated);
    VERIFY_NAMES(outcome.failure, "negated", "the image of left is mirrored", "readable");
    QCOMPARE(outcome.repair, QString());
  }

  // Gravity dominates the accelerations, so that their misfit is small: the sign of the scale is decisive. If
  // it is not clear, the result is not ok.
  void slowMotion_isNotOk() {
    for (const char* const scenario : {"slow", "small_motion"}) {
      SimulatedPass mirrored = rig(scenario);
      mirror(Mirroring::Y, 0, mirrored);
      const Outcome outcome = outcomeOf(mirrored);
      QVERIFY2(!outcome.ok(), scenario);
      QVERIFY2(!outcome.repair.contains("axes"), qPrintable(outcome.repair));
      if (!outcome.failure.isEmpty()) VERIFY_NAMES(outcome.failure, "negated", "mirrored");
      mirrored.session.cameras.front().mirrored = Mirroring::Y;
      const Outcome stated = outcomeOf(mirrored);
      QVERIFY2((stated.failure + stated.reason).startsWith("left: mirrored: y"),
               qPrintable(stated.failure + stated.reason));
      QCOMPARE(stated.repair, QString());
    }
  }

  // Two reflections are a rotation: the image is upside down, and the result is that of such a camera.
  void bothReflections_areARotation() {
    SimulatedPass turned = single_;
    mirror(Mirroring::X, 0, turned);
    mirror(Mirroring::Y, 0, turned);
    const Outcome outcome = outcomeOf(turned);
    QVERIFY2(outcome.ok(), qPrintable(outcome.failure + outcome.reason));
    const Eigen::Quaterniond half_turn(Eigen::AngleAxisd(kRadPerDeg * 180.0, Eigen::Vector3d::UnitZ()));
    const Eigen::Quaterniond truth = turned.truth.cameras.front().imu_from_camera.rotation;
    QVERIFY(rotationAngleBetween_rad(outcome.rotation, truth * half_turn) < 2e-3);
  }

  // With the cause known, the repair is right.
  void mountIsKnown() {
    const std::pair<Mirroring, const char*> kRepairs[] = {
        {Mirroring::X, "cameras.left.mirrored=x"},
        {Mirroring::Y, "cameras.left.mirrored=y"},
        {Mirroring::Transposed, "cameras.left.mirrored=transposed"}};
    for (const auto& [how, repair] : kRepairs) {
      SimulatedPass mirrored = single_;
      stateMount(mirrored, 5.0);
      mirror(how, 0, mirrored);
      const Outcome outcome = outcomeOf(mirrored);
      VERIFY_NAMES(outcome.failure, "left: the image is mirrored", "prior");
      QCOMPARE(outcome.repair, QString(repair));
    }
    for (const std::optional<double> sigma_deg : {std::optional(5.0), std::optional<double>()}) {
      SimulatedPass negated = single_;
      stateMount(negated, sigma_deg);
      negate(negated.detections.imus.front());
      const Outcome outcome = outcomeOf(negated);
      VERIFY_NAMES(outcome.failure, "left_imu: the accelerations are negated", "not mirrored");
      QCOMPARE(outcome.repair, QString("imus.left_imu.accelerometer_axes=-x,-y,-z"));
    }
    SimulatedPass given = single_;
    stateMount(given, {});
    mirror(Mirroring::Transposed, 0, given);
    VERIFY_NAMES(outcomeOf(given).failure, "mirrored", "given rotation", "180 deg");
  }

  void statedMirroring_leavesAccelerations() {
    SimulatedPass negated = single_;
    negated.session.cameras.front().mirrored = Mirroring::None;
    negate(negated.detections.imus.front());
    QCOMPARE(outcomeOf(negated).repair, QString("imus.left_imu.accelerometer_axes=-x,-y,-z"));
  }

  // A stated reversal may be a guess, so it does not show that accelerations are negated. It is named first.
  void wrongReversal_fails() {
    for (const Mirroring how : kAll) {
      SimulatedPass wrong = single_;
      stateWrongly(how, 0, wrong);
      const Outcome outcome = outcomeOf(wrong);
      QVERIFY2(
          outcome.failure.startsWith(QString("left: mirrored: %1 is wrong for left, or").arg(nameOf(how))),
          qPrintable(outcome.failure));
      VERIFY_NAMES(outcome.failure, "the accelerations of left_imu are negated", "remove the key mirrored");
      QCOMPARE(outcome.repair, QString());
      stateMount(wrong, 5.0);
      const Outcome mounted = outcomeOf(wrong);
      VERIFY_NAMES(mounted.failure, "left: mirrored:", "is wrong", "prior");
      QCOMPARE(mounted.repair, QString("cameras.left.mirrored=none"));
      stateMount(wrong, {});
      VERIFY_NAMES(outcomeOf(wrong).failure, "left: mirrored:", "is wrong, or the given rotation is",
                   "180 deg");
    }
  }

  void wrongReversalWithNegation_isDoubtful_unlessConfirmed() {
    SimulatedPass wrong = single_;
    stateWrongly(Mirroring::Y, 0, wrong);
    negate(wrong.detections.imus.front());
    declareNegated(wrong.session.imus.front());
    const Outcome misled = outcomeOf(wrong);
    QVERIFY(errorOf_deg(wrong, misled) > 179.0);
    QVERIFY2(misled.reason.startsWith("left: mirrored: y may be wrong"), qPrintable(misled.reason));
    VERIFY_NAMES(misled.reason, "the session also inverts the accelerations", "prior.cameras.left.rotation");
    QCOMPARE(misled.repair, QString());

    SimulatedPass right = single_;  // a mirrored image that was reversed, and an inverted accelerometer
    right.session.cameras.front().mirrored = Mirroring::Y;
    declareNegated(right.session.imus.front());
    VERIFY_NAMES(outcomeOf(right).reason, "mirrored: y may be wrong");
    stateMount(right, 5.0);
    Outcome confirmed = outcomeOf(right);
    QVERIFY2(confirmed.ok(), qPrintable(confirmed.failure + confirmed.reason));
    right.session.cameras.front().prior = {};
    right.session.imus.front().accelerometer_axes = kIdentityAxes;  // recorded accelerations confirm it
    confirmed = outcomeOf(right);
    QVERIFY2(confirmed.ok(), qPrintable(confirmed.failure + confirmed.reason));
  }

  void wrongReversalOfOneOfTwo_isNamed() {
    SimulatedPass stereo = rig("stereo_two_imus");
    stereo.session.imus.resize(1);
    stereo.detections.imus.resize(1);
    for (const std::size_t camera : {0U, 1U}) {
      SimulatedPass wrong = stereo;
      stateWrongly(Mirroring::X, camera, wrong);
      const QString name = QString::fromStdString(stereo.session.cameras[camera].name);
      const Outcome outcome = outcomeOf(wrong);
      QVERIFY2(outcome.failure.startsWith(name + ": mirrored: x is wrong"), qPrintable(outcome.failure));
      QCOMPARE(outcome.repair, QString("cameras.%1.mirrored=none").arg(name));
      wrong.session.imus.clear();
      wrong.detections.imus.clear();
      wrong.session.reference = stereo.session.cameras.front().name;
      const Outcome alone = outcomeOf(wrong);
      QVERIFY2(alone.failure.startsWith(name + ": either mirrored: x is wrong for " + name),
               qPrintable(alone.failure));
      wrong.session.cameras[1 - camera].mirrored = Mirroring::None;
      QCOMPARE(outcomeOf(wrong).repair, QString("cameras.%1.mirrored=none").arg(name));
    }
  }

  // Accelerations that are negated to make a mirrored camera fit do not give an ok result.
  void negationInTheSession_isDoubtful_unlessConfirmed() {
    SimulatedPass wrong = single_;
    mirror(Mirroring::X, 0, wrong);
    negate(wrong.detections.imus.front());
    declareNegated(wrong.session.imus.front());
    const Outcome misled = outcomeOf(wrong);
    QVERIFY(errorOf_deg(wrong, misled) > 179.0);
    VERIFY_NAMES(misled.reason, "left_imu: the session inverts the accelerations", "mirrored");
    QCOMPARE(misled.repair, QString());
    stateMount(wrong, 5.0);
    const Outcome contradicted = outcomeOf(wrong);
    VERIFY_NAMES(contradicted.failure + contradicted.reason, "mirrored in x", "prior");

    SimulatedPass right = single_;  // an accelerometer that measures gravity, and the session's reading of it
    right.session.imus.front().acceleration_unit = AccelerationUnit::MinusGravity;
    VERIFY_NAMES(outcomeOf(right).reason, "the session inverts the accelerations");
    right.session.cameras.front().mirrored = Mirroring::None;
    Outcome confirmed = outcomeOf(right);
    QVERIFY2(confirmed.ok(), qPrintable(confirmed.failure + confirmed.reason));
    right.session.cameras.front().mirrored.reset();
    stateMount(right, 5.0);
    confirmed = outcomeOf(right);
    QVERIFY2(confirmed.ok(), qPrintable(confirmed.failure + confirmed.reason));
    right.session.cameras.front().prior = {};
    right.session.imus.front().accelerometer_axes = {-1, -2, -3};  // twice: not inverted
    confirmed = outcomeOf(right);
    QVERIFY2(confirmed.ok(), qPrintable(confirmed.failure + confirmed.reason));
  }

  void oneOfTwoCameras_isNamed() {
    SimulatedPass stereo = rig("stereo_two_imus");
    stereo.session.imus.resize(1);
    stereo.detections.imus.resize(1);
    for (const std::size_t camera : {0U, 1U}) {
      SimulatedPass mirrored = stereo;
      mirror(Mirroring::X, camera, mirrored);
      const Outcome outcome = outcomeOf(mirrored);
      const std::string name = stereo.session.cameras[camera].name;
      QVERIFY2(outcome.failure.startsWith(QString::fromStdString(name + ": the image is mirrored")),
               qPrintable(outcome.failure));
      QCOMPARE(outcome.repair, QString());  // whether in x or in y is not known
      mirrored.session.imus.clear();
      mirrored.detections.imus.clear();
      mirrored.session.reference = stereo.session.cameras.front().name;
      VERIFY_NAMES(outcomeOf(mirrored).failure, "mirrored", "from behind", "left", "right");
      mirrored.session.cameras[1 - camera].mirrored = Mirroring::None;
      const Outcome stated = outcomeOf(mirrored);
      QVERIFY2(stated.failure.startsWith(QString::fromStdString(name + ": the image is mirrored")),
               qPrintable(stated.failure));
    }
    SimulatedPass both = stereo;  // as one driver does
    mirror(Mirroring::X, 0, both);
    mirror(Mirroring::X, 1, both);
    const Outcome outcome = outcomeOf(both);
    VERIFY_NAMES(outcome.failure, "negated", "the images of left, right are mirrored");
    QCOMPARE(outcome.repair, QString());
  }

  void camerasOfTwoKinds_confirmEachOther() {
    SimulatedPass hybrid = rig("hybrid_stereo");
    declareNegated(hybrid.session.imus.front());
    const Outcome confirmed = outcomeOf(hybrid);
    QVERIFY2(!confirmed.reason.contains("inverts"), qPrintable(confirmed.reason));
    QVERIFY2(confirmed.failure.isEmpty(), qPrintable(confirmed.failure));
    hybrid.session.imus.front().accelerometer_axes = kIdentityAxes;
    negate(hybrid.detections.imus.front());
    QVERIFY(outcomeOf(hybrid).repair.endsWith("accelerometer_axes=-x,-y,-z"));
  }

  // A lens alone has no motion to contradict it: it is that of the image that the driver delivers, or of the
  // reversed one.
  void lensAlone_isThatOfTheImage() {
    for (const Mirroring how : kAll) {
      SimulatedPass mirrored = single_;
      mirror(how, 0, mirrored);
      const CameraIntrinsics delivered = *mirrored.session.cameras.front().intrinsics;
      const IntrinsicsResult found =
          estimateIntrinsics({mirrored.session.board, delivered.resolution_px,
                              mirrored.detections.cameras.front(), delivered, std::nullopt},
                             *mirrored.session.options.intrinsics, RunContext{});
      QVERIFY2(projectionDifference(found.intrinsics, delivered).rms_px < 0.5, nameOf(how));
    }
  }

  void framesOfTheSensor_showTheDirection() {
    const SimulatedPass davis = rig("davis346_frames");
    for (const Mirroring how : {Mirroring::X, Mirroring::Y}) {
      SimulatedPass mirrored = davis;
      test::mirrorImage(how, 0, true, mirrored.session, mirrored.detections);
      const Outcome outcome = outcomeOf(mirrored);
      VERIFY_NAMES(outcome.failure, "left: the image is mirrored");
      QCOMPARE(outcome.repair, QString("cameras.left.mirrored=%1").arg(nameOf(how)));
      mirrored.session.cameras.front().mirrored = how;  // wrongly: it mirrors what was right
      const Outcome stated = outcomeOf(mirrored);
      VERIFY_NAMES(stated.failure, "left: mirrored:", "is wrong", "agree with");
      QCOMPARE(stated.repair, QString("cameras.left.mirrored=none"));
    }
  }

  void tags_areReadableInRightImagesOnly() {
    SimulatedPass boards = rig("two_boards");
    declareNegated(boards.session.imus.front());
    const Outcome confirmed = outcomeOf(boards);
    QVERIFY2(confirmed.ok(), qPrintable(confirmed.failure + confirmed.reason));
    boards.session.imus.front().accelerometer_axes = kIdentityAxes;
    SimulatedPass mirrored = boards;
    mirror(Mirroring::Y, 0, mirrored);
    QVERIFY2(outcomeOf(mirrored).failure.startsWith("events: the image is mirrored"),
             qPrintable(outcomeOf(mirrored).failure));
    mirrored.session.imus.clear();
    mirrored.detections.imus.clear();
    mirrored.session.reference = "events";
    VERIFY_NAMES(outcomeOf(mirrored).failure, "mirrored");
    negate(boards.detections.imus.front());
    const Outcome negated = outcomeOf(boards);
    VERIFY_NAMES(negated.failure, "accelerations are negated", "tags are readable");
    QVERIFY(negated.repair.endsWith("accelerometer_axes=-x,-y,-z"));
  }

  // One inverted axis of the accelerometer: no reading of the gyroscope repairs it.
  void leftHandedAccelerometer_hasNoRepair() {
    SimulatedPass rig = single_;
    for (ImuSample& sample : rig.detections.imus.front().samples) sample.specific_force_m_s2.z() *= -1.0;
    const Outcome outcome = outcomeOf(rig);
    VERIFY_NAMES(outcome.failure, "accelerometer's axes seem left-handed", "(x,y,-z)", "readable");
    QCOMPARE(outcome.repair, QString());
  }

  void secondImu_showsTheSign() {
    const SimulatedPass two = rig("stereo_two_imus");
    for (const std::size_t imu : {0U, 1U}) {
      SimulatedPass negated = two;
      negate(negated.detections.imus[imu]);
      const Outcome outcome = outcomeOf(negated);
      VERIFY_NAMES(outcome.failure, "accelerations are negated");
      QCOMPARE(outcome.repair,
               QString::fromStdString("imus." + two.session.imus[imu].name + ".accelerometer_axes=-x,-y,-z"));
    }
  }

 private:
  static SimulatedPass rig(const char* scenario) {
    constexpr double kDuration_s = 8.0;
    SimulatedPass simulated = test::simulatePass(kDuration_s, scenario);
    simulated.session.options.report.edit().split_half_check = false;  // not tested here
    return simulated;
  }

  SimulatedPass single_;
};

}  // namespace

EVICAL_TEST(TestMirroredImages)
#include "tst_mirrored_images.moc"
