// Detects the board in a session's recording and prints the position of its first circle: detect_board
// SESSION.
#include "core/base/error.h"
#include "core/base/progress.h"
#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/session/session.h"

#include <cstdio>

using namespace evical;

namespace {

void printViews(const BoardObservations& camera) {
  std::printf("%s: %llu events, board in %zu of %zu windows\n", camera.camera.c_str(),
              static_cast<unsigned long long>(camera.events), camera.views.size(), camera.windows.size());
  for (const BoardView& view : camera.views) {
    const CircleObservation& circle = view.circles.front();
    std::printf("  %8.3f s  %2zu circles, number %d at (%.2f, %.2f) px\n", view.time_s, view.circles.size(),
                circle.circle, circle.centre_px.x(), circle.centre_px.y());
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "detect_board SESSION\n");
    return 2;
  }
  try {
    const Session session = readSession(argv[1]);
    const DetectionResult detections =
        readAndDetect(session, RunContext{});  // a context could show progress, or stop
    for (const BoardObservations& camera : detections.cameras) printViews(camera);
    return 0;
  } catch (const CalibrationError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
