#include "core/numerics/solver_stop.h"

#include "tests/support/test_program.h"

#include <ceres/iteration_callback.h>

using namespace evical;

class TestSolverStop : public QObject {
  Q_OBJECT

 private slots:
  void callback_abortsOnceItIsAskedToStop() {
    std::stop_source source;
    const std::unique_ptr<ceres::IterationCallback> callback = stopCallback(source.get_token());
    const ceres::IterationSummary summary{};
    QCOMPARE((*callback)(summary), ceres::SOLVER_CONTINUE);
    source.request_stop();
    QCOMPARE((*callback)(summary), ceres::SOLVER_ABORT);
  }

  void callback_ofATokenThatNobodyHoldsGoesOn() {
    const ceres::IterationSummary summary{};
    QCOMPARE((*stopCallback({}))(summary), ceres::SOLVER_CONTINUE);
  }
};

EVICAL_TEST(TestSolverStop)
#include "tst_solver_stop.moc"
