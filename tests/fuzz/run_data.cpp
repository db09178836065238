// run.data: parts whose check sums are not looked at here (EVICAL_FUZZ_RUN_DATA), so that damage gets through to them.
#include "core/pipeline/runs/run_data.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const evical::fuzz::InputFile file("run.data");
  evical::runData(evical::readRunData(file.write(data, size)).run);
  return 0;
}
