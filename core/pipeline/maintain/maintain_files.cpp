#include "core/pipeline/maintain/maintain_files.h"

#include "core/base/atomic_file.h"
#include "core/export/export_target.h"
#include "core/report/assessment_report.h"
#include "core/report/html/html_report.h"

#include <fmt/format.h>

#include <cstddef>
#include <utility>
#include <vector>

namespace evical {

void writeMaintenanceFiles(const std::filesystem::path& folder, const Maintenance& maintenance,
                           const std::string& log) {
  std::vector<FileContent> files = {{"log.txt", log}, {"stops.csv", stopsCsv(maintenance)}};
  for (std::size_t k = 0; k < maintenance.tracks.size(); ++k)
    files.push_back({fmt::format("track{}.csv", k + 1), trackCsv(maintenance.tracks[k])});
  for (ReportFile& file : reportFiles(maintenance)) files.push_back({file.name, std::move(file.content)});
  files.push_back(
      {"maintenance.yaml", assessmentYaml(maintenance)});  // written last: marks a complete result
  writeExportedFiles(folder, files);
}

}  // namespace evical
