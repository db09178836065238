#include "core/pipeline/session/idle_options.h"

#include "core/pipeline/session/calibration_options.h"
#include "tests/support/simulated_pass.h"
#include "tests/support/test_program.h"

using namespace evical;

class TestIdleOptions : public QObject {
  Q_OBJECT

 private slots:
  void searches_areIdle_whereTheOtherOneIsUsed() {
    Session session = test::simulatePass(0.5).session;
    QCOMPARE(whyIdle(session, "ring_vote.least_score"),
             std::string("ring votes are used only where normal flow finds no board"));
    session.options.front_end.detection.try_both = false;
    QCOMPARE(whyIdle(session, "ring_vote.least_score"),
             std::string("circles are looked for by normal flow alone"));
    QVERIFY(whyIdle(session, "normal_flow.fastest_px_s").empty());
    session.options.front_end.detection.method = CandidateSource::RingVote;
    QVERIFY(whyIdle(session, "ring_vote.least_score").empty());
    QVERIFY(!whyIdle(session, "normal_flow.fastest_px_s").empty());
  }

  void intrinsics_areIdle_whereTheyAreGiven() {
    Session session = test::simulatePass(0.5).session;
    QVERIFY(!whyIdle(session, "intrinsics.model").empty());
    session.cameras.front().intrinsics.reset();
    QVERIFY(whyIdle(session, "intrinsics.model").empty());
  }

  void optionsOfOtherCommands_areIdle() {
    Session session = test::simulatePass(0.5).session;
    for (const OptionRow& row : optionRows())
      for (const char* const group : {"check.", "maintain.", "egomotion.", "edge_slopes.", "blink."})
        if (row.name.starts_with(group)) QVERIFY2(!whyIdle(session, row.name).empty(), row.name.c_str());
    session.board_blinks = true;
    for (const OptionRow& row : optionRows())
      if (row.name.starts_with("blink.")) QVERIFY2(whyIdle(session, row.name).empty(), row.name.c_str());
  }

  void imus_decideAboutTheirs() {
    Session session = test::simulatePass(0.5).session;
    QVERIFY(whyIdle(session, "optimisation.priors.gyroscope_bias_sigma_rad_s").empty());
    QVERIFY(!whyIdle(session, "optimisation.priors.smooth_position_m_s2").empty());
    session.imus.clear();
    QCOMPARE(whyIdle(session, "optimisation.priors.gyroscope_bias_sigma_rad_s"),
             std::string("there is no IMU"));
    QVERIFY(whyIdle(session, "optimisation.priors.smooth_position_m_s2").empty());
  }

  // A rule whose option has another name by now would never be said.
  void everyRule_isOfAnOption() {
    Session session = test::simulatePass(0.5).session;
    int idle = 0;
    for (const OptionRow& row : optionRows()) idle += !whyIdle(session, row.name).empty();
    QVERIFY(idle > 20);
    for (const char* const name :
         {"frames.tag_border", "frames.markers", "optimisation.priors.gyroscope_rotation_sigma_deg",
          "optimisation.model.gyroscope_random_walk", "optimisation.priors.smooth_rotation_rad_s2"})
      QVERIFY2(!whyIdle(session, name).empty(), name);
    for (const char* const name :
         {"detection.method", "tracking.first_gate_px", "optimisation.solver.threads"})
      QVERIFY2(whyIdle(session, name).empty(), name);
  }
};

EVICAL_TEST(TestIdleOptions)
#include "tst_idle_options.moc"
