// Calibrates a session's sensors and prints the poses of the cameras with sigmas: calibrate SESSION.
#include "core/base/error.h"
#include "core/base/progress.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/session/session.h"

#include <cstdio>
#include <string>

using namespace evical;

namespace {

// Prints one line per stage, without fractions of a stage and log lines.
class StageNames : public ProgressSink {
 public:
  void stageStarted(const ProgressStage& stage) override { std::printf("%s\n", stage.text().c_str()); }
  void stageProgress(double) override {}
  void log(LogLevel, std::string_view) override {}
};

void printCamera(const std::string& name, const CameraState& camera, const CameraUncertainty& sigma) {
  const Eigen::Vector3d& at = camera.reference_from_camera.translation_m;
  const Eigen::Quaterniond& turn = camera.reference_from_camera.rotation;
  std::printf("%s\n", name.c_str());
  std::printf("  translation %8.4f %8.4f %8.4f m, sigma %.4f %.4f %.4f\n", at.x(), at.y(), at.z(),
              sigma.translation_std_m.x(), sigma.translation_std_m.y(), sigma.translation_std_m.z());
  std::printf("  rotation    %8.5f %8.5f %8.5f %8.5f (x y z w)\n", turn.x(), turn.y(), turn.z(), turn.w());
  std::printf("  time offset %8.3f ms, sigma %.3f\n", 1e3 * camera.time_offset_s,
              1e3 * sigma.time_offset_std_s);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "calibrate SESSION\n");
    return 2;
  }
  try {
    Session session = readSession(argv[1]);
    setOption(session.options, "report.split_half_check",
              "false");  // options by the names of `evical options`
    StageNames progress;
    const CalibrationResult result = calibrate(session, RunContext{progress}).result;
    std::printf("%s%s\n",
                result.status == CalibrationStatus::Ok ? "ok" : "doubtful: ", result.reason.c_str());
    for (std::size_t i = 0; i < session.cameras.size(); ++i)
      printCamera(session.cameras[i].name, result.state.cameras[i], result.uncertainty.cameras[i]);
    return 0;
  } catch (const CalibrationError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
