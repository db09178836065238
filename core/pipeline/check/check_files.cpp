#include "core/pipeline/check/check_files.h"

#include "core/base/atomic_file.h"
#include "core/pipeline/runs/result_files.h"
#include "core/report/assessment_report.h"

#include <memory>
#include <utility>
#include <vector>

namespace evical {
namespace {

NamedResult namedOf(const CheckInput& input, const CheckRun& checked, const std::string& version) {
  if (checked.run) return namedRun(input.session, checked.run, version);
  const auto failed = std::make_shared<CalibrationResult>();
  failed->status = CalibrationStatus::Failed;
  failed->reason = checked.check.reason;
  if (!checked.detections.cameras.empty() || !checked.detections.imus.empty())
    failed->start_ns = checked.detections.start_ns;
  return namedResult(input.session, failed, version);
}

}  // namespace

void writeCheckFiles(const std::filesystem::path& folder, const CheckInput& input, const CheckRun& checked,
                     const std::string& version, const std::string& log) {
  const NamedResult named = namedOf(input, checked, version);
  std::vector<FileContent> files = {{"log.txt", log}};
  for (FileContent& file :
       reportOf(input.session, named, checked.run ? checked.run->detections : checked.detections, {},
                &checked.check))
    files.push_back(std::move(file));
  files.push_back({"check.yaml", assessmentYaml(checked.check)});  // written last: marks a complete result
  writeExportedFiles(folder, files);
}

}  // namespace evical
