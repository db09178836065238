// Readers of text files, all with the same bytes: sessions, intrinsics, imports of other programs' files,
// results, scenarios with their boards.
#include "core/base/error.h"
#include "core/format/intrinsics_yaml.h"
#include "core/pipeline/session/import_session.h"
#include "core/pipeline/session/session.h"
#include "core/report/result_yaml.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/fuzz/input_file.h"

namespace {

// Bad files must cause a CalibrationError and nothing else.
template <class Read>
void mayFail(Read read) {
  try {
    read();
  } catch (const evical::CalibrationError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const evical::fuzz::InputFile input("input.yaml");
  const std::filesystem::path& path = input.write(data, size);
  mayFail([&] {
    const evical::Session session = evical::readSession(path);
    evical::sessionYaml(session, path.parent_path());
  });
  mayFail([&] { evical::readIntrinsicsFile(path, "left", "events"); });
  mayFail([&] { evical::importFiles({{path}, "", {}, {}}, path.parent_path() / "imported.yaml"); });
  mayFail([&] { evical::readResultYaml(path); });
  mayFail([&] {
    const evical::Scenario scenario = evical::readScenario(path);
    evical::truthYaml(scenario);
    evical::sessionYaml(scenario, "recording.bag");
  });
  return 0;
}
