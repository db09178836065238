// Valid recordings with false contents through the whole pipeline: bytes select disturbances
// (tests/support/lying_recording.h). Must end in a result or an error message, within the fuzzer's limits of
// time and memory.
#include "core/base/error.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "tests/fuzz/input_file.h"
#include "tests/support/lying_recording.h"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const evical::fuzz::InputFile place("unused");
  static const evical::test::LyingRecording lying(place.folder());
  try {
    const evical::CalibrationRun run = evical::calibrate(lying.tell({data, size}), evical::RunContext{});
    for (const evical::CameraState& camera : run.result.state.cameras)
      if (!camera.reference_from_camera.translation_m.allFinite()) std::abort();
  } catch (const evical::CalibrationError&) {
    // Disturbed recordings cause this error.
  }
  return 0;
}
