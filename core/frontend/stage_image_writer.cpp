#include "core/frontend/stage_image_writer.h"

#include "core/base/error.h"
#include "core/frontend/stage_drawing.h"

#include <cstdio>
#include <system_error>
#include <utility>
#include <vector>

namespace evical {
namespace {

std::filesystem::path numbered(const std::filesystem::path& directory, const char* name, int number) {
  char file[32];
  std::snprintf(file, sizeof file, "%s_%04d.png", name, number);
  return directory / file;
}

}  // namespace

StageImageWriter::StageImageWriter(std::filesystem::path directory, int every_nth, const BoardScene& scene,
                                   const BurstHistory* history, const FrontEndOptions& options)
    : directory_(std::move(directory)),
      every_nth_(every_nth > 0 ? every_nth : 1),
      scene_(&scene),
      history_(history),
      options_(options) {
  std::error_code error;
  std::filesystem::create_directories(directory_, error);
  if (error)
    throw badInput(directory_.string(), "folder for images cannot be created: " + error.message(),
                   "Choose another folder");
}

void StageImageWriter::windowTracked(const BurstWindow& window, const WindowTrace& trace) {
  const int number = windows_++;
  if (number % every_nth_ != 0) return;
  writePng(numbered(directory_, "window", number), drawTrackedWindow(window, trace, *scene_));
  ++images_;
}

void StageImageWriter::windowSearched(const BoardSearch& search, std::int64_t middle_ns) {
  const int number = searches_++;
  if (number % every_nth_ != 0) return;
  BurstWindow window(*scene_);
  if (history_)
    window.fillSupported(*history_, middle_ns, search.half_window_s, options_.ring_vote.min_support);
  else
    window.assign({}, middle_ns);
  const std::filesystem::path path = numbered(directory_, "search", number);
  if (search.source == CandidateSource::NormalFlow) {
    const NormalFlowStages arcs = findArcs(window, options_);
    writePng(path, drawSearch(window, search, *scene_, &arcs));
  } else {
    writePng(path, drawSearch(window, search, *scene_));
  }
  ++images_;
}

}  // namespace evical
