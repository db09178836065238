#include "core/pipeline/session/idle_options.h"

#include "core/frontend/detection_options.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/session/calibration_options.h"
#include "tests/support/simulated_pass.h"
#include "tests/support/test_program.h"

#include <algorithm>

using namespace evical;

namespace {

std::string whyIdle(const Session& session, const std::string& name, const StreamTypes& types = {}) {
  const std::vector<OptionRow> rows = optionRows();
  const auto row = std::ranges::find(rows, name, &OptionRow::name);
  return row == rows.end() ? "no such option" : evical::whyIdle(session, *row, types);
}

}  // namespace

class TestIdleOptions : public QObject {
  Q_OBJECT

 private slots:
  void searches_areIdle_whereTheOtherOneIsUsed() {
    Session session = test::simulatePass(0.5).session;
    QCOMPARE(whyIdle(session, "tuning.ring_vote.min_score"),
             std::string("ring votes are used only if normal flow does not find the board"));
    session.options.front_end.edit().detection.try_both = false;
    QCOMPARE(whyIdle(session, "tuning.ring_vote.min_score"),
             std::string("circles are detected only by normal flow"));
    QVERIFY(whyIdle(session, "tuning.normal_flow.fastest_px_s").empty());
    session.options.front_end.edit().detection.method = CandidateSource::RingVote;
    QVERIFY(whyIdle(session, "tuning.ring_vote.min_score").empty());
    QVERIFY(!whyIdle(session, "tuning.normal_flow.fastest_px_s").empty());
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
        if (nameInTables(row.name).starts_with(group))
          QVERIFY2(!whyIdle(session, row.name).empty(), row.name.c_str());
    session.board_blinks = true;
    for (const OptionRow& row : optionRows())
      if (nameInTables(row.name).starts_with("blink."))
        QVERIFY2(whyIdle(session, row.name).empty(), row.name.c_str());
  }

  void streams_decideAboutFramesAndEvents() {
    const Session session = test::simulatePass(0.5).session;
    const std::string stream = session.cameras.front().stream;
    QVERIFY(whyIdle(session, "frames.rate_hz").empty() && whyIdle(session, "grid.min_circles").empty());
    const StreamTypes events{{stream, StreamType::Events}}, frames{{stream, StreamType::Frames}};
    QCOMPARE(whyIdle(session, "frames.rate_hz", events), std::string("no camera records frames"));
    QVERIFY(whyIdle(session, "grid.min_circles", events).empty());
    QCOMPARE(whyIdle(session, "grid.min_circles", frames), std::string("no camera records events"));
    QVERIFY(whyIdle(session, "frames.rate_hz", frames).empty());
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

  // A rule whose option has been renamed would never apply.
  void everyRule_isOfAnOption() {
    Session session = test::simulatePass(0.5).session;
    int idle = 0;
    for (const OptionRow& row : optionRows()) idle += !whyIdle(session, row.name).empty();
    QVERIFY(idle > 20);
    session.options.optimisation.edit().gyroscope_rotation = Estimated::No;
    session.options.optimisation.edit().bias_model = BiasModel::Constant;
    for (const char* const name :
         {"frames.tag_border", "frames.markers", "optimisation.priors.gyroscope_rotation_sigma_deg",
          "optimisation.model.gyroscope_random_walk", "optimisation.priors.smooth_rotation_rad_s2"})
      QVERIFY2(!whyIdle(session, name).empty(), name);
    for (const char* const name :
         {"detection.method", "tuning.tracking.first_gate_px", "optimisation.solver.threads"})
      QVERIFY2(whyIdle(session, name).empty(), name);
  }
};

EVICAL_TEST(TestIdleOptions)
#include "tst_idle_options.moc"
