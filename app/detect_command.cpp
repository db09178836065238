#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/output.h"
#include "app/session_arguments.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/data/calibration_observer.h"
#include "core/frontend/board_tracker.h"
#include "core/frontend/detection_options.h"
#include "core/frontend/stage_image_writer.h"
#include "core/pipeline/detection/board_size_check.h"
#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/runs/result_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace evical {
namespace {

struct DetectArguments : SessionArguments {
  bool images = false;
  int every_nth = 10;
};

// Draws windows of every camera, into one folder per camera.
class ImageWriters final : public CalibrationObserver {
 public:
  ImageWriters(const DetectArguments& arguments, const Session& session, std::filesystem::path output)
      : arguments_(arguments), session_(session), output_(std::move(output)) {}

  FrontEndObserver* windowObserver(std::size_t camera, const BoardTracker& tracker) override {
    const std::filesystem::path below = std::filesystem::path("images") / foldersOfCameras(session_)[camera];
    const std::filesystem::path folder = output_ / below;
    makeFolderWithin(output_, below);
    writers_.push_back(std::make_unique<StageImageWriter>(folder, arguments_.every_nth, tracker.scene(),
                                                          &tracker.history(), *session_.options.front_end));
    return writers_.back().get();
  }

 private:
  const DetectArguments& arguments_;
  const Session& session_;
  std::filesystem::path output_;
  std::vector<std::unique_ptr<StageImageWriter>> writers_;
};

// `has_lens`: the camera's intrinsics were used.
void printOutcome(const BoardObservations& camera, bool has_lens) {
  print("{}: {} {}, board in {} of {} {}\n", camera.camera, camera.events, measurementsOf(camera.kind),
        camera.views.size(), camera.windows.size(), camera.kind == CameraKind::Events ? "windows" : "frames");
  std::vector<int> counts(kWindowOutcomeCount, 0);
  for (const WindowReport& window : camera.windows) ++counts[static_cast<std::size_t>(window.outcome)];
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (counts[k] > 0) print("  {:6} {}\n", counts[k], windowOutcomeName(static_cast<WindowOutcome>(k)));
  }
  const auto countOf = [&](WindowOutcome outcome) { return counts[static_cast<std::size_t>(outcome)]; };
  if (camera.kind != CameraKind::Events || has_lens) return;
  const bool other_tags = countOf(WindowOutcome::OtherPattern) > countOf(WindowOutcome::Complete);
  if (other_tags || countOf(WindowOutcome::Partial) > countOf(WindowOutcome::Complete))
    print(
        "  Without intrinsics, lens distortion {}. `evical intrinsics` and `evical calibrate` calibrate the "
        "lens first, and then find the board more often.\n",
        other_tags ? "bends the board, and its tags may seem to be others"
                   : "hides points near the border of the image");
}

void detectIn(const Session& session, const std::filesystem::path& output, const DetectArguments& arguments,
              const std::stop_token& stop) {
  Console console(arguments.quiet);
  console.announceReplacement(output, {"detections.yaml"});
  const NewFolder folder(output);
  ImageWriters images(arguments, session, output);
  const RunContext context{console, stop, arguments.images ? &images : nullptr};
  console.stageStarted(nameOf(CalibrationStage::Detect));
  const DetectionResult detections = readAndDetect(session, context);
  for (const RecordingFault& fault : detections.faults) console.log(LogLevel::Warning, fault.text);
  writeDetectionFiles(output, session, detections, console.logText());
  console.stageStarted("done");
  for (std::size_t k = 0; k < detections.cameras.size(); ++k)
    printOutcome(detections.cameras[k], detections.lenses[k].detection_intrinsics.has_value());
}

// Several recordings get one folder each, by name, numbered if names repeat.
int run(const DetectArguments& arguments) {
  const Session session = sessionFrom(arguments);
  const std::stop_token stop = stopOnSignals();
  std::vector<std::filesystem::path> recordings = session.more_recordings;
  recordings.insert(recordings.begin(), session.recording);
  std::map<std::string, int> taken;
  for (const std::filesystem::path& recording : recordings) {
    Session one = session;
    one.recording = recording;
    one.more_recordings.clear();
    std::filesystem::path output = arguments.output;
    if (recordings.size() > 1) {
      const std::string name = recording.stem().string();
      const int number = ++taken[name];
      output /= number == 1 ? name : fmt::format("{}_{}", name, number);
      print("{}\n", recording.string());
    }
    detectIn(one, output, arguments, stop);
  }
  return kDone;
}

}  // namespace

void addDetectCommand(Command& app, int& exit_code) {
  auto arguments = std::make_shared<DetectArguments>();
  Command command = app.command("detect", "Detect the board only, without a calibration");
  addSessionArguments(command, *arguments);
  command.flag("--images", arguments->images, "Draw the detection stages of windows as PNG");
  command.option("--every", arguments->every_nth, "Draw every N-th window").between(1, 1000000);
  command.example("evical detect session.yaml -o detections --images");
  command.action([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace evical
