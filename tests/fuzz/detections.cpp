// Tables of detections: the same bytes as either table, whose columns are identified by their names.
#include "core/base/error.h"
#include "core/report/detections_csv.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const evical::fuzz::InputFile detections("detections.csv");
  const std::filesystem::path& path = detections.write(data, size);
  std::filesystem::copy_file(path, detections.folder() / "windows.csv",
                             std::filesystem::copy_options::overwrite_existing);
  try {
    constexpr int kPoints = 44;
    const std::vector<evical::BoardObservations> cameras =
        evical::readDetections(detections.folder(), kPoints);
    evical::detectionsCsv(cameras);
    evical::windowsCsv(cameras);
  } catch (const evical::CalibrationError&) {
  }
  return 0;
}
