// optimisation.threads also limits the libraries below the solver.
#include "core/optimisation/batch_optimiser.h"
#include "tests/core/optimisation/simulated_rig.h"
#include "tests/support/test_program.h"

#include <QDir>

#include <dlfcn.h>

namespace {

using namespace evical;

// OpenMP keeps its threads after their work.
qsizetype threadsHere() {
  return QDir("/proc/self/task").entryList(QDir::Dirs | QDir::NoDotAndDotDot).size();
}

class TestSolverThreads : public QObject {
  Q_OBJECT
 private slots:
  void oneThread_staysOne() {
    auto* const set = reinterpret_cast<void (*)(int)>(::dlsym(RTLD_DEFAULT, "omp_set_num_threads"));
    auto* const get = reinterpret_cast<int (*)()>(::dlsym(RTLD_DEFAULT, "omp_get_max_threads"));
    if (set == nullptr || get == nullptr) QSKIP("CHOLMOD is built without OpenMP");
    set(4);  // as on a machine with four processors
    test::RigOptions rig_options;
    rig_options.duration_s = 8.0;
    rig_options.imu_rate_hz = 200.0;
    const test::SimulatedRig rig = test::simulateRig(rig_options);
    OptimisationOptions options;
    options.threads = 1;
    options.max_iterations = 3;
    const qsizetype before = threadsHere();
    optimiseBatch(rig.input, test::disturbed(rig.truth, 5), options, RunContext{});
    QCOMPARE(threadsHere(), before);
    QCOMPARE(get(), 4);  // other users of OpenMP keep their threads
  }
};

}  // namespace

EVICAL_TEST(TestSolverThreads)
#include "tst_solver_threads.moc"
