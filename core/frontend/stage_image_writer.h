// Writes a picture of every n-th window that the front end processes.
#pragma once

#include "core/frontend/detection_options.h"
#include "core/frontend/window_trace.h"

#include <filesystem>

namespace evical {

class BurstHistory;
struct BoardScene;

// search_0000.png, search_0001.png, ... and window_0000.png, ...: numbered by searches and windows, so that
// the numbers of two runs agree for any every_nth.
class StageImageWriter : public FrontEndObserver {
 public:
  // Creates the folder. `scene` and `history` are the tracker's and must outlive the writer; without a
  // history searches are drawn without bursts.
  StageImageWriter(std::filesystem::path directory, int every_nth, const BoardScene& scene,
                   const BurstHistory* history = nullptr, const FrontEndOptions& options = {});

  void windowTracked(const BurstWindow& window, const WindowTrace& trace) override;
  void windowSearched(const BoardSearch& search, std::int64_t middle_ns) override;

  int imagesWritten() const { return images_; }

 private:
  std::filesystem::path directory_;
  int every_nth_;
  const BoardScene* scene_;
  const BurstHistory* history_;
  FrontEndOptions options_;
  int windows_ = 0, searches_ = 0, images_ = 0;
};

}  // namespace evical
